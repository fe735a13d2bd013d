//! Tests: reconstructs surfaces that are known, and gives wrong and degenerate points.

use super::*;
use crate::boundary::loops::BoundaryLoops;
use crate::error::ErrorKind;
use crate::fixtures::{self, Arrays, Noise, Point};
use crate::job::Job;
use crate::mesh::attributes::{AttributeValues, ScalarValues};
use crate::quality::topology::{Topology, examine};
use proptest::prelude::*;
use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

fn reconstruct(points: &[Point]) -> Result<(TriMesh, PointReport)> {
    let cloud = PointCloud::new(points.to_vec());
    mesh_from_points(cloud, &PointOptions::default(), None)
}

/// The mesh of points that have a surface, checked for what always holds.
fn surface(points: &[Point]) -> (TriMesh, PointReport, Topology) {
    let (mesh, report) = reconstruct(points).unwrap();
    let topology = check(points, &mesh, &report);
    (mesh, report, topology)
}

/// What holds for every mesh from points.
fn check(points: &[Point], mesh: &TriMesh, report: &PointReport) -> Topology {
    let topology = examine(mesh.triangles());
    assert!(topology.is_oriented_manifold(), "{topology:?}");
    let bits = |points: &[Point]| -> Vec<[u64; 3]> {
        points.iter().map(|p| p.map(f64::to_bits)).collect()
    };
    assert_eq!(bits(mesh.positions()), bits(points));
    assert_eq!(report.points, points.len());
    assert_eq!(report.used, topology.vertices);
    assert_eq!(
        report.used + report.unused + report.duplicates,
        report.points
    );
    assert_eq!(report.triangles, mesh.triangles().len());
    assert_eq!(report.pieces, topology.components);
    topology
}

fn loop_sizes(mesh: &TriMesh) -> Vec<usize> {
    let found = BoundaryLoops::find(mesh);
    let mut sizes: Vec<usize> = found.loops.iter().map(|l| l.edge_count()).collect();
    sizes.sort_unstable();
    sizes
}

/// The volume that the triangles enclose with the origin.
fn volume(mesh: &TriMesh) -> f64 {
    mesh.triangles()
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| mesh.point(v));
            a.dot(&b.cross(&c)) / 6.0
        })
        .sum()
}

/// Points at random on the unit sphere.
fn random_sphere(count: usize, seed: u64) -> Vec<Point> {
    let mut noise = Noise(seed);
    (0..count)
        .map(|_| {
            let (z, angle) = (noise.signed(), TAU * noise.signed());
            let r = (1.0 - z * z).sqrt();
            [r * angle.cos(), r * angle.sin(), z]
        })
        .collect()
}

#[test]
fn a_sphere_comes_back_closed_and_outward() {
    let sphere = fixtures::sphere(16);
    let (mesh, report, topology) = surface(&sphere.positions);
    assert_eq!(report.used, report.points);
    assert_eq!(topology.boundary_edges, 0);
    assert_eq!(topology.euler_characteristic(), 2);
    assert_eq!(report.pieces, 1);
    assert!(volume(&mesh) > 0.98 * 2.0 * TAU / 3.0);
}

#[test]
fn a_sheet_keeps_its_hole_and_faces_up() {
    let arrays = fixtures::sheet_without(20, |i, j| (7..13).contains(&i) && (7..13).contains(&j));
    let flat =
        arrays.mapped(|[x, y, _]| [x + 0.1 * (1.7 * y).sin(), y + 0.1 * (2.3 * x).cos(), 0.0]);
    let (mesh, report, topology) = surface(&flat.positions);
    assert_eq!(report.used, report.points);
    assert_eq!(topology.euler_characteristic(), 0);
    let sizes = loop_sizes(&mesh);
    assert!((18..=24).contains(&sizes[0]), "{sizes:?}");
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|v| mesh.point(v));
        assert!((b - a).cross(&(c - a)).z > 0.0);
    }
}

#[test]
fn a_regular_grid_is_triangulated_without_gaps() {
    let (mesh, report, topology) = surface(&fixtures::sheet(15, |_, _| 2.0).positions);
    assert_eq!(report.used, report.points);
    assert_eq!(mesh.triangles().len(), 2 * 15 * 15);
    assert_eq!(topology.euler_characteristic(), 1);
    assert_eq!(loop_sizes(&mesh), [60]);
}

/// Rows of points along y at distance 1, the points of a row 0.6 apart, without the middle six of the rows
/// `missing`. The sheet is flat up to 8.5, and then turns round a cylinder of radius `radius`; normals estimated
/// beside the gap are up to 50° wrong.
fn bent_sheet_without(
    missing: std::ops::Range<u32>,
    radius: f64,
    is_staggered: bool,
) -> Vec<Point> {
    const TURN: f64 = 2.4;
    let profile = |row: u32| {
        let along = f64::from(row) - 8.5;
        let angle = (along / radius).clamp(0.0, TURN);
        let straight = along - radius * angle;
        [
            radius * angle.sin() + straight * angle.cos(),
            radius * (angle.cos() - 1.0) - straight * angle.sin(),
        ]
    };
    let place = |(row, k): (u32, u32)| {
        let [x, z] = profile(row);
        let shift = if is_staggered && row % 2 == 1 {
            0.3
        } else {
            0.0
        };
        [x, 0.6 * f64::from(k) + shift, z]
    };
    let all = (0..17).flat_map(|row| (0..30).map(move |k| (row, k)));
    all.filter(|(row, k)| !(missing.contains(row) && (12..18).contains(k)))
        .map(place)
        .collect()
}

#[test]
fn a_gap_is_closed_wholly_or_not_at_all() {
    for radius in [0.7, 0.8, 0.9, 1.0, 1.1, 1.2] {
        for is_staggered in [false, true] {
            let loops = |missing| {
                let points = bent_sheet_without(missing, radius, is_staggered);
                let (mesh, report, _) = surface(&points);
                assert_eq!(report.used, report.points);
                loop_sizes(&mesh)
            };
            // Circles of 1.8 times the median of the surface, and of 3.5 times.
            let whole = loops(8..9);
            assert_eq!(whole.len(), 1, "{radius}, {is_staggered}: {whole:?}");
            let sizes = loops(6..9);
            assert_eq!(sizes.len(), 2, "{radius}, {is_staggered}: {sizes:?}");
            assert!((14..=18).contains(&sizes[0]), "{sizes:?}");
        }
    }
}

#[test]
fn a_cylinder_stays_open_at_both_ends() {
    let cylinder = fixtures::cylinder(24, 10);
    let (mesh, report, topology) = surface(&cylinder.positions);
    assert_eq!(report.used, report.points);
    assert_eq!(topology.euler_characteristic(), 0);
    assert_eq!(loop_sizes(&mesh), [24, 24]);
    assert!(volume(&mesh) > 0.0);
}

#[test]
fn a_torus_keeps_its_handle() {
    let torus = fixtures::torus(24, 48).jittered(0.01, 3);
    let (mesh, report, topology) = surface(&torus.positions);
    assert_eq!(report.used, report.points);
    assert_eq!(topology.boundary_edges, 0);
    assert_eq!(topology.euler_characteristic(), 0);
    assert!(volume(&mesh) > 0.9 * TAU * TAU);
}

#[test]
fn noise_does_not_tear_the_surface() {
    // The spacing is about 0.1.
    let sphere = fixtures::sphere(16);
    for share in [0.01, 0.1, 0.2] {
        let noisy = sphere.jittered(share * 0.1, 5);
        let (_, report, topology) = surface(&noisy.positions);
        assert!(
            report.used * 100 >= report.points * 99,
            "{share}: {report:?}"
        );
        assert_eq!(topology.boundary_edges, 0, "{share}");
        assert_eq!(topology.euler_characteristic(), 2, "{share}");
    }
}

#[test]
fn a_random_spacing_leaves_few_small_holes() {
    for seed in 0..3 {
        let points = random_sphere(3000, seed);
        let (mesh, report, _) = surface(&points);
        assert!(report.used * 100 >= report.points * 99, "{report:?}");
        assert_eq!(report.pieces, 1);
        let sizes = loop_sizes(&mesh);
        assert!(sizes.len() <= 3, "{sizes:?}");
    }
}

#[test]
fn the_spacing_may_change() {
    // From 1 to 12 between the poles.
    let sphere = random_sphere(4000, 1);
    let dense_below: Vec<Point> = sphere
        .into_iter()
        .enumerate()
        .filter(|(k, p)| p[2] < 0.0 || k % 12 == 0)
        .map(|(_, p)| p)
        .collect();
    let (mesh, report, _) = surface(&dense_below);
    assert!(report.used * 100 >= report.points * 99, "{report:?}");
    assert!(loop_sizes(&mesh).len() <= 4, "{:?}", loop_sizes(&mesh));
}

#[test]
fn two_spheres_are_two_pieces_and_both_face_outward() {
    let sphere = fixtures::sphere(12);
    let inner = sphere.moved(0.5, 0.3, [0.0; 3]);
    let (mesh, report, topology) = surface(&sphere.beside(&inner).positions);
    assert_eq!(report.pieces, 2);
    assert_eq!(topology.boundary_edges, 0);
    let expected = 2.0 * TAU / 3.0 * (1.0 + 0.125);
    assert!(volume(&mesh) > 0.95 * expected, "{}", volume(&mesh));
}

#[test]
fn given_normals_decide_the_side() {
    let sphere = fixtures::sphere(10);
    let inward: Vec<Point> = sphere
        .positions
        .iter()
        .map(|p| p.map(|c| -7.0 * c))
        .collect();
    let make = |normals: Vec<Point>| {
        let cloud = PointCloud {
            normals: Some(normals),
            ..PointCloud::new(sphere.positions.clone())
        };
        mesh_from_points(cloud, &PointOptions::default(), None).unwrap()
    };
    let (mesh, report) = make(inward.clone());
    assert_eq!(report.estimated_normals, 0);
    assert!(volume(&mesh) < -4.0);

    // One good normal is enough.
    let mut almost_none = vec![[0.0, f64::NAN, 0.0]; inward.len()];
    almost_none[7] = inward[7];
    let (mesh, report) = make(almost_none);
    assert_eq!(report.estimated_normals, inward.len() - 1);
    assert!(volume(&mesh) < -4.0);
}

#[test]
fn duplicates_stay_as_isolated_vertices_with_their_attributes() {
    let sphere = fixtures::sphere(8);
    let mut points = sphere.positions.clone();
    points.extend_from_slice(&sphere.positions[..10]);
    points.insert(0, sphere.positions[3]);
    let numbers: Vec<u32> = (0..points.len() as u32).collect();
    let mut cloud = PointCloud::new(points.clone());
    let column = AttributeValues::Scalars(ScalarValues::U32(numbers));
    cloud.attributes.push("number", column.clone()).unwrap();
    let (mesh, report) = mesh_from_points(cloud, &PointOptions::default(), None).unwrap();
    check(&points, &mesh, &report);
    assert_eq!(report.duplicates, 11);
    assert_eq!(report.unused, 0);
    assert_eq!(mesh.vertex_attributes().get("number"), Some(&column));
    // The first at a place is the one that is used: vertex 0, not its like.
    assert!(mesh.triangles().iter().flatten().any(|&v| v == 0));
    assert!(mesh.triangles().iter().flatten().all(|&v| v != 4));
}

#[test]
fn what_makes_no_surface_is_refused_with_a_reason() {
    let line: Vec<Point> = (0..20)
        .map(|k| [f64::from(k), 2.0 * f64::from(k), 1.0])
        .collect();
    let mut with_nan = fixtures::sphere(4).positions;
    with_nan[5][1] = f64::NAN;
    let cases: [(&[Point], ErrorKind, &str); 7] = [
        (&[], ErrorKind::InvalidInput, "0 points are too few"),
        (&line[..3], ErrorKind::InvalidInput, "3 points are too few"),
        (
            &[[1.0; 3]; 9],
            ErrorKind::Geometry,
            "at 1 different places only",
        ),
        (&line, ErrorKind::Geometry, "on one line"),
        (&with_nan, ErrorKind::InvalidInput, "point 5 is not finite"),
        (
            &[
                [0.0; 3],
                [1.0, 0.0, f64::INFINITY],
                [0.0, 1.0, 0.0],
                [1.0; 3],
            ],
            ErrorKind::InvalidInput,
            "point 1 is not finite",
        ),
        (
            &[
                [-1.7e308; 3],
                [1.7e308; 3],
                [0.0, 1.0, 0.0],
                [1.0, 0.0, 0.0],
            ],
            ErrorKind::InvalidInput,
            "too far apart",
        ),
    ];
    for (points, kind, expected) in cases {
        let error = reconstruct(points).unwrap_err();
        assert_eq!(error.kind(), kind, "{error}");
        assert!(error.message().contains(expected), "{error}");
    }
}

#[test]
fn options_and_lengths_are_checked() {
    let points = fixtures::sphere(4).positions;
    let refused = |cloud: PointCloud, options: &PointOptions| {
        let error = mesh_from_points(cloud, options, None).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput, "{error}");
    };
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = PointOptions {
            radius: Some(radius),
            ..PointOptions::default()
        };
        refused(PointCloud::new(points.clone()), &options);
    }
    for neighbours in [0, 5, 201] {
        let options = PointOptions {
            neighbours,
            ..PointOptions::default()
        };
        refused(PointCloud::new(points.clone()), &options);
    }
    let cloud = PointCloud {
        normals: Some(vec![[0.0; 3]; 2]),
        ..PointCloud::new(points.clone())
    };
    refused(cloud, &PointOptions::default());
    let cloud = PointCloud {
        positions: points,
        ..PointCloud::default()
    };
    refused(cloud, &PointOptions::default());
}

#[test]
fn a_radius_leaves_open_what_is_larger() {
    let sheet = fixtures::sheet(12, |_, _| 0.0);
    let with_hole = sheet.cut(|c| (c[0] - 6.0).hypot(c[1] - 6.0) < 2.0);
    let make = |radius: f64| {
        let options = PointOptions {
            radius: Some(radius),
            ..PointOptions::default()
        };
        mesh_from_points(PointCloud::new(with_hole.positions.clone()), &options, None)
    };
    let (mesh, _) = make(1.2).unwrap();
    assert_eq!(loop_sizes(&mesh).len(), 2);
    let (mesh, _) = make(5.0).unwrap();
    assert_eq!(loop_sizes(&mesh).len(), 1);
    let error = make(0.1).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Geometry);
    assert!(error.message().contains("radius 0.1"), "{error}");
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let points = fixtures::torus(20, 40).jittered(0.03, 9).positions;
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| surface(&points).0.triangles().to_vec())
    };
    assert_eq!(with(1), with(4));
}

#[test]
fn it_stops_when_asked_to() {
    let points = fixtures::sphere(16).positions;
    let asked = AtomicUsize::new(0);
    // Threads that share a job lose ticks to each other: how often they ask differs from run to run.
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one_thread = one_thread.unwrap();
    let count = |stop_at: usize| {
        asked.store(0, Ordering::Relaxed);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= stop_at;
        let (cloud, options) = (PointCloud::new(points.clone()), PointOptions::default());
        one_thread
            .install(|| super::reconstruct(cloud, &options, &Job::new(&stop)))
            .map(|_| asked.load(Ordering::Relaxed))
    };
    let questions = count(usize::MAX).unwrap();
    assert!(questions >= 5);
    for stop_at in 0..questions {
        assert_eq!(count(stop_at).unwrap_err().kind(), ErrorKind::Cancelled);
    }
}

#[test]
fn the_scale_may_be_extreme() {
    let sphere = fixtures::sphere(8).jittered(0.02, 1);
    let expected = surface(&sphere.positions).0.triangles().to_vec();
    for exponent in [-900, -300, 300, 900] {
        let scale = 2.0_f64.powi(exponent);
        let scaled = sphere.mapped(|p| p.map(|c| c * scale));
        let (mesh, report, _) = surface(&scaled.positions);
        assert_eq!(mesh.triangles(), expected, "2^{exponent}");
        assert!(report.radius.iter().all(|&r| r > 0.01 * scale && r < scale));
    }
}

/// Points of all kinds: on a lattice, in clusters, along lines, at random.
fn any_points() -> impl Strategy<Value = Vec<Point>> {
    let lattice = prop::collection::vec(prop::array::uniform3(0_i32..4), 0..60)
        .prop_map(|points| points.into_iter().map(|p| p.map(f64::from)).collect());
    let anywhere = prop::collection::vec(prop::array::uniform3(-1.0..1.0), 0..80);
    let flat = prop::collection::vec((0_i32..8, 0_i32..8), 0..80).prop_map(|points| {
        let place = |(x, y): (i32, i32)| [f64::from(x), f64::from(y), f64::from(x * y) * 0.01];
        points.into_iter().map(place).collect()
    });
    let clusters = (
        prop::collection::vec(prop::array::uniform3(-1.0..1.0), 1..8),
        0_u64..99,
    )
        .prop_map(|(centers, seed): (Vec<Point>, u64)| {
            let mut noise = Noise(seed);
            let near = |c: &Point| -> Vec<Point> {
                (0..9)
                    .map(|_| c.map(|c| c + 1e-9 * noise.signed()))
                    .collect()
            };
            centers.iter().flat_map(near).collect()
        });
    prop_oneof![lattice, anywhere, flat, clusters]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_points_give_a_manifold_or_a_reason(points in any_points()) {
        match reconstruct(&points) {
            Ok((mesh, report)) => {
                check(&points, &mesh, &report);
                prop_assert!(report.triangles > 0);
            }
            Err(error) => prop_assert!(
                [ErrorKind::InvalidInput, ErrorKind::Geometry].contains(&error.kind())
            ),
        }
    }

    #[test]
    fn place_scale_and_turn_do_not_matter(
        seed in 0_u64..1000,
        scale in 1e-3..1e3,
        angle in 0.0..6.0,
        offset in prop::array::uniform3(-10.0..10.0),
    ) {
        let sphere = fixtures::sphere(7).jittered(0.03, seed);
        let triangles = |arrays: &Arrays| surface(&arrays.positions).0.triangles().to_vec();
        prop_assert_eq!(triangles(&sphere), triangles(&sphere.moved(scale, angle, offset)));
    }
}

#[test]
fn a_star_is_the_delaunay_star_of_its_plane() {
    let mut noise = Noise(17);
    let tangent = Tangent::new(Vec3::zeros(), Vec3::z());
    for round in 0..200 {
        // Every other round on a lattice, where circles pass through many points.
        let coordinate = Cell::new(0.0);
        let mut draw = || {
            let value = 4.0 * noise.signed();
            coordinate.set(if round % 2 == 0 { value } else { value.round() });
            coordinate.get()
        };
        let mut points: Vec<Vec3> = (0..25)
            .map(|_| Vec3::new(draw(), draw(), 0.0))
            .filter(|p| p.norm() > 0.0)
            .collect();
        points.sort_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
        points.dedup();
        let star = star::Star::new(0, &tangent, (1..).zip(points.iter().copied()));
        let place = |v: u32| tangent.place(&points[v as usize - 1]).unwrap();
        let sectors: Vec<[u32; 2]> = star.sectors().collect();
        for (k, &[a, b]) in sectors.iter().enumerate() {
            let (p, q) = (place(a), place(b));
            for v in 1..=points.len() as u32 {
                assert!(tangent::in_circle(p, q, place(v)) <= 0.0, "round {round}");
            }
            for &[c, d] in &sectors[..k] {
                assert!(!tangent::sectors_overlap([p, q], [place(c), place(d)]));
            }
        }
        // Every direction that points surround belongs to a sector.
        let is_inside = (1..=points.len() as u32).all(|v| {
            let others = || (1..=points.len() as u32).map(place);
            others().any(|w| tangent::turn(place(v), w) > 0.0)
                && others().any(|w| tangent::turn(place(v), w) < 0.0)
        });
        if is_inside {
            assert!(star.is_closed(), "round {round}");
        }
    }
}
