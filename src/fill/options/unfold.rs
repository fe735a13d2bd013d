//! Parameters of the unfolding.

use super::parameter::{Parameter, number};
use crate::triangulate::unfold::UnfoldSolver;

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "unfold.solver",
        help: "what unfolds the rim",
        allowed: "descent or annealing",
        get: |o| match o.unfold.solver {
            UnfoldSolver::Descent => "descent".to_owned(),
            UnfoldSolver::Annealing => "annealing".to_owned(),
        },
        set: |o, v| {
            o.unfold.solver = match v {
                "descent" => UnfoldSolver::Descent,
                "annealing" => UnfoldSolver::Annealing,
                _ => return None,
            };
            Some(())
        },
    },
    Parameter {
        name: "unfold.restarts",
        help: "runs after which the rim counts as not unfolded; auto is 100 for annealing, 4 for descent",
        allowed: "auto, or an integer from 1 to 10000",
        get: |o| {
            let restarts = o.unfold.restarts;
            restarts.map_or_else(|| "auto".to_owned(), |r| r.to_string())
        },
        set: |o, v| {
            o.unfold.restarts = if v == "auto" {
                None
            } else {
                Some(number(v, 1, 10_000)?)
            };
            Some(())
        },
    },
    Parameter {
        name: "unfold.steps",
        help: "most steps of a run",
        allowed: "an integer from 1 to 1000000",
        get: |o| o.unfold.steps.to_string(),
        set: |o, v| number(v, 1, 1_000_000).map(|v| o.unfold.steps = v),
    },
    Parameter {
        name: "unfold.temperature",
        help: "start temperature T of the annealing, in radians of its energy",
        allowed: "a number from 0.000001 to 1000",
        get: |o| o.unfold.temperature.to_string(),
        set: |o, v| number(v, 1e-6, 1e3).map(|v| o.unfold.temperature = v),
    },
    Parameter {
        name: "unfold.k",
        help: "rate of cooling k of the annealing",
        allowed: "a number from 0.1 to 0.999",
        get: |o| o.unfold.k.to_string(),
        set: |o, v| number(v, 0.1, 0.999).map(|v| o.unfold.k = v),
    },
    Parameter {
        name: "unfold.epsilon",
        help: "least distance of the rim from itself on the way, in mean rim edges",
        allowed: "a number from 0.000000001 to 0.1",
        get: |o| o.unfold.epsilon.to_string(),
        set: |o, v| number(v, 1e-9, 0.1).map(|v| o.unfold.epsilon = v),
    },
    Parameter {
        name: "unfold.cone",
        help: "degrees by which the annealing turns a direction that lowered the energy",
        allowed: "a number from 0 to 180",
        get: |o| o.unfold.cone.to_string(),
        set: |o, v| number(v, 0.0, 180.0).map(|v| o.unfold.cone = v),
    },
];
