//! Whether a hole is the missing tip of a horn.
//!
//! Where the surface stands steeply on the plane of a small rim and closes in on the hole, what is missing is the end
//! of something long. Interpolating functions round such ends off too early; a quadric, fitted to a converging tube,
//! is an ellipsoid or a paraboloid and closes like one.

use super::Implicit;
use super::candidates::Candidate;
use super::choice::{Score, score_of};
use super::project::way_out;
use crate::hole::Hole;
use crate::math::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

/// Mean angle between the normals of the triangles at the rim and that of the rim's plane, at least.
const STEEP: f64 = 60.0 * std::f64::consts::PI / 180.0;
/// Spread of the rim across its plane over that along it, at most; coarse rims are ragged, and beyond this have no plane.
const FLAT: f64 = 0.5;
/// Edges of the rim, fewer than this: the end of something wide is no tip.
const SMALL: usize = 80;
/// Mean component of the normals towards the hole, at least: 0 is a tube of constant width, which has no tip to grow.
const CONVERGING: f64 = 0.08;

/// A surface that closes is used when its score is within this factor of the best of all but [`TOO_FREE`]: the rings
/// left out lie on the flank and say less about the tip than that it closes.
const TOLERANCE: f64 = 1.5;
/// The tip is further from the rim than any ring that was left out: surfaces with so much freedom bend on the way.
const TOO_FREE: [Candidate; 2] = [Candidate::Cyclide, Candidate::Torus];

/// The surface that closes a tip, if it predicts well: the quadric, or the cone where that has the better score.
pub(crate) fn closing_candidate(scores: &[Score]) -> Option<Candidate> {
    let best = scores
        .iter()
        .filter(|s| !TOO_FREE.contains(&s.0))
        .map(|s| s.1)
        .min_by(f64::total_cmp)?;
    let quadric = score_of(scores, Candidate::Quadric)?;
    let cone = score_of(scores, Candidate::Cone).filter(|&cone| cone < quadric);
    if quadric.min(cone.unwrap_or(quadric)) >= TOLERANCE * best {
        None
    } else if cone.is_some() {
        Some(Candidate::Cone)
    } else {
        Some(Candidate::Quadric)
    }
}

/// What is left of a horn whose tip may be missing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stump {
    /// The centroid of the rim.
    center: Vec3,
    /// Unit vector across the rim's plane, away from the surroundings.
    onwards: Vec3,
}

/// A missing tip on the surface that closes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tip {
    stump: Stump,
    /// From the centroid of the rim to the apex.
    height: f64,
}

/// Height of a tip in diameters of the rim, at least: lower than half a sphere it is a cap, which needs no help.
const LEAST_HEIGHT: f64 = 0.5;

impl Stump {
    /// The tip that the surface puts on the stump, if it has one up to `reach` above a rim of the diameter.
    pub(crate) fn tip_on(&self, surface: &dyn Implicit, diameter: f64, reach: f64) -> Option<Tip> {
        let height = way_out(surface, &self.center, &self.onwards, reach)?;
        (height > LEAST_HEIGHT * diameter).then_some(Tip {
            stump: *self,
            height,
        })
    }
}

impl Tip {
    /// Where a point goes that is to be at this share of the way up to the apex; higher ones stay.
    pub(crate) fn raised(&self, p: &Vec3, share: f64) -> Vec3 {
        let present = (p - self.stump.center).dot(&self.stump.onwards);
        p + f64::max(share * self.height - present, 0.0) * self.stump.onwards
    }
}

/// Judges by the rim, its normals and the direction in which the surroundings end.
pub(crate) fn find_stump(hole: &Hole) -> Option<Stump> {
    let (rim, around) = (hole.rim(), &hole.surroundings);
    let normals: Vec<Vec3> = hole.outside_normals.iter().flatten().copied().collect();
    if rim.len() >= SMALL || normals.is_empty() {
        return None;
    }
    let mean = |points: &mut dyn Iterator<Item = Vec3>| {
        let (mut sum, mut count) = (Vec3::zeros(), 0.0);
        points.for_each(|p| {
            sum += p;
            count += 1.0;
        });
        sum / f64::max(count, 1.0)
    };
    let center = mean(&mut rim.iter().copied());
    let behind = mean(
        &mut around
            .vertices_in(1..2)
            .into_iter()
            .map(|v| around.point(v)),
    );
    let mut spread = Matrix3::zeros();
    for p in rim {
        spread += (p - center) * (p - center).transpose();
    }
    if !spread.iter().all(|x| x.is_finite()) {
        return None;
    }
    let eigen = SymmetricEigen::new(spread);
    let across = eigen.eigenvalues.imin();
    let axis: Vec3 = eigen.eigenvectors.column(across).into();
    let count = normals.len() as f64;
    let angle = normals
        .iter()
        .map(|n| n.dot(&axis).abs().min(1.0).acos())
        .sum::<f64>()
        / count;
    let onwards = axis * (center - behind).dot(&axis).signum();
    let lean = normals.iter().map(|n| n.dot(&onwards)).sum::<f64>() / count;
    let is_stump = angle > STEEP
        && eigen.eigenvalues[across] < FLAT * FLAT * eigen.eigenvalues.max()
        && lean > CONVERGING;
    is_stump.then_some(Stump { center, onwards })
}
