//! Step 6, first half: maps the rim and the predicted points to the plane in which they are triangulated.
//!
//! There are three layouts: projection to one plane; projection to two planes, one of which is then turned into the
//! other; and the sections as parallel lines, side by side, each with its points at their distances along the section.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, section 4.6, for the first two layouts. The third one follows its section 6, which
//! proposes more planes for more complex holes; here each section has its own. `O(m + points)` for `m` rim vertices,
//! `O(m n + points)` for `n` sections side by side. Not guaranteed: that a layout is one-to-one.

use super::base_points::BasePoint;
use super::rim::Rim;
use super::section::Section;
use super::segmentation::{Plane, fit_plane};
use crate::error::{Error, Result};
use crate::math::{Vec3, unit};

/// Lower bound on the distance between two sections laid side by side, and on the height of the two ends beyond the
/// first and the last section, in mean edge lengths. It keeps rounding errors from changing their order.
const LEAST_STEP: f64 = 0.05;

/// Two planes are parallel if the sine of the angle between their normals is below this. They have no line to unfold
/// along.
const PARALLEL: f64 = 1e-3;

/// The rim and the predicted points in a plane. The rim is counter-clockwise where the layout is one-to-one.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    pub(super) rim: Vec<[f64; 2]>,
    /// The points of the sections, in order; `None` for a point that is to be left out.
    pub(super) inside: Vec<Option<[f64; 2]>>,
}

/// The input of a layout.
pub(super) struct Scene<'a> {
    pub(super) rim: &'a Rim,
    /// The base points in the order in which `i` and `n - 1 - i` are partners.
    pub(super) base: &'a [BasePoint],
    pub(super) sections: &'a [Section],
}

impl Scene<'_> {
    /// The position of a rim vertex in the sequence of base points, as a fractional index.
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

    /// Projects all points to the least squares plane of the base points.
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

    /// Projects the sections before `fold` to one plane and the others to a second plane. Then the second plane is
    /// turned round the line in which both meet, into the first.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Geometry`] when the planes do not meet or the parts lie on the wrong sides of the line.
    pub(super) fn on_two_planes(&self, fold: usize) -> Result<Layout> {
        let n = self.base.len();
        let is_far = |place: f64| place >= fold as f64 && place <= (n - 1 - fold) as f64;
        let positions = |far: bool| -> Vec<Vec3> {
            // The near part starts after the end of the far part, so that its points follow the rim.
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
        // The left side of the line, in the near plane.
        let down = near.normal.cross(&line);
        if down.dot(&(near.center - origin)) > 0.0 {
            return Err(refusal(
                "the two planes of the rim cannot be unfolded: their parts lie on the wrong sides",
            ));
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

    /// Lays the sections side by side. Each lies on a line `y = const`, with its points at their distances along the
    /// section from its first end. The rim between the ends of neighboring sections is drawn straight if `is_straight`;
    /// then it cannot meet itself. Otherwise it keeps its shape, projected to the plane of the nearest section. Points
    /// that would lie outside the rim get no position.
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

    /// The position of a rim vertex when the sections are laid side by side.
    fn beside_rows(&self, vertex: usize, rows: &[Row], is_straight: bool) -> [f64; 2] {
        let n = self.base.len() as f64;
        let place = self.place(vertex);
        let (bottom, top) = (&rows[0], &rows[rows.len() - 1]);
        // The two ends of sections between which the vertex lies, in the layout and in space; its share of the way from
        // one to the other; and the row whose directions count.
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
            // The rim bulges only beyond the first and the last row, so that the rows are inside.
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
    /// Its ends in space.
    ends: [Vec3; 2],
    /// Unit direction in space from the second end to the first.
    across: Vec3,
    /// Unit direction in space to the next section.
    ahead: Vec3,
    /// Indices of the base points at its ends.
    first: f64,
    second: f64,
    half_width: f64,
    y: f64,
    /// Distances of its points from the first end, along the section.
    distances: Vec<f64>,
}

impl Row {
    /// The first end, in the layout and in space.
    fn right(&self) -> ([f64; 2], Vec3) {
        ([self.half_width, self.y], self.ends[0])
    }

    /// The second end, in the layout and in space.
    fn left(&self) -> ([f64; 2], Vec3) {
        ([-self.half_width, self.y], self.ends[1])
    }

    /// The position of the point at a distance from the first end. `crossings` are the `x` at which the rim crosses the
    /// line of the row; the row is fitted between the two nearest to its ends. `None` for a point outside the rim.
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

/// The `x` at which the polygon crosses the height `y`, in ascending order.
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

/// The point on both planes that is nearest to the midpoint of their centers.
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
