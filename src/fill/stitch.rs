//! Appends planned patches to the mesh, one after the other, so that the result does not depend on the
//! order in which they were planned.

use super::method::Method;
use super::options::FillOptions;
use super::pipeline::HoleLoops;
use super::plan::{Failure, Plan, Planner, chain};
use super::report::{Attempt, HoleReport, HoleStatus, Prediction};
use super::verify::check_against_mesh;
use crate::error::{Error, ErrorKind};
use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::math::box_tree::BoxTree;
use crate::mesh::trimesh::TriMesh;
use crate::quality::Surface;
use crate::quality::self_intersection::{AppendedPatch, count};
use crate::quality::spatial::FaceIndex;
use std::ops::Range;

/// Stitches planned patches into a mesh.
pub(super) struct Stitcher<'a> {
    mesh: &'a mut TriMesh,
    faces: &'a FaceIndex,
    options: &'a FillOptions,
    interrupted: &'a (dyn Fn() -> bool + Sync),
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
    pub(super) fn new(
        mesh: &'a mut TriMesh,
        faces: &'a FaceIndex,
        options: &'a FillOptions,
        interrupted: &'a (dyn Fn() -> bool + Sync),
        plans: &[Option<&Plan>],
    ) -> Self {
        let boxes = BoxTree::build(plans.len(), |i| {
            plans[i].map_or_else(Aabb::empty, |plan| plan_box(mesh, plan))
        });
        let stitched = vec![0..0; plans.len()];
        Self {
            mesh,
            faces,
            options,
            interrupted,
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
        planned: Result<Plan, Failure>,
    ) -> Outcome {
        let mut plan = match planned {
            Ok(plan) => plan,
            Err(failure) => return Outcome::failed(failure.error, failure.tried),
        };
        let mut with_patches = 0;
        let conflict = self.conflict(&plan).or_else(|| {
            with_patches = self.intersections_with_patches(&plan);
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
                Some(Ok((other, count)))
                    if !is_usable
                        || count + other.self_intersections
                            < with_patches + plan.self_intersections =>
                {
                    with_patches = count;
                    self.replanned.push((index, plan_box(self.mesh, &other)));
                    plan = other;
                }
                Some(Err(failure)) if !is_usable => {
                    return Outcome::failed(failure.error, failure.tried);
                }
                // The plan stands, and the report says what else was tried.
                Some(Ok((other, count))) => {
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
        self.append(index, plan)
    }

    /// Why the patch no longer fits the mesh.
    fn conflict(&self, plan: &Plan) -> Option<Error> {
        let triangles = plan.triangles(self.mesh.positions().len());
        check_against_mesh(self.mesh, &plan.hole, &triangles).err()
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

    /// Plans the hole anew on the mesh as it is, by one of `methods`.
    fn replan(
        &self,
        hole: &HoleLoops<'_>,
        plan: &Plan,
        error: &Error,
        methods: &[Method],
    ) -> Result<(Plan, usize), Failure> {
        let planner = Planner {
            mesh: self.mesh,
            faces: self.faces,
            options: self.options,
            interrupted: self.interrupted,
        };
        let mut tried = plan.tried.clone();
        tried.push(Attempt {
            method: plan.method,
            reason: error.to_string(),
        });
        let outcome = planner.plan(hole.outer, &hole.islands, methods);
        let mut other = outcome.map_err(|mut failure| {
            tried.append(&mut failure.tried);
            Failure {
                error: failure.error,
                tried: std::mem::take(&mut tried),
            }
        })?;
        tried.append(&mut other.tried);
        other.tried = tried;
        match self.conflict(&other) {
            Some(error) => Err(Failure {
                error,
                tried: other.tried,
            }),
            None => {
                let count = self.intersections_with_patches(&other);
                Ok((other, count))
            }
        }
    }

    /// Pairs of triangles of the patch and of the patches stitched so far that intersect.
    fn intersections_with_patches(&self, plan: &Plan) -> usize {
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
        let triangles = plan.triangles(self.mesh.positions().len());
        let patch = AppendedPatch {
            points: &plan.points,
            triangles: &triangles,
        };
        near.iter()
            .map(|&i| self.stitched[i as usize].clone())
            .filter(|range| !range.is_empty())
            .map(|range| {
                let other = Surface {
                    points: self.mesh.points(),
                    triangles: &self.mesh.triangles()[range],
                };
                count(other, &FaceIndex::build(other), patch).with_mesh
            })
            .sum()
    }

    fn append(&mut self, index: usize, plan: Plan) -> Outcome {
        let vertices = self.mesh.positions().len();
        let faces = self.mesh.triangles().len();
        let triangles = plan.triangles(vertices);
        let points: Vec<[f64; 3]> = plan.points.iter().map(|&p| p.into()).collect();
        let appended = self
            .mesh
            .append(&points, &triangles, |of_vertices, of_faces| {
                plan.attributes.append_to(of_vertices, of_faces)
            });
        if let Err(error) = appended {
            return Outcome::failed(error, plan.tried);
        }
        self.stitched[index] = faces..faces + triangles.len();
        Outcome {
            status: HoleStatus::Filled,
            reason: String::new(),
            filled: Some(Filled {
                method: plan.method,
                new_vertices: vertices as u32..(vertices + points.len()) as u32,
                new_triangles: faces as u32..(faces + triangles.len()) as u32,
                self_intersections: plan.self_intersections,
                min_angle: plan.min_angle,
            }),
            tried: plan.tried,
            prediction: plan.prediction,
        }
    }
}

impl Outcome {
    fn failed(error: Error, tried: Vec<Attempt>) -> Self {
        let status = match error.kind() {
            ErrorKind::Cancelled => HoleStatus::Cancelled,
            _ => HoleStatus::Failed,
        };
        Self {
            status,
            reason: error.to_string(),
            tried,
            filled: None,
            prediction: None,
        }
    }

    /// Enters the outcome in the report of a loop of the hole; `outer` bounds the patch.
    pub(super) fn record(&self, report: &mut HoleReport, outer: usize, seconds: f64) {
        report.status = self.status;
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
