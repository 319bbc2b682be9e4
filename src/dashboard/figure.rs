//! Time histories as a picture: measured against model, and the residual below, for each output, and the inputs; of a
//! diagnosis with the declared model beside the one that has its effects in it.

use plotters::prelude::*;

use super::chart::{Area, Chart, Margins, axes, extent, faint, in_words, svg};
use super::decimate::rows_to_plot;
use super::style::{DECLARED, MEASURED, MODEL, THIRD};
use crate::estimate::{OutputSeries, Series, TimeHistory};
use crate::flight::{GAP_FACTOR, Shown, shown_in};

const WIDTH: u32 = 900;
/// Height of one output's panel, residual included.
const PANEL: u32 = 230;
const RESIDUAL: u32 = 80;
/// Height of one input's panel.
const INPUT: u32 = 110;
/// Height of the line that says what is what.
const LEGEND: u32 = 24;

const MARGINS: Margins = Margins {
    around: 6,
    below: 26,
    left: 64,
};

/// Points drawn of a series.
const MOST_POINTS: usize = 1_600;

/// One segment as SVG; angles in degrees, as people expect them.
///
/// # Errors
/// The drawing library's words; none is known for finite numbers.
pub fn history_svg(history: &TimeHistory) -> Result<String, String> {
    let (outputs, inputs) = (history.outputs.len() as u32, history.inputs.len() as u32);
    let height = LEGEND + PANEL * outputs + INPUT * inputs;
    svg((WIDTH, height), |area| {
        let (legend, mut rest) = area.split_vertically(LEGEND);
        key(history, &legend)?;
        for output in &history.outputs {
            let (panel, below) = rest.split_vertically(PANEL);
            let (above, residual) = panel.split_vertically(PANEL - RESIDUAL);
            draw(&history.time, output, &above, &residual)?;
            rest = below;
        }
        for input in &history.inputs {
            let (panel, below) = rest.split_vertically(INPUT);
            draw_input(&history.time, input, &panel)?;
            rest = below;
        }
        Ok(())
    })
}

/// What is what, once for all panels and above them, where it hides nothing.
fn key(history: &TimeHistory, area: &Area<'_>) -> Result<(), String> {
    let is_diagnosed = (history.outputs.iter()).any(|output| !output.declared.is_empty());
    let mut entries = vec![("measured", MEASURED, 0)];
    if is_diagnosed {
        entries.push(("declared model", DECLARED, 2));
    }
    let model = if is_diagnosed {
        "with its effects"
    } else {
        "model"
    };
    entries.push((model, MODEL, 2));
    if !history.inputs.is_empty() {
        entries.push(("input", THIRD, 1));
    }
    let middle = LEGEND as i32 / 2 + 2;
    for (at, (text, colour, width)) in entries.into_iter().enumerate() {
        let x = 80 + 150 * at as i32;
        if width == 0 {
            area.draw(&Circle::new((x + 8, middle), 3, colour.filled()))
        } else {
            let line = vec![(x, middle), (x + 18, middle)];
            area.draw(&PathElement::new(line, colour.stroke_width(width)))
        }
        .map_err(in_words)?;
        let text = Text::new(text, (x + 24, middle - 6), ("sans-serif", 12));
        area.draw(&text).map_err(in_words)?;
    }
    Ok(())
}

fn draw_input(time: &[f64], input: &Series, area: &Area<'_>) -> Result<(), String> {
    let Shown { scale, unit } = shown_in(&input.unit);
    let values = points(time, &input.values, scale);
    let mut chart = over_time(area, time, range_of(values.iter().flatten()))?;
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.y_labels(3)
        .x_desc("t [s]")
        .y_desc(format!("{} [{unit}]", input.name))
        .label_style(("sans-serif", 12))
        .draw()
        .map_err(in_words)?;
    lines(&mut chart, &values, THIRD.stroke_width(1))
}

/// A line through samples that follow each other: none across a gap.
fn lines(
    chart: &mut Chart<'_, '_>,
    runs: &[Vec<(f64, f64)>],
    style: ShapeStyle,
) -> Result<(), String> {
    for run in runs {
        if let [alone] = run.as_slice() {
            let dot = std::iter::once(Circle::new(*alone, 1, style.filled()));
            chart.draw_series(dot).map_err(in_words)?;
        }
        let line = LineSeries::new(run.iter().copied(), style);
        chart.draw_series(line).map_err(in_words)?;
    }
    Ok(())
}

fn draw(
    time: &[f64],
    output: &OutputSeries,
    above: &Area<'_>,
    below: &Area<'_>,
) -> Result<(), String> {
    let Shown { scale, unit } = shown_in(&output.unit);
    let measured = points(time, &output.measured, scale);
    let model = points(time, &output.model, scale);
    let declared = points(time, &output.declared, scale);
    let residual = points(time, &output.residual, scale);
    let label = format!("{} [{unit}]", output.name);

    let all = measured.iter().chain(&model).chain(&declared);
    let range = range_of(all.flatten());
    let mut chart = over_time(above, time, range)?;
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.x_labels(0)
        .y_labels(5)
        .y_desc(label)
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(in_words)?;
    for (runs, colour) in [(declared, DECLARED), (model, MODEL)] {
        lines(&mut chart, &runs, colour.stroke_width(2))?;
    }
    // above the lines: what was measured is never hidden
    let dots = (measured.iter().flatten()).map(|&at| Circle::new(at, 1, MEASURED.filled()));
    chart.draw_series(dots).map_err(in_words)?;
    let before = output.measured.iter().zip(&output.declared);
    let before: Vec<f64> = before.map(|(z, y)| z - y).collect();
    let before = points(time, &before, scale);
    let all = residual.iter().chain(&before).flatten();
    let mut chart = over_time(below, time, range_of(all))?;
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.y_labels(3)
        .x_desc("t [s]")
        .y_desc("residual")
        .label_style(("sans-serif", 12))
        .draw()
        .map_err(in_words)?;
    for (runs, colour) in [(before, DECLARED), (residual, MEASURED)] {
        lines(&mut chart, &runs, colour.stroke_width(1))?;
    }
    Ok(())
}

/// Axes over the time of a segment.
fn over_time<'a, 'b>(
    area: &'a Area<'b>,
    time: &[f64],
    range: (f64, f64),
) -> Result<Chart<'a, 'b>, String> {
    let first = time.first().copied().unwrap_or(0.0);
    let last = time.last().copied().unwrap_or(1.0);
    axes(area, (first, last.max(first + 1e-9)), range, &MARGINS)
}

/// The samples that are numbers, and of very many those that a plot shows, in runs without a gap: where a value is missing, or the
/// recording stopped, another begins.
fn points(time: &[f64], values: &[f64], scale: f64) -> Vec<Vec<(f64, f64)>> {
    let there: Vec<usize> = (0..values.len().min(time.len()))
        .filter(|&row| values[row].is_finite())
        .collect();
    let finite: Vec<f64> = there.iter().map(|&row| values[row]).collect();
    let step = usual_step(time);
    let follows = |row: usize| row > 0 && time[row] - time[row - 1] <= GAP_FACTOR * step;
    let mut runs: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut last: Option<usize> = None;
    for place in rows_to_plot(&[&finite], finite.len(), MOST_POINTS) {
        let row = there[place];
        let goes_on = last.is_some_and(|last: usize| {
            // all rows between are there, and none is behind a gap
            place - last == row - there[last] && (there[last] + 1..=row).all(follows)
        });
        if !goes_on {
            runs.push(Vec::new());
        }
        if let Some(run) = runs.last_mut() {
            run.push((time[row], values[row] * scale));
        }
        last = Some(place);
    }
    runs
}

/// The median time between samples.
fn usual_step(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// From the least to the greatest value, with some room, never empty.
fn range_of<'a>(points: impl Iterator<Item = &'a (f64, f64)>) -> (f64, f64) {
    let Some((low, high)) = extent(points.map(|&(_, value)| value)) else {
        return (-1.0, 1.0);
    };
    let room = (0.08 * (high - low)).max(1e-9 + 1e-6 * high.abs());
    (low - room, high + room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_series_keep_their_extremes() {
        let time: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values = vec![0.0; time.len()];
        values[54_321] = 7.0;
        values[12_345] = -3.0;
        let drawn = points(&time, &values, 1.0);
        assert_eq!(drawn.len(), 1);
        let drawn = &drawn[0];
        assert!(drawn.len() <= MOST_POINTS);
        assert!(drawn.contains(&(54_321.0, 7.0)) && drawn.contains(&(12_345.0, -3.0)));
    }

    #[test]
    fn no_line_crosses_what_is_missing_or_a_gap() {
        let time = [0.0, 0.1, 0.2, 0.3, 0.4, 2.0, 2.1];
        let values = [1.0, 2.0, f64::NAN, 4.0, 5.0, 6.0, 7.0];
        let runs = points(&time, &values, 2.0);
        let expected = [
            vec![(0.0, 2.0), (0.1, 4.0)],
            vec![(0.3, 8.0), (0.4, 10.0)],
            vec![(2.0, 12.0), (2.1, 14.0)],
        ];
        assert_eq!(runs, expected);
        assert!(points(&time, &[f64::NAN; 7], 1.0).is_empty());
    }

    #[test]
    fn angles_are_shown_in_degrees() {
        let mut history = TimeHistory {
            segment: "1".into(),
            role: crate::estimate::Role::default(),
            time: vec![0.0, 1.0],
            inputs: vec![],
            outputs: vec![OutputSeries {
                name: "alpha".into(),
                unit: "rad".into(),
                measured: vec![0.1, 0.2],
                model: vec![0.1, 0.1],
                declared: Vec::new(),
                residual: vec![0.0, 0.1],
            }],
        };
        let svg = history_svg(&history).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("alpha [deg]"));
        assert!(!svg.contains("declared model"));
        history.outputs[0].declared = vec![0.1, 0.15];
        let svg = history_svg(&history).unwrap();
        assert!(svg.contains("declared model") && svg.contains("with its effects"));
    }
}
