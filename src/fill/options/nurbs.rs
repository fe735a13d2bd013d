//! Parameters of NURBS.

use super::parameter::{Parameter, number};

pub(super) const PARAMETERS: &[Parameter] = &[Parameter {
    name: "nurbs.layers",
    help: "layers of known points on each side of the hole, besides the rim",
    allowed: "an integer from 0 to 6",
    get: |o| o.nurbs.layers.to_string(),
    set: |o, v| number(v, 0, 6).map(|v| o.nurbs.layers = v),
}];
