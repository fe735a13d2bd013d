//! Runs both programs on every case and input, one process at a time, in turns.

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use crate::job::{Job, jobs, read_json};
use crate::judge::{self, Score};
use crate::{Result, process};

/// A fill that takes longer than this runs only once, because its relative spread is small.
const LONG_FILL_SECONDS: f64 = 1.0;
/// Clock time over processor time above which other work on the machine is reported.
const BUSY_RATIO: f64 = 1.25;
/// Below this many seconds the two clocks are not compared.
const BUSY_MIN_SECONDS: f64 = 0.02;
/// Time for everything except the fill (reading, building, writing), before a program is stopped.
const OVERHEAD: Duration = Duration::from_secs(120);
/// CGAL's program checks the limit itself, by processor time. We stop it only if the clock time exceeds
/// the limit by this factor.
const CGAL_CLOCK_FACTOR: f64 = 4.0;
/// Largest rim for the exact search: the size of the input that is made for it.
const EXACT_LIMIT: &str = "flat.exact-limit=400";
/// The input whose connectivity is timed.
const BUILD_INPUT: &str = "hole_in_4m";

/// The settings of a run; see the help of the command line.
pub(crate) struct Settings {
    pub(crate) cases: Option<PathBuf>,
    pub(crate) inputs: Option<PathBuf>,
    pub(crate) cgal: PathBuf,
    pub(crate) holefill: PathBuf,
    pub(crate) out: PathBuf,
    pub(crate) scorer: Option<String>,
    pub(crate) only: Option<String>,
    pub(crate) repeats: usize,
    pub(crate) limit_seconds: f64,
}

/// The task of both programs.
#[derive(Clone, Copy, PartialEq)]
enum Task {
    FairC1,
    FairC2,
    /// The minimum-weight triangulation by the full dynamic program.
    Exact,
}

impl Task {
    fn name(self) -> &'static str {
        match self {
            Self::FairC1 => "fair-c1",
            Self::FairC2 => "fair-c2",
            Self::Exact => "exact",
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Program {
    Holefill,
    Cgal,
}

impl Program {
    fn name(self) -> &'static str {
        match self {
            Self::Holefill => "holefill",
            Self::Cgal => "cgal",
        }
    }
}

/// Time, memory and result of one program.
#[derive(Clone, Debug, Default)]
pub(crate) struct Run {
    /// Median time of the fill alone; the time limit if it was reached.
    pub(crate) seconds: Option<f64>,
    /// The program was stopped at the limit.
    pub(crate) limited: bool,
    pub(crate) peak_megabytes: Option<f64>,
    /// The program had to wait for the processor, so clock times are too long.
    pub(crate) disturbed: bool,
    /// Why there is no result, or only a part of it.
    pub(crate) problem: Option<String>,
    pub(crate) score: Score,
}

/// Both programs on the same task.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pair {
    pub(crate) ours: Run,
    pub(crate) cgal: Run,
}

impl Pair {
    /// Our time over CGAL's; an upper bound where CGAL was stopped. `None` where a time is missing
    /// or our result is incomplete.
    pub(crate) fn time_ratio(&self) -> Option<f64> {
        if self.ours.limited || self.ours.problem.is_some() {
            return None;
        }
        Some(self.ours.seconds? / self.cgal.seconds?)
    }
}

/// A case at both continuities.
#[derive(Clone, Debug, Default)]
pub(crate) struct CaseRow {
    pub(crate) name: String,
    /// Edges of the rims to fill.
    pub(crate) edges: u64,
    pub(crate) has_truth: bool,
    pub(crate) c1: Pair,
    pub(crate) c2: Pair,
}

/// One of the large inputs.
#[derive(Clone, Debug, Default)]
pub(crate) struct InputRow {
    pub(crate) name: String,
    pub(crate) task: &'static str,
    pub(crate) pair: Pair,
}

/// Seconds to build the connectivity of the 4,000,000-triangle mesh; ours include the list of loops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BuildRow {
    pub(crate) ours: f64,
    pub(crate) cgal: f64,
}

/// Everything measured.
#[derive(Clone, Debug, Default)]
pub(crate) struct Results {
    pub(crate) cases: Vec<CaseRow>,
    pub(crate) inputs: Vec<InputRow>,
    pub(crate) build: Option<BuildRow>,
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    (n > 0).then(|| (values[(n - 1) / 2] + values[n / 2]) / 2.0)
}

impl Settings {
    fn file(&self, job: &Job, task: Task, program: Program) -> PathBuf {
        self.out
            .join(format!("{}.{}.{}", job.name, task.name(), program.name()))
    }

    fn command(&self, job: &Job, task: Task, program: Program) -> Vec<String> {
        let file = self.file(job, task, program);
        let output = process::beside(&file, "ply").display().to_string();
        let report = process::beside(&file, "json").display().to_string();
        let words: Vec<String> = match program {
            Program::Holefill => {
                let holefill = self.holefill.display().to_string();
                let mut words = vec![holefill, "fill".into(), job.input(), "-o".into(), output];
                let method = if task == Task::Exact {
                    "flat"
                } else {
                    task.name()
                };
                words.extend(["--method", method, "--threads", "1", "--quiet"].map(str::to_owned));
                if task == Task::Exact {
                    words.extend(["--set", EXACT_LIMIT].map(str::to_owned));
                }
                words.extend(["--report".into(), report]);
                words
            }
            Program::Cgal => {
                let mut words = vec![self.cgal.display().to_string(), job.input(), output];
                let arguments = match task {
                    Task::FairC1 => ["--continuity", "1"],
                    Task::FairC2 => ["--continuity", "2"],
                    Task::Exact => ["--method", "cubic"],
                };
                words.extend(arguments.map(str::to_owned));
                words.extend(["--limit-seconds".into(), self.limit_seconds.to_string()]);
                words.extend(["--json".into(), report]);
                words
            }
        };
        words.into_iter().chain(job.keep_args()).collect()
    }

    fn once(&self, job: &Job, task: Task, program: Program) -> Result<Run> {
        let file = self.file(job, task, program);
        let report = process::beside(&file, "json");
        for extension in ["json", "ply"] {
            match fs::remove_file(process::beside(&file, extension)) {
                Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(e.into()),
                _ => {}
            }
        }
        let factor = if program == Program::Cgal {
            CGAL_CLOCK_FACTOR
        } else {
            1.0
        };
        let limit = Duration::from_secs_f64(factor * self.limit_seconds) + OVERHEAD;
        let outcome = process::run(&self.command(job, task, program), &file, limit)?;
        let mut run = Run {
            peak_megabytes: outcome.peak_kilobytes.map(|kb| kb as f64 / 1024.0),
            ..Run::default()
        };
        let json = report.exists().then(|| read_json(&report)).transpose()?;
        let stopped = json.as_ref().is_some_and(|json| json["status"] == "limit");
        if outcome.timed_out || stopped {
            run.limited = true;
            run.seconds = Some(self.limit_seconds);
            run.problem = Some(format!("stopped after {} s", self.limit_seconds));
            return Ok(run);
        }
        let Some(json) = json.filter(|_| matches!(outcome.code, Some(0 | 3))) else {
            let status = outcome
                .code
                .map_or("a signal".into(), |code| format!("status {code}"));
            run.problem = Some(format!("ended by {status}"));
            return Ok(run);
        };
        run.seconds = match program {
            Program::Holefill => json["seconds"]["fill"].as_f64(),
            Program::Cgal => json["seconds"]["fill"]["cpu"].as_f64(),
        };
        if program == Program::Cgal {
            let wall = json["seconds"]["fill"]["wall"].as_f64();
            run.disturbed = run
                .seconds
                .zip(wall)
                .is_some_and(|(cpu, wall)| wall > BUSY_MIN_SECONDS && wall > BUSY_RATIO * cpu);
        }
        let holes = json["holes"].as_array().map_or(&[][..], Vec::as_slice);
        let failed = holes
            .iter()
            .filter(|hole| hole["status"] == "failed")
            .count();
        if failed > 0 {
            run.problem = Some(format!("{failed} of {} holes failed", holes.len()));
        }
        Ok(run)
    }

    /// Runs both programs in turns, and takes the median time of each.
    fn pair(&self, job: &Job, task: Task, repeats: usize) -> Result<Pair> {
        eprintln!("{} {}", job.name, task.name());
        let mut times = [Vec::new(), Vec::new()];
        let mut last = [Run::default(), Run::default()];
        for turn in 0..repeats {
            for (k, program) in [Program::Holefill, Program::Cgal].into_iter().enumerate() {
                let is_long = last[k].seconds.is_none_or(|s| s > LONG_FILL_SECONDS);
                if turn > 0 && is_long {
                    continue;
                }
                last[k] = self.once(job, task, program)?;
                times[k].extend(last[k].seconds);
            }
        }
        let [mut ours, mut cgal] = last;
        let [our_times, cgal_times] = times;
        ours.seconds = median(our_times);
        cgal.seconds = median(cgal_times);
        Ok(Pair { ours, cgal })
    }

    fn judge(&self, job: &Job, task: Task, pair: &mut Pair) -> Result<()> {
        for (program, run) in [
            (Program::Holefill, &mut pair.ours),
            (Program::Cgal, &mut pair.cgal),
        ] {
            let output = process::beside(&self.file(job, task, program), "ply");
            if !output.exists() {
                continue;
            }
            match judge::score(self.scorer.as_deref(), &job.folder, &output) {
                Ok(score) => run.score = score,
                Err(error) => run.problem = Some(error.to_string()),
            }
        }
        Ok(())
    }

    fn case(&self, job: &Job) -> Result<CaseRow> {
        let mut c1 = self.pair(job, Task::FairC1, self.repeats)?;
        self.judge(job, Task::FairC1, &mut c1)?;
        let mut c2 = self.pair(job, Task::FairC2, 1)?;
        self.judge(job, Task::FairC2, &mut c2)?;
        let has_truth = job.folder.join("truth.ply").exists();
        Ok(CaseRow {
            name: job.name.clone(),
            edges: job.edges,
            has_truth,
            c1,
            c2,
        })
    }

    fn input(&self, job: &Job) -> Result<InputRow> {
        let task = if job.name == "rim_400" {
            Task::Exact
        } else {
            Task::FairC1
        };
        let pair = self.pair(job, task, self.repeats)?;
        for program in [Program::Holefill, Program::Cgal] {
            let output = process::beside(&self.file(job, task, program), "ply");
            if output.exists() {
                fs::remove_file(output)?;
            }
        }
        Ok(InputRow {
            name: job.name.clone(),
            task: task.name(),
            pair,
        })
    }

    fn build(&self, job: &Job) -> Result<Option<BuildRow>> {
        eprintln!("{} build", job.name);
        let limit = Duration::from_secs_f64(self.limit_seconds) + OVERHEAD;
        let file = self.out.join(format!("{}.build", job.name));
        let report = process::beside(&file, "json");
        let holefill = self.holefill.display().to_string();
        let inspect = [holefill, "inspect".into(), job.input(), "--json".into()];
        let mut build = vec![self.cgal.display().to_string(), job.input(), "-".into()];
        build.extend(["--method", "triangulate", "--json"].map(str::to_owned));
        build.push(report.display().to_string());
        build.extend(job.keep_args());
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..self.repeats {
            if process::run(&inspect, &file, limit)?.code == Some(0) {
                let json = read_json(&process::beside(&file, "out"))?;
                let seconds = |key: &str| json["seconds"][key].as_f64();
                times[0].extend(seconds("build").zip(seconds("loops")).map(|(a, b)| a + b));
            }
            if process::run(&build, &file, limit)?.code == Some(0) {
                times[1].extend(read_json(&report)?["seconds"]["build"]["cpu"].as_f64());
            }
        }
        let [ours, cgal] = times.map(median);
        Ok(ours.zip(cgal).map(|(ours, cgal)| BuildRow { ours, cgal }))
    }
}

/// Measures everything in the settings.
pub(crate) fn measure(settings: &Settings) -> Result<Results> {
    fs::create_dir_all(&settings.out)?;
    let only = settings.only.as_deref();
    let mut results = Results::default();
    for job in jobs(settings.cases.as_deref(), only)? {
        results.cases.push(settings.case(&job)?);
    }
    for job in jobs(settings.inputs.as_deref(), only)? {
        results.inputs.push(settings.input(&job)?);
        if job.name == BUILD_INPUT {
            results.build = settings.build(&job)?;
        }
    }
    Ok(results)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_of_times_lies_between_the_middle_two() {
        assert_eq!(median(vec![]), None);
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 9.0]), Some(3.0));
    }

    #[test]
    fn a_result_with_failed_holes_has_no_time_ratio() {
        let whole = Run {
            seconds: Some(1.0),
            ..Run::default()
        };
        let part = Run {
            problem: Some("1 of 2 holes failed".into()),
            ..whole.clone()
        };
        let slow = Run {
            seconds: Some(4.0),
            limited: true,
            ..Run::default()
        };
        let ratio = |ours: &Run, cgal: &Run| {
            Pair {
                ours: ours.clone(),
                cgal: cgal.clone(),
            }
            .time_ratio()
        };
        assert_eq!(ratio(&whole, &slow), Some(0.25));
        assert_eq!(ratio(&part, &whole), None);
        assert_eq!(ratio(&slow, &whole), None);
        assert_eq!(ratio(&whole, &Run::default()), None);
    }
}
