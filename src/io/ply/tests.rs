use super::*;
use crate::error::ErrorKind;

const ENCODINGS: [PlyEncoding; 3] = PlyEncoding::ALL;

/// A file of each kind of property, in text: the corner list and the position come second.
const RICH: &str = "\
ply
format ascii 1.0
comment made by hand
obj_info id  7
comment second
element vertex 4
property char a
property float32 x
property float y
property float z
property uint8 red
property list ushort double weights
property uint id
element face 2
property short flag
property list uchar uint vertex_index
property list uint8 float texcoord
element edge 1
property int vertex1
property int vertex2
property double length
element empty 0
property int nothing
end_header
-128 0.1 -0.0 1e-42 255 2 0.1 -1e300 4294967295
127 1 0 0 0 0 0
0 NaN inf -inf 7 1 5 1
1 3.4028235e38 16777217 0.3 8 0 2
-32768 3 0 1 2 6 0 0.1 0.2 0.3 0.4 0.5
32767 3 2 1 3 0
0 3 2.5
";

fn round_trip(mesh: &MeshData) -> MeshData {
    check(mesh).unwrap();
    let mut bytes = Vec::new();
    write(mesh, &mut bytes).unwrap();
    parse(&bytes).unwrap()
}

fn bits(mesh: &MeshData) -> Vec<[u64; 3]> {
    mesh.positions.iter().map(|p| p.map(f64::to_bits)).collect()
}

#[test]
fn everything_survives_in_every_encoding() {
    let original = parse(RICH.as_bytes()).unwrap();
    assert!(original.notes.is_empty(), "{:?}", original.notes);
    assert_eq!(original.position_type, ScalarType::F32);
    assert_eq!(
        original.positions[0],
        [f64::from(0.1f32), 0.0, f64::from(1e-42f32)]
    );
    assert_eq!(original.triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(original.ply.remarks.len(), 3);
    for encoding in ENCODINGS {
        let mut mesh = original.clone();
        mesh.ply.encoding = encoding;
        for precision in [ScalarType::F32, ScalarType::F64] {
            mesh.position_type = precision;
            let again = round_trip(&mesh);
            assert_eq!(bits(&again), bits(&original));
            assert_eq!(again.position_type, precision);
            assert_eq!(again.triangles, original.triangles);
            assert_eq!(again.vertex_attributes, original.vertex_attributes);
            assert_eq!(again.face_attributes, original.face_attributes);
            assert_eq!(again.ply, mesh.ply);
        }
    }
}

#[test]
fn a_written_header_declares_what_the_original_did() {
    let mut bytes = Vec::new();
    write(&parse(RICH.as_bytes()).unwrap(), &mut bytes).unwrap();
    let header = |bytes: &[u8]| {
        let text = String::from_utf8(bytes.to_vec()).unwrap();
        let header = text.split("end_header").next().unwrap().to_owned();
        header.replace("float32", "float").replace("uint8", "uchar")
    };
    assert_eq!(header(&bytes), header(RICH.as_bytes()));
}

/// A file with one triangle list of the given types; corners as they are in binary.
fn binary_faces(types: &str, count: usize, body: &[u8]) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement face {count}\n\
         property list {types} vertex_indices\nproperty uchar mark\n\
         element vertex 5\nproperty uchar x\nproperty uchar y\nproperty uchar z\nend_header\n"
    )
    .into_bytes();
    bytes.extend(body);
    bytes.extend([0; 15]);
    bytes
}

#[test]
fn polygons_in_binary_are_cut_and_repeat_their_attributes() {
    let body = [
        3, 0, 1, 2, 10, 5, 0, 1, 2, 3, 4, 11, 2, 0, 1, 12, 3, 2, 3, 4, 13,
    ];
    let mesh = parse(&binary_faces("char uchar", 4, &body)).unwrap();
    assert_eq!(
        mesh.triangles,
        [[0, 1, 2], [0, 1, 2], [0, 2, 3], [0, 3, 4], [2, 3, 4]]
    );
    let marks = AttributeValues::Scalars(ScalarValues::U8(vec![10, 11, 11, 11, 13]));
    assert_eq!(mesh.face_attributes.get("mark"), Some(&marks));
    assert_eq!(mesh.position_type, ScalarType::F64);
    assert_eq!(mesh.notes.len(), 3, "{:?}", mesh.notes);
    assert_eq!(round_trip(&mesh).triangles, mesh.triangles);
}

#[test]
fn quads_in_rows_of_one_size_are_cut() {
    let body = [4, 0, 1, 2, 3, 10, 4, 1, 2, 3, 4, 11];
    let mesh = parse(&binary_faces("uchar char", 2, &body)).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [1, 2, 3], [1, 3, 4]]);
}

#[test]
fn a_bad_face_in_binary_is_an_error_at_its_byte() {
    let cases: [(&str, usize, &[u8], &str); 5] = [
        (
            "uchar uchar",
            2,
            &[3, 0, 1, 2, 9, 3, 0, 1, 5, 9],
            "face 1 has the vertex index 5",
        ),
        (
            "uchar char",
            2,
            &[3, 0, 1, 2, 9, 3, 0, 255, 1, 9],
            "face 1 has the vertex index -1",
        ),
        (
            "char uchar",
            2,
            &[3, 0, 1, 2, 9, 255, 0, 1, 1, 9],
            "list vertex_indices of face 1 has",
        ),
        (
            "uchar uchar",
            2,
            &[3, 0, 1, 2, 9, 90, 0, 1, 1, 9],
            "the file ends within face 1 of 2",
        ),
        (
            "uint float",
            1,
            &[0; 5],
            "vertex_indices of face needs an integer type",
        ),
    ];
    for (types, count, body, expected) in cases {
        let bytes = binary_faces(types, count, body);
        let error = parse(&bytes).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Parse);
        assert!(error.message().contains(expected), "{error}");
        if count == 2 {
            let at = bytes.len() - 15 - 5;
            assert!(
                error.message().starts_with(&format!("byte {at}: ")),
                "{error}"
            );
        }
    }
}

fn text_file(vertex_count: &str, face_count: &str, body: &str) -> String {
    format!(
        "ply\nformat ascii 1.0\nelement vertex {vertex_count}\nproperty double x\n\
         property double y\nproperty double z\nelement face {face_count}\n\
         property list uchar int vertex_indices\nend_header\n{body}"
    )
}

#[test]
fn a_bad_row_in_text_is_an_error_at_its_line() {
    let cases = [
        (
            "1",
            "0",
            "0 0\n0 0 0\n",
            "line 10: property z has too few values",
        ),
        (
            "1",
            "0",
            "0 0 0 0\n",
            "line 10: vertex 0 has more than its 3",
        ),
        (
            "1",
            "0",
            "0 0 zero\n",
            "line 10: property z (double) cannot be \"zero\"",
        ),
        (
            "2",
            "0",
            "0 0 0\n0 00000\n",
            "line 11: property z has too few",
        ),
        (
            "2",
            "0",
            "0 0 0\n      \n",
            "the file ends after line 11: vertex 1 of 2 is missing",
        ),
        (
            "1",
            "1",
            "0 0 0\n\n3 0 0 1\n",
            "line 12: face 0 has the vertex index 1",
        ),
        (
            "1",
            "1",
            "0 0 0\n3 0 0 -1\n",
            "line 11: face 0 has the vertex index -1",
        ),
        (
            "1",
            "1",
            "0 0 0\n3 0 0\n",
            "line 11: property vertex_indices has too few",
        ),
        ("1", "1", "0 0 0\n3 0 0 0 0\n", "line 11: face 0 has more"),
        (
            "1",
            "1",
            "0 0 0\n-3 0 0 0\n",
            "line 11: the length of a list cannot be",
        ),
        (
            "1",
            "1",
            "0 0 0\n4294967295 0 0 0\n",
            "line 11: property vertex_indices has too few",
        ),
        (
            "1",
            "1",
            "0 0 0\n3 0 0 0\n3 0 0 0\n",
            "line 12: more rows than the header promises",
        ),
        (
            "9999999999999999999",
            "1",
            "0 0 0\n",
            "byte 187: the header promises",
        ),
        (
            "1",
            "999999999999",
            "0 0 0\n3 0 0 0\n",
            "byte 187: the header promises",
        ),
    ];
    for (vertices, faces, body, start) in cases {
        let error = parse(text_file(vertices, faces, body).as_bytes()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Parse);
        let start = start.strip_prefix("byte 187: ").unwrap_or(start);
        assert!(error.message().contains(start), "{body:?} gives {error}");
    }
}

#[test]
fn a_file_without_positions_or_corners_is_an_error() {
    let text = text_file("1", "1", "0 0 0\n3 0 0 0\n");
    for (from, to) in [
        ("double x", "double X"),
        ("double z", "list uchar double z"),
        ("element vertex", "element Vertex"),
        ("list uchar int vertex_indices", "int vertex_indices"),
    ] {
        let error = parse(text.replace(from, to).as_bytes()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Parse, "{from}");
    }
}

#[test]
fn points_without_faces_are_read() {
    let text = "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty float y\n\
                property double z\nend_header\n1 2 3";
    let mesh = parse(text.as_bytes()).unwrap();
    assert_eq!(
        (mesh.positions.as_slice(), mesh.triangles.len()),
        ([[1.0, 2.0, 3.0]].as_slice(), 0)
    );
    assert_eq!(mesh.position_type, ScalarType::F64);
    assert!(
        parse(text_file("0", "0", "").as_bytes())
            .unwrap()
            .positions
            .is_empty()
    );
}

#[test]
fn strips_are_read_when_there_are_no_faces() {
    let text = text_file("4", "1", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n6 0 1 2 3 -1 0\n");
    let mesh = parse(text.replace("element face", "element tristrips").as_bytes()).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(mesh.notes.len(), 1);
    assert!(mesh.ply.elements.is_empty());
}

#[test]
fn properties_named_like_others_are_kept() {
    let text = text_file("1", "1", "0 0 0 7\n3 0 0 0 1 5 9\n")
        .replace("double z\n", "double z\nproperty int vertex_indices\n")
        .replace(
            "vertex_indices\nend_header",
            "vertex_indices\nproperty list uchar int vertex_index\nproperty int x\nend_header",
        );
    let mesh = parse(text.as_bytes()).unwrap();
    for mesh in [&mesh, &round_trip(&mesh)] {
        let names = |attributes: &Attributes| -> Vec<String> {
            attributes
                .iter()
                .map(|column| column.name.clone())
                .collect()
        };
        assert_eq!(names(&mesh.vertex_attributes), ["vertex_indices"]);
        assert_eq!(names(&mesh.face_attributes), ["vertex_index", "x"]);
        assert_eq!(mesh.triangles, [[0, 0, 0]]);
    }
}

#[test]
fn a_small_index_type_grows_with_the_mesh() {
    let mut mesh = parse(&binary_faces("uchar uchar", 1, &[3, 0, 1, 2, 9])).unwrap();
    mesh.positions.resize(300, [0.0; 3]);
    mesh.vertex_attributes = Attributes::new(300);
    mesh.triangles[0][2] = 299;
    assert_eq!(round_trip(&mesh).triangles, mesh.triangles);
}

#[test]
fn a_polygon_that_would_repeat_its_list_too_often_is_refused() {
    let n = 20_000;
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\n\
         property uchar y\nproperty uchar z\nelement face 1\n\
         property list ushort uchar vertex_indices\nproperty list ushort uchar big\nend_header\n";
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend([0; 3]);
    for _ in 0..2 {
        bytes.extend((n as u16).to_le_bytes());
        bytes.extend(vec![0; n]);
    }
    let error = parse(&bytes).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Parse);
    assert!(error.message().contains("repeat more than"), "{error}");
}
