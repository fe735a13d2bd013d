//! The method `mls`: fits a height field to the vertices near the hole by moving least squares, and resamples it.
//!
//! Heights are measured over a reference plane or a fitted sphere, the domain. New vertices lie on a square grid in
//! the domain. They are triangulated there together with the rim, and then edges are flipped, because a triangulation
//! that is Delaunay in the domain need not be so in space.
//!
//! Source: J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from point clouds",
//! preprint 2006, Image and Vision Computing 25(1), 2007. The paper reconstructs the whole model from points; here only
//! the hole is triangulated. Limits: see `height_field`.

mod domain;
mod fit;
mod height_field;
mod mask;
pub(crate) mod options;
mod vicinity;

use super::method::Method;
use super::spec::{Extension, HoleReach, MethodSpec};
use super::task::Task;
use crate::error::Result;
use crate::math::Vec3;
use crate::options::FillOptions;
use crate::patch::PatchSurface;
use crate::refine::{RefineOptions, refine};
use crate::surroundings::Surroundings;
use height_field::HeightField;

/// The method.
pub(super) const MLS: MethodSpec = MethodSpec {
    name: "mls",
    reach,
    falls_back_to: &[Method::FairC1, Method::Membrane, Method::Flat],
    make,
    extension: Some(Extension { reach, extend }),
    ..MethodSpec::USUAL
};

/// Target edge length with which refinement splits no edge, in mean rim edge lengths.
const UNSPLIT: f64 = 1e9;

fn reach(options: &FillOptions) -> HoleReach {
    HoleReach {
        rings: 1,
        steps: options.methods.mls.beta,
    }
}

/// # Errors
/// Those of [`HeightField::new`] and [`HeightField::patch`].
fn make(task: &Task<'_>) -> Result<PatchSurface> {
    let (hole, job) = (task.hole, task.job);
    let field = HeightField::new(hole, &hole.surroundings, &task.options.methods.mls, job)?;
    let mut surface = field.patch(task.options.refinement.max_vertices, job)?;
    // Flips only: a triangulation that is Delaunay in the domain is not so on a steep surface.
    let flips_only = RefineOptions {
        pass_relaxations: 0,
        final_relaxations: 0,
        max_vertices: surface.points.len(),
        ..RefineOptions::new(job)
    };
    let mut sizes = vec![UNSPLIT; surface.points.len()];
    refine(&mut surface, &mut sizes, &flips_only, &|a, b| {
        hole.is_joined(a, b)
    })?;
    Ok(surface)
}

/// Extends attribute values with the fit that gives the heights, for each channel.
///
/// # Errors
/// Those of [`HeightField::new`] and [`HeightField::extend`].
fn extend(
    task: &Task<'_>,
    around: &Surroundings,
    channels: &[Vec<f64>],
    points: &[Vec3],
) -> Result<Vec<Vec<f64>>> {
    let field = HeightField::new(task.hole, around, &task.options.methods.mls, task.job)?;
    let in_vicinity = |values: &Vec<f64>| -> Vec<f64> {
        let vertices = field.vertices().iter();
        vertices.map(|&v| values[v as usize]).collect()
    };
    let known: Vec<Vec<f64>> = channels.iter().map(in_vicinity).collect();
    field.extend(&known, points, task.job)
}
