//! Makes a mesh from points, so that holes of a point cloud can be filled.
//!
//! All corners of triangles are input points. The surface ends where there are no samples, so the gaps of a scan become
//! holes of the mesh. The steps, with their files:
//!
//! 1. `cloud`: find the distinct points and their nearest neighbors.
//! 2. `normals`, `orientation`: estimate the normal of each point, and orient the normals consistently.
//! 3. `star`, with `tangent`: for each point, choose triangles in its tangent plane.
//! 4. `reach`: limit the size of triangles.
//! 5. `assemble`, with `surface` and `gaps`: take the triangles that fit together.
//! 6. `outward`: decide which side is outside.
//!
//! Sources: Gopi & Krishnan 2000, which J. Wang & M. Oliveira, Filling holes on locally smooth surfaces
//! reconstructed from point clouds, Image and Vision Computing 25(1), 2007, section 4.1 use, with the stars of Gopi,
//! Krishnan & Silva 2000; see `docs/methods/points.md`.
//!
//! Cost: see [`mesh_from_points`]. Not guaranteed: that surfaces are separated whose distance is only a few samples;
//! that triangles without a common corner do not intersect; that the mesh has the topology of the original surface.

mod assemble;
mod cloud;
mod gaps;
mod normals;
mod orientation;
mod outward;
mod reach;
mod star;
mod surface;
mod tangent;
#[cfg(test)]
mod tests;

use crate::error::{Error, Result};
use crate::fill::progress::{ProgressCallback, Watch};
use crate::job::Job;
use crate::math::plane::principal_spreads;
use crate::math::{Vec3, unit};
use crate::mesh::attributes::Attributes;
use crate::mesh::trimesh::TriMesh;
use assemble::Assembler;
use cloud::Cloud;
use tangent::Tangent;

/// Lower bound on the number of different points.
const FEWEST_POINTS: usize = 4;
/// All points together lie on a line if their second largest spread, divided by the largest, is below this.
const LINE_SPREAD: f64 = 1e-9;
/// Default of [`PointOptions::neighbours`].
const NEIGHBORS: usize = 24;

/// Points to make a mesh from.
#[derive(Clone, Debug, Default)]
pub struct PointCloud {
    /// The points.
    pub positions: Vec<[f64; 3]>,
    /// Normals that point outward, of any length, one per point. A normal that is zero or not finite is
    /// estimated, and takes the side of those around it.
    pub normals: Option<Vec<[f64; 3]>>,
    /// Attributes of the points, which become those of the vertices.
    pub attributes: Attributes,
}

impl PointCloud {
    /// Points without normals and attributes.
    #[must_use]
    pub fn new(positions: Vec<[f64; 3]>) -> Self {
        Self {
            attributes: Attributes::new(positions.len()),
            normals: None,
            positions,
        }
    }
}

/// How a mesh is made from points.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointOptions {
    /// The largest radius of the circle through the corners of a triangle, in units of the positions; holes
    /// that such a circle passes through stay open. `None` (the default) takes 3 times the median of the
    /// neighborhood, see `docs/methods/points.md`.
    pub radius: Option<f64>,
    /// How many of the nearest points each point chooses its triangles from, from 6 to 200; default 24.
    pub neighbours: usize,
}

impl Default for PointOptions {
    fn default() -> Self {
        Self {
            radius: None,
            neighbours: NEIGHBORS,
        }
    }
}

impl PointOptions {
    fn check(&self) -> Result<()> {
        if let Some(radius) = self.radius
            && !(radius > 0.0 && radius.is_finite())
        {
            return Err(Error::invalid(format!(
                "the radius is a positive number, not {radius}"
            )));
        }
        if !(6..=200).contains(&self.neighbours) {
            return Err(Error::invalid(format!(
                "{} neighbours cannot be used; 6 to 200 can",
                self.neighbours
            )));
        }
        Ok(())
    }
}

/// The report on a mesh that was made from points.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PointReport {
    /// Number of input points, which are the vertices of the mesh.
    pub points: usize,
    /// Points that a triangle uses.
    pub used: usize,
    /// Points at the position of an earlier point; no triangle uses them.
    pub duplicates: usize,
    /// Other points that no triangle uses.
    pub unused: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of pieces of surface that share no vertex.
    pub pieces: usize,
    /// Number of normals that were estimated, without those of duplicates.
    pub estimated_normals: usize,
    /// The upper bound on the radius of a triangle's circumscribed circle, in units of the positions: its minimum,
    /// median and maximum over the points.
    pub radius: [f64; 3],
}

/// Makes an oriented manifold mesh with boundary from points.
///
/// The vertices are the points, all of them, in their order, with the bits of their positions and attributes;
/// points that no triangle uses stay as isolated vertices. No edge has more than two triangles, no vertex more
/// than one fan, and neighboring triangles run along their common edge in opposite directions. Triangles are
/// in ascending order of their lowest vertex. Holes stay open.
///
/// With normals, triangles face where these point. Without, each piece faces away from its middle; a flat
/// piece faces the direction of the coordinate axis nearest to its normal.
///
/// Works in parallel in rayon's current pool; the result is the same for any number of threads.
/// `progress` is called about every 10 milliseconds, with no holes, and can cancel the work.
///
/// # Errors
/// [`crate::ErrorKind::InvalidInput`] for a position that is not finite, normals or attributes of another length than
/// the positions, fewer than 4 points, options out of range; [`crate::ErrorKind::Geometry`] for fewer than 4 different
/// points, points on a line, and when no triangle can be made; [`crate::ErrorKind::Cancelled`] when stopped.
///
/// # Complexity
/// O(n log n) time and O(n) memory, about 1 kB for each point, at a given number of neighbors.
pub fn mesh_from_points(
    cloud: PointCloud,
    options: &PointOptions,
    progress: Option<ProgressCallback<'_>>,
) -> Result<(TriMesh, PointReport)> {
    let watch = Watch::new(0, None, progress);
    reconstruct(cloud, options, &Job::new(&watch))
}

/// As [`mesh_from_points`], for a job of the caller.
pub(crate) fn reconstruct(
    cloud: PointCloud,
    options: &PointOptions,
    job: &Job<'_>,
) -> Result<(TriMesh, PointReport)> {
    options.check()?;
    let count = cloud.positions.len();
    check_lengths(&cloud)?;
    if count < FEWEST_POINTS {
        return Err(Error::invalid(format!(
            "{count} points are too few: a mesh needs at least {FEWEST_POINTS}"
        )));
    }
    let distinct = Cloud::new(&cloud.positions)?;
    check_spread(&distinct)?;

    let neighbors = distinct.all_nearest(options.neighbours, job)?;
    let known: Vec<Option<Vec3>> = distinct
        .sources
        .iter()
        .map(|&v| known_normal(cloud.normals.as_deref(), v))
        .collect();
    let mut normals = normals::estimate(&distinct, &neighbors, &known, job)?;
    orientation::agree(&distinct, &neighbors, &mut normals, &known, job)?;
    let tangents: Vec<Option<Tangent>> = distinct
        .points
        .iter()
        .zip(&normals)
        .map(|(p, n)| (n.norm_squared() > 0.0).then(|| Tangent::new(*p, *n)))
        .collect();
    let assembled = Assembler {
        cloud: &distinct,
        neighbors: &neighbors,
        tangents: &tangents,
        radius: options.radius.map(|r| r * distinct.scale),
        job,
    }
    .run()?;

    let mut triangles = assembled.triangles;
    if triangles.is_empty() {
        return Err(geometry(match options.radius {
            Some(radius) => {
                format!("no three neighboring points fit on a circle of radius {radius}")
            }
            None => "no three neighboring points make a triangle".to_owned(),
        }));
    }
    if known.iter().all(Option::is_none) {
        outward::face_outward(&distinct.points, &mut triangles);
        triangles.sort_unstable();
    }
    let report = PointReport {
        points: count,
        duplicates: count - distinct.len(),
        triangles: triangles.len(),
        pieces: piece_count(distinct.len(), &triangles),
        estimated_normals: known.iter().filter(|n| n.is_none()).count(),
        radius: range(assembled.limits).map(|r| r / distinct.scale),
        ..used(distinct.len(), &triangles)
    };
    for corner in triangles.iter_mut().flatten() {
        *corner = distinct.sources[*corner as usize];
    }
    let no_attributes = Attributes::new(triangles.len());
    let mesh =
        TriMesh::with_attributes(cloud.positions, triangles, cloud.attributes, no_attributes)?;
    Ok((mesh, report))
}

fn check_lengths(cloud: &PointCloud) -> Result<()> {
    let count = cloud.positions.len();
    let normals = cloud.normals.as_ref().map_or(count, Vec::len);
    for (what, entries) in [("normals", normals), ("attributes", cloud.attributes.len())] {
        if entries != count {
            return Err(Error::invalid(format!(
                "there are {entries} {what} for {count} points"
            )));
        }
    }
    Ok(())
}

fn check_spread(cloud: &Cloud) -> Result<()> {
    if cloud.len() < FEWEST_POINTS {
        return Err(geometry(format!(
            "the points are at {} different places only: a mesh needs at least {FEWEST_POINTS}",
            cloud.len()
        )));
    }
    let [longest, second, _] = principal_spreads(&cloud.points);
    if second <= LINE_SPREAD * longest {
        return Err(geometry("all points lie on one line".to_owned()));
    }
    Ok(())
}

/// The unit normal that the caller gave for point `v`.
fn known_normal(normals: Option<&[[f64; 3]]>, v: u32) -> Option<Vec3> {
    let normal = Vec3::from(normals?[v as usize]);
    // Dividing by the largest component avoids overflow.
    let largest = normal.amax();
    (largest > 0.0 && largest.is_finite() && normal.iter().all(|c| c.is_finite()))
        .then(|| unit(normal / largest))
}

/// How many of `count` points the triangles use.
fn used(count: usize, triangles: &[[u32; 3]]) -> PointReport {
    let mut is_used = vec![false; count];
    for &v in triangles.iter().flatten() {
        is_used[v as usize] = true;
    }
    let used = is_used.iter().filter(|&&u| u).count();
    PointReport {
        used,
        unused: count - used,
        ..PointReport::default()
    }
}

fn piece_count(vertex_count: usize, triangles: &[[u32; 3]]) -> usize {
    let pieces = outward::pieces(vertex_count, triangles);
    pieces.iter().max().map_or(0, |&last| last as usize + 1)
}

/// The smallest, the median and the largest value.
fn range(values: Vec<f64>) -> [f64; 3] {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    [low, reach::median(values).unwrap_or(0.0), high]
}

fn geometry(message: String) -> Error {
    Error::geometry(message)
}
