//! `trimtab diagnose`: what a model lacks, here and now.

use std::ops::ControlFlow;
use std::path::PathBuf;

use super::progress::ProgressLine;
use super::request::Request;
use super::table::{self, bordered};
use super::{Failure, figures, notes};
use crate::dashboard::{force_svg, history_svg};
use crate::diagnose::{Diagnosis, FitChange, Refusal};
use crate::estimate::{Role, TimeHistory, five_digits};
use crate::job::{self, JobKind};

/// Fits a model, finds what it lacks, adds that, and shows the error before and after.
#[derive(clap::Args, Debug)]
pub(super) struct Diagnose {
    #[command(flatten)]
    request: Request,
    /// Show every candidate that was refused, with the reason.
    #[arg(long, conflicts_with = "json")]
    all: bool,
    /// Write a picture of each segment to this directory: measured, declared model and model with its effects; and one of the
    /// unmodelled force, where something is left.
    #[arg(long, value_name = "DIRECTORY")]
    figures: Option<PathBuf>,
    /// Print the whole result as JSON instead.
    #[arg(long)]
    json: bool,
}

impl Diagnose {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let plan = self.request.plan(JobKind::Diagnose)?;
        let progress = ProgressLine::new(self.request.tolerance);
        let result = job::run_diagnosis(&plan, &mut |step| {
            if let Some(step) = step {
                progress.diagnosis(step);
            }
            ControlFlow::Continue(())
        })
        .map_err(|faults| {
            notes::say(&plan.prepared.findings);
            Failure::faults("the job failed", &faults)
        })?;
        let Some(diagnosis) = &result.diagnosis else {
            return Err(Failure::new(result.estimate.reason));
        };
        progress.finish(diagnosis.verdict.name());
        if self.json {
            notes::say(&result.estimate.findings);
            println!("{}", serde_json::to_string_pretty(&result)?);
        } else {
            println!("{}", table::result(&result.estimate, None));
            println!("{}", conclusion(diagnosis, self.all));
        }
        if let Some(directory) = &self.figures {
            let force = diagnosis.unmodelled.as_ref();
            let force = force.map(|found| ("unmodelled.svg".to_string(), force_svg(found)));
            figures::write(directory, pictures(&result.histories).chain(force))?;
        }
        Ok(())
    }
}

/// A picture of each segment, numbered: labels may differ in what no file name can have.
fn pictures(
    histories: &[TimeHistory],
) -> impl Iterator<Item = (String, Result<String, String>)> + '_ {
    histories.iter().enumerate().map(|(number, history)| {
        let is_plain = |c: char| c.is_alphanumeric() || c == '-';
        let label = history.segment.replace(|c| !is_plain(c), "_");
        (format!("{}-{label}.svg", number + 1), history_svg(history))
    })
}

/// The refused candidates, the error before and after, and the verdict last.
pub(super) fn conclusion(diagnosis: &Diagnosis, all: bool) -> String {
    let mut text = String::new();
    let shown =
        |reason: Refusal| all || !matches!(reason, Refusal::NotSignificant | Refusal::NotFitted);
    for refused in diagnosis
        .refused
        .iter()
        .filter(|refused| shown(refused.reason))
    {
        text += &format!("refused {}: {}\n", refused.effect.name(), refused.sentence);
    }
    if !diagnosis.effects.is_empty() {
        text += &format!("{}\n", shifts(diagnosis));
    }
    text += &format!("{}\n", errors(diagnosis));
    text += &format!(
        "verdict: {}: {}",
        diagnosis.verdict.name(),
        diagnosis.sentence
    );
    text
}

/// How far the effects move the parameters of the declared model.
fn shifts(diagnosis: &Diagnosis) -> String {
    let header = [
        "parameter",
        "declared model",
        "with effects",
        "shift, standard errors",
    ];
    let rows = diagnosis.parameters.iter().map(|change| {
        let shift = change.shift;
        vec![
            change.name.clone(),
            five_digits(change.before),
            five_digits(change.after),
            shift.map_or("-".to_string(), |shift| format!("{shift:+.1}")),
        ]
    });
    bordered(header, rows, 0..0)
}

/// The error of each output, before and after.
fn errors(diagnosis: &Diagnosis) -> String {
    let rows = diagnosis.fits.iter().map(|fit| {
        vec![
            place(fit),
            fit.before.name.clone(),
            format!("{:.4e} {}", fit.before.rms, fit.before.unit),
            format!("{:.4e} {}", fit.after.rms, fit.after.unit),
            format!("{:.3}", fit.after.rms / fit.before.rms),
        ]
    });
    bordered(
        ["RMS error", "output", "before", "after", "ratio"],
        rows,
        0..0,
    )
}

fn place(fit: &FitChange) -> String {
    let segment = fit.segment.as_deref().unwrap_or("all segments");
    match fit.role {
        Role::Estimation => "fit".to_string(),
        Role::Validation => format!("prediction of {segment}"),
        Role::Final => format!("prediction of {segment} (no decision saw it)"),
    }
}
