//! The distances between the segments of a closed polygon in space, on which the freedom from crossings rests.
//!
//! Based on: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1 (d_MD); the distance of two segments as C. Ericson, "Real-time
//! collision detection", Morgan Kaufmann, 2005, section 5.1.9.
//!
//! Segments that share a vertex are left out, their distance is zero. That loses nothing: when one of them
//! comes to lie on the other, its far vertex does, and with it the segment beyond, which is not left out.
//!
//! Segments are sorted along the axis in which the polygon is longest, and each is compared with those whose
//! boxes are near: O(m log m) and the number of such pairs, m² at worst.

use crate::math::Vec3;
use crate::math::aabb::Aabb;

/// Finds near segments of a closed polygon; keeps its memory between calls.
#[derive(Default)]
pub(super) struct SegmentDistances {
    boxes: Vec<Aabb>,
    /// Segments by the lower end of their boxes along the sweep's axis. Points that moved little leave it
    /// nearly sorted for the next call.
    order: Vec<u32>,
}

impl SegmentDistances {
    /// The smallest distance between two segments that share no vertex; infinite for a triangle.
    ///
    /// Segment `i` runs from point `i` to the next.
    pub(super) fn smallest(&mut self, points: &[Vec3]) -> f64 {
        let m = points.len();
        if m < 4 {
            return f64::INFINITY;
        }
        // The segment after the next is nearly always close: it bounds the search from the start.
        let start = (0..m)
            .map(|i| segment_distance(points, i, (i + 2) % m))
            .fold(f64::INFINITY, f64::min);
        let mut smallest = start;
        self.visit_near(points, start, |i, j, _| {
            smallest = smallest.min(segment_distance(points, i, j));
            smallest
        });
        smallest
    }

    /// For each vertex the smallest distance of its two segments to all others that share no vertex with the
    /// segment, at most `reach`.
    pub(super) fn at_vertices(&mut self, points: &[Vec3], reach: f64, out: &mut Vec<f64>) {
        let m = points.len();
        out.clear();
        out.resize(m, reach);
        self.visit_near(points, reach, |i, j, _| {
            let distance = segment_distance(points, i, j);
            for v in [i, (i + 1) % m, j, (j + 1) % m] {
                out[v] = out[v].min(distance);
            }
            reach
        });
    }

    /// Calls `visit` with every two segments, not neighbours, whose boxes are less than `reach` apart in each
    /// coordinate; it returns the reach for the rest of the search.
    fn visit_near(
        &mut self,
        points: &[Vec3],
        mut reach: f64,
        mut visit: impl FnMut(usize, usize, f64) -> f64,
    ) {
        let m = points.len();
        self.boxes.clear();
        self.boxes.extend((0..m).map(|i| {
            let (p, q) = (&points[i], &points[(i + 1) % m]);
            Aabb {
                lo: p.inf(q),
                hi: p.sup(q),
            }
        }));
        let all = self.boxes.iter().fold(Aabb::empty(), |a, b| a.union(b));
        let axis = (all.hi - all.lo).imax();
        if self.order.len() != m {
            self.order = (0..m as u32).collect();
        }
        let boxes = &self.boxes;
        let start = |i: u32| boxes[i as usize].lo[axis];
        self.order
            .sort_by(|&i, &j| start(i).total_cmp(&start(j)).then(i.cmp(&j)));
        for (place, &i) in self.order.iter().enumerate() {
            let end = boxes[i as usize].hi[axis];
            for &j in &self.order[place + 1..] {
                if start(j) > end + reach {
                    break;
                }
                let (i, j) = (i as usize, j as usize);
                if (i + 1) % m == j || (j + 1) % m == i {
                    continue;
                }
                if boxes[i].grown(reach).overlaps(&boxes[j]) {
                    reach = visit(i, j, reach);
                }
            }
        }
    }
}

/// The distance between two segments of the closed polygon.
fn segment_distance(points: &[Vec3], i: usize, j: usize) -> f64 {
    let m = points.len();
    distance(
        [&points[i], &points[(i + 1) % m]],
        [&points[j], &points[(j + 1) % m]],
    )
}

/// The distance between the segments from `p` to `q` and from `r` to `s`.
fn distance([p, q]: [&Vec3; 2], [r, s]: [&Vec3; 2]) -> f64 {
    let (d, e, w) = (q - p, s - r, p - r);
    let (dd, ee, de) = (d.norm_squared(), e.norm_squared(), d.dot(&e));
    let (dw, ew) = (d.dot(&w), e.dot(&w));
    let clamped = |numerator: f64, denominator: f64| {
        if denominator > 0.0 {
            (numerator / denominator).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    // The nearest point on the first line to the second, then on the second segment to that point, then back.
    let x = clamped(de * ew - ee * dw, dd * ee - de * de);
    let y = clamped(de * x + ew, ee);
    let x = clamped(de * y - dw, dd);
    let nearest = (w + d * x - e * y).norm_squared();
    // Of segments that are almost parallel the first value of x is rounding: the ends decide.
    let ends = [
        to_segment(p, r, &e, ee),
        to_segment(q, r, &e, ee),
        to_segment(r, p, &d, dd),
        to_segment(s, p, &d, dd),
    ];
    ends.into_iter().fold(nearest, f64::min).sqrt()
}

/// Squared distance of `p` from the segment that leaves `start` along `d`, of squared length `dd`.
fn to_segment(p: &Vec3, start: &Vec3, d: &Vec3, dd: f64) -> f64 {
    let w = p - start;
    let x = if dd > 0.0 {
        (w.dot(d) / dd).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (w - d * x).norm_squared()
}
