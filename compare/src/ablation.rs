//! The effect of each stage of `auto`. Fills the same cases with one stage off at a time, with each candidate surface
//! prescribed, and by CGAL at second-order continuity, in one run.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::job::{Job, jobs, read_json};
use crate::table::geometric_mean;
use crate::{Result, judge, process};

/// Smallest deviation that counts, as a share of the size of the hole: below it, the triangles of the files dominate.
const LEAST_DEVIATION: f64 = 1e-4;

/// Stages to switch off: the name in the table, and the options.
const STAGES: [(&str, &[&str]); 6] = [
    ("without jets: normals of triangles", &["auto.jets=off"]),
    (
        "without primitives: interpolating functions only",
        &["auto.primitives=off"],
    ),
    ("without `rbf5`", &["auto.quintic=off"]),
    ("without creases", &["auto.creases=off"]),
    ("without the tip rule", &["auto.tips=off"]),
    (
        "without the choice: always `rbf3`",
        &["auto.candidate=rbf3"],
    ),
];

/// The candidates, each prescribed for all holes.
const CANDIDATES: [&str; 11] = [
    "plane",
    "sphere",
    "cylinder",
    "cone",
    "torus",
    "quadric",
    "cyclide",
    "rbf3",
    "rbf3-smoothed",
    "rbf3-ridge",
    "rbf5",
];

/// The settings of a run; see the help of the command line.
pub(crate) struct Settings {
    pub(crate) cases: PathBuf,
    pub(crate) holefill: PathBuf,
    pub(crate) cgal: PathBuf,
    pub(crate) out: PathBuf,
    pub(crate) only: Option<String>,
    pub(crate) most_edges: u64,
    pub(crate) limit_seconds: f64,
}

/// Deviation and seconds of one way on one case.
#[derive(Clone, Copy, Debug)]
struct Figure {
    deviation: f64,
    seconds: f64,
}

/// One way to fill, on all cases; `None` where it gave no result.
struct Way {
    title: String,
    figures: Vec<Option<Figure>>,
}

impl Settings {
    fn run(&self, job: &Job, command: &[String], name: &str, seconds: &[&str]) -> Option<Figure> {
        let file = self.out.join(name);
        let output = process::beside(&file, "ply");
        let limit = Duration::from_secs_f64(self.limit_seconds);
        let outcome = process::run(command, &file, limit).ok()?;
        if !matches!(outcome.code, Some(0 | 3)) {
            return None;
        }
        let report = read_json(&process::beside(&file, "json")).ok()?;
        let seconds = seconds.iter().fold(&report, |json, key| &json[*key]);
        Some(Figure {
            deviation: judge::score(None, &job.folder, &output).ok()?.sym_rms?,
            seconds: seconds.as_f64()?,
        })
    }

    fn ours(&self, job: &Job, name: &str, options: &[&str]) -> Option<Figure> {
        let file = self.out.join(name);
        let at = |extension| process::beside(&file, extension).display().to_string();
        let mut words = vec![
            self.holefill.display().to_string(),
            "fill".into(),
            job.input(),
        ];
        words.extend(["-o".into(), at("ply"), "--report".into(), at("json")]);
        words.extend(["--method", "auto", "--threads", "1", "--quiet"].map(str::to_owned));
        words.extend(
            options
                .iter()
                .flat_map(|o| ["--set".to_owned(), (*o).to_owned()]),
        );
        words.extend(job.keep_args());
        self.run(job, &words, name, &["seconds", "fill"])
    }

    fn cgal(&self, job: &Job) -> Option<Figure> {
        let file = self.out.join("cgal");
        let at = |extension| process::beside(&file, extension).display().to_string();
        let mut words = vec![self.cgal.display().to_string(), job.input(), at("ply")];
        words.extend(["--continuity", "2", "--json"].map(str::to_owned));
        words.push(at("json"));
        words.extend(job.keep_args());
        self.run(job, &words, "cgal", &["seconds", "fill", "cpu"])
    }
}

/// Runs everything and describes it in Markdown.
pub(crate) fn table(settings: &Settings) -> Result<String> {
    fs::create_dir_all(&settings.out)?;
    let mut jobs = jobs(Some(&settings.cases), settings.only.as_deref())?;
    jobs.retain(|job| job.edges <= settings.most_edges && has_truth(&job.folder));
    let over_all = |title: &str, run: &dyn Fn(&Job) -> Option<Figure>| Way {
        title: title.to_owned(),
        figures: jobs
            .iter()
            .map(|job| {
                eprintln!("{title}: {}", job.name);
                run(job)
            })
            .collect(),
    };
    let whole = over_all("all stages", &|job| settings.ours(job, "auto", &[]));
    let mut ways: Vec<Way> = STAGES
        .iter()
        .map(|(title, options)| over_all(title, &|job| settings.ours(job, "stage", options)))
        .collect();
    if settings.cgal.exists() {
        ways.push(over_all("CGAL, continuity 2", &|job| settings.cgal(job)));
    }
    let candidates: Vec<Way> = CANDIDATES
        .iter()
        .map(|name| {
            let option = format!("auto.candidate={name}");
            over_all(name, &|job| settings.ours(job, "candidate", &[&option]))
        })
        .collect();
    let mut text = stages(&jobs, &whole, &ways);
    text.push_str(&oracle(&jobs, &whole, &candidates));
    Ok(text)
}

fn has_truth(folder: &Path) -> bool {
    folder.join("truth.ply").exists()
}

fn deviation_ratio(figure: &Figure, to: &Figure) -> f64 {
    figure.deviation.max(LEAST_DEVIATION) / to.deviation.max(LEAST_DEVIATION)
}

fn stages(jobs: &[Job], whole: &Way, ways: &[Way]) -> String {
    let mut text = String::from(
        "| | cases | deviation over that of all stages, geometric mean | worst case | seconds over those of all stages |\n\
         | --- | ---: | ---: | --- | ---: |\n",
    );
    for way in ways {
        let pairs: Vec<(&Job, Figure, Figure)> = jobs
            .iter()
            .zip(way.figures.iter().zip(&whole.figures))
            .filter_map(|(job, (way, whole))| Some((job, (*way)?, (*whole)?)))
            .collect();
        let ratios: Vec<f64> = pairs
            .iter()
            .map(|(_, a, b)| deviation_ratio(a, b))
            .collect();
        let times: Vec<f64> = pairs
            .iter()
            .map(|(_, a, b)| a.seconds / b.seconds)
            .collect();
        let worst = pairs
            .iter()
            .zip(&ratios)
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map_or(String::new(), |((job, ..), ratio)| {
                format!("{} {ratio:.2}", job.name)
            });
        let mean =
            |values: &[f64]| geometric_mean(values).map_or("–".into(), |m| format!("{m:.3}"));
        let (deviation, time) = (mean(&ratios), mean(&times));
        let _ = writeln!(
            text,
            "| {} | {} | {deviation} | {worst} | {time} |",
            way.title,
            pairs.len()
        );
    }
    text
}

/// Compares the best candidate of each case with the choice of `auto`.
fn oracle(jobs: &[Job], whole: &Way, candidates: &[Way]) -> String {
    let mut text = String::from(
        "\n| case | chosen | best candidate | | ratio |\n| --- | ---: | ---: | --- | ---: |\n",
    );
    let mut ratios = Vec::new();
    for (i, (job, chosen)) in jobs.iter().zip(&whole.figures).enumerate() {
        let best = candidates
            .iter()
            .filter_map(|way| Some((way.figures[i]?, way.title.as_str())))
            .min_by(|a, b| a.0.deviation.total_cmp(&b.0.deviation));
        let (Some(chosen), Some((best, name))) = (chosen, best) else {
            continue;
        };
        let ratio = deviation_ratio(chosen, &best);
        ratios.push(ratio);
        let _ = writeln!(
            text,
            "| {} | {:.2e} | {:.2e} | {name} | {ratio:.3} |",
            job.name, chosen.deviation, best.deviation
        );
    }
    if let Some(mean) = geometric_mean(&ratios) {
        let _ = writeln!(
            text,
            "\nGeometric mean of the ratios over {} cases: {mean:.3}.",
            ratios.len()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(deviation: f64) -> Option<Figure> {
        Some(Figure {
            deviation,
            seconds: 1.0,
        })
    }

    #[test]
    fn deviations_below_the_resolution_of_files_count_as_equal() {
        let ratio = |a, b| deviation_ratio(&figure(a).unwrap(), &figure(b).unwrap());
        assert_eq!(ratio(1e-7, 3e-5), 1.0);
        assert_eq!(ratio(2e-3, 1e-3), 2.0);
    }

    #[test]
    fn the_table_leaves_out_what_has_no_result_and_names_the_worst() {
        let job = |name: &str| Job::named(name);
        let jobs = [job("a"), job("b"), job("c")];
        let whole = Way {
            title: "all".into(),
            figures: vec![figure(1e-3), figure(1e-3), figure(1e-3)],
        };
        let way = Way {
            title: "one".into(),
            figures: vec![figure(2e-3), figure(8e-3), None],
        };
        let text = stages(&jobs, &whole, std::slice::from_ref(&way));
        assert!(
            text.ends_with("| one | 2 | 4.000 | b 8.00 | 1.000 |\n"),
            "{text}"
        );
        let text = oracle(&jobs, &way, std::slice::from_ref(&whole));
        assert!(
            text.contains("| b | 8.00e-3 | 1.00e-3 | all | 8.000 |"),
            "{text}"
        );
        assert!(text.ends_with("over 2 cases: 4.000.\n"), "{text}");
    }
}
