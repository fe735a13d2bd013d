//! Delaunay edge flips, with a stack of edges whose neighborhood changed.
//!
//! An edge is flipped if the sum of the two angles opposite to it is above π. In a plane this is the empty-circle test,
//! but it needs no plane. Flips that would fold the patch or make a blocked edge are not done.
//!
//! Sources: C. L. Lawson, "Software for C1 surface interpolation", Mathematical Software III, 1977; A. Bobenko and
//! B. Springborn, "A discrete Laplace-Beltrami operator for simplicial surfaces", Discrete & Computational Geometry 38,
//! 2007, for the criterion on surfaces.
//!
//! Cost: one test for each edge on the stack, and `O(valence)` for each flip. Not guaranteed: that all edges are
//! Delaunay at the end. On a curved patch a flip changes the surface, so flips might never end; each call has an
//! upper bound on their number.

use crate::error::Result;
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use crate::patch::mesh::{Halfedge, PatchMesh, prev};

/// The sum of opposite angles counts as above π if its sine is below minus this. Four corners on a circle, as in a
/// regular grid, give rounding errors of about 1e-15, which must not cause flips.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Lower bound on the cosine between a new triangle's normal and the mean normal of the two triangles that it replaces.
/// A larger angle (above 72 degrees) would fold the patch or cut off a ridge.
const MIN_NORMAL_COSINE: f64 = 0.3;

/// Upper bound on the flips of one call, divided by the number of edges on its stack. About one is usual; unfavorable
/// triangulations need more.
const FLIPS_PER_EDGE: usize = 16;

/// Whether an edge between these two rim vertices exists outside the patch.
pub(super) type Blocked<'a> = dyn Fn(u32, u32) -> bool + 'a;

/// Flips edges of one patch. It owns the stack, so that it is allocated once.
pub(super) struct Flipper<'a> {
    blocked: &'a Blocked<'a>,
    job: &'a Job<'a>,
    stack: Vec<Halfedge>,
}

impl<'a> Flipper<'a> {
    pub(super) fn new(blocked: &'a Blocked<'a>, job: &'a Job<'a>) -> Self {
        Self {
            blocked,
            job,
            stack: Vec::new(),
        }
    }

    /// Tests `edges`, and every edge next to a flipped one, until no edge is to be flipped. Returns the number of
    /// flips.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(super) fn restore(
        &mut self,
        mesh: &mut PatchMesh,
        points: &[Vec3],
        edges: impl ExactSizeIterator<Item = Halfedge>,
    ) -> Result<usize> {
        let mut budget = FLIPS_PER_EDGE * edges.len();
        let granted = budget;
        for h in edges {
            self.restore_from(mesh, points, h, &mut budget)?;
        }
        Ok(granted - budget)
    }

    /// [`Self::restore`] over all edges of the patch.
    pub(super) fn restore_all(&mut self, mesh: &mut PatchMesh, points: &[Vec3]) -> Result<usize> {
        let mut budget = FLIPS_PER_EDGE * mesh.halfedge_count() as usize;
        let granted = budget;
        for t in 0..mesh.triangles().len() {
            // An edge that is to be flipped has an obtuse angle opposite to it on at least one side. Edges of triangles
            // already passed that a flip changes are on the stack.
            if let Some(h) = opposite_obtuse(points, mesh.triangles()[t], t as u32) {
                self.restore_from(mesh, points, h, &mut budget)?;
            }
        }
        Ok(granted - budget)
    }

    fn restore_from(
        &mut self,
        mesh: &mut PatchMesh,
        points: &[Vec3],
        first: Halfedge,
        budget: &mut usize,
    ) -> Result<()> {
        let mut edge = Some(first);
        while let Some(h) = edge {
            self.job.tick(1)?;
            if let Some(g) = mesh.opposite(h)
                && *budget > 0
                && wants_flip(mesh, points, h, g)
                && self.may_flip(mesh, h, g)
            {
                self.stack.extend(mesh.flip(h, g));
                *budget -= 1;
            }
            edge = self.stack.pop();
        }
        Ok(())
    }

    fn may_flip(&self, mesh: &PatchMesh, h: Halfedge, g: Halfedge) -> bool {
        let (c, d) = (mesh.apex(h), mesh.apex(g));
        let on_rim = c.max(d) < mesh.rim_count() as u32;
        let taken = mesh.has_edge(c, d) || (on_rim && (self.blocked)(c, d));
        !taken
    }
}

/// The halfedge of triangle `t` opposite to its obtuse angle, if it has one.
#[inline]
fn opposite_obtuse(points: &[Vec3], corners: [u32; 3], t: u32) -> Option<Halfedge> {
    let [a, b, c] = corners.map(|v| &points[v as usize]);
    let (ab, bc, ca) = (b - a, c - b, a - c);
    if ca.dot(&bc) > 0.0 {
        Some(3 * t)
    } else if ab.dot(&ca) > 0.0 {
        Some(3 * t + 1)
    } else if bc.dot(&ab) > 0.0 {
        Some(3 * t + 2)
    } else {
        None
    }
}

/// Whether the edge violates the Delaunay condition and its flip would not fold the surface.
#[inline]
fn wants_flip(mesh: &PatchMesh, points: &[Vec3], h: Halfedge, g: Halfedge) -> bool {
    let corner = |h| &points[mesh.origin(h) as usize];
    let (a, b, c, d) = (corner(h), corner(g), corner(prev(h)), corner(prev(g)));
    let (ca, cb, da, db) = (a - c, b - c, a - d, b - d);
    let (cos_c, cos_d) = (ca.dot(&cb), da.dot(&db));
    // Without an obtuse angle the sum is not above π.
    (cos_c < 0.0 || cos_d < 0.0) && {
        let (normal_c, normal_d) = (ca.cross(&cb), db.cross(&da));
        // The sine of the two angles' sum, times the lengths of their sides.
        let sine = normal_c.norm() * cos_d + cos_c * normal_d.norm();
        sine < 0.0 && {
            let sides = ca.norm_squared() * cb.norm_squared() * da.norm_squared();
            sine < -ANGLE_TOLERANCE * (sides * db.norm_squared()).sqrt()
                && keeps_sides([a, b, c, d], normal_c, normal_d)
        }
    }
}

/// Whether the triangles `c a d` and `d b c` face the same side as those that they replace.
fn keeps_sides([a, b, c, d]: [&Vec3; 4], normal_c: Vec3, normal_d: Vec3) -> bool {
    let mean = unit(unit(normal_c) + unit(normal_d));
    let keeps_side = |n: Vec3| {
        let length = n.norm();
        length > f64::MIN_POSITIVE && n.dot(&mean) >= MIN_NORMAL_COSINE * length
    };
    keeps_side(cross_normal(c, a, d)) && keeps_side(cross_normal(d, b, c))
}

/// Number of interior edges that [`Flipper::restore_all`] would still have to flip.
#[cfg(test)]
pub(super) fn count_violations(mesh: &PatchMesh, points: &[Vec3], blocked: &Blocked<'_>) -> usize {
    let flipper = Flipper::new(blocked, &crate::job::UNLIMITED);
    (0..mesh.halfedge_count())
        .filter(|&h| {
            mesh.opposite(h).is_some_and(|g| {
                g > h && wants_flip(mesh, points, h, g) && flipper.may_flip(mesh, h, g)
            })
        })
        .count()
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{disc_rim, fan, star_rim};
    use super::*;
    use crate::job::UNLIMITED;
    use proptest::prelude::*;

    fn connect(points: &[Vec3], triangles: Vec<[u32; 3]>) -> PatchMesh {
        PatchMesh::new(triangles, points.len(), points.len()).unwrap()
    }

    fn flip_all(mesh: &mut PatchMesh, points: &[Vec3], blocked: &Blocked<'_>) -> usize {
        let mut flipper = Flipper::new(blocked, &UNLIMITED);
        flipper.restore_all(mesh, points).unwrap()
    }

    fn kite() -> (Vec<Vec3>, PatchMesh) {
        let points = vec![
            Vec3::new(-2.0, 0.0, 0.0),
            Vec3::new(0.0, -1.0, 0.0),
            Vec3::new(2.0, 0.0, 0.0),
            Vec3::new(0.0, 1.0, 0.0),
        ];
        let mesh = connect(&points, vec![[0, 1, 2], [0, 2, 3]]);
        (points, mesh)
    }

    /// Whether any corner lies inside the circle of any triangle, by the in-circle determinant.
    fn circles_are_empty(mesh: &PatchMesh, points: &[Vec3]) -> bool {
        mesh.triangles().iter().all(|t| {
            points.iter().all(|p| {
                let row = |v: u32| {
                    let q = points[v as usize] - p;
                    Vec3::new(q.x, q.y, q.norm_squared())
                };
                row(t[0]).dot(&row(t[1]).cross(&row(t[2]))) < 1e-7
            })
        })
    }

    #[test]
    fn the_long_diagonal_of_a_kite_is_flipped_unless_the_mesh_owns_the_short_one() {
        let (points, mut mesh) = kite();
        assert_eq!(flip_all(&mut mesh, &points, &|a, b| a + b == 4), 0);
        assert_eq!(flip_all(&mut mesh, &points, &|_, _| false), 1);
        assert!(mesh.has_edge(1, 3) && !mesh.has_edge(0, 2));
        mesh.validate();
    }

    #[test]
    fn a_square_is_left_alone_whatever_its_place_and_scale() {
        for (scale, shift) in [(1.0, 0.0), (1e-6, 1.0), (1e9, 0.0), (0.1, 1e3)] {
            let corner = |x: f64, y: f64| Vec3::new(shift + scale * x, shift + scale * y, 0.1);
            let points = vec![
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(1.0, 1.0),
                corner(0.0, 1.0),
            ];
            let mut mesh = connect(&points, vec![[0, 1, 2], [0, 2, 3]]);
            assert_eq!(flip_all(&mut mesh, &points, &|_, _| false), 0);
        }
    }

    #[test]
    fn a_flip_that_would_fold_a_reflex_quadrilateral_is_refused() {
        let points = vec![
            Vec3::new(-2.0, 0.0, 0.0),
            Vec3::new(-1.0, -0.2, 0.0),
            Vec3::new(2.0, 0.0, 0.0),
            Vec3::new(3.0, 0.1, 0.0),
        ];
        let mut mesh = connect(&points, vec![[0, 1, 2], [0, 2, 3]]);
        assert_eq!(flip_all(&mut mesh, &points, &|_, _| false), 0);
    }

    #[test]
    fn a_collinear_triangle_is_flipped_away() {
        let points = vec![
            Vec3::new(0.0, 0.0, 0.0),
            Vec3::new(1.0, 0.0, 0.0),
            Vec3::new(2.0, 0.0, 0.0),
            Vec3::new(1.0, 1.0, 0.0),
        ];
        let mut mesh = connect(&points, vec![[0, 1, 2], [0, 2, 3]]);
        assert_eq!(flip_all(&mut mesh, &points, &|_, _| false), 1);
    }

    #[test]
    fn coincident_points_cause_no_flip_and_no_endless_loop() {
        let points = vec![Vec3::new(1.0, 2.0, 3.0); 9];
        let mut mesh = connect(&points, fan(9));
        assert_eq!(flip_all(&mut mesh, &points, &|_, _| false), 0);
    }

    #[test]
    fn a_convex_fan_becomes_the_delaunay_triangulation() {
        for n in [4, 5, 17, 60] {
            let points: Vec<_> = disc_rim(n)
                .iter()
                .map(|p| Vec3::new(p.x, 0.37 * p.y + 0.1 * p.x, 0.0))
                .collect();
            let mut mesh = connect(&points, fan(n));
            flip_all(&mut mesh, &points, &|_, _| false);
            mesh.validate();
            assert!(circles_are_empty(&mesh, &points), "{n} corners");
        }
    }

    #[test]
    fn helical_strips_end_without_violations() {
        let n = 80;
        let points: Vec<_> = (0..2 * n)
            .map(|i| {
                let (k, r) = if i < n {
                    (i, 1.0)
                } else {
                    (2 * n - 1 - i, 2.5)
                };
                let angle = 0.2 * k as f64;
                Vec3::new(r * angle.cos(), r * angle.sin(), 0.05 * k as f64)
            })
            .collect();
        let last = 2 * n as u32 - 1;
        // A zigzag with every third quadrilateral cut the long way.
        let triangles = (0..n as u32 - 1).flat_map(|k| {
            if k % 3 == 0 {
                [[k, last - k, k + 1], [k + 1, last - k, last - k - 1]]
            } else {
                [[k, last - k, last - k - 1], [k, last - k - 1, k + 1]]
            }
        });
        let mut mesh = connect(&points, triangles.collect());
        let flips = flip_all(&mut mesh, &points, &|_, _| false);
        assert!(flips < 4 * n);
        mesh.validate();
        assert_eq!(count_violations(&mesh, &points, &|_, _| false), 0);
    }

    proptest! {
        #[test]
        fn star_polygons_end_locally_delaunay(
            radii in prop::collection::vec(0.01f64..1.0, 3..40),
            blocks in any::<u32>(),
        ) {
            let points = star_rim(&radii);
            let mut mesh = connect(&points, fan(points.len()));
            let rim = mesh.rim_pairs();
            let blocked = |a: u32, b: u32| blocks.rotate_left(a + b) & 7 == 0;
            flip_all(&mut mesh, &points, &blocked);
            mesh.validate();
            prop_assert_eq!(mesh.rim_pairs(), rim);
            prop_assert_eq!(count_violations(&mesh, &points, &blocked), 0);
        }
    }
}
