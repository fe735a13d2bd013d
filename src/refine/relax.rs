//! Tangential relaxation: moves an interior vertex toward the centroid of its one-ring, within its
//! tangent plane, never through a neighbouring edge.
//!
//! The centroid weighs each triangle by its area over its squared target edge length, so that at
//! rest every triangle has the area that its size asks for. With uniform sizes this is the
//! area-weighted relaxation of: M. Botsch and L. Kobbelt, "A remeshing approach to multiresolution
//! modeling", Symposium on Geometry Processing, 2004.
//!
//! Vertices move one after the other, each seeing the moves before it: `O(valence)` each. Not
//! guaranteed: that a triangle which is already folded gets unfolded (it never gets worse), and that
//! the vertex stays on a curved surface (it stays in the tangent plane).

use super::connectivity::{Connectivity, Halfedge, prev};
use super::density::SizeField;
use crate::math::{Vec3, unit};

/// Part of the way to the centroid that one move goes. The full way settles in half the number of
/// moves that 0.7 needs, because each move sees those before it; much more would oscillate.
const STEP: f64 = 1.0;

/// No move may shrink a triangle, seen along the vertex normal, below this part of the mean of its
/// ring.
const FOLD_MARGIN: f64 = 0.1;

/// Relaxes vertices of one patch; owns the one-ring buffer so that it is allocated once.
pub(super) struct Relaxer {
    /// The one-ring, counter-clockwise.
    ring: Vec<Spoke>,
}

/// A neighbour of the vertex in the middle and the triangle between it and the one before.
#[derive(Clone, Copy)]
struct Spoke {
    vertex: u32,
    /// Position relative to the vertex in the middle.
    offset: Vec3,
    /// Normal of the triangle, of twice its area.
    normal: Vec3,
}

/// What the triangles round a vertex sum up to.
struct Sums {
    normal: Vec3,
    /// Three times the weighted sum of the centroids, relative to the vertex.
    centroid: Vec3,
    weight: f64,
}

impl Relaxer {
    pub(super) fn new() -> Self {
        Self { ring: Vec::new() }
    }

    /// Moves `v` if triangles surround it, updates its size, and returns the length of the move over
    /// the target edge length there.
    pub(super) fn relax(
        &mut self,
        mesh: &Connectivity,
        points: &mut [Vec3],
        sizes: &mut SizeField,
        v: u32,
    ) -> f64 {
        let Some(start) = mesh.closed_start(v) else {
            return 0.0;
        };
        let origin = points[v as usize];
        let size = sizes.at(v);
        let sums = self.collect_ring(mesh, points, sizes, start, &origin, size);
        let step = self.limited_step(&sums);
        let target = origin + step;
        if !target.iter().all(|x| x.is_finite()) {
            return 0.0;
        }
        points[v as usize] = target;
        sizes.measure_depth(
            v,
            self.ring
                .iter()
                .map(|u| (u.vertex, (u.offset - step).norm())),
        );
        step.norm() / size
    }

    /// Walks round the vertex at `origin`, which the half-edge `start` leaves.
    fn collect_ring(
        &mut self,
        mesh: &Connectivity,
        points: &[Vec3],
        sizes: &SizeField,
        start: Halfedge,
        origin: &Vec3,
        size: f64,
    ) -> Sums {
        self.ring.clear();
        let mut sums = Sums {
            normal: Vec3::zeros(),
            centroid: Vec3::zeros(),
            weight: 0.0,
        };
        let first = mesh.target(start);
        let (mut b, mut b_size) = (points[first as usize] - origin, sizes.at(first));
        let mut h = start;
        loop {
            let back = prev(h);
            let vertex = mesh.origin(back);
            let (c, c_size) = (points[vertex as usize] - origin, sizes.at(vertex));
            let normal = b.cross(&c);
            let edge = size + b_size + c_size;
            let weight = normal.norm() / (edge * edge);
            sums.normal += normal;
            sums.centroid += (b + c) * weight;
            sums.weight += weight;
            self.ring.push(Spoke {
                vertex,
                offset: c,
                normal,
            });
            (b, b_size) = (c, c_size);
            match mesh.opposite(back) {
                Some(turned) if turned != start => h = turned,
                _ => break,
            }
        }
        sums
    }

    fn limited_step(&self, sums: &Sums) -> Vec3 {
        let up = unit(sums.normal);
        if up == Vec3::zeros() || sums.weight <= f64::MIN_POSITIVE {
            return Vec3::zeros();
        }
        let mut step = sums.centroid / (3.0 * sums.weight);
        step -= up * step.dot(&up);
        // Seen along `up`, each area changes linearly with the way gone: area - t * loss, where the
        // loss is `step` × (outer edge) · `up`.
        let floor = FOLD_MARGIN * sums.normal.norm() / self.ring.len() as f64;
        let across = up.cross(&step);
        let mut way = STEP;
        let mut before = self.ring.last().map_or(0.0, |u| u.offset.dot(&across));
        for u in &self.ring {
            let after = u.offset.dot(&across);
            let loss = after - before;
            let area = u.normal.dot(&up);
            if loss > 0.0 && area - way * loss < floor {
                way = (area - floor).max(0.0) / loss;
            }
            before = after;
        }
        step * way
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::PatchSurface;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    /// A wheel: vertex `n` is the hub of the polygon `rim`.
    fn wheel(rim: Vec<Vec3>, hub: Vec3) -> (Connectivity, Vec<Vec3>) {
        let n = rim.len() as u32;
        let triangles = (0..n).map(|i| [n, i, (i + 1) % n]).collect();
        let mut points = rim;
        points.push(hub);
        (
            Connectivity::build(triangles, points.len(), points.len() - 1).unwrap(),
            points,
        )
    }

    fn sizes(mesh: &Connectivity, points: &[Vec3], grading: f64) -> SizeField {
        let rim_count = mesh.rim_count();
        let surface = PatchSurface {
            rim_count,
            points: points.to_vec(),
            triangles: mesh.triangles().to_vec(),
        };
        SizeField::new(mesh, &surface.points, &vec![1.0; rim_count], grading).unwrap()
    }

    fn hexagon(height: f64) -> Vec<Vec3> {
        (0..6)
            .map(|i| {
                let z = if i % 2 == 0 { height } else { -height };
                Vec3::new(
                    (TAU * i as f64 / 6.0).cos(),
                    (TAU * i as f64 / 6.0).sin(),
                    z,
                )
            })
            .collect()
    }

    #[test]
    fn the_hub_of_a_regular_wheel_stays() {
        let (mesh, mut points) = wheel(hexagon(0.2), Vec3::zeros());
        let mut sizes = sizes(&mesh, &points, 0.0);
        assert!(Relaxer::new().relax(&mesh, &mut points, &mut sizes, 6) < 1e-15);
    }

    #[test]
    fn an_eccentric_hub_comes_to_the_middle_and_keeps_its_height() {
        let (mesh, mut points) = wheel(hexagon(0.0), Vec3::new(0.7, 0.3, 0.0));
        let rim = points[..6].to_vec();
        let mut sizes = sizes(&mesh, &points, 0.0);
        let mut relaxer = Relaxer::new();
        for v in (0..7).cycle().take(7 * 30) {
            relaxer.relax(&mesh, &mut points, &mut sizes, v);
        }
        assert!(points[6].norm() < 1e-6);
        assert_eq!(points[..6], rim, "the rim does not move");
    }

    #[test]
    fn a_point_ring_of_coincident_vertices_moves_nothing() {
        let p = Vec3::new(3.0, 4.0, 5.0);
        let (mesh, mut points) = wheel(vec![p; 5], p);
        let mut sizes = sizes(&mesh, &points, 0.3);
        assert_eq!(Relaxer::new().relax(&mesh, &mut points, &mut sizes, 5), 0.0);
        assert_eq!(points[5], p);
    }

    proptest! {
        #[test]
        fn no_move_turns_a_triangle_over(
            radii in prop::collection::vec(0.02f64..1.0, 3..12),
            heights in prop::collection::vec(-0.3f64..0.3, 12),
            hub in prop::array::uniform3(-0.4f64..0.4),
        ) {
            let step = TAU / radii.len() as f64;
            let rim = radii.iter().zip(&heights).enumerate().map(|(i, (r, z))| {
                let angle = step * i as f64;
                Vec3::new(r * angle.cos(), r * angle.sin(), *z)
            });
            let (mesh, mut points) = wheel(rim.collect(), Vec3::from(hub));
            let mut sizes = sizes(&mesh, &points, 0.0);
            let n = radii.len();
            let areas = |points: &[Vec3], up: &Vec3| -> Vec<f64> {
                (0..n)
                    .map(|i| (points[i] - points[n]).cross(&(points[(i + 1) % n] - points[n])).dot(up))
                    .collect()
            };
            let mut relaxer = Relaxer::new();
            for _ in 0..5 {
                let normal: Vec3 =
                    (0..n).map(|i| (points[i] - points[n]).cross(&(points[(i + 1) % n] - points[n]))).sum();
                let up = unit(normal);
                let floor = FOLD_MARGIN * normal.norm() / n as f64;
                let before = areas(&points, &up);
                relaxer.relax(&mesh, &mut points, &mut sizes, n as u32);
                for (old, new) in before.iter().zip(areas(&points, &up)) {
                    prop_assert!(new >= old.min(floor) - 1e-12, "{} became {}", old, new);
                }
            }
        }
    }
}
