//! `trimtab fit`: an estimation here and now, without a server.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::progress::ProgressLine;
use super::request::Request;
use super::two_step::TwoStep;
use super::{Failure, notes, table};
use crate::estimate::Estimate;
use crate::http::trajectories_as_csv;
use crate::job::{self, JobKind, Plan};

/// Fits a model to recordings and prints the parameter table.
#[derive(clap::Args, Debug)]
pub(super) struct Fit {
    #[command(flatten)]
    request: Request,
    #[command(flatten)]
    two_step: TwoStep,
    /// Print the whole result as JSON instead.
    #[arg(long)]
    json: bool,
    /// Write every state, definition and output along the trajectory, with standard errors, to this CSV file.
    #[arg(long, value_name = "FILE")]
    trajectories: Option<PathBuf>,
}

impl Fit {
    pub(super) fn run(&self) -> Result<(), Failure> {
        self.check_trajectories()?;
        let plan = match self.two_step.plan(&self.request, self.json)? {
            Some(plan) => plan,
            None => self.request.plan(JobKind::Estimate)?,
        };
        let progress = ProgressLine::new(self.request.tolerance);
        let result = job::run(&plan, &mut |told| {
            progress.told(told);
            ControlFlow::Continue(())
        })
        .map_err(|faults| {
            notes::say(&plan.prepared.findings);
            Failure::faults("the job failed", &faults)
        })?;
        progress.finish(&result.estimate.reason);
        if self.json {
            notes::say(&result.estimate.findings);
            println!("{}", serde_json::to_string_pretty(&result)?);
        } else {
            println!("{}", table::result(&result.estimate, None));
        }
        if let Some(file) = &self.trajectories {
            self.write_trajectories(file, &plan, &result.estimate)?;
        }
        Ok(())
    }

    /// Refuses a file that could not be written, or must not, before anything is fitted.
    fn check_trajectories(&self) -> Result<(), Failure> {
        let Some(file) = &self.trajectories else {
            return Ok(());
        };
        let refuse = |why: String| {
            Err(Failure::new(format!(
                "--trajectories {}: {why}",
                file.display()
            )))
        };
        let folder = file
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return refuse(format!(
                "there is no folder {}; make it first",
                folder.display()
            ));
        }
        if file.is_dir() {
            return refuse("it is a folder; name a file in it".to_string());
        }
        let real = file.canonicalize().ok();
        let is_read = |used: &&Path| real.is_some() && used.canonicalize().ok() == real;
        match self.request.files().into_iter().find(is_read) {
            Some(_) => refuse("it is a recording of this fit; name another file".to_string()),
            None => Ok(()),
        }
    }

    fn write_trajectories(
        &self,
        file: &Path,
        plan: &Plan,
        estimate: &Estimate,
    ) -> Result<(), Failure> {
        let trajectories = job::trajectories_of(plan, estimate)
            .map_err(|why| Failure::new(format!("there is no trajectory: {why}")))?;
        let mut all = trajectories
            .iter()
            .flat_map(|trajectory| &trajectory.quantities);
        if let Some(series) = all.find(|series| series.standard_errors.is_empty()) {
            eprintln!(
                "{} has no standard error along the trajectory: a parameter behind it has none, or the estimate is singular",
                series.name
            );
        }
        std::fs::write(file, trajectories_as_csv(&trajectories))
            .map_err(|why| Failure::new(format!("{} cannot be written: {why}", file.display())))
    }
}
