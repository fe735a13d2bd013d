//! Fills the chosen holes of a mesh: plans in parallel on the unchanged mesh, then stitches in order.

use super::options::FillOptions;
use super::plan::{Failure, Plan, Planner, chain};
use super::progress::{Progress, ProgressCallback};
use super::report::{FillReport, HoleReport, HoleStatus};
use super::stitch::Stitcher;
use crate::boundary::classify::LoopClass;
use crate::boundary::loops::{BoundaryLoop, BoundaryLoops};
use crate::boundary::select::Selection;
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::connectivity::{BOUNDARY, origin, target};
use crate::mesh::trimesh::TriMesh;
use crate::quality::Surface;
use crate::quality::spatial::FaceIndex;
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Fills the holes of `mesh` that `selection` chooses among the loops in `boundary`.
///
/// New vertices and triangles are appended in the order of the loops; everything that was in the mesh
/// stays bit for bit and keeps its index. New triangles are oriented like those round their hole. A hole
/// that cannot be filled is left as it was, with the reason in its report, and the others are still filled.
/// Every patch is checked: manifold, oriented, without degenerate or duplicate triangles, and tested for
/// intersections with itself, with the mesh and with the other patches; if it fails, simpler methods are
/// tried in turn (see [`FillOptions::fallback`]).
///
/// `boundary` must be [`BoundaryLoops::find`] of this mesh as it is; afterwards it describes the mesh
/// before the fill.
///
/// Not guaranteed: that a patch has no intersections at all. When every method's patch has some, the one with
/// the fewest is used and [`HoleReport::self_intersections`] says how many remain.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] when the selection names an edge that is on no loop, when `boundary` is not that
/// of `mesh`, when an option is out of its range, or when the thread pool cannot be made. The mesh is then
/// unchanged. What goes wrong with a single hole is not an error of the call.
///
/// # Complexity
/// One pass over the mesh for the index of the intersection tests, then each hole by itself: about
/// `k^1.5` for `k` new vertices.
pub fn fill_holes(
    mesh: &mut TriMesh,
    boundary: &BoundaryLoops,
    selection: &Selection,
    options: &FillOptions,
    progress: Option<ProgressCallback<'_>>,
) -> Result<FillReport> {
    options.check()?;
    check_boundary(mesh, boundary)?;
    let kept = selection.reasons_to_keep(boundary)?;
    let holes = group_holes(boundary, &kept, options);
    let mut report = FillReport {
        holes: boundary
            .loops
            .iter()
            .zip(&kept)
            .map(|(l, k)| blank_report(l, k))
            .collect(),
        ..FillReport::default()
    };
    if holes.is_empty() {
        return Ok(report);
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| {
            let message = format!("cannot start {} threads: {e}", options.threads);
            Error::new(ErrorKind::Limit, message)
        })?;
    let start = Instant::now();
    let surface = Surface {
        points: mesh.points(),
        triangles: mesh.triangles(),
    };
    let faces = pool.install(|| FaceIndex::build(surface));
    report.index_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let meter = Meter::new(holes.len(), progress);
    let interrupted = || meter.is_cancelled();
    let planner = Planner {
        mesh,
        faces: &faces,
        options,
        interrupted: &interrupted,
    };
    let methods = chain(options);
    let plan = |hole: &HoleLoops<'_>| {
        let start = Instant::now();
        let outcome = if meter.is_cancelled() {
            Err(Failure {
                error: Error::cancelled(),
                tried: Vec::new(),
            })
        } else {
            planner.plan(hole.outer, &hole.islands, &methods)
        };
        meter.advance();
        (outcome, start.elapsed().as_secs_f64())
    };
    // One thread is the caller's own: its memory is warm, and callbacks come from where the call came.
    let planned: Vec<(std::result::Result<Plan, Failure>, f64)> = if options.threads == 1 {
        holes.iter().map(plan).collect()
    } else {
        pool.install(|| holes.par_iter().with_max_len(1).map(plan).collect())
    };
    let plans: Vec<Option<&Plan>> = planned.iter().map(|(p, _)| p.as_ref().ok()).collect();
    let mut stitcher = Stitcher::new(mesh, &faces, options, &interrupted, &plans);
    for (i, (hole, (plan, seconds))) in holes.iter().zip(planned).enumerate() {
        let start = Instant::now();
        let outcome = stitcher.stitch(i, hole, plan);
        let seconds = seconds + start.elapsed().as_secs_f64();
        for l in std::iter::once(&hole.outer).chain(&hole.islands) {
            outcome.record(&mut report.holes[l.id], hole.outer.id, seconds);
        }
    }
    report.fill_seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

/// A hole to fill: a loop and the loose sheets inside it.
pub(super) struct HoleLoops<'a> {
    pub(super) outer: &'a BoundaryLoop,
    pub(super) islands: Vec<&'a BoundaryLoop>,
}

/// The holes to fill: every chosen loop, islands together with the loop that they lie in.
fn group_holes<'a>(
    boundary: &'a BoundaryLoops,
    kept: &[Option<String>],
    options: &FillOptions,
) -> Vec<HoleLoops<'a>> {
    let is_chosen =
        |id: usize| kept[id].is_none() && unfillable_reason(boundary.loops[id].class).is_none();
    let host_of = |l: &BoundaryLoop| {
        l.host.filter(|&host| {
            options.join_islands && is_chosen(host) && boundary.loops[host].host.is_none()
        })
    };
    let mut holes: Vec<HoleLoops<'a>> = boundary
        .loops
        .iter()
        .filter(|l| is_chosen(l.id) && host_of(l).is_none())
        .map(|outer| HoleLoops {
            outer,
            islands: Vec::new(),
        })
        .collect();
    for island in boundary.loops.iter().filter(|l| is_chosen(l.id)) {
        if let Some(host) = host_of(island)
            && let Ok(i) = holes.binary_search_by_key(&host, |h| h.outer.id)
        {
            holes[i].islands.push(island);
        }
    }
    holes
}

fn unfillable_reason(class: LoopClass) -> Option<&'static str> {
    match class {
        LoopClass::NotOriented => Some("the triangles along the loop are not oriented alike"),
        LoopClass::OpenChain => {
            Some("the boundary does not close: it runs into an edge with more than two triangles")
        }
        _ => None,
    }
}

fn blank_report(l: &BoundaryLoop, kept: &Option<String>) -> HoleReport {
    let (status, reason) = match (kept, unfillable_reason(l.class)) {
        (Some(reason), _) => (HoleStatus::Kept, reason.clone()),
        (None, reason) => (HoleStatus::Failed, reason.unwrap_or_default().to_owned()),
    };
    HoleReport {
        id: l.id,
        edge: l.edge(),
        edges: l.edge_count(),
        perimeter: l.perimeter,
        class: l.class,
        status,
        reason,
        method: None,
        tried: Vec::new(),
        prediction: None,
        new_vertices: 0..0,
        new_triangles: 0..0,
        self_intersections: 0,
        min_angle: None,
        seconds: 0.0,
    }
}

fn check_boundary(mesh: &TriMesh, boundary: &BoundaryLoops) -> Result<()> {
    let (triangles, connectivity) = (mesh.triangles(), mesh.connectivity());
    let is_edge = |l: &BoundaryLoop, i: usize| {
        let h = l.halfedges[i];
        (h as usize) < connectivity.halfedge_count()
            && connectivity.twin(h) == BOUNDARY
            && l.directed_edge(i) == [origin(triangles, h), target(triangles, h)]
    };
    let is_sound = |id: usize, l: &BoundaryLoop| {
        let open_end = usize::from(l.class == LoopClass::OpenChain);
        l.id == id
            && l.vertices.len() == l.edge_count() + open_end
            && (0..l.edge_count()).all(|i| is_edge(l, i))
            && (l.reversed.is_empty() || unfillable_reason(l.class).is_some())
            && l.host.is_none_or(|host| host < boundary.loops.len())
    };
    match (0..boundary.loops.len()).find(|&id| !is_sound(id, &boundary.loops[id])) {
        Some(id) => Err(invalid(format!(
            "loop {id} is not on the boundary of this mesh"
        ))),
        None => Ok(()),
    }
}

fn invalid(message: String) -> Error {
    Error::new(ErrorKind::InvalidInput, message)
}

/// Counts finished holes, tells the caller, and remembers whether it asked to stop.
struct Meter<'a> {
    progress: Mutex<Progress>,
    callback: Option<ProgressCallback<'a>>,
    cancelled: AtomicBool,
}

impl<'a> Meter<'a> {
    fn new(holes_total: usize, callback: Option<ProgressCallback<'a>>) -> Self {
        let progress = Mutex::new(Progress {
            holes_done: 0,
            holes_total,
        });
        Self {
            progress,
            callback,
            cancelled: AtomicBool::new(false),
        }
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    fn advance(&self) {
        let Some(callback) = self.callback else {
            return;
        };
        // Held during the call, so that the caller sees one call at a time and counts that only grow.
        let mut progress = self
            .progress
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner());
        progress.holes_done += 1;
        if callback(*progress) == ControlFlow::Break(()) {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }
}
