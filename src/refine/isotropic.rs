//! Refines a patch: splits, flips and relaxes until no edge is longer than its target length allows.
//!
//! Each pass splits edges that are too long, the longest first and at most one edge of a triangle. Then it restores the
//! Delaunay property and relaxes the vertices. When a pass splits only few edges, the whole patch gets its final
//! relaxations. Edges that became too long by these are split in passes that work only near their new vertices. Rim
//! vertices do not move, and rim edges are neither split nor flipped. No edge is collapsed.
//!
//! Sources: P. Liepa, "Filling holes in meshes", Symposium on Geometry Processing, 2003, for the size attribute and the
//! Delaunay property; M. Botsch and L. Kobbelt, "A remeshing approach to multiresolution modeling", Symposium on
//! Geometry Processing, 2004, for edge splits and tangential relaxation.
//!
//! Cost: `O(n log n)` for `n` triangles in the result, in all measurements. Not guaranteed: that no two triangles of a
//! strongly twisted patch intersect.

use super::density::SizeField;
use super::flip::{Blocked, Flipper};
use super::locality::renumber;
use super::relax::relax;
use crate::error::{Error, Result};
use crate::job::Job;
use crate::math::Vec3;
use crate::patch::PatchSurface;
use crate::patch::mesh::{Halfedge, PatchMesh, next, prev};
use std::cmp::Reverse;

/// Upper bound on the number of passes. A pass roughly halves the longest edges, so only inputs on which splitting
/// has no effect come near this bound.
const MAX_PASSES: usize = 128;

/// If a pass adds fewer vertices than this share, the whole patch gets its final relaxations. Later passes relax only
/// the neighborhood of their own vertices.
const LOCAL_PASS: f64 = 0.2;

/// Number of rings round a new vertex that a local pass relaxes.
const LOCAL_RINGS: usize = 1;

/// Lower bound on the vertices of a patch that is renumbered. A smaller one fits into the cache in any order.
const RENUMBER_FROM: usize = 5_000;

/// Growth of the number of vertices after which the patch is renumbered again.
const RENUMBER_GROWTH: f64 = 1.3;

/// Relaxation ends when no vertex moves by more than this share of its target edge length.
const SETTLED_MOVE: f64 = 1e-3;

/// A rim of at most this number of edges is closed without an interior vertex, if no edge exceeds its target length by
/// more than `SMALL_RIM_FACTOR`.
const SMALL_RIM: usize = 5;

/// See [`SMALL_RIM`]. The diagonal of a regular pentagon, divided by its side, is 1.618; irregular ones have a bit
/// more.
const SMALL_RIM_FACTOR: f64 = 1.75;

/// A rim edge is holding if its squared length, divided by the squared length above which an interior edge would be
/// split, is above this. Then the other sides of its triangle are not split: since the rim edge stays, the longer of
/// them is about too long wherever the third corner is.
const HOLDING: f64 = 2.0;

/// The parameters of refinement.
#[derive(Clone)]
pub(crate) struct RefineOptions<'a> {
    /// An interior edge is split if its length, divided by the mean target length of its ends, is above this.
    pub(crate) split_factor: f64,
    /// The same for interior edges between two rim vertices.
    pub(crate) chord_factor: f64,
    /// Growth of the target length, divided by the distance from the rim; 0 gives a uniform density.
    pub(crate) grading: f64,
    /// Relaxations after each pass of splits.
    pub(crate) pass_relaxations: usize,
    /// Relaxations of the whole patch when only few edges are left to split; at least `pass_relaxations` if the last
    /// pass split an edge.
    pub(crate) final_relaxations: usize,
    /// Upper bound on the vertices of the result. Refinement fails if it needs more.
    pub(crate) max_vertices: usize,
    /// The job, which can be cancelled.
    pub(crate) job: &'a Job<'a>,
}

impl<'a> RefineOptions<'a> {
    pub(crate) fn new(job: &'a Job<'a>) -> Self {
        Self {
            split_factor: 1.4,
            chord_factor: 1.25,
            grading: 0.0,
            pass_relaxations: 2,
            final_relaxations: 3,
            max_vertices: 10_000_000,
            job,
        }
    }
}

/// The report of a refinement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RefineReport {
    /// Vertices inserted.
    pub(crate) splits: usize,
    /// Edges flipped.
    pub(crate) flips: usize,
    /// Largest move of a vertex in the last relaxation, in target edge lengths.
    pub(crate) last_move: f64,
}

/// Refines `surface` until no interior edge is longer than its target length allows. Edges beside a rim edge that is at
/// least as long and [`HOLDING`] are excepted.
///
/// `sizes` are the target edge lengths of all vertices or of the rim vertices; at return, of all vertices.
/// `blocked(a, b)` says that the mesh has an edge between the rim vertices `a` and `b`, so the patch must not have
/// one. The function can be called again after the points moved; if no edge is too long, this costs a few tests of
/// every edge and the final relaxations. Rim vertices keep their numbers. Interior vertices keep them unless a patch
/// of some thousand vertices grows by a third. Triangles are reordered.
///
/// # Errors
/// `Topology` or `InvalidInput` for a patch that is not manifold, points that are not finite or sizes that are not
/// positive; `Limit` when more than `max_vertices` are needed; `Cancelled`. The surface is then unchanged.
pub(crate) fn refine(
    surface: &mut PatchSurface,
    sizes: &mut Vec<f64>,
    options: &RefineOptions<'_>,
    blocked: &Blocked<'_>,
) -> Result<RefineReport> {
    if !surface.points.iter().flatten().all(|x| x.is_finite()) {
        return Err(Error::invalid("a patch point is not finite"));
    }
    options.job.ask()?;
    let mesh = PatchMesh::new(
        surface.triangles.clone(),
        surface.points.len(),
        surface.rim_count,
    )?;
    options.job.ask()?;
    let field = SizeField::new(&mesh, &surface.points, sizes, options.grading, options.job)?;
    let mut refiner = Refiner {
        points: surface.points.clone(),
        mesh,
        sizes: field,
        options,
        flipper: Flipper::new(blocked, options.job),
        dirty: Vec::new(),
        ordered: surface.points.len().max(RENUMBER_FROM),
        report: RefineReport::default(),
    };
    refiner.run()?;
    options.job.ask()?;
    surface.points = refiner.points;
    surface.triangles = refiner.mesh.triangles().to_vec();
    *sizes = refiner.sizes.into_sizes();
    Ok(refiner.report)
}

/// An edge to split: its length above the threshold, in quarters of an octave, and one of its halfedges.
type LongEdge = (Reverse<u32>, Halfedge);

struct Refiner<'a> {
    mesh: PatchMesh,
    points: Vec<Vec3>,
    sizes: SizeField,
    options: &'a RefineOptions<'a>,
    flipper: Flipper<'a>,
    /// Edges that may not be Delaunay any more, because of a split or a move.
    dirty: Vec<Halfedge>,
    /// Number of vertices at the last renumbering.
    ordered: usize,
    report: RefineReport,
}

impl Refiner<'_> {
    fn run(&mut self) -> Result<()> {
        self.restore_all()?;
        let mut relaxations = self.options.final_relaxations;
        for _ in 0..MAX_PASSES {
            let before = self.mesh.vertex_count();
            let long = self.all_long_edges();
            let added = self.split_edges(long)?;
            self.restore_dirty()?;
            self.order_if_grown()?;
            if added < local_limit(before) {
                if added > 0 {
                    relaxations = relaxations.max(self.options.pass_relaxations);
                }
                break;
            }
            for _ in 0..self.options.pass_relaxations {
                self.relax_all()?;
            }
            #[cfg(test)]
            self.mesh.validate();
        }
        for _ in 0..relaxations {
            self.relax_all()?;
            if self.report.last_move < SETTLED_MOVE {
                break;
            }
        }
        self.split_the_rest()
    }

    /// Does passes until no edge is too long, each near the splits of the one before.
    fn split_the_rest(&mut self) -> Result<()> {
        // The vertices near the last pass; `None` if it was not local.
        let mut near: Option<Vec<u32>> = None;
        for _ in 0..MAX_PASSES {
            let before = self.mesh.vertex_count();
            self.options.job.ask()?;
            let long = match &near {
                Some(near) => self.long_edges_at(near),
                None => self.all_long_edges(),
            };
            self.options.job.ask()?;
            let added = self.split_edges(long)?;
            if added == 0 && near.take().is_none() {
                break;
            }
            self.restore_dirty()?;
            let local = !self.order_if_grown()? && added < local_limit(before);
            self.options.job.ask()?;
            near = (local && added > 0).then(|| self.vertices_near(before as u32));
            for _ in 0..self.options.pass_relaxations {
                match &near {
                    Some(near) => self.relax_some(near)?,
                    None if added > 0 => self.relax_all()?,
                    None => {}
                }
            }
            #[cfg(test)]
            self.mesh.validate();
        }
        Ok(())
    }

    /// Renumbers vertices and triangles if the patch grew enough, and returns whether it did.
    fn order_if_grown(&mut self) -> Result<bool> {
        let grown = self.mesh.vertex_count() as f64 > RENUMBER_GROWTH * self.ordered as f64;
        if grown {
            self.ordered = self.mesh.vertex_count();
            self.options.job.ask()?;
            renumber(&mut self.mesh, &mut self.points, &mut self.sizes);
            self.options.job.ask()?;
        }
        Ok(grown)
    }

    /// The squared length of an edge, divided by the squared length above which it is split.
    #[inline]
    fn squared_excess(&self, a: u32, b: u32) -> f64 {
        let rim = self.mesh.rim_count();
        let factor = if (a.max(b) as usize) >= rim {
            self.options.split_factor
        } else if rim > SMALL_RIM {
            self.options.chord_factor
        } else {
            self.options.split_factor.max(SMALL_RIM_FACTOR)
        };
        let limit = 0.5 * factor * (self.sizes.at(a) + self.sizes.at(b));
        self.squared_length(a, b) / (limit * limit)
    }

    #[inline]
    fn squared_length(&self, a: u32, b: u32) -> f64 {
        (self.points[a as usize] - self.points[b as usize]).norm_squared()
    }

    /// Whether a triangle at the edge of `h` has a rim edge that is at least as long and [`HOLDING`]. Splitting the
    /// edge of `h` would have no lasting effect.
    fn is_held(&self, h: Halfedge) -> bool {
        let ends = |h: Halfedge| (self.mesh.origin(h), self.mesh.target(h));
        let (a, b) = ends(h);
        let length = self.squared_length(a, b);
        let holds = |side: Halfedge| {
            let (a, b) = ends(side);
            self.mesh.opposite(side).is_none()
                && self.squared_length(a, b) >= length
                && self.squared_excess(a, b) > HOLDING
        };
        let sides = [Some(h), self.mesh.opposite(h)].into_iter().flatten();
        sides.flat_map(|side| [next(side), prev(side)]).any(holds)
    }

    /// Adds the edge of `h` from `a` to `b` to the list if it is too long.
    #[inline]
    fn collect_long(&self, h: Halfedge, a: u32, b: u32, long: &mut Vec<LongEdge>) {
        let excess = self.squared_excess(a, b);
        if excess > 1.0 && !self.is_held(h) {
            // The leading bits of a positive float are its octave and half of the octave.
            long.push((Reverse((excess.to_bits() >> 51) as u32), h));
        }
    }

    /// All interior edges that are too long, with their excess.
    fn all_long_edges(&self) -> Vec<LongEdge> {
        let mut long = Vec::new();
        for (t, (&[a, b, c], opposite)) in self.mesh.triangles_and_opposites().enumerate() {
            let h = 3 * t as Halfedge;
            for (h, from, to, opposite) in [
                (h, a, b, opposite[0]),
                (h + 1, b, c, opposite[1]),
                (h + 2, c, a, opposite[2]),
            ] {
                // each edge once
                if opposite.is_some_and(|g| h < g) {
                    self.collect_long(h, from, to, &mut long);
                }
            }
        }
        long
    }

    /// The edges at `vertices` that are too long, with their excess. An edge may occur twice.
    fn long_edges_at(&self, vertices: &[u32]) -> Vec<LongEdge> {
        let mut long = Vec::new();
        for &v in vertices {
            for h in self.mesh.corners(v) {
                self.collect_long(h, v, self.mesh.target(h), &mut long);
            }
        }
        long
    }

    /// Splits the edges, the longest first (to a quarter of an octave), at most one edge of a triangle. Returns the
    /// number of splits.
    fn split_edges(&mut self, mut long: Vec<LongEdge>) -> Result<usize> {
        let before = self.mesh.vertex_count();
        long.sort_by_key(|&(class, _)| class);
        let mut used = vec![false; self.mesh.triangles().len()];
        for (_, h) in long {
            self.options.job.tick(5)?;
            let Some(g) = self.mesh.opposite(h) else {
                continue;
            };
            let is_used = |h: Halfedge| used.get(h as usize / 3).is_none_or(|&u| u);
            if is_used(h) || is_used(g) {
                continue;
            }
            if self.mesh.vertex_count() >= self.options.max_vertices {
                return Err(Error::limit(format!(
                    "the patch needs more than {} vertices",
                    self.options.max_vertices
                )));
            }
            used[h as usize / 3] = true;
            used[g as usize / 3] = true;
            self.split(h, g);
        }
        let added = self.mesh.vertex_count() - before;
        self.report.splits += added;
        Ok(added)
    }

    fn split(&mut self, h: Halfedge, g: Halfedge) {
        let (a, b) = (self.mesh.origin(h), self.mesh.origin(g));
        let apexes = [self.mesh.apex(h), self.mesh.apex(g)];
        let middle = self.points[a as usize] * 0.5 + self.points[b as usize] * 0.5;
        self.sizes
            .push_midpoint(&self.points, &middle, [a, b], apexes);
        self.points.push(middle);
        // The edges at the new vertex are Delaunay, so only those that `split` returns are tested.
        self.dirty.extend(self.mesh.split(h, g));
    }

    fn restore_dirty(&mut self) -> Result<()> {
        let dirty = self.dirty.drain(..);
        self.report.flips += self.flipper.restore(&mut self.mesh, &self.points, dirty)?;
        Ok(())
    }

    fn restore_all(&mut self) -> Result<()> {
        self.report.flips += self.flipper.restore_all(&mut self.mesh, &self.points)?;
        Ok(())
    }

    fn relax_all(&mut self) -> Result<()> {
        self.report.last_move = 0.0;
        for v in self.mesh.rim_count() as u32..self.mesh.vertex_count() as u32 {
            self.options.job.tick(5)?;
            self.relax_vertex(v);
        }
        self.restore_all()
    }

    /// Relaxes interior `vertices` and makes the edges round them Delaunay again.
    fn relax_some(&mut self, vertices: &[u32]) -> Result<()> {
        self.report.last_move = 0.0;
        for &v in vertices {
            self.options.job.tick(5)?;
            self.relax_vertex(v);
            self.dirty
                .extend(self.mesh.corners(v).flat_map(|h| [h, next(h)]));
        }
        self.restore_dirty()
    }

    fn relax_vertex(&mut self, v: u32) {
        let way = relax(&self.mesh, &mut self.points, &mut self.sizes, v);
        self.report.last_move = self.report.last_move.max(way);
    }

    /// The vertices from `first_new` on and all interior ones within [`LOCAL_RINGS`] of them, sorted.
    fn vertices_near(&self, first_new: u32) -> Vec<u32> {
        let mut near: Vec<u32> = (first_new..self.mesh.vertex_count() as u32).collect();
        let mut seen = vec![false; self.mesh.vertex_count()];
        seen[first_new as usize..].fill(true);
        seen[..self.mesh.rim_count()].fill(true); // never to be relaxed
        let mut ring = 0;
        for _ in 0..LOCAL_RINGS {
            let end = near.len();
            for i in ring..end {
                for h in self.mesh.corners(near[i]) {
                    let u = self.mesh.target(h);
                    if !std::mem::replace(&mut seen[u as usize], true) {
                        near.push(u);
                    }
                }
            }
            ring = end;
        }
        near.sort_unstable();
        near
    }
}

/// Lower bound on the new vertices of a pass that relaxes the whole patch. `before` is the number of vertices at its
/// start.
fn local_limit(before: usize) -> usize {
    (LOCAL_PASS * before as f64) as usize + 1
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{
        check_invariants, connect, disc_rim, fan_patch, refined, strip_patch,
    };
    use super::super::flip::count_violations;
    use super::*;
    use crate::job::UNLIMITED;

    fn smallest_angles_deg(surface: &PatchSurface) -> Vec<f64> {
        let mut angles: Vec<f64> = surface
            .triangles
            .iter()
            .map(|t| {
                let p = t.map(|v| surface.points[v as usize]);
                (0..3)
                    .map(|i| {
                        (p[(i + 1) % 3] - p[i])
                            .angle(&(p[(i + 2) % 3] - p[i]))
                            .to_degrees()
                    })
                    .fold(f64::INFINITY, f64::min)
            })
            .collect();
        angles.sort_by(f64::total_cmp);
        angles
    }

    /// Lengths of the interior edges over their target.
    fn relative_lengths(surface: &PatchSurface, sizes: &[f64]) -> Vec<f64> {
        let mesh = connect(surface);
        (0..mesh.halfedge_count())
            .filter(|&h| mesh.opposite(h).is_some_and(|g| h < g))
            .map(|h| [mesh.origin(h) as usize, mesh.target(h) as usize])
            .map(|[a, b]| {
                2.0 * (surface.points[a] - surface.points[b]).norm() / (sizes[a] + sizes[b])
            })
            .collect()
    }

    fn signed_areas(surface: &PatchSurface) -> impl Iterator<Item = f64> + '_ {
        surface.triangles.iter().map(|t| {
            let p = t.map(|v| surface.points[v as usize]);
            0.5 * (p[1] - p[0]).cross(&(p[2] - p[0])).z
        })
    }

    #[test]
    fn round_discs_get_well_shaped_triangles_of_the_rims_size() {
        for m in [36, 100, 250] {
            let surface = fan_patch(disc_rim(m));
            let (out, sizes) = refined(&surface);
            let angles = smallest_angles_deg(&out);
            assert!(
                angles[angles.len() / 20] >= 38.0,
                "{m}: {}",
                angles[angles.len() / 20]
            );
            assert!(angles[0] > 20.0, "{m}: {}", angles[0]);
            let lengths = relative_lengths(&out, &sizes);
            let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
            assert!((0.95..1.08).contains(&mean), "{m}: mean {mean}");
            assert!(lengths.iter().all(|&l| l < 1.5), "{m}");
            let expected = 0.18 * (m * m) as f64;
            let count = out.triangles.len() as f64;
            assert!((0.85..1.25).contains(&(count / expected)), "{m}: {count}");
        }
    }

    #[test]
    fn planar_patches_end_delaunay_and_tile_the_hole() {
        for m in [7, 40, 120] {
            let surface = fan_patch(disc_rim(m));
            let (out, _) = refined(&surface);
            assert_eq!(
                count_violations(&connect(&out), &out.points, &|_, _| false),
                0
            );
            let area: f64 = signed_areas(&surface).sum();
            assert!((signed_areas(&out).sum::<f64>() / area - 1.0).abs() < 1e-12);
            assert!(
                signed_areas(&out).all(|a| a > 0.0),
                "{m}: a triangle folded over"
            );
        }
    }

    #[test]
    fn triangles_grow_in_proportion_to_large_rims() {
        let per_edge = |m: usize| {
            // Halving the rim again and again: the ears of a convex polygon, without a hub.
            let mut triangles = Vec::new();
            let mut ring: Vec<u32> = (0..m as u32).collect();
            while ring.len() > 3 {
                let pairs = ring
                    .chunks(2)
                    .zip(ring.iter().skip(2).step_by(2).chain(&ring[..1]));
                triangles.extend(
                    pairs
                        .filter(|(p, _)| p.len() == 2)
                        .map(|(p, &next)| [p[0], p[1], next]),
                );
                ring = ring.into_iter().step_by(2).collect();
            }
            if let [a, b, c] = ring[..] {
                triangles.push([a, b, c]);
            }
            let surface = PatchSurface {
                rim_count: m,
                points: disc_rim(m),
                triangles,
            };
            refined(&surface).0.triangles.len() as f64 / m as f64
        };
        let (small, middle, large) = (per_edge(1536), per_edge(3072), per_edge(6144));
        assert!((9.0..16.0).contains(&large), "{large}");
        assert!(small > middle && middle > large && large > 0.75 * small);
    }

    #[test]
    fn the_smallest_holes_get_no_vertex_unless_their_size_asks_for_it() {
        for m in [3, 4, 5] {
            let surface = fan_patch(disc_rim(m));
            assert_eq!(refined(&surface).0.triangles.len(), m - 2);
            let mut fine = surface.clone();
            let options = RefineOptions::new(&UNLIMITED);
            refine(&mut fine, &mut vec![0.3; m], &options, &|_, _| false).unwrap();
            // A triangle alone has no interior edge to split.
            assert_eq!(fine.points.len() > m, m > 3);
        }
        let (hexagon, _) = refined(&fan_patch(disc_rim(6)));
        assert_eq!(hexagon.triangles.len(), 6);
        assert!(hexagon.points[6].norm() < 1e-2);
    }

    #[test]
    fn no_long_edge_ties_two_sides_of_the_rim_together() {
        // Staggered rails: every edge across is 1.32 long, too short to be split for its length.
        let rails: Vec<_> = (0..60)
            .map(|k| {
                (
                    Vec3::new(k as f64, 0.0, 0.0),
                    Vec3::new(k as f64 + 0.5, 1.22, 0.0),
                )
            })
            .collect();
        let surface = strip_patch(&rails);
        let mut out = surface.clone();
        refine(
            &mut out,
            &mut vec![1.0; 120],
            &RefineOptions::new(&UNLIMITED),
            &|_, _| false,
        )
        .unwrap();
        let mesh = connect(&out);
        let rim = out.rim_count as u32;
        let chords: Vec<_> = (0..mesh.halfedge_count())
            .filter(|&h| mesh.opposite(h).is_some() && mesh.origin(h).max(mesh.target(h)) < rim)
            .map(|h| out.points[mesh.origin(h) as usize] - out.points[mesh.target(h) as usize])
            .filter(|edge| edge.norm() > 1.3)
            .collect();
        assert!(chords.is_empty(), "{chords:?}");
        let loose = RefineOptions {
            chord_factor: 1.4,
            ..RefineOptions::new(&UNLIMITED)
        };
        let mut kept = surface.clone();
        refine(&mut kept, &mut vec![1.0; 120], &loose, &|_, _| false).unwrap();
        assert_eq!(kept.points.len(), 120);
    }

    #[test]
    fn a_rim_edge_far_longer_than_the_target_does_not_draw_vertices_without_end() {
        // One edge of length 3 below a row of edges of length 1.
        let row = (0..=3).map(|i| Vec3::new(f64::from(3 - i), 1.2, 0.0));
        let rim: Vec<Vec3> = [Vec3::zeros(), Vec3::x() * 3.0]
            .into_iter()
            .chain(row)
            .collect();
        let m = rim.len();
        let surface = PatchSurface {
            rim_count: m,
            points: rim,
            triangles: (1..m as u32 - 1).map(|i| [0, i, i + 1]).collect(),
        };
        let (mut out, mut sizes) = (surface.clone(), vec![1.0; m]);
        refine(
            &mut out,
            &mut sizes,
            &RefineOptions::new(&UNLIMITED),
            &|_, _| false,
        )
        .unwrap();
        check_invariants(&surface, &out, &sizes);
        assert!(out.triangles.len() < 20, "{}", out.triangles.len());
    }

    #[test]
    fn a_second_call_leaves_a_refined_patch_almost_alone() {
        let (mut out, mut sizes) = refined(&fan_patch(disc_rim(100)));
        let count = out.triangles.len();
        let options = RefineOptions {
            final_relaxations: 1,
            ..RefineOptions::new(&UNLIMITED)
        };
        for _ in 0..5 {
            let before = out.clone();
            let report = refine(&mut out, &mut sizes, &options, &|_, _| false).unwrap();
            check_invariants(&before, &out, &sizes);
            assert!(report.splits <= 2 && report.flips <= 10, "{report:?}");
            assert_eq!(
                report.splits + report.flips > 0,
                before.triangles != out.triangles
            );
        }
        assert!(out.triangles.len() <= count + 8);
    }

    #[test]
    fn a_patch_that_was_bulged_is_refined_to_the_same_density_again() {
        let (mut out, mut sizes) = refined(&fan_patch(disc_rim(60)));
        let radius = out.points[0].norm();
        for p in &mut out.points[60..] {
            p.z = (radius * radius - p.xy().norm_squared()).max(0.0).sqrt();
        }
        let flat = out.clone();
        let options = RefineOptions::new(&UNLIMITED);
        let report = refine(&mut out, &mut sizes, &options, &|_, _| false).unwrap();
        check_invariants(&flat, &out, &sizes);
        assert!(report.splits + report.flips > 0);
        assert!(relative_lengths(&out, &sizes).iter().all(|&l| l < 1.5));
        // A hemisphere has twice the area of its disc.
        let growth = out.triangles.len() as f64 / flat.triangles.len() as f64;
        assert!((1.5..2.6).contains(&growth), "{growth}");
    }

    #[test]
    fn twisted_strips_are_refined_without_folds() {
        let rails: Vec<_> = (0..150)
            .map(|k| {
                let angle = 0.04 * k as f64;
                let (c, s) = (angle.cos(), angle.sin());
                let rail = |r: f64| Vec3::new(r * c, r * s, 0.2 * k as f64);
                (rail(2.0), rail(8.0))
            })
            .collect();
        let (out, sizes) = refined(&strip_patch(&rails));
        let mesh = connect(&out);
        let normal = |h: u32| {
            let p = out.triangles[h as usize / 3].map(|v| out.points[v as usize]);
            (p[1] - p[0]).cross(&(p[2] - p[0])).normalize()
        };
        for h in 0..mesh.halfedge_count() {
            if let Some(g) = mesh.opposite(h) {
                assert!(normal(h).dot(&normal(g)) > 0.5);
            }
        }
        assert!(relative_lengths(&out, &sizes).iter().all(|&l| l < 1.5));
        assert!(smallest_angles_deg(&out)[out.triangles.len() / 20] > 25.0);
    }
}
