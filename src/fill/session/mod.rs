//! A mesh whose holes are filled one by one: what costs a pass over the mesh is done once and kept.
//!
//! [`plan`](FillSession::plan) makes patches on the unchanged mesh, [`apply`](FillSession::apply) appends them.
//! Everything that fills holes goes this way.

pub(crate) mod at_once;
mod found;
mod history;
mod lookup;
mod plan;

pub use plan::{FillPlan, PlannedPatch};

use super::index::MeshIndex;
use super::patch::PatchFailure;
use super::plan::Planner;
use super::polyline::Polyline;
use super::progress::{ProgressCallback, Watch};
use super::report::FillReport;
use super::stitch::stitch_all;
use crate::boundary::boundary_loop::BoundaryLoop;
use crate::boundary::loops::BoundaryLoops;
use crate::boundary::select::Selection;
use crate::error::{Error, Result};
use crate::job::Job;
use crate::mesh::attributes::AttributeValues;
use crate::mesh::trimesh::TriMesh;
use crate::options::{FillOptions, FilledAttributes};
use found::FoundLoops;
use history::History;
use std::sync::{Mutex, OnceLock, TryLockError};
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
    polyline: Option<Polyline>,
    boundary: OnceLock<FoundLoops>,
    index: OnceLock<MeshIndex>,
    /// Held while the index is built.
    indexing: Mutex<()>,
    history: History,
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
            history: History::default(),
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
    /// [`crate::ErrorKind::InvalidInput`] for fewer than three points, a coordinate that is not finite, or another number
    /// of normals than of points.
    pub fn from_polyline(points: Vec<[f64; 3]>, normals: Option<&[[f64; 3]]>) -> Result<Self> {
        let polyline = Polyline::new(&points, normals)?;
        let mesh = TriMesh::new(points, Vec::new())?;
        let loops = vec![BoundaryLoop::of_polyline(mesh.points())];
        Ok(Self {
            polyline: Some(polyline),
            ..Self::with_boundary(mesh, BoundaryLoops { loops })
        })
    }

    /// Takes a mesh and its loops.
    fn with_boundary(mesh: TriMesh, boundary: BoundaryLoops) -> Self {
        Self {
            boundary: OnceLock::from(FoundLoops::new(boundary)),
            ..Self::new(mesh)
        }
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
        self.history.layout_changed();
        Ok(())
    }

    /// Adds a column to the attributes of the triangles. Plans that were made before cannot be applied any more.
    ///
    /// # Errors
    /// As [`TriMesh::add_face_attribute`].
    pub fn add_face_attribute(&mut self, name: &str, values: AttributeValues) -> Result<()> {
        self.mesh.add_face_attribute(name, values)?;
        self.history.layout_changed();
        Ok(())
    }

    /// All loops of the mesh before anything was filled.
    #[must_use]
    pub fn boundary(&self) -> &BoundaryLoops {
        &self.found_loops().all
    }

    /// Finds the loops and builds the index now, so that the next fill costs no more than its holes.
    pub fn prepare(&self) {
        self.found_loops().places();
        // Nothing stops it, so there is nothing that can fail.
        let _ = self.index(&Job::unlimited());
    }

    /// Makes patches and changes nothing.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when the target names a loop that does not exist, is closed or cannot be
    /// filled, or an option is out of its range; [`crate::ErrorKind::Limit`] when the threads cannot be started;
    /// [`crate::ErrorKind::Cancelled`] when `progress` said so.
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
        let plan = self.plan_watched(target, options, &mut watch)?;
        watch.refuse_cancelled()?;
        Ok(plan)
    }

    /// As [`plan`](Self::plan), but holes at which it was cancelled only say so in the report.
    fn plan_watched(
        &self,
        target: Target<'_>,
        options: &FillOptions,
        watch: &mut Watch<'_>,
    ) -> Result<FillPlan> {
        options.check()?;
        check_attribute_names(&self.mesh, options)?;
        let (holes, openings) = self.openings(target, options)?;
        watch.expect(openings.len());
        let mut plan = FillPlan {
            stamp: self.history.stamp(self.size()),
            options: options.clone(),
            openings: Vec::with_capacity(openings.len()),
            report: FillReport {
                holes,
                ..FillReport::default()
            },
        };
        if openings.is_empty() {
            return Ok(plan);
        }
        let pool = thread_pool(options)?;
        let start = Instant::now();
        let is_indexed = self.index.get().is_some();
        let index = pool.install(|| self.index(&Job::new(watch)));
        if !is_indexed {
            plan.report.index_seconds = start.elapsed().as_secs_f64();
        }
        let start = Instant::now();
        let outcomes = match index {
            Ok(index) => {
                let planner = Planner {
                    loops: &self.boundary().loops,
                    index,
                    polyline: self.polyline.as_ref(),
                    options,
                };
                planner.plan_all(&self.mesh, &openings, &pool, watch)
            }
            Err(error) => {
                let failure = PatchFailure::from(watch.explain(error));
                vec![(Err(failure), 0.0); openings.len()]
            }
        };
        plan.report.fill_seconds = start.elapsed().as_secs_f64();
        let planned = openings.into_iter().zip(outcomes);
        plan.take(planned.map(|(opening, (outcome, seconds))| (opening, outcome, seconds)));
        Ok(plan)
    }

    /// Appends the patches of a plan, in the order of the loops. A patch that no longer fits, because it collides with
    /// another one or with what was filled since it was planned, is made anew.
    ///
    /// The report is as that of [`crate::fill_holes`]; it has an entry for each loop that the plan's target
    /// lists.
    ///
    /// # Errors
    /// [`crate::ErrorKind::InvalidInput`] when the plan is not of this session, or the mesh that it was made for was changed by
    /// an undo or by new attributes; [`crate::ErrorKind::Cancelled`] when `progress` said so. Nothing changes then.
    pub fn apply(
        &mut self,
        plan: &FillPlan,
        progress: Option<ProgressCallback<'_>>,
    ) -> Result<FillReport> {
        let watch = Watch::new(plan.openings.len(), plan.options.time_budget, progress);
        self.apply_watched(plan.clone(), &watch)
    }

    fn apply_watched(&mut self, plan: FillPlan, watch: &Watch<'_>) -> Result<FillReport> {
        self.history.check(&plan.stamp)?;
        if self.is_polyline() && self.undo_count() > 0 {
            let message = "the polyline was closed by an earlier fill";
            return Err(Error::invalid(message));
        }
        if plan.openings.is_empty() {
            return Ok(plan.report);
        }
        let pool = thread_pool(&plan.options)?;
        let before = self.size();
        let mut report = self.stitch(plan, watch);
        if let Err(cancelled) = watch.refuse_cancelled() {
            self.mesh.truncate(before[0], before[1]);
            return Err(cancelled);
        }
        let start = Instant::now();
        if let Some(index) = self.index.get_mut() {
            pool.install(|| index.update(&self.mesh));
        }
        if self.size()[1] > before[1] {
            self.history.filled(before);
        }
        report.fill_seconds += start.elapsed().as_secs_f64();
        Ok(report)
    }

    /// Appends the patches of a plan of this session, and leaves the index as it is.
    fn stitch(&mut self, plan: FillPlan, watch: &Watch<'_>) -> FillReport {
        let mut report = plan.report;
        // A plan whose time ran out may have left no index; it has no patches to check either.
        let (Some(found), Some(index)) = (self.boundary.get(), self.index.get()) else {
            return report;
        };
        let start = Instant::now();
        let planner = Planner {
            loops: &found.all.loops,
            index,
            polyline: self.polyline.as_ref(),
            options: &plan.options,
        };
        let planned_at = plan.stamp.size[1];
        let reports = &mut report.holes;
        stitch_all(
            &mut self.mesh,
            &planner,
            plan.openings,
            planned_at,
            watch,
            reports,
        );
        report.fill_seconds += start.elapsed().as_secs_f64();
        report
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
        watch.refuse_cancelled()?;
        self.apply_watched(plan, &watch)
    }

    /// How many fills can be undone: those that appended something.
    #[must_use]
    pub fn undo_count(&self) -> usize {
        self.history.undo_count()
    }

    /// Takes the last fill back that appended something: its vertices, triangles and attribute values are removed, and
    /// the loops that it closed are open again. Returns whether there was one.
    ///
    /// Cost follows what is removed.
    pub fn undo(&mut self) -> bool {
        let Some([vertices, triangles]) = self.history.undo() else {
            return false;
        };
        self.mesh.truncate(vertices, triangles);
        if let Some(index) = self.index.get_mut() {
            index.update(&self.mesh);
        }
        true
    }

    fn found_loops(&self) -> &FoundLoops {
        let find = || FoundLoops::new(BoundaryLoops::find(&self.mesh));
        self.boundary.get_or_init(find)
    }

    /// Numbers of vertices and triangles.
    fn size(&self) -> [usize; 2] {
        [self.mesh.positions().len(), self.mesh.triangles().len()]
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
}

/// The threads that `options` asks for.
///
/// # Errors
/// [`crate::ErrorKind::Limit`] when they cannot be started.
pub(crate) fn thread_pool(options: &FillOptions) -> Result<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| Error::limit(format!("cannot start {} threads: {e}", options.threads)))
}

/// Fails when an option names an attribute that the mesh does not have.
fn check_attribute_names(mesh: &TriMesh, options: &FillOptions) -> Result<()> {
    let FilledAttributes::Only(names) = &options.attributes.filled else {
        return Ok(());
    };
    let attributes = mesh.vertex_attributes();
    match names.iter().find(|name| attributes.get(name).is_none()) {
        None => Ok(()),
        Some(name) => {
            let known: Vec<&str> = attributes.iter().map(|a| a.name.as_str()).collect();
            Err(Error::invalid(format!(
                "there is no vertex attribute '{name}' to fill; there are: {}",
                known.join(", ")
            )))
        }
    }
}
