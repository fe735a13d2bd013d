//! Tests on nearly coplanar triangles, compared with exact integer arithmetic.
//!
//! Two faces of one flat patch may be so thin that a test with a tolerance reports a crossing. Here the definition of
//! an improper intersection is applied to such pairs without rounding: coordinates are multiples of 2^-53, so every
//! volume is an integer in that unit.

use super::intersect::intersects_improperly;
use crate::math::Vec3;

type Triangle = [[f64; 3]; 3];

/// Five pairs from the fill of a scan with a flat base: three without a common corner, two with one. Their planes are
/// 1e-9 to 1e-7 of their extent apart.
const PAIRS: [(Triangle, Triangle); 5] = [
    (
        [
            [0.8572748130556761, -1.4361239883520607, 1.4994738239626932],
            [0.8582072745835583, -1.4361239720438452, 1.5008529433324722],
            [0.9122016601904115, -1.4361239820988907, 1.5849694136180514],
        ],
        [
            [1.020267, -1.436124, 1.753315],
            [0.9122016601904115, -1.4361239820988907, 1.5849694136180514],
            [0.9136572576212293, -1.4361239576117304, 1.587122336446877],
        ],
    ),
    (
        [
            [0.8582072745835583, -1.4361239720438452, 1.5008529433324722],
            [0.747467, -1.436124, 1.328549],
            [0.8604356420505151, -1.4361239321565484, 1.504150142634877],
        ],
        [
            [0.9122016601904115, -1.4361239820988907, 1.5849694136180514],
            [0.911601955691674, -1.4361239924868219, 1.5840829643484142],
            [0.8572748130556761, -1.4361239883520607, 1.4994738239626932],
        ],
    ),
    (
        [
            [0.9475531220419794, -1.4361236473140724, 1.6363181309039505],
            [0.9475478071792227, -1.4361236466992302, 1.6362953443110948],
            [0.9478128868011735, -1.4361236562122168, 1.6368346968963383],
        ],
        [
            [0.9475531220419794, -1.4361236473140724, 1.6363181309039505],
            [0.9480182281287549, -1.4361236676335873, 1.6373670442227977],
            [0.9469316800297812, -1.4361236208689818, 1.634936573885463],
        ],
    ),
    (
        [
            [0.8604356420505151, -1.4361239321565484, 1.504150142634877],
            [0.747467, -1.436124, 1.328549],
            [0.8656719667660875, -1.4361238293677994, 1.5119022507459894],
        ],
        [
            [0.9122016601904115, -1.4361239820988907, 1.5849694136180514],
            [0.911601955691674, -1.4361239924868219, 1.5840829643484142],
            [0.8572748130556761, -1.4361239883520607, 1.4994738239626932],
        ],
    ),
    (
        [
            [0.8941011223210493, -1.4361040125947915, 1.2664493292410373],
            [0.9051190352482753, -1.4361038967217439, 1.28036512923103],
            [0.9100585659785978, -1.4361000562176418, 1.2873833912196413],
        ],
        [
            [0.8570518746830652, -1.4361056194531774, 1.219408825767493],
            [0.937020460695964, -1.436102918420104, 1.3207869979405513],
            [0.8941683064208417, -1.4361042986793715, 1.2664759073176834],
        ],
    ),
];

/// The coordinates as multiples of 2^-53, differences to `origin` taken exactly.
fn difference(p: [f64; 3], origin: [f64; 3]) -> [i128; 3] {
    let whole = |x: f64| {
        let scaled = x * 2.0_f64.powi(53);
        assert!(scaled.fract() == 0.0 && scaled.abs() < 2.0_f64.powi(55));
        scaled as i128
    };
    std::array::from_fn(|k| whole(p[k]) - whole(origin[k]))
}

/// The sign of the volume of `a`, `b`, `c`, `d`: that of a sum of products of three numbers below 2^56.
fn exact_side(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> i32 {
    let (u, v, w) = (difference(b, a), difference(c, a), difference(d, a));
    // Each product of two fits into 113 bits; the third factor multiplies its upper and lower half by themselves.
    let (mut upper, mut lower) = (0_i128, 0_i128);
    for (k, third) in w.iter().enumerate() {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let minor = u[i] * v[j] - u[j] * v[i];
        upper += (minor >> 64) * third;
        lower += (minor & i128::from(u64::MAX)) * third;
    }
    let total = upper + (lower >> 64);
    let rest = lower & i128::from(u64::MAX);
    match total {
        0 => i32::from(rest > 0),
        _ => total.signum() as i32,
    }
}

/// Whether the segment from `p` to `q` passes through the triangle, its ends strictly on both sides.
fn crosses(p: [f64; 3], q: [f64; 3], [a, b, c]: Triangle) -> bool {
    let around = [
        exact_side(p, q, a, b),
        exact_side(p, q, b, c),
        exact_side(p, q, c, a),
    ];
    let is_inside = !(around.contains(&1) && around.contains(&-1));
    let apart = around.iter().filter(|&&s| s != 0).count();
    exact_side(a, b, c, p) * exact_side(a, b, c, q) < 0 && is_inside && apart >= 2
}

/// Whether an edge of one triangle that has no corner in common with the other crosses it.
fn intersects_exactly(t: Triangle, u: Triangle) -> bool {
    let any_edge = |edges: Triangle, face: Triangle| {
        (0..3).any(|k| {
            let (p, q) = (edges[k], edges[(k + 1) % 3]);
            !face.contains(&p) && !face.contains(&q) && crosses(p, q, face)
        })
    };
    any_edge(t, u) || any_edge(u, t)
}

#[test]
fn exact_volumes_have_their_signs() {
    let (o, x, y) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let smallest = 2.0_f64.powi(-53);
    for z in [smallest, 1.0] {
        assert_eq!(exact_side(o, x, y, [0.5, 0.5, z]), 1);
        assert_eq!(exact_side(o, x, y, [0.5, 0.5, -z]), -1);
    }
    assert_eq!(exact_side(o, x, y, [1.5, -0.5, 0.0]), 0);
    let needle = [
        [0.25, 0.25, -smallest],
        [0.25, 0.25, smallest],
        [2.0, 2.0, 0.0],
    ];
    assert!(intersects_exactly([o, x, y], needle));
}

#[test]
fn neighbors_in_a_flat_patch_do_not_intersect() {
    for (t, u) in PAIRS {
        assert!(!intersects_exactly(t, u), "{t:?} {u:?}");
        let (t, u) = (t.map(Vec3::from), u.map(Vec3::from));
        assert!(!intersects_improperly(&t, &u), "{t:?} {u:?}");
    }
}
