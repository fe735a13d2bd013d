//! Counts the improper intersections of a patch with itself and with the mesh it was made for.
//!
//! [`intersects_improperly`] defines an improper intersection. Each pair of triangles counts once. Pairs of two mesh
//! faces are not tested.
//!
//! Small patches are swept along their longest axis. Large ones get a [`BoxTree`] of their own and are searched in
//! pieces, in parallel. Mesh faces are found through the index of the mesh. Most pairs with overlapping boxes are
//! neighbors; a [`Separator`] rejects them quickly.
//!
//! Complexity: O(m log n + k) for m patch triangles, n mesh faces and k pairs of overlapping boxes. Not guaranteed:
//! pairs in two different patches are found only if both patches are passed as one.

use super::{
    Surface,
    intersect::{COPLANAR, intersects_improperly},
    projection::covers_nothing_twice,
    separation::Separator,
    spatial::FaceIndex,
};
use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::math::box_tree::BoxTree;
use rayon::prelude::*;

/// Number of patch triangles in one piece of parallel work. A patch of at most this size is swept, which is faster than
/// building a tree.
const PIECE: usize = 256;

/// Upper bound on the mesh faces near the patch, for each patch triangle, for which a sweep is used. With more, the
/// index is searched for each triangle.
const NEAR_PER_TRIANGLE: usize = 8;

/// Number of successive patch triangles in the sweep that can be skipped together.
const CHUNK: usize = 16;

/// Upper bound on the triangles of a patch for which a proof is tried. Its cost can grow with the square of the
/// outline.
const PROVABLE: usize = 4096;

/// Upper bound on the pairs that are listed.
const EXAMPLES: usize = 8;

/// The triangles of one or more patches in the vertex ids of the mesh they will be appended to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AppendedPatch<'a> {
    /// Positions of the new vertices: the first has id `mesh.points.len()`.
    pub(crate) points: &'a [Vec3],
    /// Triangles of mesh vertices and new vertices.
    pub(crate) triangles: &'a [[u32; 3]],
    /// For each halfedge of the triangles the other one of its edge, from
    /// [`pair_halfedges`](crate::mesh::pairing::pair_halfedges), in whatever numbering of the vertices.
    pub(crate) twins: &'a [u32],
}

/// Two triangles that intersect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pair {
    /// Two triangles of the patch, the lower index first.
    WithinPatch(u32, u32),
    /// A triangle of the patch and a face of the mesh.
    WithMesh(u32, u32),
}

/// The improper intersections of a patch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct SelfIntersections {
    /// Pairs of patch triangles.
    pub(crate) within_patch: usize,
    /// Pairs of a patch triangle and a mesh face.
    pub(crate) with_mesh: usize,
    /// The first few pairs, by patch triangle.
    pub(crate) examples: Vec<Pair>,
}

impl SelfIntersections {
    /// Pairs of both kinds.
    pub(crate) fn total(&self) -> usize {
        self.within_patch + self.with_mesh
    }

    fn add(&mut self, pair: Pair) {
        match pair {
            Pair::WithinPatch(..) => self.within_patch += 1,
            Pair::WithMesh(..) => self.with_mesh += 1,
        }
        if self.examples.len() < EXAMPLES {
            self.examples.push(pair);
        }
    }

    fn merge(mut self, later: Self) -> Self {
        self.within_patch += later.within_patch;
        self.with_mesh += later.with_mesh;
        let room = EXAMPLES - self.examples.len();
        self.examples.extend(later.examples.into_iter().take(room));
        self
    }
}

/// Counts the improper intersections of `patch` with itself and with `mesh`, which `faces`
/// indexes.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
pub(crate) fn count(
    mesh: Surface<'_>,
    faces: &FaceIndex,
    patch: AppendedPatch<'_>,
    job: &Job<'_>,
) -> Result<SelfIntersections> {
    let corners_of = |triangle: &[u32; 3]| {
        triangle.map(|v| match (v as usize).checked_sub(mesh.points.len()) {
            Some(new) => patch.points[new],
            None => mesh.points[v as usize],
        })
    };
    let corners: Vec<[Vec3; 3]> = patch.triangles.iter().map(corners_of).collect();
    let boxes: Vec<Aabb> = corners.iter().map(grown_box).collect();
    let task = TriangleSearch {
        mesh,
        faces,
        triangles: patch.triangles,
        corners: &corners,
        boxes: &boxes,
    };
    let is_sound =
        corners.len() <= PROVABLE && covers_nothing_twice(patch.triangles, patch.twins, &corners);
    if corners.len() <= PIECE {
        Ok(task.sweep(is_sound))
    } else {
        task.search_in_parallel(is_sound, job)
    }
}

/// The box of a triangle, grown by a margin so that it overlaps the boxes of triangles nearly in its plane.
fn grown_box(triangle: &[Vec3; 3]) -> Aabb {
    let Aabb { lo, hi } = Aabb::around(triangle);
    let room = Vec3::repeat(COPLANAR * (hi - lo).max());
    Aabb {
        lo: lo - room,
        hi: hi + room,
    }
}

struct TriangleSearch<'a> {
    mesh: Surface<'a>,
    faces: &'a FaceIndex,
    /// Patch triangles with their corners and boxes.
    triangles: &'a [[u32; 3]],
    corners: &'a [[Vec3; 3]],
    boxes: &'a [Aabb],
}

impl TriangleSearch<'_> {
    /// The planes of triangle `i`, kept in `known`.
    fn separator<'s>(&self, i: usize, known: &'s mut [Option<Separator>]) -> &'s Separator {
        known[i].get_or_insert_with(|| Separator::new(self.triangles[i], self.corners[i]))
    }

    /// Adds patch triangles `i`, with its separator, and `j` to `pairs` if they intersect improperly.
    fn try_patch(&self, i: usize, separator: &Separator, j: usize, pairs: &mut Vec<Pair>) {
        if !separator.clears(&self.triangles[j], &self.corners[j])
            && intersects_improperly(&self.corners[i], &self.corners[j])
        {
            pairs.push(Pair::WithinPatch(i.min(j) as u32, i.max(j) as u32));
        }
    }

    /// Adds patch triangle `i`, with its separator, and `face` to `pairs` if they intersect improperly.
    fn try_mesh(&self, i: usize, separator: &Separator, face: u32, pairs: &mut Vec<Pair>) {
        let corners = self.mesh.corners(face as usize);
        if !separator.clears(&self.mesh.triangles[face as usize], &corners)
            && intersects_improperly(&self.corners[i], &corners)
        {
            pairs.push(Pair::WithMesh(i as u32, face));
        }
    }

    /// Searches a patch of one piece along the axis of its largest extent; within itself only unless it `is_sound`.
    fn sweep(&self, is_sound: bool) -> SelfIntersections {
        let whole = self.boxes.iter().fold(Aabb::empty(), |all, b| all.union(b));
        let axis = (whole.hi - whole.lo).imax();
        let mut order: Vec<(f64, usize)> = self.boxes.iter().map(|b| b.lo[axis]).zip(0..).collect();
        order.sort_unstable_by(|(a, i), (b, j)| a.total_cmp(b).then(i.cmp(j)));
        let swept: Vec<(Aabb, usize)> = order.iter().map(|&(_, i)| (self.boxes[i], i)).collect();
        // In a patch without intersections of its own, only few triangles are near the mesh.
        let mut separators = vec![None; self.boxes.len()];
        let mut pairs = Vec::new();
        let unproved = if is_sound { &[] } else { &swept[..] };
        for (k, (a, i)) in unproved.iter().enumerate() {
            for (b, j) in &swept[k + 1..] {
                if b.lo[axis] > a.hi[axis] {
                    break;
                }
                if a.overlaps(b) {
                    let separator = self.separator(*i, &mut separators);
                    self.try_patch(*i, separator, *j, &mut pairs);
                }
            }
        }
        let mut near = Vec::new();
        let limit = NEAR_PER_TRIANGLE * self.boxes.len();
        if self
            .faces
            .tree()
            .overlapping_at_most(limit, &whole, &mut near)
        {
            let reach = |chunk: &[(Aabb, usize)]| {
                chunk.iter().fold(Aabb::empty(), |all, (b, _)| all.union(b))
            };
            let reaches: Vec<Aabb> = swept.chunks(CHUNK).map(reach).collect();
            for &face in &near {
                let a = Aabb::around(&self.mesh.corners(face as usize));
                let chunks = swept.chunks(CHUNK).zip(&reaches);
                for (chunk, _) in chunks.filter(|(_, reach)| a.overlaps(reach)) {
                    for (_, i) in chunk.iter().filter(|(b, _)| a.overlaps(b)) {
                        let separator = self.separator(*i, &mut separators);
                        self.try_mesh(*i, separator, face, &mut pairs);
                    }
                }
            }
        } else {
            for i in 0..self.boxes.len() {
                let separator = self.separator(i, &mut separators);
                self.search_mesh(i, separator, &mut near, &mut pairs);
            }
        }
        tally(pairs)
    }

    /// Searches the mesh near triangle `i`, with its separator; `found` is overwritten.
    fn search_mesh(
        &self,
        i: usize,
        separator: &Separator,
        found: &mut Vec<u32>,
        pairs: &mut Vec<Pair>,
    ) {
        self.faces.overlapping(&self.boxes[i], found);
        for &face in found.iter() {
            self.try_mesh(i, separator, face, pairs);
        }
    }

    fn search_in_parallel(&self, is_sound: bool, job: &Job<'_>) -> Result<SelfIntersections> {
        let own = if is_sound {
            None
        } else {
            let box_of = |i: usize| self.boxes[i];
            Some(BoxTree::build(self.boxes.len(), box_of, job)?)
        };
        let pieces = 0..self.boxes.len().div_ceil(PIECE);
        let search = |p: usize| {
            let piece = p * PIECE..((p + 1) * PIECE).min(self.boxes.len());
            let mut pairs = Vec::new();
            let mut found = Vec::new();
            for i in piece {
                let separator = &Separator::new(self.triangles[i], self.corners[i]);
                // Next to long thin triangles, one search may take milliseconds.
                job.ask()?;
                if let Some(own) = &own {
                    own.overlapping(&self.boxes[i], &mut found);
                    for &j in found.iter().filter(|&&j| j as usize > i) {
                        self.try_patch(i, separator, j as usize, &mut pairs);
                    }
                }
                self.search_mesh(i, separator, &mut found, &mut pairs);
            }
            Ok(tally(pairs))
        };
        // With one thread, a pool would only cost time.
        let tallies: Vec<_> = if rayon::current_num_threads() == 1 {
            pieces.map(search).collect::<Result<_>>()?
        } else {
            pieces.into_par_iter().map(search).collect::<Result<_>>()?
        };
        Ok(tallies
            .into_iter()
            .fold(SelfIntersections::default(), SelfIntersections::merge))
    }
}

/// Counts pairs, by the patch triangle.
fn tally(mut pairs: Vec<Pair>) -> SelfIntersections {
    pairs.sort_unstable_by_key(|&pair| match pair {
        Pair::WithinPatch(i, j) => (i, 0, j),
        Pair::WithMesh(i, face) => (i, 1, face),
    });
    let mut tally = SelfIntersections::default();
    pairs.into_iter().for_each(|pair| tally.add(pair));
    tally
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::halfedge::BOUNDARY;
    use crate::mesh::pairing::pair_halfedges;
    use proptest::prelude::*;

    /// All pairs, without boxes.
    fn by_all_pairs(mesh: Surface<'_>, patch: AppendedPatch<'_>) -> SelfIntersections {
        let points = [mesh.points, patch.points].concat();
        let corners = |t: &[u32; 3]| t.map(|v| points[v as usize]);
        let mut tally = SelfIntersections::default();
        for (i, t) in patch.triangles.iter().enumerate() {
            for (j, u) in patch.triangles.iter().enumerate().skip(i + 1) {
                if intersects_improperly(&corners(t), &corners(u)) {
                    tally.add(Pair::WithinPatch(i as u32, j as u32));
                }
            }
            for (j, u) in mesh.triangles.iter().enumerate() {
                if intersects_improperly(&corners(t), &corners(u)) {
                    tally.add(Pair::WithMesh(i as u32, j as u32));
                }
            }
        }
        tally
    }

    fn check(mesh: Surface<'_>, patch: AppendedPatch<'_>) -> SelfIntersections {
        let faces = FaceIndex::build(mesh, &Job::unlimited()).unwrap();
        let found = count(mesh, &faces, patch, &Job::unlimited()).unwrap();
        assert_eq!(found, by_all_pairs(mesh, patch));
        found
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(60))]

        #[test]
        fn the_count_is_that_of_all_pairs(
            points in proptest::collection::vec(
                ((-5i32..5).prop_map(f64::from), -5.0..5.0, -5.0..5.0), 12..200),
            split in 3usize..9,
            triangles in proptest::collection::vec([any::<u16>(), any::<u16>(), any::<u16>()], 1..400),
        ) {
            let points: Vec<Vec3> = points.into_iter().map(|(x, y, z)| Vec3::new(x, y, z)).collect();
            let (own, new) = points.split_at(split);
            let ids = |t: &[u16; 3], n: usize| t.map(|v| u32::from(v) % n as u32);
            let (of_mesh, of_patch) = triangles.split_at(triangles.len() / 10);
            let of_mesh: Vec<_> = of_mesh.iter().map(|t| ids(t, split)).collect();
            let of_patch: Vec<_> = of_patch.iter().map(|t| ids(t, points.len())).collect();
            check(
                Surface { points: own, triangles: &of_mesh },
                AppendedPatch { points: new, triangles: &of_patch, twins: &pair_halfedges(&of_patch, points.len()) },
            );
        }
    }

    /// A sheet of 2 n^2 triangles over the unit square at height `z(x, y)`.
    fn sheet(n: u32, first_id: u32, z: impl Fn(f64, f64) -> f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut points = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..=n {
            for j in 0..=n {
                let (x, y) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                points.push(Vec3::new(x, y, z(x, y)));
                if i < n && j < n {
                    let a = first_id + i * (n + 1) + j;
                    triangles.push([a, a + n + 1, a + 1]);
                    triangles.push([a + n + 1, a + n + 2, a + 1]);
                }
            }
        }
        (points, triangles)
    }

    #[test]
    fn a_sound_sheet_has_no_intersection_at_any_size() {
        for n in [1, 4, 11, 12, 30] {
            let (points, triangles) = sheet(n, 0, |x, y| 0.2 * (5.0 * x).sin() * (4.0 * y).cos());
            let (own, rest) = triangles.split_at(triangles.len() / 2);
            let mesh = Surface {
                points: &points,
                triangles: own,
            };
            let found = check(
                mesh,
                AppendedPatch {
                    points: &[],
                    triangles: rest,
                    twins: &pair_halfedges(rest, points.len()),
                },
            );
            assert_eq!(found, SelfIntersections::default(), "n = {n}");
        }
    }

    #[test]
    fn a_bump_through_the_mesh_is_counted_on_both_paths() {
        for n in [6, 20] {
            let (points, triangles) = sheet(n, 0, |_, _| 0.01);
            let mesh = Surface {
                points: &points,
                triangles: &triangles,
            };
            let first_id = points.len() as u32;
            let (bump, bump_triangles) =
                sheet(n, first_id, |x, y| 0.3 * (6.0 * x).sin() * (6.0 * y).sin());
            let patch = AppendedPatch {
                points: &bump,
                triangles: &bump_triangles,
                twins: &pair_halfedges(&bump_triangles, points.len() + bump.len()),
            };
            let found = check(mesh, patch);
            assert!(found.with_mesh >= n as usize && found.within_patch == 0);
            assert!(found.examples.len() == EXAMPLES);
        }
    }

    #[test]
    fn a_duplicate_of_a_mesh_face_is_found() {
        let points = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let mesh = Surface {
            points: &points,
            triangles: &[[0, 1, 2]],
        };
        let patch = AppendedPatch {
            points: &[],
            triangles: &[[0, 2, 1]],
            twins: &[BOUNDARY; 3],
        };
        assert_eq!(check(mesh, patch).examples, [Pair::WithMesh(0, 0)]);
    }

    #[test]
    fn a_second_layer_apart_only_by_rounding_is_found() {
        let points = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let layer = points.map(|p| p + Vec3::new(0.1, 0.1, 1e-15));
        let mesh = Surface {
            points: &points,
            triangles: &[[0, 1, 2]],
        };
        let patch = AppendedPatch {
            points: &layer,
            triangles: &[[3, 4, 5]],
            twins: &[BOUNDARY; 3],
        };
        assert_eq!(check(mesh, patch).with_mesh, 1);
    }

    #[test]
    fn nothing_and_degenerate_triangles_intersect_nothing() {
        let points = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::repeat(f64::NAN)];
        for triangles in [vec![], vec![[0, 0, 0], [1, 1, 2], [0, 1, 3], [3, 3, 3]]] {
            let mesh = Surface {
                points: &points,
                triangles: &triangles,
            };
            let patch = AppendedPatch {
                points: &[],
                triangles: &triangles,
                twins: &pair_halfedges(&triangles, points.len()),
            };
            let faces = FaceIndex::build(mesh, &Job::unlimited()).unwrap();
            let found = count(mesh, &faces, patch, &Job::unlimited()).unwrap();
            assert_eq!(found, by_all_pairs(mesh, patch));
        }
    }
}
