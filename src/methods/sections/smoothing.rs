//! Taubin smoothing, which hardly shrinks a surface: of the surroundings (step 1) and of the patch (step 7).
//!
//! A step moves each point toward the mean of its neighbors; the next step moves it back by a bit more.
//!
//! Source: G. Taubin, "A signal processing approach to fair surface design", SIGGRAPH 1995, which W.-C. Xie and
//! X.-F. Zou use in sections 4.1 and 4.7. `O(edges)` for each step. Not guaranteed: that a curved surface keeps its
//! position exactly.

use crate::math::Vec3;

/// The factors of the step forward and the step back. Their pass band, `1/λ + 1/μ`, is 0.1.
const LAMBDA: f64 = 0.5;
const MU: f64 = -LAMBDA / (1.0 - 0.1 * LAMBDA);

/// The neighbors of each point, one list after the other.
#[derive(Clone, Debug)]
pub(super) struct NeighborLists {
    starts: Vec<usize>,
    ends: Vec<u32>,
}

impl NeighborLists {
    /// The neighbors along the edges of `triangles`, for `count` points.
    pub(super) fn new(triangles: &[[u32; 3]], count: usize) -> Self {
        Self::of_edges(
            triangles
                .iter()
                .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]),
            count,
        )
    }

    pub(super) fn of_edges(edges: impl Iterator<Item = (u32, u32)>, count: usize) -> Self {
        let mut directed: Vec<(u32, u32)> = edges.flat_map(|(a, b)| [(a, b), (b, a)]).collect();
        directed.sort_unstable();
        directed.dedup();
        let mut starts = vec![0; count + 1];
        for &(a, _) in &directed {
            starts[a as usize + 1] += 1;
        }
        for v in 0..count {
            starts[v + 1] += starts[v];
        }
        Self {
            starts,
            ends: directed.into_iter().map(|(_, b)| b).collect(),
        }
    }

    pub(super) fn of(&self, v: usize) -> &[u32] {
        &self.ends[self.starts[v]..self.starts[v + 1]]
    }
}

/// Smooths the points for which `is_free` holds. `steps` counts the steps forward and the steps back.
pub(super) fn smooth(
    points: &mut [Vec3],
    neighbors: &NeighborLists,
    is_free: impl Fn(usize) -> bool,
    steps: usize,
) {
    let free: Vec<usize> = (0..points.len())
        .filter(|&v| is_free(v) && !neighbors.of(v).is_empty())
        .collect();
    let mut moved = vec![Vec3::zeros(); free.len()];
    for step in 0..steps {
        let factor = if step % 2 == 0 { LAMBDA } else { MU };
        for (to, &v) in moved.iter_mut().zip(&free) {
            let around = neighbors.of(v);
            let sum: Vec3 = around.iter().map(|&w| points[w as usize]).sum();
            *to = points[v] + (sum / around.len() as f64 - points[v]) * factor;
        }
        for (to, &v) in moved.iter().zip(&free) {
            points[v] = *to;
        }
    }
}
