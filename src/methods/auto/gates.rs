//! Checks whether a patch on a predicted surface is good enough to be used.
//!
//! The patch must be finite, stay near the hole, have few folded triangles, not be much larger than the faired patch,
//! and not meet the mesh at a sharp angle. Cost: O(n log n) for n triangles. Intersections are checked later, for the
//! patches of all methods.

use crate::error::{Error, Result};
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use crate::methods::task::Task;
use crate::patch::PatchSurface;

/// A triangle is folded if the cosine between its normal and the mean normal of its vertices is below this.
pub(super) const FOLDED: f64 = 0.2;
/// Upper bound on the share of folded triangles.
const FOLDED_SHARE: f64 = 0.03;
/// Fewer folded triangles than this are always allowed, in small patches too: that is, two.
const FOLDED_COUNT: f64 = 2.5;
/// The patch is bent at a rim edge if the cosine between its normal and the normal of the mesh is below this.
const BENT: f64 = 0.3;
/// Upper bound on the share of rim edges at which the patch is bent. A patch above it is used all the same if the
/// faired patch is bent at as many edges.
const BENT_SHARE: f64 = 0.1;

/// Upper bounds on the size of a patch.
struct Limits {
    /// Distance of a vertex from the middle of the rim, in diameters of the rim.
    reach: f64,
    /// Area of the patch, divided by the area of the faired patch.
    area_growth: f64,
}

const USUAL: Limits = Limits {
    reach: 3.0,
    area_growth: 8.0,
};

/// For the missing tips of horns.
const TIP: Limits = Limits {
    reach: TIP_REACH,
    area_growth: 40.0,
};

/// Upper bound on the distance of a tip from the middle of the rim, in diameters of the rim.
pub(super) const TIP_REACH: f64 = 6.0;

/// Checks a patch on a predicted surface against the faired one.
///
/// # Errors
/// [`crate::ErrorKind::Geometry`], with the reason, when the patch is not to be used; [`crate::ErrorKind::Cancelled`].
pub(super) fn check(
    task: &Task<'_>,
    patch: &PatchSurface,
    faired: &PatchSurface,
    is_tip: bool,
) -> Result<()> {
    let limits = if is_tip { &TIP } else { &USUAL };
    let (middle, diameter) = task.hole.middle_and_diameter();
    let reach = limits.reach * diameter;
    if patch.points.iter().any(|p| (p - middle).norm() > reach) {
        return Err(Error::geometry(
            "the predicted patch goes too far away from the hole",
        ));
    }
    if !patch.points.iter().flatten().all(|x| x.is_finite()) {
        return Err(Error::geometry("the predicted patch is not finite"));
    }
    let folded = folded_share(patch, task.job)?;
    let count = patch.triangles.len().max(1) as f64;
    if folded >= FOLDED_SHARE.max(FOLDED_COUNT / count) {
        return Err(Error::geometry("the predicted patch is folded"));
    }
    task.job.ask()?;
    if area(patch) > limits.area_growth * area(faired) {
        return Err(Error::geometry(
            "the predicted patch is far larger than the hole",
        ));
    }
    task.job.ask()?;
    let bent = bent_share(task, patch);
    task.job.ask()?;
    if bent > BENT_SHARE && bent > bent_share(task, faired) {
        return Err(Error::geometry(
            "the predicted patch is bent against the mesh along the rim",
        ));
    }
    Ok(())
}

/// The share of rim edges at which the patch is [`BENT`].
fn bent_share(task: &Task<'_>, patch: &PatchSurface) -> f64 {
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
    let polygon = &task.hole.polygon;
    let mut bent = 0.0;
    let mut count = 0.0;
    for (i, outside) in task.hole.outside_normals.iter().enumerate() {
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

fn area(patch: &PatchSurface) -> f64 {
    let double = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| &patch.points[v as usize]);
        cross_normal(a, b, c).norm()
    };
    patch.triangles.iter().map(double).sum::<f64>() / 2.0
}

/// The share of triangles that are [`FOLDED`]. Normals of vertices are weighted by the angles of their triangles.
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

/// The unit normal of a triangle.
pub(super) fn normal(patch: &PatchSurface, t: &[u32; 3]) -> Vec3 {
    let [a, b, c] = t.map(|v| &patch.points[v as usize]);
    unit(cross_normal(a, b, c))
}
