//! Parameters of GREY.

use super::parameter::{Parameter, number};

pub(super) const PARAMETERS: &[Parameter] = &[Parameter {
    name: "grey.series",
    help: "known angles on each side of the hole to which the grey model is fitted",
    allowed: "an integer from 4 to 8",
    get: |o| o.grey.series.to_string(),
    set: |o, v| number(v, 4, 8).map(|v| o.grey.series = v),
}];
