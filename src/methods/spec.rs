//! [`MethodSpec`], the interface between a method and the rest of the library.

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
    /// Upper bound on the distance of a patch vertex from the middle of the rim's bounding box, in diagonals of that
    /// box.
    pub(crate) farthest: f64,
    /// Whether the method cannot fill a hole whose rim is linked with another rim, like two links of a chain.
    pub(crate) needs_unlinked_rim: bool,
    /// Makes the patch, in the hole's coordinates. The caller verifies it.
    pub(crate) make: fn(&Task<'_>) -> Result<PatchSurface>,
    /// How the method extends attribute values into its patch, if it does so itself.
    pub(crate) extension: Option<Extension>,
}

impl MethodSpec {
    /// Defaults for most methods. A method adds at least its name and `make`.
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

/// The usual value of [`MethodSpec::farthest`]. A patch that goes further has failed. Half a sphere on a round rim
/// needs 0.35, two thirds of a sphere 0.61.
const FARTHEST: f64 = 0.75;

/// The fallbacks of a method that predicts the missing surface.
pub(crate) const STAIRCASE: &[Method] = &[
    Method::FairC2,
    Method::FairC1,
    Method::Membrane,
    Method::Flat,
];

/// The type of [`Extension::extend`].
type Extend = fn(&Task<'_>, &Surroundings, &[Vec<f64>], &[Vec3]) -> Result<Vec<Vec<f64>>>;

/// How a method extends attribute values round a hole into its patch.
pub(crate) struct Extension {
    /// How much of the mesh is read.
    pub(crate) reach: fn(&FillOptions) -> HoleReach,
    /// Computes the values at given points. Arguments: the task, the surroundings, the known values, the points. The
    /// known values are one list for each channel, for the rim vertices and then the points of the surroundings. The
    /// result is one list for each channel.
    pub(crate) extend: Extend,
}

/// How much of the mesh round a hole a method reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HoleReach {
    /// Number of complete rings of triangles.
    pub(crate) rings: u32,
    /// In addition, the triangles with a vertex nearer to the rim than this. Unit: the sampling step, see
    /// [`Surroundings::sampling_step`].
    pub(crate) steps: f64,
}

impl HoleReach {
    /// The given number of rings, and no more.
    pub(crate) fn rings(rings: u32) -> Self {
        Self { rings, steps: 0.0 }
    }

    /// The smallest reach that covers both.
    pub(crate) fn union(self, other: Self) -> Self {
        Self {
            rings: self.rings.max(other.rings),
            steps: self.steps.max(other.steps),
        }
    }
}
