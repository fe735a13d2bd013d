//! Code that the programs share which repeat the experiments of the papers.

// Each program uses only a part of it.
#![allow(dead_code)]

pub(crate) mod cap;
pub(crate) mod plot;

use holefill::io::{self, MeshData};
use holefill::{
    BoundaryLoops, FillOptions, FillReport, Method, Selection, TriMesh, deviation, fill_holes,
};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Runs of each time measurement; the fastest counts.
pub(crate) const RUNS: usize = 5;

pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// The folders of the models and of the results, from the command line.
pub(crate) fn folders() -> Result<(PathBuf, PathBuf)> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let models = arguments.next().ok_or("which folder are the models in?")?;
    let results = arguments.next().unwrap_or_else(|| "docs/results".into());
    Ok((models, results))
}

/// The command that runs the program `name`, with the profile that it was built with.
pub(crate) fn command(name: &str) -> String {
    let profile = match cfg!(debug_assertions) {
        true => "",
        false => "--release ",
    };
    format!(
        "`cargo run {profile}--example {name} -- FOLDER docs/results` on a machine with other work"
    )
}

/// A model with holes.
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) mesh: TriMesh,
    /// Selection that leaves loops open which are not holes.
    pub(crate) selection: Selection,
    pub(crate) holes: usize,
    /// The removed triangles, without noise.
    truth: Option<MeshData>,
    meta: serde_json::Value,
}

impl Case {
    /// Reads `input.ply`, `meta.json`, and `truth_clean.ply` or `truth.ply`, from the model's folder.
    pub(crate) fn read(models: &Path, name: &str) -> Result<Self> {
        let folder = models.join(name);
        let data = io::read(folder.join("input.ply"))?;
        let mesh = TriMesh::with_attributes(
            data.positions,
            data.triangles,
            data.vertex_attributes,
            data.face_attributes,
        )?;
        let text = std::fs::read_to_string(folder.join("meta.json"))?;
        let meta: serde_json::Value = serde_json::from_str(&text)?;
        let vertex = |v: &serde_json::Value| v.as_u64().and_then(|v| u32::try_from(v).ok());
        let keep = meta["keep_loops"].as_array().into_iter().flatten();
        let selection = Selection {
            keep: keep
                .filter_map(|l| Some([vertex(&l["edge"][0])?, vertex(&l["edge"][1])?]))
                .collect(),
            ..Selection::default()
        };
        let truth = ["truth_clean.ply", "truth.ply"].map(|file| folder.join(file));
        let truth = truth.iter().find(|file| file.is_file());
        Ok(Self {
            name: name.to_owned(),
            mesh,
            selection,
            holes: meta["fill_loops"].as_array().map_or(0, Vec::len),
            truth: truth.map(io::read).transpose()?,
            meta,
        })
    }

    /// Description and origin of the model.
    pub(crate) fn description(&self) -> &str {
        self.meta["description"].as_str().unwrap_or("")
    }

    /// Number of removed triangles.
    pub(crate) fn removed(&self) -> String {
        let removed = self.meta["removed_triangles"].as_u64();
        removed.map_or("–".to_owned(), |n| n.to_string())
    }

    /// Fills the holes once.
    pub(crate) fn fill(&self, options: &FillOptions) -> Result<Filled> {
        fill(&self.mesh, &self.selection, options, 1)
    }

    /// Fills the holes [`RUNS`] times, to measure the time.
    pub(crate) fn time(&self, options: &FillOptions) -> Result<Filled> {
        fill(&self.mesh, &self.selection, options, RUNS)
    }

    /// APE and MPE of eq. 17 of Xie and Zou, `None` without truth.
    pub(crate) fn errors(&self, filled: &Filled) -> Result<Option<deviation::PointErrors>> {
        let Some(truth) = &self.truth else {
            return Ok(None);
        };
        // So that vertices of the input do not count as new.
        let mut known = truth.positions.clone();
        known.extend(self.mesh.positions());
        let new = &filled.mesh.triangles()[self.mesh.triangles().len()..];
        let found = deviation::compare(filled.mesh.positions(), new, &known, &truth.triangles)?;
        Ok(found.point_errors)
    }
}

/// A mesh whose holes were filled.
pub(crate) struct Filled {
    pub(crate) report: FillReport,
    pub(crate) mesh: TriMesh,
    /// New vertices.
    pub(crate) points: usize,
    /// Least processor time of a fill.
    pub(crate) seconds: f64,
}

impl Filled {
    /// Holes that the method itself filled, not one of its fallbacks.
    pub(crate) fn by(&self, method: Method) -> usize {
        let holes = self.report.holes.iter();
        holes.filter(|h| h.method == Some(method)).count()
    }

    pub(crate) fn intersections(&self) -> usize {
        let holes = self.report.holes.iter();
        holes.map(|h| h.self_intersections).sum()
    }
}

/// Fills a mesh `runs` times, and keeps the last result and the least time.
pub(crate) fn fill(
    mesh: &TriMesh,
    selection: &Selection,
    options: &FillOptions,
    runs: usize,
) -> Result<Filled> {
    let boundary = BoundaryLoops::find(mesh);
    let run = || -> Result<Filled> {
        let mut filled = mesh.clone();
        let start = processor_time();
        let report = fill_holes(&mut filled, &boundary, selection, options, None)?;
        Ok(Filled {
            report,
            seconds: (processor_time() - start).as_secs_f64(),
            points: filled.positions().len() - mesh.positions().len(),
            mesh: filled,
        })
    };
    let mut last = run()?;
    for _ in 1..runs {
        let seconds = last.seconds;
        last = run()?;
        last.seconds = last.seconds.min(seconds);
    }
    Ok(last)
}

/// Options of `method` on one thread, with parameters.
pub(crate) fn options(method: Method, parameters: &[(&str, &str)]) -> Result<FillOptions> {
    let mut options = FillOptions::default();
    options.method = method;
    options.threads = 1;
    for (name, value) in parameters {
        options.set(name, value)?;
    }
    Ok(options)
}

/// Least processor time in seconds of [`RUNS`] runs of `work`.
pub(crate) fn least_seconds<T>(mut work: impl FnMut() -> Result<T>) -> Result<f64> {
    let mut least = f64::INFINITY;
    for _ in 0..RUNS {
        let start = processor_time();
        work()?;
        least = least.min((processor_time() - start).as_secs_f64());
    }
    Ok(least)
}

/// Processor time of this process. Other work on the machine has little influence.
#[cfg(unix)]
pub(crate) fn processor_time() -> Duration {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ProcessCPUTime);
    let seconds = u64::try_from(time.tv_sec).unwrap_or(0);
    Duration::from_secs(seconds) + Duration::from_nanos(u64::try_from(time.tv_nsec).unwrap_or(0))
}

/// Time since the first call, where processor time is not available.
#[cfg(not(unix))]
pub(crate) fn processor_time() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}
