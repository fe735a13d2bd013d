//! Exact tests on closed polygons in the plane: whether a polygon is simple, and its orientation.
//!
//! Edges are sorted by their ranges of x, and those with overlapping ranges are tested by exact predicates.
//!
//! Source: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates",
//! Discrete & Computational Geometry 18(3), 1997 (the orientation test of the crate `robust`). The predicates are exact
//! unless a product of two coordinate differences over- or underflows; callers must avoid that.

use crate::error::Result;
use crate::job::Job;
use robust::{Coord, orient2d};

/// A point of the plane.
pub(crate) type Point2 = [f64; 2];

/// Finds two edges of the closed `polygon` that share a point and should not, the lower index first: two edges that
/// cross or touch, successive edges that overlap, or an edge without length. `None` for a simple polygon, which has
/// at least three vertices. Edge `i` begins at vertex `i`.
///
/// All coordinates must be finite.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
///
/// # Complexity
/// O(m log m) and one test for each pair of edges whose ranges of x overlap: about m^1.5 pairs for a polygon
/// without a preferred direction, m² at worst.
pub(crate) fn find_contact(polygon: &[Point2], job: &Job<'_>) -> Result<Option<(usize, usize)>> {
    let m = polygon.len();
    if m < 3 {
        return Ok(Some((0, 0)));
    }
    let ends = |i: usize| [polygon[i], polygon[(i + 1) % m]];
    let range = |i: usize, k: usize| {
        let [a, b] = ends(i);
        (a[k].min(b[k]), a[k].max(b[k]))
    };
    let mut order: Vec<usize> = (0..m).collect();
    order.sort_by(|&i, &j| range(i, 0).0.total_cmp(&range(j, 0).0).then(i.cmp(&j)));
    for (place, &i) in order.iter().enumerate() {
        job.tick(200)?;
        if ends(i)[0] == ends(i)[1] {
            return Ok(Some((i, i)));
        }
        let (right, (low, high)) = (range(i, 0).1, range(i, 1));
        for &j in &order[place + 1..] {
            if range(j, 0).0 > right {
                break;
            }
            let (other_low, other_high) = range(j, 1);
            if other_low > high || other_high < low {
                continue;
            }
            let is_met = if (i + 1) % m == j {
                runs_back(polygon[i], polygon[j], polygon[(j + 1) % m])
            } else if (j + 1) % m == i {
                runs_back(polygon[j], polygon[i], polygon[(i + 1) % m])
            } else {
                share_a_point(ends(i), ends(j))
            };
            if is_met {
                return Ok(Some((i.min(j), i.max(j))));
            }
        }
    }
    Ok(None)
}

/// Whether a simple polygon runs counter-clockwise.
pub(crate) fn is_counter_clockwise(polygon: &[Point2]) -> bool {
    let m = polygon.len();
    let lowest = (0..m).min_by(|&i, &j| {
        let (p, q) = (polygon[i], polygon[j]);
        p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
    });
    // The polygon is convex at its lowest vertex. It is not straight there, because successive edges do not overlap.
    lowest.is_some_and(|i| turn(polygon[(i + m - 1) % m], polygon[i], polygon[(i + 1) % m]) > 0.0)
}

/// Positive when `a`, `b`, `c` turn left, negative when they turn right, zero on a line.
pub(crate) fn turn(a: Point2, b: Point2, c: Point2) -> f64 {
    let coord = |p: Point2| Coord { x: p[0], y: p[1] };
    orient2d(coord(a), coord(b), coord(c))
}

/// Whether the edge from `b` to `c` overlaps the edge from `a` to `b`.
fn runs_back(a: Point2, b: Point2, c: Point2) -> bool {
    if turn(a, b, c) != 0.0 {
        return false;
    }
    // The edges are on one line. They overlap if `a` and `c` are on the same side of `b`, in a coordinate in which the
    // line extends.
    let k = if a[0] == b[0] { 1 } else { 0 };
    (a[k] < b[k]) == (c[k] < b[k])
}

/// Whether two segments have a point in common.
fn share_a_point([a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> bool {
    let (at_a, at_b) = (turn(c, d, a), turn(c, d, b));
    let (at_c, at_d) = (turn(a, b, c), turn(a, b, d));
    let differ = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    let within = |p: Point2, q: Point2, r: Point2| {
        (0..2).all(|k| p[k].min(q[k]) <= r[k] && r[k] <= p[k].max(q[k]))
    };
    (differ(at_a, at_b) && differ(at_c, at_d))
        || (at_a == 0.0 && within(c, d, a))
        || (at_b == 0.0 && within(c, d, b))
        || (at_c == 0.0 && within(a, b, c))
        || (at_d == 0.0 && within(a, b, d))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn contact(polygon: &[Point2]) -> Option<(usize, usize)> {
        find_contact(polygon, &Job::unlimited()).unwrap()
    }

    /// Every pair, by exact integer arithmetic on small coordinates.
    fn has_contact_slow(polygon: &[[i64; 2]]) -> bool {
        let m = polygon.len();
        let side = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
            ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
        };
        let on = |a: [i64; 2], b: [i64; 2], p: [i64; 2]| {
            side(a, b, p) == 0 && (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]))
        };
        let edge = |i: usize| (polygon[i % m], polygon[(i + 1) % m]);
        (0..m).any(|i| {
            let (a, b) = edge(i);
            let (_, next) = edge(i + 1);
            a == b
                || on(a, b, next)
                || on(b, next, a)
                || (i + 2..m).filter(|j| (j + 1) % m != i).any(|j| {
                    let (c, d) = edge(j);
                    on(a, b, c)
                        || on(a, b, d)
                        || on(c, d, a)
                        || on(c, d, b)
                        || (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0)
                })
        })
    }

    fn regular(m: usize) -> Vec<Point2> {
        (0..m)
            .map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / m as f64;
                [angle.cos(), angle.sin()]
            })
            .collect()
    }

    #[test]
    fn regular_polygons_are_simple_and_turn_left() {
        for m in [3, 4, 50, 2000] {
            let mut polygon = regular(m);
            assert_eq!(contact(&polygon), None);
            assert!(is_counter_clockwise(&polygon));
            polygon.reverse();
            assert!(!is_counter_clockwise(&polygon));
        }
    }

    #[test]
    fn contacts_of_every_kind_are_found() {
        let cases: [&[Point2]; 6] = [
            &[[0.0, 0.0], [1.0, 0.0]],
            // a crossing, a vertex on an edge, a spike, an edge without length, a repeated vertex
            &[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
            &[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.0], [0.0, 1.0]],
            &[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            &[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            &[
                [0.0, 0.0],
                [1.0, 0.0],
                [1.0, 1.0],
                [0.0, 0.0],
                [-1.0, 1.0],
                [-1.0, 0.0],
            ],
        ];
        for polygon in cases {
            assert!(contact(polygon).is_some(), "{polygon:?}");
        }
    }

    #[test]
    fn a_vertex_one_bit_beside_an_edge_is_no_contact() {
        let tip = [0.5, f64::from_bits(0.5_f64.to_bits() + 1)];
        let mut polygon = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 2.0], tip, [0.0, 2.0]];
        assert_eq!(contact(&polygon), None);
        polygon[3] = [0.5, 0.5];
        assert!(contact(&polygon).is_some());
    }

    proptest! {
        #[test]
        fn small_polygons_agree_with_every_pair(
            points in prop::collection::vec([-4_i64..5, -4_i64..5], 3..9),
        ) {
            let polygon: Vec<Point2> = points.iter().map(|p| p.map(|x| x as f64)).collect();
            prop_assert_eq!(contact(&polygon).is_some(), has_contact_slow(&points));
        }
    }
}
