//! The height field round a hole, fitted by moving least squares, and the patch that is sampled from it.
//!
//! The domain is chosen, the points near the rim are projected to it, and their heights are fitted. The patch has
//! samples of the fit on a square grid inside the rim.
//!
//! Source: J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from point clouds",
//! preprint 2006, Image and Vision Computing 25(1), 2007, section 4. `docs/methods/mls.md` lists the differences. The
//! sphere as a domain is not in the paper.
//!
//! Cost: O(m k) for m points of the vicinity and k samples, as in the paper. Not guaranteed: that the patch is free of
//! intersections.

use super::domain::{Domain, Place};
use super::fit::MovingFit;
use super::mask;
use super::options::{MlsDomain, MlsOptions, MlsUnit};
use super::vicinity::{Vicinity, rim_loops};
use crate::error::{Error, ErrorKind, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::{Vec3, cross_normal};
use crate::patch::PatchSurface;
use crate::patch::chords::joined_chords;
use crate::patch::mesh::PatchMesh;
use crate::surroundings::Surroundings;
use crate::triangulate::planar::triangulate_planar_region;
use crate::triangulate::simple_polygon::{Point2, find_contact};

/// Upper bound on the share of the vicinity's projected area that is turned over. Noise turns single thin triangles
/// over, a fold turns large parts over.
const FOLDED_SHARE: f64 = 0.02;
/// Lower bound on the projected area of the vicinity, divided by its area in space, for which the plane is chosen
/// automatically. It stands for 45 degrees on average. On a steeper surface patches bulge, see section 6 of the paper.
const LEAST_PROJECTED_SHARE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Upper bound on the number of vicinity points times the number of samples. It takes about half a minute.
const MOST_PRODUCTS: usize = 1 << 30;
/// Upper bound on the rounds of adding samples on chords that are edges of the mesh already.
const CHORD_ROUNDS: usize = 4;
/// The unit of [`MlsUnit::Radius`], divided by the radius of the hole.
const RADIUS_SHARE: f64 = 0.25;

/// The height field round one hole.
pub(crate) struct HeightField<'a> {
    hole: &'a Hole,
    options: &'a MlsOptions,
    vicinity: Vicinity,
    domain: Domain,
    /// The polygons that bound the patch, as rim vertices.
    loops: Vec<Vec<u32>>,
    /// Coordinates of the vicinity's points, the rim's first.
    uv: Vec<Point2>,
    heights: Vec<f64>,
}

impl<'a> HeightField<'a> {
    /// Chooses the domain and measures the heights of the vicinity. `surroundings` must contain all points nearer to
    /// the rim than [`MlsOptions::beta`] sampling steps.
    ///
    /// # Errors
    /// [`ErrorKind::Geometry`] when there is no domain, or the vicinity does not project to it one-to-one;
    /// [`ErrorKind::Topology`] when an island touches the rim; [`ErrorKind::Cancelled`].
    pub(crate) fn new(
        hole: &'a Hole,
        surroundings: &Surroundings,
        options: &'a MlsOptions,
        job: &Job<'_>,
    ) -> Result<Self> {
        let loops = rim_loops(hole)?;
        job.ask()?;
        let vicinity = Vicinity::new(hole, surroundings, options.beta, job)?;
        job.ask()?;
        let rim: Vec<Vec3> = hole
            .polygon
            .iter()
            .map(|&v| surroundings.point(v))
            .collect();
        let on = |domain: Domain| {
            let projection = Projection::new(&domain, &vicinity, &loops, job)?;
            Ok((domain, projection))
        };
        let plane = || Domain::plane(&vicinity, &rim).and_then(on);
        let sphere = || Domain::sphere(&vicinity, &rim);
        let chosen: Result<(Domain, Projection)> = match options.domain {
            MlsDomain::Plane => plane(),
            MlsDomain::Curved => sphere().map_or_else(|_| plane(), on),
            MlsDomain::Auto => match plane() {
                Ok((_, projection)) if projection.area_share < LEAST_PROJECTED_SHARE => {
                    sphere().and_then(on).or_else(|_| plane())
                }
                Err(error) => sphere().and_then(on).map_err(|_| error),
                flat => flat,
            },
        };
        let (domain, Projection { places, .. }) = chosen?;
        Ok(Self {
            hole,
            options,
            domain,
            loops,
            uv: places.iter().map(|p| p.uv).collect(),
            heights: places.iter().map(|p| p.height).collect(),
            vicinity,
        })
    }

    /// The vertices of the vicinity, with the numbers of [`HoleShape::point`].
    pub(crate) fn vertices(&self) -> &[u32] {
        &self.vicinity.vertices
    }

    /// Extends attribute values to other points: fits them in place of the heights (section 4.4). `channels` has one
    /// list for each channel, with a value for each of the [`Self::vertices`].
    ///
    /// # Errors
    /// [`ErrorKind::Solver`] when the fit has no value at a point; [`ErrorKind::Limit`]; [`ErrorKind::Cancelled`].
    pub(crate) fn extend(
        &self,
        channels: &[Vec<f64>],
        points: &[Vec3],
        job: &Job<'_>,
    ) -> Result<Vec<Vec<f64>>> {
        let places: Vec<Point2> = points.iter().map(|p| self.domain.place(p).uv).collect();
        self.fitted(channels, &places, job)
    }

    /// The patch: the rim, the samples, and the triangles between them.
    ///
    /// # Errors
    /// [`ErrorKind::Limit`] for more than `limit` samples, or if samples times vicinity points are too many; those of
    /// the fit and of the triangulation; [`ErrorKind::Cancelled`].
    pub(crate) fn patch(&self, limit: usize, job: &Job<'_>) -> Result<PatchSurface> {
        let hole = self.hole;
        let at = |v: &u32| self.uv[*v as usize];
        let loops: Vec<Vec<Point2>> = self
            .loops
            .iter()
            .map(|l| l.iter().map(at).collect())
            .collect();
        let step = self.vicinity.step;
        let mut samples = mask::resampling_positions(&loops, step, limit, job)?;
        // The triangulation numbers the vertices of the loops first and then the samples.
        let order: Vec<u32> = self.loops.iter().flatten().copied().collect();
        let mut triangles = triangulate_planar_region(&loops, &samples, job)?;
        let shift = hole.rim().len() - order.len();
        let global = |v: u32| order.get(v as usize).copied().unwrap_or(v + shift as u32);
        for round in 0.. {
            let triangles_in_space = triangles.iter().map(|t| t.map(global)).collect();
            let count = hole.rim().len() + samples.len();
            let mesh = PatchMesh::new(triangles_in_space, count, hole.rim().len())?;
            let mut chords = joined_chords(&mesh, hole);
            if chords.is_empty() || round == CHORD_ROUNDS {
                break;
            }
            chords.sort_unstable();
            samples.extend(chords.iter().map(|&(a, b)| {
                let [a, b] = [a, b].map(|v| self.uv[v as usize]);
                [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
            }));
            triangles = triangulate_planar_region(&loops, &samples, job)?;
        }
        let heights = self.fitted(std::slice::from_ref(&self.heights), &samples, job)?;
        let mut points = hole.rim().to_vec();
        points.extend(samples.iter().zip(&heights[0]).map(|(&uv, &height)| {
            let place = Place { uv, height };
            self.domain.point(&place)
        }));
        Ok(PatchSurface {
            rim_count: hole.rim().len(),
            points,
            triangles: triangles.into_iter().map(|t| t.map(global)).collect(),
        })
    }

    /// The values of the moving fit at each of `places`.
    fn fitted(
        &self,
        channels: &[Vec<f64>],
        places: &[Point2],
        job: &Job<'_>,
    ) -> Result<Vec<Vec<f64>>> {
        let count = self.uv.len();
        if count.saturating_mul(places.len()) > MOST_PRODUCTS {
            let message = format!(
                "{} samples of a fit to {count} points are too many",
                places.len()
            );
            return Err(Error::limit(message));
        }
        let fit = MovingFit {
            points: &self.uv,
            channels,
            alpha: self.options.alpha,
            unit: self.unit(),
            degree: self.options.degree,
        };
        let mut evaluator = fit.evaluator();
        let mut result = vec![Vec::with_capacity(places.len()); channels.len()];
        let mut values = vec![0.0; channels.len()];
        for &place in places {
            job.tick(count / 4)?;
            if !evaluator.evaluate(place, &mut values) {
                let message = "the weighted least squares have no solution at a sample";
                return Err(Error::new(ErrorKind::Solver, message));
            }
            for (list, value) in result.iter_mut().zip(&values) {
                list.push(*value);
            }
        }
        Ok(result)
    }

    fn unit(&self) -> f64 {
        match self.options.unit {
            MlsUnit::Step => self.vicinity.step,
            MlsUnit::Radius => {
                let rim = &self.uv[..self.hole.rim().len()];
                let count = rim.len() as f64;
                let mean = |k: usize| rim.iter().map(|p| p[k]).sum::<f64>() / count;
                let (u, v) = (mean(0), mean(1));
                let radius = rim.iter().map(|p| (p[0] - u).hypot(p[1] - v)).sum::<f64>() / count;
                (RADIUS_SHARE * radius).max(self.vicinity.step)
            }
        }
    }
}

/// The vicinity, projected to a domain.
struct Projection {
    /// The coordinates of its points.
    places: Vec<Place>,
    /// Projected area of its triangles, divided by their area in space.
    area_share: f64,
}

impl Projection {
    /// Projects the vicinity.
    ///
    /// # Errors
    /// [`ErrorKind::Geometry`] when the projection is not one-to-one; [`ErrorKind::Cancelled`].
    fn new(
        domain: &Domain,
        vicinity: &Vicinity,
        loops: &[Vec<u32>],
        job: &Job<'_>,
    ) -> Result<Self> {
        job.ask()?;
        let places: Vec<Place> = vicinity.points.iter().map(|p| domain.place(p)).collect();
        let (mut turned, mut all, mut in_space) = (0.0, 0.0, 0.0);
        for t in &vicinity.triangles {
            let [a, b, c] = t.map(|v| places[v as usize].uv);
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            all += area.abs();
            turned += (-area).max(0.0);
            let [a, b, c] = t.map(|v| &vicinity.points[v as usize]);
            in_space += cross_normal(a, b, c).norm();
        }
        let onto = match domain {
            Domain::Plane { .. } => "the reference plane",
            Domain::Sphere { .. } => "the fitted sphere",
        };
        if turned > FOLDED_SHARE * all {
            let share = (100.0 * turned / all).round();
            let message = format!("{share} % of the vicinity are folded over in {onto}");
            return Err(Error::geometry(message));
        }
        for of_loop in loops {
            let polygon: Vec<Point2> = of_loop.iter().map(|&v| places[v as usize].uv).collect();
            if polygon.iter().flatten().any(|x| !x.is_finite()) {
                let message = format!("the rim has no place in {onto}");
                return Err(Error::geometry(message));
            }
            if let Some((i, j)) = find_contact(&polygon, job)? {
                let message = format!("edges {i} and {j} of the rim meet in {onto}");
                return Err(Error::geometry(message));
            }
        }
        Ok(Self {
            places,
            area_share: all / in_space,
        })
    }
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
