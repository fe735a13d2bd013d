//! What every function does when it is used as it should be.

use super::*;
use crate::boundary::select::Selection;
use crate::fill::session::{FillSession, Target};
use crate::mesh::trimesh::TriMesh;
use crate::options::FillOptions;

#[test]
fn a_fill_through_c_gives_the_bits_of_a_fill_through_rust() {
    let arrays = holed();
    for (method, name) in [(c"flat", "flat"), (c"fair-c2", "fair-c2")] {
        let mesh = mesh_of(&arrays);
        assert_eq!(fill_all(mesh.0, &with_method(method)), OK);
        let rust = TriMesh::new(arrays.positions.clone(), arrays.triangles.clone()).unwrap();
        let mut session = FillSession::new(rust);
        let options = FillOptions {
            method: name.parse().unwrap(),
            threads: 1,
            ..FillOptions::default()
        };
        let selection = Selection::default();
        session
            .fill(Target::Selected(&selection), &options, None)
            .unwrap();
        assert_eq!(positions(mesh.0), session.mesh().positions());
        assert_eq!(triangles(mesh.0), session.mesh().triangles());
    }
}

/// Rows from an odd address on, with seven bytes between them, and what C is told of them.
fn apart<T: Numbers + bytemuck::Pod>(given: &[[T; 3]]) -> (Vec<u8>, HolefillInput) {
    let mut bytes = vec![0xAA_u8];
    for row in given {
        bytes.extend_from_slice(bytemuck::cast_slice(row));
        bytes.extend_from_slice(&[0xAA; 7]);
    }
    let view = HolefillInput {
        data: bytes[1..].as_ptr().cast(),
        stride: size_of::<[T; 3]>() as u64 + 7,
        ..rows(given)
    };
    (bytes, view)
}

/// Triangles with indices of another type.
fn converted<T: TryFrom<u32>>(triangles: &[[u32; 3]]) -> Vec<[T; 3]> {
    let index = |v| T::try_from(v).unwrap_or_else(|_| panic!("{v} is too large"));
    triangles.iter().map(|t| t.map(index)).collect()
}

#[test]
fn arrays_of_every_type_and_stride_make_the_same_mesh() {
    let arrays = holed();
    let expected = mesh_of(&arrays);
    let signed = converted::<i32>(&arrays.triangles);
    let (_points, points) = apart(&arrays.positions);
    for (_faces, faces) in [
        apart(&converted::<u64>(&arrays.triangles)),
        apart(&converted::<i64>(&arrays.triangles)),
        apart(&arrays.triangles),
        apart(&signed),
        (Vec::new(), rows(&signed)),
    ] {
        let mut mesh = Owned(HolefillMesh::default());
        ok!(holefill_mesh_from_arrays: &points, &faces, &mut mesh.0);
        assert_eq!(digest(mesh.0), digest(expected.0));
    }
    // Single precision is widened exactly.
    let singles = arrays.positions.iter().map(|p| p.map(|c| c as f32));
    let singles: Vec<[f32; 3]> = singles.collect();
    let mut mesh = Owned(HolefillMesh::default());
    let (points, faces) = (rows(&singles), rows(&arrays.triangles));
    ok!(holefill_mesh_from_arrays: &points, &faces, &mut mesh.0);
    let widened: Vec<[f64; 3]> = singles.iter().map(|p| p.map(f64::from)).collect();
    assert_eq!(positions(mesh.0), widened);
}

#[test]
fn outputs_go_where_they_should_and_nowhere_else() {
    let arrays = holed();
    let mesh = mesh_of(&arrays);
    let (expected, view) = apart(&arrays.positions[2..6]);
    let mut bytes = vec![0xAA_u8; expected.len()];
    let output = HolefillOutput {
        data: bytes[1..].as_mut_ptr().cast(),
        count: view.count,
        stride: view.stride,
        scalar_type: view.scalar_type,
        reserved: 0,
    };
    ok!(holefill_mesh_read_positions: mesh.0, 2, &output);
    assert_eq!(bytes, expected);
    let next = &arrays.triangles[1..3];
    let faces = |to: &HolefillOutput| call!(holefill_mesh_read_triangles: mesh.0, 1, to);
    assert_eq!(read(2, [0_u64; 3], faces), converted::<u64>(next));
    assert_eq!(read(2, [0_i64; 3], faces), converted::<i64>(next));
    assert_eq!(read(2, [0_i32; 3], faces), converted::<i32>(next));
    let points = |to: &HolefillOutput| call!(holefill_mesh_read_positions: mesh.0, 1, to);
    let expected = [1, 2].map(|i| arrays.positions[i].map(|c| c as f32));
    assert_eq!(read(2, [0_f32; 3], points), expected);
}

#[test]
fn a_loop_is_the_same_by_id_by_edge_and_by_vertices() {
    let mut digests = Vec::new();
    for way in 0..5 {
        let mesh = holed_mesh();
        let mut chain = loop_vertices(mesh.0, 1);
        let (from, to) = (chain[3], chain[4]);
        chain.rotate_left(5);
        if way == 3 {
            chain.reverse();
        }
        let view = rows(&chain);
        let ids = rows(&[1_i64]);
        let target = match way {
            0 => at_loop(1),
            1 => at_edge([from, to]),
            2 | 3 => at_ids(HOLEFILL_TARGET_VERTICES, &view),
            _ => at_ids(HOLEFILL_TARGET_LOOPS, &ids),
        };
        assert_eq!(found(mesh.0, &target), Ok(vec![1]));
        assert_eq!(fill(mesh.0, &target, &options()), OK);
        assert_eq!(loop_info(mesh.0, 1).is_open, 0);
        assert_eq!(loop_info(mesh.0, 0).is_open, 1);
        digests.push(digest(mesh.0));
    }
    assert!(digests.windows(2).all(|w| w[0] == w[1]));
}

#[test]
fn a_chain_through_two_loops_that_touch_finds_both() {
    let mesh = mesh_of(&fixtures::touching_holes(3));
    let touching: Vec<u64> = (0..loop_count(mesh.0))
        .filter(|&id| loop_info(mesh.0, id).loop_class == HOLEFILL_CLASS_TOUCHING)
        .collect();
    let [a, b] = touching[..] else {
        panic!("{touching:?}");
    };
    let (mut first, mut second) = (loop_vertices(mesh.0, a), loop_vertices(mesh.0, b));
    let shared = first.iter().position(|v| second.contains(v)).unwrap();
    first.rotate_left(shared);
    let place_in_second = second.iter().position(|v| *v == first[0]).unwrap();
    second.rotate_left(place_in_second);
    let eight: Vec<u64> = [first, second].concat();
    let view = rows(&eight);
    let target = at_ids(HOLEFILL_TARGET_VERTICES, &view);
    let (mut ids, mut count) = ([u64::MAX; 2], 0);
    let place = ids.as_mut_ptr();
    let status = call!(holefill_mesh_find_loops: mesh.0, &target, place, 1, &mut count);
    assert_eq!((status, count), (TOO_SMALL, 2));
    assert_eq!(ids[0], u64::MAX);
    ok!(holefill_mesh_find_loops: mesh.0, &target, place, 2, &mut count);
    assert_eq!(ids, [a, b]);
    // Not all of it is not a loop.
    let view = rows(&eight[..eight.len() - 1]);
    assert_eq!(
        found(mesh.0, &at_ids(HOLEFILL_TARGET_VERTICES, &view)),
        Err(NOT_FOUND)
    );
}

#[test]
fn a_plan_is_what_a_fill_would_do_and_changes_nothing() {
    let planned = holed_mesh();
    let before = digest(planned.0);
    let plan = plan_loop(planned.0, 0, &options());
    assert_eq!(digest(planned.0), before);
    let (points, faces) = patch(&plan, 0);
    let filled = holed_mesh();
    fill_loop(filled.0, 0, &options());
    let count = info(planned.0);
    assert_eq!(positions(filled.0)[count.vertex_count as usize..], points);
    assert_eq!(triangles(filled.0)[count.triangle_count as usize..], faces);
    assert_eq!(apply(&plan, planned.0), OK);
    assert_eq!(digest(planned.0), digest(filled.0));
    // A second time the rim is closed.
    assert_eq!(apply(&plan, planned.0), INCOMPLETE);
    assert_eq!(digest(planned.0), digest(filled.0));
}

#[test]
fn plans_of_several_loops_number_their_patches_one_after_the_other() {
    let mesh = holed_mesh();
    let (mut plan, mut report) = (
        Owned(HolefillPlan::default()),
        Owned(HolefillReport::default()),
    );
    let mut infos = [HolefillPatchInfo::default(); 2];
    ok!(holefill_mesh_plan: mesh.0, ptr::null(), &options(), &mut plan.0);
    for id in 0..2 {
        call!(holefill_plan_patch: plan.0, id, &mut infos[id as usize]);
    }
    call!(holefill_plan_report: plan.0, &mut report.0);
    assert_eq!(infos[0].first_vertex, info(mesh.0).vertex_count);
    assert_eq!(
        infos[1].first_vertex,
        infos[0].first_vertex + infos[0].vertex_count
    );
    let hole = hole(&report, 1);
    assert_eq!(
        (hole.status, hole.first_vertex),
        (HOLEFILL_HOLE_FILLED, infos[1].first_vertex)
    );
    assert_eq!(apply(&plan, mesh.0), OK);
    let filled = holed_mesh();
    fill_all(filled.0, &options());
    assert_eq!(digest(filled.0), digest(mesh.0));
}

#[test]
fn undo_brings_back_every_state_in_turn() {
    let mesh = holed_mesh();
    let mut states = vec![digest(mesh.0)];
    for id in [1, 0] {
        assert_eq!(fill_loop(mesh.0, id, &options()), OK);
        states.push(digest(mesh.0));
    }
    let filled = states.pop().unwrap();
    for state in states.iter().rev() {
        assert_eq!(undo(mesh.0), OK);
        assert_eq!(digest(mesh.0), *state);
    }
    assert_eq!(undo(mesh.0), NOTHING_TO_UNDO);
    for id in [1, 0] {
        assert_eq!(fill_loop(mesh.0, id, &options()), OK);
    }
    assert_eq!(digest(mesh.0), filled);
}

#[test]
fn a_report_says_what_happened_to_each_hole() {
    let mesh = holed_mesh();
    let rules = HolefillSelection {
        keep_largest: 1,
        ..Default::default()
    };
    let (status, report) = report_of(mesh.0, &selected(&rules), &with_method(c"fair-c1"));
    assert_eq!(status, OK);
    let holes = [hole(&report, 0), hole(&report, 1)];
    let (kept, filled) = match holes[0].status {
        HOLEFILL_HOLE_KEPT => (holes[0], holes[1]),
        _ => (holes[1], holes[0]),
    };
    assert_eq!(kept.status, HOLEFILL_HOLE_KEPT);
    assert!(kept.perimeter >= filled.perimeter && kept.method.is_null());
    assert_eq!(filled.status, HOLEFILL_HOLE_FILLED);
    assert_eq!(static_text(filled.method), Some("fair-c1"));
    let size = info(mesh.0);
    assert_eq!(filled.first_vertex, size.input_vertex_count);
    assert_eq!(filled.first_vertex + filled.vertex_count, size.vertex_count);
    assert_eq!(
        filled.first_triangle + filled.triangle_count,
        size.triangle_count
    );
    let summary: HolefillSummary = got!(holefill_report_summary: report.0);
    assert_eq!(
        (summary.hole_count, summary.filled, summary.kept),
        (2, 1, 1)
    );
    assert_eq!(summary.new_triangles, filled.triangle_count);
    let reason = reason(&report, kept.loop_id);
    assert!(reason.contains("largest"), "{reason}");
}

#[test]
fn methods_that_were_tried_are_listed_with_reasons() {
    let mesh = holed_mesh();
    let parameters = parameters(c"refine.max-vertices", c"0");
    let options = HolefillFillOptions {
        parameters: parameters.0,
        ..with_method(c"fair-c1")
    };
    let (status, report) = report_of(mesh.0, &at_loop(0), &options);
    assert_eq!(status, OK);
    let hole = hole(&report, 0);
    assert_eq!(static_text(hole.method), Some("flat"));
    assert!(hole.tried_count >= 1);
    let mut method: *const c_char = ptr::null();
    let place = &raw mut method;
    let reason = told!(holefill_report_tried: report.0, 0, 0, place);
    assert_eq!(static_text(method), Some("fair-c1"));
    assert!(!reason.is_empty());
}

#[test]
fn a_report_is_also_one_text_with_what_was_predicted() {
    let edge = |[x, y, z]: fixtures::Point| (x - 1.0).hypot(y - 1.0).hypot(z) < 0.5;
    let cube = fixtures::cube(12).cut(edge);
    let mut has_scores = false;
    for (arrays, method) in [(holed(), c"auto"), (cube, c"auto"), (holed(), c"fair-c1")] {
        let mesh = mesh_of(&arrays);
        let (status, report) = report_of(mesh.0, &every_loop(), &with_method(method));
        assert_eq!(status, OK);
        let json = told!(holefill_report_json: report.0);
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let holes = json["holes"].as_array().unwrap();
        assert_eq!(holes.len() as u64, loop_count(mesh.0));
        for (i, told) in (0..).zip(holes) {
            let hole = hole(&report, i);
            assert_eq!(told["id"], hole.loop_id);
            assert_eq!(told["method"].as_str(), static_text(hole.method));
            assert_eq!(told["new_triangles"], hole.triangle_count);
            let mut found = HolefillPrediction::default();
            let status = call!(holefill_report_prediction: report.0, i, &mut found);
            let told = &told["prediction"];
            if told.is_null() {
                assert_eq!(status, NOT_FOUND);
                continue;
            }
            assert_eq!(status, OK);
            assert_eq!(told["chosen"].as_str(), static_text(found.chosen));
            assert_eq!(told["noise"], found.noise);
            assert_eq!(told["is_tip"], found.is_tip == 1);
            assert_eq!(told["is_flat"], found.is_flat == 1);
            assert_eq!(told["creases"], found.crease_count);
            let length = |list: &serde_json::Value| list.as_array().map_or(0, Vec::len) as u64;
            assert_eq!(length(&told["crease_surfaces"]), found.crease_surface_count);
            let scores = told["scores"].as_object().unwrap();
            assert_eq!(scores.len() as u64, found.score_count);
            has_scores |= scores.contains_key(static_text(found.chosen).unwrap());
        }
    }
    assert!(has_scores);
}

#[test]
fn every_open_loop_is_the_default_target() {
    let [all, null] = [holed_mesh(), holed_mesh()];
    ok!(holefill_mesh_fill_all: all.0);
    ok!(holefill_mesh_fill: null.0, ptr::null(), ptr::null(), ptr::null_mut());
    assert_eq!(digest(all.0), digest(null.0));
    assert!((0..loop_count(all.0)).all(|id| loop_info(all.0, id).is_open == 0));
}

#[test]
fn fields_of_the_options_and_parameters_do_the_same() {
    let with_field = holed_mesh();
    let coarse = HolefillFillOptions {
        density: 2.0,
        ..options()
    };
    fill_loop(with_field.0, 0, &coarse);
    let with_name = holed_mesh();
    let parameters = parameters(c"refine.density", c"2");
    let named = HolefillFillOptions {
        parameters: parameters.0,
        ..options()
    };
    fill_loop(with_name.0, 0, &named);
    assert_eq!(digest(with_field.0), digest(with_name.0));
    let plain = holed_mesh();
    fill_loop(plain.0, 0, &options());
    assert_ne!(digest(plain.0), digest(with_name.0));
}

#[test]
fn attributes_go_in_come_out_and_are_continued() {
    let arrays = holed();
    let mesh = mesh_of(&arrays);
    let (vertices, faces) = (arrays.positions.len(), arrays.triangles.len());
    let heights: Vec<f32> = arrays.positions.iter().map(|p| p[2] as f32).collect();
    let colors: Vec<[u8; 3]> = (0..vertices).map(|i| [(i % 256) as u8, 10, 200]).collect();
    let labels: Vec<i16> = vec![-7; faces];
    let (vertex, triangle) = (HOLEFILL_ELEMENT_VERTEX, HOLEFILL_ELEMENT_TRIANGLE);
    let colors = rows(&colors);
    for (element, name, components, values) in [
        (vertex, c"height", 1, rows(&heights)),
        (vertex, c"color", 3, colors),
        (vertex, c"place", 3, rows(&arrays.positions)),
        (triangle, c"label", 1, rows(&labels)),
    ] {
        let name = name.as_ptr();
        let add = || call!(holefill_mesh_add_attribute: mesh.0, element, name, components, &values);
        assert_eq!(add(), OK);
        assert_eq!(add(), INVALID);
    }
    let before = digest(mesh.0);
    assert_eq!(fill_loop(mesh.0, 0, &options()), OK);
    let size = info(mesh.0);
    let mut new_labels = vec![0_i16; size.triangle_count as usize];
    let mut new_colors = vec![[0_u8; 3]; size.vertex_count as usize];
    let mut as_numbers = vec![[0_f64; 3]; size.vertex_count as usize];
    let mut places = vec![[0_f64; 3]; size.vertex_count as usize];
    let as_signed = HolefillOutput {
        scalar_type: HOLEFILL_TYPE_I8,
        ..place(&mut new_colors)
    };
    let [ok, refused] = [OK, INVALID];
    for (element, index, output, expected) in [
        (triangle, 0, place(&mut new_labels), ok),
        (vertex, 1, place(&mut new_colors), ok),
        (vertex, 1, place(&mut as_numbers), ok),
        (vertex, 2, place(&mut places), ok),
        (vertex, 1, as_signed, refused),
    ] {
        let status = call!(holefill_mesh_read_attribute: mesh.0, element, index, 0, &output);
        assert_eq!(status, expected);
    }
    assert!(new_labels.iter().all(|&l| l == -7));
    assert!(
        new_colors[vertices..]
            .iter()
            .all(|c| c[1] == 10 && c[2] == 200)
    );
    assert_eq!(as_numbers[vertices], new_colors[vertices].map(f64::from));
    assert_eq!(places[..vertices], arrays.positions);
    assert!(
        places[vertices..]
            .iter()
            .flatten()
            .all(|c| c.abs() <= 1.0 + 1e-9)
    );
    let name = told!(holefill_mesh_attribute_name: mesh.0, HOLEFILL_ELEMENT_VERTEX, 1);
    assert_eq!(name, "color");
    assert_eq!(undo(mesh.0), OK);
    assert_eq!(digest(mesh.0), before);
}

#[test]
fn the_log_speaks_only_when_it_is_asked_and_only_as_loud() {
    unsafe extern "C" fn log(level: HolefillLogLevel, message: *const c_char, data: *mut c_void) {
        // SAFETY: the test hands its list over.
        let lines = unsafe { &mut *data.cast::<Vec<(HolefillLogLevel, String)>>() };
        // SAFETY: the library's text ends with a zero byte.
        let text = unsafe { CStr::from_ptr(message) };
        lines.push((level, text.to_str().unwrap().to_owned()));
    }
    for (limit, expected) in [(HOLEFILL_LOG_WARNING, 0), (HOLEFILL_LOG_INFO, 2), (0, 2)] {
        let mesh = holed_mesh();
        let mut lines: Vec<(HolefillLogLevel, String)> = Vec::new();
        let options = HolefillFillOptions {
            log: Some(log),
            log_data: (&raw mut lines).cast(),
            log_level: limit,
            ..with_method(c"fair-c1")
        };
        fill_all(mesh.0, &options);
        assert_eq!(lines.len(), expected, "{lines:?}");
        assert!(lines.iter().all(|(level, _)| *level == HOLEFILL_LOG_INFO));
    }
}

#[test]
fn irregularities_are_counted() {
    let mesh = mesh_of(&fixtures::sheet_with_hole().with_vertex([9.0, 9.0, 9.0]));
    let mut defects = HolefillDefects::default();
    let status = call!(holefill_mesh_defects: mesh.0, &mut defects);
    assert_eq!((status, defects.isolated_vertices), (OK, 1));
}

#[test]
fn versions_and_statuses_have_texts() {
    assert_eq!(holefill_abi_version(), HOLEFILL_ABI_VERSION);
    assert_eq!(
        static_text(holefill_version()),
        Some(env!("CARGO_PKG_VERSION"))
    );
    for (k, &(status, ..)) in status::STATUSES.iter().enumerate() {
        assert_eq!(status, k as i32, "numbers are given one after the other");
        assert!(
            !static_text(holefill_status_name(status))
                .unwrap()
                .is_empty()
        );
        assert!(
            !static_text(holefill_status_message(status))
                .unwrap()
                .is_empty()
        );
    }
    assert_eq!(static_text(holefill_status_name(-1)), Some("UNKNOWN"));
}
