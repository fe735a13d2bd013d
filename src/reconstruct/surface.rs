//! A surface that grows triangle by triangle, and the test whether another triangle fits.
//!
//! At each of its corners, a triangle is an arc: (p, a, b) is the arc a -> b round p. The arcs round a point never
//! branch, and never close a circle that leaves other arcs out. Their sectors in the tangent plane never overlap. So
//! each edge has at most two triangles, in opposite directions, and a surrounded point has one fan. A point on the
//! boundary may have several fans until [`GrowingSurface::separate_fans`].
//!
//! Complexity: O(d^2) for each triangle, with d triangles at a point.

use super::cloud::Cloud;
use super::tangent::{Tangent, TangentPlace, sectors_overlap, turn};
use std::collections::{BTreeSet, BinaryHeap};

/// An oriented surface of triangles.
pub(super) struct GrowingSurface<'a> {
    cloud: &'a Cloud,
    tangents: &'a [Option<Tangent>],
    /// For each point, the opposite sides of its triangles, in their direction.
    arcs: Vec<Vec<[u32; 2]>>,
}

impl<'a> GrowingSurface<'a> {
    /// A surface without triangles. A point without a tangent plane never gets one.
    pub(super) fn new(cloud: &'a Cloud, tangents: &'a [Option<Tangent>]) -> Self {
        Self {
            cloud,
            tangents,
            arcs: vec![Vec::new(); cloud.len()],
        }
    }

    /// Adds the triangle if it fits.
    pub(super) fn add(&mut self, triangle: [u32; 3]) -> bool {
        let fits = self.fits(triangle);
        if fits {
            self.insert(triangle);
        }
        fits
    }

    /// Adds a triangle for which [`connects`](Self::connects) holds, whether it fits in the tangent planes or not.
    pub(super) fn insert(&mut self, triangle: [u32; 3]) {
        debug_assert!(self.connects(triangle));
        for [p, a, b] in rotations(triangle) {
            self.arcs[p as usize].push([a, b]);
        }
    }

    /// Whether the triangle can be added.
    pub(super) fn fits(&self, triangle: [u32; 3]) -> bool {
        self.connects(triangle)
            && rotations(triangle)
                .into_iter()
                .all(|[p, a, b]| self.has_room(p, [a, b]))
    }

    /// Whether the surface stays an oriented manifold with the triangle, except that boundary points may have several
    /// fans.
    pub(super) fn connects(&self, triangle: [u32; 3]) -> bool {
        rotations(triangle).into_iter().all(|[p, a, b]| {
            let arcs = &self.arcs[p as usize];
            arcs.iter().all(|&[c, d]| c != a && d != b) && !self.closes_too_early(p, [a, b])
        })
    }

    /// Whether the sector of the arc is free in the tangent plane of `p`.
    fn has_room(&self, p: u32, arc: [u32; 2]) -> bool {
        let Some(sector) = self.sector(p, arc) else {
            return false;
        };
        turn(sector[0], sector[1]) > 0.0
            && self.arcs[p as usize].iter().all(|&other| {
                self.sector(p, other)
                    .is_none_or(|other| !sectors_overlap(sector, other))
            })
    }

    /// Whether the arc would close a circle round `p` that leaves other arcs out.
    fn closes_too_early(&self, p: u32, [a, b]: [u32; 2]) -> bool {
        let arcs = &self.arcs[p as usize];
        let mut at = b;
        for passed in 0..arcs.len() {
            if at == a {
                return passed < arcs.len();
            }
            match arcs.iter().find(|arc| arc[0] == at) {
                Some(arc) => at = arc[1],
                None => return false,
            }
        }
        false
    }

    fn sector(&self, p: u32, ends: [u32; 2]) -> Option<[TangentPlace; 2]> {
        let tangent = self.tangents[p as usize].as_ref()?;
        let place = |v: u32| tangent.place(&self.cloud.points[v as usize]);
        Some([place(ends[0])?, place(ends[1])?])
    }

    /// Whether a triangle has the directed edge a -> b.
    pub(super) fn has_side(&self, a: u32, b: u32) -> bool {
        self.arcs[a as usize].iter().any(|arc| arc[0] == b)
    }

    /// Whether triangles surround the point.
    pub(super) fn is_surrounded(&self, p: u32) -> bool {
        let arcs = &self.arcs[p as usize];
        !arcs.is_empty()
            && arcs
                .iter()
                .all(|arc| arcs.iter().any(|next| next[0] == arc[1]))
    }

    /// Removes triangles at the boundary for which `excess` is positive, the largest excess first, and goes on
    /// inward. A triangle stays if it is the only one at a corner. Returns the number of removed triangles.
    pub(super) fn peel(&mut self, excess: impl Fn([u32; 3]) -> f64) -> usize {
        let mut removed = 0;
        let mut queue = BinaryHeap::new();
        let sides = self.boundary();
        let offer = |surface: &Self, [a, b]: [u32; 2], queue: &mut BinaryHeap<Peeled>| {
            let Some(c) = surface.third(a, b) else {
                return;
            };
            let excess = excess([a, b, c]);
            if excess > 0.0 {
                queue.push(Peeled {
                    excess,
                    corners: from_lowest([a, b, c]),
                });
            }
        };
        for side in sides {
            offer(self, side, &mut queue);
        }
        while let Some(Peeled { corners, .. }) = queue.pop() {
            let [a, b, c] = corners;
            let is_there = self.third(a, b) == Some(c);
            let is_last = corners.iter().any(|&v| self.arcs[v as usize].len() == 1);
            if !is_there || is_last {
                continue;
            }
            self.remove(corners);
            removed += 1;
            for [a, b, _] in rotations(corners) {
                offer(self, [b, a], &mut queue);
            }
        }
        removed
    }

    /// The third corner of the triangle with the directed edge a -> b.
    pub(super) fn third(&self, a: u32, b: u32) -> Option<u32> {
        let arcs = &self.arcs[a as usize];
        arcs.iter().find(|arc| arc[0] == b).map(|arc| arc[1])
    }

    /// Keeps the largest fan at each point, and removes the triangles of its other fans. Returns their number.
    pub(super) fn separate_fans(&mut self) -> usize {
        let mut removed = 0;
        let mut to_do: BTreeSet<u32> = (0..self.arcs.len() as u32).collect();
        while let Some(p) = to_do.pop_first() {
            let fans = fans(&self.arcs[p as usize]);
            // Of equally large ones, the first stays.
            let Some(largest) = (0..fans.len()).max_by_key(|&k| (fans[k].len(), fans.len() - k))
            else {
                continue;
            };
            for (k, fan) in fans.iter().enumerate() {
                if k == largest {
                    continue;
                }
                for &[a, b] in fan {
                    self.remove([p, a, b]);
                    removed += 1;
                    to_do.extend([a, b]);
                }
            }
        }
        removed
    }

    /// Removes a triangle.
    pub(super) fn remove(&mut self, triangle: [u32; 3]) {
        for [p, a, b] in rotations(triangle) {
            self.arcs[p as usize].retain(|&arc| arc != [a, b]);
        }
    }

    /// All triangles, each starting with its lowest index, in ascending order.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles: Vec<[u32; 3]> = (0..)
            .zip(&self.arcs)
            .flat_map(|(p, arcs)| {
                arcs.iter()
                    .filter(move |[a, b]| p < *a && p < *b)
                    .map(move |&[a, b]| [p, a, b])
            })
            .collect();
        triangles.sort_unstable();
        triangles
    }

    /// The sides a -> b of triangles that have no triangle on the other side, in ascending order.
    pub(super) fn boundary(&self) -> Vec<[u32; 2]> {
        let mut sides = Vec::new();
        for (p, arcs) in (0..).zip(&self.arcs) {
            // Sides from p run p -> a, of the arc a -> b; their opposite is that of an arc c -> a.
            let open = arcs
                .iter()
                .filter(|[a, _]| arcs.iter().all(|other| other[1] != *a));
            sides.extend(open.map(|&[a, _]| [p, a]));
        }
        sides.sort_unstable();
        sides
    }
}

/// The triangle, starting at each of its corners.
pub(super) fn rotations([a, b, c]: [u32; 3]) -> [[u32; 3]; 3] {
    [[a, b, c], [b, c, a], [c, a, b]]
}

/// The triangle, starting with its lowest index, in the same orientation.
pub(super) fn from_lowest(triangle: [u32; 3]) -> [u32; 3] {
    let [a, b, c] = rotations(triangle);
    a.min(b).min(c)
}

/// A triangle that may be removed. The largest excess comes first.
struct Peeled {
    excess: f64,
    corners: [u32; 3],
}

impl Ord for Peeled {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_excess = self.excess.total_cmp(&other.excess);
        by_excess.then(self.corners.cmp(&other.corners))
    }
}

impl PartialOrd for Peeled {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Peeled {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Peeled {}

/// The arcs in connected runs.
fn fans(arcs: &[[u32; 2]]) -> Vec<Vec<[u32; 2]>> {
    let mut fans: Vec<Vec<[u32; 2]>> = Vec::new();
    let is_start = |arc: &[u32; 2]| arcs.iter().all(|other| other[1] != arc[0]);
    let starts: Vec<[u32; 2]> = arcs.iter().copied().filter(is_start).collect();
    if starts.is_empty() && !arcs.is_empty() {
        // The point is surrounded: `GrowingSurface::add` allows no second fan there.
        return vec![arcs.to_vec()];
    }
    for start in starts {
        let mut fan = vec![start];
        let mut at = start[1];
        while let Some(next) = arcs.iter().find(|arc| arc[0] == at) {
            fan.push(*next);
            at = next[1];
        }
        fans.push(fan);
    }
    fans
}
