//! The distance from a point to a set of line segments, with an index for many segments.

use super::Vec3;
use super::aabb::Aabb;
use super::box_tree::BoxTree;
use crate::error::Result;
use crate::job::Job;

/// The point of the segment from `a` to `b` closest to `p`.
pub(crate) fn closest_on_segment(p: &Vec3, a: &Vec3, b: &Vec3) -> Vec3 {
    let direction = b - a;
    let length_sq = direction.norm_squared();
    if length_sq > 0.0 {
        let share = (direction.dot(&(p - a)) / length_sq).clamp(0.0, 1.0);
        a + direction * share
    } else {
        *a
    }
}

/// Line segments with an index for searches by distance.
pub(crate) struct Segments {
    ends: Vec<[Vec3; 2]>,
    tree: BoxTree,
}

impl Segments {
    /// Indexes the segments, which must be finite. O(n log n).
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(crate) fn new(ends: Vec<[Vec3; 2]>, job: &Job<'_>) -> Result<Self> {
        let tree = BoxTree::build(ends.len(), |i| Aabb::around(&ends[i]), job)?;
        Ok(Self { ends, tree })
    }

    /// Squared distance from `p`, which must be finite, to the nearest segment; infinite when there is none.
    pub(crate) fn distance_sq(&self, p: &Vec3) -> f64 {
        let mut nearest = f64::INFINITY;
        self.tree.search_near(p, |i| {
            let [a, b] = &self.ends[i as usize];
            nearest = nearest.min((p - closest_on_segment(p, a, b)).norm_squared());
            nearest
        });
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn no_segment_is_infinitely_far() {
        assert_eq!(
            Segments::new(Vec::new(), &Job::unlimited())
                .unwrap()
                .distance_sq(&Vec3::zeros()),
            f64::INFINITY
        );
    }

    proptest! {
        #[test]
        fn the_nearest_segment_is_found(
            ends in proptest::collection::vec(([-9.0..9.0, -9.0..9.0, -9.0..9.0], [-9.0..9.0, -9.0..9.0, -9.0..9.0]), 1..60),
            p in [-12.0..12.0, -12.0..12.0, -12.0..12.0],
        ) {
            let ends: Vec<[Vec3; 2]> = ends.into_iter().map(|(a, b)| [a.into(), b.into()]).collect();
            let p = Vec3::from(p);
            let expected = ends
                .iter()
                .map(|[a, b]| (p - closest_on_segment(&p, a, b)).norm_squared())
                .fold(f64::INFINITY, f64::min);
            prop_assert_eq!(Segments::new(ends, &Job::unlimited()).unwrap().distance_sq(&p), expected);
        }
    }
}
