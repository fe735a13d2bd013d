//! The domain of a height field: the reference plane or a fitted sphere, with coordinates `u`, `v` and a height.
//!
//! The plane is that of least squares (J. Wang, M. M. Oliveira, "Filling holes on locally smooth surfaces reconstructed
//! from point clouds", 2007, eq. 8). The sphere is fitted to the normals of triangles; it is not in the paper. Cost:
//! linear in the number of points. Not guaranteed: that the projection to the domain is one-to-one.

use super::vicinity::Vicinity;
use crate::error::{Error, Result};
use crate::math::{Vec3, cross_normal, unit};
use crate::triangulate::simple_polygon::Point2;
use nalgebra::{Matrix3, SymmetricEigen};

/// Upper bound on the radius of the fitted sphere, in extents of the vicinity. With a larger radius, the sphere rises
/// over the vicinity by less than two thousandths of its extent, which is nearly flat.
const FLAT_RADIUS: f64 = 64.0;

/// A point in the coordinates of a domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) uv: Point2,
    pub(crate) height: f64,
}

/// The domain. The rim is counter-clockwise in its coordinates.
#[derive(Clone, Debug)]
pub(crate) enum Domain {
    /// Orthographic projection along the third axis.
    Plane {
        origin: Vec3,
        /// Rows are the axes U, V and S.
        axes: Matrix3<f64>,
    },
    /// Central projection to a sphere. The coordinates are those of Lambert's azimuthal projection round a pole, which
    /// preserves areas. The height is the distance from the center.
    Sphere {
        center: Vec3,
        radius: f64,
        /// The third row is the direction of the pole.
        axes: Matrix3<f64>,
    },
}

impl Domain {
    /// The least squares plane of the vicinity (eq. 8), with its normal on the side that the patch faces. `rim` is the
    /// polygon that bounds the patch.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Geometry`] when the rim encloses no area in the plane.
    pub(crate) fn plane(vicinity: &Vicinity, rim: &[Vec3]) -> Result<Self> {
        let origin = vicinity.points.iter().sum::<Vec3>() / vicinity.points.len().max(1) as f64;
        let mut scatter = Matrix3::zeros();
        for p in &vicinity.points {
            let d = p - origin;
            scatter += d * d.transpose();
        }
        let eigen = SymmetricEigen::new(scatter);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let [u, _, s] = order.map(|k| eigen.eigenvectors.column(k).into_owned());
        let facing = vector_area(rim).dot(&s);
        if !facing.is_finite() || facing == 0.0 {
            let message = "the rim encloses no area in the reference plane";
            return Err(Error::geometry(message));
        }
        Ok(Self::Plane {
            origin,
            axes: axes(u, s * facing.signum()),
        })
    }

    /// The sphere that fits the normals of the vicinity's triangles best. With the centroids `x` of the triangles and
    /// their normals `n`, the center `c` and the signed radius `r` minimize the sum of `area · |x - c - r n|²`. The
    /// pole lies in the direction that the patch faces.
    ///
    /// # Errors
    /// [`ErrorKind::Geometry`] when there is no such sphere, or it is nearly flat.
    pub(crate) fn sphere(vicinity: &Vicinity, rim: &[Vec3]) -> Result<Self> {
        let flat = || Error::geometry("the vicinity is not curved like a sphere");
        let faces: Vec<(Vec3, Vec3, f64)> = vicinity
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| vicinity.points[v as usize]);
                let normal = cross_normal(&a, &b, &c);
                ((a + b + c) / 3.0, unit(normal), normal.norm())
            })
            .collect();
        let weight: f64 = faces.iter().map(|f| f.2).sum();
        let mean = |of: fn(&(Vec3, Vec3, f64)) -> Vec3| {
            faces.iter().map(|f| of(f) * f.2).sum::<Vec3>() / weight
        };
        let (x, n) = (mean(|f| f.0), mean(|f| f.1));
        let moment: f64 = faces.iter().map(|f| f.2 * (f.0 - x).dot(&(f.1 - n))).sum();
        let spread: f64 = faces.iter().map(|f| f.2 * (f.1 - n).norm_squared()).sum();
        let radius = moment / spread;
        let extent = vicinity
            .points
            .iter()
            .map(|p| (p - x).norm())
            .fold(0.0, f64::max);
        if !radius.is_finite() || radius.abs() > FLAT_RADIUS * extent || radius == 0.0 {
            return Err(flat());
        }
        let center = x - radius * n;
        let pole = unit(vector_area(rim)) * radius.signum();
        if pole == Vec3::zeros() {
            return Err(flat());
        }
        // Any axis perpendicular to the pole will do. This one is far from parallel to it.
        let across = Vec3::ith(pole.iamin(), 1.0);
        let mut axes = axes(across - pole * pole.dot(&across), pole);
        if radius < 0.0 {
            // The patch faces the center and is seen from there, so the orientation is reversed.
            axes.row_mut(1).neg_mut();
        }
        Ok(Self::Sphere {
            center,
            radius: radius.abs(),
            axes,
        })
    }

    /// The coordinates of a point in the domain.
    pub(crate) fn place(&self, p: &Vec3) -> Place {
        match self {
            Self::Plane { origin, axes } => {
                let q = axes * (p - origin);
                Place {
                    uv: [q.x, q.y],
                    height: q.z,
                }
            }
            Self::Sphere {
                center,
                radius,
                axes,
            } => {
                let q = axes * (p - center);
                let height = q.norm();
                let direction = unit(q);
                // Lambert's azimuthal projection: 2 r sin(θ/2) from the pole.
                let across = direction.x.hypot(direction.y);
                let angle = across.atan2(direction.z);
                let stretch = if across > 0.0 {
                    2.0 * radius * (angle / 2.0).sin() / across
                } else {
                    *radius
                };
                Place {
                    uv: [direction.x * stretch, direction.y * stretch],
                    height,
                }
            }
        }
    }

    /// The point with given coordinates; the inverse of [`Self::place`].
    pub(crate) fn point(&self, place: &Place) -> Vec3 {
        let [u, v] = place.uv;
        match self {
            Self::Plane { origin, axes } => origin + axes.tr_mul(&Vec3::new(u, v, place.height)),
            Self::Sphere {
                center,
                radius,
                axes,
            } => {
                let distance = u.hypot(v);
                let angle = 2.0 * (distance / (2.0 * radius)).min(1.0).asin();
                let shrink = if distance > 0.0 {
                    angle.sin() / distance
                } else {
                    0.0
                };
                let direction = Vec3::new(u * shrink, v * shrink, angle.cos());
                center + axes.tr_mul(&(direction * place.height))
            }
        }
    }
}

/// A right-handed frame with the rows U, V and S. `s` is the third axis, a unit vector; `u` is perpendicular to it.
fn axes(u: Vec3, s: Vec3) -> Matrix3<f64> {
    let u = unit(u);
    let v = s.cross(&u);
    Matrix3::from_rows(&[u.transpose(), v.transpose(), s.transpose()])
}

/// The area vector of a closed polygon. Its length is the largest area of a projection, and it is the direction of that
/// projection.
fn vector_area(polygon: &[Vec3]) -> Vec3 {
    let start = polygon.first().copied().unwrap_or_default();
    polygon
        .windows(2)
        .map(|w| (w[0] - start).cross(&(w[1] - start)))
        .sum::<Vec3>()
        / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A band of a sphere of this radius round its pole, bounded by a circle at `from` radians; triangles face
    /// outward, or inward.
    fn band(radius: f64, from: f64, is_outward: bool) -> (Vicinity, Vec<Vec3>) {
        let (n, rows) = (24, 3);
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, -0.9, 2.0);
        let shift = Vec3::new(3.0, -1.0, 2.0);
        let at = |row: usize, i: usize| {
            let (theta, phi) = (
                from + 0.1 * row as f64,
                std::f64::consts::TAU * i as f64 / n as f64,
            );
            let p = Vec3::new(
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            );
            turn * (p * radius) + shift
        };
        let mut vicinity = Vicinity {
            vertices: (0..n as u32).collect(),
            points: (0..rows * n).map(|k| at(k / n, k % n)).collect(),
            triangles: Vec::new(),
            step: 0.1 * radius,
        };
        for row in 0..rows as u32 - 1 {
            for i in 0..n as u32 {
                let v = |r: u32, i: u32| (row + r) * n as u32 + i % n as u32;
                vicinity.triangles.push([v(0, i), v(1, i), v(0, i + 1)]);
                vicinity.triangles.push([v(0, i + 1), v(1, i), v(1, i + 1)]);
            }
        }
        let mut rim: Vec<Vec3> = vicinity.points[..n].to_vec();
        if !is_outward {
            vicinity.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            rim.reverse();
        }
        (vicinity, rim)
    }

    fn signed_area(polygon: &[Point2]) -> f64 {
        let n = polygon.len();
        let cross = |i: usize| {
            let (p, q) = (polygon[i], polygon[(i + 1) % n]);
            p[0] * q[1] - p[1] * q[0]
        };
        (0..n).map(cross).sum::<f64>() / 2.0
    }

    #[test]
    fn a_sphere_is_found_from_either_side_and_beyond_the_equator() {
        for (radius, from) in [(1.0, 0.5), (20.0, 1.2), (3.0, 2.2)] {
            for is_outward in [true, false] {
                let (vicinity, rim) = band(radius, from, is_outward);
                let domain = Domain::sphere(&vicinity, &rim).unwrap();
                let places: Vec<Place> = vicinity.points.iter().map(|p| domain.place(p)).collect();
                for place in &places {
                    assert!((place.height / radius - 1.0).abs() < 0.02, "{place:?}");
                }
                // The rim runs counter-clockwise, and so do the triangles outside of it.
                let uv: Vec<Point2> = rim.iter().map(|p| domain.place(p).uv).collect();
                let expected = 2.0 * std::f64::consts::PI * radius * radius * (1.0 - from.cos());
                assert!((signed_area(&uv) / expected - 1.0).abs() < 0.05);
                for t in &vicinity.triangles {
                    assert!(signed_area(&t.map(|v| places[v as usize].uv)) > 0.0);
                }
            }
        }
    }

    #[test]
    fn a_plane_has_the_patch_counter_clockwise() {
        for is_outward in [true, false] {
            let (vicinity, rim) = band(2.0, 0.6, is_outward);
            let domain = Domain::plane(&vicinity, &rim).unwrap();
            let uv: Vec<Point2> = rim.iter().map(|p| domain.place(p).uv).collect();
            assert!(signed_area(&uv) > 0.0);
            let heights: Vec<f64> = rim.iter().map(|p| domain.place(p).height).collect();
            assert!(heights.iter().all(|h| (h - heights[0]).abs() < 1e-9));
        }
    }

    #[test]
    fn what_is_flat_has_no_sphere() {
        let (mut vicinity, mut rim) = band(1.0, 0.5, true);
        vicinity.points.iter_mut().for_each(|p| p.z = 0.0);
        rim.iter_mut().for_each(|p| p.z = 0.0);
        assert!(Domain::sphere(&vicinity, &rim).is_err());
        rim.iter_mut().for_each(|p| p.y = 0.0);
        vicinity.points.iter_mut().for_each(|p| p.y = 0.0);
        assert!(Domain::plane(&vicinity, &rim).is_err());
    }

    proptest! {
        #[test]
        fn a_place_leads_back_to_its_point(p in [-4.0..4.0, -4.0..4.0, -4.0..4.0]) {
            let p = Vec3::from(p);
            let (vicinity, rim) = band(1.5, 1.0, true);
            for domain in [Domain::plane(&vicinity, &rim), Domain::sphere(&vicinity, &rim)] {
                let domain = domain.unwrap();
                prop_assert!((domain.point(&domain.place(&p)) - p).norm() < 1e-9);
            }
        }
    }
}
