//! The star of a point: the triangles round it in the Delaunay triangulation of its tangent plane.
//!
//! The neighbors of the point are mapped to its tangent plane, and its Delaunay neighbors there are kept. They are
//! inserted one by one, nearest first, into a cyclic list. Only triangles at the point itself are computed. Points on a
//! common circle are always triangulated from the point with the lowest index, so that the stars of a regular grid
//! agree.
//!
//! Source: M. Gopi, S. Krishnan, C. Silva, Surface reconstruction based on lower dimensional localized
//! Delaunay triangulation, Eurographics 2000.
//!
//! Complexity: O(k d) for k neighbors and d Delaunay neighbors.

use super::tangent::{Tangent, TangentPlace, in_circle, is_between, turn};
use crate::math::Vec3;

/// The Delaunay neighbors of a point in its tangent plane, counter-clockwise.
pub(super) struct Star {
    center: u32,
    ring: Vec<(u32, TangentPlace)>,
}

impl Star {
    /// The star of `center` among `neighbors`, nearest first.
    pub(super) fn new(
        center: u32,
        tangent: &Tangent,
        neighbors: impl Iterator<Item = (u32, Vec3)>,
    ) -> Self {
        let mut star = Self::empty(center);
        for (index, position) in neighbors {
            if let Some(place) = tangent.place(&position) {
                star.insert(index, place);
            }
        }
        star
    }

    /// A star without triangles.
    pub(super) fn empty(center: u32) -> Self {
        Self {
            center,
            ring: Vec::new(),
        }
    }

    /// The pairs of ring vertices that form a triangle with the center, counter-clockwise.
    pub(super) fn sectors(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let count = self.ring.len();
        (0..count).filter_map(move |k| {
            let (a, p) = self.ring[k];
            let (b, q) = self.ring[(k + 1) % count];
            (turn(p, q) > 0.0).then_some([a, b])
        })
    }

    /// Whether the triangles surround the center.
    pub(super) fn is_closed(&self) -> bool {
        self.ring.len() >= 3 && self.sectors().count() == self.ring.len()
    }

    fn insert(&mut self, index: u32, place: TangentPlace) {
        let Some(at) = self.slot(place) else {
            return;
        };
        let count = self.ring.len();
        if count >= 2 {
            let before = self.ring[(at + count - 1) % count];
            let after = self.ring[at % count];
            if turn(before.1, after.1) > 0.0 && !self.prefers((index, place), before, after) {
                return;
            }
        }
        self.ring.insert(at, (index, place));
        self.drop_after(index);
        self.drop_before(index);
    }

    /// The position of `place` in the ring; `None` when it lies behind a neighbor in the same direction.
    fn slot(&self, place: TangentPlace) -> Option<usize> {
        let is_behind =
            |p: TangentPlace| turn(p, place) == 0.0 && p.x * place.x + p.y * place.y > 0.0;
        if self.ring.iter().any(|&(_, p)| is_behind(p)) {
            return None;
        }
        let count = self.ring.len();
        if count <= 1 {
            return Some(count);
        }
        (0..count).find_map(|k| {
            let (p, q) = (self.ring[k].1, self.ring[(k + 1) % count].1);
            let is_inside = if turn(p, q) > 0.0 {
                is_between(p, place, q)
            } else {
                // The gap is half a turn or more: it is the complement of the other sector.
                !is_between(q, place, p)
            };
            is_inside.then_some(k + 1)
        })
    }

    /// Whether `x` is a Delaunay neighbor of the center, given the neighbors `a` and `b` on its two sides.
    fn prefers(
        &self,
        x: (u32, TangentPlace),
        a: (u32, TangentPlace),
        b: (u32, TangentPlace),
    ) -> bool {
        let inside = in_circle(a.1, b.1, x.1);
        if inside == 0.0 {
            // On a common circle, the diagonal starts at the lowest index.
            self.center.min(x.0) < a.0.min(b.0)
        } else {
            inside > 0.0
        }
    }

    /// Removes the neighbors after `index` that are no Delaunay neighbors any more.
    fn drop_after(&mut self, index: u32) {
        while self.ring.len() >= 3 {
            let count = self.ring.len();
            let Some(at) = self.position(index) else {
                return;
            };
            let next = (at + 1) % count;
            let far = (at + 2) % count;
            if !self.is_cut_off(at, next, far) {
                return;
            }
            self.ring.remove(next);
        }
    }

    /// Removes the neighbors before `index` that are no Delaunay neighbors any more.
    fn drop_before(&mut self, index: u32) {
        while self.ring.len() >= 3 {
            let count = self.ring.len();
            let Some(at) = self.position(index) else {
                return;
            };
            let next = (at + count - 1) % count;
            let far = (at + count - 2) % count;
            if !self.is_cut_off(far, next, at) {
                return;
            }
            self.ring.remove(next);
        }
    }

    /// Whether the ring vertex `middle`, between two others, is no Delaunay neighbor of the center any more.
    fn is_cut_off(&self, before: usize, middle: usize, after: usize) -> bool {
        let [a, x, b] = [before, middle, after].map(|k| self.ring[k]);
        turn(a.1, x.1) > 0.0
            && turn(x.1, b.1) > 0.0
            && turn(a.1, b.1) > 0.0
            && !self.prefers(x, a, b)
    }

    fn position(&self, index: u32) -> Option<usize> {
        self.ring.iter().position(|&(other, _)| other == index)
    }
}
