//! Cuts a hole into faces along creases. Each face belongs to one region of the mesh round the hole.
//!
//! The ends of creases divide the rim into a cycle of arcs; each arc belongs to one region. Two moves remove an arc:
//!
//! * *close*: if the arcs before and after it belong to one region, a crease joins the two ends of the arc;
//! * *corner*: the creases at the two ends of the arc meet in the point where its region meets the regions before and
//!   after it. From this corner the crease between these two regions continues.
//!
//! When two arcs are left, one crease separates them. All orders of moves are listed. They are tried in ascending order
//! of the total length of their creases, measured along straight lines, and the first one is taken whose curves exist.
//! Two corners that coincide are united; there four or more regions meet.
//!
//! Cost: exponential in the number of ends, which [`MOST_ENDS`] bounds. Not guaranteed: that the shortest creases are
//! the original ones.

use super::intersection::{IntersectionCurve, corner};
use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::math::Vec3;
use crate::methods::auto::creases::detect::Regions;
use crate::methods::auto::surface::Implicit;

/// Upper bound on the number of crease ends. A hole with more is filled as a smooth one.
const MOST_ENDS: usize = 6;

/// Upper bound on the orders of moves for which curves are computed.
const MOST_TRIALS: usize = 6;

/// Upper bound on the distance of a corner from the middle of the rim, in diameters of the rim.
const FARTHEST_CORNER: f64 = 1.0;

/// Two corners closer than this are united. Unit: the mean edge length at the rim.
const SAME_CORNER: f64 = 0.5;

/// Lower bound on the distance between the ends of a crease, in the same unit. A shorter one would make triangles
/// without area.
const RIM_DISTANCE: f64 = 0.05;

/// Upper bound on a Newton step toward a corner, in diameters of the rim.
const LONGEST_STEP: f64 = 0.25;

/// A hole cut into faces.
#[derive(Clone, Debug)]
pub(crate) struct Partition {
    /// Vertices of creases and corners inside the hole. Their numbers follow those of the rim vertices.
    pub(crate) points: Vec<Vec3>,
    pub(crate) faces: Vec<Face>,
    /// The vertices of each crease, ends included.
    pub(crate) creases: Vec<Vec<u32>>,
}

/// A piece of the hole.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(crate) region: u32,
    /// Its vertices in the orientation of the patch.
    pub(crate) boundary: Vec<u32>,
}

/// Cuts the hole along the creases in which the `surfaces` of the regions meet.
///
/// # Errors
/// [`crate::ErrorKind::Geometry`] when there are too many creases or they do not meet inside the hole.
pub(crate) fn partition(
    hole: &Hole,
    regions: &Regions,
    surfaces: &[&dyn Implicit],
    step: f64,
) -> Result<Partition> {
    if regions.ends.len() > MOST_ENDS {
        return failed("too many creases meet in the hole");
    }
    let (middle, diameter) = hole.middle_and_diameter();
    let search = Search {
        surfaces,
        middle,
        diameter,
    };
    let first = regions.ends.iter().map(|end| RimArc {
        region: regions.at_rim[end.position],
        start: hole.rim()[hole.polygon[end.position] as usize],
    });
    let mut plans = Vec::new();
    search.extend(
        &first.collect::<Vec<_>>(),
        &PartitionPlan::default(),
        &mut plans,
    );
    plans.sort_by(|a, b| a.length.total_cmp(&b.length));
    for plan in plans.iter().take(MOST_TRIALS) {
        if let Some(partition) = Builder::new(hole, regions, surfaces, step).build(plan) {
            return Ok(partition);
        }
    }
    failed("the creases do not meet inside the hole")
}

fn failed<T>(reason: &str) -> Result<T> {
    Err(Error::geometry(reason.to_owned()))
}

#[derive(Clone, Copy, Debug)]
enum Move {
    /// Close the arc at this place in the cycle.
    Close(usize),
    /// End the arc at this place in a corner.
    Corner(usize, Vec3),
}

#[derive(Clone, Debug, Default)]
struct PartitionPlan {
    moves: Vec<Move>,
    /// The total length of the creases, as if they were straight.
    length: f64,
}

impl PartitionPlan {
    fn with(&self, step: Move, length: f64) -> Self {
        let mut plan = self.clone();
        plan.moves.push(step);
        plan.length += length;
        plan
    }
}

/// A part of the cycle that belongs to one region. It ends where the next arc starts.
#[derive(Clone, Copy)]
struct RimArc {
    region: u32,
    start: Vec3,
}

struct Search<'a> {
    surfaces: &'a [&'a dyn Implicit],
    middle: Vec3,
    diameter: f64,
}

impl Search<'_> {
    /// Adds to `plans` all ways to finish the plan.
    fn extend(&self, arcs: &[RimArc], plan: &PartitionPlan, plans: &mut Vec<PartitionPlan>) {
        let len = arcs.len();
        if len < 2 {
            return;
        }
        if len == 2 {
            let mut finished = plan.clone();
            finished.length += (arcs[1].start - arcs[0].start).norm();
            plans.push(finished);
            return;
        }
        // Three arcs meet in the same corner, whichever of them is removed first.
        for i in 0..if len == 3 { 1 } else { len } {
            let (before, after) = (arcs[(i + len - 1) % len], arcs[(i + 1) % len]);
            let ends = [arcs[i].start, after.start];
            if before.region == after.region {
                let mut rest = arcs.to_vec();
                remove_arc_and_next(&mut rest, i);
                let plan = plan.with(Move::Close(i), (ends[1] - ends[0]).norm());
                self.extend(&rest, &plan, plans);
            } else if let Some(corner) = self.corner([before, arcs[i], after], ends) {
                let mut rest = arcs.to_vec();
                rest[(i + 1) % len].start = corner;
                rest.remove(i);
                let length = ends.iter().map(|end| (corner - end).norm()).sum();
                self.extend(&rest, &plan.with(Move::Corner(i, corner), length), plans);
            }
        }
    }

    fn corner(&self, arcs: [RimArc; 3], ends: [Vec3; 2]) -> Option<Vec3> {
        let surfaces = arcs.map(|arc| self.surfaces[arc.region as usize]);
        let start = (ends[0] + ends[1] + self.middle) / 3.0;
        corner(surfaces, start, LONGEST_STEP * self.diameter)
            .filter(|p| (p - self.middle).norm() < FARTHEST_CORNER * self.diameter)
    }
}

/// Removes arc `i` and the one after it, which merges with the one before.
fn remove_arc_and_next<T>(arcs: &mut Vec<T>, i: usize) {
    let next = (i + 1) % arcs.len();
    arcs.remove(i.max(next));
    arcs.remove(i.min(next));
}

/// An arc as a chain of vertices from its start to its end.
struct CreaseChain {
    region: u32,
    vertices: Vec<u32>,
}

/// Turns a plan into faces.
struct Builder<'a> {
    hole: &'a Hole,
    surfaces: &'a [&'a dyn Implicit],
    step: f64,
    /// Direction into the hole at each crease's end, with the vertex.
    departures: Vec<(u32, Vec3)>,
    chains: Vec<CreaseChain>,
    partition: Partition,
}

impl<'a> Builder<'a> {
    fn new(hole: &'a Hole, regions: &Regions, surfaces: &'a [&'a dyn Implicit], step: f64) -> Self {
        let (polygon, ends) = (&hole.polygon, &regions.ends);
        let chain = |k: usize| {
            let from = ends[k].position;
            let to = ends[(k + 1) % ends.len()].position;
            let count = (to + polygon.len() - from) % polygon.len();
            let vertices = (from..=from + count).map(|i| polygon[i % polygon.len()]);
            CreaseChain {
                region: regions.at_rim[from],
                vertices: vertices.collect(),
            }
        };
        Self {
            hole,
            surfaces,
            step,
            departures: ends
                .iter()
                .map(|end| (polygon[end.position], -end.outward))
                .collect(),
            chains: (0..ends.len()).map(chain).collect(),
            partition: Partition {
                points: Vec::new(),
                faces: Vec::new(),
                creases: Vec::new(),
            },
        }
    }

    fn build(mut self, plan: &PartitionPlan) -> Option<Partition> {
        for step in &plan.moves {
            match *step {
                Move::Close(i) => self.close(i)?,
                Move::Corner(i, corner) => self.meet(i, corner)?,
            }
        }
        let [first, second] = &self.chains[..] else {
            return None;
        };
        let regions = [first.region, second.region];
        let ends = [first.vertices[0], second.vertices[0]];
        let crease = self.crease(ends, regions)?;
        let chains = std::mem::take(&mut self.chains);
        for (chain, is_first) in chains.into_iter().zip([true, false]) {
            let mut boundary = chain.vertices;
            // The second chain starts where the first ends.
            let back: Vec<u32> = if is_first {
                crease.iter().rev().copied().collect()
            } else {
                crease.clone()
            };
            join(&mut boundary, &back);
            self.finish(chain.region, boundary);
        }
        let is_sound = |face: &Face| {
            let mut sorted = face.boundary.clone();
            sorted.sort_unstable();
            sorted.dedup();
            sorted.len() >= 3 && sorted.len() == face.boundary.len()
        };
        self.drop_unused();
        self.partition
            .faces
            .iter()
            .all(is_sound)
            .then_some(self.partition)
    }

    fn close(&mut self, i: usize) -> Option<()> {
        let len = self.chains.len();
        let (before, after) = ((i + len - 1) % len, (i + 1) % len);
        let regions = [self.chains[before].region, self.chains[i].region];
        let ends = [self.chains[i].vertices[0], self.chains[after].vertices[0]];
        let crease = self.crease(ends, regions)?;
        let mut merged = std::mem::take(&mut self.chains[before].vertices);
        join(&mut merged, &crease);
        join(&mut merged, &self.chains[after].vertices);
        self.chains[before].vertices = merged;
        let mut boundary = std::mem::take(&mut self.chains[i].vertices);
        let back: Vec<u32> = crease.into_iter().rev().collect();
        join(&mut boundary, &back);
        self.finish(self.chains[i].region, boundary);
        remove_arc_and_next(&mut self.chains, i);
        Some(())
    }

    fn meet(&mut self, i: usize, corner: Vec3) -> Option<()> {
        let len = self.chains.len();
        let (before, after) = ((i + len - 1) % len, (i + 1) % len);
        let region = self.chains[i].region;
        let corner = self.add(corner);
        let ends = [self.chains[i].vertices[0], self.chains[after].vertices[0]];
        let left = self.crease([ends[0], corner], [self.chains[before].region, region])?;
        let right = self.crease([ends[1], corner], [region, self.chains[after].region])?;
        join(&mut self.chains[before].vertices, &left);
        let mut onward: Vec<u32> = right.iter().rev().copied().collect();
        join(&mut onward, &self.chains[after].vertices);
        self.chains[after].vertices = onward;
        let mut boundary = std::mem::take(&mut self.chains[i].vertices);
        join(&mut boundary, &right);
        let back: Vec<u32> = left.into_iter().rev().collect();
        join(&mut boundary, &back);
        self.finish(region, boundary);
        self.chains.remove(i);
        Some(())
    }

    /// Adds the vertices of the crease between two vertices and returns it with its ends.
    fn crease(&mut self, ends: [u32; 2], regions: [u32; 2]) -> Option<Vec<u32>> {
        let positions = ends.map(|v| self.position(v));
        let distance = (positions[1] - positions[0]).norm();
        let rim = self.hole.rim().len() as u32;
        if ends.iter().all(|&v| v >= rim) && distance < SAME_CORNER * self.step {
            self.unite(ends[0], ends[1]);
            return Some(vec![ends[0]]);
        }
        if distance < RIM_DISTANCE * self.step {
            return None;
        }
        let departure = self.departures.iter().find(|d| d.0 == ends[0]);
        let curve = IntersectionCurve {
            surfaces: regions.map(|r| self.surfaces[r as usize]),
            ends: positions,
            departure: departure.map(|d| d.1),
            step: self.step,
        };
        let mut crease = vec![ends[0]];
        for p in curve.points()? {
            crease.push(self.add(p));
        }
        crease.push(ends[1]);
        self.partition.creases.push(crease.clone());
        Some(crease)
    }

    fn finish(&mut self, region: u32, mut boundary: Vec<u32>) {
        // The chain is closed: its last vertex is its first.
        while boundary.len() > 1 && boundary.first() == boundary.last() {
            boundary.pop();
        }
        self.partition.faces.push(Face { region, boundary });
    }

    fn add(&mut self, p: Vec3) -> u32 {
        self.partition.points.push(p);
        (self.hole.rim().len() + self.partition.points.len() - 1) as u32
    }

    fn position(&self, v: u32) -> Vec3 {
        let rim = self.hole.rim();
        match (v as usize).checked_sub(rim.len()) {
            None => rim[v as usize],
            Some(inner) => self.partition.points[inner],
        }
    }

    /// Replaces vertex `removed` by `kept` everywhere.
    fn unite(&mut self, kept: u32, removed: u32) {
        let faces = self.partition.faces.iter_mut().map(|f| &mut f.boundary);
        let chains = self.chains.iter_mut().map(|c| &mut c.vertices);
        for list in faces.chain(chains).chain(&mut self.partition.creases) {
            for v in list.iter_mut().filter(|v| **v == removed) {
                *v = kept;
            }
            list.dedup();
        }
    }

    /// Removes the points that no face uses and renumbers the others.
    fn drop_unused(&mut self) {
        let rim = self.hole.rim().len();
        let mut is_used = vec![false; self.partition.points.len()];
        for &v in self.partition.faces.iter().flat_map(|f| &f.boundary) {
            if let Some(inner) = (v as usize).checked_sub(rim) {
                is_used[inner] = true;
            }
        }
        let mut numbers = Vec::with_capacity(is_used.len());
        let mut count = rim as u32;
        for &used in &is_used {
            numbers.push(count);
            count += u32::from(used);
        }
        let mut used = is_used.iter();
        self.partition.points.retain(|_| used.next() == Some(&true));
        let faces = self.partition.faces.iter_mut().map(|f| &mut f.boundary);
        for v in faces.chain(&mut self.partition.creases).flatten() {
            if let Some(inner) = (*v as usize).checked_sub(rim) {
                *v = numbers[inner];
            }
        }
    }
}

/// Continues a chain by one that starts where it ends.
fn join(chain: &mut Vec<u32>, next: &[u32]) {
    chain.extend(&next[1.min(next.len())..]);
}
