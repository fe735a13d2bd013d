//! Defects of a mesh. They are counted when the mesh is built, and never repaired.

/// Upper bound on the stored examples of each kind of defect.
const EXAMPLES: usize = 4;

/// One kind of defect: its number of occurrences, and the first few of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Defect<T> {
    /// Number of occurrences in the mesh.
    pub count: usize,
    /// The first occurrences, at most four.
    pub examples: Vec<T>,
}

impl<T> Default for Defect<T> {
    fn default() -> Self {
        Self {
            count: 0,
            examples: Vec::new(),
        }
    }
}

impl<T> Defect<T> {
    pub(crate) fn record(&mut self, place: T) {
        if self.examples.len() < EXAMPLES {
            self.examples.push(place);
        }
        self.count += 1;
    }
}

/// Irregularities found when a mesh was built. None of them is repaired or removed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MeshDefects {
    /// Edges with three or more triangles, as vertex pairs.
    pub nonmanifold_edges: Defect<[u32; 2]>,
    /// Edges whose two triangles have them in the same direction, as vertex pairs.
    pub inconsistent_edges: Defect<[u32; 2]>,
    /// Triangles that name a vertex twice. The connectivity ignores them.
    pub degenerate_faces: Defect<u32>,
    /// Triangles with the same three vertices as an earlier one.
    pub duplicate_faces: Defect<u32>,
    /// Vertices that no triangle uses.
    pub isolated_vertices: Defect<u32>,
}

impl MeshDefects {
    /// Whether nothing irregular was found.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.summary().is_empty()
    }

    /// One line for each kind of defect that occurs, with its count and its first occurrences.
    #[must_use]
    pub fn summary(&self) -> Vec<String> {
        let mut lines = Vec::new();
        describe(
            &mut lines,
            &self.nonmanifold_edges,
            "edges with more than two triangles",
            edge,
        );
        describe(
            &mut lines,
            &self.inconsistent_edges,
            "edges between triangles of opposite orientation",
            edge,
        );
        describe(
            &mut lines,
            &self.degenerate_faces,
            "triangles that name a vertex twice",
            u32::to_string,
        );
        describe(
            &mut lines,
            &self.duplicate_faces,
            "duplicate triangles",
            u32::to_string,
        );
        describe(
            &mut lines,
            &self.isolated_vertices,
            "vertices without a triangle",
            u32::to_string,
        );
        lines
    }
}

fn edge(e: &[u32; 2]) -> String {
    format!("{}-{}", e[0], e[1])
}

fn describe<T>(
    lines: &mut Vec<String>,
    defect: &Defect<T>,
    what: &str,
    place: impl Fn(&T) -> String,
) {
    if defect.count == 0 {
        return;
    }
    let places: Vec<String> = defect.examples.iter().map(place).collect();
    let more = if defect.count > places.len() {
        ", ..."
    } else {
        ""
    };
    lines.push(format!(
        "{} {what} ({}{more})",
        defect.count,
        places.join(", ")
    ));
}
