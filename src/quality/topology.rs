//! Examines the topology of a triangle list: counts of edges, boundary edges, components and defects. Tests use it.
//!
//! It reads indices only: vertices at equal positions are different vertices.
//!
//! Complexity: O(n log n) for n triangles, by sorting; memory of about 100 bytes a triangle.

use rayon::prelude::*;

/// The topology of a list of triangles.
///
/// Triangles that repeat an index are counted as degenerate and otherwise ignored. All other counts include
/// duplicates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Topology {
    /// Vertices that some triangle uses.
    pub(crate) vertices: usize,
    /// Undirected edges.
    pub(crate) edges: usize,
    /// Triangles of three different vertices.
    pub(crate) faces: usize,
    /// Sets of faces connected across edges.
    pub(crate) components: usize,
    /// Edges of one face.
    pub(crate) boundary_edges: usize,
    /// Edges of three or more faces.
    pub(crate) nonmanifold_edges: usize,
    /// Edges of two faces that both run along them in the same direction.
    pub(crate) inconsistent_edges: usize,
    /// Vertices whose faces form more than one fan.
    pub(crate) nonmanifold_vertices: usize,
    /// Triangles that repeat an index.
    pub(crate) degenerate_faces: usize,
    /// Faces that have the same three vertices as an earlier one, in either orientation.
    pub(crate) duplicate_faces: usize,
}

impl Topology {
    /// Vertices - edges + faces.
    pub(crate) fn euler_characteristic(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }

    /// Whether this is an oriented manifold, perhaps with boundary, of sound faces.
    pub(crate) fn is_oriented_manifold(&self) -> bool {
        self.nonmanifold_edges == 0
            && self.inconsistent_edges == 0
            && self.nonmanifold_vertices == 0
            && self.degenerate_faces == 0
            && self.duplicate_faces == 0
    }

    /// Whether this is an oriented disk: the topology of a patch over a simple boundary loop.
    pub(crate) fn is_disk(&self) -> bool {
        self.is_oriented_manifold()
            && self.components == 1
            && self.boundary_edges > 0
            && self.euler_characteristic() == 1
    }
}

/// One side of an edge: halfedge `k` of face `face` runs from its corner `k` to corner `k + 1`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    low: u32,
    high: u32,
    face: u32,
    k: u8,
    forward: bool,
}

/// Examines a list of at most `u32::MAX / 3` triangles.
pub(crate) fn examine(triangles: &[[u32; 3]]) -> Topology {
    let sound: Vec<[u32; 3]> = triangles
        .iter()
        .copied()
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    let mut sides: Vec<Side> = (0..sound.len() as u32)
        .flat_map(|face| (0..3u8).map(move |k| (face, k)))
        .map(|(face, k)| {
            let triangle = sound[face as usize];
            let (from, to) = (triangle[k as usize], triangle[(k as usize + 1) % 3]);
            Side {
                low: from.min(to),
                high: from.max(to),
                face,
                k,
                forward: from < to,
            }
        })
        .collect();
    sides.par_sort_unstable();

    let mut topology = Topology {
        faces: sound.len(),
        degenerate_faces: triangles.len() - sound.len(),
        duplicate_faces: count_duplicates(&sound),
        ..Topology::default()
    };
    let mut faces = DisjointSets::new(sound.len());
    // Corners at one vertex are joined across edges. The classes are the fans.
    let mut corners = DisjointSets::new(3 * sound.len());
    for edge in sides.chunk_by(|x, y| (x.low, x.high) == (y.low, y.high)) {
        topology.edges += 1;
        match edge {
            [_] => topology.boundary_edges += 1,
            [x, y] => topology.inconsistent_edges += usize::from(x.forward == y.forward),
            _ => topology.nonmanifold_edges += 1,
        }
        for pair in edge.windows(2) {
            faces.join(pair[0].face, pair[1].face);
            let [x, y] = [pair[0].corners(), pair[1].corners()];
            corners.join(x.0, y.0);
            corners.join(x.1, y.1);
        }
    }
    topology.components = faces.class_count();

    let mut fans: Vec<(u32, u32)> = sound
        .iter()
        .flatten()
        .zip(0..)
        .map(|(&vertex, corner)| (vertex, corners.find(corner)))
        .collect();
    fans.par_sort_unstable();
    fans.dedup();
    for of_vertex in fans.chunk_by(|x, y| x.0 == y.0) {
        topology.vertices += 1;
        topology.nonmanifold_vertices += usize::from(of_vertex.len() > 1);
    }
    topology
}

impl Side {
    /// The corners at the edge's lower and higher vertex.
    fn corners(&self) -> (u32, u32) {
        let from = 3 * self.face + u32::from(self.k);
        let to = 3 * self.face + u32::from((self.k + 1) % 3);
        if self.forward { (from, to) } else { (to, from) }
    }
}

fn count_duplicates(triangles: &[[u32; 3]]) -> usize {
    let mut keys: Vec<[u32; 3]> = triangles
        .iter()
        .map(|&triangle| {
            let mut key = triangle;
            key.sort_unstable();
            key
        })
        .collect();
    keys.par_sort_unstable();
    let before = keys.len();
    keys.dedup();
    before - keys.len()
}

/// Union-find with path halving; the representative of a class is its lowest member.
struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
        }
    }

    fn find(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let grandparent = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = grandparent;
            x = grandparent;
        }
        x
    }

    fn join(&mut self, x: u32, y: u32) {
        let (x, y) = (self.find(x), self.find(y));
        self.parent[x.max(y) as usize] = x.min(y);
    }

    fn class_count(&self) -> usize {
        self.parent
            .iter()
            .zip(0..)
            .filter(|&(&parent, x)| parent == x)
            .count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::{BTreeMap, BTreeSet};

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn a_closed_surface_has_no_boundary_and_characteristic_two() {
        let t = examine(&TETRAHEDRON);
        assert_eq!(t.euler_characteristic(), 2);
        assert!(t.is_oriented_manifold() && !t.is_disk());
        assert_eq!((t.vertices, t.edges, t.faces, t.components), (4, 6, 4, 1));
    }

    #[test]
    fn a_disk_is_told_from_everything_that_resembles_one() {
        assert!(examine(&[[0, 1, 2]]).is_disk());
        assert!(examine(&[[0, 1, 2], [0, 2, 3]]).is_disk());
        let cases: [(&str, &[[u32; 3]]); 7] = [
            ("nothing", &[]),
            ("two disks", &[[0, 1, 2], [3, 4, 5]]),
            ("two disks at a vertex", &[[0, 1, 2], [0, 3, 4]]),
            ("closed", &TETRAHEDRON),
            ("inconsistent", &[[0, 1, 2], [0, 3, 2], [1, 0, 4]]),
            (
                "annulus",
                &[
                    [0, 1, 3],
                    [1, 4, 3],
                    [1, 2, 4],
                    [2, 5, 4],
                    [2, 0, 5],
                    [0, 3, 5],
                ],
            ),
            ("twice the same face", &[[0, 1, 2], [0, 2, 1]]),
        ];
        for (name, triangles) in cases {
            assert!(!examine(triangles).is_disk(), "{name}");
        }
    }

    #[test]
    fn each_defect_has_its_own_count() {
        let book = examine(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
        assert_eq!((book.nonmanifold_edges, book.inconsistent_edges), (1, 0));
        assert_eq!(examine(&[[0, 1, 2], [0, 1, 3]]).inconsistent_edges, 1);
        let pinch = examine(&[[0, 1, 2], [0, 3, 4]]);
        assert_eq!((pinch.nonmanifold_vertices, pinch.components), (1, 2));
        assert_eq!(
            examine(&[[0, 0, 1], [5, 5, 5], [0, 1, 2]]).degenerate_faces,
            2
        );
        assert_eq!(
            examine(&[[0, 1, 2], [1, 2, 0], [0, 2, 1]]).duplicate_faces,
            2
        );
        assert_eq!(examine(&[[0, 1, u32::MAX]]).vertices, 3);
        assert_eq!(examine(&[]), Topology::default());
    }

    /// Counts by maps and by walking, with nothing in common with the sorted version.
    fn by_maps(triangles: &[[u32; 3]]) -> Topology {
        let sound: Vec<_> = triangles
            .iter()
            .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            .collect();
        let mut edges: BTreeMap<BTreeSet<u32>, Vec<(usize, u32)>> = BTreeMap::new();
        let mut by_vertex: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (f, t) in sound.iter().enumerate() {
            for k in 0..3 {
                edges
                    .entry([t[k], t[(k + 1) % 3]].into())
                    .or_default()
                    .push((f, t[k]));
                by_vertex.entry(t[k]).or_default().push(f);
            }
        }
        let classes = |faces: &[usize], at: Option<u32>| {
            let mut left: BTreeSet<usize> = faces.iter().copied().collect();
            let mut count = 0;
            while let Some(seed) = left.pop_first() {
                count += 1;
                let mut stack = vec![seed];
                while let Some(f) = stack.pop() {
                    for (edge, users) in &edges {
                        let through = at.is_none_or(|v| edge.contains(&v));
                        if through && users.iter().any(|u| u.0 == f) {
                            stack.extend(users.iter().map(|u| u.0).filter(|g| left.remove(g)));
                        }
                    }
                }
            }
            count
        };
        let with = |n: usize| edges.values().filter(move |u| u.len() == n);
        let distinct: BTreeSet<BTreeSet<u32>> = sound.iter().map(|&&t| t.into()).collect();
        Topology {
            vertices: by_vertex.len(),
            edges: edges.len(),
            faces: sound.len(),
            components: classes(&(0..sound.len()).collect::<Vec<_>>(), None),
            boundary_edges: with(1).count(),
            nonmanifold_edges: edges.values().filter(|u| u.len() > 2).count(),
            inconsistent_edges: with(2).filter(|u| u[0].1 == u[1].1).count(),
            nonmanifold_vertices: by_vertex
                .iter()
                .filter(|(v, faces)| classes(faces, Some(**v)) > 1)
                .count(),
            degenerate_faces: triangles.len() - sound.len(),
            duplicate_faces: sound.len() - distinct.len(),
        }
    }

    proptest! {
        #[test]
        fn counts_agree_with_maps(
            triangles in proptest::collection::vec([0u32..9, 0u32..9, 0u32..9], 0..24),
        ) {
            prop_assert_eq!(examine(&triangles), by_maps(&triangles));
        }
    }
}
