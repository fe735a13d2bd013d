//! Moving least squares: for each place where a value is needed, one weighted fit of a polynomial in two variables.
//!
//! Weights decrease with the distance from the place. If the points do not determine a polynomial of the wanted degree,
//! one of lower degree is fitted.
//!
//! Sources: P. Lancaster, K. Salkauskas, "Curve and surface fitting: an introduction", 1986; J. Wang, M. M. Oliveira,
//! "Filling holes on locally smooth surfaces reconstructed from point clouds", 2006, eq. 2, 6 and 7, for the
//! polynomials and weights. Cost: O(m) for each place and `m` points.

use crate::math::least_squares::LeastSquares;
use crate::triangulate::simple_polygon::Point2;

/// Points with a weight below this share of the largest one are left out. They do not change sums in double precision.
const SMALLEST_WEIGHT: f64 = 1e-20;
/// A place whose distance from a point is below this, in units of the fit, gets the values of the point. That is the
/// limit of the fit: the weight of the point grows without bound.
const COINCIDENT: f64 = 1e-8;

/// Values at points of a plane, and the parameters of the fit.
pub(crate) struct MovingFit<'a> {
    /// The points.
    pub(crate) points: &'a [Point2],
    /// One list of values for each channel.
    pub(crate) channels: &'a [Vec<f64>],
    /// The α of eq. 6.
    pub(crate) alpha: f64,
    /// The unit of the distances in eq. 6.
    pub(crate) unit: f64,
    /// Degree of the polynomials, from 0 to 3.
    pub(crate) degree: usize,
}

impl MovingFit<'_> {
    /// Allocates the buffers of the fit.
    pub(crate) fn evaluator(&self) -> Evaluator<'_> {
        Evaluator {
            fit: self,
            squares: vec![0.0; self.points.len()],
            system: LeastSquares::new(terms(self.degree), self.channels.len()),
        }
    }
}

/// Number of terms of a polynomial of the degree in two variables.
fn terms(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Numbers of terms of the polynomials of degree 2, 1 and 0. They are tried in turn if the points do not determine the
/// polynomial of the wanted degree.
const FEWER_TERMS: [usize; 3] = [6, 3, 1];

/// Fits at one place after the other. It keeps its buffers.
pub(crate) struct Evaluator<'a> {
    fit: &'a MovingFit<'a>,
    squares: Vec<f64>,
    system: LeastSquares,
}

impl Evaluator<'_> {
    /// Writes the value of each channel at `p` to `out`. Returns false if the points determine no value.
    ///
    /// O(points).
    pub(crate) fn evaluate(&mut self, p: Point2, out: &mut [f64]) -> bool {
        let fit = self.fit;
        let mut nearest = (f64::INFINITY, 0);
        for (i, (square, q)) in self.squares.iter_mut().zip(fit.points).enumerate() {
            let (u, v) = ((q[0] - p[0]) / fit.unit, (q[1] - p[1]) / fit.unit);
            *square = u * u + v * v;
            if *square < nearest.0 {
                nearest = (*square, i);
            }
        }
        let (least, at) = nearest;
        if least <= COINCIDENT * COINCIDENT {
            for (out, values) in out.iter_mut().zip(fit.channels) {
                *out = values[at];
            }
            return !fit.points.is_empty();
        }
        self.system.clear();
        let count = terms(fit.degree);
        for (i, (&square, q)) in self.squares.iter().zip(fit.points).enumerate() {
            // Eq. 6, divided by its largest value. That does not change the solution and avoids underflow.
            let weight = (-fit.alpha * (square - least)).exp() * least / square;
            if weight < SMALLEST_WEIGHT {
                continue;
            }
            // Eq. 2 in coordinates with the place as origin, so that the first coefficient is the value.
            let (u, v) = ((q[0] - p[0]) / fit.unit, (q[1] - p[1]) / fit.unit);
            let basis = [
                1.0,
                u,
                v,
                u * u,
                v * v,
                u * v,
                u * u * u,
                u * u * v,
                u * v * v,
                v * v * v,
            ];
            self.system
                .add(weight.sqrt(), &basis[..count], |c| fit.channels[c][i]);
        }
        let fewer = FEWER_TERMS.iter().position(|&n| n < count).unwrap_or(3);
        self.system.first_unknown(&FEWER_TERMS[fewer..], out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    fn ring(count: usize) -> Vec<Point2> {
        (0..count)
            .map(|i| (i as f64 * 2.4, 1.0 + 0.4 * (i % 3) as f64))
            .map(|(angle, radius)| [radius * angle.cos(), radius * angle.sin()])
            .collect()
    }

    fn at(points: &[Point2], values: Vec<f64>, degree: usize, p: Point2) -> f64 {
        let fit = MovingFit {
            points,
            channels: &[values],
            alpha: 1.0 / 16.0,
            unit: 0.3,
            degree,
        };
        let mut out = [0.0];
        assert!(fit.evaluator().evaluate(p, &mut out));
        out[0]
    }

    #[test]
    fn polynomials_of_the_degree_are_reproduced() {
        let points = ring(60);
        let f = |p: &Point2, degree: usize| {
            let [u, v] = *p;
            [1.0 + u, u * v - v * v, u * u * v + 2.0 * v * v * v][..degree]
                .iter()
                .sum::<f64>()
        };
        for degree in 1..=3 {
            for p in [[0.0, 0.0], [0.3, -0.5], [0.9, 0.1]] {
                let values = points.iter().map(|q| f(q, degree)).collect();
                let found = at(&points, values, degree, p);
                assert!((found - f(&p, degree)).abs() < 1e-9, "{degree} at {p:?}");
            }
        }
    }

    #[test]
    fn the_points_are_interpolated_and_approached_continuously() {
        let points = ring(40);
        let values: Vec<f64> = (0..40).map(|i| f64::from(i % 5)).collect();
        for (q, value) in points.iter().zip(&values) {
            assert_eq!(at(&points, values.clone(), 2, *q), *value);
            for distance in [1e-9, 1e-7, 1e-4] {
                let found = at(&points, values.clone(), 2, [q[0] + distance, q[1]]);
                assert!(
                    (found - value).abs() < 300.0 * distance + 1e-6,
                    "{distance}: {found}"
                );
            }
        }
    }

    #[test]
    fn too_few_points_lower_the_degree_and_far_places_do_not_underflow() {
        let line: Vec<Point2> = (0..4).map(|i| [f64::from(i), 0.0]).collect();
        let values: Vec<f64> = (0..4).map(|i| 2.0 * f64::from(i)).collect();
        let found = at(&line, values.clone(), 2, [1.5, 0.7]);
        assert!(found.is_finite() && (0.0..=6.0).contains(&found), "{found}");
        assert!(at(&line, values, 2, [1e4, 1e4]).is_finite());
        assert_eq!(at(&line[..1], vec![7.0], 2, [0.5, 0.5]), 7.0);
    }

    proptest! {
        #[test]
        fn a_fit_is_that_of_the_normal_equations_of_the_paper(
            values in proptest::collection::vec(-1.0..1.0, 30),
            u in -0.5..0.5,
            v in -0.5..0.5,
        ) {
            let points = ring(30);
            let found = at(&points, values.clone(), 2, [u, v]);
            // Eq. 7 as it stands: a = (B W Bᵀ)⁻¹ B W f, and then s(u, v).
            let row = |[u, v]: Point2| [1.0, u, v, u * u, v * v, u * v];
            let b = DMatrix::from_fn(6, 30, |k, i| row(points[i])[k]);
            let weights = points.iter().map(|q| {
                let square = ((q[0] - u).powi(2) + (q[1] - v).powi(2)) / 0.09;
                (-square / 16.0).exp() / square
            });
            let w = DMatrix::from_diagonal(&DVector::from_iterator(30, weights));
            let f = DVector::from_vec(values);
            let a = (&b * &w * b.transpose()).lu().solve(&(&b * &w * f)).unwrap();
            let expected: f64 = row([u, v]).iter().zip(a.iter()).map(|(x, y)| x * y).sum();
            prop_assert!((found - expected).abs() < 1e-7 * expected.abs().max(1.0));
        }
    }
}
