//! What happened to each hole.

use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::boundary_loop::LoopClass;
use crate::error::ErrorKind;
use crate::methods::auto::prediction::Prediction;
use crate::methods::method::Method;
use serde::{Serialize, Serializer};
use std::ops::Range;

/// How the filling of one hole ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum HoleStatus {
    /// The hole is closed.
    Filled,
    /// The hole was not asked to be filled.
    Kept,
    /// No method gave an acceptable patch; the hole is as it was.
    Failed,
    /// The caller stopped before the hole was filled; it is as it was.
    Cancelled,
}

impl HoleStatus {
    /// The name used in tables and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Filled => "filled",
            Self::Kept => "kept",
            Self::Failed => "failed",
            Self::Cancelled => "cancelled",
        }
    }
}

/// A method that was tried on a hole and not used, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Attempt {
    /// The method.
    pub method: Method,
    /// Why its patch was not used.
    pub reason: String,
}

/// What happened to one hole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HoleReport {
    /// The loop's position in [`crate::BoundaryLoops::loops`].
    pub id: usize,
    /// One directed boundary edge of the loop before the fill.
    pub edge: [u32; 2],
    /// Number of boundary edges.
    pub edges: usize,
    /// Length of the loop.
    pub perimeter: f64,
    /// Kind of the loop.
    pub class: LoopClass,
    /// How it ended.
    pub status: HoleStatus,
    /// Why: for a filled hole what remains to be said (empty when nothing does).
    pub reason: String,
    /// The kind of the error that kept the hole open, if it was one.
    #[serde(skip)]
    pub cause: Option<ErrorKind>,
    /// The method whose patch closes the hole.
    pub method: Option<Method>,
    /// The other methods tried, in order.
    pub tried: Vec<Attempt>,
    /// How the surface was predicted, when a method did so; `method` says whether the prediction stands.
    pub prediction: Option<Prediction>,
    /// New vertices, as a range of indices into the filled mesh.
    #[serde(serialize_with = "length")]
    pub new_vertices: Range<u32>,
    /// New triangles, as a range of indices into the filled mesh.
    #[serde(serialize_with = "length")]
    pub new_triangles: Range<u32>,
    /// Pairs of triangles that intersect, one of them new.
    pub self_intersections: usize,
    /// Smallest angle of the new triangles in radians.
    #[serde(rename = "min_angle_deg", serialize_with = "degrees")]
    pub min_angle: Option<f64>,
    /// Time spent on the hole, in seconds.
    pub seconds: f64,
}

impl HoleReport {
    /// That of a loop which stays open: because it is `kept`, or because it cannot be filled. Of a loop that is to be filled
    /// it says nothing yet.
    pub(super) fn of_open(l: &BoundaryLoop, kept: Option<String>) -> Self {
        let unfillable = l.class.unfillable_reason().filter(|_| kept.is_none());
        Self {
            id: l.id,
            edge: l.edge(),
            edges: l.edge_count(),
            perimeter: l.perimeter,
            class: l.class,
            status: if kept.is_some() {
                HoleStatus::Kept
            } else {
                HoleStatus::Failed
            },
            reason: kept.unwrap_or_else(|| unfillable.unwrap_or_default().to_owned()),
            cause: unfillable.map(|_| ErrorKind::Topology),
            method: None,
            tried: Vec::new(),
            prediction: None,
            new_vertices: 0..0,
            new_triangles: 0..0,
            self_intersections: 0,
            min_angle: None,
            seconds: 0.0,
        }
    }

    /// Takes back what was said of a patch.
    pub(super) fn clear(&mut self) {
        self.reason.clear();
        self.cause = None;
        self.method = None;
        self.tried.clear();
        self.prediction = None;
        (self.new_vertices, self.new_triangles) = (0..0, 0..0);
        self.self_intersections = 0;
        self.min_angle = None;
        self.seconds = 0.0;
    }
}

/// What happened to all holes of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FillReport {
    /// One entry for each boundary loop, in the order of [`crate::BoundaryLoops::loops`].
    pub holes: Vec<HoleReport>,
    /// Time spent to index the mesh for the intersection tests, and to give back the index, in seconds.
    pub index_seconds: f64,
    /// Time spent to fill, in seconds, without the index.
    pub fill_seconds: f64,
}

impl FillReport {
    /// Number of holes with this status.
    #[must_use]
    pub fn count(&self, status: HoleStatus) -> usize {
        self.holes.iter().filter(|h| h.status == status).count()
    }

    /// The report as JSON. Its holes have the form that `holefill fill --report` writes.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Numbers, texts, and lists and maps of them always have a JSON form.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }
}

// The JSON form of the report

/// What has a name is that name.
macro_rules! by_name {
    ($($named:ty),*) => {$(
        impl Serialize for $named {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }
    )*};
}
by_name!(HoleStatus, LoopClass, Method);

fn length<S: Serializer>(range: &Range<u32>, serializer: S) -> Result<S::Ok, S::Error> {
    range.len().serialize(serializer)
}

fn degrees<S: Serializer>(angle: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    angle.map(f64::to_degrees).serialize(serializer)
}
