//! Taubin smoothing, which hardly shrinks a surface: of the surroundings (step 1) and of the patch (step 7).
//!
//! A step moves each point toward the mean of its neighbors; the next step moves it back by a bit more.
//!
//! Source: G. Taubin, "A signal processing approach to fair surface design", SIGGRAPH 1995, which W.-C. Xie and
//! X.-F. Zou use in sections 4.1 and 4.7. `O(edges)` for each step. Not guaranteed: that a curved surface keeps its
//! position exactly.

use crate::math::Vec3;
use crate::math::adjacency::CompressedRows;

/// The factors of the step forward and the step back. Their pass band, `1/λ + 1/μ`, is 0.1.
const LAMBDA: f64 = 0.5;
const MU: f64 = -LAMBDA / (1.0 - 0.1 * LAMBDA);

/// The neighbors of each point, one list after the other.
pub(super) fn smooth(
    points: &mut [Vec3],
    neighbors: &CompressedRows<u32>,
    is_free: impl Fn(usize) -> bool,
    steps: usize,
) {
    let free: Vec<usize> = (0..points.len())
        .filter(|&v| is_free(v) && !neighbors.of(v as u32).is_empty())
        .collect();
    let mut moved = vec![Vec3::zeros(); free.len()];
    for step in 0..steps {
        let factor = if step % 2 == 0 { LAMBDA } else { MU };
        for (to, &v) in moved.iter_mut().zip(&free) {
            let around = neighbors.of(v as u32);
            let sum: Vec3 = around.iter().map(|&w| points[w as usize]).sum();
            *to = points[v] + (sum / around.len() as f64 - points[v]) * factor;
        }
        for (to, &v) in moved.iter().zip(&free) {
            points[v] = *to;
        }
    }
}
