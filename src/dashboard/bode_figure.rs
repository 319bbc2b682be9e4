//! A frequency response as a picture: magnitude above, phase below, each with its band of 2 standard errors.

use plotters::prelude::*;

use super::chart::{Area, Margins, axes, extent, faint, in_words, svg};
use super::style::MODEL;
use crate::dynamics::FrequencyResponse;

const SIZE: (u32, u32) = (620, 420);
/// Height of the panel of the magnitude.
const ABOVE: u32 = 205;

const MARGINS: Margins = Margins {
    around: 8,
    below: 34,
    left: 60,
};

/// Wider bands than this on both sides are cut, dB or degrees: they would leave nothing of the curve.
const WIDEST: f64 = 180.0;

/// Magnitude and phase over frequency, as SVG.
///
/// # Errors
/// The drawing library's words; none is known for finite numbers.
pub fn bode_svg(response: &FrequencyResponse) -> Result<String, String> {
    let x: Vec<f64> = response.frequency.iter().map(|f| f.log10()).collect();
    svg(SIZE, |area| {
        let (above, below) = area.split_vertically(ABOVE);
        let magnitude = Curve {
            values: &response.magnitude_db,
            errors: &response.magnitude_db_standard_error,
            label: format!("magnitude, dB of {}", response.unit),
        };
        magnitude.draw(&x, "", &above)?;
        let phase = Curve {
            values: &response.phase_deg,
            errors: &response.phase_deg_standard_error,
            label: "phase, deg".to_string(),
        };
        let frequency = format!("frequency, {}", response.frequency_unit.symbol());
        phase.draw(&x, &frequency, &below)
    })
}

/// One of the two curves.
struct Curve<'a> {
    values: &'a [f64],
    /// Empty where there are none.
    errors: &'a [f64],
    label: String,
}

impl Curve<'_> {
    fn draw(&self, x: &[f64], frequency: &str, area: &Area<'_>) -> Result<(), String> {
        let edge = |sign: f64| -> Vec<(f64, f64)> {
            let errors = self.errors.iter().zip(self.values).zip(x);
            errors
                .map(|((error, value), &x)| (x, value + sign * (2.0 * error).min(WIDEST)))
                .collect()
        };
        let (upper, lower) = (edge(1.0), edge(-1.0));
        let line: Vec<(f64, f64)> = x.iter().copied().zip(self.values.iter().copied()).collect();
        let all = upper.iter().chain(&lower).chain(&line);
        let (low, high) = extent(all.map(|point| point.1)).unwrap_or((-1.0, 1.0));
        let room = (0.05 * (high - low)).max(1.0);
        let (first, last) = extent(x.iter().copied()).unwrap_or((0.0, 1.0));
        let over = (first, last.max(first + 1e-9));
        let mut chart = axes(area, over, (low - room, high + room), &MARGINS)?;
        let decimal = |exponent: &f64| plain(10_f64.powf(*exponent));
        let mut mesh = chart.configure_mesh();
        faint(&mut mesh);
        mesh.x_labels(7)
            .y_labels(6)
            .x_label_formatter(&decimal)
            .x_desc(frequency)
            .y_desc(self.label.clone())
            .label_style(("sans-serif", 12))
            .draw()
            .map_err(in_words)?;
        if !upper.is_empty() {
            let around = upper.into_iter().chain(lower.into_iter().rev());
            let band = Polygon::new(around.collect::<Vec<_>>(), MODEL.mix(0.25));
            chart.draw_series([band]).map_err(in_words)?;
        }
        let line = LineSeries::new(line, MODEL.stroke_width(2));
        chart.draw_series(line).map_err(in_words)?;
        Ok(())
    }
}

/// Two digits, as an axis has them.
fn plain(value: f64) -> String {
    match value {
        0.01..1000.0 => {
            let digits = (1.0 - value.log10().floor()).max(0.0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::FrequencyUnit;

    #[test]
    fn a_band_is_drawn_where_there_are_errors() {
        let mut response = FrequencyResponse {
            input: "de".into(),
            output: "q".into(),
            unit: "(rad/s)/rad".into(),
            frequency_unit: FrequencyUnit::Hertz,
            frequency: vec![0.1, 1.0, 10.0],
            magnitude_db: vec![6.0, 9.0, -10.0],
            magnitude_db_standard_error: vec![0.1, 0.2, 0.5],
            phase_deg: vec![-10.0, -60.0, -200.0],
            phase_deg_standard_error: vec![1.0, 1.0, 2.0],
        };
        let drawn = bode_svg(&response).expect("a picture");
        assert!(
            drawn.contains("frequency, Hz") && drawn.contains("<polygon"),
            "{drawn}"
        );
        response.magnitude_db_standard_error.clear();
        response.phase_deg_standard_error.clear();
        assert!(!bode_svg(&response).expect("a picture").contains("<polygon"));
        // nothing to draw is an empty picture
        response.frequency.clear();
        response.magnitude_db.clear();
        response.phase_deg.clear();
        assert!(bode_svg(&response).is_ok());
    }

    #[test]
    fn labels_have_the_digits_they_need() {
        assert_eq!(
            [0.02, 0.5, 2.5, 31.0, 0.002].map(plain),
            ["0.020", "0.50", "2.5", "31", "2e-3"]
        );
    }
}
