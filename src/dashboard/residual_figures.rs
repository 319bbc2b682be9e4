//! What is left over, as pictures: autocorrelation with its band, and spectrum, of each output.

use maud::{Markup, html};

use crate::diagnose::{ResidualAnalysis, SpectralLine};
use crate::estimate::five_digits as number;
use crate::flight::{Shown, p_value, shown_in};

const WIDTH: f64 = 420.0;
const HEIGHT: f64 = 150.0;
const LEFT: f64 = 46.0;
const BOTTOM: f64 = 30.0;

/// A residual that noise alone would make less often than this is not called white.
const RARE: f64 = 0.01;

/// One section for each output.
pub(super) fn residual_figures(outputs: &[ResidualAnalysis]) -> Markup {
    html! {
        @for output in outputs {
            @let Shown { scale, unit } = shown_in(&output.unit);
            section.whole {
                h3 { (output.output) }
                p.soft {
                    "rms " (number(output.rms * scale)) " " (unit) "; "
                    @if output.portmanteau.probability < RARE { "not white: noise alone would hardly be like this" }
                    @else { "as white noise would be" }
                    " (Ljung and Box, " (p_value(output.portmanteau.probability)) ")"
                }
                div.columns {
                    figure.paper { (autocorrelation(output)) }
                    figure.paper { (spectrum(output, scale, &unit)) }
                }
            }
        }
    }
}

fn autocorrelation(output: &ResidualAnalysis) -> Markup {
    let lags = output.autocorrelation.len().max(2);
    let lowest = output
        .autocorrelation
        .iter()
        .fold(-0.2, |low: f64, &value| low.min(value));
    let x = |lag: f64| LEFT + lag / (lags - 1) as f64 * (WIDTH - LEFT - 10.0);
    let y = |value: f64| 8.0 + (1.0 - value) / (1.0 - lowest) * (HEIGHT - BOTTOM - 8.0);
    let band = output.band.min(1.0);
    html! {
        svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label={ "autocorrelation of the residual of " (output.output) } font-size="11" fill="#1a2027" {
            rect x=(LEFT) width=(WIDTH - LEFT - 10.0) y=(y(band)) height=(y(-band) - y(band)) fill="#8a8f94" opacity=".25" {}
            line x1=(LEFT) x2=(WIDTH - 10.0) y1=(y(0.0)) y2=(y(0.0)) stroke="#56616d" {}
            @for (lag, value) in output.autocorrelation.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                line x1=(round(x(lag as f64))) x2=(round(x(lag as f64))) y1=(round(y(0.0))) y2=(round(y(*value))) stroke="#0072b2" stroke-width="3" {}
            }
            @for tick in [0.0, 0.5, 1.0] { text x=(LEFT - 6.0) y=(y(tick) + 4.0) text-anchor="end" { (tick) } }
            text x=(WIDTH / 2.0) y=(HEIGHT - 6.0) text-anchor="middle" { "autocorrelation, lags 0 to " (lags - 1) }
        }
    }
}

fn spectrum(output: &ResidualAnalysis, scale: f64, unit: &str) -> Markup {
    let shown: Vec<&SpectralLine> = (output.spectrum.iter())
        .filter(|line| line.density > 0.0 && line.density.is_finite())
        .collect();
    let decades = |line: &SpectralLine| (line.density * scale * scale).log10();
    let low = shown
        .iter()
        .map(|line| decades(line))
        .fold(f64::INFINITY, f64::min)
        .floor();
    let high = shown
        .iter()
        .map(|line| decades(line))
        .fold(f64::NEG_INFINITY, f64::max)
        .ceil()
        .max(low + 1.0);
    let most = shown.last().map_or(1.0, |line| line.frequency);
    let x = |frequency: f64| LEFT + frequency / most * (WIDTH - LEFT - 10.0);
    let y = |decade: f64| 8.0 + (high - decade) / (high - low) * (HEIGHT - BOTTOM - 8.0);
    let points: Vec<String> = (shown.iter())
        .map(|line| format!("{:.1},{:.1}", x(line.frequency), y(decades(line))))
        .collect();
    html! {
        svg viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label={ "spectrum of the residual of " (output.output) } font-size="11" fill="#1a2027" {
            @if !shown.is_empty() {
                line x1=(LEFT) x2=(WIDTH - 10.0) y1=(y(low)) y2=(y(low)) stroke="#56616d" {}
                polyline points=(points.join(" ")) fill="none" stroke="#0072b2" stroke-width="1.5" {}
                @for decade in [low, high] { text x=(LEFT - 6.0) y=(y(decade) + 4.0) text-anchor="end" { "1e" (decade) } }
                text x=(WIDTH / 2.0) y=(HEIGHT - 6.0) text-anchor="middle" { "density, (" (unit) ")²/Hz, from 0 to " (number(most)) " Hz" }
            }
        }
    }
}

fn round(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}
