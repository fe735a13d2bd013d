//! Target edge lengths of a patch. At the rim they are those of the mesh; inside they are interpolated. In large holes
//! they grow with the distance from the rim.
//!
//! A hole with `m` rim edges takes about `0.18 m²` triangles at uniform density. With the target length `rim size +
//! grading · distance from the rim` it takes only a multiple of `m`.
//!
//! Source: P. Liepa, "Filling holes in meshes", Symposium on Geometry Processing, 2003 (a scale attribute at each rim
//! vertex, inherited by inserted vertices). The growth is our own.
//!
//! Cost: `O(1)` for each inserted vertex. Not guaranteed: exact distances. They are measured along patch edges and
//! are up to a sixth too long.

use crate::error::{Error, Result};
use crate::job::Job;
use crate::math::Vec3;
use crate::patch::PatchSurface;
use crate::patch::mesh::{PatchMesh, prev};
use std::collections::VecDeque;

/// Upper bound on the rim edges of a hole that is filled at uniform density. It takes at most some 11,000 triangles.
const UNIFORM_RIM: f64 = 250.0;

/// Limit of the grading for very large rims: growth of the target length, divided by the distance from the rim. A round
/// hole then takes about `11 m` triangles.
const LIMIT_GRADING: f64 = 0.2;

/// Lower bound on a target length, divided by the mean one at the rim. Without it, a few degenerate edges would add
/// many vertices that do not improve the shape.
const MIN_RELATIVE_SIZE: f64 = 0.05;

/// The growth of the target edge length with distance for a hole with `rim_count` edges.
///
/// It is zero up to 250 edges, then `0.2 (1 - 250/m)²`, which starts with slope zero. The number of triangles in a
/// round hole stays about constant from 250 to 700 edges, and then grows in proportion to `m`.
pub(crate) fn grading(rim_count: usize) -> f64 {
    let rest = 1.0 - UNIFORM_RIM / (rim_count as f64).max(UNIFORM_RIM);
    LIMIT_GRADING * rest * rest
}

/// Target edge length at each rim vertex `v`: the mean length of the mesh edges there, `mesh_edge_lengths[v]`. If
/// this is missing or not positive, it is the mean length of the rim edges at `v`.
///
/// # Errors
/// `Topology` or `InvalidInput` when rim edges are needed and the patch is not manifold; `Geometry` when
/// all rim vertices coincide.
pub(crate) fn rim_sizes(surface: &PatchSurface, mesh_edge_lengths: &[f64]) -> Result<Vec<f64>> {
    let usable = |length: f64| length.is_finite() && length > 0.0;
    let given = |v: usize| mesh_edge_lengths.get(v).copied().filter(|&l| usable(l));
    let rim = 0..surface.rim_count;
    let mut sizes: Vec<f64> = match rim.clone().map(given).collect() {
        Some(all) => all,
        None => {
            let means = mean_rim_edges(surface)?;
            rim.map(|v| given(v).unwrap_or(means[v])).collect()
        }
    };
    let mean = sizes.iter().sum::<f64>() / sizes.len().max(1) as f64;
    if !usable(mean) {
        return Err(Error::geometry("the rim of the hole has no extent"));
    }
    for size in &mut sizes {
        *size = size.max(MIN_RELATIVE_SIZE * mean);
    }
    Ok(sizes)
}

/// Mean length of the rim edges at each rim vertex.
fn mean_rim_edges(surface: &PatchSurface) -> Result<Vec<f64>> {
    let mesh = PatchMesh::new(
        surface.triangles.clone(),
        surface.points.len(),
        surface.rim_count,
    )?;
    let mut sums = vec![(0.0, 0u32); surface.rim_count];
    for &h in mesh.rim_halfedges() {
        let (a, b) = (mesh.origin(h) as usize, mesh.target(h) as usize);
        let length = (surface.points[a] - surface.points[b]).norm();
        for v in [a, b] {
            sums[v].0 += length;
            sums[v].1 += 1;
        }
    }
    Ok(sums
        .iter()
        .map(|&(sum, count)| sum / f64::from(count.max(1)))
        .collect())
}

/// The target edge length at every vertex of a patch that is being refined.
///
/// A size is the sum of two terms: a base, interpolated from the rim, and the grading times the depth. The depth is the
/// distance from the rim.
pub(super) struct SizeField {
    sizes: Vec<f64>,
    depths: Vec<f64>,
    grading: f64,
}

impl SizeField {
    /// Takes sizes for all vertices, or for the rim vertices only. In the second case, interior vertices inherit the
    /// size of the nearest rim vertex.
    ///
    /// # Errors
    /// `InvalidInput` unless there is one positive, finite size for each vertex or for each rim
    /// vertex, and the grading is finite and not negative; `Cancelled` when the job is cancelled.
    pub(super) fn new(
        mesh: &PatchMesh,
        points: &[Vec3],
        given: &[f64],
        grading: f64,
        job: &Job<'_>,
    ) -> Result<Self> {
        let (rim, all) = (mesh.rim_count(), mesh.vertex_count());
        if given.len() != rim && given.len() != all {
            return Err(Error::invalid(format!(
                "{} target edge lengths for {rim} rim and {all} vertices",
                given.len()
            )));
        }
        if !given.iter().all(|s| s.is_finite() && *s > 0.0) {
            return Err(Error::invalid("a target edge length is not positive"));
        }
        if !(grading.is_finite() && grading >= 0.0) {
            return Err(Error::invalid("the grading is negative or not finite"));
        }
        if given.len() == all && grading == 0.0 {
            return Ok(Self {
                sizes: given.to_vec(),
                depths: vec![0.0; all],
                grading,
            });
        }
        let (nearest, depths) = distances_from_rim(mesh, points, job)?;
        let smallest = given[..rim].iter().copied().fold(f64::INFINITY, f64::min);
        let sizes = (0..all).map(|v| {
            let growth = grading * depths[v];
            match given.get(v) {
                // The depth may have changed since. The lower bound keeps the base from shrinking with each call.
                Some(&size) if v >= rim => (size - growth).max(smallest) + growth,
                Some(&size) => size,
                None => given[nearest[v] as usize] + growth,
            }
        });
        Ok(Self {
            sizes: sizes.collect(),
            depths,
            grading,
        })
    }

    pub(super) fn at(&self, v: u32) -> f64 {
        self.sizes[v as usize]
    }

    /// Whether sizes depend on the distance from the rim.
    pub(super) fn is_graded(&self) -> bool {
        self.grading != 0.0
    }

    pub(super) fn into_sizes(self) -> Vec<f64> {
        self.sizes
    }

    /// Moves the values of vertex `order[i]` to vertex `i`.
    pub(super) fn permute(&mut self, order: &[u32]) {
        for values in [&mut self.sizes, &mut self.depths] {
            *values = order.iter().map(|&old| values[old as usize]).collect();
        }
    }

    fn base(&self, v: u32) -> f64 {
        self.sizes[v as usize] - self.grading * self.depths[v as usize]
    }

    /// Adds the size of a vertex at `middle`, between `ends` and opposite to `apexes`.
    pub(super) fn push_midpoint(
        &mut self,
        points: &[Vec3],
        middle: &Vec3,
        ends: [u32; 2],
        apexes: [u32; 2],
    ) {
        let base = 0.5 * (self.base(ends[0]) + self.base(ends[1]));
        let depth = ends
            .into_iter()
            .chain(apexes)
            .map(|v| self.depths[v as usize] + (points[v as usize] - middle).norm())
            .fold(f64::INFINITY, f64::min);
        self.sizes.push(base + self.grading * depth);
        self.depths.push(depth);
    }

    /// Updates the depth of an interior vertex, given the distances to its neighbors.
    pub(super) fn measure_depth(&mut self, v: u32, ring: impl Iterator<Item = (u32, f64)>) {
        let base = self.base(v);
        let depth = ring
            .map(|(u, distance)| self.depths[u as usize] + distance)
            .fold(f64::INFINITY, f64::min);
        if depth.is_finite() {
            self.depths[v as usize] = depth;
            self.sizes[v as usize] = base + self.grading * depth;
        }
    }
}

/// For each vertex, the nearest rim vertex and the distance to it along edges. Vertices without triangles get the first
/// rim vertex.
fn distances_from_rim(
    mesh: &PatchMesh,
    points: &[Vec3],
    job: &Job<'_>,
) -> Result<(Vec<u32>, Vec<f64>)> {
    let (rim, all) = (mesh.rim_count(), mesh.vertex_count());
    let mut nearest: Vec<u32> = (0..all as u32)
        .map(|v| if (v as usize) < rim { v } else { 0 })
        .collect();
    let mut depths = vec![f64::INFINITY; all];
    depths[..rim].fill(0.0);
    if rim < all {
        // Bellman-Ford with a queue that starts at the rim, so few vertices are visited twice.
        let mut waiting: VecDeque<u32> = (0..rim as u32).collect();
        let mut queued = vec![true; all];
        queued[rim..].fill(false);
        while let Some(v) = waiting.pop_front() {
            job.tick(3)?;
            queued[v as usize] = false;
            let neighbors = mesh
                .corners(v)
                .flat_map(|h| [mesh.target(h), mesh.origin(prev(h))]);
            for u in neighbors.map(|u| u as usize) {
                let depth = depths[v as usize] + (points[u] - points[v as usize]).norm();
                if depth < depths[u] {
                    depths[u] = depth;
                    nearest[u] = nearest[v as usize];
                    if !std::mem::replace(&mut queued[u], true) {
                        waiting.push_back(u as u32);
                    }
                }
            }
        }
    }
    for depth in &mut depths {
        if depth.is_infinite() {
            *depth = 0.0;
        }
    }
    Ok((nearest, depths))
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{disc_rim, fan_patch};
    use super::*;
    use crate::error::ErrorKind;

    #[test]
    fn grading_starts_smoothly_and_never_falls() {
        assert!((0..=250).all(|m| grading(m) == 0.0));
        assert!(grading(251) > 0.0 && grading(251) < 1e-5);
        assert!((250..5000).all(|m| grading(m) < grading(m + 1)));
        assert!(grading(usize::MAX) <= LIMIT_GRADING);
    }

    #[test]
    fn mesh_edge_lengths_win_where_they_are_usable() {
        let surface = fan_patch(disc_rim(6));
        let sizes = rim_sizes(&surface, &[2.0, 0.0, f64::NAN, -1.0, f64::INFINITY]).unwrap();
        assert_eq!(sizes[0], 2.0);
        assert!(
            sizes[1..].iter().all(|s| (s - 1.0).abs() < 1e-12),
            "{sizes:?}"
        );
    }

    #[test]
    fn coincident_rim_vertices_get_a_small_but_positive_size() {
        let mut surface = fan_patch(disc_rim(8));
        surface.points[3] = surface.points[2];
        surface.points[4] = surface.points[2];
        let sizes = rim_sizes(&surface, &[]).unwrap();
        let mean_edge = (disc_rim(8)[1] - disc_rim(8)[0]).norm();
        assert!(sizes[3] > 0.0 && sizes[3] < 0.06 * mean_edge);
        surface.points.fill(Vec3::new(1.0, 1.0, 1.0));
        assert_eq!(
            rim_sizes(&surface, &[]).unwrap_err().kind(),
            ErrorKind::Geometry
        );
    }

    #[test]
    fn pinched_rim_vertices_average_all_their_rim_edges() {
        let surface = PatchSurface {
            rim_count: 5,
            points: vec![
                Vec3::zeros(),
                Vec3::x(),
                Vec3::new(0.0, 1.0, 0.0),
                Vec3::new(-3.0, 0.0, 0.0),
                Vec3::new(0.0, -3.0, 0.0),
            ],
            triangles: vec![[0, 1, 2], [0, 3, 4]],
        };
        assert_eq!(rim_sizes(&surface, &[]).unwrap()[0], 2.0);
    }

    #[test]
    fn sizes_that_do_not_fit_the_patch_are_refused() {
        let surface = fan_patch(disc_rim(5));
        let mesh = PatchMesh::new(surface.triangles, 5, 5).unwrap();
        let bad = |sizes: &[f64], grading| {
            SizeField::new(&mesh, &surface.points, sizes, grading, &Job::unlimited()).is_err()
        };
        assert!(bad(&[1.0; 4], 0.0) && bad(&[1.0; 6], 0.0) && bad(&[], 0.0));
        assert!(bad(&[0.0; 5], 0.0) && bad(&[f64::NAN; 5], 0.0));
        assert!(bad(&[1.0; 5], -0.1) && bad(&[1.0; 5], f64::NAN));
    }

    #[test]
    fn a_midpoint_averages_its_ends_and_grows_with_the_distance_from_the_rim() {
        let surface = fan_patch(disc_rim(4));
        let mesh = PatchMesh::new(surface.triangles, 4, 4).unwrap();
        let given = [1.0, 2.0, 3.0, 4.0];
        for (grading, expected) in [(0.0, 2.0), (0.5, 2.0 + 0.5 * 0.5_f64.sqrt())] {
            let mut sizes =
                SizeField::new(&mesh, &surface.points, &given, grading, &Job::unlimited()).unwrap();
            sizes.push_midpoint(&surface.points, &Vec3::zeros(), [0, 2], [1, 3]);
            assert!(
                (sizes.at(4) - expected).abs() < 1e-12,
                "{} {expected}",
                sizes.at(4)
            );
        }
    }

    #[test]
    fn interior_vertices_without_a_size_inherit_the_nearest_rim_vertex() {
        // A wheel whose hub sits close to vertex 2.
        let mut points = disc_rim(6);
        points.push(points[2] * 0.9);
        let triangles = (0..6).map(|i| [6, i, (i + 1) % 6]).collect();
        let mesh = PatchMesh::new(triangles, 7, 6).unwrap();
        let given = [1.0, 1.0, 7.0, 1.0, 1.0, 1.0];
        let sizes = SizeField::new(&mesh, &points, &given, 0.5, &Job::unlimited()).unwrap();
        assert!(
            (sizes.at(6) - (7.0 + 0.5 * 0.1)).abs() < 1e-9,
            "{}",
            sizes.at(6)
        );
    }
}
