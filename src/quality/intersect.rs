//! Tests two triangles for an improper intersection, that is, one that two triangles of a sound surface never have.
//!
//! | corners in common | improper when |
//! | --- | --- |
//! | none | an edge of one crosses the other |
//! | one | the edge opposite to it crosses the other triangle |
//! | two | the faces fold onto each other (dihedral angle below [`FOLD`]) |
//! | three | always: it is the same face twice |
//!
//! Two triangles in one plane intersect improperly if they overlap with positive area, whatever corners they share.
//! Touching is not improper: a corner on a face, a corner on an edge, two faces that only touch. Corners are in common
//! if their positions are equal; vertex ids do not count.
//!
//! Crossings are decided by exact predicates: J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast
//! Robust Geometric Predicates, Discrete & Computational Geometry 18, 1997 (crate `robust`). They are exact unless a
//! product under- or overflows. So neighbors in a flat patch whose planes differ by 1e-9 of their extent are decided
//! correctly; tests that round small volumes to zero report some of them. Whether two triangles lie in one plane is
//! decided with a tolerance, because computed points never lie in a plane exactly.
//!
//! Not guaranteed: intersections of triangles without area (see [`has_area`]) are not reported.

use crate::math::{Vec3, cross_normal, unit};
use robust::{Coord3D, orient3d};

/// Two triangles lie in one plane if their distance from it is below this share of the larger triangle. It is far above
/// the rounding error of a computed point (2^-52) and far below any modeled gap.
pub(super) const COPLANAR: f64 = 1e-9;

/// A triangle has no area if twice its area, divided by the square of the extent, is below this. Its normal is then
/// only rounding error.
const NO_AREA: f64 = 1e-14;

/// Two faces are folded onto each other if the angle between them at their common edge is below this, in radians. It is
/// 0.05 degrees.
const FOLD: f64 = 0.05 * std::f64::consts::PI / 180.0;

/// Whether two triangles of a surface intersect in more than the corners and edges they share.
///
/// Symmetric, and independent of the orientation and of the starting corner.
pub(crate) fn intersects_improperly(t: &[Vec3; 3], u: &[Vec3; 3]) -> bool {
    if has_repeated_corner(t) || has_repeated_corner(u) {
        return false;
    }
    let t_shared = t.map(|p| u.contains(&p));
    let u_shared = u.map(|p| t.contains(&p));
    let shared = t_shared.iter().filter(|&&s| s).count();
    if shared == 3 {
        return true;
    }
    let extent = extent(t).max(extent(u));
    let (t_normal, u_normal) = (
        cross_normal(&t[0], &t[1], &t[2]),
        cross_normal(&u[0], &u[1], &u[2]),
    );
    if !has_area(&t_normal, extent) || !has_area(&u_normal, extent) {
        return false;
    }
    if max_height(u, t, &t_normal).max(max_height(t, u, &u_normal)) < COPLANAR * extent {
        return overlap_in_plane(t, u, &t_normal);
    }
    match shared {
        0 => cross_apart(t, u),
        1 => cross_beyond_corner(
            &from_corner(t, t_shared, true),
            &from_corner(u, u_shared, true),
        ),
        _ => is_fold(
            &from_corner(t, t_shared, false),
            &from_corner(u, u_shared, false),
        ),
    }
}

fn has_repeated_corner([a, b, c]: &[Vec3; 3]) -> bool {
    a == b || b == c || c == a
}

/// Whether a triangle with this normal (of length twice the area) has an area, in a scene of this extent.
fn has_area(normal: &Vec3, extent: f64) -> bool {
    normal.norm() > NO_AREA * extent * extent
}

/// Longest side of the bounding box.
pub(super) fn extent([a, b, c]: &[Vec3; 3]) -> f64 {
    (a.sup(b).sup(c) - a.inf(b).inf(c)).max()
}

/// The largest distance of a corner of `t` from the plane of `base`.
fn max_height(t: &[Vec3; 3], base: &[Vec3; 3], normal: &Vec3) -> f64 {
    let direction = unit(*normal);
    t.iter()
        .map(|p| direction.dot(&(p - base[0])).abs())
        .fold(0.0, f64::max)
}

/// The triangle turned so that it starts at its first corner marked `wanted`.
fn from_corner(t: &[Vec3; 3], marks: [bool; 3], wanted: bool) -> [Vec3; 3] {
    let k = marks.iter().position(|&m| m == wanted).unwrap_or(0);
    [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]
}

/// Which side of the plane through `a`, `b`, `c` the point is on: exactly -1, 0 or 1.
fn side(a: &Vec3, b: &Vec3, c: &Vec3, p: &Vec3) -> i8 {
    let coord = |v: &Vec3| Coord3D {
        x: v.x,
        y: v.y,
        z: v.z,
    };
    let volume = orient3d(coord(a), coord(b), coord(c), coord(p));
    i8::from(volume > 0.0) - i8::from(volume < 0.0)
}

fn sides([a, b, c]: &[Vec3; 3], of: &[Vec3; 3]) -> [i8; 3] {
    of.each_ref().map(|p| side(a, b, c, p))
}

/// Whether a triangle stays on one side of a plane and touches it in one corner at most, so that it cannot cross.
/// `sides` are those of its corners.
fn keeps_off(sides: [i8; 3]) -> bool {
    let sum: i8 = sides.iter().sum();
    sum.abs() >= 2
}

/// Whether two triangles cross that have no common corner and do not lie in one plane.
fn cross_apart(t: &[Vec3; 3], u: &[Vec3; 3]) -> bool {
    let u_sides = sides(t, u);
    if keeps_off(u_sides) {
        return false;
    }
    let t_sides = sides(u, t);
    if keeps_off(t_sides) {
        return false;
    }
    let any_edge = |edges: &[Vec3; 3], sides: [i8; 3], face: &[Vec3; 3]| {
        (0..3).any(|k| {
            let next = (k + 1) % 3;
            sides[k] * sides[next] < 0 && line_meets(&edges[k], &edges[next], face)
        })
    };
    any_edge(t, t_sides, u) || any_edge(u, u_sides, t)
}

/// Whether two triangles cross that have one common corner, their first, and do not lie in one plane.
fn cross_beyond_corner(t: &[Vec3; 3], u: &[Vec3; 3]) -> bool {
    let opposite_crosses = |t: &[Vec3; 3], u: &[Vec3; 3]| {
        let [a, b, c] = u;
        side(a, b, c, &t[1]) * side(a, b, c, &t[2]) < 0 && line_meets(&t[1], &t[2], u)
    };
    opposite_crosses(t, u) || opposite_crosses(u, t)
}

/// Whether the segment from `p` to `q` meets the triangle in a point that is not a corner.
fn line_meets(p: &Vec3, q: &Vec3, [a, b, c]: &[Vec3; 3]) -> bool {
    let around = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    let positive = around.iter().filter(|&&s| s > 0).count();
    let negative = around.iter().filter(|&&s| s < 0).count();
    positive.min(negative) == 0 && positive.max(negative) >= 2
}

/// Whether two triangles with a common edge are folded onto each other. Both start at the corner opposite to that edge.
fn is_fold(t: &[Vec3; 3], u: &[Vec3; 3]) -> bool {
    let [tip, from, to] = t;
    let along = unit(to - from);
    let height = |tip: &Vec3| {
        let d = tip - from;
        d - along * along.dot(&d)
    };
    let (h, k) = (height(tip), height(&u[0]));
    h.cross(&k).norm().atan2(h.dot(&k)) < FOLD
}

/// Whether two triangles in the plane perpendicular to `normal` overlap with positive area, by the separating axis
/// theorem. An overlap thinner than [`COPLANAR`] counts as touching.
fn overlap_in_plane(t: &[Vec3; 3], u: &[Vec3; 3], normal: &Vec3) -> bool {
    let dropped = normal.iamax();
    let (x, y) = ((dropped + 1) % 3, (dropped + 2) % 3);
    let margin = COPLANAR * extent(t).max(extent(u));
    let separated_by_edge_of = |owner: &[Vec3; 3]| {
        (0..3).any(|k| {
            let edge = owner[(k + 1) % 3] - owner[k];
            let length = edge[x].hypot(edge[y]).max(f64::MIN_POSITIVE);
            let (nx, ny) = (-edge[y] / length, edge[x] / length);
            // Relative to one corner: far from the origin the products would lose the margin.
            let offset = |p: &Vec3| nx * (p[x] - t[0][x]) + ny * (p[y] - t[0][y]);
            let range = |s: &[Vec3; 3]| {
                let d = s.each_ref().map(offset);
                (d[0].min(d[1]).min(d[2]), d[0].max(d[1]).max(d[2]))
            };
            let ((t_lo, t_hi), (u_lo, u_hi)) = (range(t), range(u));
            t_hi.min(u_hi) - t_lo.max(u_lo) <= margin
        })
    };
    !separated_by_edge_of(t) && !separated_by_edge_of(u)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type Triangle = [[f64; 3]; 3];

    const FLOOR: Triangle = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn judge(t: &Triangle, u: &Triangle) -> bool {
        let (t, u) = (t.map(Vec3::from), u.map(Vec3::from));
        let verdict = intersects_improperly(&t, &u);
        for k in 0..3 {
            let turned = [u[k], u[(k + 1) % 3], u[(k + 2) % 3]];
            let flipped = [turned[2], turned[1], turned[0]];
            for v in [turned, flipped] {
                assert_eq!(
                    intersects_improperly(&t, &v),
                    verdict,
                    "depends on the corner order"
                );
                assert_eq!(intersects_improperly(&v, &t), verdict, "is not symmetric");
            }
        }
        verdict
    }

    #[test]
    fn crossing_is_improper_and_touching_is_not() {
        let cases = [
            (
                "an edge through the inside",
                [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 0.0]],
                true,
            ),
            (
                "an edge through an edge",
                [[2.0, 0.0, -1.0], [2.0, 0.0, 1.0], [2.0, -3.0, 0.5]],
                true,
            ),
            (
                "an edge through a corner",
                [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [-3.0, -3.0, 0.5]],
                false,
            ),
            (
                "a corner on the inside",
                [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]],
                false,
            ),
            (
                "a corner on an edge",
                [[2.0, 0.0, 0.0], [2.0, 0.0, 1.0], [3.0, 1.0, 2.0]],
                false,
            ),
            (
                "standing on an inner line",
                [[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 1.0, 2.0]],
                false,
            ),
            (
                "planes cross beside",
                [[5.0, 5.0, -1.0], [5.0, 5.0, 1.0], [9.0, 9.0, 0.0]],
                false,
            ),
            (
                "parallel above",
                [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]],
                false,
            ),
        ];
        for (name, other, expected) in cases {
            assert_eq!(judge(&FLOOR, &other), expected, "{name}");
        }
    }

    #[test]
    fn a_common_corner_excuses_only_itself() {
        let cases = [
            (
                "fan",
                [[0.0, 0.0, 0.0], [-1.0, 0.0, 1.0], [0.0, -1.0, 1.0]],
                false,
            ),
            (
                "opposite edge pierces",
                [[0.0, 0.0, 0.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0]],
                true,
            ),
            (
                "opposite edge passes beyond",
                [[0.0, 0.0, 0.0], [8.0, 8.0, -1.0], [8.0, 8.0, 1.0]],
                true,
            ),
            (
                "in plane, beside",
                [[0.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
                false,
            ),
            (
                "in plane, inside",
                [[0.0, 0.0, 0.0], [1.0, 0.5, 0.0], [0.5, 1.0, 0.0]],
                true,
            ),
            (
                "in plane, side along side",
                [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, -2.0, 0.0]],
                false,
            ),
        ];
        for (name, other, expected) in cases {
            assert_eq!(judge(&FLOOR, &other), expected, "{name}");
        }
    }

    #[test]
    fn a_common_edge_is_improper_only_when_folded() {
        let across = |angle_deg: f64| {
            let (s, c) = angle_deg.to_radians().sin_cos();
            [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 2.0 * c, 2.0 * s]]
        };
        for (angle_deg, expected) in [
            (0.0, true),
            (0.04, true),
            (0.06, false),
            (90.0, false),
            (180.0, false),
            (-0.04, true),
        ] {
            assert_eq!(
                judge(&FLOOR, &across(angle_deg)),
                expected,
                "{angle_deg} degrees"
            );
        }
        assert!(judge(&FLOOR, &FLOOR), "the same face twice");
    }

    #[test]
    fn coplanar_triangles_need_area_in_common() {
        let shifted = |x: f64, y: f64, z: f64| FLOOR.map(|p| [p[0] + x, p[1] + y, p[2] + z]);
        assert!(judge(&FLOOR, &shifted(1.0, 1.0, 0.0)));
        assert!(
            judge(&FLOOR, &shifted(1.0, 1.0, 1e-12)),
            "coplanar but for rounding"
        );
        assert!(!judge(&FLOOR, &shifted(1.0, 1.0, 1e-6)), "a real gap");
        assert!(!judge(&FLOOR, &shifted(4.0, 0.0, 0.0)), "corner to corner");
        assert!(
            !judge(&FLOOR, &shifted(-4.0 + 1e-12, 0.0, 0.0)),
            "overlap by rounding"
        );
        assert!(
            judge(&FLOOR, &[[1.0, 1.0, 0.0], [1.5, 1.0, 0.0], [1.0, 1.5, 0.0]]),
            "contained"
        );
    }

    #[test]
    fn degenerate_and_unbounded_triangles_cross_nothing() {
        let o = [1.0, 1.0, 0.0];
        let nan = [f64::NAN; 3];
        let far = [f64::MAX; 3];
        let inf = [f64::INFINITY; 3];
        for other in [
            [o, o, o],
            [[1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0]],
            [[1.0, 1.0, -1.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]],
            [nan, o, far],
            [nan, nan, nan],
            [inf, o, nan],
        ] {
            assert!(!judge(&FLOOR, &other), "{other:?}");
            assert!(!judge(&other, &other) || other[0] != other[1], "{other:?}");
        }
        let _ = judge(&FLOOR, &[far, o, inf]);
    }

    #[test]
    fn a_crossing_shallower_than_rounding_is_still_found() {
        // The tip dips below the floor by one unit in the last place of a far coordinate.
        let below = -f64::EPSILON;
        let spike = |z: f64| [[1.0, 1.0, z], [1.0, 1.2, 1.0], [1.2, 1.0, 1.0]];
        assert!(judge(&FLOOR, &spike(below)));
        assert!(!judge(&FLOOR, &spike(0.0)));
    }

    type Grid = [[i64; 3]; 3];

    fn sub(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    }
    fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    }
    fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// Solves for the point where the edge meets the plane, then for its barycentric coordinates.
    fn edge_crosses(p: [i64; 3], q: [i64; 3], t: &Grid) -> bool {
        let n = cross(sub(t[1], t[0]), sub(t[2], t[0]));
        let (hp, hq) = (dot(n, sub(p, t[0])), dot(n, sub(q, t[0])));
        if hp.signum() * hq.signum() >= 0 {
            return false;
        }
        // Point times `w`, with w > 0.
        let w = (hp - hq).abs();
        let (wp, wq) = (hq.abs(), hp.abs());
        let x: [i64; 3] = std::array::from_fn(|k| wp * p[k] + wq * q[k]);
        let scaled = |v: [i64; 3]| v.map(|c| c * w);
        let bary: Vec<i64> = (0..3)
            .map(|k| {
                let (a, b) = (t[(k + 1) % 3], t[(k + 2) % 3]);
                dot(n, cross(sub(b, a), sub(x, scaled(a))))
            })
            .collect();
        bary.iter().all(|&s| s >= 0) && bary.iter().filter(|&&s| s == 0).count() <= 1
    }

    fn edges(t: &Grid) -> impl Iterator<Item = ([i64; 3], [i64; 3])> {
        (0..3).map(|k| (t[k], t[(k + 1) % 3]))
    }

    /// Twice the area of the overlap of triangles in the plane z = 0, by clipping.
    fn clipped_area(t: &Grid, u: &Grid) -> f64 {
        let flat = |t: &Grid| t.map(|p| [p[0] as f64, p[1] as f64]);
        let area = |poly: &[[f64; 2]]| -> f64 {
            (0..poly.len())
                .map(|i| {
                    let (a, b) = (poly[i], poly[(i + 1) % poly.len()]);
                    a[0] * b[1] - a[1] * b[0]
                })
                .sum()
        };
        let mut clip = flat(u);
        if area(&clip) < 0.0 {
            clip.reverse();
        }
        let mut poly = flat(t).to_vec();
        for k in 0..3 {
            let (a, b) = (clip[k], clip[(k + 1) % 3]);
            let height =
                |p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            let mut kept = Vec::new();
            for i in 0..poly.len() {
                let (p, q) = (poly[i], poly[(i + 1) % poly.len()]);
                let (hp, hq) = (height(p), height(q));
                if hp >= 0.0 {
                    kept.push(p);
                }
                if hp * hq < 0.0 {
                    let s = hp / (hp - hq);
                    kept.push([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])]);
                }
            }
            poly = kept;
        }
        area(&poly).abs()
    }

    fn grid_triangle(depth: i64) -> impl Strategy<Value = Grid> {
        let point = (-3i64..4, -3i64..4, -depth..depth + 1).prop_map(|(x, y, z)| [x, y, z]);
        [point.clone(), point.clone(), point].prop_filter("area", |t| {
            cross(sub(t[1], t[0]), sub(t[2], t[0])) != [0; 3]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn crossings_agree_with_integer_arithmetic(t in grid_triangle(3), u in grid_triangle(3)) {
            let shared: Vec<_> = t.iter().filter(|p| u.contains(p)).collect();
            let n = cross(sub(t[1], t[0]), sub(t[2], t[0]));
            let coplanar = u.iter().all(|&p| dot(n, sub(p, t[0])) == 0);
            prop_assume!(!coplanar && shared.len() < 2);
            let counts = |edge: &([i64; 3], [i64; 3])| {
                shared.is_empty() || (*shared[0] != edge.0 && *shared[0] != edge.1)
            };
            let expected = edges(&t).filter(counts).any(|(p, q)| edge_crosses(p, q, &u))
                || edges(&u).filter(counts).any(|(p, q)| edge_crosses(p, q, &t));
            let float = |t: Grid| t.map(|p| p.map(|x| x as f64));
            prop_assert_eq!(judge(&float(t), &float(u)), expected);
        }

        #[test]
        fn overlaps_in_a_plane_agree_with_clipping(t in grid_triangle(0), u in grid_triangle(0)) {
            let float = |t: Grid| t.map(|p| p.map(|x| x as f64));
            prop_assert_eq!(judge(&float(t), &float(u)), clipped_area(&t, &u) > 1e-9);
        }
    }
}
