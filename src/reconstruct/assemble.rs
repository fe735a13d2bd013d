//! Assembles the surface from the triangles that the points chose.
//!
//! A triangle is a candidate if one of its corners chose it. Candidates are added one at a time, if they fit to those
//! already added: first the candidates that all three corners chose, then those of two corners, then those of one;
//! among these, triangles with small circumscribed circles come first. Where points disagree, small gaps remain. They
//! are closed by adding triangles at their edges, small circles first, as long as triangles are within the size
//! limit. Gaps of few edges are closed even where the triangles do not fit in the tangent planes. What is still open
//! is a hole. Triangles at its rim that are too large are removed again.
//!
//! Source: M. Gopi, S. Krishnan, A fast and efficient projection based approach for surface reconstruction,
//! International Journal of High Performance Computer Graphics, Multimedia and Visualisation 1(1), 2000. There the
//! surface grows from a seed; here the order does not depend on a seed.
//!
//! Complexity: O(n k) for n points with k neighbors, O(n log n) to sort.

use super::cloud::{Cloud, NearestPoints, for_all};
use super::gaps;
use super::reach::{RIM_SHARE, circumradius, limits};
use super::star::Star;
use super::surface::{GrowingSurface, from_lowest, rotations};
use super::tangent::Tangent;
use crate::error::Result;
use crate::job::Job;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Upper bound on the neighbors of a star that is made again, because the nearest ones do not reach as far as the size
/// limit.
const MOST_NEIGHBORS: usize = 200;

/// The input of the assembly.
pub(super) struct Assembler<'a> {
    pub(super) cloud: &'a Cloud,
    pub(super) neighbors: &'a NearestPoints,
    /// `None` for points without a normal.
    pub(super) tangents: &'a [Option<Tangent>],
    /// Upper bound on the radius of a triangle's circumscribed circle, in the cloud's unit, if the caller gave one.
    pub(super) radius: Option<f64>,
    pub(super) job: &'a Job<'a>,
}

/// The surface, and the size limits of its triangles.
pub(super) struct Assembled {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Upper bound on the radius of a triangle's circumscribed circle, at each point.
    pub(super) limits: Vec<f64>,
}

/// A triangle that points chose, starting with its lowest index.
#[derive(Clone, Copy, PartialEq)]
struct CandidateTriangle {
    votes: u8,
    radius: f64,
    corners: [u32; 3],
}

impl CandidateTriangle {
    fn order(&self, other: &Self) -> std::cmp::Ordering {
        let by_votes = other.votes.cmp(&self.votes);
        let by_radius = || self.radius.total_cmp(&other.radius);
        by_votes
            .then_with(by_radius)
            .then(self.corners.cmp(&other.corners))
    }
}

impl Assembler<'_> {
    /// Makes the surface.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(super) fn run(&self) -> Result<Assembled> {
        let near = for_all(self.cloud.len(), self.job, |v| {
            self.star(v, self.neighbors.of(v))
        })?;
        let limits = self.limits(&near)?;
        let stars = for_all(self.cloud.len(), self.job, |v| {
            self.choice(v, &near[v as usize], limits[v as usize])
        })?;
        let candidates = self.candidates(&stars, &limits);
        let mut surface = GrowingSurface::new(self.cloud, self.tangents);
        for candidate in candidates {
            self.job.tick(10)?;
            surface.add(candidate.corners);
        }
        self.close_gaps(&mut surface, &limits)?;
        // Small gaps are closed first, so that triangles are removed at true holes only.
        self.close_small_holes(&mut surface, &limits);
        if self.radius.is_none() {
            surface.peel(|t| self.radius(t) - RIM_SHARE * largest_limit(&limits, t));
            self.close_small_holes(&mut surface, &limits);
        }
        Ok(Assembled {
            triangles: surface.triangles(),
            limits,
        })
    }

    fn limits(&self, stars: &[Star]) -> Result<Vec<f64>> {
        if let Some(radius) = self.radius {
            return Ok(vec![radius; stars.len()]);
        }
        let radii = for_all(stars.len(), self.job, |v| {
            let sectors = stars[v as usize].sectors();
            let radii = sectors.map(|[a, b]| self.radius([v, a, b]));
            radii.filter(|r| r.is_finite()).collect()
        })?;
        limits(self.cloud, self.neighbors, &radii, self.job)
    }

    fn radius(&self, corners: [u32; 3]) -> f64 {
        circumradius(corners.map(|v| self.cloud.points[v as usize]))
    }

    /// The star of `v` among `near`, without points whose normals point to the other side.
    fn star(&self, v: u32, near: &[u32]) -> Star {
        let tangent = self.tangents[v as usize].as_ref();
        let alike = near.iter().copied().filter(|&w| {
            let pair = tangent.zip(self.tangents[w as usize].as_ref());
            pair.is_some_and(|(t, other)| t.normal.dot(&other.normal) > 0.0)
        });
        let places = alike.map(|w| (w, self.cloud.points[w as usize]));
        match tangent {
            Some(tangent) => Star::new(v, tangent, places),
            None => Star::empty(v),
        }
    }

    /// The sectors of the star of `v` within the limit. The star is made again from more points if it may have missed
    /// one.
    fn choice(&self, v: u32, star: &Star, limit: f64) -> Vec<[u32; 2]> {
        let near = self.neighbors.of(v);
        let within = |star: &Star| -> Vec<[u32; 2]> {
            let sectors = star.sectors();
            sectors
                .filter(|&[a, b]| self.radius([v, a, b]) <= limit)
                .collect()
        };
        let chosen = within(star);
        let reached = near.last().map_or(0.0, |&w| {
            (self.cloud.points[w as usize] - self.cloud.points[v as usize]).norm()
        });
        // A circle through the center reaches as far as its diameter. A gap can be closed by any point within twice the
        // limit.
        let largest = chosen
            .iter()
            .map(|&[a, b]| self.radius([v, a, b]))
            .fold(0.0, f64::max);
        let needed = if star.is_closed() && chosen.len() == star.sectors().count() {
            2.0 * largest
        } else {
            2.0 * limit
        };
        if needed <= reached || near.len() + 1 >= self.cloud.len() {
            return chosen;
        }
        let wider = self.cloud.within(v, needed, MOST_NEIGHBORS);
        if wider.len() <= near.len() {
            return chosen;
        }
        within(&self.star(v, &wider))
    }

    /// The triangles of all stars, in the order in which they are tried.
    fn candidates(&self, stars: &[Vec<[u32; 2]>], limits: &[f64]) -> Vec<CandidateTriangle> {
        let mut chosen: Vec<[u32; 3]> = (0..)
            .zip(stars)
            .flat_map(|(v, sectors)| sectors.iter().map(move |&[a, b]| from_lowest([v, a, b])))
            .collect();
        chosen.par_sort_unstable();
        let mut candidates: Vec<CandidateTriangle> = chosen
            .chunk_by(|a, b| a == b)
            .map(|same| CandidateTriangle {
                votes: same.len().min(3) as u8,
                radius: self.radius(same[0]),
                corners: same[0],
            })
            .filter(|c| c.radius <= largest_limit(limits, c.corners))
            .collect();
        candidates.par_sort_unstable_by(CandidateTriangle::order);
        candidates
    }

    /// Adds triangles at open edges as long as they are within the limit.
    fn close_gaps(&self, surface: &mut GrowingSurface, limits: &[f64]) -> Result<()> {
        let mut queue = BinaryHeap::new();
        for side in surface.boundary() {
            self.queue_triangles(surface, limits, side, &mut queue);
        }
        while let Some(Reverse(Queued { corners, .. })) = queue.pop() {
            self.job.tick(30)?;
            if !surface.add(corners) {
                continue;
            }
            for [a, b, _] in rotations(corners) {
                if !surface.has_side(b, a) {
                    self.queue_triangles(surface, limits, [a, b], &mut queue);
                }
            }
        }
        Ok(())
    }

    /// Leaves one fan at each point, and closes holes of few edges with triangles within the limit.
    fn close_small_holes(&self, surface: &mut GrowingSurface, limits: &[f64]) {
        surface.separate_fans();
        let normal = |v: u32| self.tangents[v as usize].as_ref().map(|t| t.normal);
        gaps::close_small_holes(surface, &self.cloud.points, normal, |t| {
            largest_limit(limits, t)
        });
    }

    /// Puts the triangles that fit at the open side of a -> b into the queue.
    fn queue_triangles(
        &self,
        surface: &GrowingSurface,
        limits: &[f64],
        [a, b]: [u32; 2],
        queue: &mut BinaryHeap<Reverse<Queued>>,
    ) {
        let mut thirds: Vec<u32> = [a, b]
            .iter()
            .flat_map(|&v| self.neighbors.of(v))
            .copied()
            .filter(|&c| c != a && c != b && !surface.is_surrounded(c))
            .collect();
        thirds.sort_unstable();
        thirds.dedup();
        for c in thirds {
            let corners = from_lowest([b, a, c]);
            let radius = self.radius(corners);
            if radius <= largest_limit(limits, corners) && surface.fits(corners) {
                queue.push(Reverse(Queued { radius, corners }));
            }
        }
    }
}

/// A triangle in the queue. Small circles come first.
struct Queued {
    radius: f64,
    corners: [u32; 3],
}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_radius = self.radius.total_cmp(&other.radius);
        by_radius.then(self.corners.cmp(&other.corners))
    }
}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Queued {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Queued {}

fn largest_limit(limits: &[f64], corners: [u32; 3]) -> f64 {
    corners
        .iter()
        .map(|&v| limits[v as usize])
        .fold(0.0, f64::max)
}
