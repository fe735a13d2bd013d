//! A model with holes, made by formula: a fluted tube along a (2,3) torus knot.
//!
//! It has one hole of each kind that scans have: a large one, one with a loose island, one round most
//! of the tube, a long crack, two that touch in a vertex, and small ones at random places.

use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

type Vec3 = Vector3<f64>;

/// Vertices along the knot and round the tube.
const ALONG: usize = 900;
const AROUND: usize = 72;
/// Radius of the torus that the knot winds round, and distance of the knot from the core of the torus.
const TORUS_RADIUS: f64 = 2.0;
const KNOT_RADIUS: f64 = 0.95;
const TUBE_RADIUS: f64 = 0.46;
/// Vertices are moved by up to this share of the grid spacing, so that rims are as irregular as in a scan.
const UNEVENNESS: f64 = 0.22;
const SMALL_HOLES: usize = 26;

/// A place on the tube: its position along the knot, 0 to 1, and the angle round it.
#[derive(Clone, Copy)]
struct Place {
    along: f64,
    angle: f64,
}

/// The center line of the knot, with a table for equal steps of length.
struct Knot {
    length: f64,
    /// Parameters at equal steps of length, the first one again at the end.
    parameters: Vec<f64>,
}

impl Knot {
    fn new() -> Self {
        let fine = 20 * ALONG;
        let speed = |k: usize| {
            let t = TAU * k as f64 / fine as f64;
            (2.0 * (TORUS_RADIUS + KNOT_RADIUS * (3.0 * t).cos())).hypot(3.0 * KNOT_RADIUS)
        };
        let step = TAU / fine as f64;
        let mut lengths = vec![0.0];
        for k in 0..fine {
            lengths.push(lengths[k] + step * (speed(k) + speed(k + 1)) / 2.0);
        }
        let length = lengths[fine];
        let parameter = |i: usize| {
            let wanted = length * i as f64 / ALONG as f64;
            let k = lengths.partition_point(|&l| l <= wanted).clamp(1, fine) - 1;
            step * (k as f64 + (wanted - lengths[k]) / (lengths[k + 1] - lengths[k]))
        };
        Self {
            length,
            parameters: (0..=ALONG).map(parameter).collect(),
        }
    }

    fn parameter(&self, along: f64) -> f64 {
        let position = along.rem_euclid(1.0) * ALONG as f64;
        let i = (position as usize).min(ALONG - 1);
        let share = position - i as f64;
        self.parameters[i] * (1.0 - share) + self.parameters[i + 1] * share
    }

    /// The position of a parameter along the knot.
    fn along(&self, parameter: f64) -> f64 {
        self.parameters.partition_point(|&t| t < parameter) as f64 / ALONG as f64
    }

    /// The center line, and two directions across it: away from the torus' core, and along the torus.
    fn frame(&self, along: f64) -> [Vec3; 3] {
        let t = self.parameter(along);
        let (core, out) = (Vec3::new((2.0 * t).cos(), (2.0 * t).sin(), 0.0), 3.0 * t);
        let outward = core * out.cos() + Vec3::z() * out.sin();
        let round = Vec3::z().cross(&core) * (2.0 * (TORUS_RADIUS + KNOT_RADIUS * out.cos()));
        let tangent = round + (Vec3::z() * out.cos() - core * out.sin()) * (3.0 * KNOT_RADIUS);
        let center = core * TORUS_RADIUS + outward * KNOT_RADIUS;
        [center, outward, outward.cross(&tangent.normalize())]
    }

    fn point(&self, place: Place) -> Vec3 {
        let [center, outward, sideward] = self.frame(place.along);
        let (sin, cos) = place.angle.sin_cos();
        center + (outward * cos + sideward * sin) * radius(place)
    }

    /// The place of the tube at this parameter that faces along z, toward the viewer of the picture.
    fn facing(&self, parameter: f64) -> Place {
        let along = self.along(parameter);
        let [_, outward, sideward] = self.frame(along);
        Place {
            along,
            angle: sideward.z.atan2(outward.z),
        }
    }

    /// The distance from `center` to `place` on the surface: along the tube, and round it.
    fn offset(&self, center: Place, place: Place) -> [f64; 2] {
        let wrapped = |d: f64| d - d.round();
        [
            self.length * wrapped(place.along - center.along),
            TAU * TUBE_RADIUS * wrapped((place.angle - center.angle) / TAU),
        ]
    }
}

/// The radius of the tube: it swells three times, and has flutes that wind round it.
fn radius(place: Place) -> f64 {
    let swell = 1.0 + 0.13 * (3.0 * TAU * place.along).cos();
    let flutes = 1.0 + 0.07 * (5.0 * place.angle + 17.0 * TAU * place.along).sin();
    TUBE_RADIUS * swell * flutes
}

/// A pseudo-random number from -1 to 1 for `key` (the finalizer of splitmix64).
fn scatter(key: u64) -> f64 {
    let mut z = key.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// The holes: where each is, and which offsets from there are missing.
struct Damage {
    large: Place,
    with_island: Place,
    round_the_tube: Place,
    crack: Place,
    small: Vec<(Place, f64)>,
}

impl Damage {
    fn new(knot: &Knot) -> Self {
        let [top, lobe] = [PI / 6.0, 0.0]
            .map(|first| [0.0, 1.0, 2.0].map(|turn| knot.facing(first + turn * TAU / 3.0)));
        let small = (0..SMALL_HOLES as u64).map(|k| {
            let place = Place {
                along: scatter(4 * k),
                angle: PI * scatter(4 * k + 1),
            };
            (place, 0.085 + 0.035 * scatter(4 * k + 2))
        });
        let [large, with_island, round_the_tube] = top;
        let named = [large, with_island, round_the_tube, lobe[0], lobe[1]];
        let is_clear = |place: Place| {
            named
                .iter()
                .all(|&center| knot.offset(center, place)[0].abs() > 1.2)
        };
        let small = small.filter(|(place, _)| is_clear(*place)).collect();
        Self {
            large,
            with_island,
            round_the_tube,
            crack: lobe[0],
            small,
        }
    }

    fn is_missing(&self, knot: &Knot, place: Place) -> bool {
        let [x, y] = knot.offset(self.large, place);
        let wave = |angle: f64| 1.0 + 0.22 * (3.0 * angle).sin() + 0.13 * (7.0 * angle).cos();
        let in_large = (x / 1.25).hypot(y) < 0.44 * wave(y.atan2(x));

        let [x, y] = knot.offset(self.with_island, place);
        let in_ring = (0.17..0.40 * wave(y.atan2(x) + 1.0)).contains(&x.hypot(y));

        let [x, y] = knot.offset(self.round_the_tube, place);
        let in_round = y.abs() < 0.9 && x.abs() < 0.20 + 0.05 * (9.0 * y).sin();

        let [x, y] = knot.offset(self.crack, place);
        let middle = 0.14 * (4.0 * x).sin() + 0.03 * (19.0 * x).sin();
        let in_crack = x.abs() < 1.0 && (y - middle).abs() < 0.022;

        let in_small = self.small.iter().any(|&(center, size)| {
            let [x, y] = knot.offset(center, place);
            x.hypot(y) < size
        });
        in_large || in_ring || in_round || in_crack || in_small
    }
}

/// Whether a grid cell belongs to one of two round holes that touch in the vertex `corner`.
fn is_in_touching_holes(cell: [usize; 2], corner: [usize; 2]) -> bool {
    let from_corner = |k: usize, count: usize| {
        let d = (cell[k] + count - corner[k]) % count;
        if d < count / 2 {
            d as f64 + 0.5
        } else {
            d as f64 + 0.5 - count as f64
        }
    };
    let [x, y] = [from_corner(0, ALONG), from_corner(1, AROUND)];
    // Circles through the corner, each in its own quadrant.
    (x * y > 0.0)
        && [4.5, -4.0]
            .iter()
            .any(|c: &f64| (x - c).hypot(y - c) < c.abs() * 2f64.sqrt())
}

/// Positions and triangles of the model.
pub(crate) fn damaged_knot() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let knot = Knot::new();
    let damage = Damage::new(&knot);
    let place = |x: f64, y: f64| Place {
        along: x / ALONG as f64,
        angle: TAU * y / AROUND as f64,
    };
    let touching = knot.facing(TAU / 3.0);
    let corner = [
        (touching.along * ALONG as f64) as usize,
        (touching.angle.rem_euclid(TAU) / TAU * AROUND as f64) as usize,
    ];

    let places: Vec<Place> = (0..ALONG * AROUND)
        .map(|v| {
            let moved = |key: usize| UNEVENNESS * scatter((2 * v + key) as u64 + (1 << 32));
            place(
                (v / AROUND) as f64 + moved(0),
                (v % AROUND) as f64 + moved(1),
            )
        })
        .collect();
    let is_missing: Vec<bool> = places
        .iter()
        .map(|&p| damage.is_missing(&knot, p))
        .collect();
    let vertex = |i: usize, j: usize| (i % ALONG) * AROUND + j % AROUND;
    let mut triangles = Vec::new();
    for i in 0..ALONG {
        for j in (0..AROUND).filter(|&j| !is_in_touching_holes([i, j], corner)) {
            let [a, b, c, d] = [
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            ];
            let halves = if scatter(a as u64) > 0.0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            let kept = halves.iter().filter(|t| !t.iter().any(|&v| is_missing[v]));
            triangles.extend(kept.map(|t| t.map(|v| v as u32)));
        }
    }
    let point = |v: u32| knot.point(places[v as usize]).into();
    without_unused(point, triangles)
}

/// The points that `triangles` use. The triangles get the new indices.
fn without_unused(
    point: impl Fn(u32) -> [f64; 3],
    mut triangles: Vec<[u32; 3]>,
) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    for v in triangles.iter_mut().flatten() {
        // Every vertex of a triangle is in the list.
        *v = used.partition_point(|&u| u < *v) as u32;
    }
    (used.into_iter().map(point).collect(), triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use holefill::{BoundaryLoops, LoopClass, TriMesh};

    #[test]
    fn the_model_is_clean_and_has_every_kind_of_hole() {
        let (positions, triangles) = damaged_knot();
        assert!(
            (100_000..150_000).contains(&triangles.len()),
            "{}",
            triangles.len()
        );
        let mesh = TriMesh::new(positions, triangles).unwrap();
        assert!(mesh.defects().is_empty(), "{:?}", mesh.defects().summary());
        let loops = BoundaryLoops::find(&mesh).loops;
        let count = |class| loops.iter().filter(|l| l.class == class).count();
        assert!(
            count(LoopClass::Simple) >= 12,
            "{}",
            count(LoopClass::Simple)
        );
        assert!(count(LoopClass::Touching) >= 2);
        assert_eq!(count(LoopClass::Island), 1);
        assert_eq!(count(LoopClass::OuterRim) + count(LoopClass::OpenChain), 0);
        assert!(loops.iter().any(|l| l.edge_count() > 80));
    }
}
