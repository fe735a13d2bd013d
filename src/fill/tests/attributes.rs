//! What the new vertices and triangles get for attributes.

use super::{Filled, METHODS, fill_mesh, with_method};
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::select::Selection;
use crate::error::ErrorKind;
use crate::fill::session::at_once::fill_holes;
use crate::fixtures;
use crate::math::Vec3;
use crate::mesh::attributes::{AttributeValues, Attributes, ListValues, ScalarType, ScalarValues};
use crate::mesh::trimesh::TriMesh;
use crate::methods::method::Method;
use crate::options::{FillOptions, Interpolator};

type Columns = Vec<(&'static str, AttributeValues)>;

fn scalars(values: ScalarValues) -> AttributeValues {
    AttributeValues::Scalars(values)
}

/// Lists of different lengths that say which element they belong to.
fn lists(count: usize) -> AttributeValues {
    let mut items = Vec::new();
    let mut ends = Vec::new();
    for k in 0..count {
        items.extend(std::iter::repeat_n(k as i32, k % 4));
        ends.push(items.len());
    }
    let lists = ListValues::from_parts(ScalarType::U8, ScalarValues::I32(items), ends);
    AttributeValues::Lists(lists.unwrap())
}

/// A sphere with a hole, filled with these columns for its vertices and with labels on its triangles.
fn filled_with(columns: impl Fn(&[[f64; 3]]) -> Columns, method: Method) -> Filled {
    filled_by(columns, &with_method(method))
}

fn filled_by(columns: impl Fn(&[[f64; 3]]) -> Columns, options: &FillOptions) -> Filled {
    let arrays = fixtures::sphere(12).jittered(0.004, 9).cut(|c| c[2] > 0.55);
    let mut of_vertices = Attributes::new(arrays.positions.len());
    for (name, values) in columns(&arrays.positions) {
        of_vertices.push(name, values).unwrap();
    }
    let faces = arrays.triangles.len();
    let mut of_faces = Attributes::new(faces);
    let labels = (0..faces as u32).collect();
    of_faces
        .push("label", scalars(ScalarValues::U32(labels)))
        .unwrap();
    of_faces.push("ring", lists(faces)).unwrap();
    let mesh = TriMesh::with_attributes(arrays.positions, arrays.triangles, of_vertices, of_faces);
    let filled = fill_mesh(mesh.unwrap(), &Selection::default(), options);
    for (before, after) in [
        (
            filled.before.vertex_attributes(),
            filled.after.vertex_attributes(),
        ),
        (
            filled.before.face_attributes(),
            filled.after.face_attributes(),
        ),
    ] {
        for (old, new) in before.iter().zip(after) {
            assert_eq!(old.name, new.name);
            assert_eq!(old.values.scalar_type(), new.values.scalar_type());
            for k in 0..before.len() {
                let bits = |values: &AttributeValues| values.number(k).map(f64::to_bits);
                assert_eq!(bits(&old.values), bits(&new.values));
            }
        }
    }
    filled
}

impl Filled {
    /// The values of a column on the rim, and on the new vertices.
    fn rim_and_new(&self, name: &str) -> (Vec<f64>, Vec<f64>) {
        let values = self.after.vertex_attributes().get(name).unwrap();
        let number = |v: u32| values.number(v as usize).unwrap();
        let new = self.before.positions().len() as u32..self.after.positions().len() as u32;
        (
            self.boundary.loops[0]
                .vertices
                .iter()
                .map(|&v| number(v))
                .collect(),
            new.map(number).collect(),
        )
    }
}

fn range(values: &[f64]) -> (f64, f64) {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    (
        low,
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    )
}

/// Options for a smooth patch with this interpolator.
fn interpolated_by(interpolator: Interpolator) -> FillOptions {
    let mut options = with_method(Method::FairC1);
    options.attributes.interpolator = interpolator;
    options
}

const SMOOTH: [Interpolator; 3] = [
    Interpolator::Rbf,
    Interpolator::Biharmonic,
    Interpolator::Harmonic,
];

fn doubles(positions: &[[f64; 3]], f: impl Fn(&[f64; 3]) -> f64) -> AttributeValues {
    scalars(ScalarValues::F64(positions.iter().map(f).collect()))
}

fn bytes(positions: &[[f64; 3]], f: impl Fn(&[f64; 3]) -> f64) -> AttributeValues {
    let of = |p: &[f64; 3]| (127.5 + 127.5 * f(p)).round() as u8;
    scalars(ScalarValues::U8(positions.iter().map(of).collect()))
}

#[test]
fn numbers_of_every_type_follow_the_surface_and_constants_stay() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        let singles = |f: fn(&[f64; 3]) -> f64| {
            let values = positions.iter().map(|p| f(p) as f32).collect();
            scalars(ScalarValues::F32(values))
        };
        let count = |p: &[f64; 3]| (1e4 * (2.0 + p[0])) as u32;
        vec![
            ("heat", doubles(positions, |p| 1e6 + p[0])),
            ("quality", singles(|p| p[1])),
            ("same", doubles(positions, |_| 0.1)),
            ("same32", singles(|_| 0.1)),
            ("red", bytes(positions, |p| p[0])),
            ("green", bytes(positions, |_| 1.0)),
            (
                "intensity",
                scalars(ScalarValues::U32(positions.iter().map(count).collect())),
            ),
        ]
    };
    for method in [Method::Membrane, Method::FairC1, Method::FairC2] {
        for interpolator in SMOOTH {
            let mut options = interpolated_by(interpolator);
            options.method = method;
            let filled = filled_by(columns, &options);
            let smooth = |name: &str, tolerance: f64, expected: &dyn Fn(&Vec3) -> f64| {
                let (_, new) = filled.rim_and_new(name);
                assert!(new.len() > 20);
                for (value, p) in new.iter().zip(filled.new_points()) {
                    let error = (value - expected(p)).abs();
                    assert!(
                        error < tolerance,
                        "{name} by {interpolator:?}: {error} at {p}"
                    );
                }
            };
            // A linear function comes back, as far as the type holds it and the interpolant is a
            // function of the place.
            let (t, exact) = match interpolator {
                Interpolator::Rbf => (0.01, true),
                _ => (0.15, false),
            };
            smooth("heat", if exact { 1e-3 } else { t }, &|p| 1e6 + p.x);
            smooth("quality", if exact { 1e-5 } else { t }, &|p| p.y);
            // Rounded to whole numbers round the hole: that grows on the way inwards.
            smooth("red", 127.5 * t + 4.0, &|p| 127.5 + 127.5 * p.x);
            smooth("intensity", 1e4 * t + 2.0, &|p| 1e4 * (2.0 + p.x));
            for (name, value) in [
                ("same", 0.1),
                ("same32", f64::from(0.1_f32)),
                ("green", 255.0),
            ] {
                let (_, new) = filled.rim_and_new(name);
                assert!(
                    new.iter().all(|&v| v == value),
                    "{name} by {interpolator:?}"
                );
            }
        }
    }
}

#[test]
fn a_membrane_stays_in_the_range_of_the_rim_and_nothing_goes_far_beyond() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        vec![("steep", doubles(positions, |p| p[2].powi(9)))]
    };
    for interpolator in SMOOTH {
        let filled = filled_by(columns, &interpolated_by(interpolator));
        let (rim, new) = filled.rim_and_new("steep");
        let (old_low, old_high) = range(&rim);
        let (low, high) = range(&new);
        if interpolator == Interpolator::Harmonic {
            assert!(old_low <= low && high <= old_high);
        } else {
            // The values rise towards the hole, and go on rising.
            assert!(high > old_high);
            assert!(high <= old_high * (1.0 + 0.11));
        }
    }
}

#[test]
fn few_centers_leave_no_seam_at_the_rim() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        vec![(
            "wave",
            doubles(positions, |p| (9.0 * p[1].atan2(p[0])).sin()),
        )]
    };
    let mut options = interpolated_by(Interpolator::Rbf);
    options.attributes.centers = 8;
    let filled = filled_by(columns, &options);
    let values = filled.after.vertex_attributes().get("wave").unwrap();
    let number = |v: u32| values.number(v as usize).unwrap();
    // Eight centres cannot follow nine waves; the values next to the rim do all the same.
    let rim = &filled.boundary.loops[0].vertices;
    let first_new = filled.before.positions().len() as u32;
    let (mut error, mut count) = (0.0, 0);
    for t in filled.new_triangles() {
        for &v in t.iter().filter(|&&v| v >= first_new) {
            let at_rim: Vec<f64> = t
                .iter()
                .filter(|v| rim.contains(v))
                .map(|&v| number(v))
                .collect();
            if at_rim.len() == 2 {
                error += (number(v) - (at_rim[0] + at_rim[1]) / 2.0).abs();
                count += 1;
            }
        }
    }
    assert!(
        count > 20 && error / f64::from(count) < 0.35,
        "{}",
        error / f64::from(count)
    );
}

#[test]
fn only_the_named_attributes_are_interpolated() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        let ids = (0..positions.len() as i32).collect();
        vec![
            ("heat", doubles(positions, |p| p[0])),
            ("cold", doubles(positions, |p| p[0])),
            ("id", scalars(ScalarValues::I32(ids))),
        ]
    };
    let mut options = with_method(Method::FairC1);
    options.set("attributes.filled", "cold, id").unwrap();
    let filled = filled_by(columns, &options);
    let is_copied = |name: &str| {
        let (rim, new) = filled.rim_and_new(name);
        new.iter().all(|v| rim.contains(v))
    };
    assert!(is_copied("heat"));
    assert!(!is_copied("cold") && !is_copied("id"));
    for name in ["none", "attributes.interpolator"] {
        let mut options = with_method(Method::FairC1);
        match name {
            "none" => options.set("attributes.filled", name).unwrap(),
            _ => options.set(name, "nearest").unwrap(),
        }
        let filled = filled_by(columns, &options);
        for column in ["heat", "cold", "id"] {
            let (rim, new) = filled.rim_and_new(column);
            assert!(new.iter().all(|v| rim.contains(v)), "{name}: {column}");
        }
    }
}

#[test]
fn a_name_that_the_mesh_lacks_is_an_error_that_lists_those_it_has() {
    let arrays = fixtures::sphere(8).cut(|c| c[2] > 0.55);
    let mut of_vertices = Attributes::new(arrays.positions.len());
    of_vertices
        .push("heat", doubles(&arrays.positions, |p| p[0]))
        .unwrap();
    let of_faces = Attributes::new(arrays.triangles.len());
    let mesh = TriMesh::with_attributes(arrays.positions, arrays.triangles, of_vertices, of_faces);
    let mut mesh = mesh.unwrap();
    let boundary = BoundaryLoops::find(&mesh);
    let mut options = with_method(Method::FairC1);
    options.set("attributes.filled", "heat,haet").unwrap();
    let error =
        fill_holes(&mut mesh, &boundary, &Selection::default(), &options, None).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(
        error.message().contains("'haet'") && error.message().contains("heat"),
        "{error}"
    );
}

#[test]
fn a_label_comes_from_the_side_that_it_lies_on() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        let side = |p: &[f64; 3]| u8::from(p[0] > 0.0);
        vec![(
            "material",
            scalars(ScalarValues::U8(positions.iter().map(side).collect())),
        )]
    };
    let filled = filled_with(columns, Method::FairC1);
    let (_, new) = filled.rim_and_new("material");
    for (label, p) in new.iter().zip(filled.new_points()) {
        assert!(
            *label == f64::from(u8::from(p.x > 0.0)) || p.x.abs() < 0.2,
            "{label} at {p}"
        );
    }
}

#[test]
fn normals_against_the_orientation_stay_so() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        vec![
            ("nx", doubles(positions, |p| -2.0 * p[0])),
            ("ny", doubles(positions, |p| -2.0 * p[1])),
            ("nz", doubles(positions, |p| -2.0 * p[2])),
        ]
    };
    let filled = filled_with(columns, Method::FairC1);
    let normals = ["nx", "ny", "nz"].map(|name| filled.rim_and_new(name).1);
    for (i, p) in filled.new_points().iter().enumerate() {
        let normal = Vec3::new(normals[0][i], normals[1][i], normals[2][i]);
        assert!((normal.norm() - 1.0).abs() < 1e-12);
        assert!(normal.dot(&p.normalize()) < -0.9, "{normal} at {p}");
    }
}

#[test]
fn normals_are_those_of_the_patch_and_have_length_one() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        let axis = |k: usize| positions.iter().map(|p| p[k] as f32).collect();
        // In another order than usual, with another column between.
        vec![
            ("nz", scalars(ScalarValues::F32(axis(2)))),
            ("nx", scalars(ScalarValues::F32(axis(0)))),
            ("other", scalars(ScalarValues::F32(axis(0)))),
            ("ny", scalars(ScalarValues::F32(axis(1)))),
        ]
    };
    let filled = filled_with(columns, Method::FairC1);
    let normals = ["nx", "ny", "nz"].map(|name| filled.rim_and_new(name).1);
    for (i, p) in filled.new_points().iter().enumerate() {
        let normal = Vec3::new(normals[0][i], normals[1][i], normals[2][i]);
        assert!((normal.norm() - 1.0).abs() < 1e-6);
        assert!(normal.dot(&p.normalize()) > 0.9, "{normal} at {p}");
    }
}

#[test]
fn labels_and_lists_are_copied_from_the_rim() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        let count = positions.len();
        vec![
            (
                "label",
                scalars(ScalarValues::I32((0..count as i32).collect())),
            ),
            (
                "flag",
                scalars(ScalarValues::U8(
                    (0..count).map(|k| (k % 2) as u8).collect(),
                )),
            ),
            ("ring", lists(count)),
        ]
    };
    for method in METHODS {
        let filled = filled_with(columns, method);
        let rim = &filled.boundary.loops[0];
        let (labels, new_labels) = filled.rim_and_new("label");
        let (_, flags) = filled.rim_and_new("flag");
        let lists_of = |attributes: &Attributes| match attributes.get("ring") {
            Some(AttributeValues::Lists(lists)) => lists.clone(),
            other => panic!("{other:?}"),
        };
        let entry = |lists: &ListValues, k: usize| -> Vec<f64> {
            let range = lists.range(k).unwrap();
            range.map(|i| lists.items().get(i).unwrap()).collect()
        };
        let rings = lists_of(filled.after.vertex_attributes());
        let first = filled.before.positions().len();
        for (i, &label) in new_labels.iter().enumerate() {
            assert!(labels.contains(&label));
            assert_eq!(
                flags[i],
                f64::from(label as u32 % 2),
                "one source for all columns"
            );
            assert_eq!(entry(&rings, first + i), entry(&rings, label as usize));
        }
        // A new triangle has what some triangle along the rim has.
        let faces: Vec<u32> = rim.halfedges.iter().map(|h| h / 3).collect();
        let labels = filled.after.face_attributes().get("label").unwrap();
        let rings = lists_of(filled.after.face_attributes());
        let mut met = std::collections::BTreeSet::new();
        for f in filled.before.triangles().len()..filled.after.triangles().len() {
            let source = labels.number(f).unwrap() as u32;
            assert!(faces.contains(&source));
            assert_eq!(entry(&rings, f), entry(&rings, source as usize));
            met.insert(source);
        }
        assert!(met.len() > 4, "the nearest ones, not always the same");
        // At the rim itself it is the neighbour.
        for &h in &rim.halfedges {
            let new = filled.after.connectivity().twin(h) / 3;
            let source = labels.number(new as usize).unwrap() as u32;
            let corner = filled.after.triangles()[new as usize];
            let is_ear = corner.iter().filter(|v| rim.vertices.contains(v)).count() == 3;
            assert!(source == h / 3 || is_ear);
        }
    }
}

#[test]
fn a_column_that_cannot_be_computed_with_is_copied_and_harms_no_other() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        let count = positions.len();
        let mut broken = vec![1.0; count];
        broken.iter_mut().step_by(2).for_each(|v| *v = f64::NAN);
        let huge = (0..count).map(|k| if k % 2 == 0 { f64::MAX } else { -f64::MAX });
        vec![
            ("broken", scalars(ScalarValues::F64(broken))),
            (
                "height",
                scalars(ScalarValues::F64(positions.iter().map(|p| p[0]).collect())),
            ),
            ("huge", scalars(ScalarValues::F64(huge.collect()))),
            (
                "infinite",
                scalars(ScalarValues::F32(vec![f32::INFINITY; count])),
            ),
        ]
    };
    let filled = filled_with(columns, Method::FairC1);
    let (rim, new) = filled.rim_and_new("broken");
    assert!(rim.iter().any(|v| v.is_nan()));
    assert!(new.iter().all(|&v| v.is_nan() || v == 1.0));
    let (_, new) = filled.rim_and_new("infinite");
    assert!(new.iter().all(|&v| v == f64::INFINITY));
    let (_, new) = filled.rim_and_new("huge");
    assert!(new.iter().all(|v| v.is_finite()));
    let (_, new) = filled.rim_and_new("height");
    let smooth = new.iter().zip(filled.new_points());
    assert!(smooth.clone().all(|(v, p)| (v - p.x).abs() < 0.15));
}
