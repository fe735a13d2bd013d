//! Chooses the signs of normals so that neighbors point to the same side of the surface.
//!
//! Signs are propagated along a minimum spanning tree of the graph of nearest neighbors, by Kruskal's algorithm on
//! disjoint sets whose members know their relative signs. To compare two normals, one is mirrored in the plane halfway
//! between the points. On a circular arc the mirror image equals the other normal. So the comparison works round a
//! crease too.
//!
//! Sources: H. Hoppe et al., Surface reconstruction from unorganized points, SIGGRAPH 1992, section 3.3, for the tree;
//! H. Xie et al., Piecewise C1 continuous surface reconstruction of noisy point clouds via local implicit quadric
//! regression, IEEE Visualization 2003, for the comparison.
//!
//! Complexity: O(n k log n) for k neighbors. Not guaranteed: right signs where two surfaces nearly touch.

use super::cloud::{Cloud, NearestPoints};
use crate::error::Result;
use crate::job::Job;
use crate::math::Vec3;
use rayon::prelude::*;

/// Number of neighbors of a point in the graph.
const SIGN_NEIGHBORS: usize = 10;

/// Flips normals that are not `known` so that neighbors agree. Known normals keep their sign. A component of the graph
/// without a known normal keeps the sign of its first point.
///
/// # Errors
/// `Cancelled` when the job is cancelled.
pub(super) fn agree(
    cloud: &Cloud,
    neighbors: &NearestPoints,
    normals: &mut [Vec3],
    known: &[Option<Vec3>],
    job: &Job<'_>,
) -> Result<()> {
    let mut edges: Vec<Edge> = (0..cloud.len() as u32)
        .into_par_iter()
        .flat_map_iter(|v| {
            let near = neighbors.of(v);
            let near = &near[..near.len().min(SIGN_NEIGHBORS)];
            // An edge that both ends list counts once.
            let is_mine = move |w: u32| v < w || !listed(neighbors, w, v);
            let normals = &*normals;
            near.iter()
                .filter(move |&&w| is_mine(w))
                .map(move |&w| Edge::between(cloud, normals, v, w))
        })
        .collect();
    job.ask()?;
    edges.par_sort_unstable_by(|a, b| a.cost.total_cmp(&b.cost).then(a.ends.cmp(&b.ends)));

    // All known normals are in one set, whose number is the last.
    let fixed = cloud.len() as u32;
    let mut sets = SignedSets::new(cloud.len() + 1);
    for v in (0..fixed).filter(|&v| known[v as usize].is_some()) {
        sets.join(v, fixed, false);
    }
    for edge in &edges {
        let [v, w] = edge.ends;
        sets.join(v, w, edge.is_opposite);
    }
    let [fixed_root, fixed_sign] = sets.find(fixed);
    // In a set without a known normal, the first point keeps its sign.
    let mut first_sign = vec![None; cloud.len() + 1];
    first_sign[fixed_root as usize] = Some(fixed_sign);
    for v in 0..fixed {
        let [root, sign] = sets.find(v);
        let first = *first_sign[root as usize].get_or_insert(sign);
        if sign != first {
            normals[v as usize] = -normals[v as usize];
        }
    }
    Ok(())
}

fn listed(neighbors: &NearestPoints, v: u32, w: u32) -> bool {
    neighbors.of(v).iter().take(SIGN_NEIGHBORS).any(|&x| x == w)
}

struct Edge {
    cost: f64,
    ends: [u32; 2],
    /// Whether the two present normals point to different sides.
    is_opposite: bool,
}

impl Edge {
    fn between(cloud: &Cloud, normals: &[Vec3], v: u32, w: u32) -> Self {
        let chord = crate::math::unit(cloud.points[w as usize] - cloud.points[v as usize]);
        let (n, m) = (normals[v as usize], normals[w as usize]);
        let (rise, fall) = (chord.dot(&n), chord.dot(&m));
        // The dot product with the mirror image of the other.
        let agreement = n.dot(&m) - 2.0 * rise * fall;
        Self {
            cost: 1.0 - agreement.abs() + (rise * rise + fall * fall),
            ends: [v.min(w), v.max(w)],
            is_opposite: agreement < 0.0,
        }
    }
}

/// Disjoint sets whose members know their sign relative to the root: 0 for equal, 1 for opposite.
struct SignedSets {
    parents: Vec<[u32; 2]>,
    sizes: Vec<u32>,
}

impl SignedSets {
    fn new(count: usize) -> Self {
        Self {
            parents: (0..count as u32).map(|v| [v, 0]).collect(),
            sizes: vec![1; count],
        }
    }

    /// The root of the set of `v`, and the sign of `v` relative to it.
    fn find(&mut self, v: u32) -> [u32; 2] {
        let mut at = v;
        let mut sign = 0;
        while self.parents[at as usize][0] != at {
            let [parent, relative] = self.parents[at as usize];
            sign ^= relative;
            // Halve the path: the grandparent becomes the parent.
            let [grandparent, further] = self.parents[parent as usize];
            self.parents[at as usize] = [grandparent, relative ^ further];
            at = parent;
        }
        [at, sign]
    }

    fn join(&mut self, v: u32, w: u32, is_opposite: bool) {
        let ([a, sign_a], [b, sign_b]) = (self.find(v), self.find(w));
        if a == b {
            return;
        }
        let (child, root) = if self.sizes[a as usize] < self.sizes[b as usize] {
            (a, b)
        } else {
            (b, a)
        };
        self.sizes[root as usize] += self.sizes[child as usize];
        self.parents[child as usize] = [root, sign_a ^ sign_b ^ u32::from(is_opposite)];
    }
}
