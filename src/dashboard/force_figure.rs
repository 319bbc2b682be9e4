//! A force that the model does not have, as pictures: over time in each flight, and over what it depends on.

use plotters::prelude::*;

use super::chart::{Area, Margins, axes, extent, faint, in_words, svg};
use super::style::{MEASURED, MODEL};
use crate::diagnose::{ForceCurve, ForceHistory};
use crate::estimate::Role;
use crate::flight::{Shown, shown_in};

const WIDTH: u32 = 900;
/// Height of one flight's panel with the line that names it, and of a curve.
const PANEL: u32 = 180;
const TITLE: u32 = 18;
const CURVE: (u32, u32) = (430, 264);
/// Height of the line that says what is what.
const LEGEND: u32 = 24;

/// Flights drawn, at most; all are in the JSON.
pub(super) const MOST_FLIGHTS: usize = 8;

const MARGINS: Margins = Margins {
    around: 6,
    below: 28,
    left: 68,
};

/// A line with the band around it: x, then least, likely and greatest value.
struct Band {
    x: Vec<f64>,
    lower: Vec<f64>,
    middle: Vec<f64>,
    upper: Vec<f64>,
}

/// The force over the time of each flight, one below the other, all on one scale. `force` is what it is called.
///
/// # Errors
/// The drawing library's words; none is known for finite numbers.
pub(super) fn force_over_time(
    flights: &[ForceHistory],
    (force, unit): (&str, &str),
) -> Result<String, String> {
    let Shown { scale, unit } = shown_in(unit);
    let flights = &flights[..flights.len().min(MOST_FLIGHTS)];
    let bands: Vec<Band> = flights
        .iter()
        .map(|flight| Band {
            x: flight.time.clone(),
            lower: scaled(&flight.lower, scale),
            middle: scaled(&flight.value, scale),
            upper: scaled(&flight.upper, scale),
        })
        .collect();
    let range = range(&bands);
    let label = format!("{force} [{unit}]");
    let height = LEGEND + PANEL * flights.len().max(1) as u32;
    svg((WIDTH, height), |area| {
        let (legend, mut rest) = area.split_vertically(LEGEND);
        key(&legend, MARGINS.left as i32)?;
        for (band, flight) in bands.iter().zip(flights) {
            let (panel, below) = rest.split_vertically(PANEL);
            let (title, panel) = panel.split_vertically(TITLE);
            let told = match flight.role {
                Role::Estimation => flight.segment.clone(),
                _ => format!("{}, not fitted", flight.segment),
            };
            let at = (MARGINS.left as i32 + 12, 4);
            let text = Text::new(told, at, ("sans-serif", 13));
            title.draw(&text).map_err(in_words)?;
            draw(&panel, band, range, ("t [s]", &label))?;
            rest = below;
        }
        Ok(())
    })
}

/// The force over a quantity.
///
/// # Errors
/// As [`force_over_time`].
pub(super) fn force_over_quantity(
    curve: &ForceCurve,
    (quantity, of_quantity): (&str, &str),
    (force, of_force): (&str, &str),
) -> Result<String, String> {
    let (x, y) = (shown_in(of_quantity), shown_in(of_force));
    let band = Band {
        x: scaled(&curve.x, x.scale),
        lower: scaled(&curve.lower, y.scale),
        middle: scaled(&curve.y, y.scale),
        upper: scaled(&curve.upper, y.scale),
    };
    let labels = (
        format!("{quantity} [{}]", x.unit),
        format!("{force} [{}]", y.unit),
    );
    svg(CURVE, |area| {
        let (legend, rest) = area.split_vertically(LEGEND);
        key(&legend, MARGINS.left as i32)?;
        let range = range(std::slice::from_ref(&band));
        draw(&rest, &band, range, (&labels.0, &labels.1))
    })
}

/// What is what, above the panels, where it hides nothing.
fn key(area: &Area<'_>, left: i32) -> Result<(), String> {
    let middle = LEGEND as i32 / 2 + 2;
    let (line, shade) = (left + 12, left + 150);
    let text =
        |text: &'static str, x: i32| Text::new(text, (x + 26, middle - 6), ("sans-serif", 12));
    let stroke = vec![(line, middle), (line + 20, middle)];
    let stroke = PathElement::new(stroke, MODEL.stroke_width(2));
    area.draw(&stroke).map_err(in_words)?;
    area.draw(&text("estimate", line)).map_err(in_words)?;
    let corners = [(shade, middle - 5), (shade + 20, middle + 5)];
    let patch = Rectangle::new(corners, MEASURED.mix(SHADE).filled());
    area.draw(&patch).map_err(in_words)?;
    area.draw(&text("95 % band", shade)).map_err(in_words)
}

/// How dark a band is.
const SHADE: f64 = 0.18;

fn scaled(values: &[f64], scale: f64) -> Vec<f64> {
    values.iter().map(|value| value * scale).collect()
}

/// Of the lines with some room; a band that leaves it is cut off, or it would hide what is known.
fn range(bands: &[Band]) -> (f64, f64) {
    let middle = bands.iter().flat_map(|band| &band.middle).copied();
    let (low, high) = extent(middle).unwrap_or((-1.0, 1.0));
    let half = (0.75 * (high - low)).max(1e-12 + 1e-6 * high.abs());
    let centre = 0.5 * (low + high);
    let edges = bands
        .iter()
        .flat_map(|band| band.lower.iter().chain(&band.upper));
    let (least, most) = extent(edges.copied()).unwrap_or((low, high));
    (least.max(centre - half), most.min(centre + half))
}

fn draw(
    area: &Area<'_>,
    band: &Band,
    (low, high): (f64, f64),
    (below, beside): (&str, &str),
) -> Result<(), String> {
    let (first, last) = extent(band.x.iter().copied()).unwrap_or((0.0, 1.0));
    let mut chart = axes(area, (first, last.max(first + 1e-9)), (low, high), &MARGINS)?;
    let mut mesh = chart.configure_mesh();
    faint(&mut mesh);
    mesh.y_labels(4)
        .x_desc(below)
        .y_desc(beside)
        .label_style(("sans-serif", 12))
        .draw()
        .map_err(in_words)?;
    let inside = |(x, y): (&f64, &f64)| (*x, y.clamp(low, high));
    let upper = band.x.iter().zip(&band.upper).map(inside);
    let lower = band.x.iter().zip(&band.lower).map(inside).rev();
    let outline: Vec<(f64, f64)> = upper.chain(lower).collect();
    let shade = Polygon::new(outline, MEASURED.mix(SHADE).filled());
    chart
        .draw_series(std::iter::once(shade))
        .map_err(in_words)?;
    let zero = vec![(first, 0.0), (last, 0.0)];
    if (low..=high).contains(&0.0) {
        let line = PathElement::new(zero, BLACK.mix(0.4).stroke_width(1));
        chart.draw_series(std::iter::once(line)).map_err(in_words)?;
    }
    let line = band.x.iter().copied().zip(band.middle.iter().copied());
    let line = LineSeries::new(line, MODEL.stroke_width(2));
    chart.draw_series(line).map_err(in_words)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_force_is_drawn_for_each_flight_and_over_what_it_depends_on() {
        let flight = |segment: &str| ForceHistory {
            segment: segment.into(),
            role: Role::Estimation,
            time: vec![0.0, 1.0, 2.0],
            value: vec![0.0, 0.1, 0.0],
            lower: vec![-0.1, 0.0, -9.0],
            upper: vec![0.1, 0.2, 9.0],
        };
        let held_out = ForceHistory {
            role: Role::Validation,
            ..flight("B")
        };
        let force = ("force in q", "rad/s^2");
        let svg = force_over_time(&[flight("A"), held_out], force).unwrap();
        assert!(svg.contains("force in q [deg/s^2]") && svg.contains("B, not fitted"));
        let many = vec![flight("A"); 100];
        let svg = force_over_time(&many, force).unwrap();
        assert_eq!(svg.matches("force in q").count(), MOST_FLIGHTS);
        let curve = ForceCurve {
            x: vec![0.0, 0.1],
            y: vec![0.0, 0.2],
            lower: vec![-0.1, 0.1],
            upper: vec![0.1, 0.3],
        };
        let svg = force_over_quantity(&curve, ("alpha", "rad"), ("force in q", "rad/s^2")).unwrap();
        assert!(svg.contains("alpha [deg]") && svg.contains("force in q [deg/s^2]"));
    }

    #[test]
    fn a_wide_band_does_not_flatten_the_line() {
        let band = Band {
            x: vec![0.0, 1.0],
            lower: vec![-100.0, -1.0],
            middle: vec![-1.0, 1.0],
            upper: vec![100.0, 1.2],
        };
        assert_eq!(range(&[band]), (-1.5, 1.5));
    }
}
