//! Options of a fill, and every parameter by its documented name.

mod attributes;
mod auto;
mod grey;
mod hpde;
mod mls;
mod nurbs;
mod parameter;
mod staircase;
mod unfold;

pub use attributes::{AttributeOptions, FilledAttributes, Interpolator};
pub use auto::AutoOptions;
pub use parameter::Parameter;
pub use staircase::{FairWeights, FairingOptions};

use super::method::Method;
use crate::error::{Error, ErrorKind, Result};
use crate::predict::grey::GreyOptions;
use crate::predict::hpde::options::HpdeOptions;
use crate::predict::mls::MlsOptions;
use crate::predict::nurbs::NurbsOptions;
use crate::triangulate::unfold::UnfoldOptions;
use parameter::{number, switch, switch_name};

/// How holes are filled.
///
/// All parameters can also be reached by name with [`FillOptions::set`]; [`FillOptions::parameters`] lists
/// them with their defaults and ranges.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FillOptions {
    /// The method; default [`Method::Auto`].
    pub method: Method,
    /// Seed of the methods that use random numbers; default 0.
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
    /// How [`Method::Membrane`], [`Method::FairC1`] and [`Method::FairC2`] fair the refined patch.
    pub fairing: FairingOptions,
    /// What [`Method::Auto`] and [`Method::Curvature`] do.
    pub auto: AutoOptions,
    /// Options of [`Method::Hpde`].
    pub hpde: HpdeOptions,
    /// Options of [`Method::Grey`], which uses those of [`Method::Hpde`] besides.
    pub grey: GreyOptions,
    /// Options of [`Method::Nurbs`], which uses those of [`Method::Hpde`] besides.
    pub nurbs: NurbsOptions,
    /// Seconds that a fill may take; holes that are not finished then fail with [`ErrorKind::Limit`] and are as
    /// they were. `None` (the default) sets no limit. Which holes are finished in time depends on the
    /// machine; a patch that is finished is the same as without a limit.
    pub time_budget: Option<f64>,
    /// How the attributes of new vertices are made.
    pub attributes: AttributeOptions,
    /// How [`Method::UnfoldArea`] and [`Method::UnfoldFairing`] unfold the rim.
    pub unfold: UnfoldOptions,
    /// How [`Method::Mls`] fits and resamples.
    pub mls: MlsOptions,
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
            fairing: FairingOptions::default(),
            auto: AutoOptions::default(),
            hpde: HpdeOptions::default(),
            grey: GreyOptions::default(),
            nurbs: NurbsOptions::default(),
            time_budget: None,
            attributes: AttributeOptions::default(),
            unfold: UnfoldOptions::default(),
            mls: MlsOptions::default(),
        }
    }
}

/// The parameters, by the method or stage that they belong to.
const GROUPS: &[&[Parameter]] = &[
    FILL,
    auto::PARAMETERS,
    staircase::PARAMETERS,
    hpde::PARAMETERS,
    grey::PARAMETERS,
    nurbs::PARAMETERS,
    unfold::PARAMETERS,
    mls::PARAMETERS,
    attributes::PARAMETERS,
];

const FILL: &[Parameter] = &[
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
        name: "fill.time-budget",
        help: "seconds after which holes that are not finished are given up",
        allowed: "none, or a number of seconds from 0 to 1000000000",
        get: |o| {
            o.time_budget
                .map_or_else(|| "none".to_owned(), |t| t.to_string())
        },
        set: |o, v| {
            o.time_budget = if v == "none" {
                None
            } else {
                Some(number(v, 0.0, 1e9)?)
            };
            Some(())
        },
    },
];

impl FillOptions {
    /// Every parameter that [`FillOptions::set`] knows, each method's together.
    pub fn parameters() -> impl Iterator<Item = &'static Parameter> {
        GROUPS.iter().copied().flatten()
    }

    /// Sets the parameter `name` to `value`.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] for an unknown name (the message lists the known ones) or a value that
    /// is not allowed (the message says which are). The options are then unchanged.
    pub fn set(&mut self, name: &str, value: &str) -> Result<()> {
        let Some(parameter) = Self::parameters().find(|p| p.name == name) else {
            let names: Vec<&str> = Self::parameters().map(|p| p.name).collect();
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
        for parameter in Self::parameters() {
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
        for parameter in FillOptions::parameters() {
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
        for parameter in FillOptions::parameters() {
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
