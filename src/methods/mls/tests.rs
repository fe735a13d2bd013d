//! Tests: fills holes in analytic surfaces and measures the distance of the patch from them.

use super::*;
use crate::job::Job;

/// The hole in a grid over `[-1, 1]²` that is lifted by `f`, inside the circle of this radius.
fn hole_in_grid(f: impl Fn(f64, f64) -> Vec3, n: i32, radius: f64) -> Hole {
    let h = 1.0 / f64::from(n);
    let at = |i: i32, j: i32| f(f64::from(i) * h, f64::from(j) * h);
    let is_known = |i: i32, j: i32| {
        let middle = |k: i32| (f64::from(k) + 0.5) * h;
        i >= -n && i < n && j >= -n && j < n && middle(i).hypot(middle(j)) > radius
    };
    // The cells' edges toward the hole, with the hole on the left.
    let mut next = std::collections::BTreeMap::new();
    for i in -n..n {
        for j in -n..n {
            if is_known(i, j) {
                continue;
            }
            for (a, b, beyond) in [
                ((i, j), (i + 1, j), (i, j - 1)),
                ((i + 1, j), (i + 1, j + 1), (i + 1, j)),
                ((i + 1, j + 1), (i, j + 1), (i, j + 1)),
                ((i, j + 1), (i, j), (i - 1, j)),
            ] {
                if is_known(beyond.0, beyond.1) {
                    next.insert(a, b);
                }
            }
        }
    }
    let start = *next.keys().next().unwrap();
    let mut rim = vec![start];
    while next[rim.last().unwrap()] != start {
        rim.push(next[rim.last().unwrap()]);
    }
    let mut numbers: std::collections::BTreeMap<(i32, i32), u32> =
        rim.iter().copied().zip(0..).collect();
    let mut points: Vec<Vec3> = rim.iter().map(|&(i, j)| at(i, j)).collect();
    let mut triangles = Vec::new();
    for i in -n..n {
        for j in -n..n {
            if is_known(i, j) {
                let mut number = |i: i32, j: i32| {
                    *numbers.entry((i, j)).or_insert_with(|| {
                        points.push(at(i, j));
                        points.len() as u32 - 1
                    })
                };
                let [a, b, c, d] =
                    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(k, l)| number(i + k, j + l));
                triangles.push([a, b, c]);
                triangles.push([a, c, d]);
            }
        }
    }
    let levels = (0..points.len()).map(|i| u32::from(i >= rim.len()));
    let levels = levels.collect();
    Hole {
        polygon: (0..rim.len() as u32).collect(),
        is_bridge: vec![false; rim.len()],
        surroundings: Surroundings::new(rim.len(), points, levels, triangles),
        ..Hole::default()
    }
}

fn filled(hole: &Hole, options: &MlsOptions) -> Result<PatchSurface> {
    HeightField::new(hole, &hole.surroundings, options, &Job::unlimited())?
        .patch(100_000, &Job::unlimited())
}

#[test]
fn a_quadratic_height_field_comes_back_wherever_it_lies() {
    let f = |u: f64, v: f64| Vec3::new(u, v, 0.2 * u * u - 0.3 * u * v + 0.1 * v);
    let turn = nalgebra::Rotation3::from_euler_angles(0.5, -1.2, 2.0);
    let mut hole = hole_in_grid(f, 12, 0.5);
    let points = hole.surroundings.points().iter();
    let moved = points.map(|p| turn * p * 3.0 + Vec3::new(5.0, 6.0, -7.0));
    hole.surroundings = hole.surroundings.moved(moved.collect());
    for unit in [MlsUnit::Step, MlsUnit::Radius] {
        // Heights over the tilted plane of least squares are only nearly quadratic.
        let options = MlsOptions {
            unit,
            ..MlsOptions::default()
        };
        let surface = filled(&hole, &options).unwrap();
        assert!(surface.points.len() > 200 + surface.rim_count);
        for p in &surface.points[surface.rim_count..] {
            let q = turn.inverse() * (p - Vec3::new(5.0, 6.0, -7.0)) / 3.0;
            assert!((q.z - f(q.x, q.y).z).abs() < 2e-3, "{q}");
            assert!(q.x.hypot(q.y) < 0.6);
        }
    }
}

#[test]
fn the_samples_have_the_spacing_of_equation_nine() {
    let hole = hole_in_grid(|u, v| Vec3::new(u, v, 0.0), 20, 0.6);
    let step = hole.surroundings.sampling_step();
    let surface = filled(&hole, &MlsOptions::default()).unwrap();
    let expected = std::f64::consts::PI * 0.36 / (step * step);
    let samples = (surface.points.len() - surface.rim_count) as f64;
    assert!(samples < expected && samples > 0.85 * expected);
    assert!(surface.points.iter().all(|p| p.z.abs() < 1e-12));
}

#[test]
fn what_folds_in_the_plane_is_refused_and_filled_over_the_sphere() {
    // A sphere of which less than the lower half is left.
    let f = |u: f64, v: f64| {
        let (polar, angle) = (2.6 * u.hypot(v), v.atan2(u));
        Vec3::new(
            polar.sin() * angle.cos(),
            polar.sin() * angle.sin(),
            polar.cos(),
        )
    };
    let hole = hole_in_grid(f, 20, 0.7);
    let with = |domain| MlsOptions {
        domain,
        ..MlsOptions::default()
    };
    let error = filled(&hole, &with(MlsDomain::Plane)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Geometry);
    assert!(error.message().contains("folded"), "{error}");
    for domain in [MlsDomain::Auto, MlsDomain::Curved] {
        let surface = filled(&hole, &with(domain)).unwrap();
        for p in &surface.points[surface.rim_count..] {
            assert!((p.norm() - 1.0).abs() < 5e-3, "{p}");
        }
        assert!(surface.points.iter().any(|p| p.z > 0.99));
    }
}

#[test]
fn other_values_are_extended_like_the_heights() {
    let hole = hole_in_grid(|u, v| Vec3::new(u, v, 0.1 * u * v), 12, 0.5);
    let options = MlsOptions::default();
    let field = HeightField::new(&hole, &hole.surroundings, &options, &Job::unlimited()).unwrap();
    let value = |p: &Vec3| 3.0 + p.x - p.x * p.y;
    let known = field
        .vertices()
        .iter()
        .map(|&v| value(&hole.surroundings.point(v)))
        .collect();
    let surface = field.patch(100_000, &Job::unlimited()).unwrap();
    let new_points = &surface.points[surface.rim_count..];
    let found = field
        .extend(&[known], new_points, &Job::unlimited())
        .unwrap();
    for (p, found) in new_points.iter().zip(&found[0]) {
        assert!((found - value(p)).abs() < 5e-3, "{found} at {p}");
    }
}

#[test]
fn limits_and_stops_are_errors() {
    let hole = hole_in_grid(|u, v| Vec3::new(u, v, 0.0), 12, 0.5);
    let options = MlsOptions::default();
    let field = HeightField::new(&hole, &hole.surroundings, &options, &Job::unlimited()).unwrap();
    assert_eq!(
        field.patch(10, &Job::unlimited()).unwrap_err().kind(),
        ErrorKind::Limit
    );
    assert_eq!(
        field.patch(1000, &Job::new(&|| true)).unwrap_err().kind(),
        ErrorKind::Cancelled
    );
}
