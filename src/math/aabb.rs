//! Axis-aligned boxes.

use super::Vec3;

/// An axis-aligned box; empty when a lower bound exceeds its upper bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    /// Smallest coordinates.
    pub(crate) lo: Vec3,
    /// Largest coordinates.
    pub(crate) hi: Vec3,
}

impl Aabb {
    /// The box of no point at all.
    pub(crate) fn empty() -> Self {
        Self {
            lo: Vec3::repeat(f64::INFINITY),
            hi: Vec3::repeat(f64::NEG_INFINITY),
        }
    }

    /// The smallest box round some points.
    pub(crate) fn around(points: &[Vec3]) -> Self {
        points.iter().fold(Self::empty(), |b, p| Self {
            lo: b.lo.inf(p),
            hi: b.hi.sup(p),
        })
    }

    /// The smallest box round both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            lo: self.lo.inf(&other.lo),
            hi: self.hi.sup(&other.hi),
        }
    }

    /// Whether no point of the other box lies outside this one.
    pub(crate) fn contains(&self, other: &Self) -> bool {
        (0..3).all(|k| self.lo[k] <= other.lo[k] && other.hi[k] <= self.hi[k])
    }

    /// The box with `margin` more on each side.
    pub(crate) fn grown(&self, margin: f64) -> Self {
        Self {
            lo: self.lo.add_scalar(-margin),
            hi: self.hi.add_scalar(margin),
        }
    }

    /// Whether the boxes share a point.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        // No short-circuits: six comparisons are cheaper than one mispredicted branch.
        let mut overlap = true;
        for k in 0..3 {
            overlap &= self.lo[k] <= other.hi[k];
            overlap &= other.lo[k] <= self.hi[k];
        }
        overlap
    }
}
