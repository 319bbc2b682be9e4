//! `trimtab watch`: a job of a server, followed to its end.

use super::client::Client;
use super::progress::ProgressLine;
use super::server::ServerOption;
use super::{Failure, diagnose, plots, table};
use crate::estimate::{Estimate, Outcome};
use crate::job::{EventBody, JobKind};

/// Follows a job and prints its parameter table, and of a diagnosis what it comes to.
#[derive(clap::Args, Debug)]
pub(super) struct Watch {
    /// The job's id.
    job: String,
    #[command(flatten)]
    server: ServerOption,
}

impl Watch {
    pub(super) async fn run(&self) -> Result<(), Failure> {
        let client = Client::of(&self.server)?;
        let estimate = follow(&client, &self.job).await?;
        println!("{}", table::result(&estimate, None));
        conclude(&client, &self.job, &estimate).await
    }
}

/// Shows the flights, and prints what a diagnosis comes to, unless it was stopped before its conclusion.
pub(super) async fn conclude(
    client: &Client,
    job: &str,
    estimate: &Estimate,
) -> Result<(), Failure> {
    plots::show(client, job).await?;
    let is_diagnosis = client.spec(job).await?.kind == JobKind::Diagnose;
    if is_diagnosis && estimate.outcome != Outcome::Cancelled {
        let diagnosis = client.diagnosis(job).await?;
        println!("{}", diagnose::conclusion(&diagnosis, false));
    }
    Ok(())
}

/// Follows a job with a progress bar; the estimate, when there is one.
pub(super) async fn follow(client: &Client, job: &str) -> Result<Estimate, Failure> {
    let tolerance = client.spec(job).await?.options.tolerance;
    let progress = ProgressLine::new(tolerance);
    let mut ending = None;
    client
        .follow(job, |event| match &event.body {
            EventBody::Queued => progress.say("queued"),
            EventBody::Claimed { worker, attempt: 1 } => {
                progress.say(&format!("claimed by worker {worker}"))
            }
            EventBody::Claimed { worker, attempt } => {
                progress.say(&format!("claimed by worker {worker}, attempt {attempt}"));
            }
            EventBody::Released { reason } => {
                progress.say(&format!("given back to the queue: {reason}"))
            }
            EventBody::Prepared(prepared) => {
                let (samples, unknowns) = (prepared.samples, prepared.parameters.len());
                progress.say(&format!("{samples} samples, {unknowns} unknowns"));
                for finding in &prepared.findings {
                    progress.say(&format!("note: {}; {}", finding.message, finding.remedy));
                }
            }
            EventBody::Start(report) => progress.say(&report.text),
            EventBody::Iteration(iteration) => progress.iteration(iteration),
            EventBody::Finding(step) => progress.say(&step.finding),
            EventBody::Diagnosis(step) => progress.diagnosis(step),
            EventBody::CancelRequested => progress.say("asked to stop"),
            EventBody::Succeeded { reason, .. } => {
                progress.finish(reason);
                ending = Some(Ok(()));
            }
            EventBody::Cancelled { has_result: true } => {
                progress.finish("cancelled; the best iterate is kept");
                ending = Some(Ok(()));
            }
            EventBody::Cancelled { has_result: false } => {
                ending = Some(Err(Failure::new("the job was cancelled")))
            }
            EventBody::Failed { faults } => {
                ending = Some(Err(Failure::faults("the job failed", faults)))
            }
        })
        .await?;
    ending.unwrap_or_else(|| Err(Failure::new("the job's log ended before the job did")))?;
    client.estimate(job).await
}
