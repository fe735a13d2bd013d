//! Step 5, first half: the two circular arcs of a section, and the range of heights between them for each point.
//!
//! One arc is tangent to the surface at the first end of the section, the other at the second end.
//!
//! Source: W.-C. Xie, X.-F. Zou, "A triangulation-based hole patching method using differential evolution",
//! Computer-Aided Design 45, 2013, section 4.5, equations 12, 13, 15 and 16. `O(m)`.

use std::f64::consts::FRAC_PI_2;

/// Below this angle, in radians, an arc is computed as a parabola. Both agree to double precision.
const FLAT: f64 = 1e-5;

/// A circular arc from the origin to `(length, 0)`. Its tangents at both ends make the angle `angle` with the x axis; a
/// positive angle is upward at the start.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Arc {
    pub(crate) length: f64,
    /// In radians, between -π and π.
    pub(crate) angle: f64,
}

impl Arc {
    /// The length of the arc itself.
    pub(crate) fn arc_length(&self) -> f64 {
        if self.angle.abs() < FLAT {
            self.length
        } else {
            self.length * self.angle / self.angle.sin()
        }
    }

    /// The point at the share `s` of the arc.
    pub(crate) fn at(&self, s: f64) -> [f64; 2] {
        if self.angle.abs() < FLAT {
            return [s * self.length, self.length * self.angle * s * (1.0 - s)];
        }
        let turned = self.angle * (1.0 - 2.0 * s);
        let radius = self.length / (2.0 * self.angle.sin());
        let x = radius * (self.angle.sin() - turned.sin());
        [x, self.height(turned)]
    }

    /// The height of the arc above `x`; `None` for an arc of more than half a circle, which may have two heights there
    /// or none.
    fn above(&self, x: f64) -> Option<f64> {
        if self.angle.abs() > FRAC_PI_2 {
            return None;
        }
        let share = x / self.length;
        if self.angle.abs() < FLAT {
            return Some(self.length * self.angle * share * (1.0 - share));
        }
        let turned = (self.angle.sin() * (1.0 - 2.0 * share))
            .clamp(-1.0, 1.0)
            .asin();
        Some(self.height(turned))
    }

    /// `R (cos turned - cos angle)` without cancellation.
    fn height(&self, turned: f64) -> f64 {
        let product = ((self.angle + turned) / 2.0).sin() * ((self.angle - turned) / 2.0).sin();
        self.length * product / self.angle.sin()
    }
}

/// The points of a section in its plane, with bounds on their heights. The ends are the origin and `(length, 0)`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Profile {
    pub(crate) length: f64,
    pub(crate) x: Vec<f64>,
    /// Lower bound on the height of each point.
    pub(crate) lower: Vec<f64>,
    /// Upper bound on the height of each point.
    pub(crate) upper: Vec<f64>,
    /// The start heights: the two arcs, blended by equation 16.
    pub(crate) start: Vec<f64>,
}

/// The profile of a section with `count` points. The arc `first` is tangent to the surface at the first end, `second`
/// at the second end.
pub(crate) fn profile(first: &Arc, second: &Arc, count: usize) -> Profile {
    let mut profile = Profile {
        length: first.length,
        ..Profile::default()
    };
    for i in 1..=count {
        let share = i as f64 / (count + 1) as f64;
        let (a, b) = (first.at(share), second.at(share));
        let x = (a[0] + b[0]) / 2.0;
        let low = first.above(x).unwrap_or(a[1]);
        let high = second.above(x).unwrap_or(b[1]);
        profile.x.push(x);
        profile.lower.push(low.min(high));
        profile.upper.push(low.max(high));
        profile.start.push(low + (high - low) * share);
    }
    profile
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_an_arc_are_equally_far_apart_on_a_circle() {
        for angle in [-2.5, -1.0, -1e-7, 0.0, 1e-4, 0.3, 1.5, 2.0, 2.8] {
            let arc = Arc { length: 3.0, angle };
            let points: Vec<[f64; 2]> = (0..=8).map(|i| arc.at(f64::from(i) / 8.0)).collect();
            let step =
                |i: usize| (points[i + 1][0] - points[i][0]).hypot(points[i + 1][1] - points[i][1]);
            for i in 0..8 {
                assert!((step(i) - step(0)).abs() < 1e-9, "{angle}: {points:?}");
            }
            assert!(points[0][0].hypot(points[0][1]) < 1e-12);
            assert!((points[8][0] - 3.0).hypot(points[8][1]) < 1e-12);
            let finest = arc.at(1e-6);
            let slope = finest[1].atan2(finest[0]);
            assert!((slope - angle).abs() < 1e-5, "{angle}: {slope}");
            if angle.abs() > FLAT {
                let radius = 3.0 / (2.0 * angle.sin());
                let center = [1.5, -radius * angle.cos()];
                for p in &points {
                    let distance = (p[0] - center[0]).hypot(p[1] - center[1]);
                    assert!((distance - radius.abs()).abs() < 1e-9);
                }
                assert!((arc.arc_length() - 2.0 * radius * angle).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn the_height_above_a_point_is_on_the_arc() {
        for angle in [-1.5, -0.2, 1e-6, 0.7, 1.57] {
            let arc = Arc { length: 2.0, angle };
            for i in 1..10 {
                let [x, y] = arc.at(f64::from(i) / 10.0);
                assert!((arc.above(x).unwrap() - y).abs() < 1e-7, "{angle}");
            }
        }
        assert_eq!(
            Arc {
                length: 2.0,
                angle: 1.6
            }
            .above(1.0),
            None
        );
    }

    #[test]
    fn the_start_leaves_each_end_along_its_own_arc() {
        let (first, second) = (
            Arc {
                length: 1.0,
                angle: 0.9,
            },
            Arc {
                length: 1.0,
                angle: -0.4,
            },
        );
        let profile = profile(&first, &second, 2000);
        let slope = profile.start[0].atan2(profile.x[0]);
        assert!((slope - 0.9).abs() < 5e-3, "{slope}");
        let last = 1999;
        let slope = profile.start[last].atan2(1.0 - profile.x[last]);
        assert!((slope + 0.4).abs() < 5e-3, "{slope}");
        for i in 0..2000 {
            let start = profile.start[i];
            assert!(profile.lower[i] <= start && start <= profile.upper[i]);
        }
    }
}
