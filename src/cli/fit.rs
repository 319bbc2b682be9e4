//! `trimtab fit`: an estimation here and now, without a server.

use std::ops::ControlFlow;

use super::progress::ProgressLine;
use super::request::Request;
use super::{Failure, table};
use crate::job::{self, JobKind};

/// Fits a model to recordings and prints the parameter table.
#[derive(clap::Args, Debug)]
pub(super) struct Fit {
    #[command(flatten)]
    request: Request,
    /// Print the whole result as JSON instead.
    #[arg(long)]
    json: bool,
}

impl Fit {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let plan = self.request.plan(JobKind::Estimate)?;
        let progress = ProgressLine::new(self.request.tolerance);
        let result = job::run(&plan, &mut |told| {
            progress.told(told);
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the job failed", &faults))?;
        progress.finish(&result.estimate.reason);
        if self.json {
            println!("{}", serde_json::to_string_pretty(&result)?);
        } else {
            println!("{}", table::result(&result.estimate, None));
        }
        Ok(())
    }
}
