//! The Markdown tables, the geometric means, and a verdict for every target.

use std::fmt::Write as _;

use crate::measure::{CaseRow, InputRow, Pair, Results, Run};

/// Deviations below this share of the size of the hole are rounding, as in a flat hole with a flat patch.
const EXACT_DEVIATION: f64 = 1e-9;

/// One target, its measured figure, and whether it is met; `None` where it was not measured.
pub(crate) struct Verdict {
    pub(crate) target: &'static str,
    pub(crate) figure: String,
    pub(crate) met: Option<bool>,
}

/// `None` if there are no values.
pub(crate) fn geometric_mean(values: &[f64]) -> Option<f64> {
    let sum: f64 = values.iter().map(|v| v.ln()).sum();
    (!values.is_empty()).then(|| (sum / values.len() as f64).exp())
}

fn deviation_ratio(pair: &Pair) -> Option<f64> {
    let [ours, cgal] = [pair.ours.score.sym_rms?, pair.cgal.score.sym_rms?];
    Some(ours.max(EXACT_DEVIATION) / cgal.max(EXACT_DEVIATION))
}

/// The geometric mean of a figure over all cases. A case without the figure fails the target.
fn mean_verdict<'a>(
    target: &'static str,
    limit: f64,
    cases: impl Iterator<Item = &'a CaseRow>,
    figure: impl Fn(&CaseRow) -> Option<f64>,
) -> Verdict {
    let figures: Vec<Option<f64>> = cases.map(figure).collect();
    let known: Vec<f64> = figures.iter().copied().flatten().collect();
    let mean = geometric_mean(&known);
    let shown = mean.map_or("no figure".into(), |mean| format!("{mean:.3}"));
    Verdict {
        target,
        figure: format!("{shown} over {} of {} cases", known.len(), figures.len()),
        met: (!figures.is_empty())
            .then(|| known.len() == figures.len() && mean.is_some_and(|mean| mean <= limit)),
    }
}

fn row<'a>(results: &'a Results, name: &str) -> Option<&'a InputRow> {
    results.inputs.iter().find(|row| row.name == name)
}

fn ratio_verdict(target: &'static str, results: &Results, name: &str, limit: f64) -> Verdict {
    let Some(row) = row(results, name) else {
        return Verdict {
            target,
            figure: String::new(),
            met: None,
        };
    };
    let ratio = row.pair.time_ratio();
    let figure = format!(
        "{} against {}{}",
        seconds(&row.pair.ours),
        seconds(&row.pair.cgal),
        ratio.map_or(String::new(), |ratio| format!(": {ratio:.3}"))
    );
    Verdict {
        target,
        figure,
        met: Some(ratio.is_some_and(|ratio| ratio <= limit)),
    }
}

/// Our time alone below a limit, and our memory where that is limited too.
fn limit_verdict(
    target: &'static str,
    results: &Results,
    name: &str,
    max_seconds: f64,
    max_megabytes: Option<f64>,
) -> Verdict {
    let Some(row) = row(results, name) else {
        return Verdict {
            target,
            figure: String::new(),
            met: None,
        };
    };
    let ours = &row.pair.ours;
    let fast = ours.problem.is_none() && ours.seconds.is_some_and(|s| s < max_seconds);
    let small = max_megabytes.is_none_or(|max| ours.peak_megabytes.is_some_and(|mb| mb < max));
    let cgal = &row.pair.cgal;
    let figure = format!(
        "{}, {} (CGAL {}, {})",
        seconds(ours),
        megabytes(ours),
        seconds(cgal),
        megabytes(cgal)
    );
    Verdict {
        target,
        figure,
        met: Some(fast && small),
    }
}

fn build_verdict(results: &Results) -> Verdict {
    let target = "connectivity and loops of 4,000,000 triangles ≤ 1/8";
    let Some(build) = results.build else {
        return Verdict {
            target,
            figure: String::new(),
            met: None,
        };
    };
    let ratio = build.ours / build.cgal;
    let figure = format!(
        "{:.3} s against {:.3} s: {ratio:.3}",
        build.ours, build.cgal
    );
    Verdict {
        target,
        figure,
        met: Some(ratio <= 1.0 / 8.0),
    }
}

fn size_verdict(results: &Results) -> Verdict {
    let target = "the same hole in a mesh 100 times larger ≤ 1.2";
    let (small, large) = (row(results, "hole_in_40k"), row(results, "hole_in_4m"));
    let Some((small, large)) = small.zip(large) else {
        return Verdict {
            target,
            figure: String::new(),
            met: None,
        };
    };
    let (small, large) = (&small.pair.ours, &large.pair.ours);
    let whole = small.problem.is_none() && large.problem.is_none();
    let ratio = small
        .seconds
        .zip(large.seconds)
        .map(|(small, large)| large / small);
    let shown = ratio.map_or(String::new(), |ratio| format!(": {ratio:.3}"));
    let figure = format!("{} against {}{shown}", seconds(large), seconds(small));
    Verdict {
        target,
        figure,
        met: Some(whole && ratio.is_some_and(|ratio| ratio <= 1.2)),
    }
}

/// Every target, in the order in which they are stated.
pub(crate) fn verdicts(results: &Results) -> Vec<Verdict> {
    let with_truth = || results.cases.iter().filter(|case| case.has_truth);
    vec![
        mean_verdict(
            "deviation over CGAL's, C1 ≤ 1.00",
            1.0,
            with_truth(),
            |case| deviation_ratio(&case.c1),
        ),
        mean_verdict(
            "deviation over CGAL's, C2 ≤ 1.00",
            1.0,
            with_truth(),
            |case| deviation_ratio(&case.c2),
        ),
        mean_verdict(
            "time of the fill over CGAL's, C1 ≤ 1/2",
            0.5,
            results.cases.iter(),
            |case| case.c1.time_ratio(),
        ),
        ratio_verdict(
            "1,000 holes in 1,000,000 triangles ≤ 1/3",
            results,
            "many_holes_1m",
            1.0 / 3.0,
        ),
        ratio_verdict(
            "wavy slit, 10,000 rim edges ≤ 1/2",
            results,
            "slit_10k",
            0.5,
        ),
        limit_verdict(
            "wavy slit, 100,000 rim edges < 10 s",
            results,
            "slit_100k",
            10.0,
            None,
        ),
        ratio_verdict("wide rim, 1,000 edges ≤ 1/10", results, "rim_1000", 0.1),
        limit_verdict(
            "wide rim, 3,000 edges < 5 s, < 0.5 GB",
            results,
            "rim_3000",
            5.0,
            Some(500.0),
        ),
        ratio_verdict(
            "full dynamic program, 400 edges ≤ 1/5",
            results,
            "rim_400",
            0.2,
        ),
        build_verdict(results),
        size_verdict(results),
    ]
}

fn number(value: Option<f64>) -> String {
    match value {
        None => "–".into(),
        Some(v) if v == 0.0 || v.abs() >= 0.001 => format!("{v:.4}"),
        Some(v) => format!("{v:.1e}"),
    }
}

fn seconds(run: &Run) -> String {
    match run.seconds {
        None => "–".into(),
        Some(s) if run.limited => format!("> {s:.0} s"),
        Some(s) if s < 0.1 => format!("{:.3} ms", 1000.0 * s),
        Some(s) => format!("{s:.3} s"),
    }
}

fn megabytes(run: &Run) -> String {
    run.peak_megabytes
        .map_or("–".into(), |mb| format!("{mb:.0} MB"))
}

fn intersections(pair: &Pair) -> String {
    let shown = |run: &Run| {
        run.score
            .intersections
            .map_or("–".into(), |n| n.to_string())
    };
    format!("{} / {}", shown(&pair.ours), shown(&pair.cgal))
}

/// The problems of both programs, and whether the scorer accepts the result.
fn remarks(name: &str, pair: &Pair, out: &mut String) {
    for (program, run) in [("holefill", &pair.ours), ("CGAL", &pair.cgal)] {
        if let Some(problem) = &run.problem {
            let _ = writeln!(out, "- {name}, {program}: {problem}");
        } else if run.score.ok == Some(false) {
            let _ = writeln!(
                out,
                "- {name}, {program}: the scorer does not accept the result"
            );
        }
    }
}

fn case_table(cases: &[CaseRow], out: &mut String) {
    out.push_str("| case | m | C1 ours | C1 CGAL | ratio | C2 ours | C2 CGAL | ratio ");
    out.push_str("| intersections C1 | C2 | fill ours | fill CGAL | ratio |\n");
    out.push_str("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: ");
    out.push_str("| ---: | ---: | ---: | ---: | ---: |\n");
    for case in cases {
        let _ = write!(out, "| {} | {} ", case.name, case.edges);
        for pair in [&case.c1, &case.c2] {
            let rms = |run: &Run| number(run.score.sym_rms);
            let ratio = number(deviation_ratio(pair));
            let _ = write!(
                out,
                "| {} | {} | {ratio} ",
                rms(&pair.ours),
                rms(&pair.cgal)
            );
        }
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} |",
            intersections(&case.c1),
            intersections(&case.c2),
            seconds(&case.c1.ours),
            seconds(&case.c1.cgal),
            number(case.c1.time_ratio())
        );
    }
}

fn input_table(inputs: &[InputRow], out: &mut String) {
    out.push_str("| input | task | fill ours | fill CGAL | ratio | memory ours | memory CGAL |\n");
    out.push_str("| --- | --- | ---: | ---: | ---: | ---: | ---: |\n");
    for row in inputs {
        let (ours, cgal) = (&row.pair.ours, &row.pair.cgal);
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} |",
            row.name,
            row.task,
            seconds(ours),
            seconds(cgal),
            number(row.pair.time_ratio()),
            megabytes(ours),
            megabytes(cgal)
        );
    }
}

fn pairs(results: &Results) -> impl Iterator<Item = &Pair> {
    let of_cases = results.cases.iter().flat_map(|case| [&case.c1, &case.c2]);
    of_cases.chain(results.inputs.iter().map(|row| &row.pair))
}

/// The whole report.
pub(crate) fn markdown(results: &Results, verdicts: &[Verdict]) -> String {
    let mut out = String::from("# holefill against CGAL\n");
    if !results.cases.is_empty() {
        out.push_str(
            "\nTwo-way RMS deviation over the hole's size, and time of the fill alone (C1).\n\n",
        );
        case_table(&results.cases, &mut out);
    }
    if !results.inputs.is_empty() {
        out.push('\n');
        input_table(&results.inputs, &mut out);
    }
    let mut notes = String::new();
    if pairs(results).any(|pair| pair.cgal.disturbed) {
        notes.push_str(
            "- the machine was busy: our times are by the clock and too long, CGAL's are not\n",
        );
    }
    for case in &results.cases {
        remarks(&format!("{} C1", case.name), &case.c1, &mut notes);
        remarks(&format!("{} C2", case.name), &case.c2, &mut notes);
    }
    for row in &results.inputs {
        remarks(&row.name, &row.pair, &mut notes);
    }
    if !notes.is_empty() {
        let _ = write!(out, "\n{notes}");
    }
    out.push_str("\n| target | measured | verdict |\n| --- | --- | --- |\n");
    for verdict in verdicts {
        let word = match verdict.met {
            Some(true) => "pass",
            Some(false) => "FAIL",
            None => "not measured",
        };
        let _ = writeln!(out, "| {} | {} | {word} |", verdict.target, verdict.figure);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::Score;
    use crate::measure::BuildRow;

    fn run(seconds: f64, sym_rms: f64) -> Run {
        Run {
            seconds: Some(seconds),
            peak_megabytes: Some(100.0),
            score: Score {
                sym_rms: Some(sym_rms),
                ..Score::default()
            },
            ..Run::default()
        }
    }

    fn pair(ours: f64, cgal: f64) -> Pair {
        Pair {
            ours: run(ours, ours),
            cgal: run(cgal, cgal),
        }
    }

    fn case(ours: f64, cgal: f64) -> CaseRow {
        let both = pair(ours, cgal);
        CaseRow {
            name: "c".into(),
            edges: 9,
            has_truth: true,
            c1: both.clone(),
            c2: both,
        }
    }

    fn input(name: &str, ours: f64, cgal: f64) -> InputRow {
        InputRow {
            name: name.into(),
            task: "fair-c1",
            pair: pair(ours, cgal),
        }
    }

    fn met(results: &Results) -> Vec<Option<bool>> {
        verdicts(results)
            .iter()
            .map(|verdict| verdict.met)
            .collect()
    }

    fn passing() -> Results {
        Results {
            cases: vec![case(0.1, 1.0), case(2.0, 1.0)],
            inputs: vec![
                input("many_holes_1m", 1.0, 3.0),
                input("slit_10k", 0.4, 0.8),
                input("slit_100k", 9.9, 1.0),
                input("rim_1000", 0.2, 2.0),
                input("rim_3000", 4.9, 1.0),
                input("rim_400", 0.2, 1.0),
                input("hole_in_40k", 1.0, 1.0),
                input("hole_in_4m", 1.2, 1.0),
            ],
            build: Some(BuildRow {
                ours: 0.125,
                cgal: 1.0,
            }),
        }
    }

    #[test]
    fn every_target_passes_at_its_limit() {
        assert_eq!(met(&passing()), [Some(true); 11]);
    }

    #[test]
    fn every_target_fails_beyond_its_limit() {
        let mut results = passing();
        results.cases[0] = case(3.0, 1.0);
        for row in &mut results.inputs {
            row.pair.ours.seconds = row.pair.ours.seconds.map(|s| 1.1 * s);
        }
        results.inputs[6].pair.ours.seconds = Some(1.0);
        results.build = Some(BuildRow {
            ours: 0.126,
            cgal: 1.0,
        });
        assert_eq!(met(&results), [Some(false); 11]);
    }

    #[test]
    fn too_much_memory_fails_a_target_that_limits_it() {
        let mut results = passing();
        results.inputs[4].pair.ours.peak_megabytes = Some(501.0);
        assert_eq!(met(&results)[7], Some(false));
    }

    #[test]
    fn nothing_measured_is_no_pass() {
        assert_eq!(met(&Results::default()), [None; 11]);
    }

    #[test]
    fn a_case_without_a_result_of_ours_fails_the_means() {
        let mut results = passing();
        results.cases[0].c1.ours = Run {
            problem: Some("ended".into()),
            ..Run::default()
        };
        assert_eq!(met(&results)[..3], [Some(false), Some(true), Some(false)]);
    }

    #[test]
    fn a_case_without_truth_counts_for_time_only() {
        let mut results = passing();
        results.cases.push(CaseRow {
            has_truth: false,
            c1: Pair {
                ours: Run {
                    score: Score::default(),
                    ..run(1.0, 0.0)
                },
                cgal: run(9.0, 0.0),
            },
            ..case(1.0, 1.0)
        });
        let verdicts = verdicts(&results);
        assert!(
            verdicts[0].figure.ends_with("over 2 of 2 cases"),
            "{}",
            verdicts[0].figure
        );
        assert!(
            verdicts[2].figure.ends_with("over 3 of 3 cases"),
            "{}",
            verdicts[2].figure
        );
    }

    #[test]
    fn deviations_of_rounding_size_are_equal() {
        assert_eq!(deviation_ratio(&pair(1e-17, 3e-16)), Some(1.0));
    }

    #[test]
    fn the_report_names_every_case_and_every_problem() {
        let mut results = passing();
        results.cases[1].c2.cgal.problem = Some("1 of 2 holes failed".into());
        results.inputs[0].pair.cgal.disturbed = true;
        let text = markdown(&results, &verdicts(&results));
        assert!(text.contains("- c C2, CGAL: 1 of 2 holes failed\n"));
        assert!(text.contains("the machine was busy"));
        assert_eq!(text.matches("| pass |").count(), 11);
    }
}
