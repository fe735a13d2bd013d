//! Normals at the rim from local quadrics through the positions of the surroundings alone.
//!
//! Based on: F. Cazals, M. Pouget, "Estimating differential quantities using polynomial fitting of osculating jets",
//! Computer Aided Geometric Design 22(2), 2005. The normals of triangles at a rim lie to one side of it and lag
//! behind the surface by half an edge; a quadric through the vertex does not.
//!
//! `O(1)` per vertex of bounded degree. Where there are too few neighbours the mean triangle normal stands.

use crate::math::{Vec3, cross_normal, unit};
use crate::patch::HoleShape;
use nalgebra::{SMatrix, SVector, SymmetricEigen};

/// Coefficients of a quadric through the vertex: two of first and three of second order.
const UNKNOWNS: usize = 5;

/// Neighbours wanted for a fit, and how far they are looked for, in edges.
const WANTED: usize = 9;
const FEWEST_RINGS: usize = 2;
const MOST_RINGS: usize = 4;

/// Neighbours whose normal makes a larger angle than that with this cosine lie beyond a crease.
const SAME_SIDE: f64 = 0.2;

/// Directions of the fit that the points determine less than this part of the best determined one are left out.
const CONDITION: f64 = 1e-3;

/// Unit normals at the rim vertices of `hole`, oriented like the mesh.
pub(crate) fn rim_normals(hole: &HoleShape) -> Vec<Vec3> {
    let rim_count = hole.points.len();
    let mut points = hole.points.clone();
    points.extend(&hole.surroundings.points);
    let mut rough = vec![Vec3::zeros(); points.len()];
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
    for t in &hole.surroundings.triangles {
        let [a, b, c] = t.map(|v| points[v as usize]);
        let normal = unit(cross_normal(&a, &b, &c));
        for k in 0..3 {
            let (v, next, last) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            let to = |w: u32| points[w as usize] - points[v as usize];
            rough[v as usize] += normal * to(next).angle(&to(last));
            around[v as usize].extend([next, last]);
        }
    }
    for (normal, neighbours) in rough.iter_mut().zip(&mut around) {
        *normal = unit(*normal);
        neighbours.sort_unstable();
        neighbours.dedup();
    }
    (0..rim_count)
        .map(|v| {
            let near = neighbourhood(v as u32, &around, &rough);
            fit(&points, v, &near, rough[v]).unwrap_or(rough[v])
        })
        .collect()
}

/// The vertices within two edges, or more if they are few, on this side of creases.
fn neighbourhood(v: u32, around: &[Vec<u32>], normals: &[Vec3]) -> Vec<u32> {
    let mut met = vec![v];
    let mut frontier = vec![v];
    for ring in 0..MOST_RINGS {
        if ring >= FEWEST_RINGS && met.len() > WANTED {
            break;
        }
        let mut next: Vec<u32> = frontier
            .iter()
            .flat_map(|&w| around[w as usize].iter().copied())
            .filter(|w| !met.contains(w))
            .collect();
        next.sort_unstable();
        next.dedup();
        met.extend(&next);
        frontier = next;
    }
    met.retain(|&w| w != v && normals[w as usize].dot(&normals[v as usize]) > SAME_SIDE);
    met
}

/// The normal of the quadric `w = g1 u + g2 v + (c1 u² + 2 c2 u v + c3 v²) / 2` in the frame of `normal`, fitted by
/// weighted least squares. `None` when there are too few points.
fn fit(points: &[Vec3], center: usize, near: &[u32], normal: Vec3) -> Option<Vec3> {
    if near.len() < UNKNOWNS || normal == Vec3::zeros() {
        return None;
    }
    let other = if normal.x.abs() < 0.8 {
        Vec3::x()
    } else {
        Vec3::y()
    };
    let a = unit(normal.cross(&other));
    let b = normal.cross(&a);
    let local = |&p: &u32| {
        let d = points[p as usize] - points[center];
        [d.dot(&a), d.dot(&b), d.dot(&normal)]
    };
    let local: Vec<[f64; 3]> = near.iter().map(local).collect();
    let square: f64 = local.iter().map(|[u, v, _]| u * u + v * v).sum();
    let scale = (square / local.len() as f64).sqrt();
    if scale.is_nan() || scale <= 0.0 {
        return None;
    }
    let mut matrix = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    let mut right = SVector::<f64, UNKNOWNS>::zeros();
    for [u, v, w] in local.iter().map(|p| p.map(|x| x / scale)) {
        let row = SVector::from([u, v, u * u / 2.0, u * v, v * v / 2.0]);
        // The weight falls to a third at the distance of the scale; it enters the equations squared.
        let weight = (-2.0 * (u * u + v * v)).exp();
        matrix += row * row.transpose() * weight;
        right += row * (w * weight);
    }
    let eigen = SymmetricEigen::new(matrix);
    let smallest = eigen.eigenvalues.max() * CONDITION * CONDITION;
    let mut solution = SVector::<f64, UNKNOWNS>::zeros();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > smallest {
            solution += vector * (vector.dot(&right) / value);
        }
    }
    let fitted = unit(normal - a * solution[0] - b * solution[1]);
    (fitted.dot(&normal) > 0.0).then_some(fitted)
}
