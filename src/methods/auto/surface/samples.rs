//! Samples of the mesh round a hole, for fitting: vertices with normals, original or smoothed.
//!
//! A fit gets a limited number of samples, spread as evenly as possible by farthest-point sampling. Normals come from
//! quadrics through the neighbors. Noise is estimated once. It decides whether candidates read smoothed samples, and
//! over how many rings of neighbors they are smoothed.
//!
//! Cost: `O(k n)` to choose `k` of `n` vertices. Normals and smoothed samples are computed when they are needed.

use super::{RINGS, Sample};
use crate::error::Result;
use crate::hole::Hole;
use crate::job::Job;
use crate::math::Vec3;
use crate::surroundings::fits::QuadricFits;
use std::ops::Range;

/// Lower bound on the distance of two samples, in mean rim edge lengths. Closer ones make the systems ill-conditioned.
const CLOSEST: f64 = 0.2;
/// Noise, in mean rim edge lengths, above which candidates may read smoothed samples. Measured: 0 to 0.01 on
/// triangulations of smooth surfaces, 0.01 to 0.06 on scans with detail, 0.05 to 0.08 on a sphere with noise of one
/// percent of its size, 0.2 to 0.4 with five percent.
pub(crate) const NOISY: f64 = 0.04;
/// Noise, in the same unit, above which samples are smoothed over more rings.
const VERY_NOISY: f64 = 0.15;
/// Rings of neighbors that a sample is smoothed over on noisy and on very noisy surroundings.
const RINGS_IF_NOISY: usize = 3;
const RINGS_IF_VERY_NOISY: usize = 4;
/// Detail misleads round a wide hole: bumps much narrower than the hole say nothing about its middle. So a hole with at
/// least `FEWEST_EDGES` rim edges and at least `DETAILED` noise (in mean rim edge lengths) is continued from smoothed
/// samples. Measured on 61 such holes cut out of nine models: patches are 4 % nearer to the original. Less noise may be
/// the error of a coarse triangulation.
const FEWEST_EDGES: usize = 200;
const DETAILED: f64 = 0.005;
/// Detail is smoothed over one ring of neighbors for each `EDGES_PER_SMOOTHING_RING` rim edges, but over at most
/// `SHARE_OF_WIDTH` of the hole's width (in mean rim edge lengths) and at most `MOST_SMOOTHING_RINGS`.
///
/// A hole for which this gives fewer rings than noise needs is a slit. It is not smoothed, because its two sides show
/// the detail between them. Measured on 48 slits of 200 to 350 edges: without the bound by the width, patches are 8 to
/// 28 % further from the original than without smoothing; with it they are as near, or 2 % nearer.
const EDGES_PER_SMOOTHING_RING: f64 = 45.0;
const SHARE_OF_WIDTH: f64 = 1.0 / 3.0;
const MOST_SMOOTHING_RINGS: f64 = RINGS as f64;
/// The last ring of vertices that noise is estimated at. Fits further out would lack neighbors.
const LAST_NOISE_LEVEL: u32 = 7;

/// The mesh round a hole, sampled on demand.
pub(crate) struct SampledBand<'a> {
    pub(crate) fits: QuadricFits<'a>,
    /// Mean length of the edges at the rim.
    pub(crate) step: f64,
    /// Edges of the polygon that bounds the patch.
    pub(crate) rim_edges: usize,
    /// Width of the hole, divided by `step`.
    width: f64,
    /// Noise of the positions, divided by `step`.
    pub(crate) noise: f64,
    use_jets: bool,
    /// Results of [`Self::spread`]: range of levels, number of vertices asked for, vertices.
    spreads: Vec<(Range<u32>, usize, Vec<u32>)>,
    normals: Vec<Option<Vec3>>,
    /// For each vertex the last smoothed sample, and the rings of neighbors that it was smoothed over.
    smoothed: Vec<Option<(usize, Sample)>>,
    pub(crate) job: &'a Job<'a>,
}

impl<'a> SampledBand<'a> {
    /// Estimates the noise. `band` are the surroundings of `hole` or a part of them; `step` is the mean edge length at
    /// the rim. With `use_jets`, normals come from quadrics through the neighbors, otherwise from the triangles.
    pub(crate) fn new(
        fits: QuadricFits<'a>,
        hole: &Hole,
        step: f64,
        use_jets: bool,
        job: &'a Job<'a>,
    ) -> Self {
        let count = fits.around.points().len();
        let noise = fits.noise(LAST_NOISE_LEVEL) / step;
        Self {
            fits,
            step,
            rim_edges: hole.polygon.len(),
            width: hole.width() / step,
            noise,
            use_jets,
            spreads: Vec::new(),
            normals: vec![None; count],
            smoothed: vec![None; count],
            job,
        }
    }

    /// Whether the positions are so noisy that an interpolating fit would follow the noise.
    pub(crate) fn is_noisy(&self) -> bool {
        self.noise > NOISY
    }

    /// Whether the hole is so wide that detail round it would mislead an interpolating fit.
    pub(crate) fn is_detail_misleading(&self) -> bool {
        self.rings_over_detail().is_some()
    }

    /// Rings of neighbors that samples are smoothed over to remove noise.
    pub(crate) fn rings_over_noise(&self) -> usize {
        if self.noise > VERY_NOISY {
            RINGS_IF_VERY_NOISY
        } else {
            RINGS_IF_NOISY
        }
    }

    /// Rings of neighbors that samples are smoothed over to remove detail; `None` where detail does not mislead.
    pub(crate) fn rings_over_detail(&self) -> Option<usize> {
        let by_edges = (self.rim_edges as f64 / EDGES_PER_SMOOTHING_RING).round();
        let by_width = (self.width * SHARE_OF_WIDTH).round();
        let rings = by_edges.min(by_width).min(MOST_SMOOTHING_RINGS) as usize;
        let is_misleading = self.rim_edges >= FEWEST_EDGES
            && self.noise >= DETAILED
            && rings >= self.rings_over_noise();
        is_misleading.then_some(rings)
    }

    /// The vertex and its normal.
    pub(crate) fn sample(&mut self, vertex: u32) -> Sample {
        let v = vertex as usize;
        let normal = *self.normals[v].get_or_insert_with(|| {
            if self.use_jets {
                self.fits.interpolating_normal(vertex)
            } else {
                self.fits.normals[v]
            }
        });
        Sample {
            point: self.fits.around.point(vertex),
            normal,
        }
    }

    /// The vertex, moved onto a surface fitted to `rings` rings of neighbors, and the normal of this surface. The
    /// sample is not smoothed where no surface can be fitted.
    pub(crate) fn smoothed_sample(&mut self, vertex: u32, rings: usize) -> Sample {
        let v = vertex as usize;
        if let Some((known, sample)) = self.smoothed[v]
            && known == rings
        {
            return sample;
        }
        let sample = match self.fits.smoothed(vertex, rings) {
            Some(s) => Sample {
                point: s.point,
                normal: s.normal,
            },
            None => self.sample(vertex),
        };
        self.smoothed[v] = Some((rings, sample));
        sample
    }

    /// At most `most` of the vertices whose level is in `levels`, by farthest-point sampling: the first vertex is the
    /// farthest from the centroid, each next one the farthest from all before it. Vertices without a normal, and those
    /// closer than [`CLOSEST`] to a chosen one, are left out.
    ///
    /// # Errors
    /// `Cancelled` when the job is cancelled.
    pub(crate) fn spread(&mut self, levels: Range<u32>, most: usize) -> Result<Vec<u32>> {
        let known = self.spreads.iter().find(|s| s.0 == levels && s.1 >= most);
        if let Some((.., vertices)) = known {
            // A smaller set is the beginning of a larger one.
            return Ok(vertices[..most.min(vertices.len())].to_vec());
        }
        let vertices = self.spread_anew(levels.clone(), most)?;
        self.spreads.push((levels, most, vertices.clone()));
        Ok(vertices)
    }

    fn spread_anew(&self, levels: Range<u32>, most: usize) -> Result<Vec<u32>> {
        let mut vertices = self.fits.around.vertices_in(levels);
        vertices.retain(|&v| self.fits.normals[v as usize] != Vec3::zeros());
        if vertices.is_empty() {
            return Ok(vertices);
        }
        let point = |&v: &u32| self.fits.around.point(v);
        let points: Vec<Vec3> = vertices.iter().map(point).collect();
        let middle = points.iter().sum::<Vec3>() / points.len() as f64;
        let mut reach: Vec<f64> = points.iter().map(|p| (p - middle).norm_squared()).collect();
        let closest = (CLOSEST * self.step).powi(2);
        let mut chosen = Vec::with_capacity(most.min(vertices.len()));
        let mut next = farthest(&reach);
        reach.fill(f64::INFINITY);
        while chosen.len() < most {
            self.job.tick(points.len() / 8)?;
            let at = points[next];
            chosen.push(vertices[next]);
            for (distance, p) in reach.iter_mut().zip(&points) {
                *distance = distance.min((p - at).norm_squared());
            }
            next = farthest(&reach);
            if reach[next] < closest {
                break;
            }
        }
        Ok(chosen)
    }
}

/// The position of the first largest value.
fn farthest(values: &[f64]) -> usize {
    let mut best = 0;
    for (i, &value) in values.iter().enumerate() {
        if value > values[best] {
            best = i;
        }
    }
    best
}
