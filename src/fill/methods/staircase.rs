//! The staircase of practical methods: triangulate, refine, fair.
//!
//! Based on: G. Barequet, M. Sharir, "Filling gaps in the boundary of a polyhedron", CAGD 12(2), 1995;
//! P. Liepa, "Filling holes in meshes", SGP 2003. Unlike there, the patch is refined again while it takes
//! shape, so that its triangles are as regular on the final surface as they were on the first one.

use crate::error::Result;
use crate::fair::kharmonic::{Order, fair};
use crate::fair::laplacian::Weights;
use crate::fill::method::Method;
use crate::fill::options::{FairWeights, FillOptions};
use crate::job::Job;
use crate::math::sparse::SpdSolver;
use crate::patch::{HoleShape, PatchSurface};
use crate::refine::{RefineOptions, grading, refine, rim_sizes};
use crate::triangulate::{HolePolygon, TriangulationOptions, triangulate};

/// Edge lengths of the first, coarse patch over those of the final one.
const COARSENING: f64 = 2.0;

/// Polygon vertices that ear clipping leaves to the exhaustive search.
const EAR_REMAINDER: usize = 64;
/// The same, and the largest rim searched whole, where the triangulation is only the start of a patch that
/// will be refined: flips and fairing make up for what the search would find.
const START_EAR_REMAINDER: usize = 16;
const START_EXACT_LIMIT: usize = 24;

/// Relaxations of the coarse patch, which is only a start, and of the final one: a third hardly improves the
/// angles.
const COARSE_RELAXATIONS: usize = 0;
const FINE_RELAXATIONS: usize = 2;

/// Builds patches for one hole; the steps that several methods share are done once.
pub(crate) struct Staircase<'a> {
    hole: &'a HoleShape,
    options: &'a FillOptions,
    job: &'a Job<'a>,
    refined: Option<Result<(PatchSurface, Vec<f64>)>>,
}

impl<'a> Staircase<'a> {
    /// Nothing is computed yet.
    pub(crate) fn new(hole: &'a HoleShape, options: &'a FillOptions, job: &'a Job<'a>) -> Self {
        Self {
            hole,
            options,
            job,
            refined: None,
        }
    }

    /// The patch of `method` in the hole's coordinates.
    ///
    /// # Errors
    /// Those of triangulation, refinement and fairing, and [`crate::ErrorKind::Cancelled`].
    pub(crate) fn patch(&mut self, method: Method) -> Result<PatchSurface> {
        let order = match method {
            Method::Flat => return self.triangulate(self.options.exact_limit, EAR_REMAINDER),
            Method::Membrane => Order::One,
            Method::FairC2 => Order::Three,
            _ => Order::Two,
        };
        let (mut surface, _) = self.refined()?;
        let mut solver = SpdSolver::new(self.job);
        let around = &self.hole.surroundings;
        let weights = match self.options.fairing.weights {
            FairWeights::Lumped => Weights::Cotangent,
            FairWeights::Voronoi => Weights::Voronoi,
        };
        let passes = [Order::Two, order];
        let passes = &passes[usize::from(order != Order::Three)..];
        let skipped = passes.len().saturating_sub(self.options.fairing.passes);
        for &order in &passes[skipped..] {
            fair(&mut surface, around, order, weights, &mut solver)?;
        }
        Ok(surface)
    }

    fn triangulate(&self, exact_limit: usize, ear_remainder: usize) -> Result<PatchSurface> {
        let hole = self.hole;
        let points: Vec<_> = hole
            .polygon
            .iter()
            .map(|&v| hole.points[v as usize])
            .collect();
        let at = |position: usize| hole.polygon[position];
        let polygon = HolePolygon {
            points: &points,
            outside_normals: &hole.outside_normals,
            vertex_ids: &hole.polygon,
            blocked: &|i, j| hole.is_joined(at(i), at(j)),
        };
        let options = TriangulationOptions {
            exact_limit,
            ear_remainder,
            job: self.job,
        };
        let triangulation = triangulate(&polygon, &options)?;
        let triangles = triangulation
            .triangles
            .iter()
            .map(|t| t.map(|position| at(position as usize)));
        Ok(PatchSurface {
            rim_count: hole.points.len(),
            points: hole.points.clone(),
            triangles: triangles.collect(),
        })
    }

    /// The patch before it is faired, and the target edge length of each of its vertices.
    ///
    /// # Errors
    /// Those of triangulation and refinement, and [`crate::ErrorKind::Cancelled`].
    pub(super) fn refined(&mut self) -> Result<(PatchSurface, Vec<f64>)> {
        if let Some(refined) = &self.refined {
            return refined.clone();
        }
        let start = self.triangulate(START_EXACT_LIMIT, START_EAR_REMAINDER);
        let refined = start.and_then(|mut surface| {
            let mut sizes = rim_sizes(&surface, &self.hole.edge_lengths)?;
            for size in &mut sizes {
                *size *= COARSENING * self.options.density;
            }
            self.refine(&mut surface, &mut sizes, COARSE_RELAXATIONS)?;
            let around = &self.hole.surroundings;
            let mut solver = SpdSolver::new(self.job);
            fair(
                &mut surface,
                around,
                Order::Two,
                Weights::Uniform,
                &mut solver,
            )?;
            for size in &mut sizes {
                *size /= COARSENING;
            }
            self.refine(&mut surface, &mut sizes, FINE_RELAXATIONS)?;
            Ok((surface, sizes))
        });
        self.refined.insert(refined).clone()
    }

    /// Refines a patch of this hole whose vertices have moved. `sizes` holds the target edge length of each of its
    /// vertices, and does so afterwards.
    ///
    /// # Errors
    /// Those of refinement, and [`crate::ErrorKind::Cancelled`].
    pub(super) fn refine_again(
        &self,
        surface: &mut PatchSurface,
        sizes: &mut Vec<f64>,
    ) -> Result<()> {
        self.refine(surface, sizes, FINE_RELAXATIONS)
    }

    fn refine(
        &self,
        surface: &mut PatchSurface,
        sizes: &mut Vec<f64>,
        final_relaxations: usize,
    ) -> Result<()> {
        let options = RefineOptions {
            grading: self
                .options
                .grading
                .unwrap_or_else(|| grading(surface.rim_count)),
            pass_relaxations: 1,
            final_relaxations,
            max_vertices: surface
                .rim_count
                .saturating_add(self.options.max_new_vertices),
            ..RefineOptions::new(self.job)
        };
        refine(surface, sizes, &options, &|a, b| self.hole.is_joined(a, b))?;
        Ok(())
    }
}
