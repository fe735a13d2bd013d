//! Finds patches without touching the mesh: for each hole methods in turn until one gives a patch that passes every
//! check, for several holes in parallel.

use super::attributes::AttributeTask;
use super::cut::{MeshPlace, cut_out};
use super::index::MeshIndex;
use super::patch::{Outcome, Patch, PatchFailure, in_mesh};
use super::polyline::Polyline;
use super::progress::Watch;
use super::report::Attempt;
use super::verify::check_patch;
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::linked::LinkedLoops;
use crate::boundary::opening::Opening;
use crate::error::{Error, ErrorKind, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::Vec3;
use crate::mesh::trimesh::TriMesh;
use crate::methods::method::Method;
use crate::methods::spec::HoleReach;
use crate::methods::task::Task;
use crate::options::FillOptions;
use crate::patch::PatchSurface;
use crate::quality::self_intersection::AppendedPatch;
use crate::quality::shape::smallest_angle;
use rayon::prelude::*;
use std::time::Instant;

/// The methods to try, best first: the chosen one, then the simpler ones.
pub(crate) fn chain(options: &FillOptions) -> Vec<Method> {
    let mut methods = vec![options.method];
    if options.fallback {
        methods.extend_from_slice(options.method.spec().falls_back_to);
    }
    methods
}

/// What planning needs besides the mesh.
#[derive(Clone, Copy)]
pub(crate) struct Planner<'a> {
    /// All loops of the mesh.
    pub(crate) loops: &'a [BoundaryLoop],
    pub(crate) index: &'a MeshIndex,
    /// Set when the mesh is a polyline.
    pub(crate) polyline: Option<&'a Polyline>,
    pub(crate) options: &'a FillOptions,
}

/// A hole cut out of the mesh, about to be filled.
struct Site<'a> {
    mesh: &'a TriMesh,
    hole: &'a Hole,
    place: &'a MeshPlace,
    task: &'a Task<'a>,
}

/// A patch that passed the checks.
struct Checked {
    method: Method,
    surface: PatchSurface,
    twins: Vec<u32>,
    /// New vertices in the mesh's coordinates.
    points: Vec<Vec3>,
    intersections: usize,
}

impl Planner<'_> {
    /// Plans the patches of all openings, in parallel on the threads of `pool`, with the seconds that each took.
    pub(super) fn plan_all(
        &self,
        mesh: &TriMesh,
        openings: &[Opening],
        pool: &rayon::ThreadPool,
        watch: &Watch<'_>,
    ) -> Vec<(Outcome, f64)> {
        let methods = chain(self.options);
        let needs_unlinked = methods.first().is_some_and(|m| m.spec().needs_unlinked_rim);
        let links =
            (needs_unlinked && self.polyline.is_none()).then(|| LinkedLoops::new(mesh, self.loops));
        let plan = |opening: &Opening| {
            let start = Instant::now();
            let job = Job::new(watch);
            let may_start = job.ask().and_then(|()| match &links {
                Some(links) => check_links(links, opening),
                None => Ok(()),
            });
            let outcome = may_start
                .map_err(PatchFailure::from)
                .and_then(|()| self.plan(mesh, opening, &methods, &job))
                .map_err(|failure| PatchFailure {
                    error: watch.explain(failure.error),
                    tried: failure.tried,
                });
            watch.advance();
            (outcome, start.elapsed().as_secs_f64())
        };
        // One thread is the caller's own: its memory is warm.
        if self.options.threads == 1 {
            openings.iter().map(plan).collect()
        } else {
            let plan_all = || openings.par_iter().with_max_len(1).map(plan).collect();
            pool.install(plan_all)
        }
    }

    /// Finds a patch for the opening by the first of `methods` whose patch passes every check and intersects nothing. If
    /// each one's intersects something, the one with the fewest intersecting pairs is taken, unless a method found the rim
    /// knotted.
    pub(crate) fn plan(
        &self,
        mesh: &TriMesh,
        opening: &Opening,
        methods: &[Method],
        job: &Job<'_>,
    ) -> Outcome {
        job.ask()?;
        let (hole, place) = match self.polyline {
            Some(polyline) => polyline.cut_out(mesh.points())?,
            None => {
                let reach = methods.iter().map(|m| (m.spec().reach)(self.options));
                let reach = reach.fold(HoleReach::rings(1), HoleReach::union);
                cut_out(mesh, &opening.rims_among(self.loops), reach, job)?
            }
        };
        job.ask()?;
        let site = Site {
            mesh,
            hole: &hole,
            place: &place,
            task: &Task::new(&hole, self.options, job),
        };
        let mut tried = Vec::new();
        match site.best_of(methods, self.index, &mut tried) {
            Ok(checked) => match site.finished(checked) {
                Ok(patch) => Ok(Patch { tried, ..patch }),
                Err(error) => Err(PatchFailure { error, tried }),
            },
            Err(error) => Err(PatchFailure { error, tried }),
        }
    }
}

/// Fails when a rim of the opening is linked with another loop: no disk over it is free of intersections then.
fn check_links(links: &LinkedLoops<'_>, opening: &Opening) -> Result<()> {
    let mut rims = opening.rims().iter();
    match rims.find_map(|&id| Some((id, links.partner(id)?))) {
        None => Ok(()),
        Some((id, other)) => Err(Error::new(
            ErrorKind::Knotted,
            format!("loop {id} is linked with loop {other}, which pierces every disk over it"),
        )),
    }
}

impl Site<'_> {
    /// The best patch of the methods. `tried` gets the others, and why their patches were not used.
    fn best_of(
        &self,
        methods: &[Method],
        index: &MeshIndex,
        tried: &mut Vec<Attempt>,
    ) -> Result<Checked> {
        // With its position among those that were tried.
        let mut best: Option<(Checked, usize)> = None;
        let mut last_error = None;
        let mut knotted = None;
        for &method in methods {
            let reason = match self.checked(method, index) {
                Ok(checked) => {
                    let found = checked.intersections;
                    if best.as_ref().is_none_or(|(b, _)| found < b.intersections) {
                        best = Some((checked, tried.len()));
                    }
                    if found == 0 {
                        break;
                    }
                    format!("its patch has {found} intersecting pairs of triangles")
                }
                Err(error) if error.kind() == ErrorKind::Cancelled => return Err(error),
                Err(error) => {
                    let reason = error.to_string();
                    if error.kind() == ErrorKind::Knotted {
                        knotted = Some(error.clone());
                    }
                    last_error = Some(error);
                    reason
                }
            };
            tried.push(Attempt { method, reason });
        }
        // Every disk over a knotted rim meets itself: what does so here is no way out.
        if knotted.is_some() {
            best = best.filter(|(checked, _)| checked.intersections == 0);
        }
        match best {
            Some((checked, position)) => {
                if checked.intersections > 0 {
                    tried.remove(position);
                }
                Ok(checked)
            }
            None => Err(knotted
                .or(last_error)
                .unwrap_or_else(|| Error::invalid("no method was allowed"))),
        }
    }

    fn checked(&self, method: Method, index: &MeshIndex) -> Result<Checked> {
        let (spec, job) = (method.spec(), self.task.job);
        let surface = (spec.make)(self.task)?;
        let twins = check_patch(self.hole, &surface, spec.farthest, job)?;
        job.ask()?;
        let new = surface.points[surface.rim_count..].iter();
        let points: Vec<Vec3> = new.map(|p| self.place.to_mesh(p)).collect();
        let vertex_count = self.mesh.positions().len();
        let patch = AppendedPatch {
            points: &points,
            triangles: &in_mesh(&self.place.rim, &surface.triangles, vertex_count),
            twins: &twins,
        };
        let intersections = index.intersections(self.mesh, patch, job)?.total();
        Ok(Checked {
            method,
            surface,
            twins,
            points,
            intersections,
        })
    }

    /// The patch with its attributes, and nothing that was tried besides.
    fn finished(&self, checked: Checked) -> Result<Patch> {
        let surface = checked.surface;
        let task = AttributeTask {
            mesh: self.mesh,
            hole: self.hole,
            place: self.place,
            surface: &surface,
            options: self.task.options,
            method: checked.method,
            job: self.task.job,
        };
        let attributes = task.carry()?;
        let corners = |t: &[u32; 3]| t.map(|v| surface.points[v as usize]);
        let angles = surface
            .triangles
            .iter()
            .map(|t| smallest_angle(&corners(t)));
        Ok(Patch {
            method: checked.method,
            tried: Vec::new(),
            rim: self.place.rim.clone(),
            rim_edges: self.place.rim_edges(&self.hole.polygon),
            points: checked.points,
            min_angle: angles.fold(std::f64::consts::PI, f64::min),
            triangles: surface.triangles,
            twins: checked.twins,
            self_intersections: checked.intersections,
            attributes,
            prediction: self.task.known(),
        })
    }
}
