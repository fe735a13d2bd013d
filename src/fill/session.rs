//! A mesh whose holes are filled one by one: what costs a pass over the mesh is done once and kept.

use super::hole::Hole;
use super::index::MeshIndex;
use super::pipeline::{
    HoleLoops, Planned, Work, blank_report, check_attribute_names, group_holes, thread_pool,
    unfillable_reason,
};
use super::plan::{Plan, PlanFailure, chain};
use super::polyline;
use super::progress::{ProgressCallback, Watch};
use super::report::{FillReport, HoleReport};
use super::stitch::Outcome;
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::select::Selection;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::math::Vec3;
use crate::mesh::attributes::AttributeValues;
use crate::mesh::halfedge::BOUNDARY;
use crate::mesh::trimesh::TriMesh;
use crate::options::FillOptions;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, TryLockError};
use std::time::{Duration, Instant};

/// Time between two looks whether another thread has built the index.
const WAIT: Duration = Duration::from_millis(1);

/// Which holes to plan or to fill.
#[derive(Clone, Copy, Debug)]
pub enum Target<'a> {
    /// The loops of these ids. They must be open and fillable; the others get no entry in the report.
    Loops(&'a [usize]),
    /// All open loops that the rules choose; every loop gets an entry in the report.
    Selected(&'a Selection),
}

/// A mesh, its boundary loops, and what filling them one by one needs.
///
/// Loops are found when they are first asked for, and keep their ids from then on: filling a hole closes its
/// loop and changes no other. The first plan or fill builds the index for the intersection tests; from then on the
/// cost of a fill follows its holes.
#[derive(Debug)]
pub struct FillSession {
    mesh: TriMesh,
    /// Set for a polyline: the normals, if there are any.
    polyline: Option<Option<Vec<Vec3>>>,
    boundary: OnceLock<Boundary>,
    index: OnceLock<MeshIndex>,
    /// Held while the index is built.
    indexing: Mutex<()>,
    /// Vertices and triangles before each fill that was not undone.
    fills: Vec<[usize; 2]>,
    /// Counts changes of the mesh.
    revision: u64,
    /// Number of triangles after each undo, with the revision; only those that no later undo went below.
    undone: Vec<(u64, usize)>,
    /// The revision of the attributes' layout.
    layout: u64,
    /// What plans know this session by.
    token: Arc<()>,
}

/// Patches that were made for some holes and are not part of the mesh. Holds nothing of the mesh.
///
/// Each patch is checked by itself: against the mesh, not against the other patches, which
/// [`FillSession::apply`] does.
pub struct FillPlan {
    token: Arc<()>,
    options: FillOptions,
    revision: u64,
    layout: u64,
    vertex_count: usize,
    triangle_count: usize,
    holes: Vec<PlannedHole>,
    blank: Vec<HoleReport>,
    report: FillReport,
}

struct PlannedHole {
    outer: usize,
    islands: Vec<usize>,
    planned: Planned,
    /// New vertices in the numbering of the plan.
    vertices: Range<usize>,
}

/// One patch of a plan: new vertices and triangles, in the indices of the mesh it was made for.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedPatch {
    /// Id of the loop that bounds it.
    pub loop_id: usize,
    /// Index of the first new vertex: vertices of the mesh are below it, and so are those of the patches before
    /// this one.
    pub first_vertex: usize,
    /// Positions of the new vertices.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles, oriented like those round the hole.
    pub triangles: Vec<[u32; 3]>,
}

#[derive(Debug)]
struct Boundary {
    loops: BoundaryLoops,
    /// Boundary halfedges with the loop that they are on, ascending.
    places: Vec<(u32, usize)>,
}

impl FillSession {
    /// Takes a mesh. Nothing is computed yet.
    #[must_use]
    pub fn new(mesh: TriMesh) -> Self {
        Self {
            mesh,
            polyline: None,
            boundary: OnceLock::new(),
            index: OnceLock::new(),
            indexing: Mutex::new(()),
            fills: Vec::new(),
            revision: 0,
            undone: Vec::new(),
            layout: 0,
            token: Arc::new(()),
        }
    }

    /// Takes a closed polyline: a mesh of its points without a triangle, whose only loop is the polyline. It runs in
    /// its direction round the patch, counter-clockwise as seen from the side to which the patch's normals
    /// point.
    ///
    /// With `normals`, one per point and of any length, a strip of surface perpendicular to them is supposed
    /// outside the polyline, so that every method meets it as it would meet a mesh. Without them, or where a
    /// normal is zero or along the polyline, nothing is known outside: `flat` and `membrane` do what they always
    /// do, `fair-c1` and `fair-c2` give the patch of least energy through the rim with no tangent plane prescribed.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] for fewer than three points, a coordinate that is not finite, or another number
    /// of normals than of points.
    pub fn from_polyline(points: Vec<[f64; 3]>, normals: Option<&[[f64; 3]]>) -> Result<Self> {
        polyline::check(&points, normals)?;
        let normals = normals.map(|n| n.iter().map(|&n| Vec3::from(n)).collect());
        let session = Self::new(TriMesh::new(points, Vec::new())?);
        let loops = vec![BoundaryLoop::of_polyline(session.mesh.points())];
        let boundary = Boundary {
            loops: BoundaryLoops { loops },
            places: Vec::new(),
        };
        Ok(Self {
            polyline: Some(normals),
            boundary: OnceLock::from(boundary),
            ..session
        })
    }

    /// The mesh as it is.
    #[must_use]
    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// Gives the mesh back.
    #[must_use]
    pub fn into_mesh(self) -> TriMesh {
        self.mesh
    }

    /// Whether this is a polyline and no mesh.
    #[must_use]
    pub fn is_polyline(&self) -> bool {
        self.polyline.is_some()
    }

    /// Adds a column to the attributes of the vertices. Plans that were made before cannot be applied any more.
    ///
    /// # Errors
    /// As [`TriMesh::add_vertex_attribute`].
    pub fn add_vertex_attribute(&mut self, name: &str, values: AttributeValues) -> Result<()> {
        self.mesh.add_vertex_attribute(name, values)?;
        self.layout += 1;
        Ok(())
    }

    /// Adds a column to the attributes of the triangles. Plans that were made before cannot be applied any more.
    ///
    /// # Errors
    /// As [`TriMesh::add_face_attribute`].
    pub fn add_face_attribute(&mut self, name: &str, values: AttributeValues) -> Result<()> {
        self.mesh.add_face_attribute(name, values)?;
        self.layout += 1;
        Ok(())
    }

    /// All loops of the mesh before anything was filled.
    #[must_use]
    pub fn boundary(&self) -> &BoundaryLoops {
        &self.found_boundary().loops
    }

    /// Finds the loops and builds the index now, so that the next fill costs no more than its holes.
    pub fn prepare(&self) {
        self.found_boundary();
        // Nothing stops it, so there is nothing that can fail.
        let _ = self.index(&Job::unlimited());
    }

    /// Whether the loop `id` has not been closed.
    #[must_use]
    pub fn is_open(&self, id: usize) -> bool {
        if self.polyline.is_some() {
            return id == 0 && self.fills.is_empty();
        }
        let connectivity = self.mesh.connectivity();
        let is_open = |l: &BoundaryLoop| {
            l.halfedges
                .iter()
                .all(|&h| connectivity.twin(h) == BOUNDARY)
        };
        self.boundary().loops.get(id).is_some_and(is_open)
    }

    /// The loop through the directed boundary edge `[from, to]`, as it runs in its triangle; open or closed since.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] when there is none.
    ///
    /// # Complexity
    /// O(log b) in the boundary edges once the loops are found.
    pub fn loop_with_edge(&self, [from, to]: [u32; 2]) -> Result<usize> {
        if let Some(id) = self.find_edge(from, to) {
            return Ok(id);
        }
        let hint = match self.find_edge(to, from) {
            Some(_) => format!("; the boundary edge runs from {to} to {from}"),
            None => String::new(),
        };
        Err(invalid(format!(
            "no boundary edge runs from vertex {from} to vertex {to}{hint}"
        )))
    }

    /// The loops that together consist of the boundary edges of the closed chain `vertices`, ascending. The
    /// chain may start anywhere and run either way; where it visits a vertex twice it passes through more than one
    /// loop.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] when two vertices in succession are not joined by a boundary edge, an edge comes
    /// twice, or the edges are not all those of the loops that they are on.
    pub fn loops_with_vertices(&self, vertices: &[u32]) -> Result<Vec<usize>> {
        if vertices.len() < 2 {
            return Err(invalid(format!("{} vertices are no loop", vertices.len())));
        }
        let mut edges = Vec::with_capacity(vertices.len());
        for (i, &from) in vertices.iter().enumerate() {
            let to = vertices[(i + 1) % vertices.len()];
            let id = self
                .find_edge(from, to)
                .or_else(|| self.find_edge(to, from))
                .ok_or_else(|| {
                    invalid(format!("no boundary edge joins vertices {from} and {to}"))
                })?;
            edges.push((id, from.min(to), from.max(to)));
        }
        edges.sort_unstable();
        if let Some(w) = edges.windows(2).find(|w| w[0] == w[1]) {
            let (_, a, b) = w[0];
            return Err(invalid(format!(
                "the edge between vertices {a} and {b} comes twice"
            )));
        }
        let mut ids = Vec::new();
        for same in edges.chunk_by(|e, f| e.0 == f.0) {
            let id = same[0].0;
            let whole = self.boundary().loops[id].edge_count();
            if same.len() != whole {
                return Err(invalid(format!(
                    "the vertices pass {} of the {whole} edges of loop {id}",
                    same.len()
                )));
            }
            ids.push(id);
        }
        Ok(ids)
    }

    /// Makes patches and changes nothing.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] when the target names a loop that does not exist, is closed or cannot be
    /// filled, or an option is out of its range; [`ErrorKind::Limit`] when the threads cannot be started;
    /// [`ErrorKind::Cancelled`] when `progress` said so.
    ///
    /// # Complexity
    /// That of the holes, about `k^1.5` for `k` new vertices, once the session is prepared; the target
    /// [`Target::Selected`] looks at every loop besides.
    pub fn plan(
        &self,
        target: Target<'_>,
        options: &FillOptions,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<FillPlan> {
        let mut watch = Watch::new(0, options.time_budget, progress);
        self.plan_watched(target, options, &mut watch)
    }

    fn plan_watched(
        &self,
        target: Target<'_>,
        options: &FillOptions,
        watch: &mut Watch<'_>,
    ) -> Result<FillPlan> {
        options.check()?;
        check_attribute_names(&self.mesh, options)?;
        let (blank, holes) = self.holes(target, options)?;
        watch.expect(holes.len());
        let mut plan = FillPlan {
            token: Arc::clone(&self.token),
            options: options.clone(),
            revision: self.revision,
            layout: self.layout,
            vertex_count: self.mesh.positions().len(),
            triangle_count: self.mesh.triangles().len(),
            holes: Vec::new(),
            blank,
            report: FillReport::default(),
        };
        if !holes.is_empty() {
            let pool = thread_pool(options)?;
            let start = Instant::now();
            let is_indexed = self.index.get().is_some();
            let index = pool.install(|| self.index(&Job::new(watch)));
            if !is_indexed {
                plan.report.index_seconds = start.elapsed().as_secs_f64();
            }
            let start = Instant::now();
            let work = Work {
                options,
                pool: &pool,
                watch,
            };
            let planned = match (index, &self.polyline) {
                (Err(error), _) => {
                    let failure = PlanFailure::from(watch.explain(error));
                    vec![(Err(failure), 0.0); holes.len()]
                }
                (Ok(index), None) => work.plan(&self.mesh, index, &self.boundary().loops, &holes),
                (Ok(index), Some(normals)) => {
                    work.plan_by(&self.mesh, index, &holes, |planner, _| {
                        let hole = Hole::of_polyline(self.mesh.points(), normals.as_deref())?;
                        planner.plan_hole(hole, &chain(options))
                    })
                }
            };
            if watch.is_cancelled() {
                return Err(Error::cancelled());
            }
            plan.report.fill_seconds = start.elapsed().as_secs_f64();
            plan.take(&holes, planned);
        }
        plan.describe(&self.boundary().loops);
        Ok(plan)
    }

    /// Appends the patches of a plan, in the order of the loops. A patch that no longer fits, because it collides with
    /// another one or with what was filled since it was planned, is made anew.
    ///
    /// The report is as that of [`crate::fill_holes`]; it has an entry for each loop that the plan's target
    /// lists.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidInput`] when the plan is not of this session, or the mesh that it was made for was changed by
    /// an undo or by new attributes; [`ErrorKind::Cancelled`] when `progress` said so. Nothing changes then.
    pub fn apply(
        &mut self,
        plan: &FillPlan,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<FillReport> {
        let watch = Watch::new(plan.holes.len(), plan.options.time_budget, progress);
        self.apply_watched(plan, &watch)
    }

    fn apply_watched(&mut self, plan: &FillPlan, watch: &Watch<'_>) -> Result<FillReport> {
        self.check_plan(plan)?;
        let mut report = FillReport {
            holes: plan.blank.clone(),
            index_seconds: plan.report.index_seconds,
            fill_seconds: 0.0,
        };
        if plan.holes.is_empty() {
            return Ok(report);
        }
        let start = Instant::now();
        let pool = thread_pool(&plan.options)?;
        let before = [self.mesh.positions().len(), self.mesh.triangles().len()];
        // A plan whose time ran out may have left no index; it has no patches to check either.
        let (Some(boundary), Some(index)) = (self.boundary.get(), self.index.get()) else {
            report.holes.clone_from(&plan.report.holes);
            return Ok(report);
        };
        let loops = &boundary.loops.loops;
        let holes: Vec<HoleLoops<'_>> = plan
            .holes
            .iter()
            .map(|hole| HoleLoops {
                outer: &loops[hole.outer],
                islands: hole.islands.iter().map(|&i| &loops[i]).collect(),
            })
            .collect();
        let work = Work {
            options: &plan.options,
            pool: &pool,
            watch,
        };
        let planned = plan.holes.iter().map(|h| h.planned.clone()).collect();
        work.stitch(
            &mut self.mesh,
            index,
            plan.triangle_count,
            &holes,
            planned,
            &mut report.holes,
        );
        if watch.is_cancelled() {
            self.mesh.truncate(before[0], before[1]);
            return Err(Error::cancelled());
        }
        if let Some(index) = self.index.get_mut() {
            pool.install(|| index.update(&self.mesh));
        }
        if self.mesh.triangles().len() > before[1] {
            self.fills.push(before);
            self.revision += 1;
        }
        report.fill_seconds = plan.report.fill_seconds + start.elapsed().as_secs_f64();
        Ok(report)
    }

    /// Plans and applies. When `progress` stops it, nothing has changed, whatever was finished.
    ///
    /// # Errors
    /// As [`FillSession::plan`].
    pub fn fill(
        &mut self,
        target: Target<'_>,
        options: &FillOptions,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<FillReport> {
        let mut watch = Watch::new(0, options.time_budget, progress);
        let plan = self.plan_watched(target, options, &mut watch)?;
        self.apply_watched(&plan, &watch)
    }

    /// How many fills can be undone: those that appended something.
    #[must_use]
    pub fn undo_count(&self) -> usize {
        self.fills.len()
    }

    /// Takes the last fill back that appended something: its vertices, triangles and attribute values are removed, and
    /// the loops that it closed are open again. Returns whether there was one.
    ///
    /// Cost follows what is removed.
    pub fn undo(&mut self) -> bool {
        let Some([vertices, triangles]) = self.fills.pop() else {
            return false;
        };
        self.mesh.truncate(vertices, triangles);
        if let Some(index) = self.index.get_mut() {
            index.update(&self.mesh);
        }
        self.revision += 1;
        self.undone.retain(|&(_, count)| count < triangles);
        self.undone.push((self.revision, triangles));
        true
    }

    fn found_boundary(&self) -> &Boundary {
        self.boundary.get_or_init(|| {
            let loops = BoundaryLoops::find(&self.mesh);
            let mut places: Vec<(u32, usize)> = loops
                .loops
                .iter()
                .flat_map(|l| l.halfedges.iter().map(|&h| (h, l.id)))
                .collect();
            places.sort_unstable();
            Boundary { loops, places }
        })
    }

    /// The index, built if it is not there yet. One thread builds it, and others that need it wait.
    fn index(&self, job: &Job<'_>) -> Result<&MeshIndex> {
        loop {
            if let Some(index) = self.index.get() {
                return Ok(index);
            }
            job.ask()?;
            match self.indexing.try_lock() {
                // Another thread may have been done just before the lock was free.
                Ok(_guard) if self.index.get().is_none() => {
                    let index = MeshIndex::build(&self.mesh, job)?;
                    return Ok(self.index.get_or_init(|| index));
                }
                Err(TryLockError::Poisoned(_)) => self.indexing.clear_poison(),
                _ => std::thread::sleep(WAIT),
            }
        }
    }

    fn find_edge(&self, from: u32, to: u32) -> Option<usize> {
        let boundary = self.found_boundary();
        if self.polyline.is_some() {
            let n = boundary.loops.loops[0].edge_count();
            let is_edge = (from as usize) < n && (from as usize + 1) % n == to as usize;
            return is_edge.then_some(0);
        }
        self.mesh
            .connectivity()
            .outgoing(from)
            .filter(|o| o.target == to)
            .find_map(|o| {
                let place = boundary.places.binary_search_by_key(&o.halfedge, |p| p.0);
                Some(boundary.places[place.ok()?].1)
            })
    }

    /// Empty reports for the loops of the target, and the holes to fill.
    fn holes(
        &self,
        target: Target<'_>,
        options: &FillOptions,
    ) -> Result<(Vec<HoleReport>, Vec<HoleLoops<'_>>)> {
        let boundary = self.boundary();
        match target {
            Target::Selected(selection) => {
                let mut kept = selection.reasons_to_keep(boundary)?;
                for (id, kept) in kept.iter_mut().enumerate() {
                    if kept.is_none() && !self.is_open(id) {
                        *kept = Some("closed by an earlier fill".to_owned());
                    }
                }
                let loops = boundary.loops.iter().zip(&kept);
                let blank = loops.map(|(l, k)| blank_report(l, k)).collect();
                let ids: Vec<usize> = (0..boundary.loops.len())
                    .filter(|&id| kept[id].is_none())
                    .collect();
                Ok((blank, group_holes(boundary, &ids, options)))
            }
            Target::Loops(ids) => {
                let mut ids = ids.to_vec();
                ids.sort_unstable();
                ids.dedup();
                for &id in &ids {
                    self.check_loop(id)?;
                }
                let blank = ids
                    .iter()
                    .map(|&id| blank_report(&boundary.loops[id], &None));
                Ok((blank.collect(), group_holes(boundary, &ids, options)))
            }
        }
    }

    fn check_loop(&self, id: usize) -> Result<()> {
        let loops = &self.boundary().loops;
        let Some(l) = loops.get(id) else {
            return Err(invalid(format!(
                "there is no loop {id} among {}",
                loops.len()
            )));
        };
        if !self.is_open(id) {
            return Err(invalid(format!("loop {id} was closed by an earlier fill")));
        }
        match unfillable_reason(l.class) {
            Some(reason) => Err(Error::new(
                ErrorKind::Topology,
                format!("loop {id} cannot be filled: {reason}"),
            )),
            None => Ok(()),
        }
    }

    fn check_plan(&self, plan: &FillPlan) -> Result<()> {
        if !Arc::ptr_eq(&self.token, &plan.token) {
            return Err(invalid("the plan was made for another mesh".to_owned()));
        }
        if self.layout != plan.layout {
            return Err(invalid(
                "the plan was made before attributes were added".to_owned(),
            ));
        }
        let undoes = |&(revision, count): &(u64, usize)| {
            revision > plan.revision && count < plan.triangle_count
        };
        let is_refilled = self.is_polyline() && !self.fills.is_empty();
        if self.undone.iter().any(undoes) {
            return Err(invalid(
                "what the plan was made for was undone since".to_owned(),
            ));
        }
        if is_refilled {
            return Err(invalid(
                "the polyline was closed by an earlier fill".to_owned(),
            ));
        }
        Ok(())
    }
}

impl FillPlan {
    /// What each loop would get: ranges are those of the plan's own numbering, in which the patches follow each
    /// other. Status [`HoleStatus::Filled`](crate::HoleStatus::Filled) says that there is a patch.
    #[must_use]
    pub fn report(&self) -> &FillReport {
        &self.report
    }

    /// Number of vertices of the mesh when the plan was made: the first new vertex has this index.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The patch for the loop `id`; `None` where there is none, and for an island, which belongs to the patch round it.
    #[must_use]
    pub fn patch(&self, id: usize) -> Option<PlannedPatch> {
        let hole = self.holes.iter().find(|hole| hole.outer == id)?;
        let plan = hole.planned.0.as_ref().ok()?;
        Some(PlannedPatch {
            loop_id: id,
            first_vertex: hole.vertices.start,
            vertices: plan.points.iter().map(|&p| p.into()).collect(),
            triangles: plan.triangles(hole.vertices.start),
        })
    }

    fn take(&mut self, holes: &[HoleLoops<'_>], planned: Vec<Planned>) {
        let mut end = self.vertex_count;
        for (hole, planned) in holes.iter().zip(planned) {
            let start = end;
            end += planned
                .0
                .as_ref()
                .map_or(0, |plan: &Plan| plan.points.len());
            self.holes.push(PlannedHole {
                outer: hole.outer.id,
                islands: hole.islands.iter().map(|l| l.id).collect(),
                planned,
                vertices: start..end,
            });
        }
    }

    fn describe(&mut self, loops: &[BoundaryLoop]) {
        self.report.holes.clone_from(&self.blank);
        let mut triangles = self.triangle_count;
        for hole in &self.holes {
            let (planned, seconds) = &hole.planned;
            let outcome = match planned {
                Ok(plan) => Outcome::planned(plan, hole.vertices.start, triangles),
                Err(failure) => Outcome::failed(failure.error.clone(), failure.tried.clone()),
            };
            triangles += planned.as_ref().map_or(0, |plan| plan.triangle_count());
            let loops = HoleLoops {
                outer: &loops[hole.outer],
                islands: hole.islands.iter().map(|&i| &loops[i]).collect(),
            };
            outcome.record_all(&loops, *seconds, &mut self.report.holes);
        }
    }
}

fn invalid(message: String) -> Error {
    Error::new(ErrorKind::InvalidInput, message)
}
