//! One hole as plain data: what every method is given.

use crate::math::Vec3;
use crate::surroundings::Surroundings;

/// One opening cut out of its mesh, in coordinates of its own: the origin is the centroid of the rim, the unit is the
/// mean length of the rim's edges, so that neither the position nor the scale of the model enters the computation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hole {
    /// The rim, islands included, and the known triangles round it.
    pub(crate) surroundings: Surroundings,
    /// The closed polygon that bounds the patch, in the patch's orientation, as indices of rim vertices. With
    /// islands some of them occur in it twice.
    pub(crate) polygon: Vec<u32>,
    /// Unit normal of the known triangle at each polygon edge; `None` along the bridges to islands, and
    /// beside a triangle without area.
    pub(crate) outside_normals: Vec<Option<Vec3>>,
    /// Whether each polygon edge is a bridge between two rims, which the patch passes both ways.
    pub(crate) is_bridge: Vec<bool>,
    /// Mean length of the known edges at each rim vertex.
    pub(crate) edge_lengths: Vec<f64>,
    /// Sorted pairs (smaller first) of rim vertices that an edge of the mesh already joins.
    pub(crate) joined: Vec<(u32, u32)>,
}

impl Hole {
    /// Positions of the rim vertices.
    pub(crate) fn rim(&self) -> &[Vec3] {
        self.surroundings.rim()
    }

    /// The mean of the rim vertices, and twice the largest distance of one from it: the diameter of a round rim. Both turn
    /// with the hole, as the box of its points does not.
    pub(crate) fn middle_and_diameter(&self) -> (Vec3, f64) {
        let rim = self.rim();
        let middle = rim.iter().sum::<Vec3>() / rim.len().max(1) as f64;
        let farthest = rim.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
        (middle, 2.0 * farthest)
    }

    /// Four times the area that the polygon encloses, seen so that it is largest, over the polygon's length: the diameter
    /// of a round hole, twice the width of a slit or of a ring round an island. Bridges to islands count twice in the
    /// length.
    pub(crate) fn width(&self) -> f64 {
        let count = self.polygon.len();
        let corner = |i: usize| self.surroundings.point(self.polygon[i % count]);
        let (mut double_area, mut length) = (Vec3::zeros(), 0.0);
        for i in 0..count {
            let (from, to) = (corner(i), corner(i + 1));
            double_area += (from - corner(0)).cross(&(to - corner(0)));
            length += (to - from).norm();
        }
        if length > 0.0 {
            2.0 * double_area.norm() / length
        } else {
            0.0
        }
    }

    /// Whether an edge of the mesh already joins two rim vertices.
    pub(crate) fn is_joined(&self, a: u32, b: u32) -> bool {
        (a.max(b) as usize) < self.rim().len()
            && self.joined.binary_search(&(a.min(b), a.max(b))).is_ok()
    }
}
