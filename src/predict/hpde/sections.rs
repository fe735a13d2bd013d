//! Steps 4 and 5: the section planes and the points predicted on them.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, sections 4.4 and 4.5, equations 11 to 16.

use super::arcs::{Arc, profile};
use super::base_points::{BasePoint, rim_direction};
use super::correspondences::Pair;
use super::evolution::evolve;
use super::options::{HpdeOptions, HpdeSolver};
use crate::error::{Error, ErrorKind, Result, proceed_unless};
use crate::math::random::seeded;
use crate::math::{Vec3, unit};

/// Arcs that rise or fall more steeply than this at their ends, in radians, go almost once round their circle:
/// the surface is a tube along the rim and no cap between its sides.
const STEEPEST: f64 = 2.62;

/// The section plane stands on the surface unless the sine of the angle between the plane and the mean of the normals
/// at its ends is above this: 45°.
const LEANING: f64 = 0.7;

/// A surface is tangent to the section plane when the sine of the angle between their normals is below this.
const TANGENT: f64 = 1e-3;

/// Part of the mean edge length by which a point must be ahead of the section behind it, and behind the one ahead.
const CLEARANCE: f64 = 0.1;

/// Part of the predicted points that may be left out because their sections cross.
const MOST_CROSSING: f64 = 0.5;

/// The plane of a section: the origin is the first base point, `x` points to the second one.
#[derive(Clone, Copy, Debug)]
struct Frame {
    origin: Vec3,
    x: Vec3,
    y: Vec3,
    /// The plane's normal, which points on to the next sections.
    ahead: Vec3,
    length: f64,
}

/// The points predicted between two base points, in order.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) pair: Pair,
    pub(super) points: Vec<Vec3>,
    origin: Vec3,
    ahead: Vec3,
}

/// Predicts the points between all pairs.
///
/// # Errors
/// [`ErrorKind::Geometry`] when the arcs of most sections are out of reach or most sections cross;
/// [`ErrorKind::Limit`] for more than `most_points`; [`ErrorKind::Cancelled`].
pub(super) fn predict_sections(
    base: &[BasePoint],
    pairs: &[Pair],
    edge_length: f64,
    most_points: usize,
    options: &HpdeOptions,
    context: &Context<'_>,
) -> Result<Vec<Section>> {
    let mut ready = Vec::with_capacity(pairs.len());
    let mut out_of_reach = 0;
    for &pair in pairs {
        let Some(frame) = frame(base, pair) else {
            continue;
        };
        let angles = angles(base, pair, &frame);
        if angles.iter().any(|a| a.is_none_or(|a| a.abs() > STEEPEST)) {
            out_of_reach += 1;
            continue;
        }
        let arcs = angles.map(|angle| Arc {
            length: frame.length,
            angle: angle.unwrap_or(0.0),
        });
        ready.push((pair, frame, arcs));
    }
    if out_of_reach > pairs.len() / 2 {
        let message = format!(
            "the surface leaves {out_of_reach} of {} sections too steeply for an arc",
            pairs.len()
        );
        return Err(Error::new(ErrorKind::Geometry, message));
    }
    let length = |arcs: &[Arc; 2]| (arcs[0].arc_length() + arcs[1].arc_length()) / 2.0;
    let longest = ready.iter().fold(0.0, |l: f64, r| l.max(length(&r.2)));
    // Equation 15.
    let most = (longest / (options.point_spacing * edge_length)).floor() + 1.0;
    let counts: Vec<usize> = ready
        .iter()
        .map(|r| (length(&r.2) / longest * most).floor() as usize + 1)
        .collect();
    if counts
        .iter()
        .fold(0, |sum: usize, &c| sum.saturating_add(c))
        > most_points
    {
        let message = format!("the patch would need more than {most_points} new vertices");
        return Err(Error::new(ErrorKind::Limit, message));
    }
    let mut sections = Vec::with_capacity(ready.len());
    for ((k, (pair, frame, arcs)), &count) in (0_u64..).zip(&ready).zip(&counts) {
        let profile = profile(&arcs[0], &arcs[1], count);
        let heights = match options.solver {
            HpdeSolver::Direct => profile.start.clone(),
            HpdeSolver::De => {
                let mut random = seeded(context.seed, k);
                evolve(&profile, options, &mut random, context.interrupted)?.values
            }
        };
        proceed_unless(context.interrupted)?;
        let points = profile.x.iter().zip(&heights);
        sections.push(Section {
            pair: *pair,
            points: points
                .map(|(x, y)| frame.origin + frame.x * *x + frame.y * *y)
                .collect(),
            origin: frame.origin,
            ahead: frame.ahead,
        });
    }
    leave_out_crossing(&mut sections, edge_length)?;
    Ok(sections)
}

/// What the prediction needs besides geometry.
pub(super) struct Context<'a> {
    pub(super) seed: u64,
    pub(super) interrupted: &'a dyn Fn() -> bool,
}

/// Equation 11. `None` where the neighbouring pairs do not say where the section goes, or where its plane lies along
/// the surface: where the rim ends in a plane across the surface, all lines between its points are in that plane.
fn frame(base: &[BasePoint], pair: Pair) -> Option<Frame> {
    let n = base.len();
    let at = |k: usize| base[k % n].position;
    let (first, second) = (at(pair.first), at(pair.second));
    let line = first - second;
    let behind = (at(pair.first + n - 1) + at(pair.second + 1)) / 2.0;
    let beyond = (at(pair.first + 1) + at(pair.second + n - 1)) / 2.0;
    let across = unit(line.cross(&(behind - beyond)));
    let ahead = unit(line.cross(&across));
    let normal = unit(base[pair.first].normal + base[pair.second].normal);
    if ahead == Vec3::zeros() || normal.dot(&ahead).abs() > LEANING {
        return None;
    }
    Some(Frame {
        origin: first,
        x: -unit(line),
        y: across,
        ahead,
        length: line.norm(),
    })
}

/// The angles at which the surface leaves the section's line at its two ends, both measured upwards and inwards.
fn angles(base: &[BasePoint], pair: Pair, frame: &Frame) -> [Option<f64>; 2] {
    [(pair.first, 1.0), (pair.second, -1.0)].map(|(k, inwards)| {
        let BasePoint { normal, .. } = base[k];
        let rim = rim_direction(base, k);
        let tangent = normal.cross(&frame.ahead);
        if tangent.norm() < TANGENT {
            return None;
        }
        // The patch lies to the left of the rim.
        let into_hole = normal.cross(&rim).dot(&tangent).signum() * tangent;
        Some(
            into_hole
                .dot(&frame.y)
                .atan2(inwards * into_hole.dot(&frame.x)),
        )
    })
}

/// Leaves out the points that are not between the section before and the one after theirs.
fn leave_out_crossing(sections: &mut [Section], edge_length: f64) -> Result<()> {
    let clearance = CLEARANCE * edge_length;
    let planes: Vec<(Vec3, Vec3)> = sections.iter().map(|s| (s.origin, s.ahead)).collect();
    let (mut all, mut left) = (0, 0);
    for (k, section) in sections.iter_mut().enumerate() {
        let before = k.checked_sub(1).map(|k| planes[k]);
        let after = planes.get(k + 1);
        all += section.points.len();
        section.points.retain(|p| {
            let is_ahead = before.is_none_or(|(o, ahead)| (p - o).dot(&ahead) > clearance);
            let is_behind = after.is_none_or(|(o, ahead)| (p - o).dot(ahead) < -clearance);
            is_ahead && is_behind
        });
        left += section.points.len();
    }
    let crossing = all - left;
    if crossing as f64 > MOST_CROSSING * all as f64 {
        let message =
            format!("the section planes cross: {crossing} of {all} points are out of order");
        return Err(Error::new(ErrorKind::Geometry, message));
    }
    Ok(())
}
