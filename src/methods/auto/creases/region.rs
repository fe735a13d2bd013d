//! Chooses and fits the surface that continues one region of the mesh into a hole.
//!
//! The choice is that of [`choice`] for a smooth hole, but it reads only the region's own triangles. Triangles beyond a
//! crease would falsify normals and fits. A region with too few vertices for a choice is continued by a plane if its
//! vertices lie in one, otherwise by an interpolating function.

use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::methods::auto::creases::detect::Regions;
use crate::methods::auto::surface::algebraic::{AlgebraicSurface, Kind};
use crate::methods::auto::surface::candidates::Candidate;
use crate::methods::auto::surface::samples::SampledBand;
use crate::methods::auto::surface::{FITTED_RINGS, choice};
use crate::methods::auto::surface::{Implicit, Sample};
use crate::surroundings::Surroundings;
use crate::surroundings::fits::QuadricFits;

/// A small region is a plane if the root mean square distance of its vertices from a plane is below the larger of two
/// bounds: `PLANE_DISTANCE`, in mean rim edge lengths, and `PLANE_NOISE`, in units of its noise.
const PLANE_DISTANCE: f64 = 5e-3;
const PLANE_NOISE: f64 = 2.0;

/// Lower bound on the vertices that a surface is fitted to.
const FEWEST_VERTICES: usize = 4;
/// Upper bound on the vertices that the surface of a small region is fitted to. The cost of an interpolating function
/// grows with the cube of this number.
const MOST_VERTICES: usize = 140;

/// The surface of a region.
pub(crate) struct RegionSurface {
    pub(crate) candidate: Candidate,
    pub(crate) surface: Box<dyn Implicit>,
    /// The score of the candidate from [`choice::scores`]; `None` for a region too small for a choice.
    pub(crate) score: Option<f64>,
}

/// The part of the rim that the triangles of one region touch, with these triangles as its surroundings.
fn region_of(around: &Surroundings, faces: &[u32]) -> Surroundings {
    let triangles = || faces.iter().map(|&f| around.triangles()[f as usize]);
    let mut used: Vec<u32> = triangles().flatten().collect();
    used.sort_unstable();
    used.dedup();
    // Every vertex is in the list.
    let number = |v: u32| used.partition_point(|&u| u < v) as u32;
    Surroundings::new(
        number(around.rim().len() as u32) as usize,
        used.iter().map(|&v| around.point(v)).collect(),
        used.iter().map(|&v| around.levels()[v as usize]).collect(),
        triangles().map(|t| t.map(number)).collect(),
    )
}

/// Chooses and fits a surface for each region. `step` is the mean edge length at the rim; `allowed` says which
/// candidates may be used.
///
/// # Errors
/// [`crate::ErrorKind::Geometry`] when a region is too small; [`crate::ErrorKind::Cancelled`].
pub(crate) fn fit_regions(
    hole: &Hole,
    regions: &Regions,
    step: f64,
    allowed: &dyn Fn(Candidate, &SampledBand) -> bool,
    job: &Job<'_>,
) -> Result<Vec<RegionSurface>> {
    let fit = |faces: &Vec<u32>| {
        job.ask()?;
        let region = region_of(&hole.surroundings, faces);
        let fits = QuadricFits::new(&region, job)?;
        let mut samples = SampledBand::new(fits, hole, step, true, job);
        let is_noisy = samples.is_noisy();
        let candidates: Vec<Candidate> = Candidate::ALL
            .into_iter()
            .filter(|c| allowed(*c, &samples))
            .collect();
        let scores = choice::scores(&mut samples, &candidates)?;
        if let Some(candidate) = choice::choose(&scores, is_noisy)
            && let Some(surface) = candidate.fit_to_rim(&mut samples)?
        {
            return Ok(RegionSurface {
                candidate,
                surface,
                score: choice::score_of(&scores, candidate),
            });
        }
        fit_small(&mut samples)
    };
    regions.faces.iter().map(fit).collect()
}

fn fit_small(samples: &mut SampledBand) -> Result<RegionSurface> {
    let vertices = samples.spread(0..FITTED_RINGS + 1, MOST_VERTICES)?;
    if vertices.len() < FEWEST_VERTICES {
        let reason = "the region beside a crease is too small";
        return Err(Error::geometry(reason.to_owned()));
    }
    let chosen: Vec<Sample> = vertices.iter().map(|&v| samples.sample(v)).collect();
    let limit = samples.step * PLANE_DISTANCE.max(PLANE_NOISE * samples.noise);
    if let Some(fit) = AlgebraicSurface::fit(Kind::Plane, &chosen)
        && fit.rms < limit
    {
        return Ok(RegionSurface {
            candidate: Candidate::Plane,
            surface: Box::new(fit.surface),
            score: None,
        });
    }
    let candidate = Candidate::Cubic;
    let surface = candidate
        .fit_samples(&chosen)
        .ok_or_else(|| Error::geometry("no surface fits a region beside a crease"))?;
    Ok(RegionSurface {
        candidate,
        surface,
        score: None,
    })
}
