//! Tables for humans: aligned columns, short numbers.

use holefill::{BoundaryLoop, FillReport, HoleReport, HoleStatus};
use std::fmt::Write;

/// A report of more holes than this is not shown completely.
const ALL_ROWS: usize = 20;
/// Number of largest holes that are shown of a long report.
const LARGEST_ROWS: usize = 5;

/// Rows under headings. Columns whose heading starts with a space are aligned to the right.
struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    fn new(headings: &[&str]) -> Self {
        Self {
            rows: vec![headings.iter().map(|&h| h.to_owned()).collect()],
        }
    }

    fn render(&self) -> String {
        let columns = self.rows[0].len();
        let width = |k: usize| {
            self.rows
                .iter()
                .map(|row| row[k].trim_start().chars().count())
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::new();
            for (k, cell) in row.iter().enumerate() {
                let (cell, width) = (cell.trim_start(), widths[k]);
                // Writing to a string cannot fail.
                let _ = if self.rows[0][k].starts_with(' ') {
                    write!(line, "{cell:>width$}  ")
                } else {
                    write!(line, "{cell:<width$}  ")
                };
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }
}

/// A length or area with about five digits.
pub(crate) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        let decimals = (4 - size.log10().floor() as i32).clamp(0, 7) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.4e}")
    }
}

fn edge(edge: [u32; 2]) -> String {
    format!("{},{}", edge[0], edge[1])
}

/// One row for each boundary loop.
pub(crate) fn loops(loops: &[BoundaryLoop]) -> String {
    let mut table = Table::new(&[
        " LOOP",
        "CLASS",
        " EDGES",
        " PERIMETER",
        " AREA",
        " PLANARITY",
        "EDGE",
    ]);
    for l in loops {
        table.rows.push(vec![
            l.id.to_string(),
            l.class.to_string(),
            l.edge_count().to_string(),
            number(l.perimeter),
            number(area(l)),
            format!("{:.4}", l.planarity),
            edge(l.edge()),
        ]);
    }
    table.render()
}

/// The norm of the vector area. It is scaled so that its squares do not overflow.
pub(crate) fn area(l: &BoundaryLoop) -> f64 {
    let [x, y, z] = l.vector_area;
    x.hypot(y).hypot(z)
}

/// One row for each hole (of many holes, for the failed and the largest ones), and a line with the counts.
pub(crate) fn holes(report: &FillReport) -> String {
    if report.holes.is_empty() {
        return "no holes\n".to_owned();
    }
    let mut table = Table::new(&[
        " HOLE",
        " EDGES",
        " PERIMETER",
        "STATUS",
        "METHOD",
        " VERTICES",
        " TRIANGLES",
        "NOTE",
    ]);
    let shown = shown_holes(&report.holes);
    table
        .rows
        .extend(shown.iter().map(|&i| hole_row(&report.holes[i])));
    let mut text = table.render();
    if shown.len() < report.holes.len() {
        let hidden = report.holes.len() - shown.len();
        let _ = writeln!(text, "... and {hidden} more");
    }
    let _ = writeln!(text, "{}", summary(report));
    text
}

fn hole_row(hole: &HoleReport) -> Vec<String> {
    vec![
        hole.id.to_string(),
        hole.edges.to_string(),
        number(hole.perimeter),
        hole.status.name().to_owned(),
        hole.method
            .map_or_else(|| "-".to_owned(), |m| m.to_string()),
        hole.new_vertices.len().to_string(),
        hole.new_triangles.len().to_string(),
        hole.reason.clone(),
    ]
}

/// Indices of the holes to show, in order: all if there are few, otherwise the first failed ones and the
/// largest ones.
fn shown_holes(holes: &[HoleReport]) -> Vec<usize> {
    if holes.len() <= ALL_ROWS {
        return (0..holes.len()).collect();
    }
    let failed = |h: &HoleReport| matches!(h.status, HoleStatus::Failed | HoleStatus::Cancelled);
    let mut by_perimeter: Vec<usize> = (0..holes.len()).collect();
    by_perimeter.sort_by(|&i, &j| {
        holes[j]
            .perimeter
            .total_cmp(&holes[i].perimeter)
            .then(i.cmp(&j))
    });
    by_perimeter.truncate(LARGEST_ROWS);
    let mut shown: Vec<usize> = (0..holes.len())
        .filter(|&i| failed(&holes[i]))
        .take(ALL_ROWS)
        .collect();
    shown.extend(by_perimeter);
    shown.sort_unstable();
    shown.dedup();
    shown
}

/// The counts of holes by status, for example `635 holes: 633 filled, 2 failed`.
pub(crate) fn summary(report: &FillReport) -> String {
    let total = report.holes.len();
    let statuses = [
        HoleStatus::Filled,
        HoleStatus::Kept,
        HoleStatus::Failed,
        HoleStatus::Cancelled,
    ];
    let counts: Vec<String> = statuses
        .into_iter()
        .map(|status| (status, report.count(status)))
        .filter(|&(_, count)| count > 0)
        .map(|(status, count)| format!("{count} {}", status.name()))
        .collect();
    let plural = if total == 1 { "" } else { "s" };
    format!("{total} hole{plural}: {}", counts.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use holefill::LoopClass;

    fn hole(id: usize, status: HoleStatus, perimeter: f64) -> HoleReport {
        HoleReport {
            id,
            edge: [0, 1],
            edges: 3,
            perimeter,
            class: LoopClass::Simple,
            status,
            reason: String::new(),
            cause: None,
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

    #[test]
    fn numbers_have_five_digits_whatever_their_size() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1.0000"),
            (12.345678, "12.346"),
            (123456.7, "123457"),
            (0.00123456, "0.0012346"),
            (1e-9, "1.0000e-9"),
            (2.5e30, "2.5000e30"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn a_long_report_shows_failed_and_largest_holes_and_counts_all() {
        let mut all: Vec<HoleReport> = (0..635)
            .map(|i| hole(i, HoleStatus::Filled, 1.0 + i as f64))
            .collect();
        all[7].status = HoleStatus::Failed;
        all[9].status = HoleStatus::Failed;
        assert_eq!(shown_holes(&all), [7, 9, 630, 631, 632, 633, 634]);
        let text = holes(&FillReport {
            holes: all,
            ..FillReport::default()
        });
        assert!(
            text.ends_with("... and 628 more\n635 holes: 633 filled, 2 failed\n"),
            "{text}"
        );
    }

    #[test]
    fn many_failures_do_not_flood_the_terminal() {
        let all: Vec<HoleReport> = (0..5000)
            .map(|i| hole(i, HoleStatus::Failed, 1.0))
            .collect();
        assert_eq!(shown_holes(&all).len(), ALL_ROWS);
    }

    #[test]
    fn columns_line_up() {
        let report = FillReport {
            holes: vec![
                hole(0, HoleStatus::Filled, 10.0),
                hole(1, HoleStatus::Kept, 1e9),
            ],
            ..FillReport::default()
        };
        let text = holes(&report);
        let place = |line: &str, word: &str| line.find(word);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(place(lines[0], "STATUS"), place(lines[1], "filled"));
        assert_eq!(place(lines[0], "STATUS"), place(lines[2], "kept"));
        assert_eq!(lines[3], "2 holes: 1 filled, 1 kept");
    }
}
