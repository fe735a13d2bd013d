//! Continues creases of the mesh across a hole, so that sharp edges stay sharp.
//!
//! 1. Find the smooth regions round the hole, and where the creases between them meet the rim (`detect`).
//! 2. Fit one surface to each region (`region`).
//! 3. Cut the hole into faces along the curves in which these surfaces meet (`partition`).
//! 4. Fill each face like a hole of its own. The vertices on its creases do not move, so the faces fit together.
//!
//! Creases are used only where they explain the surroundings at least as well as one smooth surface does: the score of
//! the regions in leave-out cross-validation must not be worse than the score of the best smooth candidate.
//!
//! Not guaranteed: creases that fade out inside the known mesh are not found.

mod detect;
mod facets;
mod intersection;
mod partition;
mod region;
mod slide;

use super::march::Marcher;
use super::surface::Implicit;
use super::surface::candidates::Candidate;
use super::surface::samples::SampledBand;
use crate::error::{Error, Result};
use crate::fair::kharmonic::Order;
use crate::hole::Hole;
use crate::math::{Vec3, unit};
use crate::mesh::pairing::pair_halfedges;
use crate::methods::fair::faired;
use crate::methods::start::refined;
use crate::methods::task::Task;
use crate::patch::PatchSurface;
use crate::quality::Surface;
use crate::quality::self_intersection::{AppendedPatch, count};
use crate::quality::spatial::FaceIndex;
use crate::surroundings::Surroundings;
use detect::{Regions, detect};
use partition::{Face, Partition, partition};
use region::{RegionSurface, fit_regions};
use slide::slide_ends;

/// A rim edge lies on a crease if the cosine between the normal of its known triangle and the normal of the face's
/// surface is at most this.
const SAME_REGION: f64 = 0.8;

/// A patch with creases.
pub(super) struct CreasePatch {
    pub(super) surface: PatchSurface,
    /// Number of creases in it.
    pub(super) count: usize,
    /// The candidate of each region, in order along the rim.
    pub(super) surfaces: Vec<Candidate>,
}

/// The work on one hole.
pub(super) struct Creases<'a> {
    pub(super) task: &'a Task<'a>,
    /// Mean edge length at the rim.
    pub(super) step: f64,
    /// Score of the best smooth candidate; the regions must not score worse.
    pub(super) smooth_score: f64,
}

impl Creases<'_> {
    /// The patch that continues the creases; `None` when there are none.
    ///
    /// # Errors
    /// [`ErrorKind::Geometry`], with the reason, when creases were found that cannot be used; those of the steps;
    /// [`ErrorKind::Cancelled`].
    pub(super) fn patch(&self) -> Result<Option<CreasePatch>> {
        let Some(mut regions) = detect(self.task.hole, self.task.job)? else {
            return Ok(None);
        };
        let allowed = |candidate: Candidate, samples: &SampledBand<'_>| {
            self.task.options.methods.auto.allows(candidate, samples)
        };
        let surfaces = fit_regions(self.task.hole, &regions, self.step, &allowed, self.task.job)?;
        let score = common_score(&regions, &surfaces);
        if score > self.smooth_score {
            return unusable("a smooth surface predicts the surroundings better than creases do");
        }
        let implicit: Vec<&dyn Implicit> = surfaces.iter().map(|s| s.surface.as_ref()).collect();
        slide_ends(self.task.hole, &mut regions, &implicit, self.step)?;
        self.task.job.ask()?;
        let partition = partition(self.task.hole, &regions, &implicit, self.step)?;
        let mut surface = PatchSurface {
            rim_count: self.task.hole.rim().len(),
            points: self.task.hole.rim().to_vec(),
            triangles: Vec::new(),
        };
        surface.points.extend_from_slice(&partition.points);
        for face in &partition.faces {
            self.fill(face, &partition, &regions, &implicit, &mut surface)?;
        }
        self.task.job.ask()?;
        if self.intersects(&surface)? {
            return unusable("the patch with creases intersects itself or its surroundings");
        }
        Ok(Some(CreasePatch {
            surface,
            count: partition.creases.len(),
            surfaces: surfaces.iter().map(|s| s.candidate).collect(),
        }))
    }

    /// Fills one face and adds it to the patch.
    fn fill(
        &self,
        face: &Face,
        partition: &Partition,
        regions: &Regions,
        surfaces: &[&dyn Implicit],
        patch: &mut PatchSurface,
    ) -> Result<()> {
        let surface = surfaces[face.region as usize];
        let faces = &regions.faces[face.region as usize];
        let shape = self.face_shape(face, partition, faces, surface, patch);
        let task = Task::new(&shape, self.task.options, self.task.job);
        let start = faired(&task, Order::One)?;
        let marcher = Marcher {
            task: &task,
            surface,
            step: self.step,
            tip: None,
            joins_with_slope: false,
        };
        let (_, sizes) = refined(&task)?;
        let filled = marcher.patch(start.clone(), sizes, &start)?;
        let inner = patch.points.len() as u32;
        let count = filled.rim_count as u32;
        let number = |v: u32| match v.checked_sub(count) {
            None => face.boundary[v as usize],
            Some(new) => inner + new,
        };
        let triangles = filled.triangles.iter().map(|t| t.map(number));
        patch.triangles.extend(triangles);
        patch
            .points
            .extend_from_slice(&filled.points[filled.rim_count..]);
        Ok(())
    }

    /// A face as a hole of its own. Its surroundings are the triangles of its region.
    fn face_shape(
        &self,
        face: &Face,
        partition: &Partition,
        known: &[u32],
        surface: &dyn Implicit,
        patch: &PatchSurface,
    ) -> Hole {
        let hole = self.task.hole;
        let rim_count = hole.rim().len();
        let boundary = &face.boundary;
        let len = boundary.len();
        let points: Vec<Vec3> = boundary.iter().map(|&v| patch.points[v as usize]).collect();
        let mut positions = vec![None; rim_count];
        for (i, &v) in (0..).zip(&hole.polygon) {
            positions[v as usize] = Some(i);
        }
        let outside_normal = |i: usize| {
            let middle = (points[i] + points[(i + 1) % len]) / 2.0;
            let normal = unit(surface.value_and_gradient(&middle).1);
            let ends = [boundary[i], boundary[(i + 1) % len]];
            let [a, b] = ends.map(|v| positions.get(v as usize).copied().flatten());
            if let (Some(a), Some(b)) = (a, b)
                && (a + 1) % hole.polygon.len() == b
                && let Some(known) = hole.outside_normals[a]
                && known.dot(&normal) > SAME_REGION
            {
                return Some(known);
            }
            (normal != Vec3::zeros()).then_some(normal)
        };
        let outside_normals = (0..len).map(outside_normal).collect();
        let edge_length = |v: &u32| hole.edge_lengths.get(*v as usize).copied();
        Hole {
            polygon: (0..len as u32).collect(),
            outside_normals,
            edge_lengths: boundary
                .iter()
                .map(|v| edge_length(v).unwrap_or(self.step))
                .collect(),
            surroundings: self.surroundings_of(face, &points, known),
            is_bridge: vec![false; len],
            joined: self.joined_of(face, partition),
        }
    }

    /// The known triangles of the face's region, with the vertex numbers of the face.
    fn surroundings_of(&self, face: &Face, rim: &[Vec3], known: &[u32]) -> Surroundings {
        let around = &self.task.hole.surroundings;
        let rim_count = around.rim().len();
        let mut numbers = vec![None; around.points().len()];
        for (i, &v) in (0..).zip(&face.boundary) {
            if (v as usize) < rim_count {
                numbers[v as usize] = Some(i);
            }
        }
        let (mut points, mut levels) = (rim.to_vec(), vec![0; rim.len()]);
        let mut numbered = |v: u32| {
            *numbers[v as usize].get_or_insert_with(|| {
                points.push(around.point(v));
                levels.push(around.levels()[v as usize].max(1));
                points.len() as u32 - 1
            })
        };
        let known = known.iter().map(|&f| around.triangles()[f as usize]);
        let triangles = known.map(|t| t.map(&mut numbered)).collect();
        Surroundings::new(rim.len(), points, levels, triangles)
    }

    /// Pairs of the face's vertices that no edge inside it may join: the mesh has that edge already, or both lie on
    /// one crease and the face on the other side could make the same edge.
    fn joined_of(&self, face: &Face, partition: &Partition) -> Vec<(u32, u32)> {
        let rim_count = self.task.hole.rim().len() as u32;
        let len = face.boundary.len() as u32;
        let shares_crease = |a: u32, b: u32| {
            let has_both = |crease: &Vec<u32>| crease.contains(&a) && crease.contains(&b);
            partition.creases.iter().any(has_both)
        };
        let mut joined = Vec::new();
        for i in 0..len {
            for j in i + 1..len {
                let [a, b] = [i, j].map(|k| face.boundary[k as usize]);
                let is_known = a < rim_count && b < rim_count && self.task.hole.is_joined(a, b);
                if is_known || shares_crease(a, b) {
                    joined.push((i, j));
                }
            }
        }
        joined
    }

    /// Whether the patch intersects itself or the known triangles next to it.
    fn intersects(&self, patch: &PatchSurface) -> Result<bool> {
        let around = &self.task.hole.surroundings;
        let rim_count = patch.rim_count as u32;
        let shift = around.outer().len() as u32;
        let number = |v: u32| if v < rim_count { v } else { v + shift };
        let triangles: Vec<[u32; 3]> = patch.triangles.iter().map(|t| t.map(number)).collect();
        let mesh = Surface {
            points: around.points(),
            triangles: around.triangles(),
        };
        let appended = AppendedPatch {
            points: &patch.points[patch.rim_count..],
            triangles: &triangles,
            twins: &pair_halfedges(&patch.triangles, patch.points.len()),
        };
        let faces = FaceIndex::build(mesh, self.task.job)?;
        Ok(count(mesh, &faces, appended, self.task.job)?.total() > 0)
    }
}

fn unusable<T>(reason: &str) -> Result<T> {
    Err(Error::geometry(reason.to_owned()))
}

/// The geometric mean of the regions' scores, weighted by their numbers of rim edges; zero when no region has a score.
fn common_score(regions: &Regions, surfaces: &[RegionSurface]) -> f64 {
    let (mut logarithms, mut count) = (0.0, 0.0);
    for &region in &regions.at_rim {
        if let Some(score) = surfaces[region as usize].score {
            logarithms += score.ln();
            count += 1.0;
        }
    }
    if count > 0.0 {
        f64::exp(logarithms / count)
    } else {
        0.0
    }
}
