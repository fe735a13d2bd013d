//! Samples the known surface along a section plane, from the rim outward. The methods `grey` and `nurbs` extrapolate
//! these samples into the hole.
//!
//! The plane is followed through the known triangles, from edge to edge. `O(n log n)` for `n` known triangles to sort
//! their edges, then `O(k log n)` for `k` triangles that a section passes.

use super::base_points::BasePoint;
use super::section::Prepared;
use crate::error::Result;
use crate::hole::Hole;
use crate::job::Job;
use crate::math::{Vec3, unit};
use crate::surroundings::fits::QuadricFits;

/// Upper bound on the triangles that a walk passes for each sample. Only slivers need more.
const TRIANGLES_PER_STEP: usize = 8;

/// A sample of the known surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) point: Vec3,
    /// Unit normal, interpolated between the normals of vertices.
    pub(crate) normal: Vec3,
}

/// The known triangles round a hole, with their edges sorted.
pub(crate) struct Outside<'a> {
    hole: &'a Hole,
    /// Unit normals at the vertices.
    normals: Vec<Vec3>,
    /// Directed edges with their opposite vertices, sorted.
    edges: Vec<(u32, u32, u32)>,
}

impl<'a> Outside<'a> {
    /// Reads the surroundings of a hole.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(crate) fn new(hole: &'a Hole, job: &Job<'_>) -> Result<Self> {
        let mut edges: Vec<(u32, u32, u32)> = hole
            .surroundings
            .triangles()
            .iter()
            .flat_map(|&[a, b, c]| [(a, b, c), (b, c, a), (c, a, b)])
            .collect();
        edges.sort_unstable();
        job.ask()?;
        let around = &hole.surroundings;
        let mut normals = around.normals(job)?.to_vec();
        // Those of triangles would lean to one side at the rim.
        let at_rim = QuadricFits::new(around, job)?.normals_at_rim(job)?;
        normals[..at_rim.len()].copy_from_slice(&at_rim);
        Ok(Self {
            hole,
            normals,
            edges,
        })
    }

    fn point(&self, v: u32) -> Vec3 {
        self.hole.surroundings.point(v)
    }

    fn between(&self, a: u32, b: u32, share: f64) -> Known {
        let normal = |v: u32| self.normals[v as usize];
        Known {
            point: self.point(a).lerp(&self.point(b), share),
            normal: normal(a).lerp(&normal(b), share),
        }
    }

    fn opposite(&self, a: u32, b: u32) -> Option<u32> {
        let at = self.edges.partition_point(|e| (e.0, e.1) < (a, b));
        let found = self.edges.get(at).filter(|e| (e.0, e.1) == (a, b));
        found.map(|e| e.2)
    }

    /// Samples of the surface in the section plane, at the distances `step`, `2 step`, … from the base point `start`
    /// along the surface. There are `count` of them, or fewer if the known triangles end before.
    pub(crate) fn walk(
        &self,
        start: &BasePoint,
        section: &Prepared,
        step: f64,
        count: usize,
    ) -> Vec<Known> {
        let m = self.hole.polygon.len();
        let side = |p: Vec3| (p - start.position).dot(&section.ahead);
        // The known triangle has the rim edge in the opposite direction.
        let mut from = self.hole.polygon[(start.edge + 1) % m];
        let mut to = self.hole.polygon[start.edge];
        let mut last = Known {
            point: start.position,
            normal: start.normal,
        };
        let mut found = Vec::with_capacity(count);
        // The part of the next step that lies in triangles already passed.
        let mut done = 0.0;
        for _ in 0..TRIANGLES_PER_STEP * count {
            let Some(tip) = self.opposite(from, to) else {
                break;
            };
            let [a, b, c] = [from, to, tip].map(|v| side(self.point(v)));
            // The plane leaves through the edge whose ends are on different sides of it.
            let (p, q, s, t) = if (c > 0.0) == (a > 0.0) {
                (tip, to, c, b)
            } else {
                (from, tip, a, c)
            };
            let share = s / (s - t);
            if !(0.0..=1.0).contains(&share) {
                break;
            }
            let next = self.between(p, q, share);
            let length = (next.point - last.point).norm();
            let mut at = step - done;
            while at <= length && found.len() < count {
                let share = at / length;
                found.push(Known {
                    point: last.point.lerp(&next.point, share),
                    normal: unit(last.normal.lerp(&next.normal, share)),
                });
                at += step;
            }
            if found.len() == count {
                break;
            }
            done = length + step - at;
            last = next;
            // The next triangle has this edge in the opposite direction.
            (from, to) = (p, q);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::super::base_points::base_points;
    use super::super::correspondences::Correspondence;
    use super::super::rim::Rim;
    use super::*;
    use crate::surroundings::Surroundings;

    /// A sheet of unit squares, each cut in two, round a hole of 4 by 4, at the heights of a function.
    pub(super) fn sheet(height: impl Fn(f64, f64) -> f64) -> Hole {
        let side = 15_usize;
        let is_hole = |i: usize, j: usize| (5..9).contains(&i) && (5..9).contains(&j);
        let number = |i: usize, j: usize| (i * side + j) as u32;
        let mut triangles = Vec::new();
        for i in 0..side - 1 {
            for j in 0..side - 1 {
                if !is_hole(i, j) {
                    let [a, b, c, d] =
                        [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| number(i, j));
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        let mut rim = Vec::new();
        for k in 0..4 {
            rim.push(number(5 + k, 5));
        }
        for k in 0..4 {
            rim.push(number(9, 5 + k));
        }
        for k in 0..4 {
            rim.push(number(9 - k, 9));
        }
        for k in 0..4 {
            rim.push(number(5, 9 - k));
        }
        let at = |v: u32| {
            let (x, y) = ((v as usize / side) as f64, (v as usize % side) as f64);
            Vec3::new(x, y, height(x, y))
        };
        let others: Vec<u32> = (0..(side * side) as u32)
            .filter(|v| !rim.contains(v))
            .collect();
        let place = |v: u32| {
            let of_rim = rim.iter().position(|&w| w == v);
            let of_others = || others.iter().position(|&w| w == v).map(|k| k + rim.len());
            of_rim.or_else(of_others).unwrap_or(0) as u32
        };
        Hole {
            polygon: (0..rim.len() as u32).collect(),
            surroundings: Surroundings::new(
                rim.len(),
                rim.iter().chain(&others).map(|&v| at(v)).collect(),
                [vec![0; rim.len()], vec![1; others.len()]].concat(),
                triangles.iter().map(|t: &[u32; 3]| t.map(place)).collect(),
            ),
            ..Hole::default()
        }
    }

    #[test]
    fn a_walk_follows_the_surface_at_equal_steps() {
        let hole = sheet(|x, _| 0.5 * x);
        let normal = Vec3::new(-0.5, 0.0, 1.0).normalize();
        let rim = Rim::new(hole.rim().to_vec(), vec![normal; 16], None, 1.0);
        let base = base_points(&rim, 0.7);
        let outside = Outside::new(&hole, &Job::unlimited()).unwrap();
        let mut count = 0;
        for b in &base {
            // A plane that leaves the side of the hole at y = 5 straight away from it.
            if (b.position.y - 5.0).abs() > 1e-9 || b.position.x < 5.1 || b.position.x > 8.9 {
                continue;
            }
            let section = Prepared {
                pair: Correspondence {
                    first: 0,
                    second: 0,
                },
                ahead: Vec3::x(),
                ..Prepared::default()
            };
            let walked = outside.walk(b, &section, 0.6, 5);
            assert_eq!(walked.len(), 5);
            for (k, p) in (1..).zip(&walked) {
                let expected = b.position - Vec3::y() * 0.6 * f64::from(k);
                assert!((p.point - expected).norm() < 1e-9, "{p:?} {expected}");
                assert!((p.normal - normal).norm() < 1e-9, "{p:?}");
            }
            count += 1;
        }
        assert!(count > 3);
    }

    #[test]
    fn a_walk_ends_where_the_known_triangles_end() {
        let hole = sheet(|_, _| 0.0);
        let rim = Rim::new(hole.rim().to_vec(), vec![Vec3::z(); 16], None, 1.0);
        let base = base_points(&rim, 0.7);
        let outside = Outside::new(&hole, &Job::unlimited()).unwrap();
        let section = Prepared {
            ahead: Vec3::x(),
            ..Prepared::default()
        };
        // Five squares lie between the hole and the end of the sheet.
        assert_eq!(outside.walk(&base[1], &section, 1.0, 9).len(), 5);
    }
}
