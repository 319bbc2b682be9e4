//! `trimtab study`: derivative techniques compared on a problem, here and now.

use std::ops::ControlFlow;
use std::path::PathBuf;

use super::progress::ProgressLine;
use super::request::Request;
use super::study_tables::tables;
use super::{Failure, figures};
use crate::dashboard::{cost_figure, error_figure};
use crate::job::{self, JobKind};
use crate::work::ThreadClock;

/// Estimates, and compares all derivative techniques on the same problem: errors, costs, iterations.
#[derive(clap::Args, Debug)]
pub(super) struct Study {
    #[command(flatten)]
    request: Request,
    /// Where to write gradient-error.svg and gradient-cost.svg.
    #[arg(long, value_name = "DIRECTORY")]
    figures: Option<PathBuf>,
    /// Print the study as JSON instead.
    #[arg(long)]
    json: bool,
}

impl Study {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let plan = self.request.plan(JobKind::DerivativeStudy)?;
        let progress = ProgressLine::new(self.request.tolerance);
        let result = job::run_study(&plan, &ThreadClock::start(), &mut |told| {
            match told {
                job::StudyProgress::Estimation(told) => progress.told(told),
                job::StudyProgress::Finding(step) => progress.say(&step.finding),
                job::StudyProgress::Underway => {}
            }
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the job failed", &faults))?;
        progress.finish(&result.estimate.reason);
        let Some(study) = result.study else {
            return Err(Failure::new(result.estimate.reason));
        };
        if self.json {
            println!("{}", serde_json::to_string_pretty(&study)?);
        } else {
            println!("{}", tables(&study));
        }
        if let Some(directory) = &self.figures {
            let pictures = [
                ("gradient-error.svg", error_figure(&study.error_curves)),
                ("gradient-cost.svg", cost_figure(&study.costs)),
            ];
            figures::write(
                directory,
                pictures.map(|(name, svg)| (name.to_string(), svg)),
            )?;
        }
        Ok(())
    }
}
