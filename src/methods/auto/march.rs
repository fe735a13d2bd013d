//! Moves a patch onto a predicted surface.
//!
//! Interior vertices take short Newton steps toward the surface. The patch is refined after each round of steps,
//! because it grows. Places where it folds are smoothed. At the end the offsets of the rim from the surface are
//! extended over the interior and added there, so that the patch meets the rim.
//!
//! Cost: some ten evaluations of the surface for each new vertex and round; the blend is one sparse linear system. Not
//! guaranteed: that the patch reaches the right sheet of the surface. [`check`] rejects most patches that do not.

use super::gates::{FOLDED, check, normal};
use super::surface::Implicit;
use super::surface::project::project;
use super::surface::tip::Tip;
use crate::error::{Error, Result};
use crate::fair::kharmonic::{extend_from_rim, extend_with_slope};
use crate::math::sparse::SpdSolver;
use crate::math::{Vec3, unit};
use crate::methods::start::refine_again;
use crate::methods::task::Task;
use crate::patch::PatchSurface;

/// Upper bound on the rounds of moving and refining.
const MOST_ROUNDS: usize = 5;
/// Newton steps of a vertex in each round.
const STEPS: usize = 10;
/// Newton steps of a vertex after the last round, and of the points that measure offsets.
const LAST_STEPS: usize = 6;
/// Longest Newton step, in diameters of the rim.
const LONGEST_STEP: f64 = 0.05;
/// The rounds end when no vertex moved further than `SETTLED_MOVE` (in mean rim edge lengths) and the number of
/// triangles changed by less than the share `SETTLED_GROWTH`.
const SETTLED_MOVE: f64 = 0.02;
const SETTLED_GROWTH: f64 = 0.01;
/// A start patch with fewer interior vertices than this cannot take the shape of a tip. It is refined first.
const FEWEST_INTERIOR: usize = 3;
/// Factor on the target edge lengths while a start patch for a tip is refined.
const FINER_TIP: f64 = 0.6;
/// Factor on the target edge lengths while a start patch without interior vertices is refined. Refinement splits an
/// edge only above 1.75 target lengths. A hole with the rim of a regular pentagon is often one missing vertex, but the
/// diagonals of the pentagon have only 1.62 sides.
const FINER_RIM: f64 = 0.8;

/// Upper bound on the rounds of smoothing folded places, each time that folds are searched.
const MOST_UNFOLDINGS: usize = 20;

/// Moves patches onto a surface.
pub(super) struct Marcher<'a> {
    /// The hole to fill. For a piece of a hole between creases, the piece.
    pub(super) task: &'a Task<'a>,
    pub(super) surface: &'a dyn Implicit,
    /// Mean edge length at the rim.
    pub(super) step: f64,
    pub(super) tip: Option<Tip>,
    /// Whether the offsets of the rim are continued with their slope. True where they are detail and not noise.
    pub(super) joins_with_slope: bool,
}

impl Marcher<'_> {
    /// Moves `patch` onto the surface and checks the result against the patch `faired`. `sizes` are the target edge
    /// lengths of the patch's vertices, or of its rim vertices only.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Geometry`] when a vertex goes to infinity or the patch fails [`check`]; those of refinement
    /// and of the linear solver; [`crate::ErrorKind::Cancelled`].
    pub(super) fn patch(
        &self,
        mut patch: PatchSurface,
        mut sizes: Vec<f64>,
        faired: &PatchSurface,
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
            refine_again(self.task, &mut patch, &mut sizes)?;
            sizes.iter_mut().for_each(|s| *s /= finer);
        }
        let (_, diameter) = self.task.hole.middle_and_diameter();
        if let Some(tip) = &self.tip {
            self.raise(&mut patch, tip)?;
            refine_again(self.task, &mut patch, &mut sizes)?;
        }
        let limit = LONGEST_STEP * diameter;
        for _ in 0..MOST_ROUNDS {
            let longest = self.project(&mut patch.points[rim_count..], STEPS, limit)?;
            if !patch.points.iter().flatten().all(|x| x.is_finite()) {
                return Err(Error::geometry(
                    "the patch diverged from the predicted surface",
                ));
            }
            self.unfold(&mut patch, limit)?;
            let before = patch.triangles.len() as f64;
            refine_again(self.task, &mut patch, &mut sizes)?;
            let growth = (patch.triangles.len() as f64 - before).abs() / before;
            if longest < SETTLED_MOVE * self.step && growth < SETTLED_GROWTH {
                break;
            }
        }
        self.project(&mut patch.points[rim_count..], LAST_STEPS, limit)?;
        self.unfold(&mut patch, limit)?;
        self.blend(&mut patch, limit)?;
        check(self.task, &patch, faired, self.tip.is_some())?;
        Ok(patch)
    }

    /// Raises the patch to a cone with the apex of the tip. From a flat patch, steps along the gradients of a steep
    /// surface would lead sideways.
    fn raise(&self, patch: &mut PatchSurface, tip: &Tip) -> Result<()> {
        let (rim, interior) = patch.points.split_at_mut(patch.rim_count);
        let to_rim = |p: &Vec3| {
            let distances = rim.iter().map(|q| (p - q).norm());
            distances.fold(f64::INFINITY, f64::min)
        };
        let mut distances = Vec::with_capacity(interior.len());
        for p in interior.iter() {
            self.task.job.tick(rim.len() / 16)?;
            distances.push(to_rim(p));
        }
        let farthest = distances.iter().copied().fold(0.0, f64::max);
        for (p, distance) in interior.iter_mut().zip(&distances) {
            *p = tip.raised(p, distance / farthest);
        }
        Ok(())
    }

    /// Moves the points onto the surface and returns the longest distance that one moved.
    fn project(&self, points: &mut [Vec3], steps: usize, limit: f64) -> Result<f64> {
        let mut longest: f64 = 0.0;
        for p in points {
            self.task.job.tick(500)?;
            let moved = project(self.surface, p, steps, limit);
            longest = longest.max((moved - *p).norm());
            *p = moved;
        }
        Ok(longest)
    }

    /// Smooths the patch where its triangles are turned against the surface, and moves it back onto the surface.
    fn unfold(&self, patch: &mut PatchSurface, limit: f64) -> Result<()> {
        let gradient = |p: &Vec3| unit(self.surface.value_and_gradient(p).1);
        let mut gradients = Vec::with_capacity(patch.points.len());
        for p in &patch.points {
            self.task.job.tick(100)?;
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
            self.task.job.ask()?;
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
                    patch.points[v] = project(self.surface, &middle, STEPS, limit);
                    gradients[v] = gradient(&patch.points[v]);
                }
            }
        }
        Ok(())
    }

    /// Extends the offsets of the rim from the surface over the interior, and adds them there.
    fn blend(&self, patch: &mut PatchSurface, limit: f64) -> Result<()> {
        let rim_count = patch.rim_count;
        if patch.points.len() == rim_count {
            return Ok(());
        }
        let at_rim = self.offsets(&patch.points[..rim_count], limit)?;
        let mut solver = SpdSolver::new(self.task.job);
        let extended = if self.joins_with_slope {
            let surroundings = &self.task.hole.surroundings;
            // The slope depends on the first ring only.
            let first = surroundings.vertices_in(1..2);
            let points: Vec<Vec3> = first.iter().map(|&v| surroundings.point(v)).collect();
            let mut around = vec![Vec3::zeros(); surroundings.outer().len()];
            for (v, offset) in first.into_iter().zip(self.offsets(&points, limit)?) {
                around[v as usize - rim_count] = offset;
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

    /// The vectors from the surface to the points.
    fn offsets(&self, points: &[Vec3], limit: f64) -> Result<Vec<Vec3>> {
        let mut projected = points.to_vec();
        self.project(&mut projected, LAST_STEPS, limit)?;
        Ok(points.iter().zip(&projected).map(|(p, q)| p - q).collect())
    }
}
