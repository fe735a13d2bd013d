//! Appends planned patches to the mesh, one after the other, so that the result does not depend on the
//! order in which they were planned.

use super::index::MeshIndex;
use super::pipeline::HoleLoops;
use super::plan::{Plan, PlanFailure, Planner, chain};
use super::report::{Attempt, HoleReport, HoleStatus};
use super::verify::check_against_mesh;
use crate::error::{Error, ErrorKind};
use crate::job::Job;
use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::math::box_tree::BoxTree;
use crate::mesh::trimesh::TriMesh;
use crate::methods::auto::prediction::Prediction;
use crate::methods::method::Method;
use crate::options::FillOptions;
use crate::quality::Surface;
use crate::quality::self_intersection::{AppendedPatch, count};
use crate::quality::spatial::FaceIndex;
use std::ops::Range;

/// A patch that was planned is stitched even when the others are cancelled: the job only stops planning anew.
const UNSTOPPED: &str = "nothing stops it";

/// Pairs of a triangle of the patch and one of `part` that intersect.
fn intersections(part: Surface<'_>, faces: &FaceIndex, patch: AppendedPatch<'_>) -> usize {
    let found = count(part, faces, patch, &Job::unlimited());
    found.expect(UNSTOPPED).with_mesh
}

/// Stitches planned patches into a mesh.
pub(super) struct Stitcher<'a> {
    mesh: &'a mut TriMesh,
    index: &'a MeshIndex,
    options: &'a FillOptions,
    job: &'a Job<'a>,
    /// Triangles that were appended after the patches were planned, and their index.
    since: Option<(Range<usize>, FaceIndex)>,
    /// Boxes of all planned patches.
    boxes: BoxTree,
    /// Holes whose patch is not the planned one, with its box.
    replanned: Vec<(usize, Aabb)>,
    /// Triangles of the patch of each hole, once it is stitched.
    stitched: Vec<Range<usize>>,
}

/// How the filling of a hole ended.
pub(super) struct Outcome {
    status: HoleStatus,
    reason: String,
    cause: Option<ErrorKind>,
    tried: Vec<Attempt>,
    filled: Option<Filled>,
    prediction: Option<Prediction>,
}

struct Filled {
    method: Method,
    new_vertices: Range<u32>,
    new_triangles: Range<u32>,
    self_intersections: usize,
    min_angle: f64,
}

impl<'a> Stitcher<'a> {
    /// `planned_at` is the number of triangles that the mesh had when the patches were planned; `index` knows the
    /// mesh as it is.
    pub(super) fn new(
        mesh: &'a mut TriMesh,
        index: &'a MeshIndex,
        options: &'a FillOptions,
        job: &'a Job<'a>,
        plans: &[Option<&Plan>],
        planned_at: usize,
    ) -> Self {
        let appended = planned_at..mesh.triangles().len();
        let since = (!appended.is_empty()).then(|| {
            let tree =
                FaceIndex::build(part(mesh, appended.clone()), &Job::unlimited()).expect(UNSTOPPED);
            (appended, tree)
        });
        let box_of = |i: usize| plans[i].map_or_else(Aabb::empty, |plan| plan_box(mesh, plan));
        let boxes = BoxTree::build(plans.len(), box_of, &Job::unlimited()).expect(UNSTOPPED);
        let stitched = vec![0..0; plans.len()];
        Self {
            mesh,
            index,
            options,
            job,
            since,
            boxes,
            replanned: Vec::new(),
            stitched,
        }
    }

    /// Appends the patch of hole `index`, or makes another one if it no longer fits.
    pub(super) fn stitch(
        &mut self,
        index: usize,
        hole: &HoleLoops<'_>,
        planned: Result<Plan, PlanFailure>,
    ) -> Outcome {
        let mut plan = match planned {
            Ok(plan) => plan,
            Err(failure) => return Outcome::failed(failure.error, failure.tried),
        };
        let vertices = self.mesh.positions().len();
        let mut triangles = plan.triangles(vertices);
        let mut with_patches = 0;
        let conflict = self.conflict(&plan, &triangles).or_else(|| {
            with_patches = self.intersections_with_patches(&plan, &triangles)
                + self.intersections_since(&plan, &triangles);
            (with_patches > 0).then(|| {
                let message =
                    format!("its patch intersects that of another hole {with_patches} times");
                Error::new(ErrorKind::Geometry, message)
            })
        });
        if let Some(error) = conflict {
            let is_usable = with_patches > 0;
            let methods = self.methods_after(&plan, &error);
            let without_conflict = plan.tried.len();
            let replanned =
                (!methods.is_empty()).then(|| self.replan(hole, &plan, &error, &methods));
            match replanned {
                None => {}
                Some(Ok((other, of_other, count)))
                    if !is_usable
                        || count + other.self_intersections
                            < with_patches + plan.self_intersections =>
                {
                    with_patches = count;
                    self.replanned.push((index, plan_box(self.mesh, &other)));
                    triangles = of_other;
                    plan = other;
                }
                Some(Err(failure)) if !is_usable => {
                    return Outcome::failed(failure.error, failure.tried);
                }
                // The plan stands, and the report says what else was tried.
                Some(Ok((other, _, count))) => {
                    plan.tried = other.tried;
                    plan.tried.remove(without_conflict);
                    plan.tried.push(Attempt {
                        method: other.method,
                        reason: format!(
                            "its patch has {} intersecting pairs of triangles, other patches included",
                            count + other.self_intersections
                        ),
                    });
                }
                Some(Err(failure)) => {
                    plan.tried = failure.tried;
                    plan.tried.remove(without_conflict);
                }
            }
        }
        plan.self_intersections += with_patches;
        self.append(index, plan, &triangles)
    }

    /// Why the patch no longer fits the mesh.
    fn conflict(&self, plan: &Plan, triangles: &[[u32; 3]]) -> Option<Error> {
        check_against_mesh(self.mesh, &plan.hole, triangles).err()
    }

    /// The methods that are worth trying after a plan that does not fit for the reason `error`.
    fn methods_after(&self, plan: &Plan, error: &Error) -> Vec<Method> {
        // A new edge may block a chord: the same method can find another way. An intersection calls for
        // another shape.
        let is_blocked = error.kind() == ErrorKind::Topology;
        chain(self.options)
            .into_iter()
            .skip_while(|&m| m != plan.method)
            .skip(usize::from(!is_blocked))
            .collect()
    }

    /// Plans the hole anew on the mesh as it is, by one of `methods`. Returns the triangles of the plan besides, and how
    /// many pairs intersect with patches stitched so far.
    fn replan(
        &self,
        hole: &HoleLoops<'_>,
        plan: &Plan,
        error: &Error,
        methods: &[Method],
    ) -> Result<(Plan, Vec<[u32; 3]>, usize), PlanFailure> {
        let planner = Planner {
            mesh: self.mesh,
            index: self.index,
            options: self.options,
            job: self.job,
        };
        let mut tried = plan.tried.clone();
        tried.push(Attempt {
            method: plan.method,
            reason: error.to_string(),
        });
        let outcome = planner.plan(hole.outer, &hole.islands, methods);
        let mut other = outcome.map_err(|mut failure| {
            tried.append(&mut failure.tried);
            PlanFailure {
                error: failure.error,
                tried: std::mem::take(&mut tried),
            }
        })?;
        tried.append(&mut other.tried);
        other.tried = tried;
        let triangles = other.triangles(self.mesh.positions().len());
        match self.conflict(&other, &triangles) {
            Some(error) => Err(PlanFailure {
                error,
                tried: other.tried,
            }),
            None => {
                let count = self.intersections_with_patches(&other, &triangles);
                Ok((other, triangles, count))
            }
        }
    }

    /// Pairs of triangles of the patch and of the patches stitched so far that intersect.
    fn intersections_with_patches(&self, plan: &Plan, triangles: &[[u32; 3]]) -> usize {
        let own_box = plan_box(self.mesh, plan);
        let mut near = Vec::new();
        self.boxes.overlapping(&own_box, &mut near);
        let other = |i: &u32| !self.replanned.iter().any(|&(hole, _)| hole == *i as usize);
        near.retain(other);
        let replanned = self.replanned.iter();
        near.extend(
            replanned
                .filter(|(_, reach)| reach.overlaps(&own_box))
                .map(|&(hole, _)| hole as u32),
        );
        let patch = AppendedPatch {
            points: &plan.points,
            triangles,
            twins: &plan.twins,
        };
        near.iter()
            .map(|&i| self.stitched[i as usize].clone())
            .filter(|range| !range.is_empty())
            .map(|range| {
                let other = part(self.mesh, range);
                let faces = FaceIndex::build(other, &Job::unlimited()).expect(UNSTOPPED);
                intersections(other, &faces, patch)
            })
            .sum()
    }

    /// Pairs of triangles of the patch and of what was appended after it was planned that intersect.
    fn intersections_since(&self, plan: &Plan, triangles: &[[u32; 3]]) -> usize {
        let Some((range, tree)) = &self.since else {
            return 0;
        };
        let patch = AppendedPatch {
            points: &plan.points,
            triangles,
            twins: &plan.twins,
        };
        intersections(part(self.mesh, range.clone()), tree, patch)
    }

    fn append(&mut self, index: usize, plan: Plan, triangles: &[[u32; 3]]) -> Outcome {
        let vertices = self.mesh.positions().len();
        let faces = self.mesh.triangles().len();
        let points: Vec<[f64; 3]> = plan.points.iter().map(|&p| p.into()).collect();
        let appended =
            self.mesh
                .append(&points, triangles, &plan.twins, |of_vertices, of_faces| {
                    plan.attributes.append_to(of_vertices, of_faces)
                });
        if let Err(error) = appended {
            return Outcome::failed(error, plan.tried);
        }
        self.stitched[index] = faces..faces + triangles.len();
        Outcome {
            status: HoleStatus::Filled,
            reason: String::new(),
            cause: None,
            filled: Some(Filled::new(&plan, vertices, faces)),
            tried: plan.tried,
            prediction: plan.prediction,
        }
    }
}

impl Filled {
    /// The numbers of a patch that is appended to this many vertices and triangles.
    fn new(plan: &Plan, vertices: usize, triangles: usize) -> Self {
        let triangle_count = plan.triangle_count();
        Self {
            method: plan.method,
            new_vertices: vertices as u32..(vertices + plan.points.len()) as u32,
            new_triangles: triangles as u32..(triangles + triangle_count) as u32,
            self_intersections: plan.self_intersections,
            min_angle: plan.min_angle,
        }
    }
}

impl Outcome {
    /// What a plan promises, if it is appended to this many vertices and triangles.
    pub(super) fn planned(plan: &Plan, vertices: usize, triangles: usize) -> Self {
        Self {
            status: HoleStatus::Filled,
            reason: String::new(),
            cause: None,
            tried: plan.tried.clone(),
            prediction: plan.prediction.clone(),
            filled: Some(Filled::new(plan, vertices, triangles)),
        }
    }

    pub(super) fn failed(error: Error, tried: Vec<Attempt>) -> Self {
        let status = match error.kind() {
            ErrorKind::Cancelled => HoleStatus::Cancelled,
            _ => HoleStatus::Failed,
        };
        Self {
            status,
            reason: error.to_string(),
            cause: Some(error.kind()),
            tried,
            filled: None,
            prediction: None,
        }
    }

    /// With another error in the place of the one that kept the hole open.
    pub(super) fn explained(mut self, explain: impl Fn(Error) -> Error) -> Self {
        if let Some(cause) = self.cause {
            let tried = std::mem::take(&mut self.tried);
            return Self::failed(explain(Error::new(cause, self.reason)), tried);
        }
        self
    }

    /// Enters the outcome in the reports of all loops of the hole, which are ordered by the loops' ids.
    pub(super) fn record_all(
        &self,
        hole: &HoleLoops<'_>,
        seconds: f64,
        reports: &mut [HoleReport],
    ) {
        for l in std::iter::once(&hole.outer).chain(&hole.islands) {
            if let Ok(i) = reports.binary_search_by_key(&l.id, |r| r.id) {
                self.record(&mut reports[i], hole.outer.id, seconds);
            }
        }
    }

    /// Enters the outcome in the report of a loop of the hole; `outer` bounds the patch.
    fn record(&self, report: &mut HoleReport, outer: usize, seconds: f64) {
        report.status = self.status;
        report.cause = self.cause;
        report.reason.clone_from(&self.reason);
        if report.id != outer {
            report.reason = match self.status {
                HoleStatus::Filled => format!("joined to the patch of hole {outer}"),
                _ => format!("with hole {outer}: {}", self.reason),
            };
            return;
        }
        report.tried.clone_from(&self.tried);
        report.seconds = seconds;
        report.prediction.clone_from(&self.prediction);
        if let Some(filled) = &self.filled {
            report.method = Some(filled.method);
            report.new_vertices = filled.new_vertices.clone();
            report.new_triangles = filled.new_triangles.clone();
            report.self_intersections = filled.self_intersections;
            report.min_angle = Some(filled.min_angle);
            if filled.self_intersections > 0 {
                report.reason =
                    format!("{} pairs of triangles intersect", filled.self_intersections);
            }
        }
    }
}

fn part(mesh: &TriMesh, range: Range<usize>) -> Surface<'_> {
    Surface {
        points: mesh.points(),
        triangles: &mesh.triangles()[range],
    }
}

/// The box round a planned patch, rim included.
fn plan_box(mesh: &TriMesh, plan: &Plan) -> Aabb {
    let rim: Vec<Vec3> = plan.hole.rim.iter().map(|&v| mesh.point(v)).collect();
    let rim = Aabb::around(&rim);
    if plan.points.is_empty() {
        rim
    } else {
        rim.union(&Aabb::around(&plan.points))
    }
}
