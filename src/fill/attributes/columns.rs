//! What kind of value a column of vertex attributes holds.

use crate::mesh::attributes::{Attribute, AttributeValues};
use crate::options::FilledAttributes;

/// Names of the components of a vertex normal.
const NORMALS: [&str; 3] = ["nx", "ny", "nz"];

/// Words that name something that is the same or not the same, where a mean has no meaning.
const LABELS: [&str; 20] = [
    "label",
    "id",
    "index",
    "indices",
    "class",
    "classification",
    "category",
    "segment",
    "segmentation",
    "semantic",
    "instance",
    "material",
    "group",
    "object",
    "region",
    "flag",
    "mask",
    "type",
    "tag",
    "selected",
];

/// The columns of a unit normal, if all three are there and floating-point.
pub(super) fn normal_columns(
    columns: &[Attribute],
    filled: &FilledAttributes,
) -> Option<[usize; 3]> {
    let mut found = [0; 3];
    for (place, name) in found.iter_mut().zip(NORMALS) {
        *place = columns
            .iter()
            .position(|c| c.name == name && is_float(c) && filled.may_fill(&c.name))?;
    }
    Some(found)
}

/// Whether the values of the column are interpolated; otherwise they are copied.
pub(super) fn is_interpolated(column: &Attribute, filled: &FilledAttributes) -> bool {
    matches!(column.values, AttributeValues::Scalars(_))
        && match filled {
            FilledAttributes::Smooth => is_float(column) || !is_label(&column.name),
            FilledAttributes::Only(_) => filled.may_fill(&column.name),
        }
}

fn is_float(column: &Attribute) -> bool {
    matches!(column.values, AttributeValues::Scalars(_))
        && !column.values.scalar_type().is_integer()
}

/// Whether one of the words in the name is that of a label: `label`, `material_id`, `faceId`, `classes`.
fn is_label(name: &str) -> bool {
    let mut words = String::new();
    let mut was_lower = false;
    for c in name.chars() {
        if !c.is_alphabetic() || (c.is_uppercase() && was_lower) {
            words.push(' ');
        }
        if c.is_alphabetic() {
            words.extend(c.to_lowercase());
        }
        was_lower = c.is_lowercase();
    }
    words.split(' ').any(|word| {
        let is = |word: &str| LABELS.contains(&word);
        is(word)
            || word.strip_suffix('s').is_some_and(is)
            || word.strip_suffix("es").is_some_and(is)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_known_by_a_word_of_their_name() {
        for name in [
            "label",
            "labels",
            "material_id",
            "faceId",
            "classes",
            "segment_3",
            "scalar_Classification",
            "ID",
        ] {
            assert!(is_label(name), "{name}");
        }
        for name in [
            "red",
            "intensity",
            "humidity",
            "glass",
            "confidence",
            "quality",
            "",
        ] {
            assert!(!is_label(name), "{name}");
        }
    }
}
