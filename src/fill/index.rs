//! The spatial index of a mesh that grows: what the intersection tests of patches ask.
//!
//! One tree for the mesh as it was, and trees for what was appended since. Each of those is larger than the one
//! after it, so that there are few: O(log k) for k appended triangles, each of which is indexed O(log k) times.

use crate::error::Result;
use crate::job::Job;
use crate::mesh::trimesh::TriMesh;
use crate::quality::Surface;
use crate::quality::self_intersection::{AppendedPatch, SelfIntersections, count};
use crate::quality::spatial::FaceIndex;
use std::ops::Range;

/// Finds the triangles of a mesh near a patch.
///
/// Complexity: the first build is O(n log n) in the triangles of the mesh; what is appended or taken back later
/// costs by its own size.
#[derive(Debug)]
pub(crate) struct MeshIndex {
    /// The triangles of the mesh when the index was built.
    base: FaceIndex,
    base_count: usize,
    /// Consecutive ranges of the triangles after those.
    later: Vec<(Range<usize>, FaceIndex)>,
}

impl MeshIndex {
    /// Indexes all triangles, on the current thread pool.
    ///
    /// # Errors
    /// `Cancelled` when the job is stopped.
    pub(crate) fn build(mesh: &TriMesh, job: &Job<'_>) -> Result<Self> {
        let count = mesh.triangles().len();
        Ok(Self::around(
            FaceIndex::build(surface(mesh, 0..count), job)?,
            count,
        ))
    }

    fn around(base: FaceIndex, base_count: usize) -> Self {
        Self {
            base,
            base_count,
            later: Vec::new(),
        }
    }

    fn count(&self) -> usize {
        self.later
            .last()
            .map_or(self.base_count, |(range, _)| range.end)
    }

    /// Brings the index up to date with a mesh to which triangles were appended, or from which the last of those
    /// that were appended after the index was built were taken back.
    pub(crate) fn update(&mut self, mesh: &TriMesh) {
        let count = mesh.triangles().len();
        if count < self.base_count {
            *self = Self::around(build(mesh, 0..count), count);
            return;
        }
        self.later.retain(|(range, _)| range.start < count);
        if let Some((range, tree)) = self.later.last_mut().filter(|(range, _)| range.end > count) {
            range.end = count;
            *tree = build(mesh, range.clone());
        }
        let mut new = self.count()..count;
        if new.is_empty() {
            return;
        }
        while let Some((last, _)) = self.later.pop_if(|(last, _)| last.len() <= new.len()) {
            new.start = last.start;
        }
        self.later.push((new.clone(), build(mesh, new)));
    }

    /// The improper intersections of a patch with itself and with the indexed triangles of `mesh`.
    ///
    /// # Errors
    /// `Cancelled` when the job is stopped.
    pub(crate) fn intersections(
        &self,
        mesh: &TriMesh,
        patch: AppendedPatch<'_>,
        job: &Job<'_>,
    ) -> Result<SelfIntersections> {
        let base = surface(mesh, 0..self.base_count);
        let mut found = count(base, &self.base, patch, job)?;
        for (range, tree) in &self.later {
            let part = surface(mesh, range.clone());
            found.with_mesh += count(part, tree, patch, job)?.with_mesh;
        }
        Ok(found)
    }
}

fn surface(mesh: &TriMesh, range: Range<usize>) -> Surface<'_> {
    Surface {
        points: mesh.points(),
        triangles: &mesh.triangles()[range],
    }
}

fn build(mesh: &TriMesh, range: Range<usize>) -> FaceIndex {
    FaceIndex::build(surface(mesh, range), &Job::unlimited()).expect("nothing stops it")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;
    use crate::math::Vec3;
    use crate::mesh::halfedge::BOUNDARY;

    /// A sphere that is built from its first triangles and gets the others in pieces.
    #[test]
    fn a_grown_and_shrunk_index_counts_as_one_that_is_built_anew() {
        let sphere = fixtures::sphere(8).cut(|c| c[2] > 2.0);
        let whole = &sphere.triangles;
        let part = |n: usize| TriMesh::new(sphere.positions.clone(), whole[..n].to_vec()).unwrap();
        let first = whole.len() / 3;
        let mut index = MeshIndex::build(&part(first), &Job::unlimited()).unwrap();
        // A plane through the middle cuts many triangles.
        let base = sphere.positions.len() as u32;
        let points: Vec<Vec3> = [[-9.0, -9.0, 0.01], [9.0, -9.0, 0.02], [0.0, 9.0, 0.03]]
            .map(Vec3::from)
            .to_vec();
        let patch = AppendedPatch {
            points: &points,
            triangles: &[[base, base + 1, base + 2]],
            twins: &[BOUNDARY; 3],
        };
        let mut counts = Vec::new();
        let mut lengths: Vec<usize> = (first..whole.len()).step_by(7).collect();
        lengths.extend(lengths.clone().iter().rev().step_by(3));
        lengths.extend([
            first + 1,
            whole.len(),
            first,
            first + 5,
            first - 1,
            whole.len(),
        ]);
        for n in lengths {
            let mesh = part(n);
            index.update(&mesh);
            let total = |index: &MeshIndex| {
                let found = index.intersections(&mesh, patch, &Job::unlimited());
                found.unwrap().total()
            };
            let found = total(&index);
            let anew = MeshIndex::build(&mesh, &Job::unlimited()).unwrap();
            assert_eq!(found, total(&anew));
            let appended = n.saturating_sub(index.base_count);
            assert!(index.later.len() <= 2 + appended.ilog2_or_zero());
            counts.push(found);
        }
        assert!(counts.iter().max() > counts.iter().min());
    }

    trait Log {
        fn ilog2_or_zero(self) -> usize;
    }

    impl Log for usize {
        fn ilog2_or_zero(self) -> usize {
            self.checked_ilog2().map_or(0, |l| l as usize)
        }
    }
}
