//! An estimate in tables: parameters, process noise, fit of each output, modes.

use maud::{Markup, html};

use super::intervals::intervals;
use crate::estimate::{Estimate, FilterEstimate, Measure, Mode, OutputFit, five_digits as number};
use crate::flight::{Shown, bounded, decimals, five_digits_beside, shown_in, two_digits};

/// Parameters, process noise and the fit of each output, under headings. Below the first and the last
/// heading stands where the numbers come from, if that is said.
pub(super) fn tables(estimate: &Estimate, [of_parameters, of_fit]: [&Markup; 2]) -> Markup {
    html! {
        h2 id="parameters" { "Parameters" }
        (of_parameters)
        div.scroll tabindex="0" role="region" aria-labelledby="parameters" { (parameter_table(estimate)) }
        @if let Some(found) = &estimate.confidence_intervals { (intervals(found)) }
        @if let Some(filter) = &estimate.filter {
            h2 id="process-noise" { "Process noise" }
            div.scroll tabindex="0" role="region" aria-labelledby="process-noise" { (process_noise_table(filter)) }
        }
        h2 id="fit" { "Fit" }
        (of_fit)
        div.scroll tabindex="0" role="region" aria-labelledby="fit" { (output_table(&estimate.outputs)) }
        @for prediction in &estimate.prediction {
            h3 { "Prediction of " (prediction.segment) }
            p { (prediction.reason) }
            div.scroll tabindex="0" role="region" aria-label={ "prediction of " (prediction.segment) } { (output_table(&prediction.outputs)) }
        }
    }
}

fn parameter_table(estimate: &Estimate) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "parameter" } th scope="col" { "unit" } th.number scope="col" { "start" } th.number scope="col" { "estimate" }
                th.number scope="col" { "standard error" } th.number scope="col" { "if residuals were white" } th scope="col" { "remark" }
            } }
            tbody {
                @for parameter in &estimate.parameters {
                    @let Shown { scale, unit } = shown_in(&parameter.unit);
                    tr {
                        th scope="row" { (parameter.name) @if let Some(segment) = &parameter.segment { " [" (segment) "]" } }
                        td.soft { (unit) }
                        td.number.soft { (number(parameter.start * scale)) }
                        @for cell in bounded(parameter.estimate * scale, parameter.standard_error.map(|error| error * scale)) { td.number { (cell) } }
                        td.number.soft { @if let Some(error) = parameter.conventional_standard_error { (two_digits(error * scale)) } }
                        td.soft { (estimate.remark(parameter)) }
                    }
                }
            }
        }
    }
}

fn process_noise_table(filter: &FilterEstimate) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "state" } th scope="col" { "unit" } th.number scope="col" { "start" } th.number scope="col" { "intensity" }
                th.number scope="col" { "standard error" } th scope="col" { "remark" }
            } }
            tbody {
                @for noise in &filter.process_noise {
                    tr {
                        th scope="row" { (noise.state) } td.soft { (noise.unit) }
                        td.number.soft { (number(noise.start)) }
                        @for cell in bounded(noise.estimate, noise.standard_error) { td.number { (cell) } }
                        td.soft { (noise.remark()) }
                    }
                }
            }
        }
        p.soft { "Outputs are predicted from sample to sample by a Kalman filter; residuals are innovations." }
    }
}

fn output_table(outputs: &[OutputFit]) -> Markup {
    html! {
        table {
            thead { tr {
                th scope="col" { "output" } th scope="col" { "unit" } th.number scope="col" { "rms residual" } th.number scope="col" { "mean residual" }
                th.number scope="col" { "R²" } th.number scope="col" { "Theil" } th.number scope="col" { "of which bias" } th.number scope="col" { "variance" } th.number scope="col" { "covariance" }
                th.number scope="col" { "lag-1 autocorrelation" } th.number scope="col" { "effective samples" }
            } }
            tbody {
                @for output in outputs {
                    @let Shown { scale, unit } = shown_in(&output.unit);
                    tr {
                        th scope="row" { (output.name) } td.soft { (unit) }
                        td.number { (number(output.rms * scale)) } td.number { (five_digits_beside(output.bias * scale, output.rms * scale)) }
                        td.number { (format!("{:.4}", output.r_squared)) } td.number { (format!("{:.4}", output.theil)) }
                        @let shares = output.theil_shares;
                        @for share in [shares.bias, shares.variance, shares.covariance] {
                            td.number.soft { (format!("{share:.2}")) }
                        }
                        td.number { (decimals(output.autocorrelation, 2)) }
                        td.number { (format!("{:.0}", output.effective_samples)) }
                    }
                }
            }
        }
    }
}

pub(super) fn mode_table(modes: &[Mode]) -> Markup {
    let text = |measure: Option<Measure>| measure.map(|m| m.to_string()).unwrap_or_default();
    html! {
        table {
            thead { tr {
                th scope="col" { "mode" } th.number scope="col" { "eigenvalue, 1/s" } th.number scope="col" { "frequency, rad/s" } th.number scope="col" { "damping ratio" }
                th.number scope="col" { "period, s" } th.number scope="col" { "time constant, s" } th.number scope="col" { "to half, s" } th.number scope="col" { "to double, s" } th scope="col" { "remark" }
            } }
            tbody {
                @for mode in modes {
                    tr {
                        th scope="row" { (mode.label()) } td.number { (mode.eigenvalue()) }
                        td.number { (text(mode.natural_frequency)) } td.number { (mode.damping()) }
                        td.number { (text(mode.period)) } td.number { (text(mode.time_constant)) }
                        td.number { (text(mode.time_to_half)) } td.number { (text(mode.time_to_double)) }
                        td.soft { (mode.remark) }
                    }
                }
            }
        }
    }
}
