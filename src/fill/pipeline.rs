//! Fills the chosen holes of a mesh: plans in parallel on the unchanged mesh, then stitches in order.

use super::index::MeshIndex;
use super::plan::{Plan, PlanFailure, Planner, chain};
use super::progress::{ProgressCallback, Watch};
use super::report::{FillReport, HoleReport, HoleStatus};
use super::stitch::{Outcome, Stitcher};
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::boundary_loop::LoopClass;
use crate::boundary::linked::LinkedLoops;
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::select::Selection;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::mesh::halfedge::{BOUNDARY, origin, target};
use crate::mesh::trimesh::TriMesh;
use crate::options::{FillOptions, FilledAttributes};
use rayon::prelude::*;
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
/// of `mesh`, when an option is out of its range or names an attribute that `mesh` lacks, or when the thread pool cannot be made. The mesh is then
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
    check_attribute_names(mesh, options)?;
    check_boundary(mesh, boundary)?;
    let kept = selection.reasons_to_keep(boundary)?;
    let chosen: Vec<usize> = (0..kept.len()).filter(|&id| kept[id].is_none()).collect();
    let holes = group_holes(boundary, &chosen, options);
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
    let pool = thread_pool(options)?;
    let start = Instant::now();
    let watch = Watch::new(holes.len(), options.time_budget, progress);
    let work = Work {
        options,
        pool: &pool,
        watch: &watch,
    };
    let index = pool.install(|| MeshIndex::build(mesh, &Job::new(&watch)));
    report.index_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    match &index {
        Ok(index) => {
            let planned_at = mesh.triangles().len();
            let planned = work.plan(mesh, index, &boundary.loops, &holes);
            work.stitch(mesh, index, planned_at, &holes, planned, &mut report.holes);
        }
        Err(error) => {
            let outcome = Outcome::failed(watch.explain(error.clone()), Vec::new());
            for hole in &holes {
                outcome.record_all(hole, 0.0, &mut report.holes);
            }
        }
    }
    report.fill_seconds = start.elapsed().as_secs_f64();

    // Giving back the memory of a large index takes longer than filling a small hole.
    let start = Instant::now();
    drop(index);
    report.index_seconds += start.elapsed().as_secs_f64();
    Ok(report)
}

/// The threads that `options` asks for.
///
/// # Errors
/// [`ErrorKind::Limit`] when they cannot be started.
pub(crate) fn thread_pool(options: &FillOptions) -> Result<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| {
            let message = format!("cannot start {} threads: {e}", options.threads);
            Error::new(ErrorKind::Limit, message)
        })
}

/// A patch or the reason why there is none, and the seconds that it took.
pub(super) type Planned = (std::result::Result<Plan, PlanFailure>, f64);

/// What filling needs besides the mesh.
pub(super) struct Work<'a> {
    pub(super) options: &'a FillOptions,
    pub(super) pool: &'a rayon::ThreadPool,
    pub(super) watch: &'a Watch<'a>,
}

impl Work<'_> {
    /// Plans the patches of all holes on the unchanged mesh, whose boundary loops are `loops`, in parallel.
    pub(super) fn plan(
        &self,
        mesh: &TriMesh,
        index: &MeshIndex,
        loops: &[BoundaryLoop],
        holes: &[HoleLoops<'_>],
    ) -> Vec<Planned> {
        let methods = chain(self.options);
        let needs_unlinked = methods.first().is_some_and(|m| m.spec().needs_unlinked_rim);
        let links = needs_unlinked.then(|| LinkedLoops::new(mesh, loops));
        self.plan_by(mesh, index, holes, |planner, hole| {
            if let Some(links) = &links {
                check_links(links, hole)?;
            }
            planner.plan(hole.outer, &hole.islands, &methods)
        })
    }

    /// As [`plan`](Self::plan), for anything that `make` can plan.
    pub(super) fn plan_by<H: Sync>(
        &self,
        mesh: &TriMesh,
        index: &MeshIndex,
        holes: &[H],
        make: impl Fn(&Planner<'_>, &H) -> std::result::Result<Plan, PlanFailure> + Sync,
    ) -> Vec<Planned> {
        let plan = |hole: &H| {
            let start = Instant::now();
            let job = Job::new(self.watch);
            let planner = Planner {
                mesh,
                index,
                options: self.options,
                job: &job,
            };
            let outcome = job.ask().map_err(PlanFailure::from);
            let outcome = outcome.and_then(|()| make(&planner, hole));
            self.watch.advance();
            let outcome = outcome.map_err(|failure| self.explain(failure));
            (outcome, start.elapsed().as_secs_f64())
        };
        // One thread is the caller's own: its memory is warm.
        if self.options.threads == 1 {
            holes.iter().map(plan).collect()
        } else {
            let plan_all = || holes.par_iter().with_max_len(1).map(plan).collect();
            self.pool.install(plan_all)
        }
    }

    /// Appends the planned patches in order and enters in `reports`, by the ids of the loops, how it went.
    ///
    /// `planned_at` is the number of triangles when the patches were planned.
    pub(super) fn stitch(
        &self,
        mesh: &mut TriMesh,
        index: &MeshIndex,
        planned_at: usize,
        holes: &[HoleLoops<'_>],
        planned: Vec<Planned>,
        reports: &mut [HoleReport],
    ) {
        let job = Job::new(self.watch);
        let plans: Vec<Option<&Plan>> = planned.iter().map(|(p, _)| p.as_ref().ok()).collect();
        let mut stitcher = Stitcher::new(mesh, index, self.options, &job, &plans, planned_at);
        for (i, (hole, (plan, seconds))) in holes.iter().zip(planned).enumerate() {
            let start = Instant::now();
            let explain = |error| self.watch.explain(error);
            let outcome = stitcher.stitch(i, hole, plan).explained(explain);
            let seconds = seconds + start.elapsed().as_secs_f64();
            outcome.record_all(hole, seconds, reports);
        }
    }

    fn explain(&self, failure: PlanFailure) -> PlanFailure {
        PlanFailure {
            error: self.watch.explain(failure.error),
            tried: failure.tried,
        }
    }
}

/// A hole to fill: a loop and the loose sheets inside it.
pub(super) struct HoleLoops<'a> {
    pub(super) outer: &'a BoundaryLoop,
    pub(super) islands: Vec<&'a BoundaryLoop>,
}

/// Fails when a rim of the hole is linked with another loop: no disk over it is free of intersections then.
fn check_links(links: &LinkedLoops<'_>, hole: &HoleLoops<'_>) -> Result<()> {
    let mut rims = std::iter::once(&hole.outer).chain(&hole.islands);
    match rims.find_map(|l| Some((l.id, links.partner(l.id)?))) {
        None => Ok(()),
        Some((id, other)) => Err(Error::new(
            ErrorKind::Knotted,
            format!("loop {id} is linked with loop {other}, which pierces every disk over it"),
        )),
    }
}

/// The holes to fill: every loop of the ascending ids `chosen`, islands together with the loop that they lie in.
///
/// Cost follows the chosen loops.
pub(super) fn group_holes<'a>(
    boundary: &'a BoundaryLoops,
    chosen: &[usize],
    options: &FillOptions,
) -> Vec<HoleLoops<'a>> {
    let is_chosen = |id: usize| {
        chosen.binary_search(&id).is_ok() && unfillable_reason(boundary.loops[id].class).is_none()
    };
    let loops = || chosen.iter().map(|&id| &boundary.loops[id]);
    let host_of = |l: &BoundaryLoop| {
        l.host.filter(|&host| {
            options.join_islands && is_chosen(host) && boundary.loops[host].host.is_none()
        })
    };
    let mut holes: Vec<HoleLoops<'a>> = loops()
        .filter(|l| is_chosen(l.id) && host_of(l).is_none())
        .map(|outer| HoleLoops {
            outer,
            islands: Vec::new(),
        })
        .collect();
    for island in loops().filter(|l| is_chosen(l.id)) {
        if let Some(host) = host_of(island)
            && let Ok(i) = holes.binary_search_by_key(&host, |h| h.outer.id)
        {
            holes[i].islands.push(island);
        }
    }
    holes
}

pub(super) fn unfillable_reason(class: LoopClass) -> Option<&'static str> {
    match class {
        LoopClass::NotOriented => Some("the triangles along the loop are not oriented alike"),
        LoopClass::OpenChain => {
            Some("the boundary does not close: it runs into an edge with more than two triangles")
        }
        _ => None,
    }
}

pub(super) fn blank_report(l: &BoundaryLoop, kept: &Option<String>) -> HoleReport {
    let unfillable = unfillable_reason(l.class);
    let (status, reason, cause) = match (kept, unfillable) {
        (Some(reason), _) => (HoleStatus::Kept, reason.clone(), None),
        (None, reason) => (
            HoleStatus::Failed,
            reason.unwrap_or_default().to_owned(),
            reason.map(|_| ErrorKind::Topology),
        ),
    };
    HoleReport {
        id: l.id,
        edge: l.edge(),
        edges: l.edge_count(),
        perimeter: l.perimeter,
        class: l.class,
        status,
        reason,
        cause,
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

pub(super) fn check_attribute_names(mesh: &TriMesh, options: &FillOptions) -> Result<()> {
    let FilledAttributes::Only(names) = &options.attributes.filled else {
        return Ok(());
    };
    let attributes = mesh.vertex_attributes();
    match names.iter().find(|name| attributes.get(name).is_none()) {
        None => Ok(()),
        Some(name) => {
            let known: Vec<&str> = attributes.iter().map(|a| a.name.as_str()).collect();
            let message = format!(
                "there is no vertex attribute '{name}' to fill; there are: {}",
                known.join(", ")
            );
            Err(Error::new(ErrorKind::InvalidInput, message))
        }
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
