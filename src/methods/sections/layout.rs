//! Step 6, first half: where the rim and the predicted points lie in the plane in which they are triangulated.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, section 4.6, for one plane and for two that are unfolded. The sections laid side
//! by side carry on its section 6, which asks for more planes on more complex holes: here each section has its own.
//! `O(m + points)`.

use super::base_points::BasePoint;
use super::rim::Rim;
use super::section::Section;
use super::segmentation::{Plane, fit_plane};
use crate::error::{Error, Result};
use crate::math::{Vec3, unit};

/// The least distance between two sections laid side by side, and the least height of the ends, in mean edge
/// lengths: enough for their order to be safe from rounding.
const LEAST_STEP: f64 = 0.05;

/// Planes whose normals are closer than this (sine) have no line in common to unfold them along.
const PARALLEL: f64 = 1e-3;

/// The rim and the predicted points in a plane; the rim runs counter-clockwise if it can.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    pub(super) rim: Vec<[f64; 2]>,
    /// The points of the sections, in order; none for those that are to be left out.
    pub(super) inside: Vec<Option<[f64; 2]>>,
}

/// What is laid out.
pub(super) struct Scene<'a> {
    pub(super) rim: &'a Rim,
    /// The base points in the order in which `i` and `n - 1 - i` are partners.
    pub(super) base: &'a [BasePoint],
    pub(super) sections: &'a [Section],
}

impl Scene<'_> {
    /// The place of a rim vertex among the base points: `k` at base point `k`.
    fn place(&self, vertex: usize) -> f64 {
        let perimeter = self.rim.perimeter();
        let start = self.base.first().map_or(0.0, |b| b.arc);
        let along = (self.rim.arcs[vertex] - start).rem_euclid(perimeter) / perimeter;
        along * self.base.len() as f64
    }

    fn points(&self) -> impl Iterator<Item = (usize, &Vec3)> {
        self.sections
            .iter()
            .flat_map(|s| s.points.iter().map(|p| (s.pair.first, p)))
    }

    /// Projects everything to the plane of the base points.
    pub(super) fn on_one_plane(&self) -> Layout {
        let positions: Vec<Vec3> = if self.base.len() < 3 {
            self.rim.points.clone()
        } else {
            self.base.iter().map(|b| b.position).collect()
        };
        let Plane { center, normal } = fit_plane(&positions);
        let (x, y) = axes(normal);
        let project = |p: &Vec3| [(p - center).dot(&x), (p - center).dot(&y)];
        Layout {
            rim: self.rim.points.iter().map(project).collect(),
            inside: self.points().map(|(_, p)| Some(project(p))).collect(),
        }
    }

    /// Projects the sections before `fold` to one plane, those from it on to another, and turns the second one
    /// round the line in which they meet until they are one.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Geometry`] when the planes do not meet or the parts lie on the wrong sides of the line.
    pub(super) fn on_two_planes(&self, fold: usize) -> Result<Layout> {
        let n = self.base.len();
        let is_far = |place: f64| place >= fold as f64 && place <= (n - 1 - fold) as f64;
        let positions = |far: bool| -> Vec<Vec3> {
            // The near part begins after the end of the far one, so that it follows the rim.
            (0..n)
                .map(|k| (k + n - fold) % n)
                .filter(|&k| is_far(k as f64) == far)
                .map(|k| self.base[k].position)
                .collect()
        };
        let (near, far) = (fit_plane(&positions(false)), fit_plane(&positions(true)));
        let cross = near.normal.cross(&far.normal);
        if cross.norm() < PARALLEL {
            return Err(refusal("the two planes of the rim are parallel"));
        }
        let mut line = unit(cross);
        let origin = meeting_point(&near, &far, &cross);
        let mut up = line.cross(&far.normal);
        if up.dot(&(far.center - origin)) < 0.0 {
            up = -up;
        }
        if line.cross(&up).dot(&far.normal) < 0.0 {
            line = -line;
        }
        // In the near plane, the same turn to the left of the line.
        let down = near.normal.cross(&line);
        if down.dot(&(near.center - origin)) > 0.0 {
            return Err(refusal("the two planes of the rim do not unfold"));
        }
        let project = |p: &Vec3, far: bool| {
            let d = p - origin;
            [d.dot(&line), d.dot(if far { &up } else { &down })]
        };
        let rim = self.rim.points.iter().enumerate();
        Ok(Layout {
            rim: rim
                .map(|(v, p)| project(p, is_far(self.place(v))))
                .collect(),
            inside: self
                .points()
                .map(|(first, p)| Some(project(p, first >= fold)))
                .collect(),
        })
    }

    /// Lays the sections side by side, each along a line `y = const`, with its points at their distances from its
    /// first end. The rim between two sections, before the first and after the last one keeps its shape as seen from
    /// the nearest section, or is drawn straight if `is_straight`: then no part of it meets another. Points that come
    /// to lie outside get no place.
    pub(super) fn side_by_side(&self, is_straight: bool) -> Layout {
        let rows: Vec<Row> = self.rows();
        if rows.is_empty() {
            return self.on_one_plane();
        }
        let rim: Vec<[f64; 2]> = (0..self.rim.len())
            .map(|v| self.beside_rows(v, &rows, is_straight))
            .collect();
        let inside = rows.iter().flat_map(|row| {
            let crossings = crossings(&rim, row.y);
            row.distances
                .iter()
                .map(|d| row.place(*d, &crossings))
                .collect::<Vec<_>>()
        });
        Layout {
            inside: inside.collect(),
            rim: rim.clone(),
        }
    }

    /// Where a rim vertex lies beside the sections.
    fn beside_rows(&self, vertex: usize, rows: &[Row], is_straight: bool) -> [f64; 2] {
        let n = self.base.len() as f64;
        let place = self.place(vertex);
        let (bottom, top) = (&rows[0], &rows[rows.len() - 1]);
        // The ends of sections between which the vertex lies: where they are laid, and where they are.
        let (from, to, share, row) = if place < bottom.first || place > bottom.second {
            let since = (place - bottom.second).rem_euclid(n);
            let share = since / (bottom.first - bottom.second + n);
            (bottom.left(), bottom.right(), share, bottom)
        } else if place > top.first && place < top.second {
            let share = (place - top.first) / (top.second - top.first);
            (top.right(), top.left(), share, top)
        } else if place <= top.first {
            let next = rows.partition_point(|r| r.first < place).max(1);
            let (a, b) = (&rows[next - 1], &rows[next.min(rows.len() - 1)]);
            let share = (place - a.first) / (b.first - a.first).max(f64::MIN_POSITIVE);
            (a.right(), b.right(), share.min(1.0), a)
        } else {
            let next = rows.partition_point(|r| r.second > place).max(1);
            let (a, b) = (&rows[next - 1], &rows[next.min(rows.len() - 1)]);
            let share = (a.second - place) / (a.second - b.second).max(f64::MIN_POSITIVE);
            (a.left(), b.left(), share.min(1.0), a)
        };
        let mut laid = [0, 1].map(|k| from.0[k] + (to.0[k] - from.0[k]) * share);
        let away = self.rim.points[vertex] - from.1.lerp(&to.1, share);
        if is_straight {
            // Only the ends bulge, so that the rows are inside.
            let bulge = away.norm().max(LEAST_STEP * self.rim.edge_length);
            let is_below = place < bottom.first || place > bottom.second;
            let is_above = place > top.first && place < top.second;
            laid[1] += bulge * (f64::from(u8::from(is_above)) - f64::from(u8::from(is_below)));
        } else {
            laid[0] += away.dot(&row.across);
            laid[1] += away.dot(&row.ahead);
        }
        laid
    }

    fn rows(&self) -> Vec<Row> {
        let mut rows: Vec<Row> = Vec::with_capacity(self.sections.len());
        let mut before: Option<[Vec3; 3]> = None;
        for section in self.sections {
            let (a, b) = (
                self.base[section.pair.first].position,
                self.base[section.pair.second].position,
            );
            let mut distances = Vec::with_capacity(section.points.len());
            let (mut last, mut length) = (a, 0.0);
            for &p in &section.points {
                length += (p - last).norm();
                last = p;
                distances.push(length);
            }
            length += (b - last).norm();
            let middle = section
                .points
                .get(section.points.len() / 2)
                .copied()
                .unwrap_or((a + b) / 2.0);
            let marks = [a, middle, b];
            let step = before.map_or(0.0, |before| {
                let sum: f64 = (0..3).map(|k| (marks[k] - before[k]).norm()).sum();
                (sum / 3.0).max(LEAST_STEP * self.rim.edge_length)
            });
            let across = unit(a - b);
            let normal =
                unit(self.base[section.pair.first].normal + self.base[section.pair.second].normal);
            rows.push(Row {
                ends: [a, b],
                across,
                ahead: across.cross(&normal),
                first: section.pair.first as f64,
                second: section.pair.second as f64,
                half_width: length / 2.0,
                y: rows.last().map_or(0.0, |r| r.y) + step,
                distances,
            });
            before = Some(marks);
        }
        rows
    }
}

/// A section laid along a line.
struct Row {
    /// Where its ends are in space, and the directions along it, to its first end, and ahead.
    ends: [Vec3; 2],
    across: Vec3,
    ahead: Vec3,
    /// Places of its ends among the base points.
    first: f64,
    second: f64,
    half_width: f64,
    y: f64,
    /// Of its points from the first end.
    distances: Vec<f64>,
}

impl Row {
    /// The first end, where it is laid and where it is.
    fn right(&self) -> ([f64; 2], Vec3) {
        ([self.half_width, self.y], self.ends[0])
    }

    fn left(&self) -> ([f64; 2], Vec3) {
        ([-self.half_width, self.y], self.ends[1])
    }

    /// The place of the point at a distance from the first end, between the places where the rim crosses the line.
    fn place(&self, distance: f64, crossings: &[f64]) -> Option<[f64; 2]> {
        let nearest = |x: f64| {
            let distance = |c: &&f64| (**c - x).abs();
            crossings
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                .copied()
        };
        let (left, right) = (nearest(-self.half_width)?, nearest(self.half_width)?);
        let x = right + (left - right) * distance / (2.0 * self.half_width);
        let is_inside = crossings.partition_point(|c| *c < x) % 2 == 1;
        (is_inside && !crossings.contains(&x)).then_some([x, self.y])
    }
}

/// The `x` at which the polygon crosses the height `y`, in order.
fn crossings(polygon: &[[f64; 2]], y: f64) -> Vec<f64> {
    let mut crossings = Vec::new();
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        if (a[1] <= y) != (b[1] <= y) {
            crossings.push(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
        }
    }
    crossings.sort_by(f64::total_cmp);
    crossings
}

/// Two unit vectors that make a right-handed frame with `normal`.
fn axes(normal: Vec3) -> (Vec3, Vec3) {
    let other = if normal.x.abs() < 0.6 {
        Vec3::x()
    } else {
        Vec3::y()
    };
    let x = unit(other.cross(&normal));
    (x, normal.cross(&x))
}

/// The point on both planes that is closest to the middle of their centers.
fn meeting_point(a: &Plane, b: &Plane, cross: &Vec3) -> Vec3 {
    let middle = (a.center + b.center) / 2.0;
    let (da, db) = (
        a.normal.dot(&(a.center - middle)),
        b.normal.dot(&(b.center - middle)),
    );
    let offset = (da * b.normal.cross(cross) + db * cross.cross(&a.normal)) / cross.norm_squared();
    middle + offset
}

fn refusal(message: &str) -> Error {
    Error::geometry(message)
}
