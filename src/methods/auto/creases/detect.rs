//! Finds the smooth regions of the mesh round a hole, and the rim vertices where the creases between them end.
//!
//! Two triangles with a common edge belong to one region if the angle between their filtered normals is below a
//! threshold; regions are the connected sets of such triangles. The threshold is the larger of a fixed angle and a
//! multiple of the angles that are usual round this hole. So coarse or noisy surfaces have only creases that stand out.
//! Regions that are too small join a neighbor. A crease must not zigzag, and must be convex or concave over most of its
//! length.
//!
//! Cost: `O(n log n)` for `n` known triangles. Not guaranteed: a crease that fades out or has a gap separates no
//! regions, and is not found.

use super::facets::{Facets, SharedEdge};
use crate::error::{Error, Result};
use crate::hole::Hole;
use crate::job::Job;
use crate::math::{Vec3, unit};

/// Lower bound on the angle of a crease, in radians. Finely triangulated smooth surfaces stay below it.
const LEAST_ANGLE: f64 = 35.0 / 180.0 * std::f64::consts::PI;

/// The quantile of all angles that counts as usual round the hole.
const USUAL_QUANTILE: f64 = 0.8;
/// Lower bound on the angle of a crease, divided by the usual angle.
const STAND_OUT: f64 = 2.5;

/// Rings of triangles that regions are made of.
const RINGS: u32 = 5;

/// Lower bounds on the triangles and the rim edges of a region. Smaller regions are bumps or noise.
const FEWEST_FACES: usize = 4;
const FEWEST_RIM_EDGES: usize = 2;

/// Lower bound on the length of the line through every second vertex of a crease, divided by the length through all
/// vertices. A straight crease has 1. A crease that the mesh does not follow with its edges zigzags across equilateral
/// triangles and has 0.87.
const STRAIGHTEST_SHARE: f64 = 0.93;

/// Lower bound on the share of a crease's length that is convex, or the share that is concave.
const SAME_BEND: f64 = 0.8;

/// The regions round a hole.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Regions {
    /// The known triangles of each region, in ascending order.
    pub(crate) faces: Vec<Vec<u32>>,
    /// The region at each edge of the hole's polygon.
    pub(crate) at_rim: Vec<u32>,
    /// The ends of creases at the rim, in the order of the polygon.
    pub(crate) ends: Vec<CreaseEnd>,
}

/// The end of a crease at the rim of a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CreaseEnd {
    /// Position in the polygon; the crease separates the regions of edge `position - 1` and edge `position`.
    pub(crate) position: usize,
    /// Unit vector along the crease, away from the hole.
    pub(crate) outward: Vec3,
}

/// Finds the regions round the hole; `None` when there is only one.
///
/// # Errors
/// [`crate::ErrorKind::Geometry`] when there are creases that cannot be used, with the reason; [`crate::ErrorKind::Cancelled`].
pub(crate) fn detect(hole: &Hole, job: &Job<'_>) -> Result<Option<Regions>> {
    job.ask()?;
    let mut facets = Facets::new(hole);
    // Filtering averages normals. So the angle between two of these will not reach that of a crease.
    if facets.turn_less_than(LEAST_ANGLE / 2.0) {
        return Ok(None);
    }
    job.ask()?;
    facets.find_edges(job)?;
    facets.filter_normals(job)?;
    let threshold = threshold(&facets);
    job.ask()?;
    let mut labels = Labels::new(&facets, threshold);
    job.ask()?;
    let at_rim = rim_faces(hole);
    labels.absorb_small_regions(&facets, &at_rim);
    if labels.count_at(at_rim.iter().flatten()) < 2 {
        return Ok(None);
    }
    let known: Option<Vec<u32>> = at_rim.into_iter().collect();
    let Some(at_rim) = known.filter(|_| hole.polygon.len() == hole.rim().len()) else {
        return unusable("the rim has islands, or edges without a triangle");
    };
    labels.join_across_wedges(&facets, hole, &at_rim, threshold);
    let at_rim: Vec<u32> = at_rim.iter().map(|&f| labels.of_face[f as usize]).collect();
    let len = at_rim.len();
    let mut ends = Vec::new();
    for position in 0..len {
        let sides = [at_rim[(position + len - 1) % len], at_rim[position]];
        if sides[0] == sides[1] {
            continue;
        }
        let crease = Crease::from_rim(&facets, &labels, hole.polygon[position], sides);
        crease.check()?;
        let outward = unit(crease.points[1] - crease.points[0]);
        ends.push(CreaseEnd { position, outward });
    }
    Ok(Some(collect(&facets, &labels, at_rim, ends)))
}

fn unusable<T>(reason: &str) -> Result<T> {
    Err(Error::geometry(reason.to_owned()))
}

/// The angle above which an edge lies on a crease, in radians.
fn threshold(facets: &Facets<'_>) -> f64 {
    let mut angles: Vec<f64> = facets.edges.iter().map(|e| facets.angle(e)).collect();
    let at = (USUAL_QUANTILE * angles.len() as f64) as usize;
    let usual = if at < angles.len() {
        *angles.select_nth_unstable_by(at, f64::total_cmp).1
    } else {
        0.0
    };
    LEAST_ANGLE.max(STAND_OUT * usual)
}

/// The known triangle at each edge of the polygon, if it has one.
fn rim_faces(hole: &Hole) -> Vec<Option<u32>> {
    let mut halfedges: Vec<(u32, u32, u32)> = Vec::new();
    let rim = hole.rim().len() as u32;
    for (f, t) in (0..).zip(hole.surroundings.triangles()) {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if a < rim && b < rim {
                halfedges.push((a, b, f));
            }
        }
    }
    halfedges.sort_unstable();
    let len = hole.polygon.len();
    (0..len)
        .map(|i| {
            // The known triangle has the edge in the opposite direction.
            let (a, b) = (hole.polygon[(i + 1) % len], hole.polygon[i]);
            let at = halfedges.binary_search_by_key(&(a, b), |&(a, b, _)| (a, b));
            at.ok().map(|at| halfedges[at].2)
        })
        .collect()
}

/// The partition of the known triangles into regions. While triangles are joined it is a forest of parents; after that
/// each triangle has the label of its region, which is one of the region's triangles.
struct Labels {
    of_face: Vec<u32>,
}

impl Labels {
    /// Joins triangles across edges with an angle below `threshold`.
    fn new(facets: &Facets<'_>, threshold: f64) -> Self {
        let count = facets.triangles().len();
        let mut labels = Self {
            of_face: (0..count as u32).collect(),
        };
        let is_inner = |f: u32| facets.ring(f as usize) < RINGS;
        for edge in &facets.edges {
            if facets.angle(edge) < threshold && edge.faces.iter().all(|&f| is_inner(f)) {
                labels.join(edge.faces);
            }
        }
        for f in 0..count as u32 {
            labels.of_face[f as usize] = labels.find(f);
        }
        labels
    }

    /// The first triangle of the region that `face` belongs to.
    fn find(&self, mut face: u32) -> u32 {
        while self.of_face[face as usize] != face {
            face = self.of_face[face as usize];
        }
        face
    }

    fn join(&mut self, faces: [u32; 2]) {
        let [a, b] = faces.map(|f| self.find(f));
        let first = a.min(b);
        for mut face in faces.into_iter().chain([a, b]) {
            while self.of_face[face as usize] != first {
                face = std::mem::replace(&mut self.of_face[face as usize], first);
            }
        }
    }

    fn count_at<'f>(&self, faces: impl Iterator<Item = &'f u32>) -> usize {
        let mut labels: Vec<u32> = faces.map(|&f| self.of_face[f as usize]).collect();
        labels.sort_unstable();
        labels.dedup();
        labels.len()
    }

    /// Joins two regions that meet only in a rim vertex, because the tip of a third region lies between them there, if
    /// the angle between them is below the threshold. They continue each other inside the hole.
    fn join_across_wedges(
        &mut self,
        facets: &Facets<'_>,
        hole: &Hole,
        at_rim: &[u32],
        threshold: f64,
    ) {
        let len = at_rim.len();
        for i in 0..len {
            let faces = [at_rim[(i + len - 1) % len], at_rim[i]];
            let [a, b] = faces.map(|f| self.of_face[f as usize]);
            if a == b {
                continue;
            }
            let meet = |e: &SharedEdge| {
                let [x, y] = e.faces.map(|f| self.of_face[f as usize]);
                ([x, y] == [a, b] || [y, x] == [a, b]) && e.vertices.contains(&hole.polygon[i])
            };
            if facets.angle_between(faces) < threshold && !facets.edges.iter().any(meet) {
                self.rename(b, a);
            }
        }
    }

    fn rename(&mut self, old: u32, new: u32) {
        for label in self.of_face.iter_mut().filter(|l| **l == old) {
            *label = new;
        }
    }

    /// Joins each region at the rim that is too small with the neighbor across the edge of smallest angle.
    fn absorb_small_regions(&mut self, facets: &Facets<'_>, at_rim: &[Option<u32>]) {
        // Each round removes a region.
        for _ in 0..at_rim.len() {
            let mut sizes = vec![(0, 0); self.of_face.len()];
            for &label in &self.of_face {
                sizes[label as usize].0 += 1;
            }
            for &face in at_rim.iter().flatten() {
                sizes[self.of_face[face as usize] as usize].1 += 1;
            }
            let small = (0..).zip(&sizes).find(|&(_, &(faces, rim_edges))| {
                rim_edges > 0 && (faces < FEWEST_FACES || rim_edges < FEWEST_RIM_EDGES)
            });
            let Some((small, _)) = small else { return };
            let outward = facets.edges.iter().filter_map(|e| {
                let [a, b] = e.faces.map(|f| self.of_face[f as usize]);
                let is_inner = e.faces.iter().all(|&f| facets.ring(f as usize) < RINGS);
                let other = if a == small { b } else { a };
                let touches = is_inner && a != b && (a == small || b == small);
                touches.then(|| (facets.angle(e), other))
            });
            let Some((_, other)) = outward.min_by(|x, y| x.0.total_cmp(&y.0)) else {
                return;
            };
            self.rename(small, other);
        }
    }
}

/// A chain of edges between two regions, from a rim vertex outward.
struct Crease {
    points: Vec<Vec3>,
    /// Length of each edge, and whether the surface is convex there.
    bends: Vec<(f64, bool)>,
}

impl Crease {
    fn from_rim(facets: &Facets<'_>, labels: &Labels, rim_vertex: u32, sides: [u32; 2]) -> Self {
        let separates = |e: &&SharedEdge| {
            let [a, b] = e.faces.map(|f| labels.of_face[f as usize]);
            [a, b] == sides || [b, a] == sides
        };
        let between: Vec<&SharedEdge> = facets.edges.iter().filter(separates).collect();
        let mut crease = Self {
            points: vec![facets.point(rim_vertex)],
            bends: Vec::new(),
        };
        let mut at = rim_vertex;
        let mut used = vec![false; between.len()];
        let onward = |at: u32, used: &[bool]| {
            (0..between.len()).find(|&i| !used[i] && between[i].vertices.contains(&at))
        };
        while let Some(i) = onward(at, &used) {
            used[i] = true;
            let [a, b] = between[i].vertices;
            at = if a == at { b } else { a };
            let point = facets.point(at);
            let length = (point - crease.points[crease.points.len() - 1]).norm();
            crease.points.push(point);
            crease.bends.push((length, facets.is_convex(between[i])));
        }
        crease
    }

    fn check(&self) -> Result<()> {
        let total: f64 = self.bends.iter().map(|b| b.0).sum();
        if self.bends.is_empty() || total <= 0.0 {
            return unusable("a crease has no edge behind the rim");
        }
        let convex: f64 = self.bends.iter().filter(|b| b.1).map(|b| b.0).sum();
        if convex.max(total - convex) < SAME_BEND * total {
            return unusable("a crease is convex in one part and concave in another");
        }
        let (mut straight, mut along) = (0.0, 0.0);
        for p in self.points.windows(3) {
            straight += (p[2] - p[0]).norm();
            along += (p[2] - p[1]).norm() + (p[1] - p[0]).norm();
        }
        if straight < STRAIGHTEST_SHARE * along {
            return unusable("a crease zigzags: the edges of the mesh do not follow it");
        }
        Ok(())
    }
}

/// Numbers the regions that touch the rim, in order along the polygon, and lists their triangles.
fn collect(
    facets: &Facets<'_>,
    labels: &Labels,
    at_rim: Vec<u32>,
    ends: Vec<CreaseEnd>,
) -> Regions {
    let mut order: Vec<u32> = Vec::new();
    let mut numbers = vec![None; labels.of_face.len()];
    for &label in &at_rim {
        if numbers[label as usize].is_none() {
            numbers[label as usize] = Some(order.len() as u32);
            order.push(label);
        }
    }
    let mut faces = vec![Vec::new(); order.len()];
    for (f, &label) in (0..).zip(&labels.of_face) {
        if let Some(number) = numbers[label as usize]
            && facets.ring(f as usize) < RINGS
        {
            faces[number as usize].push(f);
        }
    }
    let at_rim = at_rim
        .iter()
        .filter_map(|&label| numbers[label as usize])
        .collect();
    Regions {
        faces,
        at_rim,
        ends,
    }
}
