//! A picture of a mesh before and after its holes were filled.
//!
//! A small renderer: parallel projection, z-buffer, smooth shading, four samples per pixel. It has a key
//! light, a fill light, and ambient light that is weaker in hollows. The inside of the surface has
//! another color, so that holes are visible.

use crate::raster::{Canvas, NOTHING, barycentric};
use crate::view::{self, View, area_normal};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::io;
use std::ops::Range;

type Vec3 = Vector3<f32>;

/// Height of the picture in pixels; its width is twice this.
const HEIGHT: usize = 800;
/// Samples per pixel along each axis.
const SAMPLES: usize = 2;
const SIZE: usize = HEIGHT * SAMPLES;

/// Linear colors at full light.
const MESH: Vec3 = Vec3::new(0.47, 0.49, 0.52);
const MESH_INSIDE: Vec3 = Vec3::new(0.10, 0.17, 0.30);
const PATCH: Vec3 = Vec3::new(0.80, 0.245, 0.03);
const PATCH_INSIDE: Vec3 = Vec3::new(0.42, 0.10, 0.02);
const BACKGROUND_TOP: Vec3 = Vec3::new(0.95, 0.96, 0.97);
const BACKGROUND_BOTTOM: Vec3 = Vec3::new(0.72, 0.75, 0.79);

/// Lights: direction (right, up, toward the eye) and brightness.
const KEY: (Vec3, f32) = (Vec3::new(-0.50, 0.62, 0.60), 1.0);
const FILL: (Vec3, f32) = (Vec3::new(0.77, 0.06, 0.63), 0.22);
const AMBIENT_ABOVE: f32 = 0.30;
const AMBIENT_BELOW: f32 = 0.13;
const HIGHLIGHT: f32 = 0.10;
const HIGHLIGHT_EXPONENT: i32 = 36;

/// Cosine of 40°: corner normals with a larger angle to the normal of their triangle are at a sharp edge.
const SMOOTH_COSINE: f32 = 0.766;
/// Radius, in samples, in which hollows are searched.
const HOLLOW_RADIUS: f32 = SIZE as f32 * 0.035;
const HOLLOW_PAIRS: usize = 12;
const GOLDEN_ANGLE: f32 = 2.399_963;
const HOLLOW_STRENGTH: f32 = 1.3;

/// What to draw.
pub(crate) struct Scene<'a> {
    pub(crate) positions: &'a [[f64; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    /// The triangles from here on are patches.
    pub(crate) first_new: usize,
    /// The triangles of each patch.
    pub(crate) patches: &'a [Range<u32>],
}

/// Rows of pixels, each red, green and blue.
pub(crate) struct Picture {
    width: usize,
    rgb: Vec<u8>,
}

/// Draws `scene` without its patches on the left and with them on the right.
pub(crate) fn draw(scene: &Scene<'_>) -> Picture {
    let Scene {
        triangles,
        first_new,
        ..
    } = *scene;
    let points = centered(scene.positions, triangles);
    let view = view::choose(&points, triangles, first_new, scene.patches);
    let places = view.project(&points, triangles, SIZE);
    let mut before = Canvas::new(SIZE);
    before.draw(&places, triangles, 0..first_new);
    let mut after = before.clone();
    after.draw(&places, triangles, first_new..triangles.len());

    let surface = Surface {
        places,
        triangles,
        first_new,
        normals: vertex_normals(&points, triangles, &view),
        view: &view,
        points: &points,
    };
    let width = 2 * HEIGHT;
    let mut rgb = vec![0; 3 * width * HEIGHT];
    rgb.par_chunks_mut(3 * width)
        .enumerate()
        .for_each(|(row, pixels)| {
            for (column, pixel) in pixels.chunks_exact_mut(3).enumerate() {
                let canvas = if column < HEIGHT { &before } else { &after };
                pixel.copy_from_slice(&surface.pixel(canvas, column % HEIGHT, row));
            }
        });
    Picture { width, rgb }
}

/// Writes a picture as PNG.
pub(crate) fn write_png(picture: &Picture, out: impl io::Write) -> io::Result<()> {
    let height = picture.rgb.len() / (3 * picture.width);
    let mut encoder = png::Encoder::new(out, picture.width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.rgb)?;
    Ok(writer.finish()?)
}

/// The points, moved to the origin and scaled to an extent of about one.
fn centered(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
    for &v in triangles.iter().flatten() {
        for k in 0..3 {
            low[k] = low[k].min(positions[v as usize][k]);
            high[k] = high[k].max(positions[v as usize][k]);
        }
    }
    // Halves, because the difference of two finite numbers need not be finite.
    let extent = (0..3)
        .map(|k| high[k] / 2.0 - low[k] / 2.0)
        .fold(0.0, f64::max);
    let scale = if extent > 0.0 { extent } else { 1.0 };
    let coordinate =
        |p: &[f64; 3], k: usize| ((p[k] / 2.0 - low[k] / 4.0 - high[k] / 4.0) / scale) as f32;
    positions
        .iter()
        .map(|p| Vec3::from_fn(|k, _| coordinate(p, k)))
        .collect()
}

/// The mean normal of the triangles round each vertex, in the axes of the view.
fn vertex_normals(points: &[Vec3], triangles: &[[u32; 3]], view: &View) -> Vec<Vec3> {
    let mut normals = vec![Vec3::zeros(); points.len()];
    for t in triangles {
        let normal = area_normal(points, t);
        for &v in t {
            normals[v as usize] += normal;
        }
    }
    normals.iter().map(|n| view.turn(&direction(n))).collect()
}

fn direction(v: &Vec3) -> Vec3 {
    v.try_normalize(0.0).unwrap_or_else(Vec3::zeros)
}

/// The data to light a sample.
struct Surface<'a> {
    points: &'a [Vec3],
    places: Vec<Vec3>,
    triangles: &'a [[u32; 3]],
    first_new: usize,
    normals: Vec<Vec3>,
    view: &'a View,
}

impl Surface<'_> {
    /// The color of a pixel: the mean of its samples.
    fn pixel(&self, canvas: &Canvas, column: usize, row: usize) -> [u8; 3] {
        let mut sum = Vec3::zeros();
        for k in 0..SAMPLES * SAMPLES {
            let (x, y) = (SAMPLES * column + k % SAMPLES, SAMPLES * row + k / SAMPLES);
            sum += match canvas.faces()[y * SIZE + x] {
                NOTHING => BACKGROUND_TOP.lerp(&BACKGROUND_BOTTOM, y as f32 / SIZE as f32),
                face => self.lit(face as usize, x, y) * (1.0 - hollow(canvas, x, y)),
            };
        }
        let linear = sum / (SAMPLES * SAMPLES) as f32;
        std::array::from_fn(|k| (255.0 * screen_value(linear[k])).round() as u8)
    }

    fn lit(&self, face: usize, x: usize, y: usize) -> Vec3 {
        let triangle = &self.triangles[face];
        let flat = self
            .view
            .turn(&direction(&area_normal(self.points, triangle)));
        let corners = triangle.map(|v| self.places[v as usize]);
        let weights = barycentric(&corners, x, y).unwrap_or([1.0 / 3.0; 3]);
        let mut normal = Vec3::zeros();
        for (&v, weight) in triangle.iter().zip(weights) {
            let smooth = self.normals[v as usize];
            normal += weight
                * if smooth.dot(&flat) > SMOOTH_COSINE {
                    smooth
                } else {
                    flat
                };
        }
        let is_outside = flat.z >= 0.0;
        let normal = if is_outside {
            direction(&normal)
        } else {
            -direction(&normal)
        };
        let color = match (face >= self.first_new, is_outside) {
            (false, true) => MESH,
            (false, false) => MESH_INSIDE,
            (true, true) => PATCH,
            (true, false) => PATCH_INSIDE,
        };
        let diffuse = |(from, strength): (Vec3, f32)| strength * normal.dot(&from).max(0.0);
        let ambient = AMBIENT_BELOW + (AMBIENT_ABOVE - AMBIENT_BELOW) * (0.5 + 0.5 * normal.y);
        let half = direction(&(KEY.0 + Vec3::z()));
        let highlight = HIGHLIGHT * normal.dot(&half).max(0.0).powi(HIGHLIGHT_EXPONENT);
        let gloss = if is_outside { highlight } else { 0.0 };
        color * (ambient + diffuse(KEY) + diffuse(FILL)) + Vec3::repeat(gloss)
    }
}

/// The share of the ambient light that does not reach a sample, 0 to 1. It is estimated from pairs of opposite
/// neighbors whose mean is nearer to the eye. On a plane the two cancel, at any tilt.
fn hollow(canvas: &Canvas, x: usize, y: usize) -> f32 {
    let here = canvas.depth(x as isize, y as isize);
    let rise = |dx: f32, dy: f32| {
        let there = canvas.depth(
            x as isize + dx.round() as isize,
            y as isize + dy.round() as isize,
        );
        (here - there).clamp(-HOLLOW_RADIUS, HOLLOW_RADIUS)
    };
    // The samples of a pixel use different directions, so that no bands are visible.
    let first = (x % SAMPLES + SAMPLES * (y % SAMPLES)) as f32 / (SAMPLES * SAMPLES) as f32;
    let mut sum = 0.0;
    for k in 0..HOLLOW_PAIRS {
        let share = (k as f32 + first + 0.25) / HOLLOW_PAIRS as f32;
        let (sin, cos) = ((k as f32 + first) * GOLDEN_ANGLE).sin_cos();
        let radius = HOLLOW_RADIUS * share;
        let (dx, dy) = (radius * cos, radius * sin);
        sum += ((rise(dx, dy) + rise(-dx, -dy)) / (2.0 * radius)).clamp(0.0, 1.0);
    }
    (HOLLOW_STRENGTH * sum / HOLLOW_PAIRS as f32).min(0.8)
}

/// The sRGB value of this brightness.
fn screen_value(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles, the second one a patch.
    fn draw_square(scale: f64, offset: f64) -> Picture {
        let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
            .map(|[x, y]| [offset + scale * x, offset + scale * y, offset]);
        let scene = Scene {
            positions: &positions,
            triangles: &[[0, 1, 2], [2, 3, 0]],
            first_new: 1,
            patches: std::slice::from_ref(&(1..2)),
        };
        draw(&scene)
    }

    fn is_orange(picture: &Picture, column: usize, row: usize) -> bool {
        let at = 3 * (row * picture.width + column);
        let [r, g, b] = [0, 1, 2].map(|k| u32::from(picture.rgb[at + k]));
        r > g + 40 && g > b
    }

    #[test]
    fn the_patch_is_orange_after_and_absent_before() {
        for (scale, offset) in [(1.0, 0.0), (1e-200, 0.0), (1e300, -1e308), (1.0, 1e9)] {
            let picture = draw_square(scale, offset);
            // Upper left of the middle of each half.
            assert!(!is_orange(&picture, 300, 300), "{scale} {offset}");
            assert!(is_orange(&picture, 800 + 300, 300), "{scale} {offset}");
            assert!(!is_orange(&picture, 800 + 500, 500), "{scale} {offset}");
        }
    }

    #[test]
    fn a_mesh_without_triangles_or_extent_gives_an_empty_picture() {
        for triangles in [&[][..], &[[0, 0, 0]], &[[0, 1, 2]]] {
            let positions = [[3.0; 3]; 3];
            let scene = Scene {
                positions: &positions,
                triangles,
                first_new: 0,
                patches: &[],
            };
            let picture = draw(&scene);
            assert!((0..800).all(|k| !is_orange(&picture, 2 * k, k)));
        }
    }

    #[test]
    fn the_png_has_the_size_of_the_picture() {
        let mut bytes = Vec::new();
        write_png(&draw_square(1.0, 0.0), &mut bytes).unwrap();
        let reader = png::Decoder::new(io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        assert_eq!(reader.info().size(), (1600, 800));
    }
}
