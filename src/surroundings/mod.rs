//! The known surface round a hole: what methods read of it, each thing computed once.

pub(crate) mod fits;

use crate::error::Result;
use crate::job::Job;
use crate::math::adjacency::CompressedRows;
use crate::math::{Vec3, cross_normal, unit};
use std::sync::OnceLock;

/// The known triangles round a rim, ring by ring.
///
/// Their vertices are numbered like those of a patch as far as they are the same: those of the rim come first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    rim_count: usize,
    points: Vec<Vec3>,
    levels: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    normals: OnceLock<Vec<Vec3>>,
    neighbors: OnceLock<CompressedRows<u32>>,
}

impl Surroundings {
    /// Triangles round the rim that the first `rim_count` of `points` are. `levels` is the ring of each point: 0 on the
    /// rim, from 1 outside.
    pub(crate) fn new(
        rim_count: usize,
        points: Vec<Vec3>,
        levels: Vec<u32>,
        triangles: Vec<[u32; 3]>,
    ) -> Self {
        debug_assert_eq!(points.len(), levels.len());
        Self {
            rim_count,
            points,
            levels,
            triangles,
            normals: OnceLock::new(),
            neighbors: OnceLock::new(),
        }
    }

    /// A rim round which nothing is known.
    pub(crate) fn bare(rim: Vec<Vec3>) -> Self {
        Self::new(rim.len(), rim.clone(), vec![0; rim.len()], Vec::new())
    }

    /// Positions of the rim vertices.
    pub(crate) fn rim(&self) -> &[Vec3] {
        &self.points[..self.rim_count]
    }

    /// Positions of the vertices that are not on the rim.
    pub(crate) fn outer(&self) -> &[Vec3] {
        &self.points[self.rim_count..]
    }

    /// Positions of all vertices, those of the rim first.
    pub(crate) fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// The position of a vertex.
    pub(crate) fn point(&self, vertex: u32) -> Vec3 {
        self.points[vertex as usize]
    }

    /// The ring of each vertex, 0 on the rim.
    pub(crate) fn levels(&self) -> &[u32] {
        &self.levels
    }

    /// Indices into [`points`](Self::points).
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The same triangles with their vertices in other places.
    pub(crate) fn moved(&self, points: Vec<Vec3>) -> Self {
        Self {
            points,
            normals: OnceLock::new(),
            ..self.clone()
        }
    }

    /// The vertices whose level is in `levels`, in ascending order.
    pub(crate) fn vertices_in(&self, levels: std::ops::Range<u32>) -> Vec<u32> {
        (0..self.points.len() as u32)
            .filter(|&v| levels.contains(&self.levels[v as usize]))
            .collect()
    }

    /// The spacing at which the surface next to the rim is sampled: `sqrt(A / (3 n))` with `A` the area of the
    /// triangles that touch one of the `n` rim vertices. About 0.54 of an edge where these are equilateral.
    ///
    /// From: J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from point
    /// clouds", Image and Vision Computing 25(1), 2007, eq. 9.
    pub(crate) fn sampling_step(&self) -> f64 {
        let touches_rim = |t: &&[u32; 3]| t.iter().any(|&v| (v as usize) < self.rim_count);
        let double_area: f64 = self
            .triangles
            .iter()
            .filter(touches_rim)
            .map(|t| {
                let [a, b, c] = t.map(|v| self.point(v));
                cross_normal(&a, &b, &c).norm()
            })
            .sum();
        (double_area / 2.0 / (3.0 * self.rim_count as f64)).sqrt()
    }

    /// Mean length of the known edges at each rim vertex, each counted once for each of its triangles; 1 where there is
    /// none.
    pub(crate) fn edge_lengths(&self) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.rim_count];
        for t in &self.triangles {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                let length = (self.point(b) - self.point(a)).norm();
                for v in [a, b] {
                    if let Some((sum, count)) = sums.get_mut(v as usize) {
                        *sum += length;
                        *count += 1.0;
                    }
                }
            }
        }
        sums.iter()
            .map(|&(sum, count)| if count > 0.0 { sum / count } else { 1.0 })
            .collect()
    }

    /// Normals averaged over the triangles at each vertex with their angles as weights; zero where there is none.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Cancelled`] when the job is stopped.
    pub(crate) fn normals(&self, job: &Job<'_>) -> Result<&[Vec3]> {
        once(&self.normals, || {
            let mut normals = vec![Vec3::zeros(); self.points.len()];
            for t in &self.triangles {
                job.tick(4)?;
                let p = t.map(|v| self.point(v));
                let normal = unit((p[1] - p[0]).cross(&(p[2] - p[0])));
                for k in 0..3 {
                    let angle = (p[(k + 1) % 3] - p[k]).angle(&(p[(k + 2) % 3] - p[k]));
                    normals[t[k] as usize] += angle * normal;
                }
            }
            normals.iter_mut().for_each(|n| *n = unit(*n));
            job.ask()?;
            Ok(normals)
        })
        .map(Vec::as_slice)
    }

    /// The vertices that an edge joins to each vertex.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Cancelled`] when the job is stopped.
    pub(crate) fn neighbors(&self, job: &Job<'_>) -> Result<&CompressedRows<u32>> {
        once(&self.neighbors, || {
            job.ask()?;
            let corners = CompressedRows::corners(&self.triangles, self.points.len());
            job.ask()?;
            let neighbors = corners.sorted();
            job.ask()?;
            Ok(neighbors)
        })
    }
}

/// What `cell` holds, made when it is first asked for. What is not made is asked for again.
fn once<T>(cell: &OnceLock<T>, make: impl FnOnce() -> Result<T>) -> Result<&T> {
    if let Some(known) = cell.get() {
        return Ok(known);
    }
    let made = make()?;
    Ok(cell.get_or_init(|| made))
}
