//! Recognizes a hole that is the missing tip of a horn, and finds the height of the tip.
//!
//! A hole is a tip if its rim is small and nearly planar, the mesh is steep against the plane of the rim, and it
//! converges toward the hole. An interpolating function would close such a hole too early. A quadric fitted to a
//! converging tube is an ellipsoid, a paraboloid or a cone, and has a tip. So the quadric or the cone is used if its
//! score allows it.
//!
//! Cost: linear in the number of vertices round the hole. Not guaranteed: that every tip is recognized.

use super::Implicit;
use super::candidates::Candidate;
use super::choice::{Score, score_of};
use super::project::way_out;
use crate::hole::Hole;
use crate::math::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

/// Lower bound on the mean angle, in radians, between the normals of the triangles at the rim and the normal of the
/// rim's plane.
const STEEP: f64 = 60.0 * std::f64::consts::PI / 180.0;
/// Upper bound on the spread of the rim vertices across their plane, divided by their largest spread. It is large
/// because coarse rims are ragged.
const FLAT: f64 = 0.5;
/// A rim with at least this number of edges is not the rim of a tip.
const SMALL: usize = 80;
/// Lower bound on the mean component of the normals in the direction of the hole. It is 0 for a tube of constant width,
/// which has no tip.
const CONVERGING: f64 = 0.08;

/// A surface that closes is used if its score is within this factor of the best score of all candidates but
/// [`TOO_FREE`]. A worse score is accepted because the rings that were left out lie on the flank, and say little about
/// the tip.
const TOLERANCE: f64 = 1.5;
/// Candidates that are not used for a tip. The tip is further from the rim than any ring that was left out, and
/// surfaces with many degrees of freedom bend on the way.
const TOO_FREE: [Candidate; 2] = [Candidate::Cyclide, Candidate::Torus];

/// The candidate that closes a tip, if its score allows it: the quadric, or the cone if its score is better.
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

/// What is left of a horn whose tip is missing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stump {
    /// The centroid of the rim.
    center: Vec3,
    /// Unit normal of the rim's plane, away from the surroundings.
    onward: Vec3,
}

/// A missing tip on the surface that closes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tip {
    stump: Stump,
    /// Distance from the centroid of the rim to the apex.
    height: f64,
}

/// Lower bound on the height of a tip, in diameters of the rim. Half a sphere has 0.5; a lower cap needs no special
/// treatment.
const LEAST_HEIGHT: f64 = 0.5;

impl Stump {
    /// The tip that the surface puts on the stump; `None` if its apex is lower than [`LEAST_HEIGHT`] or higher than
    /// `reach`. `diameter` is that of the rim.
    pub(crate) fn tip_on(&self, surface: &dyn Implicit, diameter: f64, reach: f64) -> Option<Tip> {
        let height = way_out(surface, &self.center, &self.onward, reach)?;
        (height > LEAST_HEIGHT * diameter).then_some(Tip {
            stump: *self,
            height,
        })
    }
}

impl Tip {
    /// The point, raised to the given share of the height of the tip. A point that is higher stays.
    pub(crate) fn raised(&self, p: &Vec3, share: f64) -> Vec3 {
        let present = (p - self.stump.center).dot(&self.stump.onward);
        p + f64::max(share * self.height - present, 0.0) * self.stump.onward
    }
}

/// The stump round the hole; `None` if the hole is not the missing tip of a horn.
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
    let onward = axis * (center - behind).dot(&axis).signum();
    let lean = normals.iter().map(|n| n.dot(&onward)).sum::<f64>() / count;
    let is_stump = angle > STEEP
        && eigen.eigenvalues[across] < FLAT * FLAT * eigen.eigenvalues.max()
        && lean > CONVERGING;
    is_stump.then_some(Stump { center, onward })
}
