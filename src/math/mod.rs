//! Mathematics without meshes: vectors, planes, boxes, search trees, random numbers, linear solvers.

pub(crate) mod aabb;
pub(crate) mod adjacency;
mod background;
pub(crate) mod box_tree;
mod envelope;
pub(crate) mod frame;
pub(crate) mod least_squares;
pub(crate) mod plane;
pub(crate) mod random;
pub(crate) mod segments;
pub(crate) mod sparse;
pub(crate) mod symmetric;

/// A point or direction; the type that all geometry is computed in.
pub(crate) type Vec3 = nalgebra::Vector3<f64>;

/// The vector along `v` of length one, or zero when `v` is too short to have a direction.
pub(crate) fn unit(v: Vec3) -> Vec3 {
    let length = v.norm();
    if length > f64::MIN_POSITIVE {
        v / length
    } else {
        Vec3::zeros()
    }
}

/// Twice the area of the triangle times its unit normal (counter-clockwise seen from the tip).
pub(crate) fn cross_normal(a: &Vec3, b: &Vec3, c: &Vec3) -> Vec3 {
    (b - a).cross(&(c - a))
}
