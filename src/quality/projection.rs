//! A quick proof that a patch does not intersect itself: along some direction, its projection covers no point twice.
//!
//! Criterion: all normals make an acute angle with one direction, and the outline does not cross itself when it is
//! projected along that direction. This is sufficient. All triangles are seen from the same side, so the projection
//! covers a point as often as the outline winds round it, and a simple outline winds round a point at most once. The
//! open edges of the patch must form one closed outline.
//!
//! Source: P. Volino, N. Magnenat-Thalmann, "Efficient self-collision detection on smoothly discretized
//! surface animations using geometrical shape regularity", Computer Graphics Forum 13(3), 1994.
//!
//! Complexity: O(m log m) at worst for m triangles, O(k²) at worst for k edges of the outline. Not guaranteed: a proof
//! for every sound patch. There is none for strong saddles, patches that bend by more than a right angle, or several
//! outlines.

use crate::math::{Vec3, cross_normal};
use crate::mesh::halfedge::{BOUNDARY, NON_MANIFOLD, origin, target};

/// Lower bound on the cosine of the angle between a normal and the direction, 73 degrees. For a triangle that is seen
/// nearly edge-on, rounding errors would matter.
const LEAST_COSINE: f64 = 0.3;

/// Lower bound on the distance between edges of the projected outline that are not neighbors, as a share of its extent.
/// Below it they might touch, within rounding errors.
const CLEARANCE: f64 = 1e-6;

/// Whether the criterion proves that no two triangles of the patch intersect. `twins` pairs the halfedges of
/// `triangles`; `corners` are the positions of their corners.
pub(super) fn covers_nothing_twice(
    triangles: &[[u32; 3]],
    twins: &[u32],
    corners: &[[Vec3; 3]],
) -> bool {
    let normals: Vec<Vec3> = corners
        .iter()
        .map(|[a, b, c]| cross_normal(a, b, c))
        .collect();
    let Some(view) = normals
        .iter()
        .sum::<Vec3>()
        .try_normalize(f64::MIN_POSITIVE)
    else {
        return false;
    };
    let faces_viewer = |n: &Vec3| {
        let along = n.dot(&view);
        along > 0.0 && along * along > LEAST_COSINE * LEAST_COSINE * n.norm_squared()
    };
    normals.iter().all(faces_viewer)
        && outline(triangles, twins, corners).is_some_and(|outline| is_simple(&outline, &view))
}

/// The positions along the open edges of the triangles; `None` unless these form one closed polygon.
fn outline(triangles: &[[u32; 3]], twins: &[u32], corners: &[[Vec3; 3]]) -> Option<Vec<Vec3>> {
    debug_assert_eq!(twins.len(), 3 * triangles.len());
    let start = |h: u32| origin(triangles, h);
    let end = |h: u32| target(triangles, h);
    let mut open: Vec<(u32, u32)> = Vec::new();
    for (h, twin) in (0_u32..).zip(twins) {
        match *twin {
            BOUNDARY => open.push((start(h), h)),
            NON_MANIFOLD => return None,
            twin if start(twin) == start(h) => return None,
            _ => {}
        }
    }
    open.sort_unstable();
    let is_passed_twice = open.windows(2).any(|w| w[0].0 == w[1].0);
    let first = open.first().filter(|_| !is_passed_twice)?.1;
    let mut outline = Vec::with_capacity(open.len());
    let mut h = first;
    while outline.len() < open.len() {
        outline.push(corners[h as usize / 3][h as usize % 3]);
        let next = open.binary_search_by_key(&end(h), |&(v, _)| v).ok()?;
        h = open[next].1;
        if h == first {
            break;
        }
    }
    (h == first && outline.len() == open.len()).then_some(outline)
}

/// A projected edge of the outline.
struct Segment {
    place: usize,
    ends: [[f64; 2]; 2],
    lo: [f64; 2],
    hi: [f64; 2],
}

/// Whether the closed polygon, projected along the unit vector `view`, neither crosses nor nearly touches itself.
fn is_simple(outline: &[Vec3], view: &Vec3) -> bool {
    // Two directions perpendicular to the view. The first comes from the coordinate axis least parallel to it.
    let mut across = Vec3::zeros();
    across[view.iamin()] = 1.0;
    let x_axis = (across - view * view.dot(&across)).normalize();
    let y_axis = view.cross(&x_axis);
    let seen: Vec<[f64; 2]> = outline
        .iter()
        .map(|p| {
            let p = p - outline[0];
            [p.dot(&x_axis), p.dot(&y_axis)]
        })
        .collect();
    let extent = seen
        .iter()
        .flatten()
        .fold(0.0_f64, |most, c| most.max(c.abs()));
    let room = CLEARANCE * extent;
    let count = seen.len();
    let mut segments: Vec<Segment> = (0..count)
        .map(|place| {
            let ends = [seen[place], seen[(place + 1) % count]];
            let [p, q] = ends;
            Segment {
                place,
                ends,
                lo: [p[0].min(q[0]) - room, p[1].min(q[1]) - room],
                hi: [p[0].max(q[0]), p[1].max(q[1])],
            }
        })
        .collect();
    segments.sort_unstable_by(|s, t| s.lo[0].total_cmp(&t.lo[0]).then(s.place.cmp(&t.place)));
    segments.iter().enumerate().all(|(k, s)| {
        segments[k + 1..]
            .iter()
            .take_while(|t| t.lo[0] <= s.hi[0])
            .all(|t| {
                let apart = (s.place + count - t.place) % count;
                let are_neighbors = apart == 1 || apart == count - 1;
                let is_beside = t.lo[1] > s.hi[1] || s.lo[1] > t.hi[1];
                are_neighbors || is_beside || lies_beside(s, t, room) || lies_beside(t, s, room)
            })
    })
}

/// Whether all of `t` is on one side of the line through `s`, at a distance of more than `room`.
fn lies_beside(s: &Segment, t: &Segment, room: f64) -> bool {
    let [p, q] = s.ends;
    let along = [q[0] - p[0], q[1] - p[1]];
    let least = room * along[0].hypot(along[1]);
    let [a, b] = t
        .ends
        .map(|r| along[0] * (r[1] - p[1]) - along[1] * (r[0] - p[0]));
    a.min(b) > least || a.max(b) < -least
}

#[cfg(test)]
mod tests {
    use super::super::intersect::intersects_improperly;
    use super::*;
    use crate::mesh::pairing::pair_halfedges;
    use proptest::prelude::*;

    /// The fan from the origin to the points of a closed polygon, closed or with its last triangle left out.
    fn fan(rim: &[Vec3], is_closed: bool) -> (Vec<[u32; 3]>, Vec<[Vec3; 3]>) {
        let n = rim.len() as u32;
        let triangles: Vec<_> = (0..n - u32::from(!is_closed))
            .map(|i| [n, i, (i + 1) % n])
            .collect();
        let point = |v: u32| rim.get(v as usize).copied().unwrap_or_default();
        let corners = triangles.iter().map(|t| t.map(point)).collect();
        (triangles, corners)
    }

    fn is_proved(triangles: &[[u32; 3]], corners: &[[Vec3; 3]]) -> bool {
        covers_nothing_twice(triangles, &pair_halfedges(triangles, 64), corners)
    }

    fn ring(n: usize, turns: f64, rise: f64) -> Vec<Vec3> {
        (0..n)
            .map(|i| {
                let angle = std::f64::consts::TAU * turns * i as f64 / n as f64;
                Vec3::new(angle.cos(), angle.sin(), rise * i as f64)
            })
            .collect()
    }

    #[test]
    fn a_disk_is_proved_and_what_winds_twice_is_not() {
        let (triangles, corners) = fan(&ring(12, 1.0, 0.0), true);
        assert!(is_proved(&triangles, &corners));
        // A staircase of two turns faces up everywhere, and covers everything twice.
        let (triangles, corners) = fan(&ring(24, 2.0, 0.01), false);
        assert!(!is_proved(&triangles, &corners));
    }

    #[test]
    fn two_disks_one_above_the_other_are_not_proved() {
        let (mut triangles, mut corners) = fan(&ring(6, 1.0, 0.0), true);
        let copies: Vec<_> = triangles.iter().map(|t| t.map(|v| v + 7)).collect();
        let shifted: Vec<_> = corners
            .iter()
            .map(|c| c.map(|p| p + Vec3::new(0.3, 0.0, 0.1)))
            .collect();
        triangles.extend(copies);
        corners.extend(shifted);
        assert!(!is_proved(&triangles, &corners));
    }

    #[test]
    fn turned_over_triangles_and_nothing_are_not_proved() {
        let (mut triangles, mut corners) = fan(&ring(6, 1.0, 0.0), true);
        triangles[2].swap(1, 2);
        corners[2].swap(1, 2);
        assert!(!is_proved(&triangles, &corners));
        assert!(!is_proved(&[], &[]));
    }

    proptest! {
        #[test]
        fn what_is_proved_has_no_intersection(
            rim in prop::collection::vec((0.2..1.0f64, -0.6..0.6f64, -0.9..0.9f64), 4..24),
            turns in prop_oneof![Just(1.0), Just(2.0), 0.6..2.2f64],
            is_closed in any::<bool>(),
        ) {
            let n = rim.len() as f64;
            let rim: Vec<Vec3> = (0..).zip(&rim).map(|(i, (r, z, jitter))| {
                let angle = std::f64::consts::TAU * turns * (f64::from(i) + jitter) / n;
                Vec3::new(r * angle.cos(), r * angle.sin(), *z)
            }).collect();
            let (triangles, corners) = fan(&rim, is_closed);
            if is_proved(&triangles, &corners) {
                for (i, t) in corners.iter().enumerate() {
                    for u in &corners[..i] {
                        prop_assert!(!intersects_improperly(t, u), "{t:?} {u:?}");
                    }
                }
            }
        }
    }
}
