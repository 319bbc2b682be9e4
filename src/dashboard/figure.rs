//! Time histories as a picture: measured against model, and the residual below, for each output, and the inputs; of a
//! diagnosis with the declared model beside the one that has its effects in it.

use plotters::prelude::*;

use super::chart::{Area, Chart, Margins, axes, extent, faint, in_words, svg};
use super::decimate::rows_to_plot;
use super::style::{DECLARED, MEASURED, MODEL};
use crate::estimate::{OutputSeries, Series, TimeHistory};
use crate::flight::{Shown, shown_in};

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
    let mut chart = over_time(area, time, range_of(values.iter()))?;
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.y_labels(3)
        .x_desc("t [s]")
        .y_desc(format!("{} [{unit}]", input.name))
        .label_style(("sans-serif", 12))
        .draw()
        .map_err(in_words)?;
    let line = LineSeries::new(values, BLACK.mix(0.7).stroke_width(1));
    chart.draw_series(line).map_err(in_words)?;
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

    let range = range_of(measured.iter().chain(&model).chain(&declared));
    let mut chart = over_time(above, time, range)?;
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.x_labels(0)
        .y_labels(5)
        .y_desc(label)
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(in_words)?;
    let dots = measured
        .iter()
        .map(|&at| Circle::new(at, 1, MEASURED.filled()));
    chart.draw_series(dots).map_err(in_words)?;
    for (points, colour) in [(declared, DECLARED), (model, MODEL)] {
        let line = LineSeries::new(points, colour.stroke_width(2));
        chart.draw_series(line).map_err(in_words)?;
    }
    let before = output.measured.iter().zip(&output.declared);
    let before: Vec<f64> = before.map(|(z, y)| z - y).collect();
    let before = points(time, &before, scale);
    let mut chart = over_time(below, time, range_of(residual.iter().chain(&before)))?;
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.y_labels(3)
        .x_desc("t [s]")
        .y_desc("residual")
        .label_style(("sans-serif", 12))
        .draw()
        .map_err(in_words)?;
    // a line only where samples follow each other: not across what is missing
    let gaps = output.residual.iter().any(|residual| residual.is_nan());
    for (points, colour) in [(before, DECLARED), (residual, MEASURED)] {
        if gaps {
            let dots = points.iter().map(|&at| Circle::new(at, 1, colour.filled()));
            chart.draw_series(dots).map(|_| ())
        } else {
            let line = LineSeries::new(points, colour.stroke_width(1));
            chart.draw_series(line).map(|_| ())
        }
        .map_err(in_words)?;
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

/// The samples that are numbers, and of very many those that a plot shows.
fn points(time: &[f64], values: &[f64], scale: f64) -> Vec<(f64, f64)> {
    let samples = time.iter().copied().zip(values.iter().copied());
    let (time, values): (Vec<f64>, Vec<f64>) =
        samples.filter(|(_, value)| value.is_finite()).unzip();
    let shown = rows_to_plot(&[&values], values.len(), MOST_POINTS);
    (shown.into_iter())
        .map(|row| (time[row], values[row] * scale))
        .collect()
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
        assert!(drawn.len() <= MOST_POINTS);
        assert!(drawn.contains(&(54_321.0, 7.0)) && drawn.contains(&(12_345.0, -3.0)));
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
