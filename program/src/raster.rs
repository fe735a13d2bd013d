//! A z-buffer: the visible triangle at each sample.

use nalgebra::Vector3;
use std::ops::Range;

/// Marks a sample without a triangle.
pub(crate) const NOTHING: u32 = u32::MAX;

/// A square of samples, each with the nearest triangle and its distance.
#[derive(Clone)]
pub(crate) struct Canvas {
    size: usize,
    depths: Vec<f32>,
    faces: Vec<u32>,
}

impl Canvas {
    pub(crate) fn new(size: usize) -> Self {
        Self {
            size,
            depths: vec![f32::INFINITY; size * size],
            faces: vec![NOTHING; size * size],
        }
    }

    /// The nearest triangle of each sample, or [`NOTHING`], row by row.
    pub(crate) fn faces(&self) -> &[u32] {
        &self.faces
    }

    /// The distance at a sample; infinite without a triangle, and outside the picture.
    pub(crate) fn depth(&self, x: isize, y: isize) -> f32 {
        let inside = 0..self.size as isize;
        if inside.contains(&x) && inside.contains(&y) {
            self.depths[y as usize * self.size + x as usize]
        } else {
            f32::INFINITY
        }
    }

    /// Draws the triangles of `range`, whose corners are at `places` in samples.
    pub(crate) fn draw(
        &mut self,
        places: &[Vector3<f32>],
        triangles: &[[u32; 3]],
        range: Range<usize>,
    ) {
        for face in range {
            self.draw_one(face as u32, triangles[face].map(|v| places[v as usize]));
        }
    }

    fn draw_one(&mut self, face: u32, corners: [Vector3<f32>; 3]) {
        let columns = self.samples_between(corners.map(|c| c.x));
        let rows = self.samples_between(corners.map(|c| c.y));
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        for row in rows {
            for column in columns.clone() {
                let Some(weights) = barycentric(&corners, column, row) else {
                    continue;
                };
                let depth: f32 = (0..3).map(|k| weights[k] * corners[k].z).sum();
                let sample = row * self.size + column;
                if depth < self.depths[sample] {
                    self.depths[sample] = depth;
                    self.faces[sample] = face;
                }
            }
        }
    }

    /// The samples whose centers lie within the range of three coordinates.
    fn samples_between(&self, values: [f32; 3]) -> Range<usize> {
        let low = values.into_iter().fold(f32::INFINITY, f32::min);
        let high = values.into_iter().fold(f32::NEG_INFINITY, f32::max);
        let first = (low - 0.5).ceil().max(0.0) as usize;
        let end = ((high - 0.5).floor() + 1.0).max(0.0) as usize;
        first..end.min(self.size)
    }
}

/// The weights of the corners at the center of a sample, if it lies in the triangle.
///
/// Double precision, because a sample on a common edge of two triangles must be in one of them.
pub(crate) fn barycentric(
    corners: &[Vector3<f32>; 3],
    column: usize,
    row: usize,
) -> Option<[f32; 3]> {
    let [a, b, c] = corners.map(|p| [f64::from(p.x), f64::from(p.y)]);
    let p = [column as f64 + 0.5, row as f64 + 0.5];
    let twice_area = |u: [f64; 2], v: [f64; 2], w: [f64; 2]| {
        (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0])
    };
    let parts = [
        twice_area(b, c, p),
        twice_area(c, a, p),
        twice_area(a, b, p),
    ];
    let total: f64 = parts.iter().sum();
    let is_inside = total != 0.0 && parts.iter().all(|part| part / total >= 0.0);
    is_inside.then(|| parts.map(|part| (part / total) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_cover_a_square_without_a_gap() {
        let places = [
            [0.0, 0.0, 5.0],
            [8.0, 0.0, 5.0],
            [8.0, 8.0, 5.0],
            [0.0, 8.0, 5.0],
        ]
        .map(Vector3::from);
        let mut canvas = Canvas::new(8);
        canvas.draw(&places, &[[0, 1, 2], [2, 3, 0]], 0..2);
        assert!(!canvas.faces().contains(&NOTHING));
        assert_eq!(canvas.depth(3, 3), 5.0);
        assert_eq!(canvas.depth(-1, 3), f32::INFINITY);
        assert_eq!(canvas.depth(3, 8), f32::INFINITY);
    }

    #[test]
    fn the_nearer_triangle_is_seen_whatever_the_order_and_orientation() {
        let places = [
            [0.0, 0.0, 5.0],
            [8.0, 0.0, 5.0],
            [0.0, 8.0, 5.0],
            [0.0, 0.0, 1.0],
            [0.0, 8.0, 1.0],
            [8.0, 0.0, 1.0],
        ]
        .map(Vector3::from);
        for triangles in [[[0, 1, 2], [3, 4, 5]], [[3, 4, 5], [0, 1, 2]]] {
            let mut canvas = Canvas::new(8);
            canvas.draw(&places, &triangles, 0..2);
            let seen = triangles[canvas.faces()[0] as usize];
            assert_eq!(seen, [3, 4, 5]);
        }
    }

    #[test]
    fn triangles_without_area_or_outside_draw_nothing() {
        let places = [
            [1.0, 1.0, 0.0],
            [7.0, 7.0, 0.0],
            [-9.0, 2.0, 0.0],
            [-9.0, 30.0, 0.0],
        ]
        .map(Vector3::from);
        let mut canvas = Canvas::new(8);
        canvas.draw(&places, &[[0, 1, 1], [0, 0, 0], [2, 3, 2], [2, 2, 3]], 0..4);
        assert!(canvas.faces().iter().all(|&f| f == NOTHING));
    }
}
