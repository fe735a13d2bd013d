//! Triangulates the polygon of a hole, in space or in the plane, without new vertices on the polygon.
//!
//! In space, `ear_clip` reduces a large polygon, and `min_weight` finds the minimum-weight triangulation of the rest.
//! In the plane, `planar` makes a constrained Delaunay triangulation, and `simple_polygon` tests whether it can.

mod ear_clip;
mod min_weight;
pub(crate) mod planar;
mod polygon;
pub(crate) mod simple_polygon;
#[cfg(test)]
mod test_polygons;

pub(crate) use polygon::{HolePolygon, Weight, weight_of};

use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::math::Vec3;
use ear_clip::Clipped;
use polygon::ChordRules;

/// Limits on the work of [`triangulate`].
#[derive(Clone, Copy)]
pub(crate) struct TriangulationOptions<'a> {
    /// Polygons of up to this many vertices are searched for the minimum-weight triangulation, in
    /// cubic time (see [`min_weight::MAX_SEARCHED`]); larger ones lose their cheapest ears first.
    pub(crate) exact_limit: usize,
    /// Number of vertices that ear clipping leaves to the search.
    pub(crate) ear_remainder: usize,
    /// The job, which can be cancelled.
    pub(crate) job: &'a Job<'a>,
}

#[cfg(test)]
impl Default for TriangulationOptions<'_> {
    fn default() -> Self {
        Self {
            exact_limit: 150,
            ear_remainder: 64,
            job: &crate::job::UNLIMITED,
        }
    }
}

/// A triangulation of a hole polygon.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Triangulation {
    /// Positions in the polygon, oriented like it.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Their weight, see [`weight_of`].
    pub(crate) weight: Weight,
}

/// Upper bound on how often `ear_remainder` is doubled, if the search finds no triangulation of the remainder.
const MAX_REMAINDER_DOUBLINGS: usize = 2;

/// Triangulates `polygon` with `m - 2` triangles. All have an area. Each polygon edge is used once. No edge is made
/// that is blocked or exists twice.
///
/// # Errors
/// `InvalidInput` when the polygon has fewer than three vertices, lists of unequal length,
/// successive positions of one vertex, or a coordinate that is not finite; `Geometry` or `Topology`
/// when no such triangulation was found; `Limit` when the search would exceed
/// [`min_weight::MAX_SEARCHED`] vertices; `Cancelled`.
///
/// # Complexity
/// O(m³) up to `exact_limit` vertices, O(m log m) beyond.
pub(crate) fn triangulate(
    polygon: &HolePolygon<'_>,
    options: &TriangulationOptions<'_>,
) -> Result<Triangulation> {
    polygon.validate()?;
    let triangles = if polygon.len() <= options.exact_limit {
        min_weight::search(polygon, options.job)?
    } else {
        clip_then_search(polygon, options)?
    };
    options.job.ask()?;
    let weight = weight_of(polygon, &triangles)?;
    Ok(Triangulation { triangles, weight })
}

fn clip_then_search(
    polygon: &HolePolygon<'_>,
    options: &TriangulationOptions<'_>,
) -> Result<Vec<[u32; 3]>> {
    let rules = ChordRules::new(polygon);
    let mut failure = None;
    for doubling in 0..=MAX_REMAINDER_DOUBLINGS {
        let target = options.ear_remainder.max(3).saturating_mul(1 << doubling);
        options.job.ask()?;
        let clipped = ear_clip::clip(polygon, &rules, target, options.job)?;
        match search_rest(polygon, &rules, &clipped, options) {
            Ok(rest) => {
                let mut triangles = clipped.ears;
                triangles.extend(rest);
                return Ok(triangles);
            }
            Err(error) if error.kind() == ErrorKind::Cancelled => return Err(error),
            Err(error) => failure = Some(error),
        }
        if clipped.rest.len() > target {
            break; // Clipping ended for want of ears: it would leave the same again.
        }
    }
    Err(failure.unwrap_or_else(|| Error::limit("no work was allowed")))
}

fn search_rest(
    polygon: &HolePolygon<'_>,
    rules: &ChordRules<'_>,
    clipped: &Clipped,
    options: &TriangulationOptions<'_>,
) -> Result<Vec<[u32; 3]>> {
    let at = |k: usize| clipped.rest[k] as usize;
    let points: Vec<Vec3> = (0..clipped.rest.len())
        .map(|k| polygon.points[at(k)])
        .collect();
    let ids: Vec<u32> = (0..clipped.rest.len())
        .map(|k| polygon.vertex_ids[at(k)])
        .collect();
    let blocked = |k: usize, l: usize| {
        let pair = (ids[k].min(ids[l]), ids[k].max(ids[l]));
        clipped.joined.contains(&pair) || !rules.admit(at(k), at(l))
    };
    let rest = HolePolygon {
        points: &points,
        outside_normals: &clipped.rest_normals,
        vertex_ids: &ids,
        blocked: &blocked,
    };
    let triangles = min_weight::search(&rest, options.job)?;
    Ok(triangles
        .iter()
        .map(|t| t.map(|k| clipped.rest[k as usize]))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::min_weight::MAX_SEARCHED;
    use super::test_polygons::*;
    use super::*;
    use proptest::prelude::*;

    fn searched() -> TriangulationOptions<'static> {
        TriangulationOptions {
            exact_limit: MAX_SEARCHED,
            ..Default::default()
        }
    }

    fn clipped() -> TriangulationOptions<'static> {
        TriangulationOptions {
            exact_limit: 0,
            ear_remainder: 8,
            ..Default::default()
        }
    }

    /// `weight_of` in `triangulate` has checked the edges: with all positions in one piece this is
    /// a disk (V - E + F = m - (2m - 3) + (m - 2) = 1).
    fn is_connected(triangles: &[[u32; 3]], len: usize) -> bool {
        let mut reached = vec![false; len];
        reached[0] = true;
        for _ in 0..len {
            for t in triangles {
                if t.iter().any(|&i| reached[i as usize]) {
                    t.iter().for_each(|&i| reached[i as usize] = true);
                }
            }
        }
        reached.iter().all(|&r| r)
    }

    proptest! {
        #[test]
        fn every_result_is_a_disk_spanned_by_the_polygon(rim in arbitrary_rim(3..60)) {
            for options in [searched(), clipped(), Default::default()] {
                let found = triangulate(&rim.polygon(), &options);
                let found = found.expect("points in general position always have a triangulation");
                prop_assert_eq!(found.triangles.len(), rim.points.len() - 2);
                prop_assert!(is_connected(&found.triangles, rim.points.len()));
                prop_assert_eq!(weight_of(&rim.polygon(), &found.triangles), Ok(found.weight));
                prop_assert_eq!(triangulate(&rim.polygon(), &options), Ok(found));
            }
        }

        // The largest angle of a triangulation is not that of its parts, so the search is exact only nearly. On rims
        // with waves higher than a tenth of the radius the weights may differ by more.
        #[test]
        fn smooth_rims_weigh_the_same_from_any_start(
            len in 20_usize..60, lobes in 2_u32..4, height in 0.0..0.1_f64, start in 0_usize..20,
        ) {
            let rim = Rim::wavy(len, lobes, height);
            let weight = |rim: &Rim| triangulate(&rim.polygon(), &searched()).expect("found").weight;
            let (here, there) = (weight(&rim), weight(&rim.rotated(start)));
            prop_assert!((here.max_dihedral - there.max_dihedral).abs() < 0.1, "{:?} {:?}", here, there);
            prop_assert!((here.area / there.area - 1.0).abs() < 0.05, "{:?} {:?}", here, there);
        }

        #[test]
        fn arbitrary_repeated_vertices_and_blocked_chords_never_break_the_patch(
            rim in arbitrary_rim(3..30), merged in 2_u32..30, salt in 0_usize..1000,
        ) {
            let mut rim = rim;
            rim.ids.iter_mut().for_each(|id| *id %= merged);
            let blocked = |i: usize, j: usize| (i * 31 + j * 17 + salt).is_multiple_of(7);
            let polygon = HolePolygon { blocked: &blocked, ..rim.polygon() };
            for options in [searched(), clipped()] {
                if let Ok(found) = triangulate(&polygon, &options) {
                    prop_assert!(rim.joins_no_vertices_twice(&found.triangles));
                    for t in &found.triangles {
                        let mut t = t.map(|i| i as usize);
                        t.sort_unstable();
                        for (i, j) in [(t[0], t[1]), (t[1], t[2]), (t[0], t[2])] {
                            let edge = j == i + 1 || (i == 0 && j + 1 == rim.points.len());
                            prop_assert!(edge || !blocked(i, j));
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn scaling_and_moving_the_hole_keeps_the_triangles() {
        let rim = Rim::wavy(50, 3, 0.4);
        let expected = triangulate(&rim.polygon(), &searched())
            .expect("found")
            .triangles;
        for (scale, offset) in [
            (2.0_f64.powi(-40), 0.0),
            (2.0_f64.powi(40), 0.0),
            (1.0, 1024.0),
        ] {
            let mut other = rim.clone();
            other
                .points
                .iter_mut()
                .for_each(|p| *p = *p * scale + Vec3::repeat(offset));
            let found = triangulate(&other.polygon(), &searched()).expect("found");
            let weight = weight_of(&rim.polygon(), &found.triangles).expect("a triangulation");
            let wanted = weight_of(&rim.polygon(), &expected).expect("a triangulation");
            assert!(
                (weight.max_dihedral / wanted.max_dihedral - 1.0).abs() < 1e-9,
                "{scale} {offset}"
            );
        }
    }

    #[test]
    fn wound_and_twisted_rims_are_spanned_by_both_methods() {
        for rim in [Rim::helix(300), Rim::wound(300), Rim::wavy(300, 9, 1.0)] {
            for options in [searched(), clipped(), Default::default()] {
                let found = triangulate(&rim.polygon(), &options).expect("a triangulation");
                assert_eq!(found.triangles.len(), 298);
                assert!(found.triangles.iter().all(|t| rim.area(t) > 0.0));
            }
        }
    }

    #[test]
    fn a_large_plane_hole_is_covered_once() {
        let rim = Rim::planar(&spiral_slit(5_000));
        let found = triangulate(&rim.polygon(), &Default::default()).expect("a triangulation");
        assert!((found.weight.area / rim.planar_area() - 1.0).abs() < 1e-9);
        assert_eq!(found.weight.max_dihedral, 0.0);
    }

    #[test]
    fn an_island_bridged_to_the_rim_gives_a_ring() {
        for half in [3, 5, 20, 40] {
            let rim = Rim::bridged_rings(half);
            for options in [searched(), clipped(), Default::default()] {
                let found = triangulate(&rim.polygon(), &options).expect("a ring");
                assert!(rim.joins_no_vertices_twice(&found.triangles), "{half}");
                assert!(
                    (found.weight.area / rim.planar_area() - 1.0).abs() < 1e-9,
                    "{half}"
                );
            }
        }
    }

    #[test]
    fn a_hole_that_only_existing_edges_could_cut_is_a_topology_error() {
        let rim = Rim::regular(300);
        let polygon = HolePolygon {
            blocked: &|_, _| true,
            ..rim.polygon()
        };
        for options in [searched(), Default::default()] {
            let error = triangulate(&polygon, &options).expect_err("all chords are blocked");
            assert_eq!(error.kind(), ErrorKind::Topology);
        }
    }

    #[test]
    fn a_large_collinear_rim_is_a_geometry_error() {
        let line: Vec<[f64; 2]> = (0..4000)
            .map(|i| [f64::from(i) * 0.1, f64::from(i) * 0.7])
            .collect();
        let error = triangulate(&Rim::planar(&line).polygon(), &Default::default());
        assert_eq!(error.expect_err("no area").kind(), ErrorKind::Geometry);
    }

    #[test]
    fn a_seam_that_is_closed_in_space_gets_no_flat_triangles() {
        let arc = |k: usize| {
            let a = k as f64 * 0.05;
            Vec3::new(a.cos(), a.sin(), 0.1 * (3.0 * a).sin())
        };
        let mut rim = Rim::regular(200);
        rim.points = (0..=100).chain((1..100).rev()).map(arc).collect();
        rim.normals.fill(None);
        for options in [searched(), clipped(), Default::default()] {
            let found = triangulate(&rim.polygon(), &options).expect("a folded triangulation");
            assert!(found.triangles.iter().all(|t| rim.area(t) > 0.0));
        }
    }

    #[test]
    fn the_search_refuses_what_the_caller_forced_on_it() {
        let rim = Rim::regular(MAX_SEARCHED + 1);
        let options = TriangulationOptions {
            exact_limit: usize::MAX,
            ..Default::default()
        };
        let error = triangulate(&rim.polygon(), &options).expect_err("too large");
        assert_eq!(error.kind(), ErrorKind::Limit);
    }

    #[test]
    fn fewer_than_three_vertices_are_invalid_input() {
        let rim = Rim::planar(&[[0., 0.], [1., 0.]]);
        let error = triangulate(&rim.polygon(), &Default::default()).expect_err("two vertices");
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
    }
}
