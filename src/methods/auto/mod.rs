//! The methods `auto` and `curvature`: they predict the missing surface and put a patch onto it.
//!
//! 1. Read the rings of vertices round the hole ([`SampledBand`]).
//! 2. `auto` chooses one of several candidate surfaces by leave-out cross-validation on these rings ([`choice`]).
//!    `curvature` always takes an interpolating function.
//! 3. If creases run into the hole, `auto` continues them and fills the pieces between them ([`creases`]).
//! 4. Otherwise a faired patch is moved onto the surface in short steps, refined as it grows, and blended into the
//!    rim ([`march`]).
//! 5. A patch that fails a check ([`gates`]) is not used. The next method in the list of fallbacks is tried.
//!
//! Details, sources, cost and limits: `docs/methods/auto.md`.

mod creases;
mod gates;
mod march;
pub(crate) mod options;
pub(crate) mod prediction;
pub(crate) mod surface;

use super::fair::faired;
use super::method::Method;
use super::spec::{HoleReach, MethodSpec, STAIRCASE};
use super::start::{refined, sizes_at_rim};
use super::task::Task;
use crate::error::{Error, ErrorKind, Result};
use crate::fair::kharmonic::Order;
use crate::patch::PatchSurface;
use crate::surroundings::fits::QuadricFits;
use creases::Creases;
use gates::TIP_REACH;
use march::Marcher;
use prediction::Prediction;
use surface::candidates::Candidate;
use surface::choice::Score;
use surface::flat_rim::RimPlane;
use surface::samples::SampledBand;
use surface::tip::{self, Stump};
use surface::{Implicit, RINGS, choice, flat_rim};

/// Chooses the best of many candidate surfaces.
pub(super) const AUTO: MethodSpec = MethodSpec {
    name: "auto",
    make: |task| make(task, true),
    ..CURVATURE
};

/// Always takes an interpolating function.
pub(super) const CURVATURE: MethodSpec = MethodSpec {
    name: "curvature",
    reach: |_| HoleReach::rings(RINGS),
    falls_back_to: STAIRCASE,
    farthest: FARTHEST,
    make: |task| make(task, false),
    ..MethodSpec::USUAL
};

/// Upper bound on the distance of a patch vertex from the middle of the rim, in the unit of [`MethodSpec::farthest`].
/// It is larger than for other methods: the missing end of a horn is several times as long as its rim is wide. The
/// [`gates`] have bounds of their own.
const FARTHEST: f64 = 3.0;

fn make(task: &Task<'_>, chooses: bool) -> Result<PatchSurface> {
    let mut auto = Auto {
        task,
        chooses,
        prediction: None,
    };
    let patch = auto.patch();
    if let Some(prediction) = auto.prediction {
        task.keep(prediction);
    }
    patch
}

/// The work on one hole.
struct Auto<'a> {
    task: &'a Task<'a>,
    /// Whether candidates compete. If not, an interpolating function is taken.
    chooses: bool,
    /// What the report says of the prediction; `None` before the choice.
    prediction: Option<Prediction>,
}

impl Auto<'_> {
    /// The patch on the predicted surface.
    ///
    /// # Errors
    /// [`ErrorKind::Geometry`] when no surface could be fitted or the patch on it fails a gate; those of the
    /// staircase; [`ErrorKind::Cancelled`].
    fn patch(&mut self) -> Result<PatchSurface> {
        let task = self.task;
        let lengths = &task.hole.edge_lengths;
        let step = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        let fits = QuadricFits::new(&self.task.hole.surroundings, self.task.job)?;
        let mut samples = SampledBand::new(
            fits,
            self.task.hole,
            step,
            task.options.methods.auto.jets,
            self.task.job,
        );
        self.task.job.ask()?;
        let is_noisy = samples.is_noisy();
        let (candidate, scores, stump) = self.choose(&mut samples)?;
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
        if self.chooses
            && let Some(patch) = self.patch_with_creases(step, smooth_score)?
        {
            return Ok(patch);
        }
        self.task.job.ask()?;
        let plane = self.flat_face(smooth_score);
        let is_flat = plane.is_some();
        let surface: Option<Box<dyn Implicit>> = match plane {
            Some(plane) => Some(Box::new(plane)),
            None => candidate.fit_to_rim(&mut samples)?,
        };
        self.task.job.ask()?;
        let surface =
            surface.ok_or_else(|| Error::geometry("no surface fits the mesh round the hole"))?;
        let (_, diameter) = self.task.hole.middle_and_diameter();
        let tip = stump.and_then(|s| s.tip_on(surface.as_ref(), diameter, TIP_REACH * diameter));
        if let Some(prediction) = &mut self.prediction {
            prediction.is_tip = tip.is_some();
            prediction.is_flat = is_flat;
            if is_flat {
                prediction.chosen = Candidate::Plane;
            }
        }
        let marcher = Marcher {
            task,
            surface: surface.as_ref(),
            step,
            tip,
            joins_with_slope: candidate == Candidate::CubicSmoothed && !is_noisy && !is_flat,
        };
        let taut = faired(task, Order::Two)?;
        let (_, sizes) = refined(task)?;
        let first = marcher.patch(taut.clone(), sizes, &taut);
        match first {
            Err(error) if error.kind() == ErrorKind::Geometry && !is_noisy => {
                match self.march_again(&marcher, &taut) {
                    Err(other) if other.kind() != ErrorKind::Cancelled => Err(error),
                    done => done,
                }
            }
            done => done,
        }
    }

    /// A second and a third try, for holes where the march from the first faired patch failed.
    ///
    /// The second starts from a patch that was faired with common curvature. It rises higher, which helps where a cap
    /// of more than half a sphere is missing. The third starts from a patch that is swept across the hole. It follows
    /// a rim that winds round a tube; a faired patch would cut through the tube.
    fn march_again(&self, marcher: &Marcher<'_>, taut: &PatchSurface) -> Result<PatchSurface> {
        let task = self.task;
        let start = faired(task, Order::Three)?;
        let (_, sizes) = refined(task)?;
        match marcher.patch(start, sizes, taut) {
            Err(error) if error.kind() == ErrorKind::Geometry => {}
            done => return done,
        }
        let swept = (SWEPT.spec().make)(task)?;
        let sizes = sizes_at_rim(task, &swept)?;
        marcher.patch(swept, sizes, taut)
    }
}

/// The method that makes the start of the third try.
const SWEPT: Method = Method::Hpde;

/// The chosen candidate, the scores, and the stump if the hole may be the missing tip of a horn.
type Chosen = (Candidate, Vec<Score>, Option<Stump>);

impl Auto<'_> {
    /// The patch that continues creases across the hole; `None` when there are no creases or they cannot be used.
    /// The prediction then says why they were not used.
    fn patch_with_creases(
        &mut self,
        step: f64,
        smooth_score: Option<f64>,
    ) -> Result<Option<PatchSurface>> {
        if !self.task.options.methods.auto.creases {
            return Ok(None);
        }
        let creases = Creases {
            task: self.task,
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

    /// The plane of the rim, if the hole is a gap in a flat face and no candidate is as good as exact.
    fn flat_face(&self, smooth_score: Option<f64>) -> Option<RimPlane> {
        let options = &self.task.options.methods.auto;
        let is_asked = self.chooses && options.candidate.is_none() && options.primitives;
        let is_open = smooth_score.is_some_and(|score| !choice::is_as_good_as_exact(score));
        if is_asked && is_open {
            flat_rim::plane_of_rim(self.task.hole)
        } else {
            None
        }
    }

    fn choose(&self, samples: &mut SampledBand) -> Result<Chosen> {
        let options = &self.task.options.methods.auto;
        let is_noisy = samples.is_noisy();
        if let Some(candidate) = options.candidate {
            return Ok((candidate, Vec::new(), self.stump()));
        }
        if !self.chooses {
            let is_smoothed = is_noisy || samples.is_detail_misleading();
            let candidate = if is_smoothed {
                Candidate::CubicSmoothed
            } else {
                Candidate::Cubic
            };
            return Ok((candidate, Vec::new(), None));
        }
        let candidates: Vec<Candidate> = Candidate::ALL
            .into_iter()
            .filter(|c| options.allows(*c, samples))
            .collect();
        let scores = choice::scores(samples, &candidates)?;
        let stump = self.stump();
        let closing = stump
            .filter(|_| !choice::is_exact(&scores))
            .and_then(|_| tip::closing_candidate(&scores));
        let chosen = closing
            .or_else(|| choice::choose(&scores, is_noisy))
            .ok_or_else(|| {
                Error::geometry("the mesh round the hole is too small to predict a surface")
            })?;
        Ok((chosen, scores, stump))
    }

    fn stump(&self) -> Option<Stump> {
        let is_asked_for = self.task.options.methods.auto.tips;
        is_asked_for.then(|| tip::find_stump(self.task.hole))?
    }
}
