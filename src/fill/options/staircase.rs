//! Parameters of the staircase methods and of refinement.

use super::parameter::{Parameter, number};

pub(super) const PARAMETERS: &[Parameter] = &[
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
