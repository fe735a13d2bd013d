//! Interpolation of values at scattered places in space by radial basis functions.
//!
//! Based on: J. C. Carr, R. K. Beatson, J. B. Cherrie, T. J. Mitchell, W. R. Fright, B. C. McCallum,
//! T. R. Evans, "Reconstruction and representation of 3D objects with radial basis functions", SIGGRAPH
//! 2001, section 3: `f(x) = Σ a_i |x - x_i|³ + b + c·x` with `Σ a_i = 0` and `Σ a_i x_i = 0`, the function of
//! least bending energy through the values. Linear functions are reproduced.
//!
//! Complexity: O(n³) for n centres, of which there is a largest number, and O(n) for each evaluation.
//! Not guaranteed: that a value stays in the range of the given ones.

use crate::error::{Error, ErrorKind, Result};
use crate::math::Vec3;
use faer::Mat;
use faer::prelude::Solve;

/// Subtracted on the diagonal of the linear part, whose entries have the size of one: the coefficient across
/// a plane in which all centres lie becomes zero instead of undefined.
const TAIL_SHIFT: f64 = 1e-9;

/// Coefficients of the linear part.
const TAIL: usize = 4;

/// A function through given values, several channels at once.
pub(super) struct Rbf {
    origin: Vec3,
    extent: f64,
    /// Centres about the origin in units of the extent.
    centers: Vec<Vec3>,
    channels: usize,
    /// The channels of each centre's weight, then those of the linear part.
    weights: Vec<f64>,
}

impl Rbf {
    /// The function that has `value(i, c)` for channel `c` at centre `i`.
    ///
    /// # Errors
    /// [`ErrorKind::Solver`] when the centres do not determine it: when two coincide, for instance.
    pub(super) fn through(
        centers: &[Vec3],
        channels: usize,
        value: impl Fn(usize, usize) -> f64,
    ) -> Result<Self> {
        let n = centers.len();
        let origin = centers.iter().sum::<Vec3>() / n.max(1) as f64;
        let extent = centers
            .iter()
            .map(|p| (p - origin).amax())
            .fold(f64::MIN_POSITIVE, f64::max);
        let centers: Vec<Vec3> = centers.iter().map(|p| (p - origin) / extent).collect();
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => cubed(&(centers[i] - centers[j])),
            (true, false) => tail(&centers[i])[j - n],
            (false, true) => tail(&centers[j])[i - n],
            (false, false) if i == j => -TAIL_SHIFT,
            (false, false) => 0.0,
        };
        let matrix = Mat::from_fn(n + TAIL, n + TAIL, entry);
        let right = Mat::from_fn(
            n + TAIL,
            channels,
            |i, c| if i < n { value(i, c) } else { 0.0 },
        );
        let solution = matrix.partial_piv_lu().solve(&right);
        let weights: Vec<f64> = (0..n + TAIL)
            .flat_map(|i| (0..channels).map(move |c| (i, c)))
            .map(|(i, c)| solution[(i, c)])
            .collect();
        if weights.iter().any(|w| !w.is_finite()) {
            let message = format!("no function passes through the values at {n} places");
            return Err(Error::new(ErrorKind::Solver, message));
        }
        Ok(Self {
            origin,
            extent,
            centers,
            channels,
            weights,
        })
    }

    /// Writes the value of every channel at `p` to `out`.
    pub(super) fn evaluate(&self, p: &Vec3, out: &mut [f64]) {
        let p = (p - self.origin) / self.extent;
        let (at_centers, at_tail) = self.weights.split_at(self.centers.len() * self.channels);
        out.fill(0.0);
        let mut add = |basis: f64, weights: &[f64]| {
            for (sum, weight) in out.iter_mut().zip(weights) {
                *sum += basis * weight;
            }
        };
        for (center, weights) in self
            .centers
            .iter()
            .zip(at_centers.chunks_exact(self.channels))
        {
            add(cubed(&(p - center)), weights);
        }
        for (basis, weights) in tail(&p).iter().zip(at_tail.chunks_exact(self.channels)) {
            add(*basis, weights);
        }
    }
}

fn cubed(d: &Vec3) -> f64 {
    let squared = d.norm_squared();
    squared * squared.sqrt()
}

fn tail(p: &Vec3) -> [f64; TAIL] {
    [1.0, p.x, p.y, p.z]
}

/// Places among `points` that are spread evenly over them, in the order in which they were chosen: the first
/// point, then always the one farthest from those chosen, until `count` are or none is `separation` away.
///
/// O(points · count).
pub(super) fn spread_out(points: &[Vec3], count: usize, separation: f64) -> Vec<usize> {
    let mut chosen = Vec::with_capacity(count.min(points.len()));
    let mut distance_sq = vec![f64::INFINITY; points.len()];
    let mut next = (0, f64::INFINITY);
    while chosen.len() < count.min(points.len()) && next.1 >= separation * separation {
        let latest = points[next.0];
        chosen.push(next.0);
        next = (0, -1.0);
        for (i, (d, p)) in distance_sq.iter_mut().zip(points).enumerate() {
            *d = d.min((p - latest).norm_squared());
            if *d > next.1 {
                next = (i, *d);
            }
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cloud(planar: bool) -> Vec<Vec3> {
        let height = |a: f64| if planar { 0.0 } else { (3.0 * a).sin() };
        (0..40)
            .map(|i| f64::from(i) * 0.7)
            .map(|a| Vec3::new(a.cos() * (1.0 + a / 20.0), a.sin(), height(a)))
            .collect()
    }

    #[test]
    fn the_values_are_met_and_linear_functions_are_reproduced() {
        for planar in [false, true] {
            let centers = cloud(planar);
            let linear = |p: &Vec3| 3.0 - p.x + 0.5 * p.y;
            let value = |i: usize, c: usize| match c {
                0 => linear(&centers[i]),
                _ => (i % 7) as f64,
            };
            let f = Rbf::through(&centers, 2, value).unwrap();
            let mut out = [0.0; 2];
            for (i, p) in centers.iter().enumerate() {
                f.evaluate(p, &mut out);
                assert!((out[0] - value(i, 0)).abs() < 1e-6, "{out:?}");
                assert!((out[1] - value(i, 1)).abs() < 1e-6, "{out:?}");
            }
            let inside = Vec3::new(0.1, 0.2, 0.0);
            f.evaluate(&inside, &mut out);
            assert!((out[0] - linear(&inside)).abs() < 1e-6, "{out:?}");
        }
    }

    #[test]
    fn neither_place_nor_scale_matters() {
        let centers = cloud(false);
        let value = |i: usize, _: usize| ((i * i) % 11) as f64;
        let p = Vec3::new(0.3, -0.2, 0.1);
        let mut expected = [0.0];
        let f = Rbf::through(&centers, 1, value).unwrap();
        f.evaluate(&p, &mut expected);
        for (scale, shift) in [(1e6, 0.0), (1e-6, 0.0), (1.0, 1e3)] {
            let map = |p: &Vec3| p * scale + Vec3::repeat(shift);
            let moved: Vec<Vec3> = centers.iter().map(map).collect();
            let mut found = [0.0];
            let f = Rbf::through(&moved, 1, value).unwrap();
            f.evaluate(&map(&p), &mut found);
            assert!((found[0] - expected[0]).abs() < 1e-6 * expected[0].abs());
        }
    }

    proptest! {
        #[test]
        fn chosen_places_are_far_apart_and_near_to_all(
            coordinates in proptest::collection::vec([-1.0..1.0, -1.0..1.0, -1.0..1.0], 1..80),
            count in 1_usize..40,
        ) {
            let points: Vec<Vec3> = coordinates.into_iter().map(Vec3::from).collect();
            let chosen = spread_out(&points, count, 0.0);
            prop_assert_eq!(chosen.len(), count.min(points.len()));
            let nearest = |p: &Vec3| {
                chosen.iter().map(|&i| (points[i] - p).norm()).fold(f64::INFINITY, f64::min)
            };
            // No point is farther from the chosen ones than these are from each other.
            let radius = points.iter().map(nearest).fold(0.0, f64::max);
            for (k, &i) in chosen.iter().enumerate() {
                for &j in &chosen[..k] {
                    prop_assert!((points[i] - points[j]).norm() >= radius - 1e-12);
                }
            }
        }
    }
}
