//! Options of a fill, and every parameter by its documented name.

use super::method::Method;
use crate::error::{Error, ErrorKind, Result};

/// How holes are filled.
///
/// All parameters can also be reached by name with [`FillOptions::set`]; [`FillOptions::PARAMETERS`] lists
/// them with their defaults and ranges.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FillOptions {
    /// The method; default [`Method::Auto`].
    pub method: Method,
    /// Seed of the methods that use random numbers; default 0. The methods of this version use none.
    pub seed: u64,
    /// Threads that fill holes at the same time; 0 (the default) takes as many as there are processors,
    /// 1 fills them on the calling thread. Intersection tests of patches with more than a few hundred
    /// triangles are shared out to rayon's current pool besides. The result is the same for any number.
    pub threads: usize,
    /// Whether another method is tried when the patch of the chosen one cannot be used; default true.
    pub fallback: bool,
    /// Whether a loose sheet inside a hole is joined to the patch of that hole instead of being closed by
    /// itself; default true.
    pub join_islands: bool,
    /// Largest rim, in edges, that [`Method::Flat`] searches exhaustively for the minimum-weight
    /// triangulation; default 150.
    pub exact_limit: usize,
    /// Target edge length of new triangles relative to the rim's; default 1.
    pub density: f64,
    /// How fast the target edge length grows away from the rim, per unit of length; `None` (the
    /// default) grows it only for rims of more than 250 edges, see `docs/methods/staircase.md`.
    pub grading: Option<f64>,
    /// Largest number of new vertices in one hole; default 10,000,000.
    pub max_new_vertices: usize,
}

impl Default for FillOptions {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            seed: 0,
            threads: 0,
            fallback: true,
            join_islands: true,
            exact_limit: 150,
            density: 1.0,
            grading: None,
            max_new_vertices: 10_000_000,
        }
    }
}

/// A parameter that can be set by name.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// The name, such as `refine.density`.
    pub name: &'static str,
    /// What it does, with its unit, in one line.
    pub help: &'static str,
    /// The values that are allowed, in words.
    pub allowed: &'static str,
    get: fn(&FillOptions) -> String,
    set: fn(&mut FillOptions, &str) -> Option<()>,
}

impl Parameter {
    /// The value that `options` has, as [`FillOptions::set`] would take it.
    #[must_use]
    pub fn value(&self, options: &FillOptions) -> String {
        (self.get)(options)
    }

    fn refusal(&self, value: &str) -> Error {
        Error::new(
            ErrorKind::InvalidInput,
            format!(
                "{} cannot be '{value}': it takes {}",
                self.name, self.allowed
            ),
        )
    }
}

fn number<T: std::str::FromStr + PartialOrd>(value: &str, low: T, high: T) -> Option<T> {
    value.parse().ok().filter(|v| *v >= low && *v <= high)
}

fn switch(value: &str) -> Option<bool> {
    match value {
        "on" => Some(true),
        "off" => Some(false),
        _ => None,
    }
}

fn switch_name(value: bool) -> String {
    if value { "on" } else { "off" }.to_owned()
}

impl FillOptions {
    /// Every parameter that [`FillOptions::set`] knows.
    pub const PARAMETERS: &'static [Parameter] = &[
        Parameter {
            name: "fill.fallback",
            help: "try the next simpler method when a patch cannot be used",
            allowed: "on or off",
            get: |o| switch_name(o.fallback),
            set: |o, v| switch(v).map(|v| o.fallback = v),
        },
        Parameter {
            name: "fill.join-islands",
            help: "join a loose sheet inside a hole to the patch of that hole",
            allowed: "on or off",
            get: |o| switch_name(o.join_islands),
            set: |o, v| switch(v).map(|v| o.join_islands = v),
        },
        Parameter {
            name: "flat.exact-limit",
            help: "largest rim, in edges, searched exhaustively; the cost grows with its cube",
            allowed: "an integer from 3 to 2048",
            get: |o| o.exact_limit.to_string(),
            set: |o, v| number(v, 3, 2048).map(|v| o.exact_limit = v),
        },
        Parameter {
            name: "refine.density",
            help: "target edge length of new triangles over that of the rim",
            allowed: "a number from 0.1 to 100",
            get: |o| o.density.to_string(),
            set: |o, v| number(v, 0.1, 100.0).map(|v| o.density = v),
        },
        Parameter {
            name: "refine.grading",
            help: "growth of the target edge length per unit of distance from the rim",
            allowed: "auto, or a number from 0 to 1",
            get: |o| {
                o.grading
                    .map_or_else(|| "auto".to_owned(), |g| g.to_string())
            },
            set: |o, v| {
                o.grading = if v == "auto" {
                    None
                } else {
                    Some(number(v, 0.0, 1.0)?)
                };
                Some(())
            },
        },
        Parameter {
            name: "refine.max-vertices",
            help: "largest number of new vertices in one hole",
            allowed: "an integer from 0 to 1000000000",
            get: |o| o.max_new_vertices.to_string(),
            set: |o, v| number(v, 0, 1_000_000_000).map(|v| o.max_new_vertices = v),
        },
    ];

    /// Sets the parameter `name` to `value`.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] for an unknown name (the message lists the known ones) or a value that
    /// is not allowed (the message says which are). The options are then unchanged.
    pub fn set(&mut self, name: &str, value: &str) -> Result<()> {
        let Some(parameter) = Self::PARAMETERS.iter().find(|p| p.name == name) else {
            let names: Vec<&str> = Self::PARAMETERS.iter().map(|p| p.name).collect();
            return Err(Error::new(
                ErrorKind::InvalidInput,
                format!(
                    "unknown parameter '{name}'; the parameters are {}",
                    names.join(", ")
                ),
            ));
        };
        (parameter.set)(self, value).ok_or_else(|| parameter.refusal(value))
    }

    /// Checks that every parameter is in its range, however it was set.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] for the first one that is not, as [`FillOptions::set`] would say it.
    pub(crate) fn check(&self) -> Result<()> {
        for parameter in Self::PARAMETERS {
            let value = parameter.value(self);
            if (parameter.set)(&mut self.clone(), &value).is_none() {
                return Err(parameter.refusal(&value));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_takes_its_own_default_back() {
        for parameter in FillOptions::PARAMETERS {
            let mut options = FillOptions::default();
            let value = parameter.value(&options);
            options.set(parameter.name, &value).unwrap();
            assert_eq!(options, FillOptions::default(), "{}", parameter.name);
        }
    }

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        let error = FillOptions::default()
            .set("refine.densty", "1")
            .unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        for parameter in FillOptions::PARAMETERS {
            assert!(error.message().contains(parameter.name), "{error}");
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
}
