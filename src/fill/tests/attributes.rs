//! What the new vertices and triangles get for attributes.

use super::{Filled, METHODS, fill_mesh, with_method};
use crate::boundary::select::Selection;
use crate::fill::method::Method;
use crate::fixtures;
use crate::mesh::attributes::{AttributeValues, Attributes, ListValues, ScalarType, ScalarValues};
use crate::mesh::trimesh::TriMesh;

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
    let filled = fill_mesh(mesh.unwrap(), &Selection::default(), &with_method(method));
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

#[test]
fn floating_point_columns_and_colors_stay_in_the_range_of_the_rim() {
    let columns = |positions: &[[f64; 3]]| -> Columns {
        let of = |f: fn(&[f64; 3]) -> f64| positions.iter().map(f).collect::<Vec<f64>>();
        let byte = |f: fn(&[f64; 3]) -> f64| {
            let to_byte = |p: &[f64; 3]| (127.5 + 127.5 * f(p)).round() as u8;
            positions.iter().map(to_byte).collect::<Vec<u8>>()
        };
        let narrow = |values: Vec<f64>| values.iter().map(|&v| v as f32).collect();
        vec![
            ("heat", scalars(ScalarValues::F64(of(|p| 1e6 + p[0])))),
            ("quality", scalars(ScalarValues::F32(narrow(of(|p| p[1]))))),
            ("same", scalars(ScalarValues::F64(of(|_| 0.1)))),
            ("same32", scalars(ScalarValues::F32(narrow(of(|_| 0.1))))),
            ("red", scalars(ScalarValues::U8(byte(|p| p[0])))),
            ("green", scalars(ScalarValues::U8(byte(|_| 1.0)))),
            ("blue", scalars(ScalarValues::U8(byte(|p| -p[1])))),
        ]
    };
    for method in [Method::Membrane, Method::FairC1, Method::FairC2] {
        let filled = filled_with(columns, method);
        for name in ["heat", "quality", "same", "same32", "red", "green", "blue"] {
            let (rim, new) = filled.rim_and_new(name);
            let ((low, high), (new_low, new_high)) = (range(&rim), range(&new));
            assert!(
                new.len() > 20 && low <= new_low && new_high <= high,
                "{name}"
            );
            if high > low {
                assert!(new_high - new_low > 0.3 * (high - low), "{name} varies");
            }
        }
        // Smooth: a new vertex has about the value of its place.
        let (_, heat) = filled.rim_and_new("heat");
        for (value, p) in heat.iter().zip(filled.new_points()) {
            assert!((value - 1e6 - p.x).abs() < 0.15, "{value} at {p}");
        }
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
        let normal = crate::math::Vec3::new(normals[0][i], normals[1][i], normals[2][i]);
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
