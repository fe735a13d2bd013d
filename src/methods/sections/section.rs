//! Steps 4 and 5: computes the plane and the two arcs of each section, and removes predicted points that cross a
//! neighboring section. `O(n + p)` for `n` sections and `p` points.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, sections 4.4 and 4.5, equations 11 to 16.

use super::arcs::Arc;
use super::base_points::{BasePoint, rim_direction};
use super::correspondences::Correspondence;
use super::options::SectionOptions;
use crate::error::{Error, Result};
use crate::math::{Vec3, unit};

/// Upper bound on the angle between the line of a section and the surface at its ends, in radians (150°). A steeper arc
/// would go almost once round its circle: the surface is a tube along the rim, and not a cap over the hole.
const STEEPEST: f64 = 2.62;

/// Upper bound on the sine of the angle between a section plane and the mean of the normals at its ends, 45°. A plane
/// that leans more does not cut the surface well.
const LEANING: f64 = 0.7;

/// The surface is tangent to the section plane if the sine of the angle between their normals is below this.
const TANGENT: f64 = 1e-3;

/// Lower bound on the distance of a predicted point from the planes of the sections before and after its own, in mean
/// edge lengths.
const CLEARANCE: f64 = 0.1;

/// Upper bound on the share of predicted points that are left out because their sections cross.
const MOST_CROSSING: f64 = 0.5;

/// A section before its points are predicted. The origin of its plane is the first base point. `x` points to the second
/// base point; `y` is perpendicular to it in the plane. `ahead` is the normal of the plane and points to the next
/// section.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Prepared {
    pub(crate) pair: Correspondence,
    pub(crate) origin: Vec3,
    pub(crate) x: Vec3,
    pub(crate) y: Vec3,
    pub(crate) ahead: Vec3,
    /// Distance between the base points.
    pub(crate) length: f64,
    /// The arc that is tangent to the surface at the first base point, and the one at the second.
    pub(crate) arcs: [Arc; 2],
    /// Number of points to predict.
    pub(crate) count: usize,
}

impl Prepared {
    /// The mean length of the two arcs.
    fn arc_length(&self) -> f64 {
        (self.arcs[0].arc_length() + self.arcs[1].arc_length()) / 2.0
    }

    /// The distance between predicted points.
    pub(crate) fn step(&self) -> f64 {
        self.arc_length() / (self.count + 1) as f64
    }
}

/// The predicted points of each section, in order from the first base point to the second.
pub(crate) type Predicted = Vec<Vec<Vec3>>;

/// A section with its predicted points.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) pair: Correspondence,
    pub(super) points: Vec<Vec3>,
    origin: Vec3,
    ahead: Vec3,
}

/// Prepares the section of each pair: its plane, its arcs, and its number of points. Pairs without a usable plane or
/// with too steep arcs get no section.
///
/// # Errors
/// [`ErrorKind::Geometry`] when the arcs of more than half of the sections are too steep; [`ErrorKind::Limit`] for more
/// than `most_points` points.
pub(super) fn prepare(
    base: &[BasePoint],
    pairs: &[Correspondence],
    edge_length: f64,
    most_points: usize,
    options: &SectionOptions,
) -> Result<Vec<Prepared>> {
    let mut sections = Vec::with_capacity(pairs.len());
    let mut out_of_reach = 0;
    for &pair in pairs {
        let Some(mut section) = frame(base, pair) else {
            continue;
        };
        let angles = angles(base, pair, &section);
        if angles.iter().any(|a| a.is_none_or(|a| a.abs() > STEEPEST)) {
            out_of_reach += 1;
            continue;
        }
        section.arcs = angles.map(|angle| Arc {
            length: section.length,
            angle: angle.unwrap_or(0.0),
        });
        sections.push(section);
    }
    if out_of_reach > pairs.len() / 2 {
        let message = format!(
            "the surface leaves {out_of_reach} of {} sections too steeply for an arc",
            pairs.len()
        );
        return Err(Error::geometry(message));
    }
    let longest = sections.iter().fold(0.0, |l: f64, s| l.max(s.arc_length()));
    // Equation 15.
    let most = (longest / (options.point_spacing * edge_length)).floor() + 1.0;
    let mut sum = 0_usize;
    for section in &mut sections {
        section.count = (section.arc_length() / longest * most).floor() as usize + 1;
        sum = sum.saturating_add(section.count);
    }
    if sum > most_points {
        let message = format!("the patch would need more than {most_points} new vertices");
        return Err(Error::limit(message));
    }
    Ok(sections)
}

/// The sections with their points. Points that are not between the neighboring sections are left out.
///
/// # Errors
/// [`ErrorKind::Geometry`] when more than half of the points are left out.
pub(super) fn assemble(
    prepared: &[Prepared],
    predicted: Predicted,
    edge_length: f64,
) -> Result<Vec<Section>> {
    let mut sections: Vec<Section> = prepared
        .iter()
        .zip(predicted)
        .map(|(section, points)| Section {
            pair: section.pair,
            points,
            origin: section.origin,
            ahead: section.ahead,
        })
        .collect();
    leave_out_crossing(&mut sections, edge_length)?;
    Ok(sections)
}

/// The plane of a section, equation 11. `None` when the neighboring pairs do not determine it, or when it leans too
/// much against the surface. This happens where the rim lies in a plane across the surface: then the plane of the
/// section is that of the rim.
fn frame(base: &[BasePoint], pair: Correspondence) -> Option<Prepared> {
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
    Some(Prepared {
        pair,
        origin: first,
        x: -unit(line),
        y: across,
        ahead,
        length: line.norm(),
        ..Prepared::default()
    })
}

/// The angles between the line of the section and the surface at its two ends, positive upward. `None` where the
/// surface is tangent to the section plane.
fn angles(base: &[BasePoint], pair: Correspondence, frame: &Prepared) -> [Option<f64>; 2] {
    [(pair.first, 1.0), (pair.second, -1.0)].map(|(k, inward)| {
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
                .atan2(inward * into_hole.dot(&frame.x)),
        )
    })
}

/// Leaves out the points that are not between the planes of the sections before and after their own.
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
        return Err(Error::geometry(message));
    }
    Ok(())
}
