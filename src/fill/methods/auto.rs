//! Predicts the surface that was there and moves a patch onto it.
//!
//! The surroundings are read through [`SampledBand`]; candidate surfaces compete in predicting rings that they have
//! not seen ([`choice`]). A faired patch is then marched onto the winner in short steps, refined as it grows, and
//! blended into the rim. What comes out passes the gates below or is not used: then the simpler methods follow.

use super::creases::Creases;
use super::hpde;
use super::staircase::Staircase;
use crate::error::{Error, ErrorKind, Result};
use crate::fair::kharmonic::{extend_from_rim, extend_with_slope};
use crate::fill::method::Method;
use crate::fill::options::FillOptions;
use crate::fill::report::Prediction;
use crate::job::Job;
use crate::math::sparse::SpdSolver;
use crate::math::{Vec3, cross_normal, unit};
use crate::patch::{HoleShape, PatchSurface};
use crate::predict::surface::candidates::Candidate;
use crate::predict::surface::choice::Score;
use crate::predict::surface::flat_rim::RimPlane;
use crate::predict::surface::jets::Band;
use crate::predict::surface::samples::SampledBand;
use crate::predict::surface::tip::{self, Stump, Tip};
use crate::predict::surface::{Implicit, choice, flat_rim, march};
use crate::refine::rim_sizes;

/// Rings of triangles round the hole that are read.
pub(super) const RINGS: u32 = choice::RINGS;

/// Rounds of moving and refining, at most.
const MOST_ROUNDS: usize = 5;
/// Newton steps of each round and of the last projection.
const STEPS: usize = 10;
const LAST_STEPS: usize = 6;
/// Longest Newton step, in diameters of the rim.
const LONGEST_STEP: f64 = 0.05;
/// A round in which no vertex moves further than this, in rim edge lengths, and the number of triangles changes by
/// less than the second number, as a share, is the last.
const SETTLED_MOVE: f64 = 0.02;
const SETTLED_GROWTH: f64 = 0.01;
/// Fewer interior vertices than this give a tip no shape: the start is refined once more, to edges shorter by the
/// factor.
const FEWEST_INTERIOR: usize = 3;
const FINER_TIP: f64 = 0.6;
/// The same for rims of up to five edges without an interior vertex: refinement splits their edges only above 1.75
/// target lengths, and a regular pentagon, whose diagonals have 1.62 sides, is a missing vertex with its triangles.
const FINER_RIM: f64 = 0.8;

/// Smoothings of folded places, at most, each time.
const MOST_UNFOLDINGS: usize = 20;

/// Gates. Share of triangles whose normal makes a cosine below `FOLDED` with the mean of its vertices' normals, at
/// most; two triangles are always allowed.
const FOLDED: f64 = 0.2;
const FOLDED_SHARE: f64 = 0.03;
const FOLDED_COUNT: f64 = 2.5;
/// Area over that of the faired patch, at most, and for tips.
const AREA_GROWTH: [f64; 2] = [8.0, 40.0];
/// Distance from the middle of the rim in diameters of the rim, at most, and for tips.
const REACH: [f64; 2] = [3.0, 6.0];
/// Share of rim edges at which the normals of patch and mesh make a cosine below `BENT`, at most, if the faired patch
/// has no more.
const BENT: f64 = 0.3;
const BENT_SHARE: f64 = 0.1;

/// Noise above which fairing with common curvature amplifies it.
const TOO_NOISY_FOR_CURVATURE: f64 = 0.06;

/// Candidate of [`Method::Curvature`], and where the surroundings are noisy or detailed round a wide hole.
const UNCHOSEN: [Candidate; 2] = [Candidate::Cubic, Candidate::CubicSmoothed];

/// Predicts the surface in one hole.
pub(super) struct Auto<'a> {
    hole: &'a HoleShape,
    options: &'a FillOptions,
    job: &'a Job<'a>,
    prediction: Option<Prediction>,
}

impl<'a> Auto<'a> {
    pub(super) fn new(hole: &'a HoleShape, options: &'a FillOptions, job: &'a Job<'a>) -> Self {
        Self {
            hole,
            options,
            job,
            prediction: None,
        }
    }

    /// How the surface was predicted, once it was.
    pub(super) fn prediction(&self) -> Option<&Prediction> {
        self.prediction.as_ref()
    }

    /// Whether the surface was predicted and the surroundings turned out too noisy for second derivatives.
    pub(super) fn is_noisy(&self) -> bool {
        self.prediction
            .as_ref()
            .is_some_and(|p| p.noise > TOO_NOISY_FOR_CURVATURE)
    }

    /// The patch on the predicted surface.
    ///
    /// # Errors
    /// [`ErrorKind::Geometry`] when no surface could be fitted or the patch on it fails a gate; those of the
    /// staircase; [`ErrorKind::Cancelled`].
    pub(super) fn patch(
        &mut self,
        method: Method,
        staircase: &mut Staircase<'_>,
    ) -> Result<PatchSurface> {
        let lengths = &self.hole.edge_lengths;
        let step = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        let band = Band::new(self.hole, self.job)?;
        let mut samples = SampledBand::new(band, self.hole, step, self.options.auto.jets, self.job);
        self.job.ask()?;
        let is_noisy = samples.is_noisy();
        let (candidate, scores, stump) = self.choose(method, &mut samples)?;
        let smooth_score = choice::score_of(&scores, candidate);
        self.prediction = Some(Prediction {
            chosen: candidate,
            scores,
            noise: samples.noise,
            is_tip: false,
            is_flat: false,
            crease_count: 0,
            crease_surfaces: Vec::new(),
            without_creases: None,
        });
        if method == Method::Auto
            && let Some(patch) = self.patch_with_creases(step, smooth_score)?
        {
            return Ok(patch);
        }
        self.job.ask()?;
        let plane = self.flat_face(method, smooth_score);
        let is_flat = plane.is_some();
        let surface: Option<Box<dyn Implicit>> = match plane {
            Some(plane) => Some(Box::new(plane)),
            None => candidate.fit_to_rim(&mut samples)?,
        };
        self.job.ask()?;
        let surface = surface.ok_or_else(|| geometry("no surface fits the surroundings"))?;
        let (_, diameter) = self.hole.middle_and_diameter();
        let tip = stump.and_then(|s| s.tip_on(surface.as_ref(), diameter, REACH[1] * diameter));
        if let Some(prediction) = &mut self.prediction {
            prediction.is_tip = tip.is_some();
            prediction.is_flat = is_flat;
            if is_flat {
                prediction.chosen = Candidate::Plane;
            }
        }
        let marcher = Marcher {
            hole: self.hole,
            surface: surface.as_ref(),
            step,
            tip,
            joins_with_slope: candidate == Candidate::CubicSmoothed && !is_noisy && !is_flat,
            job: self.job,
        };
        let faired = staircase.patch(Method::FairC1)?;
        let (_, sizes) = staircase.refined()?;
        let first = marcher.patch(faired.clone(), sizes, &faired, staircase);
        match first {
            Err(error) if error.kind() == ErrorKind::Geometry && !is_noisy => {
                match self.march_again(&marcher, &faired, staircase) {
                    Err(other) if other.kind() != ErrorKind::Cancelled => Err(error),
                    done => done,
                }
            }
            done => done,
        }
    }

    /// The patch on the predicted surface where the march from the faired patch failed: from one with common
    /// curvature, which rises higher over a cap that is more than half a sphere, or from one that is swept across
    /// the hole, which follows a rim that winds round a tube where a faired patch cuts through it.
    fn march_again(
        &self,
        marcher: &Marcher<'_>,
        faired: &PatchSurface,
        staircase: &mut Staircase<'_>,
    ) -> Result<PatchSurface> {
        let start = staircase.patch(Method::FairC2)?;
        let (_, sizes) = staircase.refined()?;
        match marcher.patch(start, sizes, faired, staircase) {
            Err(error) if error.kind() == ErrorKind::Geometry => {}
            done => return done,
        }
        let swept = hpde::patch(self.hole, self.options, self.job)?;
        let mut sizes = rim_sizes(&swept, &self.hole.edge_lengths)?;
        for size in &mut sizes {
            *size *= self.options.density;
        }
        marcher.patch(swept, sizes, faired, staircase)
    }
}

/// Candidate, scores, and the stump of a horn if the hole may be its tip.
type Chosen = (Candidate, Vec<Score>, Option<Stump>);

impl Auto<'_> {
    /// The patch that continues creases across the hole, if there are any and they are good enough; what speaks
    /// against them is noted in the prediction.
    fn patch_with_creases(
        &mut self,
        step: f64,
        smooth_score: Option<f64>,
    ) -> Result<Option<PatchSurface>> {
        if !self.options.auto.creases {
            return Ok(None);
        }
        let creases = Creases {
            hole: self.hole,
            options: self.options,
            job: self.job,
            step,
            smooth_score: smooth_score.unwrap_or(f64::INFINITY),
        };
        let found = creases.patch();
        let Some(prediction) = &mut self.prediction else {
            return Ok(None);
        };
        match found {
            Ok(Some(patch)) => {
                prediction.crease_count = patch.count;
                prediction.crease_surfaces = patch.surfaces;
                Ok(Some(patch.surface))
            }
            Ok(None) => Ok(None),
            Err(error) if error.kind() == ErrorKind::Cancelled => Err(error),
            Err(error) => {
                prediction.without_creases = Some(error.to_string());
                Ok(None)
            }
        }
    }

    /// Whether the options let a candidate compete.
    pub(super) fn allows(
        options: &FillOptions,
        candidate: Candidate,
        samples: &SampledBand,
    ) -> bool {
        let options = &options.auto;
        candidate.suits(samples)
            && (options.primitives || candidate.interpolates())
            && (options.quintic || candidate != Candidate::Quintic)
    }

    /// The plane of the rim where the hole is a gap in a flat face and no surface predicts as well as exactly.
    fn flat_face(&self, method: Method, smooth_score: Option<f64>) -> Option<RimPlane> {
        let options = &self.options.auto;
        let is_asked = method == Method::Auto && options.candidate.is_none() && options.primitives;
        let is_open = smooth_score.is_some_and(|score| !choice::is_as_good_as_exact(score));
        if is_asked && is_open {
            flat_rim::plane_of_rim(self.hole)
        } else {
            None
        }
    }

    fn choose(&self, method: Method, samples: &mut SampledBand) -> Result<Chosen> {
        let options = &self.options.auto;
        let is_noisy = samples.is_noisy();
        if let Some(candidate) = options.candidate {
            return Ok((candidate, Vec::new(), self.stump(samples)));
        }
        if method == Method::Curvature {
            let is_smoothed = is_noisy || samples.is_detail_misleading();
            return Ok((UNCHOSEN[usize::from(is_smoothed)], Vec::new(), None));
        }
        let candidates: Vec<Candidate> = Candidate::ALL
            .into_iter()
            .filter(|c| Self::allows(self.options, *c, samples))
            .collect();
        let scores = choice::scores(samples, &candidates)?;
        let stump = self.stump(samples);
        let closing = stump
            .filter(|_| !choice::is_exact(&scores))
            .and_then(|_| tip::closing_candidate(&scores));
        let chosen = closing
            .or_else(|| choice::choose(&scores, is_noisy))
            .ok_or_else(|| geometry("the surroundings are too small to predict from"))?;
        Ok((chosen, scores, stump))
    }

    fn stump(&self, samples: &SampledBand) -> Option<Stump> {
        let is_asked_for = self.options.auto.tips;
        is_asked_for.then(|| tip::find_stump(self.hole, &samples.band))?
    }
}

/// Moves patches onto a surface.
pub(super) struct Marcher<'a> {
    pub(super) hole: &'a HoleShape,
    pub(super) surface: &'a dyn Implicit,
    /// Mean edge length at the rim.
    pub(super) step: f64,
    pub(super) tip: Option<Tip>,
    /// Whether what the rim is off the surface goes on with the slope that it has there: detail, as opposed to noise.
    pub(super) joins_with_slope: bool,
    pub(super) job: &'a Job<'a>,
}

impl Marcher<'_> {
    /// Marches from `patch`, whose vertices (or those of its rim) have the target edge lengths `sizes`, and checks the
    /// result against the faired patch.
    pub(super) fn patch(
        &self,
        mut patch: PatchSurface,
        mut sizes: Vec<f64>,
        faired: &PatchSurface,
        staircase: &Staircase<'_>,
    ) -> Result<PatchSurface> {
        let rim_count = patch.rim_count;
        let interior = patch.points.len() - rim_count;
        let finer = if self.tip.is_some() && interior < FEWEST_INTERIOR {
            FINER_TIP
        } else if interior == 0 {
            FINER_RIM
        } else {
            1.0
        };
        if finer < 1.0 {
            sizes.iter_mut().for_each(|s| *s *= finer);
            staircase.refine_again(&mut patch, &mut sizes)?;
            sizes.iter_mut().for_each(|s| *s /= finer);
        }
        let (_, diameter) = self.hole.middle_and_diameter();
        if let Some(tip) = &self.tip {
            self.raise(&mut patch, tip)?;
            staircase.refine_again(&mut patch, &mut sizes)?;
        }
        let limit = LONGEST_STEP * diameter;
        for _ in 0..MOST_ROUNDS {
            let longest = self.project(&mut patch.points[rim_count..], STEPS, limit)?;
            if !patch.points.iter().flatten().all(|x| x.is_finite()) {
                return Err(geometry("the patch ran away from the predicted surface"));
            }
            self.unfold(&mut patch, limit)?;
            let before = patch.triangles.len() as f64;
            staircase.refine_again(&mut patch, &mut sizes)?;
            let growth = (patch.triangles.len() as f64 - before).abs() / before;
            if longest < SETTLED_MOVE * self.step && growth < SETTLED_GROWTH {
                break;
            }
        }
        self.project(&mut patch.points[rim_count..], LAST_STEPS, limit)?;
        self.unfold(&mut patch, limit)?;
        self.blend(&mut patch, limit)?;
        self.check(&patch, faired)?;
        Ok(patch)
    }

    /// Raises a patch over a tip to a cone with the same apex: from a flat patch steps along the gradients of a steep
    /// surface lead sideways.
    fn raise(&self, patch: &mut PatchSurface, tip: &Tip) -> Result<()> {
        let (rim, interior) = patch.points.split_at_mut(patch.rim_count);
        let to_rim = |p: &Vec3| {
            let distances = rim.iter().map(|q| (p - q).norm());
            distances.fold(f64::INFINITY, f64::min)
        };
        let mut distances = Vec::with_capacity(interior.len());
        for p in interior.iter() {
            self.job.tick(rim.len() / 16)?;
            distances.push(to_rim(p));
        }
        let farthest = distances.iter().copied().fold(0.0, f64::max);
        for (p, distance) in interior.iter_mut().zip(&distances) {
            *p = tip.raised(p, distance / farthest);
        }
        Ok(())
    }

    /// Moves points onto the surface; returns the longest way.
    fn project(&self, points: &mut [Vec3], steps: usize, limit: f64) -> Result<f64> {
        let mut longest: f64 = 0.0;
        for p in points {
            self.job.tick(500)?;
            let moved = march::project(self.surface, p, steps, limit);
            longest = longest.max((moved - *p).norm());
            *p = moved;
        }
        Ok(longest)
    }

    /// Smooths the patch where its triangles turn against the surface, and moves it back onto that.
    fn unfold(&self, patch: &mut PatchSurface, limit: f64) -> Result<()> {
        let gradient = |p: &Vec3| unit(self.surface.value_and_gradient(p).1);
        let mut gradients = Vec::with_capacity(patch.points.len());
        for p in &patch.points {
            self.job.tick(100)?;
            gradients.push(gradient(p));
        }
        for _ in 0..MOST_UNFOLDINGS {
            let mut is_folded = vec![false; patch.points.len()];
            let mut count = 0;
            for t in &patch.triangles {
                let mean: Vec3 = t.iter().map(|&v| gradients[v as usize]).sum();
                if normal(patch, t).dot(&unit(mean)) < FOLDED {
                    count += 1;
                    t.iter().for_each(|&v| is_folded[v as usize] = true);
                }
            }
            if count == 0 {
                break;
            }
            self.job.ask()?;
            let mut sums = vec![(Vec3::zeros(), 0.0); patch.points.len()];
            for t in &patch.triangles {
                for k in 0..3 {
                    let (v, next) = (t[k] as usize, t[(k + 1) % 3] as usize);
                    for (at, other) in [(v, next), (next, v)] {
                        sums[at].0 += patch.points[other];
                        sums[at].1 += 1.0;
                    }
                }
            }
            let rim_count = patch.rim_count;
            for v in rim_count..patch.points.len() {
                if is_folded[v] {
                    let middle = sums[v].0 / sums[v].1;
                    patch.points[v] = march::project(self.surface, &middle, STEPS, limit);
                    gradients[v] = gradient(&patch.points[v]);
                }
            }
        }
        Ok(())
    }

    /// Adds to the interior what the rim is off the surface, extended inwards.
    fn blend(&self, patch: &mut PatchSurface, limit: f64) -> Result<()> {
        let rim_count = patch.rim_count;
        if patch.points.len() == rim_count {
            return Ok(());
        }
        let at_rim = self.offsets(&patch.points[..rim_count], limit)?;
        let mut solver = SpdSolver::new(self.job);
        let extended = if self.joins_with_slope {
            let surroundings = &self.hole.surroundings;
            // No other ring has a say in the slope.
            let is_first = |&v: &usize| surroundings.levels[v] == 1;
            let first: Vec<usize> = (0..surroundings.points.len()).filter(is_first).collect();
            let points: Vec<Vec3> = first.iter().map(|&v| surroundings.points[v]).collect();
            let mut around = vec![Vec3::zeros(); surroundings.points.len()];
            for (v, offset) in first.into_iter().zip(self.offsets(&points, limit)?) {
                around[v] = offset;
            }
            extend_with_slope(patch, surroundings, &at_rim, &around, &mut solver)?
        } else {
            extend_from_rim(patch, &at_rim, &mut solver)?
        };
        for (p, offset) in patch.points[rim_count..].iter_mut().zip(extended) {
            *p += offset;
        }
        Ok(())
    }

    /// What the points are off the surface.
    fn offsets(&self, points: &[Vec3], limit: f64) -> Result<Vec<Vec3>> {
        let mut projected = points.to_vec();
        self.project(&mut projected, LAST_STEPS, limit)?;
        Ok(points.iter().zip(&projected).map(|(p, q)| p - q).collect())
    }

    /// The gates.
    fn check(&self, patch: &PatchSurface, faired: &PatchSurface) -> Result<()> {
        let (middle, diameter) = self.hole.middle_and_diameter();
        let reach = REACH[usize::from(self.tip.is_some())] * diameter;
        if patch.points.iter().any(|p| (p - middle).norm() > reach) {
            return Err(geometry("the predicted patch runs away from the hole"));
        }
        if !patch.points.iter().flatten().all(|x| x.is_finite()) {
            return Err(geometry("the predicted patch is not finite"));
        }
        let folded = folded_share(patch, self.job)?;
        let count = patch.triangles.len().max(1) as f64;
        if folded >= FOLDED_SHARE.max(FOLDED_COUNT / count) {
            return Err(geometry("the predicted patch is folded"));
        }
        self.job.ask()?;
        if area(patch) > AREA_GROWTH[usize::from(self.tip.is_some())] * area(faired) {
            return Err(geometry("the predicted patch is far larger than the hole"));
        }
        self.job.ask()?;
        let bent = self.bent_share(patch);
        self.job.ask()?;
        if bent > BENT_SHARE && bent > self.bent_share(faired) {
            return Err(geometry("the predicted patch leaves the rim at an angle"));
        }
        Ok(())
    }

    /// Share of rim edges at which the patch turns away from the mesh.
    fn bent_share(&self, patch: &PatchSurface) -> f64 {
        let rim_count = patch.rim_count as u32;
        let mut normals: Vec<([u32; 2], Vec3)> = Vec::new();
        for t in &patch.triangles {
            for k in 0..3 {
                let edge = [t[k], t[(k + 1) % 3]];
                if edge.iter().all(|&v| v < rim_count) {
                    normals.push((edge, normal(patch, t)));
                }
            }
        }
        normals.sort_unstable_by_key(|&(edge, _)| edge);
        let polygon = &self.hole.polygon;
        let mut bent = 0.0;
        let mut count = 0.0;
        for (i, outside) in self.hole.outside_normals.iter().enumerate() {
            let edge = [polygon[i], polygon[(i + 1) % polygon.len()]];
            let Ok(at) = normals.binary_search_by_key(&edge, |&(edge, _)| edge) else {
                continue;
            };
            if let Some(outside) = outside {
                count += 1.0;
                bent += f64::from(u8::from(normals[at].1.dot(outside) < BENT));
            }
        }
        bent / f64::max(count, 1.0)
    }
}

fn normal(patch: &PatchSurface, t: &[u32; 3]) -> Vec3 {
    let [a, b, c] = t.map(|v| &patch.points[v as usize]);
    unit(cross_normal(a, b, c))
}

fn area(patch: &PatchSurface) -> f64 {
    let double = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| &patch.points[v as usize]);
        cross_normal(a, b, c).norm()
    };
    patch.triangles.iter().map(double).sum::<f64>() / 2.0
}

/// Share of triangles that turn away from their surroundings.
fn folded_share(patch: &PatchSurface, job: &Job<'_>) -> Result<f64> {
    let mut at_vertices = vec![Vec3::zeros(); patch.points.len()];
    for t in &patch.triangles {
        job.tick(5)?;
        let n = normal(patch, t);
        for k in 0..3 {
            let p = [0, 1, 2].map(|i| patch.points[t[(k + i) % 3] as usize]);
            let angle = (p[1] - p[0]).angle(&(p[2] - p[0]));
            at_vertices[t[k] as usize] += angle * n;
        }
    }
    job.ask()?;
    let is_folded = |t: &[u32; 3]| {
        let mean: Vec3 = t.iter().map(|&v| unit(at_vertices[v as usize])).sum();
        normal(patch, t).dot(&unit(mean)) < FOLDED
    };
    let folded = patch.triangles.iter().filter(|t| is_folded(t)).count();
    Ok(folded as f64 / patch.triangles.len().max(1) as f64)
}

fn geometry(message: &str) -> Error {
    Error::new(ErrorKind::Geometry, message)
}
