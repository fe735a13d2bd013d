//! Tangential relaxation: moves an interior vertex in its tangent plane toward the centroid of its one-ring.
//!
//! In the centroid, each triangle has its area as weight, divided by its squared target edge length. So triangles
//! tend to the areas that their target lengths ask for. A move ends before it folds a triangle. Vertices move one
//! after the other, and each sees the moves before.
//!
//! Source: M. Botsch and L. Kobbelt, "A remeshing approach to multiresolution modeling", Symposium on Geometry
//! Processing, 2004, for uniform sizes. Cost: `O(valence)` for each vertex. Not guaranteed: that a folded triangle is
//! unfolded (it does not get worse); that the vertex stays on a curved surface (it stays in the tangent plane).

use super::density::SizeField;
use crate::math::Vec3;
use crate::patch::mesh::{Halfedge, PatchMesh, prev};

/// Length of a move, as a share of the distance to the centroid. Full moves oscillate.
const STEP: f64 = 0.7;

/// Lower bound on the area of a triangle after a move, projected along the vertex normal, as a share of the mean of the
/// ring.
const FOLD_MARGIN: f64 = 0.1;

/// Sums over the triangles round a vertex. Offsets are relative to the vertex; the length of a normal is twice the
/// area of its triangle.
struct Ring {
    normal: Vec3,
    /// Three times the weighted sum of the centroids.
    centroid: Vec3,
    weight: f64,
    triangle_count: u32,
    /// Sum and minimum of the lengths of the normals.
    total: f64,
    smallest: f64,
    /// Greatest squared distance of a neighbor.
    reach: f64,
}

/// Moves `v` if triangles surround it, and updates its size. Returns the length of the move, divided by the target edge
/// length.
pub(super) fn relax(mesh: &PatchMesh, points: &mut [Vec3], sizes: &mut SizeField, v: u32) -> f64 {
    let Some(start) = mesh.closed_start(v) else {
        return 0.0;
    };
    let origin = points[v as usize];
    let size = sizes.at(v);
    let ring = Ring::new(mesh, points, sizes, start, &origin, size);
    let step = limited_step(&ring, mesh, points, start, &origin);
    let target = origin + step;
    if !target.iter().all(|x| x.is_finite()) {
        return 0.0;
    }
    points[v as usize] = target;
    if sizes.is_graded() {
        let neighbors = mesh.corners(v).map(|h| mesh.target(h));
        sizes.measure_depth(
            v,
            neighbors.map(|u| (u, (points[u as usize] - target).norm())),
        );
    }
    step.norm() / size
}

impl Ring {
    /// Walks round the vertex at `origin`. The halfedge `start` leaves it.
    fn new(
        mesh: &PatchMesh,
        points: &[Vec3],
        sizes: &SizeField,
        start: Halfedge,
        origin: &Vec3,
        size: f64,
    ) -> Self {
        let mut ring = Self {
            normal: Vec3::zeros(),
            centroid: Vec3::zeros(),
            weight: 0.0,
            triangle_count: 0,
            total: 0.0,
            smallest: f64::INFINITY,
            reach: 0.0,
        };
        let first = mesh.target(start);
        let (mut b, mut b_size) = (points[first as usize] - origin, sizes.at(first));
        let mut h = start;
        loop {
            let back = prev(h);
            let vertex = mesh.origin(back);
            let (c, c_size) = (points[vertex as usize] - origin, sizes.at(vertex));
            let normal = b.cross(&c);
            let length = normal.norm();
            let edge = size + b_size + c_size;
            let weight = length / (edge * edge);
            ring.normal += normal;
            ring.centroid += (b + c) * weight;
            ring.weight += weight;
            ring.triangle_count += 1;
            ring.total += length;
            ring.smallest = if length < ring.smallest {
                length
            } else {
                ring.smallest
            };
            let distance = c.norm_squared();
            ring.reach = if distance > ring.reach {
                distance
            } else {
                ring.reach
            };
            (b, b_size) = (c, c_size);
            match mesh.opposite(back) {
                Some(turned) if turned != start => h = turned,
                _ => return ring,
            }
        }
    }
}

/// The move toward the centroid, in the tangent plane, shortened so that no triangle gets too small.
fn limited_step(
    ring: &Ring,
    mesh: &PatchMesh,
    points: &[Vec3],
    start: Halfedge,
    origin: &Vec3,
) -> Vec3 {
    let height = ring.normal.norm();
    if height <= f64::MIN_POSITIVE || ring.weight <= f64::MIN_POSITIVE {
        return Vec3::zeros();
    }
    let up = ring.normal / height;
    let mut step = ring.centroid * (STEP / (3.0 * ring.weight));
    step -= up * step.dot(&up);
    let floor = FOLD_MARGIN * height / f64::from(ring.triangle_count);
    // A lower bound on the projected areas: all areas together lose `total - height` when they are projected along
    // `up`. A move changes an area by at most `step` times the outer edge, which is at most twice the reach.
    let least_area = ring.smallest - (ring.total - height);
    let room = least_area - floor;
    if room > 0.0 && 4.0 * ring.reach * step.norm_squared() < room * room {
        return step;
    }
    step * way_to_fold(mesh, points, start, origin, &up, &step, floor)
}

/// The share of `step` after which the first shrinking triangle has area `floor`, at most 1.
fn way_to_fold(
    mesh: &PatchMesh,
    points: &[Vec3],
    start: Halfedge,
    origin: &Vec3,
    up: &Vec3,
    step: &Vec3,
    floor: f64,
) -> f64 {
    let mut way: f64 = 1.0;
    for h in mesh.corners(mesh.origin(start)) {
        let b = points[mesh.target(h) as usize] - origin;
        let c = points[mesh.apex(h) as usize] - origin;
        // Projected along `up`, each area changes linearly with the share `t` of the move: area - t * loss.
        let loss = step.cross(&(c - b)).dot(up);
        if loss > 0.0 {
            let area = b.cross(&c).dot(up);
            way = way.min((area - floor).max(0.0) / loss);
        }
    }
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::Job;
    use crate::math::unit;
    use crate::patch::PatchSurface;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    /// A wheel: vertex `n` is the hub of the polygon `rim`.
    fn wheel(rim: Vec<Vec3>, hub: Vec3) -> (PatchMesh, Vec<Vec3>) {
        let n = rim.len() as u32;
        let triangles = (0..n).map(|i| [n, i, (i + 1) % n]).collect();
        let mut points = rim;
        points.push(hub);
        (
            PatchMesh::new(triangles, points.len(), points.len() - 1).unwrap(),
            points,
        )
    }

    fn sizes(mesh: &PatchMesh, points: &[Vec3], grading: f64) -> SizeField {
        let rim_count = mesh.rim_count();
        let surface = PatchSurface {
            rim_count,
            points: points.to_vec(),
            triangles: mesh.triangles().to_vec(),
        };
        SizeField::new(
            mesh,
            &surface.points,
            &vec![1.0; rim_count],
            grading,
            &Job::unlimited(),
        )
        .unwrap()
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
        assert!(relax(&mesh, &mut points, &mut sizes, 6) < 1e-15);
    }

    #[test]
    fn an_eccentric_hub_comes_to_the_middle_and_keeps_its_height() {
        let (mesh, mut points) = wheel(hexagon(0.0), Vec3::new(0.7, 0.3, 0.0));
        let rim = points[..6].to_vec();
        let mut sizes = sizes(&mesh, &points, 0.0);
        for v in (0..7).cycle().take(7 * 30) {
            relax(&mesh, &mut points, &mut sizes, v);
        }
        assert!(points[6].norm() < 1e-6);
        assert_eq!(points[..6], rim, "the rim does not move");
    }

    #[test]
    fn a_point_ring_of_coincident_vertices_moves_nothing() {
        let p = Vec3::new(3.0, 4.0, 5.0);
        let (mesh, mut points) = wheel(vec![p; 5], p);
        let mut sizes = sizes(&mesh, &points, 0.3);
        assert_eq!(relax(&mesh, &mut points, &mut sizes, 5), 0.0);
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
            for _ in 0..5 {
                let normal: Vec3 =
                    (0..n).map(|i| (points[i] - points[n]).cross(&(points[(i + 1) % n] - points[n]))).sum();
                let up = unit(normal);
                let floor = FOLD_MARGIN * normal.norm() / n as f64;
                let before = areas(&points, &up);
                relax(&mesh, &mut points, &mut sizes, n as u32);
                for (old, new) in before.iter().zip(areas(&points, &up)) {
                    prop_assert!(new >= old.min(floor) - 1e-12, "{} became {}", old, new);
                }
            }
        }
    }
}
