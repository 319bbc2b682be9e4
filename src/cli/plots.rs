//! Measured and model over time as small plots in the terminal, made of braille dots.

use std::io::IsTerminal;

use textplots::{Chart, ColorPlot, Shape};

use super::Failure;
use super::client::Client;
use crate::estimate::{OutputSeries, TimeHistory};
use crate::flight::{Shown, shown_in};

/// Dots across; two make a column.
const WIDTH: u32 = 140;
/// Dots up; four make a line.
const HEIGHT: u32 = 24;

/// Blue for what was measured, orange for the model, as in all figures.
const MEASURED: (u8, u8, u8) = (86, 180, 233);
const MODEL: (u8, u8, u8) = (230, 140, 30);

/// Shows the flights of a job, to who sits before a terminal: in a file the colours would be gone, and with them what is what.
pub(super) async fn show(client: &Client, job: &str) -> Result<(), Failure> {
    if std::io::stdout().is_terminal() {
        for history in client.histories(job, WIDTH as usize * 4).await? {
            println!("{}", flight(&history));
        }
    }
    Ok(())
}

/// All outputs of a flight.
fn flight(history: &TimeHistory) -> String {
    let mut text = format!("{}: measured blue, model orange\n", history.segment);
    for output in &history.outputs {
        text.push_str(&plot(&history.time, output));
    }
    text
}

fn plot(time: &[f64], output: &OutputSeries) -> String {
    let Shown { scale, unit } = shown_in(&output.unit);
    let points = |values: &[f64]| -> Vec<(f32, f32)> {
        let pairs = time.iter().zip(values);
        pairs
            .filter(|(_, value)| value.is_finite())
            .map(|(&t, &value)| (t as f32, (value * scale) as f32))
            .collect()
    };
    let (measured, model) = (points(&output.measured), points(&output.model));
    let all = || measured.iter().chain(&model);
    let low = all().map(|point| point.1).fold(f32::INFINITY, f32::min);
    let high = all().map(|point| point.1).fold(f32::NEG_INFINITY, f32::max);
    let (Some(first), Some(last)) = (time.first(), time.last()) else {
        return String::new();
    };
    if low > high {
        return format!("{} [{unit}]: nothing was measured\n", output.name);
    }
    // a range of nothing cannot be drawn in
    let margin = ((high - low) * 0.05)
        .max(f32::EPSILON * high.abs())
        .max(f32::MIN_POSITIVE);
    let (low, high) = (low - margin, high + margin);
    let shapes = [Shape::Points(&measured), Shape::Lines(&model)];
    let mut chart = Chart::new_with_y_range(WIDTH, HEIGHT, *first as f32, *last as f32, low, high);
    let chart = chart
        .linecolorplot(&shapes[0], MEASURED.into())
        .linecolorplot(&shapes[1], MODEL.into());
    chart.figures();
    format!(
        "{} [{unit}], {low:.3} to {high:.3}, {first} to {last} s\n{}\n",
        output.name,
        chart.frame()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Role;

    #[test]
    fn what_was_measured_is_seen_whatever_it_is() {
        let of = |measured: Vec<f64>| TimeHistory {
            segment: "run".into(),
            role: Role::Estimation,
            time: vec![0.0, 1.0, 2.0],
            inputs: Vec::new(),
            outputs: vec![OutputSeries {
                name: "alpha".into(),
                unit: "rad".into(),
                model: measured.clone(),
                measured,
                declared: Vec::new(),
                residual: vec![0.0; 3],
            }],
        };
        let text = flight(&of(vec![0.0, 0.1, 0.0]));
        assert!(
            text.contains("alpha [deg], -0.286 to 6.016, 0 to 2 s"),
            "{text}"
        );
        let dots = |text: &str| {
            text.chars()
                .filter(|c| ('\u{2801}'..='\u{28ff}').contains(c))
                .count()
        };
        assert!(dots(&text) > 50, "{text}");
        // constant, zero, and missing
        for measured in [vec![1.0; 3], vec![0.0; 3], vec![f64::NAN, 1e300, 2.0]] {
            assert!(dots(&flight(&of(measured))) > 0);
        }
        let text = flight(&of(vec![f64::NAN; 3]));
        assert!(text.contains("nothing was measured"), "{text}");
    }
}
