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

use super::connectivity::{Connectivity, prev};
use super::density::SizeField;
use crate::math::{Vec3, unit};

/// Part of the way to the centroid that one move goes; the full way oscillates.
const STEP: f64 = 0.7;

/// No move may shrink a triangle, seen along the vertex normal, below this part of the mean of its
/// ring.
const FOLD_MARGIN: f64 = 0.1;

/// Relaxes vertices of one patch; owns the one-ring buffer so that it is allocated once.
pub(super) struct Relaxer {
    /// The one-ring in order; its first vertex is repeated at the end.
    ring: Vec<Neighbour>,
}

#[derive(Clone, Copy)]
struct Neighbour {
    vertex: u32,
    /// Position relative to the vertex in the middle.
    offset: Vec3,
    /// Target edge length.
    size: f64,
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
        self.ring.clear();
        let mut h = start;
        loop {
            let vertex = mesh.target(h);
            let offset = points[vertex as usize] - origin;
            self.ring.push(Neighbour {
                vertex,
                offset,
                size: sizes.at(vertex),
            });
            match mesh.opposite(prev(h)) {
                Some(turned) if turned != start => h = turned,
                _ => break,
            }
        }
        self.ring.push(self.ring[0]);
        let size = sizes.at(v);
        let step = self.limited_step(size);
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

    /// The outer edges of the incident triangles.
    fn edges(&self) -> impl Iterator<Item = (&Neighbour, &Neighbour)> {
        self.ring.windows(2).map(|pair| (&pair[0], &pair[1]))
    }

    fn limited_step(&self, size: f64) -> Vec3 {
        let (mut normal, mut centroid, mut weight) = (Vec3::zeros(), Vec3::zeros(), 0.0);
        for (b, c) in self.edges() {
            let n = b.offset.cross(&c.offset);
            let edge = size + b.size + c.size;
            let w = n.norm() / (edge * edge);
            normal += n;
            centroid += (b.offset + c.offset) * (w / 3.0);
            weight += w;
        }
        let up = unit(normal);
        if up == Vec3::zeros() || weight <= f64::MIN_POSITIVE {
            return Vec3::zeros();
        }
        let mut step = centroid / weight;
        step -= up * step.dot(&up);
        // Seen along `up`, each area changes linearly with the way gone: area - t * loss.
        let floor = FOLD_MARGIN * normal.norm() / (self.ring.len() - 1) as f64;
        let mut way = STEP;
        for (b, c) in self.edges() {
            let loss = step.cross(&(c.offset - b.offset)).dot(&up);
            if loss > 0.0 {
                let area = b.offset.cross(&c.offset).dot(&up);
                way = way.min((area - floor).max(0.0) / loss);
            }
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
