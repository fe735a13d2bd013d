//! The vicinity of a hole: the known points near the rim, to which the height field is fitted.
//!
//! Source: J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from point clouds", 2007.

use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::segments::Segments;
use crate::surroundings::Surroundings;

/// The points nearer to the rim than a number of sampling steps, and the triangles between them.
pub(crate) struct Vicinity {
    /// The vertices, first those of the rim, then others, with the numbers of [`HoleShape::point`].
    pub(crate) vertices: Vec<u32>,
    /// Their positions.
    pub(crate) points: Vec<Vec3>,
    /// Triangles between them, as indices into `points`.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The sampling step (eq. 9).
    pub(crate) step: f64,
}

impl Vicinity {
    /// The points of `surroundings` nearer to the rim than `beta` sampling steps. `surroundings` must contain them all.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Geometry`] when the triangles at the rim have no area; [`crate::ErrorKind::Cancelled`].
    pub(crate) fn new(
        hole: &Hole,
        surroundings: &Surroundings,
        beta: f64,
        job: &Job<'_>,
    ) -> Result<Self> {
        let step = hole.surroundings.sampling_step();
        if !(step.is_finite() && step > 0.0) {
            let message = "the triangles at the rim have no area to take a sampling step from";
            return Err(Error::geometry(message));
        }
        let polygon = &hole.polygon;
        let edges = (0..polygon.len())
            .map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]])
            .map(|edge| edge.map(|v| surroundings.point(v)));
        let rim = Segments::new(edges.collect(), job)?;
        let limit = (beta * step) * (beta * step);
        let mut vicinity = Self {
            vertices: (0..hole.rim().len() as u32).collect(),
            points: hole.rim().to_vec(),
            triangles: Vec::new(),
            step,
        };
        let mut place: Vec<Option<u32>> = vicinity.vertices.iter().copied().map(Some).collect();
        for (v, p) in (vicinity.points.len() as u32..).zip(surroundings.outer()) {
            job.tick(30)?;
            let is_near = rim.distance_sq(p) < limit;
            place.push(is_near.then_some(vicinity.points.len() as u32));
            if is_near {
                vicinity.vertices.push(v);
                vicinity.points.push(*p);
            }
        }
        for t in surroundings.triangles() {
            if let [Some(a), Some(b), Some(c)] = t.map(|v| place[v as usize]) {
                vicinity.triangles.push([a, b, c]);
            }
        }
        Ok(vicinity)
    }
}

/// The closed polygons that bound a hole: the outer one and those round islands, in the patch's orientation,
/// as rim vertices. Bridges between them are left out.
///
/// # Errors
/// [`crate::ErrorKind::Topology`] when two of them share a vertex.
pub(crate) fn rim_loops(hole: &Hole) -> Result<Vec<Vec<u32>>> {
    let m = hole.polygon.len();
    let mut next: Vec<Option<u32>> = vec![None; hole.rim().len()];
    for i in (0..m).filter(|&i| !hole.is_bridge[i]) {
        let (a, b) = (hole.polygon[i], hole.polygon[(i + 1) % m]);
        if next[a as usize].replace(b).is_some() {
            let message = "an island touches the rim in a vertex";
            return Err(Error::topology(message));
        }
    }
    let mut loops = Vec::new();
    for &start in &hole.polygon {
        let mut of_loop = Vec::new();
        let mut at = start;
        while let Some(to) = next[at as usize].take() {
            of_loop.push(at);
            at = to;
        }
        if !of_loop.is_empty() {
            loops.push(of_loop);
        }
    }
    Ok(loops)
}
