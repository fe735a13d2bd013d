//! Step 7, second half: collapses edges that are too short, and swaps edges for better angles.
//!
//! Rim vertices do not move, and rim edges stay. No collapse or swap makes an edge between two rim vertices that the
//! mesh joins already, turns a triangle over, or makes the patch non-manifold.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, sections 4.7 and 4.8, with the economical order of collapses of 4.8.
//! `O(n log n)` for `n` triangles whose vertices have bounded valence.

use crate::error::Result;
use crate::hole::Hole;
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use crate::patch::PatchSurface;
use crate::patch::chords::{joined_chords, split_middle};
use crate::patch::mesh::{Halfedge, PatchMesh, next, prev};
use std::collections::BTreeSet;

/// A collapse or swap must not turn a normal so far that the cosine of the angle is below this, 60°.
const LARGEST_TURN: f64 = 0.5;

/// Lower bound on the gain of the smallest angle by a swap, in radians. It keeps rounding errors from swapping an edge
/// back and forth.
const LEAST_GAIN: f64 = 1e-6;

/// A patch that is being changed.
pub(super) struct Editor<'a> {
    mesh: PatchMesh,
    points: Vec<Vec3>,
    hole: &'a Hole,
    /// The number of the last change of each triangle, and how many there were. Of two triangles at an edge the one that
    /// was changed earlier comes first, which settles the order of the swaps.
    changed: Vec<usize>,
    /// Number of changes so far.
    changes: usize,
}

impl<'a> Editor<'a> {
    /// Starts with a patch. Each edge between two rim vertices that the mesh joins already is split.
    ///
    /// # Errors
    /// Those of [`PatchMesh::new`].
    pub(super) fn new(surface: PatchSurface, hole: &'a Hole) -> Result<Self> {
        let triangle_count = surface.triangles.len();
        let point_count = surface.points.len();
        let mut editor = Self {
            mesh: PatchMesh::new(surface.triangles, point_count, surface.rim_count)?,
            points: surface.points,
            hole,
            changed: (0..triangle_count).collect(),
            changes: triangle_count,
        };
        let mut chords = joined_chords(&editor.mesh, hole);
        chords.sort_unstable();
        for (a, b) in chords {
            let Some([h, g]) = editor.sides(a, b) else {
                continue;
            };
            let added = editor.mesh.triangles().len() as Halfedge;
            split_middle(&mut editor.mesh, &mut editor.points, h, g);
            for t in [h / 3, added, g / 3, added + 1] {
                editor.touch(t);
            }
        }
        Ok(editor)
    }

    /// The patch, without triangles that were removed and without points that no triangle uses.
    pub(super) fn finish(self) -> PatchSurface {
        let rim_count = self.hole.rim().len();
        let mut number = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        for (v, p) in self.points.iter().enumerate() {
            if v < rim_count || self.mesh.closed_start(v as u32).is_some() {
                number[v] = points.len() as u32;
                points.push(*p);
            }
        }
        let triangles = self.mesh.living();
        PatchSurface {
            rim_count,
            points,
            triangles: triangles.map(|t| t.map(|v| number[v as usize])).collect(),
        }
    }

    pub(super) fn points_mut(&mut self) -> &mut [Vec3] {
        &mut self.points
    }

    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.mesh.living()
    }

    fn is_rim(&self, v: u32) -> bool {
        (v as usize) < self.mesh.rim_count()
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        (self.points[a as usize] - self.points[b as usize]).norm()
    }

    fn normal(&self, t: [u32; 3]) -> Vec3 {
        let [a, b, c] = t.map(|v| self.points[v as usize]);
        unit(cross_normal(&a, &b, &c))
    }

    fn triangle(&self, h: Halfedge) -> [u32; 3] {
        self.mesh.triangles()[h as usize / 3]
    }

    fn normal_at(&self, h: Halfedge) -> Vec3 {
        self.normal(self.triangle(h))
    }

    /// Records a change of triangle `t`.
    fn touch(&mut self, t: u32) {
        self.changed.resize(self.mesh.triangles().len(), 0);
        self.changed[t as usize] = self.changes;
        self.changes += 1;
    }

    /// The two halfedges of the edge between two vertices, that of the earlier changed triangle first. `None` if there
    /// is no such edge with two triangles.
    fn sides(&self, a: u32, b: u32) -> Option<[Halfedge; 2]> {
        let h = self.mesh.edge_between(a, b)?;
        let g = self.mesh.opposite(h)?;
        let mut sides = [h, g];
        sides.sort_by_key(|&h| self.changed[h as usize / 3]);
        Some(sides)
    }

    /// All edges with two triangles, each with its smaller end first, sorted.
    fn interior_edges(&self) -> Vec<(u32, u32)> {
        let ends = |h| (self.mesh.origin(h), self.mesh.target(h));
        let edges = self.mesh.interior_edges().map(ends);
        let mut edges: Vec<(u32, u32)> = edges.map(|(a, b)| (a.min(b), a.max(b))).collect();
        edges.sort_unstable();
        edges
    }

    /// Collapses edges that are shorter than `shortest`, the shortest first, and returns their number. Two interior
    /// points move to their midpoint; an interior point moves to a rim vertex.
    pub(super) fn collapse_short(&mut self, shortest: f64) -> usize {
        let key = |editor: &Self, (a, b): (u32, u32)| (editor.length(a, b).to_bits(), a, b);
        let mut sorted: Vec<(u64, u32, u32)> = self
            .interior_edges()
            .into_iter()
            .map(|edge| key(self, edge))
            .filter(|e| f64::from_bits(e.0) < shortest)
            .collect();
        sorted.sort_unstable();
        // Edges still to collapse: the sorted ones from `id` on, and those that collapses changed (the set NS of the
        // paper).
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
            // The edge was removed or changed since.
            if self.sides(a, b).is_none() || self.length(a, b).to_bits() != edge.0 {
                continue;
            }
            let Some(kept) = self.collapse(a, b) else {
                continue;
            };
            count += 1;
            for w in self.mesh.neighbors(kept) {
                let (a, b) = (kept.min(w), kept.max(w));
                let renewed_edge = key(self, (a, b));
                if f64::from_bits(renewed_edge.0) < shortest {
                    renewed.insert(renewed_edge);
                }
            }
        }
    }

    /// Collapses an interior edge, if that is allowed, and returns the vertex that remains.
    fn collapse(&mut self, a: u32, b: u32) -> Option<u32> {
        let (kept, gone) = if self.is_rim(b) { (b, a) } else { (a, b) };
        let position = if self.is_rim(kept) {
            self.points[kept as usize]
        } else {
            (self.points[a as usize] + self.points[b as usize]) / 2.0
        };
        if self.is_rim(kept) {
            let of_kept = self.mesh.neighbors(kept);
            let is_new = |w: u32| w != kept && of_kept.binary_search(&w).is_err();
            let mut of_gone = self.mesh.neighbors(gone).into_iter();
            if of_gone.any(|w| is_new(w) && self.hole.is_joined(kept, w)) {
                return None;
            }
        }
        let keeps_side = |h: Halfedge| {
            let t = self.triangle(h);
            let is_end = |v: u32| v == gone || v == kept;
            let moved = t.map(|v| {
                if is_end(v) {
                    position
                } else {
                    self.points[v as usize]
                }
            });
            let [p, q, r] = moved;
            t.into_iter().filter(|&v| is_end(v)).count() == 2
                || unit(cross_normal(&p, &q, &r)).dot(&self.normal(t)) > LARGEST_TURN
        };
        let mut moved = self.mesh.corners(gone);
        if !moved.all(keeps_side)
            || (!self.is_rim(kept) && !self.mesh.corners(kept).all(keeps_side))
        {
            return None;
        }
        let [h, g] = self.sides(a, b)?;
        let h = if self.mesh.origin(h) == gone { h } else { g };
        let mut left: Vec<u32> = self.mesh.corners(gone).map(|h| h / 3).collect();
        if !self.mesh.collapse(h) {
            return None;
        }
        left.sort_by_key(|&t| self.changed[t as usize]);
        left.into_iter().for_each(|t| self.touch(t));
        self.points[kept as usize] = position;
        Some(kept)
    }

    /// Swaps edges as long as a swap increases the smallest angle of the two triangles at an edge. Returns the number
    /// of swaps.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Cancelled`].
    pub(super) fn swap_edges(&mut self, job: &Job<'_>) -> Result<usize> {
        let mut waiting = self.interior_edges();
        // `pop` takes from the end, so this gives the order of the sorted edges.
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

    /// Swaps an edge, if that is allowed and better, and returns the ends of the new edge.
    fn swap(&mut self, a: u32, b: u32) -> Option<[u32; 2]> {
        let [h, g] = self.sides(a, b)?;
        let new = self.swapped(h, g)?;
        let old = [self.triangle(h), self.triangle(g)];
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
        self.flip(h, g);
        Some([new[0][0], new[1][0]])
    }

    /// The triangles that replace those of `h` and `g` when their edge is swapped; `None` if the new edge exists
    /// already in the patch or the mesh.
    fn swapped(&self, h: Halfedge, g: Halfedge) -> Option<[[u32; 3]; 2]> {
        let mesh = &self.mesh;
        let (a, b, c, d) = (mesh.origin(h), mesh.origin(g), mesh.apex(h), mesh.apex(g));
        let is_taken = self.hole.is_joined(c, d) || mesh.has_edge(c, d);
        (!is_taken).then_some([[c, a, d], [d, b, c]])
    }

    /// Swaps an edge; the new triangles are those of [`Self::swapped`].
    fn flip(&mut self, h: Halfedge, g: Halfedge) {
        self.mesh.flip(h, g);
        self.mesh.place(prev(h), h / 3);
        self.mesh.place(prev(g), g / 3);
        self.touch(h / 3);
        self.touch(g / 3);
    }

    /// Swaps edges at which the patch is folded, if it is folded less after the swap.
    pub(super) fn unfold(&mut self, folded: f64) {
        for [a, b, c, d] in self.folds(folded) {
            let Some([h, g]) = self.sides(a, b) else {
                continue;
            };
            if (self.mesh.apex(h), self.mesh.apex(g)) != (c, d) {
                continue;
            }
            let Some(new) = self.swapped(h, g) else {
                continue;
            };
            let [at_h, at_g] = new.map(|t| self.normal(t));
            // The edges round the two triangles, each with the normal at it before and after the swap.
            let (old_h, old_g) = (self.normal_at(h), self.normal_at(g));
            let round = [
                (next(h), old_h, at_g),
                (prev(h), old_h, at_h),
                (next(g), old_g, at_h),
                (prev(g), old_g, at_g),
            ];
            let mut before = old_h.dot(&old_g).min(1.0);
            let mut after = at_h.dot(&at_g).min(1.0);
            for (side, old, new) in round {
                if let Some(outside) = self.mesh.opposite(side) {
                    let normal = self.normal_at(outside);
                    before = before.min(old.dot(&normal));
                    after = after.min(new.dot(&normal));
                }
            }
            if after > before {
                self.flip(h, g);
            } else {
                // The triangles count as changed; this decides the order in `sides`.
                self.touch(h / 3);
                self.touch(g / 3);
            }
        }
    }

    /// The edges at which the cosine of the angle between the normals is below `folded`, each with the four vertices of
    /// its triangles.
    pub(super) fn folds(&self, folded: f64) -> Vec<[u32; 4]> {
        let mut folds = Vec::new();
        for (a, b) in self.interior_edges() {
            if let Some([h, g]) = self.sides(a, b)
                && self.normal_at(h).dot(&self.normal_at(g)) < folded
            {
                folds.push([a, b, self.mesh.apex(h), self.mesh.apex(g)]);
            }
        }
        folds
    }
}

/// The smallest angle of a triangle, in radians.
fn smallest_angle(t: [Vec3; 3]) -> f64 {
    (0..3)
        .map(|k| (t[(k + 1) % 3] - t[k]).angle(&(t[(k + 2) % 3] - t[k])))
        .fold(f64::INFINITY, f64::min)
}
