//! The distances between the segments of a closed polygon in space. They bound the steps of an unfolding.
//!
//! Segments are sorted along the longest axis of the polygon's bounding box. Each one is compared with those whose
//! boxes are near. Segments that share a vertex are not compared, because their distance is zero. They cannot overlap
//! unnoticed: before that, the far vertex of one would meet the other, and that vertex belongs to a segment that is
//! compared.
//!
//! Sources: A. Brunton, S. Wuhrer, C. Shu, P. Bose, E. D. Demaine, "Filling holes in triangular meshes by
//! curve unfolding", SMI 2009, section 3.1 (d_MD); C. Ericson, "Real-time collision detection", Morgan Kaufmann, 2005,
//! section 5.1.9, for the distance of two segments.
//!
//! Cost: O(m log m + k) for `m` segments and `k` near pairs; `k` can be m².

use crate::math::Vec3;
use crate::math::aabb::Aabb;

/// Finds near segments of a closed polygon. It keeps its buffers between calls.
#[derive(Default)]
pub(super) struct SegmentDistances {
    boxes: Vec<Aabb>,
    /// Segments, sorted by the lower ends of their boxes along the longest axis. If points move little, the order is
    /// nearly right for the next call.
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
        // The segment after the next is nearly always near, so its distance is a good first bound.
        let start = (0..m)
            .map(|i| nearest(points, i, (i + 2) % m).distance())
            .fold(f64::INFINITY, f64::min);
        let mut smallest = start;
        self.visit_near(points, start, |i, j| {
            smallest = smallest.min(nearest(points, i, j).distance());
            smallest
        });
        smallest
    }

    /// Computes, for each vertex, the smallest distance between its two segments and all segments that share no
    /// vertex with them, at most `reach`. Also lists the pairs of segments whose distance is below `contact_reach`,
    /// which is at most `reach`.
    pub(super) fn at_vertices(
        &mut self,
        points: &[Vec3],
        reach: f64,
        contact_reach: f64,
        out: &mut Clearances,
    ) {
        let m = points.len();
        out.distances.clear();
        out.distances.resize(m, reach);
        out.contacts.clear();
        self.visit_near(points, reach, |i, j| {
            let nearest = nearest(points, i, j);
            let distance = nearest.distance();
            for v in [i, (i + 1) % m, j, (j + 1) % m] {
                out.distances[v] = out.distances[v].min(distance);
            }
            if distance < contact_reach {
                out.contacts.push(Contact {
                    segments: [i, j],
                    nearest,
                });
            }
            reach
        });
    }

    /// Calls `visit` with each pair of segments that are not neighbors and whose boxes are less than `reach` apart in
    /// each coordinate. `visit` returns the reach for the rest of the search.
    fn visit_near(
        &mut self,
        points: &[Vec3],
        mut reach: f64,
        mut visit: impl FnMut(usize, usize) -> f64,
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
                    reach = visit(i, j);
                }
            }
        }
    }
}

/// The nearest points of two segments: at the share `x` of the first and at the share `y` of the second. `way` is the
/// vector from the second point to the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearestSegment {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) way: Vec3,
}

impl NearestSegment {
    fn distance(&self) -> f64 {
        self.way.norm()
    }
}

/// Two segments that are near to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) segments: [usize; 2],
    pub(super) nearest: NearestSegment,
}

/// The result of [`SegmentDistances::at_vertices`].
#[derive(Default)]
pub(super) struct Clearances {
    pub(super) distances: Vec<f64>,
    pub(super) contacts: Vec<Contact>,
}

/// The nearest points of the segments `i` and `j` of the closed polygon.
fn nearest(points: &[Vec3], i: usize, j: usize) -> NearestSegment {
    let m = points.len();
    let (p, q) = (&points[i], &points[(i + 1) % m]);
    let (r, s) = (&points[j], &points[(j + 1) % m]);
    let (d, e, w) = (q - p, s - r, p - r);
    let (dd, ee, de) = (d.norm_squared(), e.norm_squared(), d.dot(&e));
    let (dw, ew) = (d.dot(&w), e.dot(&w));
    let share = |numerator: f64, denominator: f64| {
        if denominator > 0.0 {
            (numerator / denominator).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    // The point of the first segment nearest to the second line, the point of the second segment nearest to it, and the
    // point of the first segment nearest to that one.
    let x = share(de * ew - ee * dw, dd * ee - de * de);
    let y = share(de * x + ew, ee);
    let x = share(de * y - dw, dd);
    // For nearly parallel segments the first `x` is only rounding error, but then an end is a nearest point.
    let places = [
        (x, y),
        (0.0, share(ew, ee)),
        (1.0, share(de + ew, ee)),
        (share(-dw, dd), 0.0),
        (share(de - dw, dd), 1.0),
    ];
    let mut best = (f64::INFINITY, NearestSegment { x, y, way: w });
    for (x, y) in places {
        let way = w + d * x - e * y;
        let distance_sq = way.norm_squared();
        if distance_sq < best.0 {
            best = (distance_sq, NearestSegment { x, y, way });
        }
    }
    best.1
}
