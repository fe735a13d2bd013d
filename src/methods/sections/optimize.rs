//! Step 7, second half: too short edges are collapsed, edges are swapped for better angles.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, sections 4.7 and 4.8; the order of the collapses is the economical one of 4.8.
//! `O(n log n)` for `n` triangles of bounded degree.
//!
//! Rim vertices stay where they are and rim edges stay edges. No collapse or swap joins two rim vertices that the
//! mesh joins already, turns a triangle over or makes the patch non-manifold.

use crate::error::Result;
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use crate::patch::{HoleShape, PatchSurface};
use std::collections::BTreeSet;

/// A triangle may turn by less than the angle with this cosine when an edge is collapsed or swapped.
const LARGEST_TURN: f64 = 0.5;

/// A swap must raise the smallest angle by this many radians, so that rounding cannot swap back and forth.
const LEAST_GAIN: f64 = 1e-6;

/// The patch while it is changed: triangles are marked as gone instead of moved.
pub(super) struct Editor<'a> {
    points: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    is_alive: Vec<bool>,
    /// Triangles at each point.
    around: Vec<Vec<u32>>,
    hole: &'a HoleShape,
}

impl<'a> Editor<'a> {
    pub(super) fn new(surface: PatchSurface, hole: &'a HoleShape) -> Self {
        let mut around = vec![Vec::new(); surface.points.len()];
        for (k, t) in (0..).zip(&surface.triangles) {
            for &v in t {
                around[v as usize].push(k);
            }
        }
        Self {
            is_alive: vec![true; surface.triangles.len()],
            points: surface.points,
            triangles: surface.triangles,
            around,
            hole,
        }
    }

    /// The patch without what is gone, and without points that no triangle has.
    pub(super) fn finish(self) -> PatchSurface {
        let rim_count = self.hole.points.len();
        let mut number = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        for (v, p) in self.points.iter().enumerate() {
            if v < rim_count || !self.around[v].is_empty() {
                number[v] = points.len() as u32;
                points.push(*p);
            }
        }
        let alive = self.triangles.iter().zip(&self.is_alive);
        PatchSurface {
            rim_count,
            points,
            triangles: alive
                .filter(|(_, alive)| **alive)
                .map(|(t, _)| t.map(|v| number[v as usize]))
                .collect(),
        }
    }

    pub(super) fn points_mut(&mut self) -> &mut [Vec3] {
        &mut self.points
    }

    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let alive = self.triangles.iter().zip(&self.is_alive);
        alive.filter(|(_, alive)| **alive).map(|(t, _)| *t)
    }

    fn is_rim(&self, v: u32) -> bool {
        (v as usize) < self.hole.points.len()
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        (self.points[a as usize] - self.points[b as usize]).norm()
    }

    fn normal(&self, t: [u32; 3]) -> Vec3 {
        let [a, b, c] = t.map(|v| self.points[v as usize]);
        unit(cross_normal(&a, &b, &c))
    }

    /// The triangles at the edge, each turned so that it begins with the edge as it runs there.
    fn at_edge(&self, a: u32, b: u32) -> Vec<(u32, [u32; 3])> {
        let mut found = Vec::with_capacity(2);
        for &k in &self.around[a as usize] {
            let t = self.triangles[k as usize];
            for i in 0..3 {
                let turned = [t[i], t[(i + 1) % 3], t[(i + 2) % 3]];
                if (turned[0], turned[1]) == (a, b) || (turned[0], turned[1]) == (b, a) {
                    found.push((k, turned));
                }
            }
        }
        found
    }

    /// Sorted.
    fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut around: Vec<u32> = self.around[v as usize]
            .iter()
            .flat_map(|&k| self.triangles[k as usize])
            .filter(|&w| w != v)
            .collect();
        around.sort_unstable();
        around.dedup();
        around
    }

    /// All edges that have two triangles, smaller end first.
    fn interior_edges(&self) -> Vec<(u32, u32)> {
        let mut edges: Vec<(u32, u32)> = self
            .triangles()
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        edges.sort_unstable();
        edges
            .chunk_by(|e, f| e == f)
            .filter(|same| same.len() == 2)
            .map(|same| same[0])
            .collect()
    }

    /// Cuts every edge that joins two rim vertices which the mesh joins already, at its middle.
    pub(super) fn split_joined(&mut self) {
        for (a, b) in self.interior_edges() {
            if self.is_rim(b) && self.hole.is_joined(a, b) {
                self.split(a, b);
            }
        }
    }

    fn split(&mut self, a: u32, b: u32) {
        let middle = self.points.len() as u32;
        self.points
            .push((self.points[a as usize] + self.points[b as usize]) / 2.0);
        self.around.push(Vec::new());
        for (k, [from, to, tip]) in self.at_edge(a, b) {
            self.replace(k, [from, middle, tip]);
            self.add([middle, to, tip]);
        }
    }

    fn add(&mut self, t: [u32; 3]) {
        let k = self.triangles.len() as u32;
        self.triangles.push(t);
        self.is_alive.push(true);
        for v in t {
            self.around[v as usize].push(k);
        }
    }

    fn remove(&mut self, k: u32) {
        for v in self.triangles[k as usize] {
            self.around[v as usize].retain(|&other| other != k);
        }
        self.is_alive[k as usize] = false;
    }

    fn replace(&mut self, k: u32, t: [u32; 3]) {
        for v in self.triangles[k as usize] {
            self.around[v as usize].retain(|&other| other != k);
        }
        self.triangles[k as usize] = t;
        for v in t {
            self.around[v as usize].push(k);
        }
    }

    /// Collapses edges that are shorter than `shortest`, the shortest first, and returns how many. Two interior
    /// points meet half way; a rim vertex stays where it is.
    pub(super) fn collapse_short(&mut self, shortest: f64) -> usize {
        let key = |editor: &Self, (a, b): (u32, u32)| (editor.length(a, b).to_bits(), a, b);
        let mut sorted: Vec<(u64, u32, u32)> = self
            .interior_edges()
            .into_iter()
            .map(|edge| key(self, edge))
            .filter(|e| f64::from_bits(e.0) < shortest)
            .collect();
        sorted.sort_unstable();
        // The sorted edges from `id` on, and those that collapses renewed: the set NS of the paper.
        let (mut id, mut renewed) = (0, BTreeSet::new());
        let mut count = 0;
        loop {
            let next = match (sorted.get(id), renewed.first()) {
                (Some(e), Some(f)) if e <= f => Some(*e),
                (Some(e), None) => Some(*e),
                (_, Some(f)) => Some(*f),
                (None, None) => None,
            };
            let Some(edge) = next else {
                return count;
            };
            if sorted.get(id) == Some(&edge) {
                id += 1;
            } else {
                renewed.remove(&edge);
            }
            let (a, b) = (edge.1, edge.2);
            // Gone or changed since.
            if self.at_edge(a, b).len() != 2 || self.length(a, b).to_bits() != edge.0 {
                continue;
            }
            let Some(kept) = self.collapse(a, b) else {
                continue;
            };
            count += 1;
            for w in self.neighbours(kept) {
                let (a, b) = (kept.min(w), kept.max(w));
                let renewed_edge = key(self, (a, b));
                if f64::from_bits(renewed_edge.0) < shortest {
                    renewed.insert(renewed_edge);
                }
            }
        }
    }

    /// Collapses an interior edge, if that is allowed; returns the vertex that is left.
    fn collapse(&mut self, a: u32, b: u32) -> Option<u32> {
        let (kept, gone) = if self.is_rim(b) { (b, a) } else { (a, b) };
        if self.is_rim(gone) {
            return None;
        }
        let position = if self.is_rim(kept) {
            self.points[kept as usize]
        } else {
            (self.points[a as usize] + self.points[b as usize]) / 2.0
        };
        let of_kept = self.neighbours(kept);
        let common: Vec<u32> = self
            .neighbours(gone)
            .into_iter()
            .filter(|w| of_kept.binary_search(w).is_ok())
            .collect();
        // The link condition, and no vertex left with two triangles.
        let is_simple = common.len() == 2
            && common
                .iter()
                .all(|&w| self.is_rim(w) || self.around[w as usize].len() > 3);
        if !is_simple {
            return None;
        }
        if self.is_rim(kept) {
            let joins = |w: u32| self.is_rim(w) && self.hole.is_joined(kept, w);
            let is_new = |w: u32| w != kept && of_kept.binary_search(&w).is_err();
            if self.neighbours(gone).iter().any(|&w| is_new(w) && joins(w)) {
                return None;
            }
        }
        let doomed: Vec<u32> = self.at_edge(a, b).into_iter().map(|(k, _)| k).collect();
        let mut moved: Vec<u32> = self.around[gone as usize].clone();
        if !self.is_rim(kept) {
            moved.extend(&self.around[kept as usize]);
        }
        moved.retain(|k| !doomed.contains(k));
        let keeps_side = moved.iter().all(|&k| {
            let t = self.triangles[k as usize];
            let [p, q, r] = t.map(|v| {
                if v == gone || v == kept {
                    position
                } else {
                    self.points[v as usize]
                }
            });
            unit(cross_normal(&p, &q, &r)).dot(&self.normal(t)) > LARGEST_TURN
        });
        if !keeps_side {
            return None;
        }
        for k in doomed {
            self.remove(k);
        }
        for k in self.around[gone as usize].clone() {
            let t = self.triangles[k as usize].map(|v| if v == gone { kept } else { v });
            self.replace(k, t);
        }
        self.points[kept as usize] = position;
        Some(kept)
    }

    /// Swaps edges as long as that raises the smaller one of the smallest angles at an edge, and returns how many.
    ///
    /// # Errors
    /// [`ErrorKind::Cancelled`].
    pub(super) fn swap_edges(&mut self, job: &Job<'_>) -> Result<usize> {
        let mut waiting = self.interior_edges();
        // Taken from the end: the order of the sorted edges.
        waiting.reverse();
        let mut count = 0;
        while let Some((a, b)) = waiting.pop() {
            if count % 1024 == 1023 {
                job.ask()?;
            }
            let Some([c, d]) = self.swap(a, b) else {
                continue;
            };
            count += 1;
            for (v, w) in [(a, c), (a, d), (b, c), (b, d)] {
                waiting.push((v.min(w), v.max(w)));
            }
        }
        Ok(count)
    }

    /// Swaps an edge if that is allowed and better; returns the ends of the new one.
    fn swap(&mut self, a: u32, b: u32) -> Option<[u32; 2]> {
        let [(k, [from, to, c]), (l, [_, _, d])] = self.at_edge(a, b)[..] else {
            return None;
        };
        if self.is_rim(c) && self.is_rim(d) && self.hole.is_joined(c, d) {
            return None;
        }
        if !self.at_edge(c, d).is_empty() {
            return None;
        }
        let old = [self.triangles[k as usize], self.triangles[l as usize]];
        let new = [[c, from, d], [d, to, c]];
        let smallest = |pair: [[u32; 3]; 2]| {
            let angle = |t: [u32; 3]| smallest_angle(t.map(|v| self.points[v as usize]));
            angle(pair[0]).min(angle(pair[1]))
        };
        if smallest(new) < smallest(old) + LEAST_GAIN {
            return None;
        }
        let middle = unit(self.normal(old[0]) + self.normal(old[1]));
        if new
            .iter()
            .any(|&t| self.normal(t).dot(&middle) < LARGEST_TURN)
        {
            return None;
        }
        self.replace(k, new[0]);
        self.replace(l, new[1]);
        Some([c, d])
    }

    /// Swaps edges at which the patch is folded, if it is folded less afterwards.
    pub(super) fn unfold(&mut self, folded: f64) {
        for [a, b, c, d] in self.folds(folded) {
            let is_pair = matches!(self.at_edge(a, b)[..], [(_, [_, _, e]), (_, [_, _, f])] if (e, f) == (c, d));
            let is_barred = self.is_rim(c) && self.is_rim(d) && self.hole.is_joined(c, d);
            if !is_pair || is_barred || !self.at_edge(c, d).is_empty() {
                continue;
            }
            let around = [(a, c), (c, b), (b, d), (d, a)];
            let worst = |editor: &Self, inner: (u32, u32)| {
                let edges = around.iter().chain([&inner]);
                edges.map(|&(v, w)| editor.bend(v, w)).fold(1.0, f64::min)
            };
            let before = worst(self, (a, b));
            let [(k, [from, to, _]), (l, _)] = self.at_edge(a, b)[..] else {
                continue;
            };
            let old = [self.triangles[k as usize], self.triangles[l as usize]];
            self.replace(k, [c, from, d]);
            self.replace(l, [d, to, c]);
            if worst(self, (c, d)) <= before {
                self.replace(k, old[0]);
                self.replace(l, old[1]);
            }
        }
    }

    /// The cosine of the angle between the normals at an edge; 1 at the rim.
    fn bend(&self, a: u32, b: u32) -> f64 {
        match self.at_edge(a, b)[..] {
            [(k, _), (l, _)] => {
                let [n, m] = [k, l].map(|k| self.normal(self.triangles[k as usize]));
                n.dot(&m)
            }
            _ => 1.0,
        }
    }

    /// The edges at which neighbouring triangles turn by more than the angle with the cosine `folded`, each with the
    /// four vertices of its triangles.
    pub(super) fn folds(&self, folded: f64) -> Vec<[u32; 4]> {
        let mut folds = Vec::new();
        for (a, b) in self.interior_edges() {
            if let [(k, [_, _, c]), (l, [_, _, d])] = self.at_edge(a, b)[..] {
                let [n, m] = [k, l].map(|k| self.normal(self.triangles[k as usize]));
                if n.dot(&m) < folded {
                    folds.push([a, b, c, d]);
                }
            }
        }
        folds
    }
}

/// In radians.
fn smallest_angle(t: [Vec3; 3]) -> f64 {
    (0..3)
        .map(|k| (t[(k + 1) % 3] - t[k]).angle(&(t[(k + 2) % 3] - t[k])))
        .fold(f64::INFINITY, f64::min)
}
