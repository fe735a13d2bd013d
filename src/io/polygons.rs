//! Cuts polygons into triangles, and records which triangles come from which polygon.

use super::text::parse_error;
use crate::error::Result;
use crate::mesh::attributes::Attributes;

/// The triangles of the faces read so far.
#[derive(Debug, Default)]
pub(super) struct Polygons {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Number of faces so far.
    faces: usize,
    /// The face of each triangle; `None` while all faces are triangles.
    sources: Option<Vec<usize>>,
    /// Number of faces with more than three corners.
    cut: usize,
    /// Number of faces with fewer than three corners, which are left out.
    too_small: usize,
}

impl Polygons {
    pub(super) fn with_capacity(faces: usize) -> Self {
        Self {
            triangles: Vec::with_capacity(faces),
            ..Self::default()
        }
    }

    /// How many faces were pushed.
    pub(super) fn faces(&self) -> usize {
        self.faces
    }

    /// Adds a face: the fan of triangles around its first corner.
    pub(super) fn push(&mut self, corners: &[u32]) {
        let face = self.faces;
        self.faces += 1;
        if let &[a, b, c] = corners {
            self.triangles.push([a, b, c]);
            self.sources
                .iter_mut()
                .for_each(|sources| sources.push(face));
            return;
        }
        let sources = self.sources.get_or_insert_with(|| (0..face).collect());
        match corners {
            [first, fan @ ..] if fan.len() >= 2 => {
                self.cut += 1;
                for side in fan.windows(2) {
                    self.triangles.push([*first, side[0], side[1]]);
                    sources.push(face);
                }
            }
            _ => self.too_small += 1,
        }
    }

    /// Turns attributes of the faces into attributes of the triangles. Values of a face are repeated for its triangles.
    ///
    /// `budget` is an upper bound on the number of values. Without it, a file of n bytes with one polygon of n
    /// corners and n values could need memory for n² values.
    pub(super) fn spread(&self, attributes: &mut Attributes, budget: usize) -> Result<()> {
        let Some(sources) = &self.sources else {
            return Ok(());
        };
        let mut values = 0;
        for column in attributes.iter() {
            for (k, &face) in sources.iter().enumerate() {
                let is_repeated = k > 0 && sources[k - 1] == face;
                values += if is_repeated {
                    column.values.entry_len(face)
                } else {
                    0
                };
            }
            if values > budget {
                return Err(parse_error(format!(
                    "cutting {} polygons into triangles would repeat more than {budget} values of \
                     their properties",
                    self.cut
                )));
            }
        }
        attributes.rearrange(sources)
    }

    pub(super) fn notes(&self) -> impl Iterator<Item = String> {
        let cut = (self.cut > 0).then(|| {
            format!(
                "{} faces with more than three corners were cut into triangles ({} faces are now \
                 {} triangles)",
                self.cut,
                self.faces,
                self.triangles.len()
            )
        });
        let too_small = (self.too_small > 0).then(|| {
            format!(
                "{} faces with fewer than three corners left out",
                self.too_small
            )
        });
        cut.into_iter().chain(too_small)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;
    use crate::mesh::attributes::{AttributeValues, ScalarValues};

    fn numbered(count: u32) -> Attributes {
        let mut attributes = Attributes::new(count as usize);
        let values = AttributeValues::Scalars(ScalarValues::U32((0..count).collect()));
        attributes.push("id", values).unwrap();
        attributes
    }

    #[test]
    fn triangles_alone_pass_unchanged() {
        let mut polygons = Polygons::with_capacity(2);
        polygons.push(&[0, 1, 2]);
        polygons.push(&[2, 1, 3]);
        let mut attributes = numbered(2);
        polygons.spread(&mut attributes, 0).unwrap();
        assert_eq!(attributes, numbered(2));
        assert_eq!(polygons.notes().count(), 0);
    }

    #[test]
    fn a_polygon_repeats_its_attributes_and_a_line_loses_them() {
        let mut polygons = Polygons::default();
        for corners in [&[0, 1, 2][..], &[0, 1], &[5, 6, 7, 8, 9], &[], &[3, 4, 5]] {
            polygons.push(corners);
        }
        let expected = [[0, 1, 2], [5, 6, 7], [5, 7, 8], [5, 8, 9], [3, 4, 5]];
        assert_eq!(polygons.triangles, expected);
        let mut attributes = numbered(5);
        polygons.spread(&mut attributes, 2).unwrap();
        let ids: Vec<_> = (0..5)
            .map(|k| attributes.get("id").unwrap().number(k))
            .collect();
        assert_eq!(ids, [0.0, 2.0, 2.0, 2.0, 4.0].map(Some));
        assert_eq!(polygons.notes().count(), 2);
    }

    #[test]
    fn repeating_more_than_the_budget_is_refused() {
        let mut polygons = Polygons::default();
        polygons.push(&(0..1000).collect::<Vec<_>>());
        assert!(polygons.spread(&mut numbered(1), 997).is_ok());
        let error = polygons.spread(&mut numbered(1), 996).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Parse);
    }
}
