//! Step 2: places base points at equal distances along the rim. Sections start and end there.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, section 4.2. `O(m + n)` for `m` rim vertices and `n` base points.

use super::rim::Rim;
use crate::math::{Vec3, unit};

/// A point of the rim at which a section starts or ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BasePoint {
    pub(super) position: Vec3,
    /// Unit normal of the known surface there, or zero.
    pub(super) normal: Vec3,
    /// Distance along the rim from its first vertex.
    pub(super) arc: f64,
    /// The edge of the rim that it lies on, by its first vertex.
    pub(super) edge: usize,
}

/// `n = ⌊BudLen / (spacing · EdgeLen)⌋` base points, where `BudLen` is the perimeter; one less if `n` is odd, so that
/// each point can have a partner. The first one is the first vertex of the rim.
pub(super) fn base_points(rim: &Rim, spacing: f64) -> Vec<BasePoint> {
    let wanted = (rim.perimeter() / (spacing * rim.edge_length)).floor();
    // The rim has at least three edges, and its lengths are finite.
    let count = (wanted as usize) & !1;
    let mut edge = 0;
    (0..count)
        .map(|k| {
            let arc = k as f64 * rim.perimeter() / count as f64;
            while edge + 1 < rim.len() && rim.arcs[edge + 1] <= arc {
                edge += 1;
            }
            let length = rim.arcs[edge + 1] - rim.arcs[edge];
            let share = if length > 0.0 {
                (arc - rim.arcs[edge]) / length
            } else {
                0.0
            };
            let (a, b) = (edge, (edge + 1) % rim.len());
            let normal = match &rim.vertex_normals {
                Some(normals) => unit(normals[a].lerp(&normals[b], share)),
                None => rim.edge_normals[edge],
            };
            BasePoint {
                position: rim.points[a].lerp(&rim.points[b], share),
                normal,
                arc,
                edge,
            }
        })
        .collect()
}

/// Number of base points to each side over which the direction of the rim is measured. It smooths a jagged rim.
const JAGS: usize = 2;

/// The unit direction of the rim at base point `k`.
pub(super) fn rim_direction(base: &[BasePoint], k: usize) -> Vec3 {
    let n = base.len();
    let reach = JAGS.min(n / 4).max(1);
    unit(base[(k + reach) % n].position - base[(k + n - reach) % n].position)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_points_are_equally_far_apart_along_the_rim() {
        let points = vec![
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(3.0, 0.0, 0.0),
            Vec3::new(3.0, 1.0, 0.0),
            Vec3::new(0.0, 1.0, 0.0),
        ];
        let rim = Rim::new(points, vec![Vec3::z(); 4], None, 1.0);
        let base = base_points(&rim, 0.8);
        assert_eq!(base.len(), 10);
        for (k, b) in base.iter().enumerate() {
            assert!((b.arc - 0.8 * k as f64).abs() < 1e-12);
            assert_eq!(b.normal, Vec3::z());
        }
        assert!((base[4].position - Vec3::new(3.0, 0.2, 0.0)).norm() < 1e-12);
        assert!((base[6].position - Vec3::new(2.2, 1.0, 0.0)).norm() < 1e-12);
    }
}
