//! The figures of a derivative study: error against step, and cost against the number of parameters.

use plotters::prelude::*;

use super::chart::{Chart, Margins, axes, extent, faint, in_words, svg};
use super::style::{MEASURED, MODEL, THIRD};
use crate::estimate::study::{CostPoint, ErrorCurve};

const SIZE: (u32, u32) = (900, 460);
/// Exponents of the least step and the least error that are drawn.
const LEAST_STEP: f64 = -20.0;
const LEAST_ERROR: f64 = -17.0;
const MOST_ERROR: f64 = 3.0;

const MARGINS: Margins = Margins {
    around: 10,
    below: 42,
    left: 66,
};

/// Told apart by colour-blind readers; markers differ too.
const COLOURS: [RGBColor; 3] = [MEASURED, MODEL, THIRD];

/// Error of the gradient against the step, both logarithmic, as SVG. Errors of 0 are drawn at 1e-17.
///
/// # Errors
/// The drawing library's words; none is known.
pub fn error_figure(curves: &[ErrorCurve]) -> Result<String, String> {
    svg(SIZE, |area| {
        let x = (LEAST_STEP, 0.0);
        let mut chart = axes(
            area,
            x,
            (LEAST_ERROR, with_legend(LEAST_ERROR, MOST_ERROR)),
            &MARGINS,
        )?;
        mesh(
            &mut chart,
            "relative step",
            "relative error of the gradient",
            (11, 11),
        )?;
        for (number, curve) in curves.iter().enumerate() {
            let points: Vec<(f64, f64)> = curve
                .points
                .iter()
                .filter_map(|point| Some((point.step.log10(), point.error?)))
                .map(|(x, error)| (x, error.log10().clamp(LEAST_ERROR, MOST_ERROR)))
                .collect();
            let drawn: Vec<(f64, f64)> = points
                .iter()
                .copied()
                .filter(|(x, _)| *x >= LEAST_STEP - 1e-9)
                .collect();
            let name = curve.technique.replace('_', " ");
            series(&mut chart, &drawn, &label(&name, &points), number)?;
        }
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}

/// What the legend says: the name, and what is beyond the left edge.
fn label(name: &str, points: &[(f64, f64)]) -> String {
    let beyond = points.iter().filter(|(x, _)| *x < LEAST_STEP - 1e-9);
    let last = beyond.clone().map(|(x, _)| *x).fold(0.0, f64::min);
    let worst = beyond.map(|(_, y)| *y).fold(f64::NEG_INFINITY, f64::max);
    if worst.is_finite() {
        format!("{name} (to 1e{last:.0}: {:.0e})", 10_f64.powf(worst))
    } else {
        name.to_string()
    }
}

/// Operations and time of one gradient against the number of free parameters, as SVG.
///
/// # Errors
/// The drawing library's words; none is known.
pub fn cost_figure(costs: &[CostPoint]) -> Result<String, String> {
    svg(SIZE, |area| {
        let panels = area.split_evenly((1, 2));
        type Pick = fn(&CostPoint) -> f64;
        let figures: [(&str, [Pick; 2]); 2] = [
            (
                "operations of one gradient",
                [
                    |c| c.direct_operations as f64,
                    |c| c.adjoint_operations as f64,
                ],
            ),
            (
                "wall time of one gradient [s]",
                [|c| c.direct_wall_seconds, |c| c.adjoint_wall_seconds],
            ),
        ];
        for (panel, (what, picks)) in panels.iter().zip(figures) {
            let points = |pick: Pick| -> Vec<(f64, f64)> {
                let point = |c: &CostPoint| ((c.unknowns as f64).log10(), pick(c).log10());
                costs
                    .iter()
                    .map(point)
                    .filter(|(_, y)| y.is_finite())
                    .collect()
            };
            let all: Vec<Vec<(f64, f64)>> = picks.map(points).into();
            let y = range(all.iter().flatten().map(|point| point.1));
            let x = range(all.iter().flatten().map(|point| point.0));
            let (bottom, top) = (y.0.floor(), with_legend(y.0.floor(), y.1));
            let mut chart = axes(panel, (0.0, x.1.max(0.1)), (bottom, top), &MARGINS)?;
            let decades = 2 * (top - bottom) as usize + 1;
            mesh(&mut chart, "free parameters", what, (4, decades))?;
            for (number, name) in ["direct (forward sensitivities)", "adjoint"]
                .iter()
                .enumerate()
            {
                series(&mut chart, &all[number], name, number)?;
            }
            legend(&mut chart, SeriesLabelPosition::UpperLeft)?;
        }
        Ok(())
    })
}

/// The end of an axis that has room for the legend above all curves.
fn with_legend(bottom: f64, top: f64) -> f64 {
    const LEGEND: f64 = 0.2;
    (bottom + (top - bottom) / (1.0 - LEGEND)).ceil()
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    extent(values).map_or((-1.0, 1.0), |(low, high)| (low - 0.05, high + 0.05))
}

/// Axes hold exponents; labels say the numbers.
fn mesh(
    chart: &mut Chart<'_, '_>,
    x: &str,
    y: &str,
    (x_labels, y_labels): (usize, usize),
) -> Result<(), String> {
    let power = |exponent: &f64| {
        let value = 10_f64.powf(*exponent);
        let is_whole = (exponent - exponent.round()).abs() < 1e-6;
        match (is_whole, (0.1..1e4).contains(&value)) {
            (true, true) => format!("{}", (value * 10.0).round() / 10.0),
            (true, false) => format!("1e{exponent:.0}"),
            (false, true) => format!("{value:.1}"),
            (false, false) => format!("{value:.0e}"),
        }
    };
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.x_labels(x_labels)
        .y_labels(y_labels)
        .x_label_formatter(&power)
        .y_label_formatter(&power)
        .x_desc(x)
        .y_desc(y)
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(in_words)
}

fn series(
    chart: &mut Chart<'_, '_>,
    points: &[(f64, f64)],
    name: &str,
    number: usize,
) -> Result<(), String> {
    let colour = COLOURS[number % COLOURS.len()];
    let line = LineSeries::new(points.iter().copied(), colour.stroke_width(2));
    chart
        .draw_series(line)
        .map_err(in_words)?
        .label(name)
        .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(3)));
    let style = colour.filled();
    match number % 3 {
        0 => chart
            .draw_series(points.iter().map(|&at| Circle::new(at, 4, style)))
            .map_err(in_words)?,
        1 => chart
            .draw_series(points.iter().map(|&at| TriangleMarker::new(at, 5, style)))
            .map_err(in_words)?,
        _ => chart
            .draw_series(
                points
                    .iter()
                    .map(|&at| Cross::new(at, 4, colour.stroke_width(2))),
            )
            .map_err(in_words)?,
    };
    Ok(())
}

fn legend<'a, 'b: 'a>(
    chart: &mut Chart<'a, 'b>,
    position: SeriesLabelPosition,
) -> Result<(), String> {
    chart
        .configure_series_labels()
        .position(position)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.2))
        .label_font(("sans-serif", 13))
        .draw()
        .map_err(in_words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::study::ErrorPoint;

    #[test]
    fn figures_have_a_curve_for_each_series_whatever_the_numbers() {
        let points = |errors: &[(f64, Option<f64>)]| {
            errors
                .iter()
                .map(|&(step, error)| ErrorPoint { step, error })
                .collect()
        };
        let curve = |technique: &str, errors: &[(f64, Option<f64>)]| ErrorCurve {
            technique: technique.into(),
            points: points(errors),
        };
        let svg = error_figure(&[
            curve("forward_difference", &[(1.0, None), (1e-8, Some(1e-8))]),
            curve("complex_step", &[(1e-8, Some(0.0)), (1e-300, Some(2e-16))]),
        ])
        .unwrap();
        assert!(
            svg.contains("forward difference") && svg.contains("(to 1e-300: 2e-16)"),
            "{svg}"
        );
        let cost = |unknowns, wall| CostPoint {
            unknowns,
            direct_operations: 1000 * unknowns as u64,
            adjoint_operations: 2000,
            direct_wall_seconds: wall,
            adjoint_wall_seconds: 0.0,
        };
        for costs in [
            vec![],
            vec![cost(1, 0.0)],
            vec![cost(1, 1e-3), cost(210, 0.1)],
        ] {
            assert!(cost_figure(&costs).unwrap().contains("wall time"));
        }
    }
}
