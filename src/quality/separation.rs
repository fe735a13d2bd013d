//! Quick proofs that two triangles of a surface do not intersect improperly.
//!
//! Most triangles with overlapping boxes are neighbors that lie beside each other. A separating plane proves that. The
//! planes tried are that of a triangle, and those perpendicular to it along its edges. If such a plane passes through
//! all common vertices, and every other corner of the second triangle lies clearly beyond it, then the triangles touch
//! in the common vertices only. This holds for all tolerances of
//! [`intersects_improperly`](super::intersect::intersects_improperly), which decides the pairs without a proof. A proof
//! is never wrong.

use super::intersect::{COPLANAR, extent};
use crate::math::{Vec3, cross_normal};

/// Lower bound on the distance of a corner that lies clearly beyond a plane, as a share of the larger triangle. A
/// corner that counts as coplanar moves by less than twice [`COPLANAR`] when it is projected along a coordinate axis.
const CLEARANCE: f64 = 4.0 * COPLANAR;

/// Lower bound on twice the area of a triangle, divided by the square of the extent. Above it, the planes of the
/// triangle have an error of at most 1e-9, far below the clearance.
const SOUND_AREA: f64 = 1e-6;

/// The normal of a plane, not of unit length.
#[derive(Clone, Copy, Debug)]
struct Direction {
    normal: Vec3,
    /// At least the length of `normal`, times [`CLEARANCE`].
    clearance: f64,
}

impl Direction {
    fn new(normal: Vec3) -> Self {
        Self {
            normal,
            clearance: CLEARANCE * normal.abs().sum(),
        }
    }
}

/// A triangle with the planes that may separate it from others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Separator {
    vertices: [u32; 3],
    corners: [Vec3; 3],
    extent: f64,
    /// The normal of the triangle.
    normal: Direction,
    /// For the edge after each corner, the normal of the edge in the triangle's plane, away from the triangle.
    outward: [Direction; 3],
    /// Square of the largest extent of another triangle for which the planes are accurate enough.
    sound_extent_sq: f64,
}

impl Separator {
    /// The planes of the triangle of `vertices` at `corners`.
    pub(super) fn new(vertices: [u32; 3], corners: [Vec3; 3]) -> Self {
        let [a, b, c] = &corners;
        let normal = cross_normal(a, b, c);
        Self {
            vertices,
            corners,
            extent: extent(&corners),
            normal: Direction::new(normal),
            outward: [b - a, c - b, a - c].map(|edge| Direction::new(edge.cross(&normal))),
            // The largest coordinate is no more than the length.
            sound_extent_sq: normal.amax() / SOUND_AREA,
        }
    }

    /// Whether a plane of this triangle proves that the one of `vertices` at `corners` does not intersect
    /// it improperly.
    #[inline]
    pub(super) fn clears(&self, vertices: &[u32; 3], corners: &[Vec3; 3]) -> bool {
        let extent = extent(corners).max(self.extent);
        if extent * extent > self.sound_extent_sq {
            return false;
        }
        let is_common = vertices.map(|v| self.vertices.contains(&v));
        let holds = self.vertices.map(|v| vertices.contains(&v));
        let common = usize::from(holds[0]) + usize::from(holds[1]) + usize::from(holds[2]);
        if common == 3 {
            return false;
        }
        // The smallest height of the other triangle's own corners above a plane through a corner of this one.
        let lowest = |through: usize, normal: &Vec3| {
            let height = |k: usize| match is_common[k] {
                true => f64::INFINITY,
                false => normal.dot(&(corners[k] - self.corners[through])),
            };
            height(0).min(height(1)).min(height(2))
        };
        for k in 0..3 {
            let held = usize::from(holds[k]) + usize::from(holds[(k + 1) % 3]);
            let Direction { normal, clearance } = &self.outward[k];
            if held == common && lowest(k, normal) > clearance * extent {
                return true;
            }
        }
        if common == 2 {
            return false;
        }
        let through = holds.iter().position(|&h| h).unwrap_or(0);
        let Direction { normal, clearance } = &self.normal;
        lowest(through, normal) > clearance * extent
            || lowest(through, &-normal) > clearance * extent
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::intersect::intersects_improperly;
    use proptest::prelude::*;

    /// Five points, of which two triangles take three each: coarse ones, so that planes and edges coincide,
    /// moved by next to nothing, so that they nearly do.
    fn points() -> impl Strategy<Value = Vec<Vec3>> {
        let size = prop_oneof![
            Just(0.0),
            Just(1e-14),
            Just(1e-10),
            Just(1e-9),
            Just(5e-9),
            Just(1e-6),
            Just(0.1)
        ];
        let coordinate = (-2..3_i32, -1.0..1.0_f64).prop_map(|(x, moved)| (f64::from(x), moved));
        let point = || [coordinate.clone(), coordinate.clone(), coordinate.clone()];
        let flatness = prop_oneof![Just(1.0), Just(0.0), Just(1e-9), Just(1e-5)];
        (proptest::collection::vec(point(), 6), size, flatness).prop_map(|(raw, size, flatness)| {
            let place = |p: &[(f64, f64); 3]| {
                let p = Vec3::from(p.map(|(x, moved)| x + size * moved));
                Vec3::new(p.x, p.y, p.z * flatness)
            };
            raw.iter().map(place).collect()
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn nothing_is_proved_wrongly(points in points(), common in 0..4_u32, turn in 0..6_usize) {
            let t = [0, 1, 2];
            let mut u = [3 - common, 4 - common, 5 - common];
            if turn >= 3 {
                u.swap(0, 1);
            }
            u.rotate_left(turn % 3);
            let corners = |t: [u32; 3]| t.map(|v| points[v as usize]);
            let intersect = intersects_improperly(&corners(t), &corners(u));
            for (t, u) in [(t, u), (u, t)] {
                let is_cleared = Separator::new(t, corners(t)).clears(&u, &corners(u));
                prop_assert!(!(is_cleared && intersect), "{:?} {:?}", corners(t), corners(u));
            }
        }
    }

    #[test]
    fn neighbors_on_a_bumpy_sheet_are_cleared() {
        const N: u32 = 12;
        let at = |i: u32, j: u32| j * N + i;
        let point = |v: u32| {
            let (x, y) = (f64::from(v % N), f64::from(v / N));
            Vec3::new(x, y, 0.3 * (0.7 * x).sin() * (0.9 * y).cos())
        };
        let cell = |i: u32, j: u32| {
            let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
            [[a, b, d], [a, d, c]]
        };
        let triangles: Vec<[u32; 3]> = (0..N - 1)
            .flat_map(|j| (0..N - 1).flat_map(move |i| cell(i, j)))
            .collect();
        let clears =
            |t: &[u32; 3], u: &[u32; 3]| Separator::new(*t, t.map(point)).clears(u, &u.map(point));
        for t in &triangles {
            let is_neighbor = |u: &&[u32; 3]| *u != t && u.iter().any(|v| t.contains(v));
            for u in triangles.iter().filter(is_neighbor) {
                assert!(clears(t, u) || clears(u, t), "{t:?} {u:?}");
            }
            assert!(!clears(t, t), "the same triangle");
        }
    }
}
