//! What a parameter is that users set by name, and how its values are read.

use super::FillOptions;
use crate::error::{Error, ErrorKind};

/// A parameter that can be set by name.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// The name, such as `refine.density`.
    pub name: &'static str,
    /// What it does, with its unit, in one line.
    pub help: &'static str,
    /// The values that are allowed, in words.
    pub allowed: &'static str,
    pub(super) get: fn(&FillOptions) -> String,
    pub(super) set: fn(&mut FillOptions, &str) -> Option<()>,
}

impl Parameter {
    /// The value that `options` has, as [`FillOptions::set`] would take it.
    #[must_use]
    pub fn value(&self, options: &FillOptions) -> String {
        (self.get)(options)
    }

    pub(super) fn refusal(&self, value: &str) -> Error {
        Error::new(
            ErrorKind::InvalidInput,
            format!(
                "{} cannot be '{value}': it takes {}",
                self.name, self.allowed
            ),
        )
    }
}

pub(super) fn number<T: std::str::FromStr + PartialOrd>(value: &str, low: T, high: T) -> Option<T> {
    value.parse().ok().filter(|v| *v >= low && *v <= high)
}

pub(super) fn switch(value: &str) -> Option<bool> {
    match value {
        "on" => Some(true),
        "off" => Some(false),
        _ => None,
    }
}

pub(super) fn switch_name(value: bool) -> String {
    if value { "on" } else { "off" }.to_owned()
}
