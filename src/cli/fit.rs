//! `trimtab fit`: an estimation here and now, without a server.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::progress::Progress;
use super::request::{Request, format_of, read_bytes};
use super::{Failure, table};
use crate::estimate;
use crate::ingest::{self, Limits};
use crate::job;

/// Fits a model to recordings and prints the parameter table.
#[derive(clap::Args, Debug)]
pub struct Fit {
    #[command(flatten)]
    request: Request,
    /// Print the whole result as JSON instead.
    #[arg(long)]
    json: bool,
}

impl Fit {
    pub fn run(&self) -> Result<(), Failure> {
        let mut maneuvers = Vec::new();
        for file in &self.request.files {
            let maneuver = ingest::read(&read_bytes(file)?, format_of(file), &Limits::default())
                .map_err(|error| Failure::faults(&file.display().to_string(), error.faults()))?;
            maneuvers.push(Arc::new(maneuver));
        }
        let ids: Vec<String> = maneuvers.iter().map(|maneuver| maneuver.digest()).collect();
        let spec = self.request.spec(&ids)?;
        let plan = job::prepare(&spec, &self.request.document()?, &maneuvers)
            .map_err(|faults| Failure::faults("the job cannot start", &faults))?;
        for finding in &plan.prepared.findings {
            eprintln!("note: {}; {}", finding.message, finding.remedy);
        }
        let progress = Progress::new(spec.options.tolerance);
        let result = job::run(&plan, &mut |told| {
            match told {
                estimate::Progress::Start(report) => progress.say(&report.text),
                estimate::Progress::Iteration(iteration) => progress.iteration(iteration),
            }
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the job failed", &faults))?;
        progress.finish(&result.estimate.reason);
        if self.json {
            let text = serde_json::to_string_pretty(&result)
                .map_err(|error| Failure::new(error.to_string()))?;
            println!("{text}");
        } else {
            println!(
                "{}\n\n{}",
                table::parameters(&result.estimate, None),
                table::outputs(&result.estimate)
            );
        }
        Ok(())
    }
}
