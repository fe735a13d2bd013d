//! The tangent plane of a point: the map of its neighbors to the plane, and predicates there.
//!
//! The map keeps the distance of a neighbor from the point and its direction round the normal, so that a curved surface
//! is not compressed. Predicates are exact for the coordinates in the plane (the crate `robust`).
//!
//! Source: M. Gopi, S. Krishnan, C. Silva, Surface reconstruction based on lower dimensional localized Delaunay
//! triangulation, Eurographics 2000, section 4.1.

use crate::math::Vec3;
use crate::math::frame::axes_across;
use robust::Coord;

/// Upper bound on the slope of the line to a neighbor against the tangent plane, as a tangent: 60°. A steeper line
/// leads to another sheet of the surface.
const STEEPEST: f64 = 1.732;

/// A place in a tangent plane; the point that the plane belongs to is the origin.
pub(super) type TangentPlace = Coord<f64>;

pub(super) const ORIGIN: TangentPlace = Coord { x: 0.0, y: 0.0 };

/// An orthonormal frame at a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    origin: Vec3,
    pub(super) normal: Vec3,
    u: Vec3,
    v: Vec3,
}

impl Tangent {
    /// The frame at `origin`; seen against `normal`, a unit vector, angles run counter-clockwise.
    pub(super) fn new(origin: Vec3, normal: Vec3) -> Self {
        let [u, v] = axes_across(&normal);
        Self {
            origin,
            normal,
            u,
            v,
        }
    }

    /// The position of `point` in the plane; `None` when it lies too steeply above or below the plane.
    pub(super) fn place(&self, point: &Vec3) -> Option<TangentPlace> {
        let d = point - self.origin;
        let (x, y, height) = (d.dot(&self.u), d.dot(&self.v), d.dot(&self.normal));
        let flat = x.hypot(y);
        if flat.is_nan() || flat == 0.0 || height.abs() > STEEPEST * flat {
            return None;
        }
        let stretch = flat.hypot(height) / flat;
        Some(TangentPlace {
            x: x * stretch,
            y: y * stretch,
        })
    }
}

/// Positive when the turn from `a` to `b` round the origin is to the left and less than half a turn.
pub(super) fn turn(a: TangentPlace, b: TangentPlace) -> f64 {
    robust::orient2d(ORIGIN, a, b)
}

/// Positive when `d` lies inside the circle through the origin, `a` and `b`, which turn left.
pub(super) fn in_circle(a: TangentPlace, b: TangentPlace, d: TangentPlace) -> f64 {
    robust::incircle(ORIGIN, a, b, d)
}

/// Whether the direction of `x` lies strictly between those of `a` and `b`, which turn left.
pub(super) fn is_between(a: TangentPlace, x: TangentPlace, b: TangentPlace) -> bool {
    turn(a, x) > 0.0 && turn(x, b) > 0.0
}

/// Whether two open sectors, each of less than half a turn to the left, overlap.
pub(super) fn sectors_overlap([a, b]: [TangentPlace; 2], [c, d]: [TangentPlace; 2]) -> bool {
    let is_same_direction =
        |p: TangentPlace, q: TangentPlace| turn(p, q) == 0.0 && p.x * q.x + p.y * q.y > 0.0;
    is_between(a, c, b)
        || is_between(a, d, b)
        || is_between(c, a, d)
        || is_between(c, b, d)
        || (is_same_direction(a, c) && is_same_direction(b, d))
}
