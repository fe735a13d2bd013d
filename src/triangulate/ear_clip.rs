//! Ear clipping of a polygon in space, cheapest ear first.
//!
//! An ear is the triangle of three successive positions. The ear with the lowest cost is cut off, until few enough
//! positions are left for a better method. The cost is the radius of the ear's circumscribed circle, or the length of
//! the new edge if that is larger. So ears as in a Delaunay triangulation come first, and ears along a densely sampled,
//! nearly straight rim come last. The cost is increased if the ear is bent against its two known neighbors, and more if
//! it does not face the same side as the rim, where it may fold over. This is our own combination of known ideas.
//!
//! Cost: time O(m log m), memory O(m). Not guaranteed: an optimum; freedom from folds and self-intersections where a
//! rim comes close to itself.

use super::polygon::{ChordRules, FlatnessTest, HolePolygon};
use crate::error::Result;
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Upper bound on the bend to a known neighbor, as 1 − cos of the angle between normals, that does not increase the
/// cost: about 45 degrees.
const FREE_TURN: f64 = 0.3;
/// Increase of the cost for each unit of bend above [`FREE_TURN`].
const TURN_PENALTY: f64 = 10.0;
/// Lower bound on the cosine between the normal of an ear and those of the rim edges that it replaces, 60 degrees.
/// Such an ear faces the same side as the rim.
const FACING_SHARE: f64 = 0.5;
/// Factor on the cost of an ear that does not face the same side as the rim. It is not a ban, because at the flat end
/// of a tube the normals at the rim mean nothing.
const DISTRUST: f64 = 8.0;

/// The result of ear clipping.
pub(super) struct Clipped {
    /// The ears as triangles of positions of the polygon, oriented like it.
    pub(super) ears: Vec<[u32; 3]>,
    /// The positions that are left, in ascending order. They form a polygon.
    pub(super) rest: Vec<u32>,
    /// Normal of the triangle across each edge of the rest, as in [`HolePolygon::outside_normals`].
    pub(super) rest_normals: Vec<Option<Vec3>>,
    /// Vertex pairs that ears joined and that other positions could join again. Each pair is in ascending order.
    pub(super) joined: BTreeSet<(u32, u32)>,
}

/// Cuts ears until `target` positions are left. More are left if no ear has an area and an allowed edge.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
pub(super) fn clip(
    polygon: &HolePolygon<'_>,
    rules: &ChordRules<'_>,
    target: usize,
    job: &Job<'_>,
) -> Result<Clipped> {
    let mut clipper = Clipper::new(polygon, rules);
    clipper.run(target.max(3), job)?;
    Ok(clipper.finish())
}

/// An entry of the queue. It is stale if the position was cut or has a newer version.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Ear {
    /// Whether the ear faces away from both the rim and the polygon. Such ears come last.
    is_folded: bool,
    /// The bits of the cost. It is not negative, so they sort like the number.
    cost: u64,
    position: u32,
    version: u32,
}

struct Clipper<'a> {
    polygon: &'a HolePolygon<'a>,
    rules: &'a ChordRules<'a>,
    flatness: FlatnessTest,
    next: Vec<u32>,
    previous: Vec<u32>,
    version: Vec<u32>,
    alive: Vec<bool>,
    /// Normal of the known triangle across the edge that starts at each position.
    normals: Vec<Option<Vec3>>,
    /// Sum of the normals of the rim edges that the edge from each position replaces. Unlike the normals of successive
    /// ears, it does not drift.
    facing: Vec<Vec3>,
    /// Direction of the polygon's area vector.
    axis: Vec3,
    queue: BinaryHeap<Reverse<Ear>>,
    ears: Vec<[u32; 3]>,
    joined: BTreeSet<(u32, u32)>,
}

impl<'a> Clipper<'a> {
    fn new(polygon: &'a HolePolygon<'a>, rules: &'a ChordRules<'a>) -> Self {
        let len = polygon.len();
        let axis = unit(area_vector(polygon.points));
        let mut clipper = Self {
            polygon,
            rules,
            flatness: FlatnessTest::new(polygon.points),
            next: (0..len).map(|i| ((i + 1) % len) as u32).collect(),
            previous: (0..len).map(|i| ((i + len - 1) % len) as u32).collect(),
            version: vec![0; len],
            alive: vec![true; len],
            normals: polygon.outside_normals.to_vec(),
            facing: guess_normals(polygon, axis),
            axis,
            queue: BinaryHeap::new(),
            ears: Vec::with_capacity(len),
            joined: BTreeSet::new(),
        };
        let entries: Vec<_> = (0..len as u32)
            .filter_map(|i| clipper.entry(i))
            .map(Reverse)
            .collect();
        clipper.queue = BinaryHeap::from(entries);
        clipper
    }

    fn ear_points(&self, position: u32) -> [&'a Vec3; 3] {
        let i = position as usize;
        [self.previous[i], position, self.next[i]].map(|p| &self.polygon.points[p as usize])
    }

    /// The queue entry of the ear; `None` if it must not be cut now.
    fn entry(&self, position: u32) -> Option<Ear> {
        let i = position as usize;
        let (before, after) = (self.previous[i] as usize, self.next[i] as usize);
        let [a, b, c] = self.ear_points(position);
        let doubled = cross_normal(a, b, c);
        let doubled_area_sq = doubled.norm_squared();
        if self.flatness.is_flat(doubled_area_sq, [a, b, c]) || !self.may_join(before, after) {
            return None;
        }
        let normal = doubled / doubled_area_sq.sqrt();
        let facing = self.facing[before] + self.facing[i];
        let faces_rim = normal.dot(&facing) > FACING_SHARE * facing.norm();
        let distrust = if faces_rim { 1.0 } else { DISTRUST };
        let turn = |edge: usize| {
            1.0 - normal.dot(&self.normals[edge].unwrap_or_else(|| unit(self.facing[edge])))
        };
        let excess = (turn(before).max(turn(i)) - FREE_TURN).max(0.0);
        let sides_sq = (b - a).norm_squared() * (c - b).norm_squared() * (c - a).norm_squared();
        let radius = (sides_sq / doubled_area_sq).sqrt() / 2.0;
        let cost = radius.max((c - a).norm()) * distrust * (1.0 + TURN_PENALTY * excess);
        Some(Ear {
            is_folded: !faces_rim && normal.dot(&self.axis) <= 0.0,
            cost: cost.to_bits(),
            position,
            version: self.version[i],
        })
    }

    fn may_join(&self, i: usize, j: usize) -> bool {
        self.rules
            .ambiguous_pair(i, j)
            .is_none_or(|pair| !self.joined.contains(&pair))
            && self.rules.admit(i, j)
    }

    fn run(&mut self, target: usize, job: &Job<'_>) -> Result<()> {
        let mut left = self.polygon.len();
        while left > target {
            let Some(Reverse(entry)) = self.queue.pop() else {
                break;
            };
            let i = entry.position as usize;
            if !self.alive[i] || entry.version != self.version[i] {
                continue;
            }
            let (before, after) = (self.previous[i], self.next[i]);
            if !self.may_join(before as usize, after as usize) {
                continue;
            }
            job.tick(30)?;
            self.cut(entry.position);
            left -= 1;
            for neighbor in [before, after] {
                self.queue.extend(self.entry(neighbor).map(Reverse));
            }
        }
        Ok(())
    }

    /// Cuts the ear at `position`, which makes the queue entries of its neighbors stale.
    fn cut(&mut self, position: u32) {
        let i = position as usize;
        let (before, after) = (self.previous[i], self.next[i]);
        let [a, b, c] = self.ear_points(position);
        self.normals[before as usize] = Some(unit(cross_normal(a, b, c)));
        let facing = self.facing[i];
        self.facing[before as usize] += facing;
        self.ears.push([before, position, after]);
        self.joined
            .extend(self.rules.ambiguous_pair(before as usize, after as usize));
        self.alive[i] = false;
        self.next[before as usize] = after;
        self.previous[after as usize] = before;
        self.version[before as usize] += 1;
        self.version[after as usize] += 1;
    }

    fn finish(self) -> Clipped {
        let rest: Vec<u32> = (0..self.polygon.len() as u32)
            .filter(|&i| self.alive[i as usize])
            .collect();
        let rest_normals = rest.iter().map(|&i| self.normals[i as usize]).collect();
        Clipped {
            ears: self.ears,
            rest,
            rest_normals,
            joined: self.joined,
        }
    }
}

/// For each edge, its known normal, or that of the last edge before it that has one; `axis` if no edge has one.
fn guess_normals(polygon: &HolePolygon<'_>, axis: Vec3) -> Vec<Vec3> {
    let known = polygon.outside_normals;
    let mut last = known.iter().rev().copied().find_map(|n| n).unwrap_or(axis);
    let carry = |normal: &Option<Vec3>| {
        last = normal.unwrap_or(last);
        last
    };
    known.iter().map(carry).collect()
}

/// Twice the vector area that the closed polygon encloses.
fn area_vector(points: &[Vec3]) -> Vec3 {
    points[1..]
        .windows(2)
        .map(|p| cross_normal(&points[0], &p[0], &p[1]))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::super::test_polygons::*;
    use super::*;
    use proptest::prelude::*;

    fn clip_all(polygon: &HolePolygon<'_>, target: usize) -> Clipped {
        clip(
            polygon,
            &ChordRules::new(polygon),
            target,
            &Job::unlimited(),
        )
        .expect("nothing stops it")
    }

    /// The ears and the rest closed by a fan, where the rest is a triangle.
    fn complete(clipped: &Clipped) -> Vec<[u32; 3]> {
        assert_eq!(clipped.rest.len(), 3);
        let mut triangles = clipped.ears.clone();
        triangles.push([clipped.rest[0], clipped.rest[1], clipped.rest[2]]);
        triangles
    }

    /// Every time the cheapest ear by a scan of all positions, for comparison with the queue.
    fn clip_by_scanning(polygon: &HolePolygon<'_>) -> Vec<[u32; 3]> {
        let rules = ChordRules::new(polygon);
        let mut clipper = Clipper::new(polygon, &rules);
        let mut ears = vec![];
        for _ in 3..polygon.len() {
            let alive = (0..polygon.len() as u32).filter(|&i| clipper.alive[i as usize]);
            let fresh = alive
                .filter_map(|i| clipper.entry(i))
                .map(|e| (e.is_folded, e.cost, e.position));
            let Some((_, _, position)) = fresh.min() else {
                break;
            };
            clipper.cut(position);
            ears.push(*clipper.ears.last().expect("just cut"));
        }
        ears
    }

    proptest! {
        #[test]
        fn the_queue_cuts_the_ears_that_scanning_would(rim in arbitrary_rim(3..40)) {
            let clipped = clip_all(&rim.polygon(), 3);
            prop_assert_eq!(&clipped.ears, &clip_by_scanning(&rim.polygon()));
        }

        #[test]
        fn ears_and_rest_share_the_positions(rim in arbitrary_rim(3..40), target in 0_usize..40) {
            let clipped = clip_all(&rim.polygon(), target);
            prop_assert_eq!(clipped.rest.len(), rim.points.len().min(target.max(3)));
            prop_assert_eq!(clipped.ears.len() + clipped.rest.len(), rim.points.len());
            prop_assert!(clipped.rest.is_sorted());
        }
    }

    #[test]
    fn plane_polygons_are_covered_once() {
        let l_shape = [[0., 0.], [4., 0.], [4., 1.], [1., 1.], [1., 4.], [0., 4.]];
        for outline in [subdivided(&l_shape, 0.02), comb(), spiral_slit(1000)] {
            for known in [true, false] {
                let mut rim = Rim::planar(&outline);
                if !known {
                    rim.normals.fill(None);
                }
                let triangles = complete(&clip_all(&rim.polygon(), 3));
                let excess = rim.areas(&triangles) / rim.planar_area() - 1.0;
                assert!(excess.abs() < 1e-9, "{excess}");
            }
        }
    }

    #[test]
    fn the_flat_end_of_a_fluted_tube_is_covered_once() {
        let outline: Vec<_> = (0..1000)
            .map(|i| f64::from(i) * std::f64::consts::TAU / 1000.0)
            .map(|a| {
                [
                    (1.0 + 0.3 * (7.0 * a).sin()) * a.cos(),
                    (1.0 + 0.3 * (7.0 * a).sin()) * a.sin(),
                ]
            })
            .collect();
        let mut rim = Rim::planar(&outline);
        let p = rim.points.clone();
        rim.normals = (0..1000)
            .map(|i| Some(unit((p[(i + 1) % 1000] - p[i]).cross(&Vec3::z()))))
            .collect();
        let triangles = complete(&clip_all(&rim.polygon(), 3));
        assert!((rim.areas(&triangles) / rim.planar_area() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn flat_and_blocked_ears_are_never_cut() {
        let line: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i), 0.0]).collect();
        assert_eq!(clip_all(&Rim::planar(&line).polygon(), 3).rest.len(), 100);
        let rim = Rim::regular(20);
        let polygon = HolePolygon {
            blocked: &|_, _| true,
            ..rim.polygon()
        };
        assert_eq!(clip_all(&polygon, 3).rest.len(), 20);
        let square = Rim::planar(&subdivided(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]], 0.01));
        let triangles = complete(&clip_all(&square.polygon(), 3));
        assert!(triangles.iter().all(|t| square.area(t) > 1e-6));
    }

    #[test]
    fn ears_join_no_two_vertices_twice() {
        let rim = Rim::bridged_rings(40);
        let clipped = clip_all(&rim.polygon(), 3);
        assert!(clipped.ears.len() > 70, "{}", clipped.ears.len());
        assert!(rim.joins_no_vertices_twice(&clipped.ears));
        assert!(
            !clipped.joined.is_empty(),
            "the case does not exercise the rule"
        );
    }

    #[test]
    fn a_stop_is_heard() {
        let rim = Rim::regular(10_000);
        let polygon = rim.polygon();
        let stopped = clip(&polygon, &ChordRules::new(&polygon), 3, &Job::new(&|| true));
        assert_eq!(
            stopped.err().map(|e| e.kind()),
            Some(crate::error::ErrorKind::Cancelled)
        );
    }
}
