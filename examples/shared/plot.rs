//! Line plots as SVG.

use super::Result;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use std::path::Path;

/// A line with its name.
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scale {
    Linear,
    Logarithmic,
}

/// Writes the plot of `lines` to `file`, with the labels of x and y. Both axes have the same kind of scale. A linear y
/// axis starts at zero.
pub(crate) fn plot(
    file: &Path,
    title: &str,
    labels: [&str; 2],
    scale: Scale,
    lines: &[Line],
) -> Result<()> {
    let all = || lines.iter().flat_map(|l| &l.points);
    let (mut x, mut y) = (f64::INFINITY..0.0_f64, f64::INFINITY..0.0_f64);
    for &(a, b) in all() {
        x = x.start.min(a)..x.end.max(a);
        y = y.start.min(b)..y.end.max(b);
    }
    match scale {
        Scale::Linear => draw(file, title, labels, x, 0.0..1.05 * y.end, lines),
        Scale::Logarithmic => draw(
            file,
            title,
            labels,
            (x.start..x.end).log_scale(),
            (y.start / 1.5..y.end * 1.5).log_scale(),
            lines,
        ),
    }
}

fn draw<X, Y>(
    file: &Path,
    title: &str,
    [x_label, y_label]: [&str; 2],
    x: X,
    y: Y,
    lines: &[Line],
) -> Result<()>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let area = SVGBackend::new(file, (760, 480)).into_drawing_area();
    area.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(76)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(x_label)
        .y_desc(y_label)
        .x_label_formatter(&number)
        .y_label_formatter(&number)
        .light_line_style(WHITE)
        .draw()?;
    for (i, line) in lines.iter().enumerate() {
        let color = Palette99::pick(i).to_rgba();
        let points = line.points.iter().copied();
        chart
            .draw_series(LineSeries::new(points.clone(), color.stroke_width(2)))?
            .label(&line.name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        // Marks for single measured values.
        if line.points.len() < 15 {
            chart.draw_series(points.map(|p| Circle::new(p, 3, color.filled())))?;
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    area.present()?;
    Ok(())
}

/// The shortest text that still distinguishes two marks of an axis.
fn number(x: &f64) -> String {
    let size = x.abs();
    if size != 0.0 && !(1e-3..1e6).contains(&size) {
        format!("{x:.0e}")
    } else {
        let text = format!("{x:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}
