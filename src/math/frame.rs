//! Frames: two axes across a direction.

use super::{Vec3, unit};

/// Two unit vectors that make a right-handed frame with the unit vector `direction`; zeros when that is zero.
pub(crate) fn axes_across(direction: &Vec3) -> [Vec3; 2] {
    // The axis that the direction has least of gives the best conditioned product.
    let u = unit(direction.cross(&Vec3::ith(direction.iamin(), 1.0)));
    [u, direction.cross(&u)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_perpendicular_and_turn_to_the_right() {
        for direction in [Vec3::x(), -Vec3::z(), unit(Vec3::new(1.0, -2.0, 3.0))] {
            let [u, v] = axes_across(&direction);
            assert!(u.dot(&direction).abs() < 1e-15 && (u.norm() - 1.0).abs() < 1e-15);
            assert!((u.cross(&v) - direction).norm() < 1e-15);
        }
        assert_eq!(axes_across(&Vec3::zeros()), [Vec3::zeros(); 2]);
    }
}
