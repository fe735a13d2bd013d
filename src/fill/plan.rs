//! Finds the patch for one hole without touching the mesh: methods in turn until one gives a patch that
//! passes every check.

use super::attributes::{AttributeTask, CarriedAttributes};
use super::hole::Hole;
use super::index::MeshIndex;
use super::report::Attempt;
use super::verify::check_patch;
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::math::Vec3;
use crate::mesh::trimesh::TriMesh;
use crate::methods::auto::prediction::Prediction;
use crate::methods::method::Method;
use crate::methods::spec::HoleReach;
use crate::methods::task::Task;
use crate::options::FillOptions;
use crate::patch::PatchSurface;
use crate::quality::self_intersection::{AppendedPatch, SelfIntersections};
use crate::quality::shape::smallest_angle;

/// A patch that may be stitched into the mesh.
#[derive(Clone)]
pub(crate) struct Plan {
    pub(crate) hole: Hole,
    pub(crate) method: Method,
    pub(crate) tried: Vec<Attempt>,
    /// New vertices in the mesh's coordinates.
    pub(crate) points: Vec<Vec3>,
    /// Indices below the rim count are rim vertices, the others new ones.
    triangles: Vec<[u32; 3]>,
    /// For each halfedge of the triangles the other one of its edge.
    pub(crate) twins: Vec<u32>,
    pub(crate) self_intersections: usize,
    pub(crate) min_angle: f64,
    pub(crate) attributes: CarriedAttributes,
    /// How the surface was predicted, if a method did so.
    pub(crate) prediction: Option<Prediction>,
}

impl Plan {
    pub(crate) fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles in the indices of a mesh with `vertex_count` vertices before the new ones.
    pub(crate) fn triangles(&self, vertex_count: usize) -> Vec<[u32; 3]> {
        global_triangles(&self.hole, &self.triangles, vertex_count)
    }
}

/// Why there is no plan, and what was tried.
#[derive(Clone)]
pub(crate) struct PlanFailure {
    pub(crate) error: Error,
    pub(crate) tried: Vec<Attempt>,
}

impl From<Error> for PlanFailure {
    fn from(error: Error) -> Self {
        Self {
            error,
            tried: Vec::new(),
        }
    }
}

/// The methods to try, best first: the chosen one, then the simpler ones.
pub(crate) fn chain(options: &FillOptions) -> Vec<Method> {
    let mut methods = vec![options.method];
    if options.fallback {
        methods.extend_from_slice(options.method.spec().falls_back_to);
    }
    methods
}

/// What planning needs besides the hole.
pub(crate) struct Planner<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) index: &'a MeshIndex,
    pub(crate) options: &'a FillOptions,
    /// Asked from time to time; true stops the work.
    pub(crate) job: &'a Job<'a>,
}

impl Planner<'_> {
    /// Finds a patch for the hole that `outer` bounds together with its `islands`, by the first of `methods`
    /// whose patch passes every check and intersects nothing. If each one's intersects something, the one
    /// with the fewest intersecting pairs is taken, unless a method found the rim knotted.
    pub(crate) fn plan(
        &self,
        outer: &BoundaryLoop,
        islands: &[&BoundaryLoop],
        methods: &[Method],
    ) -> std::result::Result<Plan, PlanFailure> {
        let reach = methods
            .iter()
            .map(|m| (m.spec().reach)(self.options))
            .fold(HoleReach::rings(1), HoleReach::union);
        self.job.ask()?;
        let hole = Hole::new(self.mesh, outer, islands, reach, self.job)?;
        self.job.ask()?;
        self.plan_hole(hole, methods)
    }

    /// As [`plan`](Self::plan), for a hole that was cut out already.
    pub(crate) fn plan_hole(
        &self,
        hole: Hole,
        methods: &[Method],
    ) -> std::result::Result<Plan, PlanFailure> {
        let mut tried = Vec::new();
        let task = Task::new(&hole.shape, self.options, self.job);
        let mut best: Option<(MadePatch, usize)> = None;
        let mut last_error = None;
        let mut knotted = None;
        for &method in methods {
            let reason = match self.candidate(&hole, &task, method) {
                Ok(candidate) => {
                    let found = candidate.intersections.total();
                    let is_better = best
                        .as_ref()
                        .is_none_or(|(b, _)| found < b.intersections.total());
                    if is_better {
                        best = Some((candidate, tried.len()));
                    }
                    if found == 0 {
                        break;
                    }
                    format!("its patch has {found} intersecting pairs of triangles")
                }
                Err(error) if error.kind() == ErrorKind::Cancelled => {
                    return Err(PlanFailure { error, tried });
                }
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
            best = best.filter(|(candidate, _)| candidate.intersections.total() == 0);
        }
        let Some((candidate, position)) = best else {
            let error = knotted
                .or(last_error)
                .unwrap_or_else(|| Error::new(ErrorKind::InvalidInput, "no method was allowed"));
            return Err(PlanFailure { error, tried });
        };
        if candidate.intersections.total() > 0 {
            tried.remove(position);
        }
        let prediction = task.known::<Prediction>();
        drop(task);
        let mut plan = self.finish(hole, candidate, tried)?;
        plan.prediction = prediction;
        Ok(plan)
    }

    fn candidate(&self, hole: &Hole, task: &Task<'_>, method: Method) -> Result<MadePatch> {
        let spec = method.spec();
        let surface = (spec.make)(task)?;
        let twins = check_patch(hole, &surface, spec.farthest, self.job)?;
        self.job.ask()?;
        let points: Vec<Vec3> = surface.points[surface.rim_count..]
            .iter()
            .map(|p| hole.to_mesh(p).into())
            .collect();
        let triangles = global_triangles(hole, &surface.triangles, self.mesh.positions().len());
        let patch = AppendedPatch {
            points: &points,
            triangles: &triangles,
            twins: &twins,
        };
        let intersections = self.index.intersections(self.mesh, patch, self.job)?;
        Ok(MadePatch {
            method,
            surface,
            twins,
            points,
            intersections,
        })
    }

    fn finish(
        &self,
        hole: Hole,
        candidate: MadePatch,
        tried: Vec<Attempt>,
    ) -> std::result::Result<Plan, PlanFailure> {
        let MadePatch {
            method,
            surface,
            twins,
            points,
            intersections,
        } = candidate;
        let task = AttributeTask {
            mesh: self.mesh,
            hole: &hole,
            surface: &surface,
            options: self.options,
            method,
            job: self.job,
        };
        let attributes = match task.carry() {
            Ok(attributes) => attributes,
            Err(error) => return Err(PlanFailure { error, tried }),
        };
        let corners = |t: &[u32; 3]| t.map(|v| surface.points[v as usize]);
        let min_angle = surface
            .triangles
            .iter()
            .map(|t| smallest_angle(&corners(t)))
            .fold(std::f64::consts::PI, f64::min);
        Ok(Plan {
            hole,
            method,
            tried,
            points,
            triangles: surface.triangles,
            twins,
            self_intersections: intersections.total(),
            min_angle,
            attributes,
            prediction: None,
        })
    }
}

struct MadePatch {
    method: Method,
    surface: PatchSurface,
    twins: Vec<u32>,
    points: Vec<Vec3>,
    intersections: SelfIntersections,
}

fn global_triangles(hole: &Hole, triangles: &[[u32; 3]], vertex_count: usize) -> Vec<[u32; 3]> {
    let rim_count = hole.rim.len();
    let global = |v: u32| match (v as usize).checked_sub(rim_count) {
        Some(new) => (vertex_count + new) as u32,
        None => hole.rim[v as usize],
    };
    triangles.iter().map(|t| t.map(global)).collect()
}
