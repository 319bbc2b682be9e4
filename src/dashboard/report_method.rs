//! How the numbers of a report were estimated: what was used of the job's options, and the noise that was found.

use maud::{Markup, html};
use serde::Serialize;

use super::report_basis::{plain, word, words};
use crate::estimate::{Derivatives, Estimate, Estimator, Noise, Options, five_digits as number};
use crate::flight::shown_in;
use crate::job::JobSpec;

/// Estimator, integration, noise, bounds: the options that the job used, defaults included.
pub(super) fn method(spec: &JobSpec, estimate: Option<&Estimate>) -> Markup {
    let options = &spec.options;
    let bounds = match estimate {
        Some(estimate) => estimate.error_bounds,
        None => Some(options.error_bounds),
    };
    html! {
        h2 id="method" { "Method" }
        dl.facts {
            @if let Some(structure) = &spec.structure { dt { "terms" } dd { (structure.words()) } }
            dt { "estimator" } dd { (words(options.estimator.name())) @if spec.structure.is_some() { ", of the parameters of the terms that were chosen" } }
            @if let Some(start) = start(spec) { dt { "start" } dd { (start) } }
            dt { "optimiser" } dd { (optimiser(options)) }
            dt { "convergence" } dd { "a further step below " (plain(&options.tolerance)) " standard errors; at most " (options.max_iterations) " iterations" }
            (integration(options, estimate))
            dt { "measurement noise" } dd { (noise(&options.noise)) }
            @if let Some(kind) = bounds { dt { "standard errors" } dd { (word(&kind)) } }
            @if !options.process_noise.is_empty() { dt { "process noise" } dd { code { (plain(&options.process_noise)) } } }
            @if let Some(band) = &options.frequency { dt { "frequencies" } dd { code { (plain(band)) } } }
        }
        @if let Some(estimate) = estimate { (noise_table(estimate)) }
    }
}

/// Where the estimator began, of those that look for a start.
fn start(spec: &JobSpec) -> Option<String> {
    let start = words(&kind(&spec.options.start));
    match spec.options.estimator {
        Estimator::OutputError if spec.structure.is_some() => Some(format!(
            "{start}, the start values being those of the regression"
        )),
        Estimator::OutputError | Estimator::OutputErrorFrequency => Some(start),
        Estimator::FilterError | Estimator::EquationError | Estimator::EquationErrorFrequency => {
            None
        }
    }
}

/// How steps were made, and from which derivatives where these can be chosen.
fn optimiser(options: &Options) -> String {
    let method = word(&options.method);
    let derivatives = words(&kind(&options.derivatives));
    match (options.estimator, options.derivatives) {
        (Estimator::OutputError, Derivatives::Adjoint { .. }) => {
            format!("quasi-Newton (BFGS), {derivatives}")
        }
        // its residuals have no adjoint of their own
        (Estimator::EquationError, Derivatives::Adjoint { .. }) => {
            format!("{method}, forward sensitivities")
        }
        (Estimator::OutputError | Estimator::EquationError, _) => {
            format!("{method}, {derivatives}")
        }
        _ => method,
    }
}

/// How the model was stepped through time, where it was, and what its inputs did between samples.
fn integration(options: &Options, estimate: Option<&Estimate>) -> Markup {
    let estimator = options.estimator;
    let found = estimate.and_then(|estimate| estimate.integration.as_ref());
    let may_step = matches!(estimator, Estimator::OutputError | Estimator::FilterError);
    let steps = found.is_some() || (estimate.is_none() && may_step);
    // transforms and derivatives are taken of inputs as they are between samples
    let has_inputs_between =
        steps || estimator.is_equation_error() || estimator.is_in_frequency_domain();
    html! {
        @if steps {
            dt { "integrator" } dd { (word(&options.integrator)) ", steps between samples: " (word(&options.steps_per_sample))
                @if let Some(found) = found {
                    " (" (found.most_steps()) " used"
                    @if let Some(halved) = &found.halved { "; halving the steps moves no estimate by more than " (number(halved.most)) " standard errors" }
                    ")"
                }
            }
        }
        @if has_inputs_between { dt { "inputs between samples" } dd { (word(&options.input_interpolation)) } }
    }
}

fn noise(noise: &Noise) -> &'static str {
    match noise {
        Noise::Given { .. } => "known, from the job",
        estimated if estimated.is_full() => {
            "estimated with the parameters, correlated between outputs"
        }
        _ => "estimated with the parameters, independent between outputs",
    }
}

/// Standard deviations of the noise, and correlations where there are any.
fn noise_table(estimate: &Estimate) -> Markup {
    let r = &estimate.noise_covariance;
    let sd = |at: usize| {
        r.get(at)
            .and_then(|row| row.get(at))
            .map_or(f64::NAN, |variance| variance.sqrt())
    };
    let correlation = |i: usize, j: usize| {
        r.get(i)
            .and_then(|row| row.get(j))
            .map(|c| c / (sd(i) * sd(j)))
    };
    let is_full = (0..r.len()).any(|i| (0..i).any(|j| correlation(i, j).is_some_and(|c| c != 0.0)));
    html! {
        @if r.len() == estimate.outputs.len() && !r.is_empty() {
            h3 id="noise" { "Noise of the outputs" }
            div.scroll tabindex="0" role="region" aria-labelledby="noise" { table {
                thead { tr {
                    th scope="col" { "output" } th scope="col" { "unit" } th.number scope="col" { "standard deviation" }
                    @if is_full { @for output in &estimate.outputs { th.number scope="col" { "correlation with " (output.name) } } }
                } }
                tbody { @for (at, output) in estimate.outputs.iter().enumerate() {
                    @let shown = shown_in(&output.unit);
                    tr {
                        th scope="row" { (output.name) } td.soft { (shown.unit) } td.number { (number(sd(at) * shown.scale)) }
                        @if is_full { @for other in 0..r.len() { td.number { @if let Some(c) = correlation(at, other) { (format!("{c:.2}")) } } } }
                    }
                } }
            } }
        }
    }
}

/// The kind of an option that has more to say; where it has, all of it follows.
fn kind(option: &impl Serialize) -> String {
    let Ok(serde_json::Value::Object(mut fields)) = serde_json::to_value(option) else {
        return plain(option);
    };
    let names = ["kind", "technique"];
    let name = names.iter().find_map(|name| fields.remove(*name));
    let name = name.map_or_else(String::new, |name| plain(&name));
    let rest: Vec<String> = (fields.iter().filter(|(_, value)| !value.is_null()))
        .map(|(field, value)| format!("{field} {}", plain(value)))
        .collect();
    if rest.is_empty() {
        name
    } else {
        format!("{name} ({})", rest.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// What a report says of the options, before there is an estimate: terms and what is said of them.
    fn said(job: serde_json::Value) -> Vec<(String, String)> {
        let mut whole = json!({"model": "short-period", "maneuvers": [{"id": "0"}]});
        let fields = job.as_object().expect("fields").clone();
        whole.as_object_mut().expect("fields").extend(fields);
        let spec: JobSpec = serde_json::from_value(whole).expect("a job");
        let page = method(&spec, None).into_string();
        let pair = |text: &str| -> (String, String) {
            let (term, rest) = text.split_once("</dt>").expect("a term");
            let (_, said) = rest.split_once("<dd>").expect("what is said");
            (
                term.into(),
                said.split("</dd>").next().unwrap_or_default().into(),
            )
        };
        page.split("<dt>").skip(1).map(pair).collect()
    }

    fn of(said: &[(String, String)], term: &str) -> Option<String> {
        let found = said.iter().find(|(name, _)| name == term);
        found.map(|(_, said)| said.clone())
    }

    #[test]
    fn only_what_was_used_is_said() {
        let output_error = said(json!({}));
        assert_eq!(of(&output_error, "start").as_deref(), Some("automatic"));
        assert_eq!(
            of(&output_error, "optimiser").as_deref(),
            Some("levenberg marquardt, forward sensitivities")
        );
        assert!(of(&output_error, "integrator").is_some());
        let adjoint = said(json!({"options": {"derivatives": {"technique": "adjoint"}}}));
        let optimiser = of(&adjoint, "optimiser").expect("an optimiser");
        assert!(
            optimiser.starts_with("quasi-Newton (BFGS), adjoint"),
            "{optimiser}"
        );
        for (estimator, starts, derives) in [
            ("equation_error", false, true),
            ("output_error_frequency", true, false),
            ("equation_error_frequency", false, false),
        ] {
            let said = said(
                json!({"options": {"estimator": estimator, "frequency": {"band_hz": [0.1, 2.0]}}}),
            );
            assert_eq!(of(&said, "integrator"), None, "{estimator}");
            assert_eq!(of(&said, "start").is_some(), starts, "{estimator}");
            let optimiser = of(&said, "optimiser").expect("an optimiser");
            assert_eq!(
                optimiser.contains("sensitivities"),
                derives,
                "{estimator}: {optimiser}"
            );
            assert!(of(&said, "inputs between samples").is_some(), "{estimator}");
        }
        let filter_error = said(json!({"options": {"estimator": "filter_error"}}));
        assert_eq!(of(&filter_error, "start"), None);
        assert_eq!(
            of(&filter_error, "optimiser").as_deref(),
            Some("levenberg marquardt")
        );
    }
}
