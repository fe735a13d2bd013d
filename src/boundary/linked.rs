//! Whether boundary loops are linked with each other, like the links of a chain.
//!
//! Based on: Z. Arai, "A rigorous derivation of the Gauss linking integral", 2013:
//! the integral over two closed polygons in closed form. A loop with another linking number than zero bounds no
//! disk that the other one does not pierce.
//!
//! Not guaranteed: two loops can be linked and have the linking number zero (the Whitehead link).

use super::boundary_loop::BoundaryLoop;
use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::mesh::trimesh::TriMesh;
use std::f64::consts::PI;

/// Pairs of loops with more pairs of edges than this are not tested: it would take longer than a second.
const MOST_PAIRS: usize = 20_000_000;

/// The boundary loops of a mesh with their boxes: linked loops have overlapping ones.
pub(crate) struct LinkedLoops<'a> {
    mesh: &'a TriMesh,
    loops: &'a [BoundaryLoop],
    boxes: Vec<Aabb>,
}

impl<'a> LinkedLoops<'a> {
    /// Measures the loops. O(their edges).
    pub(crate) fn new(mesh: &'a TriMesh, loops: &'a [BoundaryLoop]) -> Self {
        let boxes = loops
            .iter()
            .map(|l| Aabb::around(&points(mesh, l)))
            .collect();
        Self { mesh, loops, boxes }
    }

    /// The first loop that has a linking number other than zero with the loop `id`, among those not too large
    /// to be tested.
    ///
    /// O(m n) for loops of `m` and `n` edges whose boxes overlap.
    pub(crate) fn partner(&self, id: usize) -> Option<usize> {
        let own = points(self.mesh, &self.loops[id]);
        let near = |other: &&BoundaryLoop| {
            other.id != id
                && self.boxes[other.id].overlaps(&self.boxes[id])
                && other.vertices.len().saturating_mul(own.len()) <= MOST_PAIRS
        };
        let mut others = self.loops.iter().filter(near);
        let partner = others.find(|other| linking_number(&own, &points(self.mesh, other)) != 0);
        partner.map(|other| other.id)
    }
}

fn points(mesh: &TriMesh, l: &BoundaryLoop) -> Vec<Vec3> {
    l.vertices.iter().map(|&v| mesh.point(v)).collect()
}

/// How often two closed polygons without a common point wind round each other; zero if they come so near that
/// the sum is no whole number.
fn linking_number(a: &[Vec3], b: &[Vec3]) -> i64 {
    let mut sum = 0.0;
    for i in 0..a.len() {
        let ends = [a[i], a[(i + 1) % a.len()]];
        for j in 0..b.len() {
            sum += half_solid_angle(ends, [b[j], b[(j + 1) % b.len()]]);
        }
    }
    let turns = sum / (2.0 * PI);
    let whole = turns.round();
    // Rounding adds up to far less; a common point makes the sum jump by up to a half.
    if (turns - whole).abs() < 0.01 {
        whole as i64
    } else {
        0
    }
}

/// Half of the solid angle that the parallelogram of all differences between points of two segments covers.
fn half_solid_angle([p, q]: [Vec3; 2], [r, s]: [Vec3; 2]) -> f64 {
    let (a, b, c, d) = (r - p, r - q, s - q, s - p);
    let (la, lb, lc, ld) = (a.norm(), b.norm(), c.norm(), d.norm());
    let volume = a.dot(&b.cross(&c));
    let first = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    let second = la * ld * lc + a.dot(&d) * lc + d.dot(&c) * la + c.dot(&a) * ld;
    volume.atan2(first) + volume.atan2(second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn circle(m: usize, center: Vec3, x: Vec3, y: Vec3) -> Vec<Vec3> {
        (0..m)
            .map(|i| {
                let t = TAU * (i as f64 + 0.3) / m as f64;
                center + x * t.cos() + y * t.sin()
            })
            .collect()
    }

    #[test]
    fn links_of_a_chain_are_linked_and_rings_apart_are_not() {
        let one = circle(20, Vec3::zeros(), Vec3::x(), Vec3::y());
        let through = circle(33, Vec3::x(), Vec3::x(), Vec3::z());
        assert_eq!(linking_number(&one, &through).abs(), 1);
        assert_eq!(
            linking_number(&one, &through),
            linking_number(&through, &one)
        );
        let mut back = through.clone();
        back.reverse();
        assert_eq!(linking_number(&one, &back), -linking_number(&one, &through));
        for apart in [
            circle(33, Vec3::x() * 3.0, Vec3::x(), Vec3::z()),
            circle(33, Vec3::z() * 0.1, Vec3::x(), Vec3::y()),
            circle(33, Vec3::zeros(), Vec3::x() * 0.5, Vec3::z() * 0.5),
        ] {
            assert_eq!(linking_number(&one, &apart), 0);
        }
    }

    #[test]
    fn a_loop_that_winds_round_another_counts_its_turns() {
        let ring = circle(60, Vec3::zeros(), Vec3::x(), Vec3::y());
        for turns in 1..4 {
            let winding: Vec<Vec3> = (0..200)
                .map(|i| {
                    let t = TAU * f64::from(i) / 200.0;
                    let (u, r) = (f64::from(turns) * t, 0.3);
                    Vec3::new(t.cos(), t.sin(), 0.0) * (1.0 + r * u.cos())
                        + Vec3::z() * (r * u.sin())
                })
                .collect();
            assert_eq!(linking_number(&ring, &winding).abs(), i64::from(turns));
        }
    }

    #[test]
    fn loops_with_a_common_point_are_not_called_linked() {
        let one = circle(20, Vec3::zeros(), Vec3::x(), Vec3::y());
        let mut touching = circle(33, Vec3::x(), Vec3::x(), Vec3::z());
        touching[16] = one[0];
        assert!(linking_number(&one, &touching).abs() <= 1);
    }
}
