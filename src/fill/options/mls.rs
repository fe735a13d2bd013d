//! Parameters of moving least squares.

use super::parameter::{Parameter, number};
use crate::predict::mls::{MlsDomain, MlsUnit};

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "mls.alpha",
        help: "α of the weights exp(-α d²)/d², with d in the unit mls.unit",
        allowed: "a number from 0 to 1000",
        get: |o| o.mls.alpha.to_string(),
        set: |o, v| number(v, 0.0, 1e3).map(|v| o.mls.alpha = v),
    },
    Parameter {
        name: "mls.beta",
        help: "width of the vicinity, in sampling steps",
        allowed: "a number from 0.5 to 100",
        get: |o| o.mls.beta.to_string(),
        set: |o, v| number(v, 0.5, 100.0).map(|v| o.mls.beta = v),
    },
    Parameter {
        name: "mls.degree",
        help: "degree of the polynomials",
        allowed: "an integer from 0 to 3",
        get: |o| o.mls.degree.to_string(),
        set: |o, v| number(v, 0, 3).map(|v| o.mls.degree = v),
    },
    Parameter {
        name: "mls.domain",
        help: "surface over which heights are taken; auto is the plane where that is one-to-one",
        allowed: "auto, plane or curved",
        get: |o| {
            match o.mls.domain {
                MlsDomain::Auto => "auto",
                MlsDomain::Plane => "plane",
                MlsDomain::Curved => "curved",
            }
            .to_owned()
        },
        set: |o, v| {
            o.mls.domain = match v {
                "auto" => MlsDomain::Auto,
                "plane" => MlsDomain::Plane,
                "curved" => MlsDomain::Curved,
                _ => return None,
            };
            Some(())
        },
    },
    Parameter {
        name: "mls.unit",
        help: "unit of the distances in the weights: the sampling step, or a quarter of the hole's radius",
        allowed: "step or radius",
        get: |o| {
            match o.mls.unit {
                MlsUnit::Step => "step",
                MlsUnit::Radius => "radius",
            }
            .to_owned()
        },
        set: |o, v| {
            o.mls.unit = match v {
                "step" => MlsUnit::Step,
                "radius" => MlsUnit::Radius,
                _ => return None,
            };
            Some(())
        },
    },
];
