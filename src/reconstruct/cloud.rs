//! The distinct points of a cloud, in scaled coordinates, and the search for their nearest neighbors.
//!
//! Neighbors are found with a bulk-loaded R*-tree (the crate `rstar`). Points at equal distance are ordered by index.
//!
//! Complexity: O(n log n) to build; O(k log n) for k neighbors.

use crate::error::{Error, Result};
use crate::job::Job;
use crate::math::Vec3;
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

type IndexedPoint = GeomWithData<[f64; 3], u32>;

/// Number of points in one task of a thread.
const GRAIN: usize = 256;

/// Points at different positions, in the order of the caller.
pub(super) struct Cloud {
    /// Coordinates with the origin in the middle of the cloud, scaled by a power of two so that the longest side of the
    /// bounding box is between one half and one. It is zero if all points coincide.
    pub(super) points: Vec<Vec3>,
    /// The caller's index of each point, in ascending order.
    pub(super) sources: Vec<u32>,
    /// Factor from the caller's units to scaled ones.
    pub(super) scale: f64,
    tree: RTree<IndexedPoint>,
}

impl Cloud {
    /// Takes the distinct points of `positions`: of several points at one position, the first.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when a coordinate is not finite, the extent overflows, or there are more
    /// points than 32-bit indices can name.
    pub(super) fn new(positions: &[[f64; 3]]) -> Result<Self> {
        if positions.len() >= u32::MAX as usize {
            return Err(Error::invalid(format!(
                "{} points are too many",
                positions.len()
            )));
        }
        if let Some(v) = positions
            .iter()
            .position(|p| !p.iter().all(|c| c.is_finite()))
        {
            let [x, y, z] = positions[v];
            return Err(Error::invalid(format!(
                "point {v} is not finite: ({x}, {y}, {z})"
            )));
        }
        let (middle, scale) = frame_of(positions)?;
        let local = |p: &[f64; 3]| {
            // Adding zero turns -0.0 into 0.0.
            Vec3::from_fn(|axis, _| (p[axis] - middle[axis]) * scale + 0.0)
        };
        let all: Vec<Vec3> = positions.iter().map(local).collect();
        let sources = first_of_each_place(&all);
        let points: Vec<Vec3> = sources.iter().map(|&v| all[v as usize]).collect();
        let entries = points
            .iter()
            .zip(0..)
            .map(|(p, v)| IndexedPoint::new((*p).into(), v));
        Ok(Self {
            tree: RTree::bulk_load(entries.collect()),
            points,
            sources,
            scale,
        })
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// The `count` points nearest to point `v`, without `v`, nearest first.
    pub(super) fn nearest(&self, v: u32, count: usize) -> Vec<u32> {
        let at = self.points[v as usize];
        let found = self.tree.nearest_neighbor_iter(at.into());
        let others = found.map(|entry| entry.data).filter(|&w| w != v);
        self.in_order(v, others.take(count).collect())
    }

    /// The points within `radius` of point `v`, without `v`, nearest first, at most `most`.
    pub(super) fn within(&self, v: u32, radius: f64, most: usize) -> Vec<u32> {
        let at = self.points[v as usize];
        let found = self.tree.nearest_neighbor_iter(at.into());
        let near = found
            .take_while(|entry| (Vec3::from(*entry.geom()) - at).norm_squared() <= radius * radius);
        let others = near.map(|entry| entry.data).filter(|&w| w != v);
        self.in_order(v, others.take(most).collect())
    }

    /// The `count` nearest neighbors of every point.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Cancelled`] when the job is cancelled.
    pub(super) fn all_nearest(&self, count: usize, job: &Job<'_>) -> Result<NearestPoints> {
        let count = count.min(self.len().saturating_sub(1));
        let lists = for_all(self.len(), job, |v| self.nearest(v, count))?;
        Ok(NearestPoints {
            count,
            flat: lists.concat(),
        })
    }

    fn in_order(&self, v: u32, mut found: Vec<u32>) -> Vec<u32> {
        let at = self.points[v as usize];
        let distance = |w: u32| (self.points[w as usize] - at).norm_squared();
        found.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
        found
    }
}

/// The nearest neighbors of each point, in lists of equal length.
pub(super) struct NearestPoints {
    count: usize,
    flat: Vec<u32>,
}

impl NearestPoints {
    /// The neighbors of `v`, nearest first.
    pub(super) fn of(&self, v: u32) -> &[u32] {
        &self.flat[v as usize * self.count..][..self.count]
    }
}

/// Computes `make(v)` for all `v` below `count` in parallel. Results are in order.
///
/// # Errors
/// [`crate::ErrorKind::Cancelled`] when the job is cancelled.
pub(super) fn for_all<T: Send>(
    count: usize,
    job: &Job<'_>,
    make: impl Fn(u32) -> T + Sync,
) -> Result<Vec<T>> {
    // `Cloud::new` has checked that 32 bits are enough.
    (0..count as u32)
        .into_par_iter()
        .with_min_len(GRAIN)
        .map(|v| {
            job.tick(300)?;
            Ok(make(v))
        })
        .collect()
}

/// The middle of the bounding box, and a power of two that brings its longest side to between 1/2 and 1.
fn frame_of(positions: &[[f64; 3]]) -> Result<([f64; 3], f64)> {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for p in positions {
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
    }
    let extent = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    if extent == f64::INFINITY {
        return Err(Error::invalid(
            "the points lie too far apart for double precision".to_owned(),
        ));
    }
    let middle = [0, 1, 2].map(|k| low[k] + (high[k] - low[k]) / 2.0);
    // The bounds keep the power, and products with it, from overflowing.
    let exponent = (-extent.log2().floor() - 1.0).clamp(-1020.0, 1020.0);
    Ok((middle, if extent > 0.0 { exponent.exp2() } else { 1.0 }))
}

/// The indices of the first point at each position, in ascending order.
fn first_of_each_place(points: &[Vec3]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let place = |v: u32| points[v as usize];
    order.par_sort_unstable_by(|&a, &b| {
        let (p, q) = (place(a), place(b));
        let by_axis = |k: usize| p[k].total_cmp(&q[k]);
        by_axis(0)
            .then_with(|| by_axis(1))
            .then_with(|| by_axis(2))
            .then(a.cmp(&b))
    });
    order.dedup_by(|later, first| place(*later) == place(*first));
    order.sort_unstable();
    order
}
