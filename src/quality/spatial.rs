//! A static spatial index over the faces of a mesh: a tree of their boxes, for searches by box and by distance.

use super::{Surface, closest::closest_on_triangle};
use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::math::box_tree::BoxTree;
use std::cmp::Ordering;

/// The face nearest to a query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    /// Index of the face.
    pub(crate) face: u32,
    /// The closest point on it.
    pub(crate) point: Vec3,
    /// Squared distance from the query point.
    pub(crate) distance_sq: f64,
}

/// Finds faces by box and by distance.
///
/// Complexity: build O(n log n) in parallel; box query O(log n + hits) and nearest face O(log n) for
/// surfaces of the usual kind, O(n) at worst.
#[derive(Clone, Debug)]
pub(crate) struct FaceIndex {
    tree: BoxTree,
}

impl FaceIndex {
    /// Indexes all faces of a surface of at most `u32::MAX` faces.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(crate) fn build(surface: Surface<'_>, job: &Job<'_>) -> Result<Self> {
        let box_of = |f| Aabb::around(&surface.corners(f));
        let tree = BoxTree::build(surface.triangles.len(), box_of, job)?;
        Ok(Self { tree })
    }

    /// Puts all faces whose box overlaps `query` into `found`, in ascending order; `found` is
    /// cleared first.
    ///
    /// Faces whose box is apart by no more than a single-precision rounding may be included.
    pub(crate) fn overlapping(&self, query: &Aabb, found: &mut Vec<u32>) {
        self.tree.overlapping(query, found);
    }

    /// The tree of the faces' boxes.
    pub(crate) fn tree(&self) -> &BoxTree {
        &self.tree
    }

    /// The face of `surface`, which must be the one indexed, nearest to `p`; `None` when there is
    /// no face or `p` is not finite.
    ///
    /// Of faces at equal distance the lowest index wins. Exact up to rounding: a face further by
    /// some 2^-52 of the mesh's extent may stand in for the nearest.
    pub(crate) fn nearest(&self, surface: Surface<'_>, p: &Vec3) -> Option<Nearest> {
        if !p.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut best: Option<Nearest> = None;
        self.tree.search_near(p, |face| {
            let point = closest_on_triangle(p, &surface.corners(face as usize));
            let distance_sq = (p - point).norm_squared();
            let better = match &best {
                None => !distance_sq.is_nan(),
                Some(best) => match distance_sq.total_cmp(&best.distance_sq) {
                    Ordering::Less => true,
                    Ordering::Equal => face < best.face,
                    Ordering::Greater => false,
                },
            };
            if better {
                best = Some(Nearest {
                    face,
                    point,
                    distance_sq,
                });
            }
            best.map_or(f64::INFINITY, |best| best.distance_sq)
        });
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn soup(points: &[[f64; 3]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let n = points.len() as u32 / 3;
        let points = points.iter().map(|&p| p.into()).collect();
        (
            points,
            (0..n).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(),
        )
    }

    fn coordinates(faces: usize) -> impl Strategy<Value = Vec<[f64; 3]>> {
        // Few distinct values, so that boxes touch and faces degenerate.
        let coarse = (-4i32..4).prop_map(f64::from);
        let x = prop_oneof![coarse, -4.0..4.0f64];
        proptest::collection::vec([x.clone(), x.clone(), x], 0..3 * faces)
    }

    fn check_box_query(surface: Surface<'_>, query: &Aabb) {
        let mut found = vec![7];
        FaceIndex::build(surface, &Job::unlimited())
            .unwrap()
            .overlapping(query, &mut found);
        assert!(found.is_sorted_by(|a, b| a < b), "ascending, each once");
        // The slack of single precision in a cube of the mesh's size.
        let extent = Aabb::around(surface.points);
        let slack = Vec3::repeat((extent.hi - extent.lo).max().max(0.0) * 1e-6);
        let wide = Aabb {
            lo: query.lo - slack,
            hi: query.hi + slack,
        };
        for face in 0..surface.triangles.len() {
            let b = Aabb::around(&surface.corners(face));
            let hit = found.binary_search(&(face as u32)).is_ok();
            assert!(hit || !b.overlaps(query), "face {face} was missed");
            assert!(!hit || b.overlaps(&wide), "face {face} is far away");
        }
    }

    proptest! {
        #[test]
        fn a_box_query_finds_what_all_pairs_find(
            raw in coordinates(60), corners in [[-5.0..5.0f64, -5.0..5.0, -5.0..5.0], [-5.0..5.0, -5.0..5.0, -5.0..5.0]],
            shift in prop_oneof![Just(0.0), Just(1e7)], scale in prop_oneof![Just(1.0), Just(1e-9), Just(1e12)],
        ) {
            let place = |p: [f64; 3]| p.map(|x| x * scale + shift);
            let raw: Vec<_> = raw.into_iter().map(place).collect();
            let (points, triangles) = soup(&raw);
            let query = Aabb::around(&corners.map(|p| place(p).into()));
            check_box_query(Surface { points: &points, triangles: &triangles }, &query);
        }

        #[test]
        fn the_nearest_face_is_as_near_as_the_best_of_all(
            raw in coordinates(60), p in [-9.0..9.0f64, -9.0..9.0, -9.0..9.0],
        ) {
            let (points, triangles) = soup(&raw);
            let surface = Surface { points: &points, triangles: &triangles };
            let p = Vec3::from(p);
            let best = (0..triangles.len())
                .map(|f| (closest_on_triangle(&p, &surface.corners(f)) - p).norm_squared())
                .min_by(f64::total_cmp);
            let found = FaceIndex::build(surface, &Job::unlimited()).unwrap().nearest(surface, &p);
            prop_assert_eq!(found.map(|n| n.distance_sq), best);
        }
    }

    /// A bumpy sheet of 2 n^2 triangles.
    fn sheet(n: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut points = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..=n {
            for j in 0..=n {
                let (x, y) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                points.push(Vec3::new(x, y, 0.1 * (9.0 * x).sin() * (7.0 * y).cos()));
                if i < n && j < n {
                    let a = i * (n + 1) + j;
                    triangles.push([a, a + n + 1, a + 1]);
                    triangles.push([a + n + 1, a + n + 2, a + 1]);
                }
            }
        }
        (points, triangles)
    }

    #[test]
    fn every_count_round_the_fanout_is_searched_completely() {
        let (points, triangles) = sheet(12);
        for count in [0, 1, 7, 8, 9, 63, 64, 65, 288] {
            let surface = Surface {
                points: &points,
                triangles: &triangles[..count],
            };
            let index = FaceIndex::build(surface, &Job::unlimited()).unwrap();
            let mut found = Vec::new();
            index.overlapping(&Aabb::around(&points), &mut found);
            assert_eq!(found, (0..count as u32).collect::<Vec<_>>());
            for f in 0..count {
                let centroid = surface.corners(f).iter().sum::<Vec3>() / 3.0;
                let nearest = index.nearest(surface, &centroid);
                assert_eq!(nearest.map(|n| n.face as usize), Some(f));
            }
        }
    }

    #[test]
    fn the_build_does_not_depend_on_the_thread_count() {
        let (points, triangles) = sheet(120);
        let surface = Surface {
            points: &points,
            triangles: &triangles,
        };
        let build = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("pool");
            let index = pool.install(|| FaceIndex::build(surface, &Job::unlimited()).unwrap());
            format!("{index:?}")
        };
        assert_eq!(build(1), build(3));
    }

    #[test]
    fn coordinates_that_are_not_finite_or_coincide_do_no_harm() {
        let nan = Vec3::repeat(f64::NAN);
        let huge = Vec3::repeat(f64::MAX);
        let o = Vec3::zeros();
        for points in [
            vec![nan, nan, nan],
            vec![o, o, o],
            vec![o, nan, huge],
            vec![-huge, o, huge],
        ] {
            let surface = Surface {
                points: &points,
                triangles: &[[0, 1, 2], [0, 0, 0]],
            };
            let index = FaceIndex::build(surface, &Job::unlimited()).unwrap();
            let mut found = Vec::new();
            index.overlapping(&Aabb::around(&[o]), &mut found);
            let _ = index.nearest(surface, &Vec3::x());
            assert_eq!(index.nearest(surface, &nan), None);
        }
        let surface = Surface {
            points: &[o, o, o],
            triangles: &[[0, 1, 2]],
        };
        let mut found = Vec::new();
        FaceIndex::build(surface, &Job::unlimited())
            .unwrap()
            .overlapping(&Aabb::around(&[o]), &mut found);
        assert_eq!(found, [0]);
    }
}
