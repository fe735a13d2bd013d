//! Step 2, second half: decides whether the rim is cut into two parts that each lie near a plane.
//!
//! The best cut minimizes the larger one of the smallest variances of its two parts. It is used if the two planes meet
//! at a sharp angle. Some places are tried as ends of the cut first, then places near the best ones.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, section 4.2, equation 8. `O(n)` for `n` base points; the number of tries is bounded.
//! Not guaranteed for more than [`COARSE`] base points: that the cut is the best of all.

use super::base_points::BasePoint;
use crate::math::{Vec3, unit};
use nalgebra::{Matrix3, SymmetricEigen};

/// Number of places that are tried first as ends of a cut.
const COARSE: usize = 48;

/// Lower bound on the base points of a part. Three always lie in a plane.
const SMALLEST_PART: usize = 4;

/// Tolerance for rounding errors of an angle, in degrees.
const ROUNDING: f64 = 1e-6;

/// A cut of the base points into two parts: `first..second`, and the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cut {
    pub(super) first: usize,
    pub(super) second: usize,
}

/// Lower bound on the cosine of the angle between the plane of a part and the mean normal of the surface there, 45°.
/// It excludes the cut of a strip into its two long sides: their variances are smallest, but their planes are
/// perpendicular to the surface.
const SHOWS_SURFACE: f64 = 0.7;

/// A plane with a unit normal that is oriented like the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) center: Vec3,
    pub(super) normal: Vec3,
}

/// The least squares plane of points that follow each other along the rim. Its normal is oriented by the area that the
/// points enclose.
pub(super) fn fit_plane(points: &[Vec3]) -> Plane {
    let count = points.len().max(1) as f64;
    let center = points.iter().sum::<Vec3>() / count;
    let mut scatter = Matrix3::zeros();
    let mut area = Vec3::zeros();
    for (i, p) in points.iter().enumerate() {
        let d = p - center;
        scatter += d * d.transpose();
        area += d.cross(&(points[(i + 1) % points.len()] - center));
    }
    let eigen = SymmetricEigen::new(scatter);
    let smallest = eigen.eigenvalues.imin();
    let axis: Vec3 = eigen.eigenvectors.column(smallest).into();
    let normal = if axis.dot(&area) < 0.0 { -axis } else { axis };
    Plane {
        center,
        normal: unit(normal),
    }
}

/// The cut of equation 8, if its planes meet in a dihedral angle of at most `critical` degrees.
pub(super) fn cut(base: &[BasePoint], critical: f64) -> Option<Cut> {
    let n = base.len();
    if n < 2 * SMALLEST_PART {
        return None;
    }
    let positions = |range: std::ops::Range<usize>| -> Vec<Vec3> {
        range.map(|k| base[k % n].position).collect()
    };
    let shows_surface = |range: std::ops::Range<usize>| {
        let normal: Vec3 = range.clone().map(|k| base[k % n].normal).sum();
        fit_plane(&positions(range)).normal.dot(&unit(normal)) >= SHOWS_SURFACE
    };
    let moments = PlaneMoments::new(base);
    let mut step = n.div_ceil(COARSE);
    let places: Vec<usize> = (0..n).step_by(step).collect();
    let mut best: Option<(f64, Cut)> = None;
    let mut consider = |first: usize, second: usize| {
        let size = second.wrapping_sub(first);
        if first < second && second <= n && size >= SMALLEST_PART && n - size >= SMALLEST_PART {
            let thickness = moments.thickness(first, second);
            if best.is_none_or(|(least, _)| thickness < least)
                && shows_surface(first..second)
                && shows_surface(second..n + first)
            {
                best = Some((thickness, Cut { first, second }));
            }
        }
        best.map(|(_, cut)| cut)
    };
    let mut around = None;
    for (k, &first) in places.iter().enumerate() {
        for &second in &places[k + 1..] {
            around = consider(first, second);
        }
    }
    while step > 1 {
        step /= 2;
        let center = around?;
        for i in [-1_isize, 0, 1] {
            for j in [-1_isize, 0, 1] {
                let moved = |at: usize, by: isize| at.checked_add_signed(by * step as isize);
                if let (Some(first), Some(second)) =
                    (moved(center.first, i), moved(center.second, j))
                {
                    around = consider(first, second);
                }
            }
        }
    }
    let found = around?;
    let inner = fit_plane(&positions(found.first..found.second));
    let outer = fit_plane(&positions(found.second..n + found.first));
    let between = inner.normal.angle(&outer.normal).to_degrees();
    (180.0 - between <= critical + ROUNDING).then_some(found)
}

/// Prefix sums of the coordinates of the base points and of their products.
struct PlaneMoments {
    sums: Vec<(Vec3, Matrix3<f64>)>,
}

impl PlaneMoments {
    fn new(base: &[BasePoint]) -> Self {
        let mut sums = vec![(Vec3::zeros(), Matrix3::zeros())];
        let (mut sum, mut products) = sums[0];
        for b in base {
            sum += b.position;
            products += b.position * b.position.transpose();
            sums.push((sum, products));
        }
        Self { sums }
    }

    /// The larger one of the smallest variances of the two parts, `first..second` and the rest.
    fn thickness(&self, first: usize, second: usize) -> f64 {
        let total = self.sums[self.sums.len() - 1];
        let (a, b) = (self.sums[first], self.sums[second]);
        let inner = (b.0 - a.0, b.1 - a.1);
        let outer = (total.0 - inner.0, total.1 - inner.1);
        let size = second - first;
        let rest = self.sums.len() - 1 - size;
        smallest_variance(&inner, size).max(smallest_variance(&outer, rest))
    }
}

fn smallest_variance((sum, products): &(Vec3, Matrix3<f64>), count: usize) -> f64 {
    let mean = sum / count as f64;
    let covariance = products / count as f64 - mean * mean.transpose();
    covariance.symmetric_eigenvalues().min()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of 8 by 4 folded along the middle of its long sides by `bend` degrees.
    fn folded(bend: f64) -> Vec<BasePoint> {
        let corners = [[-4.0, -2.0], [4.0, -2.0], [4.0, 2.0], [-4.0, 2.0]];
        let mut base = Vec::new();
        for k in 0..4 {
            let (a, b): ([f64; 2], [f64; 2]) = (corners[k], corners[(k + 1) % 4]);
            let count = if k % 2 == 0 { 16 } else { 8 };
            for i in 0..count {
                let s = f64::from(i) / f64::from(count);
                let (u, v) = (a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s);
                let turn = if u > 0.0 { bend.to_radians() } else { 0.0 };
                base.push(BasePoint {
                    position: Vec3::new(u * turn.cos(), v, -u * turn.sin()),
                    normal: Vec3::new(turn.sin(), 0.0, turn.cos()),
                    arc: 0.0,
                    edge: 0,
                });
            }
        }
        base
    }

    #[test]
    fn a_sharp_fold_is_cut_where_it_is() {
        let base = folded(100.0);
        let cut = cut(&base, 90.0).unwrap();
        let (a, b) = (base[cut.first].position, base[cut.second].position);
        assert!(a.x.abs() < 0.6 && a.z.abs() < 0.6, "{a}");
        assert!(b.x.abs() < 0.6 && b.z.abs() < 0.6, "{b}");
    }

    #[test]
    fn the_critical_angle_decides() {
        assert!(cut(&folded(80.0), 90.0).is_none());
        assert!(cut(&folded(80.0), 101.0).is_some());
        assert!(cut(&folded(90.0), 90.0).is_some());
        assert!(cut(&folded(0.0), 90.0).is_none());
    }

    #[test]
    fn the_normal_is_that_of_the_area_enclosed() {
        let positions: Vec<Vec3> = folded(0.0).iter().map(|b| b.position).collect();
        assert!((fit_plane(&positions).normal - Vec3::z()).norm() < 1e-12);
        let backward: Vec<Vec3> = positions.into_iter().rev().collect();
        assert!((fit_plane(&backward).normal + Vec3::z()).norm() < 1e-12);
    }
}
