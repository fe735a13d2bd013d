//! Fills a hole by unfolding its rim: triangulated in the plane, embedded, refined, and shaped by an energy.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, sections 3.2 and 3.3. Unlike there, refinement works on the embedded patch and
//! again on its final shape, and both energies are minimised exactly, by one sparse system each.

use crate::error::{Error, ErrorKind, Result};
use crate::fair::kharmonic::{Order, fair};
use crate::fair::laplacian::Weights;
use crate::fill::method::Method;
use crate::fill::options::FillOptions;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::sparse::SpdSolver;
use crate::patch::chords::{joined_chords, split_middle};
use crate::patch::mesh::PatchMesh;
use crate::patch::{HoleShape, PatchSurface};
use crate::refine::{RefineOptions, grading, refine, rim_sizes};
use crate::triangulate::planar::triangulate_planar_region;
use crate::triangulate::unfold::unfold;

/// Times that a patch is refined and shaped again because its shape made edges too long. Each time fewer are;
/// what is left after the last is not far over the length at which edges are split.
const ROUNDS: usize = 4;

/// Relaxations of the patch before it gets its shape: more than the staircase needs, for the triangles of the
/// plane may be far from what suits the rim in space.
const RELAXATIONS: usize = 5;

/// Builds patches for one hole; the unfolding is done once.
pub(crate) struct Unfold<'a> {
    hole: &'a HoleShape,
    options: &'a FillOptions,
    job: &'a Job<'a>,
    embedded: Option<Result<PatchSurface>>,
}

impl<'a> Unfold<'a> {
    /// Nothing is computed yet.
    pub(crate) fn new(hole: &'a HoleShape, options: &'a FillOptions, job: &'a Job<'a>) -> Self {
        Self {
            hole,
            options,
            job,
            embedded: None,
        }
    }

    /// The patch of `method` in the hole's coordinates.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] for a rim with islands, [`ErrorKind::Knotted`] for one that was not unfolded;
    /// those of triangulation, refinement and fairing; [`ErrorKind::Cancelled`].
    pub(crate) fn patch(&mut self, method: Method) -> Result<PatchSurface> {
        let mut surface = self.embedded()?;
        let mut sizes = rim_sizes(&surface, &self.hole.edge_lengths)?;
        for size in &mut sizes {
            *size *= self.options.density;
        }
        for _ in 0..ROUNDS {
            let is_refined = self.refine(&mut surface, &mut sizes)?;
            let mut solver = SpdSolver::new(self.job);
            let around = &self.hole.surroundings;
            // E_AREA is least where every umbrella vector is zero, E_DF where every second-order one is.
            let (order, weights) = if method == Method::UnfoldFairing {
                (Order::Two, Weights::Umbrella)
            } else {
                (Order::One, Weights::Uniform)
            };
            fair(&mut surface, around, order, weights, &mut solver)?;
            if !is_refined {
                break;
            }
        }
        Ok(surface)
    }

    /// The rim with the triangles that its unfolding has in the plane, and their chords that the mesh has as edges
    /// split in the middle.
    fn embedded(&mut self) -> Result<PatchSurface> {
        if self.embedded.is_none() {
            self.embedded = Some(self.embed());
        }
        match &self.embedded {
            Some(embedded) => embedded.clone(),
            None => Err(Error::cancelled()),
        }
    }

    fn embed(&self) -> Result<PatchSurface> {
        let hole = self.hole;
        if hole.polygon.len() != hole.points.len() {
            return Err(Error::new(
                ErrorKind::InvalidInput,
                "a rim with islands is not one curve that could be unfolded",
            ));
        }
        let curve: Vec<Vec3> = hole
            .polygon
            .iter()
            .map(|&v| hole.points[v as usize])
            .collect();
        let options = self.options;
        let unfolding = unfold(&curve, &options.unfold, options.seed, self.job)?;
        let triangles = triangulate_planar_region(&[&unfolding.polygon], &[], self.job)?;
        let mut surface = PatchSurface {
            rim_count: hole.points.len(),
            points: hole.points.clone(),
            triangles: triangles
                .iter()
                .map(|t| t.map(|position| hole.polygon[position as usize]))
                .collect(),
        };
        self.job.ask()?;
        let rim_count = surface.rim_count;
        let mut mesh = PatchMesh::new(surface.triangles, rim_count, rim_count)?;
        for (a, b) in joined_chords(&mesh, hole) {
            let h = mesh.edge_between(a, b);
            if let Some((h, g)) = h.and_then(|h| Some((h, mesh.opposite(h)?))) {
                split_middle(&mut mesh, &mut surface.points, h.min(g), h.max(g));
            }
        }
        surface.triangles = mesh.triangles().to_vec();
        Ok(surface)
    }

    /// Refines the patch, and returns whether that added vertices.
    fn refine(&self, surface: &mut PatchSurface, sizes: &mut Vec<f64>) -> Result<bool> {
        let rim_count = surface.rim_count;
        let options = RefineOptions {
            grading: self.options.grading.unwrap_or_else(|| grading(rim_count)),
            pass_relaxations: 1,
            final_relaxations: RELAXATIONS,
            max_vertices: rim_count.saturating_add(self.options.max_new_vertices),
            ..RefineOptions::new(self.job)
        };
        let report = refine(surface, sizes, &options, &|a, b| self.hole.is_joined(a, b))?;
        Ok(report.splits > 0)
    }
}
