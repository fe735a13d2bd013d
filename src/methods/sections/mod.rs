//! Fills a hole with curves that run across it from rim to rim. The methods `hpde`, `grey` and `nurbs` share this; they
//! differ only in how they predict the points of the curves.
//!
//! First, pairs of rim points that face each other across the hole are chosen. Each pair defines a plane. In this
//! plane, a curve from one point to the other is predicted; this curve is a section. The points of all sections are
//! triangulated together in a plane. Then the patch is smoothed, short edges are collapsed, and edges are swapped for
//! better angles.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013. The files follow its seven steps. `docs/methods/hpde.md` lists the differences from
//! the paper, with reasons.
//!
//! Not guaranteed: that a hole can be patched. Holes with islands, sections that cross, surfaces that leave the rim too
//! steeply, and patches that fold are refused with a reason. Triangles that are not neighbors may intersect; the caller
//! must check that.

pub(crate) mod arcs;
mod base_points;
mod correspondences;
mod inside;
mod layout;
mod optimize;
pub(crate) mod options;
mod outside;
mod rim;
mod section;
mod segmentation;
mod smoothing;

pub(super) use base_points::BasePoint;
pub(super) use outside::{Known, Outside};
pub(super) use section::{Predicted, Prepared};

use super::task::Task;
use crate::error::{Error, ErrorKind, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::adjacency::CompressedRows;
use crate::patch::PatchSurface;
use crate::surroundings::Surroundings;
use crate::surroundings::fits::QuadricFits;
use crate::triangulate::planar::triangulate_planar_region;
use base_points::base_points;
use correspondences::{best_start, pairs, start_of_cut};
use inside::Inside;
use layout::{Layout, Scene};
use optimize::Editor;
use options::{SectionOptions, SectionProjection, SectionTangents};
use rim::{Rim, check_simple, edge_normals, mean_edge_length};
use section::{Section, assemble, prepare};
use smoothing::smooth;
use std::borrow::Cow;

/// Rings of known triangles that are read. A normal is fitted to two rings of neighbors, or to more where there are
/// few.
pub(super) const RING_COUNT: u32 = 3;

/// Two neighboring triangles are a fold if the cosine of the angle between their normals is below this, that is, above
/// 120°.
const FOLDED: f64 = -0.5;

/// Upper bound on the share of predicted points that lie outside the rim in the plane. A jagged rim has some.
const MOST_OUTSIDE: f64 = 0.2;

/// Upper bound on the rounds of leaving out the points at which the patch folds, and triangulating the others again.
const MOST_ROUNDS: usize = 12;

/// Predicts the points of all sections.
pub(super) type Curves<'a> = dyn Fn(&[BasePoint], &[Prepared]) -> Result<Predicted> + 'a;

/// All steps of the paper but the prediction of points, which `curves` does.
///
/// # Errors
/// [`ErrorKind::Topology`] and [`ErrorKind::Geometry`] for holes out of the method's reach, with the reason;
/// [`ErrorKind::Limit`]; those of `curves`; [`ErrorKind::Cancelled`].
///
/// # Complexity
/// `O(n² + p)` for `n` base points and `p` predicted points, besides the prediction.
pub(super) fn patch_along(
    task: &Task<'_>,
    options: &SectionOptions,
    curves: &Curves<'_>,
) -> Result<PatchSurface> {
    let (hole, job) = (task.hole, task.job);
    let most_points = task.options.refinement.max_vertices;
    check_simple(hole)?;
    let rim = read_rim(hole, options, job)?;
    let mut base = base_points(&rim, options.base_spacing);
    let n = base.len();
    // Step 3: rotate the base points so that points `i` and `n - 1 - i` are partners. `fold` is the first section on
    // the second plane, if the rim is seen as two parts.
    let mut fold = None;
    if n > 0 {
        let start = match segmentation::cut(&base, options.segment_angle) {
            Some(cut) => {
                let start = start_of_cut(n, cut.first, cut.second);
                let at = (cut.first + n - start % n) % n;
                fold = Some(at.min(n - 1 - at));
                start
            }
            None => best_start(&base, job)?,
        };
        base.rotate_left(start);
    }
    let smallest_sine = options.skip_angle.to_radians().sin();
    let mut pairs = pairs(&base, smallest_sine);
    // A section along an edge of the rim has no points.
    pairs.retain(|p| {
        let (first, second) = (base[p.first].arc, base[p.second].arc);
        rim.has_vertex_between(first, second) && rim.has_vertex_between(second, first)
    });
    let prepared = prepare(&base, &pairs, rim.edge_length, most_points, options)?;
    let predicted = curves(&base, &prepared)?;
    let sections = assemble(&prepared, predicted, rim.edge_length)?;
    let scene = Scene {
        rim: &rim,
        base: &base,
        sections: &sections,
    };
    let on_planes = || match fold {
        Some(fold) => scene.on_two_planes(fold),
        None => Ok(scene.on_one_plane()),
    };
    let finish = |layout: Layout| finish(hole, &rim, &sections, &layout, options, job);
    let planes = || on_planes().and_then(finish);
    let unrolled = || finish(scene.side_by_side(false));
    let straight = || finish(scene.side_by_side(true));
    let layouts: &[&dyn Fn() -> Result<PatchSurface>] = match options.projection {
        SectionProjection::Auto => &[&planes, &unrolled, &straight],
        SectionProjection::Planes => &[&planes],
        SectionProjection::Sections => &[&unrolled, &straight],
    };
    let mut reason = None;
    for layout in layouts {
        match layout() {
            Ok(patch) => return Ok(patch),
            Err(error) if error.kind() == ErrorKind::Cancelled => return Err(error),
            // The first layout is that of the paper; its error is reported.
            Err(error) => reason = reason.or(Some(error)),
        }
    }
    Err(reason.unwrap_or_else(|| folded(0)))
}

/// The rim, with normals. On request it is smoothed, together with its surroundings.
fn read_rim(hole: &Hole, options: &SectionOptions, job: &Job<'_>) -> Result<Rim> {
    let mut seen = Cow::Borrowed(hole);
    if options.denoise > 0 {
        seen.to_mut().surroundings = denoised(hole, options.denoise, job)?;
    }
    let normals = match options.tangents {
        SectionTangents::Chord => None,
        SectionTangents::Jet => {
            job.ask()?;
            Some(QuadricFits::new(&seen.surroundings, job)?.normals_at_rim(job)?)
        }
    };
    let in_order = |values: &[Vec3]| -> Vec<Vec3> {
        let polygon = seen.polygon.iter();
        polygon.map(|&v| values[v as usize]).collect()
    };
    Ok(Rim::new(
        in_order(seen.rim()),
        edge_normals(&seen)?,
        normals.map(|n| in_order(&n)),
        mean_edge_length(&seen),
    ))
}

/// Smooths the rim along itself, and the rings round it except the outermost vertices.
fn denoised(hole: &Hole, steps: usize, job: &Job<'_>) -> Result<Surroundings> {
    let around = &hole.surroundings;
    let (rim_count, levels) = (hole.rim().len(), around.levels());
    let m = hole.polygon.len();
    let mut points = around.points().to_vec();
    let along = (0..m).map(|i| [hole.polygon[i], hole.polygon[(i + 1) % m]]);
    let rim = CompressedRows::neighbors(along, points.len());
    let outermost = levels.iter().copied().max().unwrap_or(0);
    let is_inner = |v: usize| v >= rim_count && levels[v] < outermost;
    smooth(&mut points, &rim, |v| v < rim_count, steps);
    smooth(&mut points, around.neighbors(job)?, is_inner, steps);
    Ok(around.moved(points))
}

/// Steps 6 and 7: triangulates the points of a layout, then smooths and optimizes the patch.
fn finish(
    hole: &Hole,
    rim: &Rim,
    sections: &[Section],
    layout: &Layout,
    options: &SectionOptions,
    job: &Job<'_>,
) -> Result<PatchSurface> {
    let mut editor = triangulated(hole, sections, layout, job)?;
    let m = hole.rim().len();
    if options.smoothing {
        let triangles: Vec<[u32; 3]> = editor.triangles().collect();
        let points = editor.points_mut();
        let neighbors = CompressedRows::corners(&triangles, points.len()).sorted();
        smooth(points, &neighbors, |v| v >= m, options.smoothing_steps);
    }
    editor.collapse_short(options.shortest_edge * rim.edge_length);
    editor.swap_edges(job)?;
    match editor.folds(FOLDED).len() {
        0 => Ok(editor.finish()),
        count => Err(folded(count)),
    }
}

/// The constrained triangulation of the layout. Points at which it folds are left out.
fn triangulated<'a>(
    hole: &'a Hole,
    sections: &[Section],
    layout: &Layout,
    job: &Job<'_>,
) -> Result<Editor<'a>> {
    let m = hole.rim().len();
    let mut predicted: Vec<(Vec3, [f64; 2])> = sections
        .iter()
        .flat_map(|s| s.points.iter().copied())
        .zip(layout.inside.iter().copied())
        .filter_map(|(point, place)| Some((point, place?)))
        .collect();
    let inside = Inside::new(&layout.rim);
    let all = predicted.len();
    predicted.retain(|p| inside.contains(p.1));
    let outside = all - predicted.len();
    if outside as f64 > MOST_OUTSIDE * all as f64 {
        let message = format!(
            "the projection is not one to one: {outside} of {all} predicted points fall outside the rim"
        );
        return Err(Error::geometry(message));
    }
    for _ in 0..MOST_ROUNDS {
        let inside: Vec<[f64; 2]> = predicted.iter().map(|p| p.1).collect();
        let triangles = triangulate_planar_region(&[&layout.rim], &inside, job)?;
        // The rim of the layout is in the order of the polygon.
        let number = |v: u32| hole.polygon.get(v as usize).copied().unwrap_or(v);
        let mut points = hole.rim().to_vec();
        points.extend(predicted.iter().map(|p| p.0));
        let surface = PatchSurface {
            rim_count: m,
            points,
            triangles: triangles.into_iter().map(|t| t.map(number)).collect(),
        };
        let mut editor = Editor::new(surface, hole)?;
        editor.swap_edges(job)?;
        editor.unfold(FOLDED);
        let folds = editor.folds(FOLDED);
        let mut is_left_out = vec![false; predicted.len()];
        for v in folds.iter().flatten() {
            if let Some(index) = (*v as usize).checked_sub(m) {
                // Points after the predicted ones were made by splitting an edge.
                if let Some(left_out) = is_left_out.get_mut(index) {
                    *left_out = true;
                }
            }
        }
        if !is_left_out.contains(&true) {
            // The remaining folds have no predicted point. Smoothing may remove them.
            return Ok(editor);
        }
        let mut left_out = is_left_out.into_iter();
        predicted.retain(|_| left_out.next() == Some(false));
    }
    Err(folded(0))
}

fn folded(count: usize) -> Error {
    let message = format!("the patch is folded along {count} edges");
    Error::geometry(message)
}
