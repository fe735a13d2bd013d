//! Points and normals of the known surface for fitting, few and well spread.

use super::Sample;
use super::choice::RINGS;
use crate::error::Result;
use crate::hole::Hole;
use crate::job::Job;
use crate::math::Vec3;
use crate::surroundings::fits::QuadricFits;
use std::ops::Range;

/// Samples closer to each other than this share of the rim's edge length make systems ill-conditioned.
const CLOSEST: f64 = 0.2;
/// Noise, in rim edge lengths, from which on normals come from smoothing fits as well, and from which on these take
/// four rings of neighbours instead of three. Triangulations of smooth surfaces show 0 to 0.01, scans of detailed
/// models 0.01 to 0.06, a sphere with noise of one percent of its size 0.05 to 0.08, with five percent 0.2 to 0.4.
pub(crate) const NOISY: f64 = 0.04;
const VERY_NOISY: f64 = 0.15;
/// Rings of neighbours of smoothing fits.
const SMOOTHING_RINGS: [usize; 2] = [3, 4];
/// Holes with at least so many rim edges and so much detail round them, in rim edge lengths, are continued from smoothed
/// points: what is much narrower than the hole foretells nothing of its middle. On 61 such holes cut out of nine models
/// patches come 4 % nearer. Less detail is little to smooth, and may be a coarse triangulation.
const FEWEST_EDGES: usize = 200;
const DETAILED: f64 = 0.005;
/// The rings of neighbours that smoothing fits read there: one for so many rim edges, but no more than this share of the
/// hole's width in rim edges, nor than the surroundings have. Fewer than smooth noise are not worth it: then the hole is a
/// slit, whose two sides show the detail between them. On 48 slits of 200 to 350 edges patches are 8 to 28 % further off
/// with the number of edges as the only measure, and with the width too as near as without smoothing, or 2 % nearer.
const EDGES_PER_SMOOTHING_RING: f64 = 45.0;
const SHARE_OF_WIDTH: f64 = 1.0 / 3.0;
const MOST_SMOOTHING_RINGS: f64 = RINGS as f64;
/// The noise is read from rings up to this one: further out fits would miss neighbours.
const LAST_NOISE_LEVEL: u32 = 7;

/// The known surface round a hole, read on demand.
pub(crate) struct SampledBand<'a> {
    pub(crate) fits: QuadricFits<'a>,
    /// Mean length of the edges at the rim.
    pub(crate) step: f64,
    /// Edges of the polygon that bounds the patch.
    pub(crate) rim_edges: usize,
    /// Width of the hole over `step`.
    width: f64,
    /// Noise of the positions over `step`.
    pub(crate) noise: f64,
    use_jets: bool,
    /// Vertices found by [`Self::spread`] for ranges of levels, and how many were asked for.
    spreads: Vec<(Range<u32>, usize, Vec<u32>)>,
    normals: Vec<Option<Vec3>>,
    /// Rings of neighbours and what fits over them gave.
    smoothed: Vec<Option<(usize, Sample)>>,
    pub(crate) job: &'a Job<'a>,
}

impl<'a> SampledBand<'a> {
    /// Measures the noise; normals are computed when they are asked for. `fits` belongs to `hole` or a part of its
    /// surroundings, `step` is the mean edge length at its rim. Without `use_jets` normals are those of the triangles.
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

    /// Whether the positions are noisy: then fits that interpolate them follow the noise.
    pub(crate) fn is_noisy(&self) -> bool {
        self.noise > NOISY
    }

    /// Whether the hole is so wide that the detail of its surroundings misleads functions that interpolate it.
    pub(crate) fn is_detail_misleading(&self) -> bool {
        self.rings_over_detail().is_some()
    }

    /// Rings of neighbours of fits that smooth noise.
    pub(crate) fn rings_over_noise(&self) -> usize {
        SMOOTHING_RINGS[usize::from(self.noise > VERY_NOISY)]
    }

    /// Rings of neighbours of fits that smooth detail where it is misleading: at least those that smooth noise.
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

    /// The vertex moved onto a smooth surface through so many rings of neighbours, and the normal of that.
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

    /// At most `most` of the vertices whose level is in `levels`, spread as evenly as possible: each is the one
    /// farthest from those before it, beginning with the one farthest from the middle.
    ///
    /// # Errors
    /// `Cancelled` when the job is stopped.
    pub(crate) fn spread(&mut self, levels: Range<u32>, most: usize) -> Result<Vec<u32>> {
        let known = self.spreads.iter().find(|s| s.0 == levels && s.1 >= most);
        if let Some((.., vertices)) = known {
            // Fewer vertices are the first ones of more.
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

/// The position of the largest value; the first of several.
fn farthest(values: &[f64]) -> usize {
    let mut best = 0;
    for (i, &value) in values.iter().enumerate() {
        if value > values[best] {
            best = i;
        }
    }
    best
}
