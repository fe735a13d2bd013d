//! Appends planned patches to the mesh, one after the other, so that the result does not depend on the
//! order in which they were planned.

use super::patch::{Outcome, Patch, PatchFailure, record};
use super::plan::{Planner, chain};
use super::progress::Watch;
use super::report::{Attempt, HoleReport};
use super::verify::check_against_mesh;
use crate::boundary::opening::Opening;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::math::aabb::Aabb;
use crate::math::box_tree::BoxTree;
use crate::mesh::trimesh::TriMesh;
use crate::methods::method::Method;
use crate::quality::Surface;
use crate::quality::self_intersection::{AppendedPatch, count};
use crate::quality::spatial::FaceIndex;
use std::ops::Range;
use std::time::Instant;

/// A patch that was planned is stitched even when the others are cancelled: the job only stops planning anew.
const UNSTOPPED: &str = "nothing stops it";

/// Pairs of a triangle of the patch and one of `part` that intersect.
fn intersections(part: Surface<'_>, faces: &FaceIndex, patch: AppendedPatch<'_>) -> usize {
    let found = count(part, faces, patch, &Job::unlimited());
    found.expect(UNSTOPPED).with_mesh
}

/// An opening with what was planned for it, and the seconds that this took.
pub(super) type PlannedOpening = (Opening, Outcome, f64);

/// Appends planned patches to `mesh` in order and enters in `reports`, by the ids of the loops, how it went.
///
/// `planned_at` is the number of triangles when the patches were planned; the planner's index knows the mesh as it is.
pub(super) fn stitch_all(
    mesh: &mut TriMesh,
    planner: &Planner<'_>,
    planned: Vec<PlannedOpening>,
    planned_at: usize,
    watch: &Watch<'_>,
    reports: &mut [HoleReport],
) {
    let job = Job::new(watch);
    let mut stitcher = Stitcher::new(mesh, planner, &job, &planned, planned_at);
    for (i, (opening, outcome, seconds)) in planned.into_iter().enumerate() {
        let start = Instant::now();
        let size = stitcher.size();
        let outcome = outcome.and_then(|patch| stitcher.stitch(i, &opening, patch));
        let outcome = outcome.map_err(|failure| PatchFailure {
            error: watch.explain(failure.error),
            tried: failure.tried,
        });
        let seconds = seconds + start.elapsed().as_secs_f64();
        record(&opening, outcome.as_ref(), size, seconds, reports);
    }
}

/// Stitches planned patches into a mesh.
struct Stitcher<'a> {
    mesh: &'a mut TriMesh,
    planner: &'a Planner<'a>,
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

impl<'a> Stitcher<'a> {
    fn new(
        mesh: &'a mut TriMesh,
        planner: &'a Planner<'a>,
        job: &'a Job<'a>,
        planned: &[PlannedOpening],
        planned_at: usize,
    ) -> Self {
        let appended = planned_at..mesh.triangles().len();
        let since = (!appended.is_empty()).then(|| {
            let tree =
                FaceIndex::build(part(mesh, appended.clone()), &Job::unlimited()).expect(UNSTOPPED);
            (appended, tree)
        });
        let box_of = |i: usize| match &planned[i].1 {
            Ok(patch) => patch.bounds(mesh),
            Err(_) => Aabb::empty(),
        };
        let boxes = BoxTree::build(planned.len(), box_of, &Job::unlimited()).expect(UNSTOPPED);
        Self {
            mesh,
            planner,
            job,
            since,
            boxes,
            replanned: Vec::new(),
            stitched: vec![0..0; planned.len()],
        }
    }

    /// Numbers of vertices and triangles.
    fn size(&self) -> [usize; 2] {
        [self.mesh.positions().len(), self.mesh.triangles().len()]
    }

    /// Appends the patch of hole `index`, or makes another one if it no longer fits. Returns the one that was appended.
    fn stitch(&mut self, index: usize, opening: &Opening, mut patch: Patch) -> Outcome {
        let mut triangles = patch.triangles_after(self.mesh.positions().len());
        let mut with_patches = 0;
        let conflict = self.conflict(&patch, &triangles).or_else(|| {
            with_patches = self.intersections_with_patches(&patch, &triangles)
                + self.intersections_since(&patch, &triangles);
            (with_patches > 0).then(|| {
                Error::geometry(format!(
                    "its patch intersects that of another hole {with_patches} times"
                ))
            })
        });
        if let Some(error) = conflict {
            let is_usable = with_patches > 0;
            let methods = self.methods_after(&patch, &error);
            let without_conflict = patch.tried.len();
            let replanned =
                (!methods.is_empty()).then(|| self.replan(opening, &patch, &error, &methods));
            match replanned {
                None => {}
                Some(Ok((other, of_other, count)))
                    if !is_usable
                        || count + other.self_intersections
                            < with_patches + patch.self_intersections =>
                {
                    with_patches = count;
                    self.replanned.push((index, other.bounds(self.mesh)));
                    triangles = of_other;
                    patch = other;
                }
                Some(Err(failure)) if !is_usable => return Err(failure),
                // The patch stands, and the report says what else was tried.
                Some(Ok((other, _, count))) => {
                    patch.tried = other.tried;
                    patch.tried.remove(without_conflict);
                    patch.tried.push(Attempt {
                        method: other.method,
                        reason: format!(
                            "its patch has {} intersecting pairs of triangles, other patches included",
                            count + other.self_intersections
                        ),
                    });
                }
                Some(Err(failure)) => {
                    patch.tried = failure.tried;
                    patch.tried.remove(without_conflict);
                }
            }
        }
        patch.self_intersections += with_patches;
        match self.append(index, &patch, &triangles) {
            Ok(()) => Ok(patch),
            Err(error) => Err(PatchFailure {
                error,
                tried: patch.tried,
            }),
        }
    }

    /// Why the patch no longer fits the mesh.
    fn conflict(&self, patch: &Patch, triangles: &[[u32; 3]]) -> Option<Error> {
        check_against_mesh(self.mesh, &patch.rim_edges, triangles).err()
    }

    /// The methods that are worth trying after a patch that does not fit for the reason `error`.
    fn methods_after(&self, patch: &Patch, error: &Error) -> Vec<Method> {
        // A new edge may block a chord: the same method can find another way. An intersection calls for
        // another shape.
        let is_blocked = error.kind() == ErrorKind::Topology;
        chain(self.planner.options)
            .into_iter()
            .skip_while(|&m| m != patch.method)
            .skip(usize::from(!is_blocked))
            .collect()
    }

    /// Plans the hole anew on the mesh as it is, by one of `methods`. Returns the triangles of the patch besides, and how
    /// many pairs intersect with patches stitched so far.
    fn replan(
        &self,
        opening: &Opening,
        patch: &Patch,
        error: &Error,
        methods: &[Method],
    ) -> std::result::Result<(Patch, Vec<[u32; 3]>, usize), PatchFailure> {
        let mut tried = patch.tried.clone();
        tried.push(Attempt {
            method: patch.method,
            reason: error.to_string(),
        });
        let outcome = self.planner.plan(self.mesh, opening, methods, self.job);
        let mut other = match outcome {
            Ok(other) => other,
            Err(mut failure) => {
                tried.append(&mut failure.tried);
                return Err(PatchFailure {
                    error: failure.error,
                    tried,
                });
            }
        };
        tried.append(&mut other.tried);
        other.tried = tried;
        let triangles = other.triangles_after(self.mesh.positions().len());
        match self.conflict(&other, &triangles) {
            Some(error) => Err(PatchFailure {
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
    fn intersections_with_patches(&self, patch: &Patch, triangles: &[[u32; 3]]) -> usize {
        let own_box = patch.bounds(self.mesh);
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
        near.iter()
            .map(|&i| self.stitched[i as usize].clone())
            .filter(|range| !range.is_empty())
            .map(|range| {
                let other = part(self.mesh, range);
                let faces = FaceIndex::build(other, &Job::unlimited()).expect(UNSTOPPED);
                intersections(other, &faces, patch.appended(triangles))
            })
            .sum()
    }

    /// Pairs of triangles of the patch and of what was appended after it was planned that intersect.
    fn intersections_since(&self, patch: &Patch, triangles: &[[u32; 3]]) -> usize {
        let Some((range, tree)) = &self.since else {
            return 0;
        };
        let part = part(self.mesh, range.clone());
        intersections(part, tree, patch.appended(triangles))
    }

    fn append(&mut self, index: usize, patch: &Patch, triangles: &[[u32; 3]]) -> Result<()> {
        let first = self.mesh.triangles().len();
        let points: Vec<[f64; 3]> = patch.points.iter().map(|&p| p.into()).collect();
        let attributes = &patch.attributes;
        self.mesh
            .append(&points, triangles, &patch.twins, |of_vertices, of_faces| {
                attributes.append_to(of_vertices, of_faces)
            })?;
        self.stitched[index] = first..first + triangles.len();
        Ok(())
    }
}

fn part(mesh: &TriMesh, range: Range<usize>) -> Surface<'_> {
    Surface {
        points: mesh.points(),
        triangles: &mesh.triangles()[range],
    }
}
