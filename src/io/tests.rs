use super::*;
use crate::mesh::attributes::ScalarValues;
use crate::mesh::attributes::{AttributeValues, ScalarType};
use proptest::prelude::*;
use std::fs;

const FORMATS: [(Format, &str); 4] = [
    (Format::Ply, "ply"),
    (Format::Obj, "obj"),
    (Format::Off, "off"),
    (Format::Stl, "stl"),
];

/// A tetrahedron without one face, with coordinates that need all their digits.
fn sample() -> MeshData {
    let positions = vec![
        [0.1, -0.0, 1e-300],
        [1.0 / 3.0, 1e22, 0.0],
        [-2.0, 5e-324, 7.0],
        [0.0, 0.0, 0.1 + 0.2],
    ];
    MeshData::new(positions, vec![[0, 1, 2], [0, 3, 1], [3, 2, 1]])
}

fn add_colors(mesh: &mut MeshData, channel: impl Fn(u8) -> ScalarValues) {
    for (name, value) in [("red", 255), ("green", 0), ("blue", 3)] {
        let values = AttributeValues::Scalars(channel(value));
        mesh.vertex_attributes.push(name, values).unwrap();
    }
}

fn bits(mesh: &MeshData) -> Vec<[u64; 3]> {
    mesh.positions.iter().map(|p| p.map(f64::to_bits)).collect()
}

fn written(mesh: &MeshData, extension: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(format!("a.{extension}"));
    write(&path, mesh).unwrap();
    fs::read(path).unwrap()
}

#[test]
fn text_and_binary_formats_keep_every_bit_of_the_positions() {
    let folder = tempfile::tempdir().unwrap();
    for extension in ["ply", "OBJ", "Off"] {
        let path = folder.path().join(format!("mesh.{extension}"));
        assert!(write(&path, &sample()).unwrap().is_empty());
        let again = read(&path).unwrap();
        assert_eq!(bits(&again), bits(&sample()), "{extension}");
        assert_eq!(again.triangles, sample().triangles);
        assert_eq!(again.position_type, ScalarType::F64);
        assert!(again.notes.is_empty());
    }
}

#[test]
fn colors_survive_where_the_format_has_them() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = |value: u8| ScalarValues::U8(vec![value; 4]);
    let fractions = |value: u8| ScalarValues::F32(vec![f32::from(value) / 255.0; 4]);
    for extension in ["ply", "obj", "off"] {
        let path = folder.path().join(format!("mesh.{extension}"));
        let (mut in_bytes, mut in_fractions) = (sample(), sample());
        add_colors(&mut in_bytes, bytes);
        add_colors(&mut in_fractions, fractions);
        write(&path, &in_fractions).unwrap();
        let again = read(&path).unwrap();
        assert_eq!(
            again.vertex_attributes, in_fractions.vertex_attributes,
            "{extension}"
        );
        write(&path, &in_bytes).unwrap();
        let again = read(&path).unwrap();
        let expected = if extension == "obj" {
            &in_fractions
        } else {
            &in_bytes
        };
        assert_eq!(
            again.vertex_attributes, expected.vertex_attributes,
            "{extension}"
        );
    }
}

#[test]
fn stl_keeps_the_triangles_of_single_precision_positions() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.stl");
    let mut mesh = sample();
    mesh.positions = vec![
        [0.5, -0.0, 1.0],
        [1.0, 1e22, 0.0],
        [-2.0, 0.0, 7.0],
        [0.0, 0.0, 0.1],
    ];
    mesh.positions
        .iter_mut()
        .flatten()
        .for_each(|x| *x = f64::from(*x as f32));
    assert!(write(&path, &mesh).unwrap().is_empty());
    let again = read(&path).unwrap();
    let corners = |mesh: &MeshData| -> Vec<_> {
        mesh.triangles
            .iter()
            .map(|t| t.map(|v| bits(mesh)[v as usize]))
            .collect()
    };
    assert_eq!(corners(&again), corners(&mesh));
    assert_eq!(again.positions.len(), 4);
}

#[test]
fn what_a_format_cannot_hold_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let mut mesh = sample();
    add_colors(&mut mesh, |value| ScalarValues::U8(vec![value; 4]));
    let heat = AttributeValues::Scalars(ScalarValues::F64(vec![0.0; 4]));
    mesh.vertex_attributes.push("heat", heat).unwrap();
    let notes = |extension: &str| write(folder.path().join(extension), &mesh).unwrap();
    assert!(notes("a.ply").is_empty());
    assert_eq!(notes("a.obj"), ["vertex attributes not written: heat"]);
    assert_eq!(notes("a.off"), ["vertex attributes not written: heat"]);
    let stl = notes("a.stl");
    assert_eq!(
        stl[0],
        "vertex attributes not written: red, green, blue, heat"
    );
    assert!(stl[1].starts_with("4 vertices rounded"), "{stl:?}");
}

#[test]
fn unknown_extensions_are_answered_with_the_known_ones() {
    for path in ["mesh.xyz", "mesh", "ply", "mesh.ply.gz"] {
        let errors = [read(path).unwrap_err(), write(path, &sample()).unwrap_err()];
        for error in errors {
            assert_eq!(error.kind(), ErrorKind::InvalidInput);
            assert!(
                error.message().contains(".ply, .obj, .off and .stl"),
                "{error}"
            );
        }
    }
}

#[test]
fn missing_and_empty_files_are_errors_with_the_path() {
    let folder = tempfile::tempdir().unwrap();
    for (_, extension) in FORMATS {
        let path = folder.path().join(format!("no.{extension}"));
        let error = read(&path).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Io);
        assert!(
            error.message().contains(&path.display().to_string()),
            "{error}"
        );
        fs::write(&path, "").unwrap();
        let error = read(&path).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Parse);
        assert_eq!(
            error.message(),
            format!("{}: the file is empty", path.display())
        );
    }
}

#[test]
fn inconsistent_meshes_are_refused_before_the_old_file_is_touched() {
    let folder = tempfile::tempdir().unwrap();
    let changes: [fn(&mut MeshData); 3] = [
        |mesh| mesh.positions.truncate(3),
        |mesh| mesh.triangles[1][2] = 4,
        |mesh| mesh.face_attributes = Attributes::new(2),
    ];
    for change in changes {
        let mut mesh = sample();
        change(&mut mesh);
        for (_, extension) in FORMATS {
            let path = folder.path().join(format!("old.{extension}"));
            fs::write(&path, "old").unwrap();
            assert_eq!(
                write(&path, &mesh).unwrap_err().kind(),
                ErrorKind::InvalidInput
            );
            assert_eq!(fs::read(&path).unwrap(), b"old");
        }
    }
}

#[test]
fn no_prefix_of_a_file_is_taken_for_the_whole() {
    for (format, extension) in FORMATS {
        let bytes = written(&sample(), extension);
        // A text file is whole without its last line break.
        let whole = if format == Format::Off {
            bytes.len() - 1
        } else {
            bytes.len()
        };
        assert!(format.parse(&bytes[..whole]).is_ok());
        for length in 0..whole {
            match format.parse(&bytes[..length]) {
                Err(error) => assert_eq!(error.kind(), ErrorKind::Parse),
                // Nothing in an OBJ file says how long it should be.
                Ok(mesh) => {
                    assert_eq!(format, Format::Obj, "{length} of {whole}");
                    mesh.check().unwrap();
                }
            }
        }
    }
}

/// Small files of every kind, to be damaged.
fn valid_files() -> Vec<(Format, Vec<u8>)> {
    let mut mesh = sample();
    add_colors(&mut mesh, |value| ScalarValues::U8(vec![value; 4]));
    let mut files: Vec<_> = FORMATS
        .iter()
        .map(|&(format, extension)| (format, written(&mesh, extension)))
        .collect();
    mesh.position_type = ScalarType::F32;
    mesh.positions
        .iter_mut()
        .flatten()
        .for_each(|x| *x = x.clamp(-9.0, 9.0));
    for encoding in [PlyEncoding::Ascii, PlyEncoding::BinaryBigEndian] {
        mesh.ply.encoding = encoding;
        files.push((Format::Ply, written(&mesh, "ply")));
    }
    let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
                endloop\nendfacet\nendsolid\n";
    files.push((Format::Stl, text.into()));
    let polygons = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty uchar x\n\
                    property uchar y\nproperty uchar z\nelement face 2\nproperty list uchar uchar \
                    vertex_indices\nproperty list uchar uchar mark\nend_header\n";
    let body = [
        0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 4, 0, 1, 2, 3, 1, 9, 3, 0, 1, 2, 2, 9, 9,
    ];
    files.push((Format::Ply, [polygons.as_bytes(), &body].concat()));
    files
}

/// Parses, and holds a success to what it promises and to memory in proportion to the file.
fn parse_safely(format: Format, bytes: &[u8]) {
    match format.parse(bytes) {
        Ok(mesh) => {
            mesh.check().unwrap();
            assert!(mesh.positions.capacity() + mesh.triangles.capacity() <= 4 * bytes.len() + 16);
        }
        Err(error) => {
            assert_eq!(error.kind(), ErrorKind::Parse);
            assert!(!error.message().is_empty() && !error.message().contains('\n'));
        }
    }
}

#[test]
fn the_files_to_be_damaged_are_valid() {
    for (format, bytes) in valid_files() {
        assert!(!format.parse(&bytes).unwrap().triangles.is_empty());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn random_bytes_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 1..300)) {
        for (format, _) in FORMATS {
            parse_safely(format, &bytes);
        }
    }

    #[test]
    fn random_bytes_after_a_valid_start_do_no_harm(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        cut in any::<prop::sample::Index>(),
    ) {
        for (format, mut file) in valid_files_cached() {
            file.truncate(cut.index(file.len()));
            file.extend(&bytes);
            parse_safely(format, &file);
        }
    }

    #[test]
    fn damaged_files_do_no_harm(
        damage in prop::collection::vec((any::<prop::sample::Index>(), 0..4, any::<u8>()), 1..8),
    ) {
        for (format, mut file) in valid_files_cached() {
            for &(place, how, byte) in &damage {
                let k = place.index(file.len());
                match how {
                    0 => file[k] = byte,
                    1 => file[k] = b"0123456789-+.e \n"[byte as usize % 16],
                    2 => drop(file.remove(k)),
                    _ => file.insert(k, b'9'),
                }
            }
            parse_safely(format, &file);
        }
    }

    #[test]
    fn positions_of_any_bits_survive(
        points in prop::collection::vec(prop::array::uniform3(prop::num::f64::ANY), 1..20),
        big in any::<bool>(),
    ) {
        let mut mesh = MeshData::new(points, Vec::new());
        mesh.positions.iter_mut().flatten().for_each(|x| if x.is_nan() { *x = f64::NAN });
        for (encoding, format) in [
            (PlyEncoding::Ascii, Format::Ply),
            (if big { PlyEncoding::BinaryBigEndian } else { PlyEncoding::default() }, Format::Ply),
            (PlyEncoding::default(), Format::Obj),
            (PlyEncoding::default(), Format::Off),
        ] {
            mesh.ply.encoding = encoding;
            let mut bytes = Vec::new();
            match format {
                Format::Ply => ply::write(&mesh, &mut bytes).unwrap(),
                Format::Obj => obj::write(&mesh, &mut bytes).unwrap(),
                _ => off::write(&mesh, &mut bytes).unwrap(),
            }
            prop_assert_eq!(bits(&format.parse(&bytes).unwrap()), bits(&mesh));
        }
    }
}

/// [`valid_files`], which writes to the disk, only once.
fn valid_files_cached() -> Vec<(Format, Vec<u8>)> {
    static FILES: std::sync::OnceLock<Vec<(Format, Vec<u8>)>> = std::sync::OnceLock::new();
    FILES.get_or_init(valid_files).clone()
}
