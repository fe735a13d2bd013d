//! [`FillOptions`]: everything that users can choose for filling holes.

pub(crate) mod attributes;
pub(crate) mod entry;

pub use attributes::{AttributeOptions, FilledAttributes, Interpolator};

use crate::error::{Error, Result};
use crate::methods::method::{Method, MethodOptions};
use entry::{Entry, Options, options};
use std::sync::LazyLock;

/// An option of a fill that can be set by its name.
pub type Parameter = Entry<FillOptions>;

options! {
    /// How holes are filled.
    ///
    /// The options of a method are under [`FillOptions::methods`]. What has a range can also be set by name with
    /// [`FillOptions::set`]; [`FillOptions::parameters`] lists the names with their defaults and ranges.
    pub struct FillOptions {
        /// The method.
        method: Method = Method::Auto;
        /// Seed of the methods that use random numbers.
        seed: u64 = 0;
        /// Threads that fill holes at the same time.
        ///
        /// 0 takes as many as there are processors; 1 fills the holes on the calling thread. Intersection tests of
        /// patches with more than a few hundred triangles are shared out to rayon's current pool besides. The result
        /// is the same for any number.
        threads: usize = 0;
        /// Try the next simpler method when a patch cannot be used
        fallback: bool = true, in ();
        /// Join a loose sheet inside a hole to the patch of that hole
        ///
        /// Otherwise the hole in the middle and the sheet are closed by themselves.
        join_islands: bool = true, in ();
        /// Seconds after which holes that are not finished are given up
        ///
        /// Such holes fail with [`crate::ErrorKind::Limit`] and are as they were. Which holes are finished in time depends on
        /// the machine; a patch that is finished is the same as without a limit.
        time_budget: Option<f64> = None, in ("none", 0.0..=1e9);
    }
    groups {
        /// How patches are refined.
        "refine" refinement: RefinementOptions;
        /// How the attributes of new vertices are made.
        "attributes" attributes: AttributeOptions;
        /// The options of each method.
        "" methods: MethodOptions;
    }
}

options! {
    /// How patches are refined.
    pub struct RefinementOptions {
        /// Target edge length of new triangles over that of the rim
        density: f64 = 1.0, in 0.1..=100.0;
        /// Growth of the target edge length per unit of distance from the rim
        ///
        /// `None` grows it only for rims of more than 250 edges, see `docs/methods/staircase.md`.
        grading: Option<f64> = None, in ("auto", 0.0..=1.0);
        /// Largest number of new vertices in one hole
        max_vertices: usize = 10_000_000, in 0..=1_000_000_000;
    }
}

/// The group of the options that belong to no group of their own.
const FILL: &str = "fill";

static PARAMETERS: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
    let mut entries = FillOptions::entries();
    for entry in &mut entries {
        entry.put_into_group(FILL);
    }
    entries
});

impl FillOptions {
    /// All options that [`FillOptions::set`] knows, grouped by method.
    pub fn parameters() -> impl Iterator<Item = &'static Parameter> {
        PARAMETERS.iter()
    }

    /// The parameter of this name.
    #[must_use]
    pub fn parameter(name: &str) -> Option<&'static Parameter> {
        Self::parameters().find(|p| p.name() == name)
    }

    /// Sets the option `name` to `value`.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] for an unknown name (the message lists the known ones) or a value that
    /// is not allowed (the message says which are). The options are then unchanged.
    pub fn set(&mut self, name: &str, value: &str) -> Result<()> {
        let parameter = Self::parameter(name).ok_or_else(|| {
            let names: Vec<&str> = Self::parameters().map(Parameter::name).collect();
            Error::invalid(format!(
                "unknown parameter '{name}'; the parameters are {}",
                names.join(", ")
            ))
        })?;
        parameter.set(self, value)
    }

    /// Checks that every option is in its range, however it was set.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] for the first option out of its range, with the message of [`FillOptions::set`].
    pub(crate) fn check(&self) -> Result<()> {
        Self::parameters().try_for_each(|parameter| parameter.check(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    #[test]
    fn every_parameter_takes_its_own_default_back() {
        for parameter in FillOptions::parameters() {
            let mut options = FillOptions::default();
            let value = parameter.value(&options);
            options.set(parameter.name(), &value).unwrap();
            assert_eq!(options, FillOptions::default(), "{}", parameter.name());
        }
    }

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        let error = FillOptions::default()
            .set("refine.densty", "1")
            .unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        for parameter in FillOptions::parameters() {
            assert!(error.message().contains(parameter.name()), "{error}");
        }
    }

    #[test]
    fn a_value_out_of_range_changes_nothing_and_says_what_is_allowed() {
        let mut options = FillOptions::default();
        for (name, value) in [
            ("refine.density", "0"),
            ("refine.density", "NaN"),
            ("refine.grading", "2"),
            ("flat.exact-limit", "2.5"),
            ("fill.fallback", "yes"),
        ] {
            let error = options.set(name, value).unwrap_err();
            assert!(error.message().contains("it takes"), "{error}");
        }
        assert_eq!(options, FillOptions::default());
    }

    #[test]
    fn a_value_out_of_range_is_found_however_it_was_set() {
        let options = FillOptions::default().refinement(RefinementOptions::default().density(0.0));
        let error = options.check().unwrap_err();
        assert_eq!(
            error.message(),
            "refine.density cannot be '0': it takes a number from 0.1 to 100"
        );
    }

    #[test]
    fn switches_take_the_words_that_people_write() {
        let mut options = FillOptions::default();
        for (value, is_on) in [
            ("off", false),
            ("on", true),
            ("false", false),
            ("true", true),
            ("0", false),
            ("1", true),
        ] {
            options.set("fill.fallback", value).unwrap();
            assert_eq!(options.fallback, is_on, "{value}");
        }
    }
}
