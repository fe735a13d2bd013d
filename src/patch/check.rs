//! Every structural promise of a patch's connectivity, checked the slow way.

use super::mesh::{NONE, PatchMesh, next, prev};

/// Larger patches are made to measure time, which this must not take.
const LARGEST_VALIDATED: usize = 20_000;

impl PatchMesh {
    /// Panics with the broken promise.
    pub(crate) fn validate(&self) {
        if self.vertex_count() > LARGEST_VALIDATED {
            return;
        }
        let mut edges = Vec::new();
        let mut rim = Vec::new();
        for h in 0..self.halfedge_count() {
            let ends = (self.origin(h), self.target(h));
            if self.triangles()[h as usize / 3] == [NONE; 3] {
                assert_eq!(
                    self.opposite(h),
                    None,
                    "a triangle that is gone has a neighbor"
                );
                continue;
            }
            edges.push(ends);
            assert!(next(prev(h)) == h && self.apex(h) == self.target(next(h)));
            match self.opposite(h) {
                Some(o) => {
                    assert_eq!(
                        self.opposite(o),
                        Some(h),
                        "opposite of {h} does not point back"
                    );
                    assert_eq!(ends, (self.target(o), self.origin(o)), "opposite of {h}");
                }
                None => rim.push(h),
            }
        }
        edges.sort_unstable();
        assert!(
            edges.windows(2).all(|e| e[0] != e[1]),
            "a directed edge occurs twice"
        );
        let mut listed = self.rim_halfedges().to_vec();
        listed.sort_unstable();
        assert_eq!(listed, rim, "rim edges are lost");
        let mut corners = vec![0; self.vertex_count()];
        for t in self.living() {
            assert!(
                t[0] != t[1] && t[1] != t[2] && t[2] != t[0],
                "triangle {t:?} is degenerate"
            );
            t.iter().for_each(|&v| corners[v as usize] += 1);
        }
        for v in 0..self.vertex_count() as u32 {
            let walked: Vec<_> = self.corners(v).collect();
            assert_eq!(
                walked.len(),
                corners[v as usize],
                "one-ring of {v} is incomplete"
            );
            assert!(
                walked.iter().all(|&h| self.origin(h) == v),
                "one-ring of {v} strays"
            );
        }
    }

    /// Rim edges as directed vertex pairs, sorted.
    pub(crate) fn rim_pairs(&self) -> Vec<(u32, u32)> {
        let mut pairs: Vec<_> = self
            .rim_halfedges()
            .iter()
            .map(|&h| (self.origin(h), self.target(h)))
            .collect();
        pairs.sort_unstable();
        pairs
    }

    /// Vertices in use minus edges plus triangles.
    pub(crate) fn euler(&self) -> i64 {
        let used = (0..self.vertex_count() as u32).filter(|&v| self.corners(v).next().is_some());
        let triangles = self.living().count();
        let edges = (3 * triangles + self.rim_halfedges().len()) / 2;
        used.count() as i64 - edges as i64 + triangles as i64
    }
}
