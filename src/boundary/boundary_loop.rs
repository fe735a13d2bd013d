//! One boundary loop: its edges, its measures and its class.

use crate::math::Vec3;
use crate::math::aabb::Aabb;
use crate::math::plane::principal_spreads;
use crate::mesh::halfedge::BOUNDARY;
use std::fmt;

/// The kind of a boundary loop.
///
/// [`LoopClass::Island`] and [`LoopClass::OuterRim`] are judgements from geometry, meant as advice; they
/// can be wrong on strongly curved sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum LoopClass {
    /// The rim of a hole that touches no other loop.
    Simple,
    /// The rim of a hole that shares a vertex with another loop.
    Touching,
    /// The rim of a small sheet of its own that lies inside the hole of another loop.
    Island,
    /// The outer rim of an open sheet.
    OuterRim,
    /// The triangles along the loop are not oriented alike; it cannot be filled.
    NotOriented,
    /// The boundary runs into an edge with more than two triangles and does not close; it cannot be
    /// filled.
    OpenChain,
}

impl LoopClass {
    /// The name used in tables and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Simple => "simple",
            Self::Touching => "touching",
            Self::Island => "island",
            Self::OuterRim => "outer-rim",
            Self::NotOriented => "not-oriented",
            Self::OpenChain => "open-chain",
        }
    }

    /// Why no patch can be made for a loop of this kind.
    pub(crate) fn unfillable_reason(self) -> Option<&'static str> {
        match self {
            Self::NotOriented => Some("the triangles along the loop are not oriented alike"),
            Self::OpenChain => Some(
                "the boundary does not close: it runs into an edge with more than two triangles",
            ),
            _ => None,
        }
    }
}

impl fmt::Display for LoopClass {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A closed chain of boundary edges that visits no vertex twice; with [`LoopClass::OpenChain`] neither is
/// promised.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundaryLoop {
    /// Position in [`BoundaryLoops::loops`](crate::BoundaryLoops::loops).
    pub id: usize,
    /// Vertices in the direction in which the triangles along the loop run; edge `i` runs from vertex
    /// `i` to vertex `i + 1`, the last one back to vertex 0.
    ///
    /// An open chain ([`LoopClass::OpenChain`]) has one vertex more than edges. Where the triangles are
    /// not oriented alike, the direction is that of the lowest triangle along the loop.
    pub vertices: Vec<u32>,
    /// Length of the loop, in units of the positions.
    pub perimeter: f64,
    /// Half the sum of the cross products of successive vertices, that is the area that the loop
    /// encloses as seen from each axis. Points to the side from which the loop runs
    /// counter-clockwise.
    pub vector_area: [f64; 3],
    /// Length of the diagonal of the loop's bounding box.
    pub diameter: f64,
    /// Root mean square distance of the vertices to their plane of least squares, divided by the root
    /// mean square distance to their centroid: 0 for a planar loop, at most about 0.58.
    pub planarity: f64,
    /// What kind of boundary this is.
    pub class: LoopClass,
    /// Boundary halfedges, edge by edge.
    pub(crate) halfedges: Vec<u32>,
    /// The edges, ascending, whose halfedge runs against the loop.
    pub(crate) reversed: Vec<usize>,
    /// For an island the loop whose hole it lies in.
    pub(crate) host: Option<usize>,
    /// The bounding box.
    pub(crate) bounds: Aabb,
}

impl BoundaryLoop {
    /// The closed polyline through `points` as a loop that no triangle lies along.
    pub(crate) fn of_polyline(points: &[Vec3]) -> Self {
        let vertices = (0..points.len() as u32).collect();
        measure_points(vertices, points, vec![BOUNDARY; points.len()])
    }

    /// One directed edge of the loop, as in its triangle: it names the loop in selections.
    #[must_use]
    pub fn edge(&self) -> [u32; 2] {
        self.directed_edge(0)
    }

    /// Number of edges, which is also the number of vertices unless the loop is an open chain.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.halfedges.len()
    }

    /// Edge `i` as it runs in its triangle.
    pub(crate) fn directed_edge(&self, i: usize) -> [u32; 2] {
        let (from, to) = (
            self.vertices[i],
            self.vertices[(i + 1) % self.vertices.len()],
        );
        if self.reversed.binary_search(&i).is_ok() {
            [to, from]
        } else {
            [from, to]
        }
    }
}

/// A simple loop with the measures of `points`, which are the positions of its vertices.
pub(super) fn measure_points(
    vertices: Vec<u32>,
    points: &[Vec3],
    halfedges: Vec<u32>,
) -> BoundaryLoop {
    let mut area = Vec3::zeros();
    let bounds = Aabb::around(points);
    for (i, p) in points.iter().enumerate() {
        let q = points[(i + 1) % points.len()];
        area += (p - points[0]).cross(&(q - points[0])) / 2.0;
    }
    let length = |i: usize| (points[(i + 1) % points.len()] - points[i]).norm();
    let perimeter = (0..halfedges.len()).map(length).sum();
    let spread = principal_spreads(points);
    let total = spread.iter().map(|s| s * s).sum::<f64>().sqrt();
    BoundaryLoop {
        id: 0,
        perimeter,
        vector_area: area.into(),
        diameter: (bounds.hi - bounds.lo).norm(),
        planarity: if total > 0.0 { spread[2] / total } else { 0.0 },
        class: LoopClass::Simple,
        vertices,
        halfedges,
        reversed: Vec::new(),
        host: None,
        bounds,
    }
}
