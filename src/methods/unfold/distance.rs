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
            .map(|i| nearest(points, i, (i + 2) % m).distance())
            .fold(f64::INFINITY, f64::min);
        let mut smallest = start;
        self.visit_near(points, start, |i, j| {
            smallest = smallest.min(nearest(points, i, j).distance());
            smallest
        });
        smallest
    }

    /// For each vertex the smallest distance of its two segments to all others that share no vertex with the
    /// segment, at most `reach`; and the pairs of segments that are nearer than `contact_reach`, which is at most
    /// `reach`.
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

    /// Calls `visit` with every two segments, not neighbors, whose boxes are less than `reach` apart in each
    /// coordinate; it returns the reach for the rest of the search.
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

/// The way from the place `y` of the second of two segments to the place `x` of the first, where they are
/// nearest; places run from 0 to 1 along a segment.
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

/// What [`SegmentDistances::at_vertices`] finds.
#[derive(Default)]
pub(super) struct Clearances {
    pub(super) distances: Vec<f64>,
    pub(super) contacts: Vec<Contact>,
}

/// Where segment `i` of the closed polygon is nearest to segment `j`.
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
    // The nearest place of the first line to the second, then of the second segment to that place, then back.
    let x = share(de * ew - ee * dw, dd * ee - de * de);
    let y = share(de * x + ew, ee);
    let x = share(de * y - dw, dd);
    // Of segments that are almost parallel the first x is rounding: there one of the ends is nearest.
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
