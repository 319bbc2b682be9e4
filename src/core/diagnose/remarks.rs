//! What a reader of the answer should know beside the verdict.

use super::case::Case;
use super::lines::{Line, lines};
use super::report::FitChange;
use super::share_left::share_left;
use super::unmodelled::Unmodelled;
use crate::estimate::{Estimate, Role, Solution, TimeHistory, five_digits};
use crate::flight::{Shown, shown_in};

/// A model that leaves more than this share of an output's variance does not describe it.
const UNEXPLAINED: f64 = 0.5;

/// On the answer with these errors before and after, and on the last fit.
pub(super) fn of(case: &Case, fits: &[FitChange], last: &Solution) -> Vec<String> {
    let mut remarks = on_predictions(case, fits);
    remarks.extend(unexplained(&last.histories));
    remarks.extend(lines(&last.histories).iter().map(swings));
    remarks.extend(held_noise(&last.estimate));
    remarks
}

fn on_predictions(case: &Case, fits: &[FitChange]) -> Vec<String> {
    let mut remarks = Vec::new();
    if case.of_role(Role::Validation).next().is_none() {
        remarks.push(
            "no flight was left out of the fit: give one the role \"validation\" to see whether the effects predict it"
                .to_string(),
        );
    }
    for fit in fits
        .iter()
        .filter(|fit| fit.role != Role::Estimation && fit.after.rms > 1.02 * fit.before.rms)
    {
        let segment = fit.segment.as_deref().unwrap_or_default();
        let Shown { scale, unit } = shown_in(&fit.after.unit);
        remarks.push(format!(
            "{} of {segment} is predicted worse than before: RMS error {} instead of {} {unit}",
            fit.after.name,
            five_digits(fit.after.rms * scale),
            five_digits(fit.before.rms * scale)
        ));
    }
    remarks
}

/// Process noise that was told from coloured errors of measuring, which no estimator does.
fn held_noise(estimate: &Estimate) -> Option<String> {
    let noises = estimate.filter.iter().flat_map(|f| &f.process_noise);
    let held: Vec<&str> = (noises.filter(|noise| noise.fixed && noise.estimate > 0.0))
        .map(|noise| noise.state.as_str())
        .collect();
    (!held.is_empty()).then(|| {
        format!(
            "errors of measuring are coloured, which the filter-error method does not know: the process noise of {} is held where innovations are likeliest with their colour, and has no error bound",
            held.join(", ")
        )
    })
}

fn swings(line: &Line) -> String {
    let Shown { scale, unit } = shown_in(&line.unit);
    format!(
        "what is left of {} swings at {:.1} Hz by {} {unit}, and no input does: a vibration of the structure or of the sensor's mount, which is in no catalogue; filter all channels alike below that frequency",
        line.output,
        line.frequency,
        five_digits(line.amplitude * scale)
    )
}

/// A force that is more than white noise makes, and no more than slow noise may.
pub(super) fn of_force(force: &Unmodelled) -> String {
    format!(
        "what is left may hold a force in the equation of {}: it explains more than white noise would (2 ln L = {:.0}, where noise comes to {:.0} once in a thousand diagnoses), but slow noise of an instrument explains as much; another maneuver that moves it more would decide",
        force.equation, force.likelihood_ratio, force.threshold
    )
}

/// Outputs that the model hardly explains: its residual is most of what is recorded, though its errors may look like noise.
fn unexplained(histories: &[TimeHistory]) -> Vec<String> {
    let outputs = histories.first().map_or(0, |history| history.outputs.len());
    let of = |output: usize| {
        let series = histories.iter().map(|history| &history.outputs[output]);
        let share = share_left(series.map(|s| (&*s.measured, &*s.residual)))?;
        let name = &histories[0].outputs[output].name;
        let how_much = match share {
            1.0.. => format!("explains no more of {name} than its mean does"),
            _ => format!("leaves {:.0} % of the variance of {name}", 100.0 * share),
        };
        (share > UNEXPLAINED).then(|| {
            format!(
                "the model {how_much}: either that channel hardly moves beside its noise, or it is not what the model takes it for (its name, sign or unit)"
            )
        })
    };
    (0..outputs).filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::OutputSeries;

    #[test]
    fn what_a_model_hardly_explains_is_told() {
        let told = |residual: f64| {
            let output = OutputSeries {
                name: "p".into(),
                unit: "rad/s".into(),
                measured: vec![-1.0, 1.0],
                model: vec![0.0; 2],
                declared: Vec::new(),
                residual: vec![-residual, residual],
            };
            let history = TimeHistory {
                segment: "1".into(),
                role: Role::Estimation,
                time: vec![0.0, 0.1],
                inputs: Vec::new(),
                outputs: vec![output],
            };
            unexplained(&[history]).join("; ")
        };
        assert_eq!(told(0.7), "");
        assert!(told(0.9).contains("leaves 81 % of the variance of p"));
        assert!(told(7.0).contains("explains no more of p than its mean does"));
        assert_eq!(unexplained(&[]), Vec::<String>::new());
    }
}
