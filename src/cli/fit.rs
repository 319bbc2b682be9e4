//! `trimtab fit`: an estimation here and now, without a server.

use std::ops::ControlFlow;

use super::progress::Progress;
use super::request::Request;
use super::{Failure, table};
use crate::job;

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
        let maneuvers = self.request.recordings()?;
        let ids: Vec<String> = maneuvers.iter().map(|maneuver| maneuver.digest()).collect();
        let spec = self.request.spec(&ids)?;
        let plan = job::prepare(&spec, &self.request.document()?, &maneuvers)
            .map_err(|faults| Failure::faults("the job cannot start", &faults))?;
        for finding in &plan.prepared.findings {
            eprintln!("note: {}; {}", finding.message, finding.remedy);
        }
        let progress = Progress::new(spec.options.tolerance);
        let result = job::run(&plan, &mut |told| {
            progress.told(told);
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the job failed", &faults))?;
        progress.finish(&result.estimate.reason);
        if self.json {
            let text = serde_json::to_string_pretty(&result)
                .map_err(|error| Failure::new(error.to_string()))?;
            println!("{text}");
        } else {
            println!("{}", table::result(&result.estimate, None));
        }
        Ok(())
    }
}
