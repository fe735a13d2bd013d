//! The known triangles round a hole, with their shared edges and with normals from which noise is filtered.
//!
//! Filter: Y. Zheng, H. Fu, O. K.-C. Au, C.-L. Tai, "Bilateral normal filtering for mesh denoising", IEEE TVCG
//! 17(10), 2011, the local, iterative scheme. A normal becomes a mean over triangles that share a vertex. Similar
//! normals count more, so creases stay. The width of the filter is a multiple of the median difference between
//! neighbors; where that is zero, as on a plane, nothing is filtered.
//!
//! Cost: `O(n log n)` for `n` triangles, for sorting the edges.

use crate::error::Result;
use crate::hole::Hole;
use crate::job::Job;
use crate::math::adjacency::CompressedRows;
use crate::math::{Vec3, cross_normal, unit};
use crate::mesh::halfedge::{BOUNDARY, NON_MANIFOLD, origin, target};
use crate::mesh::pairing::pair_halfedges;

/// Rounds of filtering.
const ROUNDS: usize = 6;

/// Width of the filter, in units of the median length of the difference between the normals of neighbors.
const WIDTH_FACTOR: f64 = 2.0;
/// Upper bound on the width of the filter, as the length of a difference of unit normals. A wider filter would average
/// across creases.
const MOST_WIDTH: f64 = 0.35;

/// An edge between two known triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SharedEdge {
    /// Its vertices, the smaller first.
    pub(super) vertices: [u32; 2],
    /// Its triangles; the first runs along it from the smaller vertex to the larger.
    pub(super) faces: [u32; 2],
}

/// The known triangles with their normals and common edges.
pub(super) struct Facets<'a> {
    hole: &'a Hole,
    /// Unit normals; zero for triangles without area.
    pub(super) normals: Vec<Vec3>,
    areas: Vec<f64>,
    /// Edges with exactly two triangles that have them in opposite directions, sorted by vertices. Empty before
    /// [`find_edges`](Self::find_edges).
    pub(super) edges: Vec<SharedEdge>,
}

impl<'a> Facets<'a> {
    pub(super) fn new(hole: &'a Hole) -> Self {
        let mut facets = Self {
            hole,
            normals: Vec::new(),
            areas: Vec::new(),
            edges: Vec::new(),
        };
        for t in hole.surroundings.triangles() {
            let [a, b, c] = t.map(|v| facets.point(v));
            let normal = cross_normal(&a, &b, &c);
            facets.normals.push(unit(normal));
            facets.areas.push(normal.norm() / 2.0);
        }
        facets
    }

    /// Whether the angle between each normal and their mean is below `angle`, in radians.
    pub(super) fn turn_less_than(&self, angle: f64) -> bool {
        let mean = unit(self.normals.iter().sum());
        let least = angle.cos();
        self.normals.iter().all(|n| n.dot(&mean) > least)
    }

    /// Finds the edges that triangles share.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(super) fn find_edges(&mut self, job: &Job<'_>) -> Result<()> {
        let vertex_count = self.hole.surroundings.points().len();
        self.edges = shared_edges(self.triangles(), vertex_count, job)?;
        Ok(())
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        self.hole.surroundings.triangles()
    }

    /// The position of a vertex of the rim or of the surroundings.
    pub(super) fn point(&self, v: u32) -> Vec3 {
        self.hole.surroundings.point(v)
    }

    /// The ring that a triangle belongs to: the lowest level of its vertices.
    pub(super) fn ring(&self, face: usize) -> u32 {
        let level = |v: u32| self.hole.surroundings.levels()[v as usize];
        let [a, b, c] = self.triangles()[face].map(level);
        a.min(b).min(c)
    }

    /// The angle between the present normals of the edge's triangles, in radians.
    pub(super) fn angle(&self, edge: &SharedEdge) -> f64 {
        self.angle_between(edge.faces)
    }

    /// The same for any two triangles.
    pub(super) fn angle_between(&self, faces: [u32; 2]) -> f64 {
        let [n, m] = faces.map(|f| self.normals[f as usize]);
        2.0 * (0.5 * (n - m).norm()).min(1.0).asin()
    }

    /// Whether the surface is convex along the edge, seen from where the normals point.
    pub(super) fn is_convex(&self, edge: &SharedEdge) -> bool {
        let [n, m] = edge.faces.map(|f| self.normals[f as usize]);
        let along = self.point(edge.vertices[1]) - self.point(edge.vertices[0]);
        n.cross(&m).dot(&along) > 0.0
    }

    /// Filters noise from the normals.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(super) fn filter_normals(&mut self, job: &Job<'_>) -> Result<()> {
        job.ask()?;
        let mut differences: Vec<f64> = self
            .edges
            .iter()
            .map(|e| (self.normals[e.faces[0] as usize] - self.normals[e.faces[1] as usize]).norm())
            .collect();
        let middle = differences.len() / 2;
        if middle == differences.len() {
            return Ok(());
        }
        let (_, median, _) = differences.select_nth_unstable_by(middle, f64::total_cmp);
        let width = (WIDTH_FACTOR * *median).min(MOST_WIDTH);
        if width <= 0.0 {
            return Ok(());
        }
        let neighbors = self.neighbors(job)?;
        for _ in 0..ROUNDS {
            let mut filtered = Vec::with_capacity(self.normals.len());
            for (f, (&own, near)) in self.normals.iter().zip(&neighbors).enumerate() {
                job.tick(10)?;
                let mut sum = self.areas[f] * own;
                for &g in near {
                    let other = self.normals[g as usize];
                    let unlike = (own - other).norm_squared() / (2.0 * width * width);
                    sum += self.areas[g as usize] * (-unlike).exp() * other;
                }
                filtered.push(unit(sum));
            }
            self.normals = filtered;
        }
        Ok(())
    }

    /// The triangles that share a vertex with each triangle.
    fn neighbors(&self, job: &Job<'_>) -> Result<Vec<Vec<u32>>> {
        let count = self.hole.surroundings.points().len();
        let corners = self.triangles().as_flattened();
        let mut at_vertex = CompressedRows::with_room(count, corners.iter().copied(), 0);
        for (corner, &v) in (0_u32..).zip(corners) {
            job.tick(3)?;
            at_vertex.push(v, corner / 3);
        }
        let around = |(f, t): (u32, &[u32; 3])| {
            job.tick(10)?;
            let mut near: Vec<u32> = t
                .iter()
                .flat_map(|&v| at_vertex.of(v).iter().copied())
                .filter(|&g| g != f)
                .collect();
            near.sort_unstable();
            near.dedup();
            Ok(near)
        };
        (0..).zip(self.triangles()).map(around).collect()
    }
}

/// The edges with two consistently oriented triangles, sorted by their ends.
fn shared_edges(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    job: &Job<'_>,
) -> Result<Vec<SharedEdge>> {
    let twins = pair_halfedges(triangles, vertex_count);
    job.ask()?;
    let mut edges: Vec<SharedEdge> = (0_u32..)
        .zip(twins)
        .filter_map(|(h, twin)| {
            let vertices = [origin(triangles, h), target(triangles, h)];
            let is_shared = !matches!(twin, BOUNDARY | NON_MANIFOLD)
                && vertices[0] < vertices[1]
                && origin(triangles, twin) == vertices[1];
            is_shared.then_some(SharedEdge {
                vertices,
                faces: [h / 3, twin / 3],
            })
        })
        .collect();
    job.ask()?;
    edges.sort_unstable_by_key(|e| e.vertices);
    Ok(edges)
}
