//! Named columns of values over the vertices or the faces of a mesh.
//!
//! A column has one entry for each element: a number of one of eight types, or a list of such numbers. In
//! [`Attributes`], all columns have the same length. The append operations extend all columns at once.

mod values;

pub(crate) use values::with_scalars;
pub use values::{ListValues, ScalarType, ScalarValues};

use crate::error::{Error, Result};

/// The entries of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum AttributeValues {
    /// One number per element.
    Scalars(ScalarValues),
    /// One list of numbers per element.
    Lists(ListValues),
}

impl AttributeValues {
    /// The number of entries.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Scalars(values) => values.len(),
            Self::Lists(lists) => lists.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The type of the numbers, or of the items of the lists.
    #[must_use]
    pub fn scalar_type(&self) -> ScalarType {
        match self {
            Self::Scalars(values) => values.scalar_type(),
            Self::Lists(lists) => lists.items().scalar_type(),
        }
    }

    /// Entry `k` as a number, widened exactly; `None` for a list and past the end.
    #[must_use]
    pub fn number(&self, k: usize) -> Option<f64> {
        match self {
            Self::Scalars(values) => values.get(k),
            Self::Lists(_) => None,
        }
    }

    /// How many numbers entry `k` holds.
    pub(crate) fn entry_len(&self, k: usize) -> usize {
        match self {
            Self::Scalars(_) => 1,
            Self::Lists(lists) => lists.range(k).map_or(0, |range| range.len()),
        }
    }

    /// Appends a copy of entry `k`, which must exist.
    fn push_copy_of(&mut self, k: usize) {
        match self {
            Self::Scalars(values) => values.push_copies_of(k..k + 1),
            Self::Lists(lists) => lists.push_copy_of(k),
        }
    }

    /// Appends zero, or an empty list.
    fn push_blank(&mut self) {
        match self {
            Self::Scalars(values) => values.push(0.0),
            Self::Lists(lists) => lists.close_list(),
        }
    }

    /// Keeps the first `count` entries.
    fn truncate(&mut self, count: usize) {
        match self {
            Self::Scalars(values) => values.truncate(count),
            Self::Lists(lists) => lists.truncate(count),
        }
    }

    /// Removes the first `count` entries, which must exist.
    fn drop_front(&mut self, count: usize) {
        match self {
            Self::Scalars(values) => values.drop_front(count),
            Self::Lists(lists) => lists.drop_front(count),
        }
    }
}

/// A column: a name and one entry per element.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    /// Unique among the columns of an [`Attributes`].
    pub name: String,
    /// The entries.
    pub values: AttributeValues,
}

/// An ordered list of named columns over `len` elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    len: usize,
    columns: Vec<Attribute>,
}

impl Attributes {
    /// A list without columns, for `len` elements.
    #[must_use]
    pub fn new(len: usize) -> Self {
        Self {
            len,
            columns: Vec::new(),
        }
    }

    /// The number of elements, which is the number of entries of each column.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no elements. There may be columns nevertheless.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The columns in order.
    #[must_use]
    pub fn columns(&self) -> &[Attribute] {
        &self.columns
    }

    /// The columns in order.
    pub fn iter(&self) -> std::slice::Iter<'_, Attribute> {
        self.columns.iter()
    }

    /// The entries of the column `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&AttributeValues> {
        self.columns
            .iter()
            .find(|column| column.name == name)
            .map(|column| &column.values)
    }

    /// Adds a column at the end.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when there is a column of this name or `values` does not have
    /// one entry per element; nothing changes then.
    pub fn push(&mut self, name: impl Into<String>, values: AttributeValues) -> Result<()> {
        let name = name.into();
        if self.get(&name).is_some() {
            return Err(Error::invalid(format!(
                "there are two attributes named {name}"
            )));
        }
        if values.len() != self.len {
            return Err(Error::invalid(format!(
                "attribute {name} has {} entries for {} elements",
                values.len(),
                self.len
            )));
        }
        self.columns.push(Attribute { name, values });
        Ok(())
    }

    /// Appends one element per item of `sources`: a copy of that existing element in all columns.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when a source is not an existing element; nothing changes then.
    pub fn append_copies(&mut self, sources: &[usize]) -> Result<()> {
        self.check_sources(sources)?;
        for column in &mut self.columns {
            sources.iter().for_each(|&k| column.values.push_copy_of(k));
        }
        self.len += sources.len();
        Ok(())
    }

    /// Appends one element for each item of `sources`. In a column of numbers, new element `j` gets `value(column,
    /// j)`, where `column` has only its old entries; see [`ScalarValues::push`] for rounding. In a column of lists,
    /// it gets a copy of `sources[j]`.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when a source is not an existing element; nothing changes then.
    pub fn append_with(
        &mut self,
        sources: &[usize],
        mut value: impl FnMut(&Attribute, usize) -> f64,
    ) -> Result<()> {
        self.check_sources(sources)?;
        for column in &mut self.columns {
            let numbers: Vec<f64> = match column.values {
                AttributeValues::Scalars(_) => {
                    (0..sources.len()).map(|j| value(column, j)).collect()
                }
                AttributeValues::Lists(_) => Vec::new(),
            };
            match &mut column.values {
                AttributeValues::Scalars(values) => {
                    numbers.into_iter().for_each(|number| values.push(number));
                }
                lists @ AttributeValues::Lists(_) => {
                    sources.iter().for_each(|&k| lists.push_copy_of(k));
                }
            }
        }
        self.len += sources.len();
        Ok(())
    }

    /// Appends `count` elements that are zero, or an empty list, in all columns.
    pub(crate) fn append_blank(&mut self, count: usize) {
        for column in &mut self.columns {
            (0..count).for_each(|_| column.values.push_blank());
        }
        self.len += count;
    }

    /// Keeps the first `len` elements, which must exist.
    pub(crate) fn truncate(&mut self, len: usize) {
        self.columns
            .iter_mut()
            .for_each(|column| column.values.truncate(len));
        self.len = len;
    }

    /// Replaces the elements by copies of those in `sources`, in that order.
    pub(crate) fn rearrange(&mut self, sources: &[usize]) -> Result<()> {
        let old_len = self.len;
        self.append_copies(sources)?;
        self.columns
            .iter_mut()
            .for_each(|column| column.values.drop_front(old_len));
        self.len = sources.len();
        Ok(())
    }

    fn check_sources(&self, sources: &[usize]) -> Result<()> {
        match sources.iter().find(|&&k| k >= self.len) {
            None => Ok(()),
            Some(k) => Err(Error::invalid(format!(
                "no element {k} among {} to copy from",
                self.len
            ))),
        }
    }
}

impl<'a> IntoIterator for &'a Attributes {
    type Item = &'a Attribute;
    type IntoIter = std::slice::Iter<'a, Attribute>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scalars(values: ScalarValues) -> AttributeValues {
        AttributeValues::Scalars(values)
    }

    /// Three elements: a color, a list column with an empty entry, a temperature.
    fn sample() -> Attributes {
        let mut attributes = Attributes::new(3);
        attributes
            .push("red", scalars(ScalarValues::U8(vec![0, 100, 255])))
            .unwrap();
        let lists = ListValues::from_parts(
            ScalarType::U8,
            ScalarValues::I16(vec![7, 8, 9]),
            vec![2, 2, 3],
        );
        attributes
            .push("ring", AttributeValues::Lists(lists.unwrap()))
            .unwrap();
        attributes
            .push("heat", scalars(ScalarValues::F32(vec![0.5, -1.0, 2.0])))
            .unwrap();
        attributes
    }

    fn ring(attributes: &Attributes) -> &ListValues {
        match attributes.get("ring") {
            Some(AttributeValues::Lists(lists)) => lists,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn columns_keep_their_order_and_types() {
        let attributes = sample();
        let found: Vec<_> = attributes
            .iter()
            .map(|a| (a.name.as_str(), a.values.scalar_type()))
            .collect();
        let expected = [
            ("red", ScalarType::U8),
            ("ring", ScalarType::I16),
            ("heat", ScalarType::F32),
        ];
        assert_eq!(found, expected);
        assert_eq!(attributes.get("red").unwrap().number(2), Some(255.0));
        assert_eq!(attributes.get("red").unwrap().number(3), None);
        assert_eq!(attributes.get("ring").unwrap().number(0), None);
        assert_eq!(attributes.get("blue"), None);
    }

    #[test]
    fn a_second_column_of_one_name_or_a_wrong_length_is_refused() {
        let mut attributes = sample();
        let before = attributes.clone();
        for (name, values) in [("red", vec![1, 2, 3]), ("new", vec![1, 2]), ("new", vec![])] {
            let error = attributes
                .push(name, scalars(ScalarValues::I32(values)))
                .unwrap_err();
            assert_eq!(error.kind(), crate::ErrorKind::InvalidInput);
        }
        assert_eq!(attributes, before);
    }

    #[test]
    fn append_copies_extends_numbers_and_lists() {
        let mut attributes = sample();
        attributes.append_copies(&[2, 0, 1]).unwrap();
        assert_eq!(attributes.len(), 6);
        assert!(attributes.iter().all(|column| column.values.len() == 6));
        assert_eq!(attributes.get("red").unwrap().number(3), Some(255.0));
        assert_eq!(
            ring(&attributes).items(),
            &ScalarValues::I16(vec![7, 8, 9, 9, 7, 8])
        );
        assert_eq!(ring(&attributes).range(4), Some(4..6));
        assert_eq!(ring(&attributes).range(5), Some(6..6));
    }

    #[test]
    fn append_with_sets_numbers_and_copies_lists() {
        let mut attributes = sample();
        let mean = |column: &Attribute, _| {
            let values = &column.values;
            (values.number(0).unwrap() + values.number(1).unwrap()) / 2.0
        };
        attributes.append_with(&[0, 1], mean).unwrap();
        assert_eq!(attributes.get("red").unwrap().number(4), Some(50.0));
        assert_eq!(attributes.get("heat").unwrap().number(3), Some(-0.25));
        assert_eq!(ring(&attributes).range(3), Some(3..5));
        assert_eq!(attributes.len(), 5);
    }

    #[test]
    fn a_source_that_does_not_exist_changes_nothing() {
        let mut attributes = sample();
        let before = attributes.clone();
        assert!(attributes.append_copies(&[0, 3]).is_err());
        assert!(attributes.append_with(&[3], |_, _| 0.0).is_err());
        assert_eq!(attributes, before);
        assert!(Attributes::new(0).append_copies(&[0]).is_err());
    }

    #[test]
    fn rearrange_replaces_the_elements() {
        let mut attributes = sample();
        attributes.rearrange(&[2, 2, 0, 1]).unwrap();
        assert_eq!(attributes.len(), 4);
        assert_eq!(
            attributes.columns()[0].values,
            scalars(ScalarValues::U8(vec![255, 255, 0, 100]))
        );
        assert_eq!(
            ring(&attributes).items(),
            &ScalarValues::I16(vec![9, 9, 7, 8])
        );
        let ranges: Vec<_> = (0..4)
            .map(|k| ring(&attributes).range(k).unwrap())
            .collect();
        assert_eq!(ranges, [0..1, 1..2, 2..4, 4..4]);
        attributes.rearrange(&[]).unwrap();
        assert!(attributes.is_empty() && ring(&attributes).is_empty());
    }
}
