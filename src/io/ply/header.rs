//! Reads the header of a PLY file: the elements that follow, and their properties.

use super::super::text::{Lines, parse_error, parse_number, quoted, tokens};
use super::details::PlyEncoding;
use crate::error::Result;
use crate::mesh::attributes::ScalarType;

#[derive(Debug)]
pub(super) struct Header<'a> {
    pub(super) encoding: PlyEncoding,
    /// The `comment` and `obj_info` lines.
    pub(super) remarks: Vec<String>,
    pub(super) elements: Vec<Element>,
    /// The file after the header.
    pub(super) body: Lines<'a>,
}

#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) item_type: ScalarType,
    /// The type of the length of a list; `None` for a property that is one number.
    pub(super) count_type: Option<ScalarType>,
}

impl Property {
    /// Lower bound on the bytes of an entry in a binary file.
    pub(super) fn least_size(&self) -> usize {
        self.count_type.unwrap_or(self.item_type).size()
    }
}

pub(super) fn parse(bytes: &[u8]) -> Result<Header<'_>> {
    let mut lines = Lines::new(bytes);
    if lines.next_line().map(<[u8]>::trim_ascii) != Some(b"ply") {
        return Err(lines.error("a PLY file begins with \"ply\""));
    }
    let mut encoding = None;
    let mut remarks = Vec::new();
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let Some(line) = lines.next_line() else {
            return Err(parse_error("the PLY header has no end_header"));
        };
        let mut words = tokens(line);
        let Some(keyword) = words.next() else {
            continue;
        };
        let words: Vec<&[u8]> = words.collect();
        match (keyword, words.as_slice()) {
            (b"format", [name, b"1.0"]) if encoding.is_none() => {
                let known = PlyEncoding::ALL
                    .into_iter()
                    .find(|e| e.name().as_bytes() == *name);
                if known.is_none() {
                    return Err(lines.error(format!("unknown PLY format {}", quoted(name))));
                }
                encoding = known;
            }
            (b"comment" | b"obj_info", _) => {
                remarks.push(text(line).replace('\r', " "));
            }
            (b"element", [name, count]) => {
                let name = text(name);
                if elements.iter().any(|element| element.name == name) {
                    return Err(lines.error(format!("there are two elements named {name}")));
                }
                let Some(count) = parse_number(count) else {
                    return Err(lines.error(format!("a count cannot be {}", quoted(count))));
                };
                elements.push(Element {
                    name,
                    count,
                    properties: Vec::new(),
                });
            }
            (b"property", words) => {
                let property = parse_property(&lines, words)?;
                let Some(element) = elements.last_mut() else {
                    return Err(lines.error("a property before the first element"));
                };
                if element
                    .properties
                    .iter()
                    .any(|other| other.name == property.name)
                {
                    let (element, name) = (&element.name, &property.name);
                    return Err(lines.error(format!("{element} has two properties named {name}")));
                }
                element.properties.push(property);
            }
            (b"end_header", []) => break,
            _ => return Err(lines.error(format!("not a PLY header line: {}", quoted(line)))),
        }
    }
    match encoding {
        Some(encoding) => Ok(Header {
            encoding,
            remarks,
            elements,
            body: lines,
        }),
        None => Err(lines.error("the PLY header has no format line")),
    }
}

fn parse_property(lines: &Lines, words: &[&[u8]]) -> Result<Property> {
    let scalar_type = |word: &[u8]| {
        parse_type(word)
            .ok_or_else(|| lines.error(format!("unknown property type {}", quoted(word))))
    };
    match *words {
        [b"list", count, item, name] => {
            let count_type = scalar_type(count)?;
            if !count_type.is_integer() {
                return Err(lines.error("the length of a list needs an integer type"));
            }
            let item_type = scalar_type(item)?;
            Ok(Property {
                name: text(name),
                item_type,
                count_type: Some(count_type),
            })
        }
        [item, name] => Ok(Property {
            name: text(name),
            item_type: scalar_type(item)?,
            count_type: None,
        }),
        _ => Err(lines.error("a property line is \"property TYPE NAME\" or \"property list ...\"")),
    }
}

fn parse_type(word: &[u8]) -> Option<ScalarType> {
    Some(match word {
        b"char" | b"int8" => ScalarType::I8,
        b"uchar" | b"uint8" => ScalarType::U8,
        b"short" | b"int16" => ScalarType::I16,
        b"ushort" | b"uint16" => ScalarType::U16,
        b"int" | b"int32" => ScalarType::I32,
        b"uint" | b"uint32" => ScalarType::U32,
        b"float" | b"float32" => ScalarType::F32,
        b"double" | b"float64" => ScalarType::F64,
        _ => return None,
    })
}

/// The name that every reader knows for the type.
pub(super) fn type_name(scalar_type: ScalarType) -> &'static str {
    match scalar_type {
        ScalarType::I8 => "char",
        ScalarType::U8 => "uchar",
        ScalarType::I16 => "short",
        ScalarType::U16 => "ushort",
        ScalarType::I32 => "int",
        ScalarType::U32 => "uint",
        ScalarType::F32 => "float",
        ScalarType::F64 => "double",
    }
}

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    #[test]
    fn old_and_new_type_names_mean_the_same() {
        let text = "ply\r\nformat binary_big_endian 1.0\r\ncomment a  b \r\nelement vertex 5\r\n\
                    property int8 a\r\nproperty list uint8 float64 b\r\nelement x 0\r\n\
                    end_header\r\nBODY";
        let header = parse(text.as_bytes()).unwrap();
        assert_eq!(header.encoding, PlyEncoding::BinaryBigEndian);
        assert_eq!(header.remarks, ["comment a  b "]);
        assert_eq!(header.body.rest(), b"BODY");
        let vertex = &header.elements[0];
        assert_eq!((vertex.name.as_str(), vertex.count), ("vertex", 5));
        let types: Vec<_> = vertex
            .properties
            .iter()
            .map(|p| (p.count_type, p.item_type))
            .collect();
        assert_eq!(
            types,
            [
                (None, ScalarType::I8),
                (Some(ScalarType::U8), ScalarType::F64)
            ]
        );
        assert!(header.elements[1].properties.is_empty());
    }

    #[test]
    fn every_type_is_written_as_it_is_read() {
        for name in [
            "char", "uchar", "short", "ushort", "int", "uint", "float", "double",
        ] {
            assert_eq!(type_name(parse_type(name.as_bytes()).unwrap()), name);
        }
    }

    #[test]
    fn a_broken_header_is_an_error_at_its_line() {
        let cases = [
            ("plx\n", "line 1:"),
            ("ply\nformat ascii 2.0\n", "line 2:"),
            (
                "ply\nformat utf8 1.0\n",
                "line 2: unknown PLY format \"utf8\"",
            ),
            ("ply\nproperty int a\n", "line 2: a property before"),
            ("ply\nelement vertex -1\n", "line 2: a count"),
            (
                "ply\nelement vertex 99999999999999999999999\n",
                "line 2: a count",
            ),
            ("ply\nelement vertex\n", "line 2: not a PLY header"),
            ("ply\nelement a 1\nelement a 1\n", "line 3: there are two"),
            (
                "ply\nelement a 1\nproperty int64 a\n",
                "line 3: unknown property type \"int64\"",
            ),
            (
                "ply\nelement a 1\nproperty list float int a\n",
                "line 3: the length",
            ),
            (
                "ply\nelement a 1\nproperty int x\nproperty int x\n",
                "line 4: a has two",
            ),
            (
                "ply\nelement a 1\nproperty int\n",
                "line 3: a property line",
            ),
            ("ply\nend_header\n", "line 2: the PLY header has no format"),
            (
                "ply\nformat ascii 1.0\n",
                "the PLY header has no end_header",
            ),
        ];
        for (text, start) in cases {
            let error = parse(text.as_bytes()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Parse);
            assert!(error.message().starts_with(start), "{text:?} gives {error}");
        }
    }
}
