//! One hole as plain data, and the piece of surface that closes it: what every method takes and returns.

#[cfg(test)]
mod check;
pub(crate) mod chords;
mod edit;
pub(crate) mod mesh;
#[cfg(test)]
mod tests;

use crate::math::{Vec3, cross_normal};

/// A triangulated surface over the rim of a hole: what triangulation returns and refinement and
/// fairing work on.
///
/// Vertices `0..rim_count` are the rim: they are fixed, and so are the boundary edges between
/// them. All further vertices are interior. Triangles are oriented like the mesh round the hole.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PatchSurface {
    /// Number of rim vertices, which come first.
    pub(crate) rim_count: usize,
    /// Positions of the rim and then of the interior vertices.
    pub(crate) points: Vec<Vec3>,
    /// Indices into `points`.
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// The known triangles next to a rim, through which methods read the surface round the hole.
///
/// Vertices below the rim count are those of the rim; the others index `points` after subtracting it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    /// Positions of the vertices that are not on the rim.
    pub(crate) points: Vec<Vec3>,
    /// Ring of each of `points`, from 1.
    pub(crate) levels: Vec<u32>,
    /// Triangles.
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// One hole in coordinates of its own: the origin is the centroid of the rim, the unit is the mean length of
/// the rim's edges, so that neither the position nor the scale of the model enters the computation.
#[derive(Clone, Debug, Default)]
pub(crate) struct HoleShape {
    /// Positions of the rim vertices, islands included.
    pub(crate) points: Vec<Vec3>,
    /// The closed polygon that bounds the patch, in the patch's orientation, as indices into `points`. With
    /// islands some rim vertices occur in it twice.
    pub(crate) polygon: Vec<u32>,
    /// Unit normal of the known triangle at each polygon edge; `None` along the bridges to islands, and
    /// beside a triangle without area.
    pub(crate) outside_normals: Vec<Option<Vec3>>,
    /// Mean length of the known edges at each rim vertex.
    pub(crate) edge_lengths: Vec<f64>,
    /// The known triangles round the rim.
    pub(crate) surroundings: Surroundings,
    /// Sorted pairs (smaller first) of rim vertices that an edge of the mesh already joins.
    pub(crate) joined: Vec<(u32, u32)>,
}

impl HoleShape {
    /// The position of a vertex of the rim or of the surroundings.
    pub(crate) fn point(&self, vertex: u32) -> Vec3 {
        let v = vertex as usize;
        match v.checked_sub(self.points.len()) {
            None => self.points[v],
            Some(outside) => self.surroundings.points[outside],
        }
    }

    /// The mean of the rim vertices, and twice the largest distance of one from it: the diameter of a round rim. Both turn
    /// with the hole, as the box of its points does not.
    pub(crate) fn middle_and_diameter(&self) -> (Vec3, f64) {
        let middle = self.points.iter().sum::<Vec3>() / self.points.len().max(1) as f64;
        let farthest = self
            .points
            .iter()
            .map(|p| (p - middle).norm())
            .fold(0.0, f64::max);
        (middle, 2.0 * farthest)
    }

    /// Four times the area that the polygon encloses, seen so that it is largest, over the polygon's length: the diameter
    /// of a round hole, twice the width of a slit or of a ring round an island. Bridges to islands count twice in the
    /// length.
    pub(crate) fn width(&self) -> f64 {
        let count = self.polygon.len();
        let corner = |i: usize| self.points[self.polygon[i % count] as usize];
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

    /// The spacing at which the surface next to the rim is sampled: `sqrt(A / (3 n))` with `A` the area of the
    /// triangles that touch one of the `n` rim vertices. About 0.54 of an edge where these are equilateral.
    ///
    /// From: J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed from point
    /// clouds", Image and Vision Computing 25(1), 2007, eq. 9.
    pub(crate) fn sampling_step(&self) -> f64 {
        let rim_count = self.points.len();
        let double_area: f64 = self
            .surroundings
            .triangles
            .iter()
            .filter(|t| t.iter().any(|&v| (v as usize) < rim_count))
            .map(|t| {
                let [a, b, c] = t.map(|v| self.point(v));
                cross_normal(&a, &b, &c).norm()
            })
            .sum();
        (double_area / 2.0 / (3.0 * rim_count as f64)).sqrt()
    }

    /// Whether an edge of the mesh already joins two rim vertices.
    pub(crate) fn is_joined(&self, a: u32, b: u32) -> bool {
        (a.max(b) as usize) < self.points.len()
            && self.joined.binary_search(&(a.min(b), a.max(b))).is_ok()
    }
}
