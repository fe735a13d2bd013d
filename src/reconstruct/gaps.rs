//! Closes small holes between samples that remain after all triangles that fit in tangent planes were added.
//!
//! Such a hole has few edges, and triangles within the size limit can close it. But in the tangent plane of some corner
//! they overlap other triangles, because noise or a crease tilts the plane. So tangent planes are not used here. The
//! result must be a manifold, and the triangles must face the same side as the normals of their corners.
//!
//! Complexity: linear in the boundary.

use super::reach::circumradius;
use super::surface::{GrowingSurface, rotations};
use crate::math::{Vec3, cross_normal};

/// Upper bound on the edges of a hole that is closed. In a regular mesh, a hole as large as the size limit has this
/// number of edges.
const MOST_EDGES: usize = 12;

/// Closes holes of few edges, each completely or not at all. The circumscribed circles of new triangles are at most
/// `limit(corners)`. A new triangle must face the same side as the normals of its corners, or make an acute angle with
/// all triangles beside it, because estimated normals may be wrong at folds. Every point must have one fan.
pub(super) fn close_small_holes(
    surface: &mut GrowingSurface,
    points: &[Vec3],
    normal: impl Fn(u32) -> Option<Vec3>,
    limit: impl Fn([u32; 3]) -> f64,
) {
    for hole in small_loops(surface) {
        let added = clip_ears(surface, &hole, |surface, corners| {
            let place = |v: u32| points[v as usize];
            let facing = |[a, b, c]: [u32; 3]| cross_normal(&place(a), &place(b), &place(c));
            let own = facing(corners);
            let is_alike = |&v: &u32| normal(v).is_some_and(|n| n.dot(&own) > 0.0);
            let is_folded_against = |[a, b, _]: [u32; 3]| {
                let third = surface.third(b, a);
                third.is_some_and(|c| facing([b, a, c]).dot(&own) <= 0.0)
            };
            let radius = circumradius(corners.map(place));
            let fits = corners.iter().all(is_alike)
                || !rotations(corners).into_iter().any(is_folded_against);
            (radius <= limit(corners) && fits).then_some(radius)
        });
        if let Err(added) = added {
            for triangle in added {
                surface.remove(triangle);
            }
        }
    }
}

/// The boundary loops of few edges, in the direction of the triangles beside them.
fn small_loops(surface: &GrowingSurface) -> Vec<Vec<u32>> {
    let sides = surface.boundary();
    let next = |v: u32| {
        let at = sides.partition_point(|side| side[0] < v);
        sides
            .get(at)
            .filter(|side| side[0] == v)
            .map(|side| side[1])
    };
    let trace = |start: u32| {
        let mut vertices = vec![start];
        let mut at = next(start)?;
        while at != start {
            // Each loop is listed once, from its lowest vertex.
            if at < start || vertices.len() == MOST_EDGES {
                return None;
            }
            vertices.push(at);
            at = next(at)?;
        }
        Some(vertices)
    };
    sides.iter().filter_map(|side| trace(side[0])).collect()
}

/// Triangulates a loop by ear clipping, cheapest ear first. `cost` gives the cost of a triangle on the present
/// surface, or refuses it.
///
/// # Errors
/// The triangles that were already added, when no ear fits.
fn clip_ears(
    surface: &mut GrowingSurface,
    hole: &[u32],
    cost: impl Fn(&GrowingSurface, [u32; 3]) -> Option<f64>,
) -> Result<(), Vec<[u32; 3]>> {
    let mut rest = hole.to_vec();
    let mut added = Vec::new();
    while rest.len() >= 3 {
        let count = rest.len();
        let ears = (0..count).filter_map(|k| {
            let [a, b, c] = [0, 1, 2].map(|j| rest[(k + j) % count]);
            let is_joined = count > 3 && (surface.has_side(a, c) || surface.has_side(c, a));
            // In the opposite direction of the loop's sides.
            let ear = [c, b, a];
            let is_free = !is_joined && surface.connects(ear);
            let cost = if is_free { cost(surface, ear) } else { None };
            cost.map(|cost| (cost, k, ear))
        });
        let best = ears.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let Some((_, k, ear)) = best else {
            return Err(added);
        };
        surface.insert(ear);
        added.push(ear);
        if count == 3 {
            break;
        }
        rest.remove((k + 1) % count);
    }
    Ok(())
}
