//! Counts the improper intersections of a patch with itself and with the mesh it was made for.
//!
//! Small patches are swept along their longest axis; large ones get a [`BoxTree`] of their own
//! and are searched in parallel. The mesh is asked through its index, triangle by triangle.
//!
//! Complexity: O(m log n + k) for m patch triangles, n mesh faces and k pairs of overlapping boxes.
//! What counts is said in [`intersects_improperly`]. Each pair of triangles counts once; pairs
//! within the mesh are never looked at. Not guaranteed: pairs in two different patches are found
//! only when both are passed as one.

use super::{
    Surface,
    intersect::{COPLANAR, intersects_improperly},
    spatial::FaceIndex,
};
use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::math::box_tree::BoxTree;
use rayon::prelude::*;

/// Patch triangles up to which sweeping beats building a tree.
const SWEEP_MAX: usize = 256;

/// Patch triangles searched as one piece of parallel work.
const CHUNK: usize = 256;

/// Pairs that are reported by name.
const EXAMPLES: usize = 8;

/// The triangles of one or more patches in the vertex ids of the mesh they will be appended to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AppendedPatch<'a> {
    /// Positions of the new vertices: the first has id `mesh.points.len()`.
    pub(crate) points: &'a [Vec3],
    /// Triangles of mesh vertices and new vertices.
    pub(crate) triangles: &'a [[u32; 3]],
}

/// When to stop looking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Search {
    /// Count every pair.
    All,
    /// Stop early once something is found; the counts are then lower bounds.
    First,
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
pub(crate) fn count(
    mesh: Surface<'_>,
    faces: &FaceIndex,
    patch: AppendedPatch<'_>,
    search: Search,
) -> SelfIntersections {
    let corners: Vec<[Vec3; 3]> = patch
        .triangles
        .iter()
        .map(|triangle| {
            triangle.map(|v| match (v as usize).checked_sub(mesh.points.len()) {
                Some(new) => patch.points[new],
                None => mesh.points[v as usize],
            })
        })
        .collect();
    let boxes: Vec<Aabb> = corners.iter().map(grown_box).collect();
    let task = Task {
        mesh,
        faces,
        corners: &corners,
        boxes: &boxes,
        search,
    };
    if corners.len() <= SWEEP_MAX {
        task.sweep()
    } else {
        task.search_in_parallel()
    }
}

/// The box of a triangle with room for those that lie in its plane but for rounding.
fn grown_box(triangle: &[Vec3; 3]) -> Aabb {
    let Aabb { lo, hi } = Aabb::around(triangle);
    let room = Vec3::repeat(COPLANAR * (hi - lo).max());
    Aabb {
        lo: lo - room,
        hi: hi + room,
    }
}

struct Task<'a> {
    mesh: Surface<'a>,
    faces: &'a FaceIndex,
    /// Patch triangles and their boxes.
    corners: &'a [[Vec3; 3]],
    boxes: &'a [Aabb],
    search: Search,
}

impl Task<'_> {
    fn is_done(&self, tally: &SelfIntersections) -> bool {
        self.search == Search::First && tally.total() > 0
    }

    fn sweep(&self) -> SelfIntersections {
        let whole = self.boxes.iter().fold(Aabb::empty(), |all, b| all.union(b));
        let axis = (whole.hi - whole.lo).imax();
        let mut order: Vec<usize> = (0..self.boxes.len()).collect();
        order.sort_unstable_by(|&i, &j| {
            self.boxes[i].lo[axis]
                .total_cmp(&self.boxes[j].lo[axis])
                .then(i.cmp(&j))
        });
        let mut partners = vec![Vec::new(); self.boxes.len()];
        for (k, &i) in order.iter().enumerate() {
            for &j in &order[k + 1..] {
                if self.boxes[j].lo[axis] > self.boxes[i].hi[axis] {
                    break;
                }
                if self.boxes[i].overlaps(&self.boxes[j])
                    && intersects_improperly(&self.corners[i], &self.corners[j])
                {
                    partners[i.min(j)].push(i.max(j) as u32);
                }
            }
        }
        let mut tally = SelfIntersections::default();
        let mut found = Vec::new();
        for (i, partners) in partners.iter_mut().enumerate() {
            partners.sort_unstable();
            for &j in partners.iter() {
                tally.add(Pair::WithinPatch(i as u32, j));
            }
            if self.is_done(&tally) {
                break;
            }
            self.against_mesh(i, &mut found, &mut tally);
            if self.is_done(&tally) {
                break;
            }
        }
        tally
    }

    fn against_mesh(&self, i: usize, found: &mut Vec<u32>, tally: &mut SelfIntersections) {
        self.faces.overlapping(&self.boxes[i], found);
        for &face in found.iter() {
            if intersects_improperly(&self.corners[i], &self.mesh.corners(face as usize)) {
                tally.add(Pair::WithMesh(i as u32, face));
            }
        }
    }

    fn search_in_parallel(&self) -> SelfIntersections {
        let own = BoxTree::build(self.boxes.len(), |i| self.boxes[i]);
        let chunk_count = self.boxes.len().div_ceil(CHUNK);
        let chunks = (0..chunk_count).into_par_iter().map(|c| {
            let mut tally = SelfIntersections::default();
            let mut found = Vec::new();
            for i in c * CHUNK..((c + 1) * CHUNK).min(self.boxes.len()) {
                own.overlapping(&self.boxes[i], &mut found);
                for &j in found.iter().filter(|&&j| j as usize > i) {
                    if intersects_improperly(&self.corners[i], &self.corners[j as usize]) {
                        tally.add(Pair::WithinPatch(i as u32, j));
                    }
                }
                if !self.is_done(&tally) {
                    self.against_mesh(i, &mut found, &mut tally);
                }
                if self.is_done(&tally) {
                    break;
                }
            }
            tally
        });
        match self.search {
            Search::All => {
                let tallies: Vec<_> = chunks.collect();
                tallies
                    .into_iter()
                    .fold(SelfIntersections::default(), SelfIntersections::merge)
            }
            Search::First => chunks
                .find_first(|tally| self.is_done(tally))
                .unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
        let faces = FaceIndex::build(mesh);
        let all = count(mesh, &faces, patch, Search::All);
        assert_eq!(all, by_all_pairs(mesh, patch));
        let first = count(mesh, &faces, patch, Search::First);
        assert_eq!(first.total() > 0, all.total() > 0);
        assert!(first.within_patch <= all.within_patch && first.with_mesh <= all.with_mesh);
        assert_eq!(first.examples.first(), all.examples.first());
        all
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
                AppendedPatch { points: new, triangles: &of_patch },
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
            };
            let faces = FaceIndex::build(mesh);
            let found = count(mesh, &faces, patch, Search::All);
            assert_eq!(found, by_all_pairs(mesh, patch));
        }
    }
}
