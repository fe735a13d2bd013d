//! Constrained Delaunay triangulation of a simple polygon in the plane, with given points inside it.
//!
//! Among all triangulations of the polygon with these vertices, it has the largest smallest angle. No vertex is added.
//!
//! Source: L. P. Chew, "Constrained Delaunay triangulations", Algorithmica 4, 1989; the implementation is the crate
//! `spade`. Cost: about O(n log n) for `n` vertices in an order in which successive ones are near, O(n^1.5) otherwise.
//! Not guaranteed: if four vertices lie on a circle, another numbering can give other triangles.

use super::simple_polygon::{Point2, find_contact, is_counter_clockwise};
use crate::error::{Error, Result};
use crate::job::Job;
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, Triangulation, mitigate_underflow};

type Delaunay = ConstrainedDelaunayTriangulation<spade::Point2<f64>>;

/// Triangulates the region between an outer polygon, the first one, and polygons inside it. The points of `interior`
/// are further vertices. Polygons are closed. The outer one may have either orientation; inner ones have the opposite
/// orientation.
///
/// The triangles index the vertices of all polygons, one polygon after the other, and then the interior points. They
/// have the orientation of the outer polygon. Every polygon edge belongs to exactly one triangle. There are `m - 2 +
/// 2 k + 2 h` triangles for `m` polygon vertices, `k` interior points and `h` inner polygons.
///
/// # Errors
/// [`crate::ErrorKind::InvalidInput`] for a coordinate that is not finite or exceeds 10^60; [`crate::ErrorKind::Geometry`] when
/// a polygon is not simple (decided exactly), two polygons meet or one lies outside the first, or an interior point
/// lies outside, on a polygon, or on another interior point; [`crate::ErrorKind::Cancelled`].
pub(crate) fn triangulate_planar_region(
    polygons: &[impl AsRef<[Point2]>],
    interior: &[Point2],
    job: &Job<'_>,
) -> Result<Vec<[u32; 3]>> {
    let points: Vec<spade::Point2<f64>> = polygons
        .iter()
        .flat_map(|polygon| polygon.as_ref())
        .chain(interior)
        // Coordinates that are nearly zero would make the predicates inexact.
        .map(|p| mitigate_underflow(spade::Point2::new(p[0], p[1])))
        .collect();
    if !points.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
        return Err(invalid("a point of the plane is not finite".to_owned()));
    }
    let (m, k) = (points.len() - interior.len(), interior.len());
    let mut edges: Vec<(usize, usize)> = Vec::with_capacity(m);
    let mut is_outer_ccw = true;
    for (h, polygon) in polygons.iter().enumerate() {
        let first = edges.len();
        let n = polygon.as_ref().len();
        let rim: Vec<Point2> = points[first..first + n]
            .iter()
            .map(|p| [p.x, p.y])
            .collect();
        if let Some((i, j)) = find_contact(&rim, job)? {
            return Err(geometry(format!(
                "edges {i} and {j} of a polygon of {n} vertices meet in the plane"
            )));
        }
        if h == 0 {
            is_outer_ccw = is_counter_clockwise(&rim);
        } else if is_counter_clockwise(&rim) == is_outer_ccw {
            let message = "an inner polygon turns like the outer one";
            return Err(geometry(message.to_owned()));
        }
        edges.extend((0..n).map(|i| (first + i, first + (i + 1) % n)));
    }

    let mut delaunay = Delaunay::new();
    let mut vertices = Vec::with_capacity(m + k);
    for &p in &points {
        job.tick(300)?;
        let vertex = delaunay.insert(p);
        vertices.push(vertex.map_err(|e| invalid(format!("a point cannot be used: {e}")))?);
    }
    if delaunay.num_vertices() < m + k {
        return Err(geometry("two points of the plane coincide".to_owned()));
    }
    // The inside is on the left of each edge.
    let edges: Vec<(FixedVertexHandle, FixedVertexHandle)> = edges
        .into_iter()
        .map(|(a, b)| if is_outer_ccw { (a, b) } else { (b, a) })
        .map(|(a, b)| (vertices[a], vertices[b]))
        .collect();
    for &(a, b) in &edges {
        job.tick(300)?;
        if delaunay.try_add_constraint(a, b).is_empty() && polygons.len() > 1 {
            return Err(geometry("two polygons meet in the plane".to_owned()));
        }
    }
    job.ask()?;
    let triangles = inner_triangles(&delaunay, &edges, is_outer_ccw);
    // The number is wrong if an interior point lies on a constraint, which is then cut, or outside, where it adds no
    // triangle.
    if triangles.len() + 2 != m + 2 * k + 2 * (polygons.len() - 1) {
        return Err(geometry(
            "a point to be inside the polygon lies outside or on it".to_owned(),
        ));
    }
    Ok(triangles)
}

/// The triangles inside the rim, found by a walk inward from its edges, which have the inside on their left. Vertices
/// are numbered in the order of insertion.
fn inner_triangles(
    delaunay: &Delaunay,
    edges: &[(FixedVertexHandle, FixedVertexHandle)],
    is_counter_clockwise: bool,
) -> Vec<[u32; 3]> {
    let mut is_inside = vec![false; delaunay.num_all_faces()];
    let mut open: Vec<FixedFaceHandle<InnerTag>> = Vec::new();
    for &(from, to) in edges {
        let edge = delaunay.get_edge_from_neighbors(from, to);
        let face = edge.and_then(|e| e.face().as_inner());
        if let Some(face) = face.filter(|f| !is_inside[f.index()]) {
            is_inside[face.index()] = true;
            open.push(face.fix());
        }
    }
    while let Some(face) = open.pop() {
        for edge in delaunay.face(face).adjacent_edges() {
            if edge.is_constraint_edge() {
                continue;
            }
            let beyond = edge.rev().face().as_inner();
            if let Some(beyond) = beyond.filter(|f| !is_inside[f.index()]) {
                is_inside[beyond.index()] = true;
                open.push(beyond.fix());
            }
        }
    }
    delaunay
        .inner_faces()
        .filter(|f| is_inside[f.index()])
        .map(|f| {
            let [a, b, c] = f.vertices().map(|v| v.index() as u32);
            if is_counter_clockwise {
                [a, b, c]
            } else {
                [a, c, b]
            }
        })
        .collect()
}

fn invalid(message: String) -> Error {
    Error::invalid(message)
}

fn geometry(message: String) -> Error {
    Error::geometry(message)
}

#[cfg(test)]
mod tests {
    use super::super::simple_polygon::turn;
    use super::*;
    use crate::error::ErrorKind;
    use proptest::prelude::*;
    use robust::{Coord, incircle};
    use std::f64::consts::TAU;

    fn triangulate_planar(polygon: &[Point2], interior: &[Point2]) -> Result<Vec<[u32; 3]>> {
        triangulate_planar_region(&[polygon], interior, &Job::unlimited())
    }

    fn star(radii: &[f64]) -> Vec<Point2> {
        let step = TAU / radii.len() as f64;
        radii
            .iter()
            .enumerate()
            .map(|(i, r)| {
                let angle = step * i as f64;
                [r * angle.cos(), r * angle.sin()]
            })
            .collect()
    }

    /// Directed edges, sorted.
    fn edges(triangles: &[[u32; 3]]) -> Vec<(u32, u32)> {
        let mut edges: Vec<_> = triangles
            .iter()
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
            .collect();
        edges.sort_unstable();
        edges
    }

    /// What must hold of every triangulation of a counter-clockwise polygon.
    fn check(polygon: &[Point2], interior: &[Point2], triangles: &[[u32; 3]]) {
        let m = polygon.len() as u32;
        let points = [polygon, interior].concat();
        let at = |v: u32| points[v as usize];
        assert_eq!(triangles.len(), polygon.len() - 2 + 2 * interior.len());
        for t in triangles {
            assert!(turn(at(t[0]), at(t[1]), at(t[2])) > 0.0);
        }
        let edges = edges(triangles);
        assert!(edges.windows(2).all(|e| e[0] != e[1]));
        // Exactly the polygon's edges have one triangle.
        let mut rim: Vec<_> = edges
            .iter()
            .copied()
            .filter(|&(a, b)| edges.binary_search(&(b, a)).is_err())
            .collect();
        rim.sort_unstable();
        let mut expected: Vec<_> = (0..m).map(|i| (i, (i + 1) % m)).collect();
        expected.sort_unstable();
        assert_eq!(rim, expected);
    }

    /// Whether the circle round each triangle is free of the vertex across each edge inside the polygon.
    fn is_delaunay(points: &[Point2], triangles: &[[u32; 3]]) -> bool {
        let at = |v: u32| {
            let [x, y] = points[v as usize];
            Coord { x, y }
        };
        let apex = |a: u32, b: u32| {
            let has = |t: &&[u32; 3]| (0..3).any(|k| t[k] == a && t[(k + 1) % 3] == b);
            let t = triangles.iter().find(has)?;
            t.iter().copied().find(|&v| v != a && v != b)
        };
        triangles.iter().all(|t| {
            (0..3).all(|k| {
                apex(t[(k + 1) % 3], t[k])
                    .is_none_or(|d| incircle(at(t[0]), at(t[1]), at(t[2]), at(d)) <= 0.0)
            })
        })
    }

    #[test]
    fn a_clockwise_polygon_gives_clockwise_triangles() {
        let mut polygon = star(&[1.0, 0.3, 0.8, 0.5, 1.2, 0.4]);
        polygon.reverse();
        let triangles = triangulate_planar(&polygon, &[]).unwrap();
        let at = |v: u32| polygon[v as usize];
        assert_eq!(triangles.len(), 4);
        for t in triangles {
            assert!(turn(at(t[0]), at(t[1]), at(t[2])) < 0.0);
        }
    }

    #[test]
    fn straight_runs_of_rim_vertices_are_kept() {
        let side = 30_usize;
        let polygon: Vec<Point2> = (0..4 * side)
            .map(|i| {
                let along = (i % side) as f64;
                let end = side as f64;
                match i / side {
                    0 => [along, 0.0],
                    1 => [end, along],
                    2 => [end - along, end],
                    _ => [0.0, end - along],
                }
            })
            .collect();
        let triangles = triangulate_planar(&polygon, &[]).unwrap();
        check(&polygon, &[], &triangles);
    }

    #[test]
    fn a_polygon_that_meets_itself_is_refused() {
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let error = triangulate_planar(&bow, &[]).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Geometry);
        for wrong in [f64::NAN, f64::INFINITY, 1e70] {
            let error = triangulate_planar(&[[0.0, 0.0], [1.0, 0.0], [0.0, wrong]], &[]);
            assert_eq!(error.unwrap_err().kind(), ErrorKind::InvalidInput);
        }
    }

    #[test]
    fn points_that_are_not_inside_are_refused() {
        // An L, whose notch is inside the hull.
        let polygon = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        for wrong in [[1.5, 1.5], [1.2, 1.1], [3.0, 0.5], [2.0, 0.5], [1.0, 1.0]] {
            let error = triangulate_planar(&polygon, &[[0.5, 0.5], wrong]).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Geometry, "{wrong:?}");
        }
        assert!(triangulate_planar(&polygon, &[[0.5, 0.5], [0.5, 0.5]]).is_err());
        assert!(triangulate_planar(&polygon, &[[0.5, 0.5], [1.5, 0.5]]).is_ok());
    }

    proptest! {
        #[test]
        fn star_polygons_with_points_inside_are_triangulated_by_delaunay(
            radii in prop::collection::vec(0.1_f64..1.0, 3..80),
            inside in prop::collection::vec((0.0_f64..0.09, 0.0_f64..TAU), 0..40),
        ) {
            // The disk of radius 0.1 cos(π/3) lies inside of every star of at least three rays.
            let polygon = star(&radii);
            let interior: Vec<Point2> = inside
                .iter()
                .map(|(r, a)| [0.5 * r * a.cos(), 0.5 * r * a.sin()])
                .collect();
            match triangulate_planar(&polygon, &interior) {
                Ok(triangles) => {
                    check(&polygon, &interior, &triangles);
                    prop_assert!(is_delaunay(&[polygon, interior].concat(), &triangles));
                }
                Err(error) => {
                    let is_twice = |i: usize| interior[..i].contains(&interior[i]);
                    prop_assert!((0..interior.len()).any(is_twice), "{}", error);
                }
            }
        }
    }

    #[test]
    fn an_inner_polygon_stays_open() {
        let outer = star(&[2.0; 24]);
        let mut inner = star(&[1.0; 12]);
        inner.reverse();
        let interior: Vec<Point2> = star(&[1.5; 17]);
        for is_reversed in [false, true] {
            let mut polygons = [outer.clone(), inner.clone()];
            if is_reversed {
                polygons.iter_mut().for_each(|p| p.reverse());
            }
            let triangles =
                triangulate_planar_region(&polygons, &interior, &Job::unlimited()).unwrap();
            assert_eq!(triangles.len(), 36 - 2 + 2 * 17 + 2);
            let points: Vec<Point2> = polygons
                .iter()
                .flatten()
                .chain(&interior)
                .copied()
                .collect();
            let doubled = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|v| points[v as usize]);
                turn(a, b, c)
            };
            assert!(triangles.iter().all(|t| (doubled(t) < 0.0) == is_reversed));
            let ring = 12.0 * 4.0 * (TAU / 24.0).sin() - 6.0 * (TAU / 12.0).sin();
            let area: f64 = triangles.iter().map(|t| doubled(t).abs() / 2.0).sum();
            assert!((area - ring).abs() < 1e-9, "{area} {ring}");
        }
    }

    #[test]
    fn inner_polygons_that_meet_lie_outside_or_turn_wrongly_are_errors() {
        let outer = star(&[2.0; 24]);
        let mut inner = star(&[1.0; 12]);
        let cases = |inner: &[Point2], shift: f64| {
            let moved = inner.iter().map(|p| [p[0] + shift, p[1]]).collect();
            triangulate_planar_region(&[outer.clone(), moved], &[], &Job::unlimited())
        };
        assert!(cases(&inner, 0.0).is_err());
        inner.reverse();
        assert!(cases(&inner, 0.0).is_ok());
        for shift in [1.5, 10.0] {
            assert!(cases(&inner, shift).is_err());
        }
        let error = triangulate_planar_region(&[outer], &[], &Job::new(&|| true)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Cancelled);
    }
}
