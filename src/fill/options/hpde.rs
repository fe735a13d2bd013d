//! Parameters of HPDE.

use super::parameter::{Parameter, number, switch, switch_name};
use crate::predict::hpde::options::{
    DeCrossover, DeMutation, HpdeProjection, HpdeSolver, HpdeTangents,
};

const TANGENTS: &[(&str, HpdeTangents)] =
    &[("chord", HpdeTangents::Chord), ("jet", HpdeTangents::Jet)];

const SOLVERS: &[(&str, HpdeSolver)] = &[("de", HpdeSolver::De), ("direct", HpdeSolver::Direct)];

const VARIANTS: &[(&str, (DeMutation, DeCrossover))] = &[
    ("rand/1/bin", (DeMutation::Rand1, DeCrossover::Bin)),
    ("best/1/bin", (DeMutation::Best1, DeCrossover::Bin)),
    ("rand/2/bin", (DeMutation::Rand2, DeCrossover::Bin)),
    ("rand/1/exp", (DeMutation::Rand1, DeCrossover::Exp)),
    ("best/1/exp", (DeMutation::Best1, DeCrossover::Exp)),
    ("rand/2/exp", (DeMutation::Rand2, DeCrossover::Exp)),
];

const PROJECTIONS: &[(&str, HpdeProjection)] = &[
    ("auto", HpdeProjection::Auto),
    ("planes", HpdeProjection::Planes),
    ("sections", HpdeProjection::Sections),
];

fn named<T: Copy>(choices: &[(&str, T)], name: &str) -> Option<T> {
    choices.iter().find(|c| c.0 == name).map(|c| c.1)
}

fn name_of<T: Copy + PartialEq>(choices: &[(&str, T)], value: T) -> String {
    let name = choices.iter().find(|c| c.1 == value).map(|c| c.0);
    name.unwrap_or_default().to_owned()
}

pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "hpde.tangents",
        help: "tangents of the arcs: from the triangle at the rim, or from a quadric fitted to the surroundings",
        allowed: "chord or jet",
        get: |o| name_of(TANGENTS, o.hpde.tangents),
        set: |o, v| named(TANGENTS, v).map(|v| o.hpde.tangents = v),
    },
    Parameter {
        name: "hpde.solver",
        help: "heights of the points: differential evolution, or its start value alone",
        allowed: "de or direct",
        get: |o| name_of(SOLVERS, o.hpde.solver),
        set: |o, v| named(SOLVERS, v).map(|v| o.hpde.solver = v),
    },
    Parameter {
        name: "hpde.variant",
        help: "mutation and crossover of differential evolution",
        allowed: "rand/1, best/1 or rand/2, followed by /bin or /exp",
        get: |o| name_of(VARIANTS, (o.hpde.mutation, o.hpde.crossover)),
        set: |o, v| named(VARIANTS, v).map(|v| (o.hpde.mutation, o.hpde.crossover) = v),
    },
    Parameter {
        name: "hpde.population",
        help: "individuals of differential evolution per predicted point of a section",
        allowed: "an integer from 1 to 20",
        get: |o| o.hpde.population.to_string(),
        set: |o, v| number(v, 1, 20).map(|v| o.hpde.population = v),
    },
    Parameter {
        name: "hpde.f",
        help: "weight F of the difference in a mutation",
        allowed: "a number from 0 to 2",
        get: |o| o.hpde.f.to_string(),
        set: |o, v| number(v, 0.0, 2.0).map(|v| o.hpde.f = v),
    },
    Parameter {
        name: "hpde.cr",
        help: "probability CR of taking a height from the mutant",
        allowed: "a number from 0 to 1",
        get: |o| o.hpde.cr.to_string(),
        set: |o, v| number(v, 0.0, 1.0).map(|v| o.hpde.cr = v),
    },
    Parameter {
        name: "hpde.generations",
        help: "largest number of generations",
        allowed: "an integer from 0 to 100000",
        get: |o| o.hpde.generations.to_string(),
        set: |o, v| number(v, 0, 100_000).map(|v| o.hpde.generations = v),
    },
    Parameter {
        name: "hpde.base-spacing",
        help: "distance between base points, in mean edge lengths of the surroundings",
        allowed: "a number from 0.1 to 10",
        get: |o| o.hpde.base_spacing.to_string(),
        set: |o, v| number(v, 0.1, 10.0).map(|v| o.hpde.base_spacing = v),
    },
    Parameter {
        name: "hpde.point-spacing",
        help: "distance between predicted points of a section, in mean edge lengths of the surroundings",
        allowed: "a number from 0.1 to 10",
        get: |o| o.hpde.point_spacing.to_string(),
        set: |o, v| number(v, 0.1, 10.0).map(|v| o.hpde.point_spacing = v),
    },
    Parameter {
        name: "hpde.segment-angle",
        help: "dihedral angle A_c in degrees up to which the rim is seen as two parts on two planes",
        allowed: "a number from 0 to 180",
        get: |o| o.hpde.segment_angle.to_string(),
        set: |o, v| number(v, 0.0, 180.0).map(|v| o.hpde.segment_angle = v),
    },
    Parameter {
        name: "hpde.skip-angle",
        help: "smallest angle I_c in degrees between a section and the rim",
        allowed: "a number from 0 to 45",
        get: |o| o.hpde.skip_angle.to_string(),
        set: |o, v| number(v, 0.0, 45.0).map(|v| o.hpde.skip_angle = v),
    },
    Parameter {
        name: "hpde.projection",
        help: "where points are triangulated: on one plane or two, on the sections side by side, or what fits first",
        allowed: "auto, planes or sections",
        get: |o| name_of(PROJECTIONS, o.hpde.projection),
        set: |o, v| named(PROJECTIONS, v).map(|v| o.hpde.projection = v),
    },
    Parameter {
        name: "hpde.smoothing",
        help: "smooth the patch",
        allowed: "on or off",
        get: |o| switch_name(o.hpde.smoothing),
        set: |o, v| switch(v).map(|v| o.hpde.smoothing = v),
    },
    Parameter {
        name: "hpde.smoothing-steps",
        help: "steps of smoothing, NumSmooth",
        allowed: "an integer from 0 to 10000",
        get: |o| o.hpde.smoothing_steps.to_string(),
        set: |o, v| number(v, 0, 10_000).map(|v| o.hpde.smoothing_steps = v),
    },
    Parameter {
        name: "hpde.shortest-edge",
        help: "shorter edges are collapsed, in mean edge lengths of the surroundings",
        allowed: "a number from 0 to 1",
        get: |o| o.hpde.shortest_edge.to_string(),
        set: |o, v| number(v, 0.0, 1.0).map(|v| o.hpde.shortest_edge = v),
    },
    Parameter {
        name: "hpde.denoise",
        help: "steps of smoothing of what is read of the surroundings, for noisy scans; the mesh itself stays",
        allowed: "an integer from 0 to 1000",
        get: |o| o.hpde.denoise.to_string(),
        set: |o, v| number(v, 0, 1000).map(|v| o.hpde.denoise = v),
    },
];
