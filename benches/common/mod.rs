//! Code that the benchmarks share.
#![allow(dead_code, reason = "each benchmark uses a part of it")]

#[path = "../../tests/common/meshes.rs"]
pub(crate) mod meshes;

use holefill::{FillOptions, FillSession, Method, Target, TriMesh};
use std::ops::Range;

/// A wavy sheet of `size` by `size` quads without those whose column and row are both in `hole`.
pub(crate) fn sheet(size: usize, hole: Range<usize>) -> TriMesh {
    let is_in_hole = |c: meshes::Point| {
        [c[0], c[1]]
            .iter()
            .all(|&x| hole.contains(&(x.floor() as usize)))
    };
    let sheet = meshes::sheet(size, meshes::waves).cut(is_in_hole);
    TriMesh::new(sheet.positions, sheet.triangles).expect("the mesh is valid")
}

/// One hole of a mesh, after the work that is done once per mesh.
pub(crate) struct Hole {
    session: FillSession,
    id: usize,
}

impl Hole {
    /// The shortest loop of `mesh`.
    pub(crate) fn shortest(mesh: TriMesh) -> Self {
        let session = FillSession::new(mesh);
        session.prepare();
        let loops = &session.boundary().loops;
        let shortest = loops.iter().min_by_key(|rim| rim.edge_count());
        let id = shortest.expect("there is a loop").id;
        Self { session, id }
    }

    /// Fills the hole by `method` on one thread, and removes the patch again.
    pub(crate) fn fill_and_undo(&mut self, method: Method) {
        let mut options = FillOptions::default();
        options.method = method;
        options.threads = 1;
        self.session
            .fill(Target::Loops(&[self.id]), &options, None)
            .expect("the options are valid");
        assert!(self.session.undo(), "the hole was not filled");
    }
}
