//! Finds the view direction that shows most of the patches.

use crate::raster::Canvas;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;

type Vec3 = Vector3<f32>;

/// Number of view directions, without those of the largest patches.
const DIRECTIONS: usize = 96;
/// Number of directions that are tried by drawing the mesh.
const TRIALS: usize = 6;
/// Width of a trial drawing in samples.
const TRIAL_SIZE: usize = 192;
/// Number of largest patches whose normals are tried.
const LARGEST_PATCHES: usize = 2;
/// Largest number of patch triangles that are used to choose the trials; of more, every nth one.
const CHOICE_TRIANGLES: usize = 100_000;
/// Share by which views from straight above or below count less: they do not show which direction is up.
const STEEP_VIEW_MALUS: f32 = 0.2;
/// The view direction if there is no patch.
const USUAL: Vec3 = Vec3::new(0.45, 0.3, 0.84);
/// Share of the picture that stays empty on each side.
const MARGIN: f32 = 0.06;

/// A parallel projection: axes to the right, up, and toward the eye; then scaled and centered.
pub(crate) struct View {
    axes: [Vec3; 3],
}

impl View {
    /// Looks at the origin from the direction `from`, y up.
    pub(crate) fn new(from: Vec3) -> Self {
        let toward = from.try_normalize(0.0).unwrap_or_else(Vec3::z);
        let up = if toward.y.abs() < 0.99 {
            Vec3::y()
        } else {
            Vec3::z()
        };
        let right = up.cross(&toward).normalize();
        Self {
            axes: [right, toward.cross(&right), toward],
        }
    }

    /// The components of a direction to the right, up, and toward the eye.
    pub(crate) fn turn(&self, v: &Vec3) -> Vec3 {
        Vec3::new(
            self.axes[0].dot(v),
            self.axes[1].dot(v),
            self.axes[2].dot(v),
        )
    }

    /// Projects `points` to a picture of `size` x `size` samples. y points down, z away from the eye (also
    /// in samples). The points that `triangles` use fill the picture.
    pub(crate) fn project(
        &self,
        points: &[Vec3],
        triangles: &[[u32; 3]],
        size: usize,
    ) -> Vec<Vec3> {
        let mut places: Vec<Vec3> = points.iter().map(|p| self.turn(p)).collect();
        let (mut low, mut high) = (Vec3::repeat(f32::MAX), Vec3::repeat(f32::MIN));
        for &v in triangles.iter().flatten() {
            low = low.inf(&places[v as usize]);
            high = high.sup(&places[v as usize]);
        }
        let extent = (high - low).xy().max();
        let scale = size as f32 * (1.0 - 2.0 * MARGIN) / if extent > 0.0 { extent } else { 1.0 };
        let middle = (low + high) / 2.0;
        let half = size as f32 / 2.0;
        for p in &mut places {
            let d = (*p - middle) * scale;
            *p = Vec3::new(half + d.x, half - d.y, -d.z);
        }
        places
    }
}

/// The view in which most samples show the front of triangles from `first_new` on.
pub(crate) fn choose(
    points: &[Vec3],
    triangles: &[[u32; 3]],
    first_new: usize,
    patches: &[Range<u32>],
) -> View {
    let stride = (triangles.len() - first_new)
        .div_ceil(CHOICE_TRIANGLES)
        .max(1);
    let normals: Vec<Vec3> = triangles[first_new..]
        .iter()
        .step_by(stride)
        .map(|t| area_normal(points, t))
        .collect();
    let shown = |d: &Vec3| -> f32 { normals.iter().map(|n| n.dot(d).max(0.0)).sum() };

    let mut candidates: Vec<(f32, Vec3)> = (0..DIRECTIONS)
        .map(fibonacci_direction)
        .map(|d| (shown(&d) * (1.0 - STEEP_VIEW_MALUS * d.y.abs()), d))
        .collect();
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0));
    candidates.truncate(TRIALS);
    let mut directions = largest_patch_normals(points, triangles, patches);
    directions.extend(candidates.iter().filter(|c| c.0 > 0.0).map(|c| c.1));

    let tried: Vec<(f32, View)> = directions
        .par_iter()
        .map(|d| {
            let view = View::new(*d);
            let places = view.project(points, triangles, TRIAL_SIZE);
            let mut canvas = Canvas::new(TRIAL_SIZE);
            canvas.draw(&places, triangles, 0..triangles.len());
            let is_patch_front = |face: &&u32| {
                let face = **face as usize;
                (first_new..triangles.len()).contains(&face)
                    && area_normal(points, &triangles[face]).dot(d) > 0.0
            };
            let count = canvas.faces().iter().filter(is_patch_front).count();
            (count as f32 * (1.0 - STEEP_VIEW_MALUS * d.y.abs()), view)
        })
        .collect();
    // The first of the best views; none if no view shows a patch.
    let best = tried.into_iter().rev().max_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(score, _)| *score > 0.0)
        .map_or_else(|| View::new(USUAL), |(_, view)| view)
}

/// Twice the area times the normal.
pub(crate) fn area_normal(points: &[Vec3], triangle: &[u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|v| points[v as usize]);
    (b - a).cross(&(c - a))
}

fn largest_patch_normals(
    points: &[Vec3],
    triangles: &[[u32; 3]],
    patches: &[Range<u32>],
) -> Vec<Vec3> {
    let mut normals: Vec<(f32, Vec3)> = patches
        .iter()
        .map(|patch| {
            let faces = &triangles[patch.start as usize..patch.end as usize];
            let normals = faces.iter().map(|t| area_normal(points, t));
            normals.fold((0.0, Vec3::zeros()), |(area, sum), n| {
                (area + n.norm(), sum + n)
            })
        })
        .collect();
    normals.sort_by(|a, b| b.0.total_cmp(&a.0));
    normals
        .iter()
        .take(LARGEST_PATCHES)
        .filter_map(|n| n.1.try_normalize(0.0))
        .collect()
}

/// Point `i` of [`DIRECTIONS`] spread evenly over the sphere.
fn fibonacci_direction(i: usize) -> Vec3 {
    let y = 1.0 - (2 * i + 1) as f32 / DIRECTIONS as f32;
    let golden_angle = std::f32::consts::PI * (3.0 - 5f32.sqrt());
    let (sin, cos) = (golden_angle * i as f32).sin_cos();
    let radius = (1.0 - y * y).sqrt();
    Vec3::new(radius * cos, y, radius * sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eye_goes_to_the_side_that_the_patch_faces() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from);
        for (patch, sign) in [([0, 1, 2], 1.0), ([0, 2, 1], -1.0)] {
            let view = choose(&points, &[patch], 0, std::slice::from_ref(&(0..1)));
            assert!(view.axes[2].z * sign > 0.9, "{sign}");
        }
    }

    #[test]
    fn a_small_patch_in_sight_counts_more_than_a_large_one_behind_a_wall() {
        let wall = [[-9.0, -9.0, -0.1], [9.0, -9.0, -0.1], [0.0, 9.0, -0.1]];
        let large = [[-3.0, -3.0, 0.0], [0.0, 3.0, 0.0], [3.0, -3.0, 0.0]];
        let small = [[9.0, -1.0, 1.0], [9.0, 1.0, 1.0], [9.0, 0.0, 2.0]];
        let points = [wall, large, small]
            .concat()
            .into_iter()
            .map(Vec3::from)
            .collect::<Vec<_>>();
        let view = choose(
            &points,
            &[[0, 1, 2], [3, 4, 5], [6, 7, 8]],
            1,
            &[1..2, 2..3],
        );
        assert!(view.axes[2].x > 0.5, "{:?}", view.axes[2]);
    }

    #[test]
    fn without_a_patch_and_without_extent_there_is_still_a_view() {
        let points = [Vec3::zeros(); 3];
        let view = choose(&points, &[[0, 1, 2]], 1, &[]);
        assert!(
            view.project(&points, &[[0, 1, 2]], 10)
                .iter()
                .all(|p| p.norm().is_finite())
        );
        assert!(view.project(&[], &[], 10).is_empty());
    }
}
