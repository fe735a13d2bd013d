//! Tests whether points of the plane lie inside a polygon, by counting the edges that a ray crosses.
//!
//! The height of the polygon is divided into as many levels as it has edges. Each level lists the edges that reach it,
//! so that a point is compared only with the edges of its level. `O(m + points)` for `m` edges that are short against
//! the polygon.

/// A polygon with its edges sorted into levels.
pub(super) struct Inside<'a> {
    polygon: &'a [[f64; 2]],
    low: f64,
    /// Height of a level.
    step: f64,
    /// The edges that reach each level, by their first vertices.
    levels: Vec<Vec<u32>>,
}

impl<'a> Inside<'a> {
    pub(super) fn new(polygon: &'a [[f64; 2]]) -> Self {
        let heights = || polygon.iter().map(|p| p[1]);
        let low = heights().fold(f64::INFINITY, f64::min);
        let high = heights().fold(f64::NEG_INFINITY, f64::max);
        let mut new = Self {
            polygon,
            low,
            step: (high - low) / polygon.len() as f64,
            levels: vec![Vec::new(); polygon.len()],
        };
        for (i, a) in (0..).zip(polygon) {
            let b = polygon[(i as usize + 1) % polygon.len()];
            let (first, last) = (new.level(a[1].min(b[1])), new.level(a[1].max(b[1])));
            for level in &mut new.levels[first..=last] {
                level.push(i);
            }
        }
        new
    }

    fn level(&self, y: f64) -> usize {
        // The cast maps negative values and NaN to the first level.
        (((y - self.low) / self.step) as usize).min(self.levels.len().saturating_sub(1))
    }

    /// Whether the point lies inside. For points on the polygon, either answer is possible.
    pub(super) fn contains(&self, p: [f64; 2]) -> bool {
        let Some(edges) = self.levels.get(self.level(p[1])) else {
            return false;
        };
        let is_left_of = |i: &&u32| {
            let a = self.polygon[**i as usize];
            let b = self.polygon[(**i as usize + 1) % self.polygon.len()];
            (a[1] <= p[1]) != (b[1] <= p[1])
                && a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) < p[0]
        };
        edges.iter().filter(is_left_of).count() % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comb_is_told_from_its_gaps() {
        // Ten teeth of width 1 and height 9 on a bar of height 1.
        let mut comb = vec![[0.0, 0.0], [19.0, 0.0]];
        for k in (0..10).rev() {
            let left = 2.0 * f64::from(k);
            comb.extend([[left + 1.0, 10.0], [left, 10.0]]);
            if k > 0 {
                comb.extend([[left, 1.0], [left - 1.0, 1.0]]);
            }
        }
        let inside = Inside::new(&comb);
        for i in 0..200 {
            for j in 0..110 {
                let (x, y) = (0.1 * f64::from(i) - 0.37, 0.1 * f64::from(j) - 0.43);
                let is_tooth = x > 0.0 && x < 19.0 && y > 0.0 && y < 10.0;
                let expected = is_tooth && (y < 1.0 || x.rem_euclid(2.0) < 1.0);
                assert_eq!(inside.contains([x, y]), expected, "{x} {y}");
            }
        }
    }
}
