//! Measures the deviation between two surfaces: distances in both directions, angles between normals, and the error
//! measures APE and MPE of papers.
//!
//! Each surface is sampled densely, in proportion to area. The positions of samples in the triangles follow the R2
//! sequence, so the result is not random. For each sample and each vertex, the distance to the closest point of the
//! other surface is measured.
//!
//! Sources: W.-C. Xie, X.-F. Zou, A triangulation-based hole patching method using differential evolution,
//! Computer-Aided Design 45(12), 2013, eq. 17, for APE and MPE; M. Roberts, The Unreasonable Effectiveness of
//! Quasirandom Sequences, 2018, for the sequence.
//!
//! Complexity: O((n + s) log n) for n triangles and s samples, in parallel. Not guaranteed: the exact Hausdorff
//! distance. The maximum over samples and vertices is a lower bound of it.

use super::{
    Surface, quantile,
    spatial::{FaceIndex, Nearest},
};
use crate::error::{Error, Result};
use crate::job::Job;
use crate::math::{Vec3, cross_normal, unit};
use rayon::prelude::*;

/// Samples per triangle, within [`SAMPLES_MIN`] and [`SAMPLES_MAX`] per surface.
const SAMPLES_PER_TRIANGLE: usize = 6;
const SAMPLES_MIN: usize = 30_000;
const SAMPLES_MAX: usize = 400_000;

/// Steps of the R2 sequence: inverse powers of the plastic number.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];

/// Distances from one surface to another, in the unit of the coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneWay {
    /// Mean over the area.
    pub mean: f64,
    /// Root mean square over the area.
    pub rms: f64,
    /// Largest over samples and vertices.
    pub max: f64,
}

/// Angles between the normal at a sample of the first surface and the normal of the closest face
/// of the second, in degrees, 0 to 180.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalAngles {
    /// Mean over the area.
    pub mean_deg: f64,
    /// 95 % of the area deviate less.
    pub p95_deg: f64,
    /// Largest.
    pub max_deg: f64,
}

/// Distances of the new vertices, without unit: divided by the largest absolute coordinate among
/// them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointErrors {
    /// Average point error (APE): the mean.
    pub ape: f64,
    /// Maximum point error (MPE).
    pub mpe: f64,
    /// Number of vertices it was taken over.
    pub vertices: usize,
}

/// How far two surfaces are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// From the first surface to the second.
    pub a_to_b: OneWay,
    /// From the second surface to the first.
    pub b_to_a: OneWay,
    /// Root of the mean of both mean squares, in the unit of the coordinates.
    pub symmetric_rms: f64,
    /// Larger of both maxima, in the unit of the coordinates.
    pub hausdorff: f64,
    /// Normals of the first surface against the second; `None` when no sample has both.
    pub normals: Option<NormalAngles>,
    /// Errors of the vertices of the first surface that the second does not have; `None` when there
    /// are none, or all of them are at the origin.
    pub point_errors: Option<PointErrors>,
}

/// Measures the surface `a` against the surface `b`, each given by its positions and triangles.
///
/// For the papers' figures `a` is the filled mesh and `b` the original.
///
/// # Errors
/// [`crate::ErrorKind::InvalidInput`] when a surface has no triangle, a triangle names a position that does
/// not exist, or a triangle's coordinate is not finite.
pub fn compare(
    a_positions: &[[f64; 3]],
    a_triangles: &[[u32; 3]],
    b_positions: &[[f64; 3]],
    b_triangles: &[[u32; 3]],
) -> Result<Deviation> {
    let surfaces = [
        ("first", a_positions, a_triangles),
        ("second", b_positions, b_triangles),
    ];
    for (name, positions, triangles) in surfaces {
        let is_missing = |v: &u32| *v as usize >= positions.len();
        if let Some(face) = triangles.iter().position(|t| t.iter().any(is_missing)) {
            return Err(Error::invalid(format!(
                "triangle {face} of the {name} surface names a vertex that does not exist"
            )));
        }
    }
    compare_surfaces(
        Surface {
            points: bytemuck::cast_slice(a_positions),
            triangles: a_triangles,
        },
        Surface {
            points: bytemuck::cast_slice(b_positions),
            triangles: b_triangles,
        },
    )
}

/// As [`compare`], for indices that are known to exist.
fn compare_surfaces(a: Surface<'_>, b: Surface<'_>) -> Result<Deviation> {
    for (name, surface) in [("first", a), ("second", b)] {
        if surface.triangles.is_empty() {
            return Err(Error::invalid(format!(
                "the {name} surface has no triangle to compare"
            )));
        }
        let is_finite = |v: &u32| surface.points[*v as usize].iter().all(|x| x.is_finite());
        if let Some(face) = surface
            .triangles
            .iter()
            .position(|t| !t.iter().all(is_finite))
        {
            return Err(Error::invalid(format!(
                "triangle {face} of the {name} surface has a coordinate that is not finite"
            )));
        }
    }
    let index_a = FaceIndex::build(a, &Job::unlimited())?;
    let index_b = FaceIndex::build(b, &Job::unlimited())?;
    let from_a = measure(a, b, &index_b)?;
    let from_b = measure(b, a, &index_a)?;
    let (ab, ba) = (from_a.distances, from_b.distances);
    Ok(Deviation {
        a_to_b: ab,
        b_to_a: ba,
        symmetric_rms: ((ab.rms * ab.rms + ba.rms * ba.rms) / 2.0).sqrt(),
        hausdorff: ab.max.max(ba.max),
        normals: normal_angles(a, b, &from_a.samples),
        point_errors: point_errors(a, b, &from_a.vertices),
    })
}

/// The measurements from one surface to another.
struct Measured {
    distances: OneWay,
    /// Face of the sample and nearest face of the other surface.
    samples: Vec<(u32, u32)>,
    /// Used vertices and their distances.
    vertices: Vec<(u32, f64)>,
}

fn measure(from: Surface<'_>, to: Surface<'_>, index: &FaceIndex) -> Result<Measured> {
    let nearest = |p: &Vec3| -> Result<Nearest> {
        index
            .nearest(to, p)
            .ok_or_else(|| Error::invalid("the coordinates are too large to compare"))
    };
    let samples = sample(from);
    let hits: Vec<(u32, Nearest)> = samples
        .par_iter()
        .map(|(face, p)| Ok((*face, nearest(p)?)))
        .collect::<Result<_>>()?;
    let vertices: Vec<(u32, f64)> = used_vertices(from)
        .into_par_iter()
        .map(|v| Ok((v, nearest(&from.points[v as usize])?.distance_sq.sqrt())))
        .collect::<Result<_>>()?;

    // Summed in order: a parallel sum would depend on how the work was divided.
    let count = hits.len() as f64;
    let squares = || hits.iter().map(|(_, n)| n.distance_sq);
    let max_sample = squares().fold(0.0, f64::max).sqrt();
    let distances = OneWay {
        mean: squares().map(f64::sqrt).sum::<f64>() / count,
        rms: (squares().sum::<f64>() / count).sqrt(),
        max: vertices.iter().map(|v| v.1).fold(max_sample, f64::max),
    };
    let samples = hits.iter().map(|(face, n)| (*face, n.face)).collect();
    Ok(Measured {
        distances,
        samples,
        vertices,
    })
}

fn used_vertices(surface: Surface<'_>) -> Vec<u32> {
    let mut used = vec![false; surface.points.len()];
    for &v in surface.triangles.iter().flatten() {
        used[v as usize] = true;
    }
    (0..surface.points.len() as u32)
        .filter(|&v| used[v as usize])
        .collect()
}

fn face_normal(surface: Surface<'_>, face: usize) -> Vec3 {
    let [a, b, c] = surface.corners(face);
    cross_normal(&a, &b, &c)
}

/// Samples in proportion to area, each with its face; one per face when there is no area at all.
fn sample(surface: Surface<'_>) -> Vec<(u32, Vec3)> {
    let faces = surface.triangles.len();
    let mut reached = 0.0;
    let area_up_to: Vec<f64> = (0..faces)
        .map(|f| {
            reached += face_normal(surface, f).norm();
            reached
        })
        .collect();
    if !(reached > 0.0 && reached.is_finite()) {
        let centroid = |f: usize| surface.corners(f).iter().map(|p| p / 3.0).sum();
        return (0..faces).map(|f| (f as u32, centroid(f))).collect();
    }
    let count = faces
        .saturating_mul(SAMPLES_PER_TRIANGLE)
        .clamp(SAMPLES_MIN, SAMPLES_MAX);
    let mut face = 0;
    (0..count)
        .map(|k| {
            let share = (k as f64 + 0.5) / count as f64;
            while face + 1 < faces && area_up_to[face] <= share * reached {
                face += 1;
            }
            let [a, b, c] = surface.corners(face);
            let [r, s] = R2.map(|step| (k as f64 * step).fract());
            // The square root makes the density uniform between the corner `a` and the edge opposite to it.
            let root = r.sqrt();
            (
                face as u32,
                a * (1.0 - root) + b * (root * (1.0 - s)) + c * (root * s),
            )
        })
        .collect()
}

fn normal_angles(a: Surface<'_>, b: Surface<'_>, samples: &[(u32, u32)]) -> Option<NormalAngles> {
    let mut angles: Vec<f64> = samples
        .par_iter()
        .filter_map(|&(f, g)| {
            let n = unit(face_normal(a, f as usize));
            let m = unit(face_normal(b, g as usize));
            let defined = n != Vec3::zeros() && m != Vec3::zeros();
            defined.then(|| n.cross(&m).norm().atan2(n.dot(&m)))
        })
        .collect();
    angles.par_sort_unstable_by(f64::total_cmp);
    Some(NormalAngles {
        mean_deg: (angles.iter().sum::<f64>() / angles.len() as f64).to_degrees(),
        p95_deg: quantile(&angles, 0.95)?.to_degrees(),
        max_deg: angles.last()?.to_degrees(),
    })
}

/// Errors over the vertices of `a` that are not vertices of `b`, given the distances of all.
///
/// Positions are compared in the coarser precision of the two: when all coordinates of one surface
/// are single-precision values, both are rounded to that first.
fn point_errors(a: Surface<'_>, b: Surface<'_>, distances: &[(u32, f64)]) -> Option<PointErrors> {
    let single = is_single_precision(a) || is_single_precision(b);
    let key = |p: &Vec3| -> [u64; 3] {
        // Adding zero turns -0.0 into 0.0.
        std::array::from_fn(|k| {
            let x = if single { f64::from(p[k] as f32) } else { p[k] };
            (x + 0.0).to_bits()
        })
    };
    let mut known: Vec<[u64; 3]> = b.points.iter().map(key).collect();
    known.par_sort_unstable();
    let new: Vec<&(u32, f64)> = distances
        .iter()
        .filter(|(v, _)| known.binary_search(&key(&a.points[*v as usize])).is_err())
        .collect();
    let largest = new
        .iter()
        .map(|(v, _)| a.points[*v as usize].amax())
        .fold(0.0, f64::max);
    (largest > 0.0).then(|| PointErrors {
        ape: new.iter().map(|(_, d)| d).sum::<f64>() / new.len() as f64 / largest,
        mpe: new.iter().map(|(_, d)| *d).fold(0.0, f64::max) / largest,
        vertices: new.len(),
    })
}

fn is_single_precision(surface: Surface<'_>) -> bool {
    surface
        .points
        .iter()
        .flatten()
        .all(|&x| f64::from(x as f32) == x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::ErrorKind;

    /// A square of side `side` at height `z`, in 2 n^2 triangles facing up.
    fn square(n: u32, side: f64, z: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut points = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..=n {
            for j in 0..=n {
                let at = |k: u32| side * f64::from(k) / f64::from(n);
                points.push(Vec3::new(at(i), at(j), z));
                if i < n && j < n {
                    let a = i * (n + 1) + j;
                    triangles.push([a, a + n + 1, a + 1]);
                    triangles.push([a + n + 1, a + n + 2, a + 1]);
                }
            }
        }
        (points, triangles)
    }

    fn surface((points, triangles): &(Vec<Vec3>, Vec<[u32; 3]>)) -> Surface<'_> {
        Surface { points, triangles }
    }

    fn near(x: f64, y: f64, tolerance: f64) -> bool {
        (x - y).abs() <= tolerance
    }

    #[test]
    fn a_surface_does_not_deviate_from_itself_however_it_is_cut() {
        let (coarse, fine) = (square(3, 1.0, 0.25), square(7, 1.0, 0.25));
        let same = compare_surfaces(surface(&fine), surface(&fine)).expect("sound");
        assert!(same.hausdorff < 1e-15 && same.point_errors.is_none());
        let recut = compare_surfaces(surface(&fine), surface(&coarse)).expect("sound");
        assert!(recut.hausdorff < 1e-15 && recut.symmetric_rms < 1e-15);
        let errors = recut.point_errors.expect("there are new vertices");
        assert_eq!(errors.vertices, 8 * 8 - 4);
        assert!(recut.normals.expect("there are normals").max_deg < 1e-6);
    }

    #[test]
    fn parallel_squares_are_their_gap_apart() {
        let (a, b) = (square(4, 1.0, 0.0), square(5, 1.0, 0.5));
        let d = compare_surfaces(surface(&a), surface(&b)).expect("sound");
        for x in [
            d.a_to_b.mean,
            d.a_to_b.rms,
            d.a_to_b.max,
            d.b_to_a.mean,
            d.symmetric_rms,
        ] {
            assert!(near(x, 0.5, 1e-12), "{d:?}");
        }
        let errors = d.point_errors.expect("no vertex is shared");
        assert!(near(errors.ape, 0.5, 1e-12) && near(errors.mpe, 0.5, 1e-12));
        assert_eq!(errors.vertices, 25);
    }

    #[test]
    fn one_way_figures_differ_where_one_surface_is_larger() {
        // From the strip beyond the small square: distance x - 1, uniform in 0..1.
        let small = square(3, 1.0, 0.0);
        let (mut points, triangles) = square(3, 1.0, 0.0);
        for p in &mut points {
            p.x *= 2.0;
        }
        let d = compare_surfaces(surface(&small), surface(&(points, triangles))).expect("sound");
        assert!(d.a_to_b.max < 1e-15);
        assert!(near(d.b_to_a.mean, 0.25, 1e-4), "{d:?}");
        assert!(near(d.b_to_a.rms, (1.0f64 / 6.0).sqrt(), 1e-4), "{d:?}");
        assert_eq!((d.b_to_a.max, d.hausdorff), (1.0, 1.0));
        assert!(near(d.symmetric_rms, (1.0f64 / 12.0).sqrt(), 1e-4));
    }

    #[test]
    fn point_errors_are_over_new_vertices_and_scaled_by_their_coordinates() {
        let base = square(1, 4.0, 0.0);
        let mut raised = base.clone();
        raised.0.push(Vec3::new(2.0, 2.0, 3.0));
        raised.1 = vec![[0, 2, 4], [2, 3, 4], [3, 1, 4], [1, 0, 4]];
        let d = compare_surfaces(surface(&raised), surface(&base)).expect("sound");
        let errors = d.point_errors.expect("one new vertex");
        assert_eq!((errors.ape, errors.mpe, errors.vertices), (1.0, 1.0, 1));
        assert_eq!(d.a_to_b.max, 3.0);
    }

    #[test]
    fn a_vertex_rounded_to_single_precision_is_not_new() {
        let third = square(3, 1.0, 0.1);
        let mut rounded = third.clone();
        for p in &mut rounded.0 {
            *p = p.map(|x| f64::from(x as f32));
        }
        for (a, b) in [(&third, &rounded), (&rounded, &third)] {
            assert_eq!(
                compare_surfaces(surface(a), surface(b))
                    .expect("sound")
                    .point_errors,
                None
            );
        }
        let mut moved = third.clone();
        moved.0[5].z += 1e-12;
        let d = compare_surfaces(surface(&moved), surface(&third)).expect("sound");
        assert_eq!(d.point_errors.map(|e| e.vertices), Some(1));
    }

    #[test]
    fn normals_are_compared_with_their_orientation() {
        let floor = square(2, 1.0, 0.0);
        let mut under = floor.clone();
        under.1.iter_mut().for_each(|t| t.swap(0, 1));
        let tilted = {
            let (s, c) = 30f64.to_radians().sin_cos();
            let (points, triangles) = square(2, 1.0, 0.0);
            let turn = |p: Vec3| Vec3::new(p.x * c, p.y, p.x * s);
            (points.into_iter().map(turn).collect(), triangles)
        };
        for (other, expected) in [(&under, 180.0), (&tilted, 30.0)] {
            let d = compare_surfaces(surface(&floor), surface(other)).expect("sound");
            let normals = d.normals.expect("there are normals");
            for x in [normals.mean_deg, normals.p95_deg, normals.max_deg] {
                assert!(near(x, expected, 1e-6), "{normals:?}");
            }
        }
    }

    #[test]
    fn samples_spread_evenly_over_the_area() {
        // Triangles of very different size: each third of the square's width gets its share.
        let mut skewed = square(30, 1.0, 0.0);
        for p in &mut skewed.0 {
            p.x = p.x.powi(3);
        }
        let samples = sample(surface(&skewed));
        assert!(samples.len() >= SAMPLES_MIN);
        for third in 0..3 {
            let lo = f64::from(third) / 3.0;
            let inside = samples
                .iter()
                .filter(|(_, p)| (lo..lo + 1.0 / 3.0).contains(&p.x));
            let share = inside.count() as f64 / samples.len() as f64;
            assert!(near(share, 1.0 / 3.0, 2e-3), "{share}");
        }
    }

    #[test]
    fn degenerate_surfaces_are_measured_and_unusable_ones_refused() {
        let points = [
            Vec3::zeros(),
            Vec3::x(),
            Vec3::x() * 2.0,
            Vec3::repeat(f64::NAN),
        ];
        let line = Surface {
            points: &points,
            triangles: &[[0, 1, 2], [0, 0, 0]],
        };
        let floor = square(2, 1.0, 0.5);
        let d = compare_surfaces(line, surface(&floor)).expect("a line has distances");
        assert_eq!(d.normals, None);
        assert!(near(d.a_to_b.max, 1.25f64.sqrt(), 1e-12), "{d:?}");
        let empty = Surface {
            points: &points,
            triangles: &[],
        };
        let broken = Surface {
            points: &points,
            triangles: &[[0, 1, 3]],
        };
        for bad in [empty, broken] {
            for (a, b) in [(bad, line), (line, bad)] {
                assert_eq!(
                    compare_surfaces(a, b).map_err(|e| e.kind()),
                    Err(ErrorKind::InvalidInput)
                );
            }
        }
        // Distances overflow here; what matters is that nothing panics.
        let far = [Vec3::repeat(-f64::MAX), Vec3::repeat(f64::MAX), Vec3::x()];
        let _ = compare_surfaces(
            Surface {
                points: &far,
                triangles: &[[0, 1, 2]],
            },
            line,
        );
    }

    #[test]
    fn a_triangle_without_its_vertices_is_refused() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let (good, bad) = ([[0, 1, 2]], [[0, 1, 3]]);
        assert!(compare(&points, &good, &points, &good).is_ok());
        for (a, b, name) in [(&bad, &good, "first"), (&good, &bad, "second")] {
            let error = compare(&points, a, &points, b).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::InvalidInput);
            assert!(error.message().contains(name), "{error}");
        }
    }
}
