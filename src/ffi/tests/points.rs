//! Meshes from points through C.

use super::*;
use crate::reconstruct::{PointCloud, PointOptions, mesh_from_points};

/// The points of a sphere with two holes.
fn cloud() -> Vec<[f64; 3]> {
    let arrays = holed();
    let mut is_used = vec![false; arrays.positions.len()];
    for &v in arrays.triangles.iter().flatten() {
        is_used[v as usize] = true;
    }
    let used = arrays
        .positions
        .iter()
        .zip(is_used)
        .filter(|(_, used)| *used);
    used.map(|(p, _)| *p).collect()
}

/// What a call is given, and what it hands out.
#[derive(Clone, Copy, Default)]
struct Given {
    normals: Option<HolefillInput>,
    colors: Option<HolefillInput>,
    options: Option<HolefillPointOptions>,
}

fn or_null<T>(value: &Option<T>) -> *const T {
    value.as_ref().map_or(ptr::null(), ptr::from_ref)
}

/// The status, the mesh, and what became of the points.
fn make(
    points: &HolefillInput,
    given: &Given,
) -> (HolefillStatus, Owned<HolefillMesh>, HolefillPointSummary) {
    let mut mesh = Owned(HolefillMesh::default());
    let mut summary = HolefillPointSummary::default();
    let (normals, colors) = (or_null(&given.normals), or_null(&given.colors));
    let (options, made, became) = (or_null(&given.options), &mut mesh.0, &mut summary);
    let (status, text) =
        said!(holefill_mesh_from_points: points, normals, colors, options, made, became);
    if status != OK {
        let written = (mesh.0.id, summary.triangle_count);
        assert_eq!(written, (0, 0), "outputs are written only on success");
        assert!(!text.is_empty());
    }
    (status, mesh, summary)
}

fn point_options() -> HolefillPointOptions {
    HolefillPointOptions {
        threads: 1,
        ..Default::default()
    }
}

fn with_options(options: HolefillPointOptions) -> Given {
    Given {
        options: Some(options),
        ..Given::default()
    }
}

#[test]
fn a_mesh_from_points_is_that_of_the_rust_call() {
    let points = cloud();
    let (expected, report) = mesh_from_points(
        PointCloud::new(points.clone()),
        &PointOptions::default(),
        None,
    )
    .unwrap();
    let view = rows(&points);
    for threads in [0, 1, 2] {
        let options = HolefillPointOptions {
            threads,
            ..point_options()
        };
        let (status, mesh, summary) = make(&view, &with_options(options));
        assert_eq!(status, OK);
        assert_eq!(positions(mesh.0), points);
        assert_eq!(triangles(mesh.0), expected.triangles());
        assert_eq!(summary.used as usize, report.used);
        assert_eq!(summary.triangle_count as usize, report.triangles);
        assert_eq!(summary.piece_count as usize, report.pieces);
        assert_eq!(summary.estimated_normals as usize, points.len());
        assert_eq!(summary.radius, report.radius);
        assert_eq!(loop_count(mesh.0), 2);
        assert_eq!(fill_all(mesh.0, &super::options()), OK);
    }
}

#[test]
fn points_may_stand_anywhere_and_duplicates_stay_as_vertices() {
    #[repr(C, packed)]
    #[derive(Clone, Copy)]
    struct Sample {
        intensity: u8,
        point: [f32; 3],
        normal: [f64; 3],
        color: [u8; 4],
    }
    let mut samples: Vec<Sample> = cloud()
        .iter()
        .enumerate()
        .map(|(i, p)| Sample {
            intensity: 9,
            point: p.map(|c| c as f32),
            // Of a sphere, turned inward: so must the triangles be.
            normal: p.map(|c| -3.0 * c),
            color: [i as u8, 2, 3, 4],
        })
        .collect();
    samples.push(samples[0]);
    samples[1].normal = [0.0; 3];
    let start: *const u8 = samples.as_ptr().cast();
    let view = |offset: usize, scalar_type| HolefillInput {
        data: start.wrapping_add(offset).cast(),
        count: samples.len() as u64,
        stride: size_of::<Sample>() as u64,
        scalar_type,
        reserved: 0,
    };
    let given = Given {
        normals: Some(view(13, HOLEFILL_TYPE_F64)),
        colors: Some(view(37, HOLEFILL_TYPE_U8)),
        options: None,
    };
    let (status, mesh, summary) = make(&view(1, HOLEFILL_TYPE_F32), &given);
    assert_eq!(status, OK);
    assert_eq!((summary.duplicates, summary.estimated_normals), (1, 1));
    let (positions, triangles) = (positions(mesh.0), triangles(mesh.0));
    assert_eq!(positions.len(), samples.len());
    let copied = positions.iter().zip(&samples);
    assert!(
        copied
            .into_iter()
            .all(|(p, s)| *p == { s.point }.map(f64::from))
    );
    for t in &triangles {
        let [a, b, c] = t.map(|v| crate::math::Vec3::from(positions[v as usize]));
        assert!(
            (b - a).cross(&(c - a)).dot(&a) < 0.0,
            "triangles face inward"
        );
    }
    let mut colors = vec![[0_u8; 3]; samples.len()];
    let output = place(&mut colors);
    ok!(holefill_mesh_read_attribute: mesh.0, 1, 0, 0, &output);
    let kept = colors.iter().zip(&samples);
    assert!(kept.into_iter().all(|(c, s)| c[..] == { s.color }[..3]));
}

#[test]
fn points_that_make_no_mesh_are_refused() {
    let good = cloud();
    let line: Vec<[f64; 3]> = (0..30).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let same = vec![[1.0, 2.0, 3.0]; 30];
    for few in [&[][..], &good[..1], &good[..3], &line, &same] {
        assert_eq!(make(&rows(few), &Given::default()).0, INVALID);
    }
    // Colors are data that is carried on, whatever it is.
    let mut points = good.clone();
    points[5][1] = f64::NAN;
    let given = Given {
        colors: Some(rows(&points)),
        ..Given::default()
    };
    assert_eq!(make(&rows(&good), &given).0, OK);
}

#[test]
fn options_for_points_are_checked() {
    let points = cloud();
    let view = rows(&points);
    let changes: [Change<HolefillPointOptions>; 15] = [
        (|_| {}, OK),
        (|o| o.time_budget = 1e6, OK),
        (|o| o.radius = -1.0, INVALID),
        (|o| o.radius = f64::NAN, INVALID),
        (|o| o.radius = f64::INFINITY, INVALID),
        // Circles so small that no three points are on one.
        (|o| o.radius = 1e-6, INVALID),
        (|o| o.time_budget = -1.0, INVALID),
        (|o| o.time_budget = f64::NAN, INVALID),
        (|o| o.time_budget = f64::INFINITY, INVALID),
        (|o| o.neighbours = 1, INVALID),
        (|o| o.neighbours = 5, INVALID),
        (|o| o.neighbours = 201, INVALID),
        (|o| o.neighbours = u32::MAX, INVALID),
        (|o| o.threads = 1025, LIMIT),
        (|o| o.time_budget = 1e-9, LIMIT),
    ];
    for (k, (change, expected)) in changes.into_iter().enumerate() {
        let mut options = point_options();
        change(&mut options);
        assert_eq!(make(&view, &with_options(options)).0, expected, "{k}");
    }
}

#[test]
fn making_a_mesh_from_points_can_be_stopped_at_every_call() {
    // Some tens of milliseconds.
    let points: Vec<[f64; 3]> = fixtures::sphere(60).positions;
    let view = rows(&points);
    let mut n = 0_i64;
    loop {
        let mut left = n;
        let options = HolefillPointOptions {
            progress: Some(stop_at),
            progress_data: (&raw mut left).cast(),
            ..point_options()
        };
        let (status, ..) = make(&view, &with_options(options));
        if left >= 0 {
            assert_eq!(status, OK);
            break;
        }
        assert_eq!(status, CANCELLED, "call {n}");
        n += 1 + n / 3;
    }
    assert!(n > 0, "the callback is asked");
}
