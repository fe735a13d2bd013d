//! Patches that were made and are not part of the mesh.

use super::history::Stamp;
use crate::fill::patch::record;
use crate::fill::report::FillReport;
use crate::fill::stitch::PlannedOpening;
use crate::options::FillOptions;

/// Patches that were made for some holes and are not part of the mesh. Holds nothing of the mesh.
///
/// Each patch is checked by itself: against the mesh, not against the other patches, which
/// [`FillSession::apply`](crate::FillSession::apply) does.
#[derive(Clone)]
pub struct FillPlan {
    pub(super) stamp: Stamp,
    pub(super) options: FillOptions,
    pub(super) openings: Vec<PlannedOpening>,
    pub(super) report: FillReport,
}

/// One patch of a plan: new vertices and triangles, in the indices of the mesh it was made for.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedPatch {
    /// Id of the loop that bounds it.
    pub loop_id: usize,
    /// Index of the first new vertex: vertices of the mesh are below it, and so are those of the patches before
    /// this one.
    pub first_vertex: usize,
    /// Positions of the new vertices.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles, oriented like those round the hole.
    pub triangles: Vec<[u32; 3]>,
}

impl FillPlan {
    /// What each loop would get: ranges are those of the plan's own numbering, in which the patches follow each
    /// other. Status [`HoleStatus::Filled`](crate::HoleStatus::Filled) says that there is a patch.
    #[must_use]
    pub fn report(&self) -> &FillReport {
        &self.report
    }

    /// Number of vertices of the mesh when the plan was made: the first new vertex has this index.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.stamp.size[0]
    }

    /// The patch for the loop `id`; `None` where there is none, and for an island, which belongs to the patch round it.
    #[must_use]
    pub fn patch(&self, id: usize) -> Option<PlannedPatch> {
        let (_, outcome, _) = self.openings.iter().find(|planned| planned.0.id() == id)?;
        let patch = outcome.as_ref().ok()?;
        let report = self.report.holes.iter().find(|report| report.id == id)?;
        let first_vertex = report.new_vertices.start as usize;
        Some(PlannedPatch {
            loop_id: id,
            first_vertex,
            vertices: patch.points.iter().map(|&p| p.into()).collect(),
            triangles: patch.triangles_after(first_vertex),
        })
    }

    /// Takes what was planned, and reports it.
    pub(super) fn take(&mut self, planned: impl Iterator<Item = PlannedOpening>) {
        let [mut vertices, mut triangles] = self.stamp.size;
        for (opening, outcome, seconds) in planned {
            let size = [vertices, triangles];
            let reports = &mut self.report.holes;
            record(&opening, outcome.as_ref(), size, seconds, reports);
            if let Ok(patch) = &outcome {
                vertices += patch.points.len();
                triangles += patch.triangles.len();
            }
            self.openings.push((opening, outcome, seconds));
        }
    }
}
