//! What the library knows of a method.

use super::method::Method;
use super::task::Task;
use crate::error::Result;
use crate::math::Vec3;
use crate::options::FillOptions;
use crate::patch::PatchSurface;
use crate::surroundings::Surroundings;

/// All that the rest of the library knows of a method.
pub(crate) struct MethodSpec {
    /// The name used on the command line and in reports.
    pub(crate) name: &'static str,
    /// How much of the mesh round a hole the method reads.
    pub(crate) reach: fn(&FillOptions) -> HoleReach,
    /// The methods that are tried in turn when a patch of this one cannot be used.
    pub(crate) falls_back_to: &'static [Method],
    /// How far a patch may go from the middle of the rim, in diameters of the rim.
    pub(crate) farthest: f64,
    /// Whether the method needs a rim that bounds a disk which no other rim pierces.
    pub(crate) needs_unlinked_rim: bool,
    /// Makes the patch, in the hole's coordinates. It is verified afterwards.
    pub(crate) make: fn(&Task<'_>) -> Result<PatchSurface>,
    /// How the method itself extends attribute values into its patch, if it does.
    pub(crate) extension: Option<Extension>,
}

impl MethodSpec {
    /// What most methods have in common; they give the name and `make` besides.
    pub(crate) const USUAL: Self = Self {
        name: "",
        reach: |_| HoleReach::rings(1),
        falls_back_to: &[],
        farthest: FARTHEST,
        needs_unlinked_rim: false,
        make: |_| Err(crate::error::Error::invalid("this method makes no patch")),
        extension: None,
    };
}

/// A patch that goes further from the middle of its rim than this many diameters of the rim has run away: half a
/// sphere goes 0.35, two thirds of one 0.61.
const FARTHEST: f64 = 0.75;

/// The methods after one that predicts the surface.
pub(crate) const STAIRCASE: &[Method] = &[
    Method::FairC2,
    Method::FairC1,
    Method::Membrane,
    Method::Flat,
];

/// Makes a list of values for each channel: see [`Extension::extend`].
type Extend = fn(&Task<'_>, &Surroundings, &[Vec<f64>], &[Vec3]) -> Result<Vec<Vec<f64>>>;

/// How a method extends values that are known round a hole into its patch.
pub(crate) struct Extension {
    /// How much of the mesh is read.
    pub(crate) reach: fn(&FillOptions) -> HoleReach,
    /// The values at the points given last: a list for each channel. Known are, for each channel, the values at the
    /// rim and then at the points of the surroundings.
    pub(crate) extend: Extend,
}

/// How much of the mesh round a hole a method reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HoleReach {
    /// Rings of triangles, all of each.
    pub(crate) rings: u32,
    /// Besides, the triangles that touch a vertex nearer to the rim than so many sampling steps (see
    /// [`Surroundings::sampling_step`]).
    pub(crate) steps: f64,
}

impl HoleReach {
    /// So many rings, and no more.
    pub(crate) fn rings(rings: u32) -> Self {
        Self { rings, steps: 0.0 }
    }

    /// What covers both.
    pub(crate) fn union(self, other: Self) -> Self {
        Self {
            rings: self.rings.max(other.rings),
            steps: self.steps.max(other.steps),
        }
    }
}
