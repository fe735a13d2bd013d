//! Parameters of the methods that predict the surface.

use super::parameter::{Parameter, switch, switch_name};
use crate::predict::surface::candidates::Candidate;

/// What the methods `auto` and `curvature` do; see `docs/methods/auto.md`. The defaults suit every hole; the
/// switches tell what each part contributes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AutoOptions {
    /// The candidate to use whatever its score; `None` (the default) chooses by the scores.
    pub candidate: Option<Candidate>,
    /// Whether normals come from quadrics fitted to positions (the default) or from triangles.
    pub jets: bool,
    /// Whether planes, spheres, cylinders, cones, tori, quadrics and cyclides compete; default true.
    pub primitives: bool,
    /// Whether the function with the quintic kernel competes; default true.
    pub quintic: bool,
    /// Whether missing tips of horns are recognised; default true.
    pub tips: bool,
    /// Whether creases of the surroundings are continued across the hole; default true.
    pub creases: bool,
}

impl Default for AutoOptions {
    fn default() -> Self {
        Self {
            candidate: None,
            jets: true,
            primitives: true,
            quintic: true,
            tips: true,
            creases: true,
        }
    }
}

/// The value of `auto.candidate` that leaves the choice to the scores.
const CHOICE: &str = "choice";

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "auto.candidate",
        help: "the surface that the patch lies on, whatever its score",
        allowed: "choice, plane, sphere, cylinder, cone, torus, quadric, cyclide, rbf3, rbf3-smoothed, rbf3-ridge, rbf5",
        get: |o| o.auto.candidate.map_or(CHOICE, Candidate::name).to_owned(),
        set: |o, v| {
            o.auto.candidate = if v == CHOICE {
                None
            } else {
                Some(Candidate::ALL.into_iter().find(|c| c.name() == v)?)
            };
            Some(())
        },
    },
    Parameter {
        name: "auto.jets",
        help: "normals from quadrics fitted to positions, not from triangles",
        allowed: "on or off",
        get: |o| switch_name(o.auto.jets),
        set: |o, v| switch(v).map(|v| o.auto.jets = v),
    },
    Parameter {
        name: "auto.primitives",
        help: "planes, spheres, cylinders, cones, tori, quadrics and cyclides compete",
        allowed: "on or off",
        get: |o| switch_name(o.auto.primitives),
        set: |o, v| switch(v).map(|v| o.auto.primitives = v),
    },
    Parameter {
        name: "auto.quintic",
        help: "the interpolating function with the kernel of degree five competes",
        allowed: "on or off",
        get: |o| switch_name(o.auto.quintic),
        set: |o, v| switch(v).map(|v| o.auto.quintic = v),
    },
    Parameter {
        name: "auto.tips",
        help: "missing tips of horns are recognised",
        allowed: "on or off",
        get: |o| switch_name(o.auto.tips),
        set: |o, v| switch(v).map(|v| o.auto.tips = v),
    },
    Parameter {
        name: "auto.creases",
        help: "creases of the surroundings are continued across the hole",
        allowed: "on or off",
        get: |o| switch_name(o.auto.creases),
        set: |o, v| switch(v).map(|v| o.auto.creases = v),
    },
];
