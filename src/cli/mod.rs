//! The program's commands. Each is one clap struct, which is all the configuration it has: a setting
//! has a flag, an environment variable, a default and a line of help.
//!
//! Invariant: results go to the standard output and all else to the standard error; a failure is one message and exit code 1.

mod audit;
mod backup;
mod bordered;
mod campaign;
mod cancel;
mod changes;
mod client;
mod compare;
mod delete;
mod demo;
mod derivatives;
mod describe;
mod design;
mod diagnose;
mod document;
mod failure;
mod figures;
mod file_rows;
mod fit;
mod form;
mod health;
mod inspect;
mod intervals;
mod jobs;
mod join;
mod key;
mod linear;
mod linear_tables;
mod local;
mod maneuver;
mod mapping;
mod model;
mod models;
mod notes;
mod pairs;
mod plots;
mod predict;
mod process;
mod progress;
mod recording;
mod request;
mod response;
mod results;
mod retain;
mod scenario;
mod segments;
mod serve;
mod server;
mod simulate;
mod start_method;
mod structure;
mod study;
mod study_tables;
mod submit;
mod table;
mod track;
mod trim;
mod two_step;
mod upload;
mod watch;
mod work;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

pub use study_tables::tables as study_tables;

#[derive(Parser)]
#[command(
    name = "trimtab",
    version,
    about = "Estimates aircraft parameters from flight-test maneuvers"
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run the service: API, documentation and workers on one database.
    Serve(serve::Serve),
    Work(work::Work),
    Demo(demo::Demo),
    Fit(fit::Fit),
    Study(study::Study),
    Track(Box<track::Track>),
    Structure(Box<structure::StructureCommand>),
    Diagnose(diagnose::Diagnose),
    Linear(linear::Linear),
    Predict(predict::Predict),
    #[command(name = "campaign")]
    Campaign(campaign::ShowCampaign),
    Compare(compare::Compare),
    Upload(upload::Upload),
    Submit(submit::Submit),
    Watch(watch::Watch),
    Jobs(jobs::Jobs),
    Results(results::Results),
    Cancel(cancel::Cancel),
    Delete(delete::Delete),
    Simulate(simulate::Simulate),
    Design(design::Design),
    #[command(name = "trim")]
    Trim(Box<trim::TrimCommand>),
    Inspect(inspect::Inspect),
    Join(join::Join),
    Segments(segments::Segments),
    #[command(name = "maneuver")]
    Maneuvers(maneuver::Maneuvers),
    Response(response::Response),
    Model(model::ShowModel),
    Models(models::Models),
    Derivatives(derivatives::Derivatives),
    Health(health::Health),
    #[command(name = "key")]
    Keys(key::Keys),
    Retain(retain::Retain),
    Audit(audit::Audit),
    Backup(backup::Backup),
    Restore(backup::Restore),
    Check(backup::Check),
    /// Print the OpenAPI document of the API.
    Openapi,
}

/// Runs what the command line says.
pub fn main() -> ExitCode {
    end_when_nobody_reads();
    let done = match Cli::parse().command {
        Command::Serve(serve) => serve.run(),
        Command::Work(work) => work.run(),
        Command::Demo(demo) => block_on(demo.run()),
        Command::Fit(fit) => fit.run(),
        Command::Study(study) => study.run(),
        Command::Track(track) => track.run(),
        Command::Structure(structure) => structure.run(),
        Command::Diagnose(diagnose) => diagnose.run(),
        Command::Linear(linear) => linear.run(),
        Command::Predict(predict) => predict.run(),
        Command::Campaign(campaign) => campaign.run(),
        Command::Compare(compare) => block_on(compare.run()),
        Command::Upload(upload) => block_on(upload.run()),
        Command::Submit(submit) => block_on(submit.run()),
        Command::Watch(watch) => block_on(watch.run()),
        Command::Jobs(jobs) => block_on(jobs.run()),
        Command::Results(results) => block_on(results.run()),
        Command::Cancel(cancel) => block_on(cancel.run()),
        Command::Delete(delete) => block_on(delete.run()),
        Command::Simulate(simulate) => simulate.run(),
        Command::Design(design) => design.run(),
        Command::Trim(trim) => trim.run(),
        Command::Inspect(inspect) => inspect.run(),
        Command::Join(join) => join.run(),
        Command::Segments(segments) => segments.run(),
        Command::Maneuvers(maneuvers) => block_on(maneuvers.run()),
        Command::Response(response) => response.run(),
        Command::Model(model) => model.run(),
        Command::Models(models) => block_on(models.run()),
        Command::Derivatives(derivatives) => derivatives.run(),
        Command::Health(health) => block_on(health.run()),
        Command::Keys(keys) => block_on(keys.run()),
        Command::Retain(retain) => block_on(retain.run()),
        Command::Audit(audit) => block_on(audit.run()),
        Command::Backup(backup) => block_on(backup.run()),
        Command::Restore(restore) => block_on(restore.run()),
        Command::Check(check) => block_on(check.run()),
        Command::Openapi => openapi(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("trimtab: {failure}");
            ExitCode::FAILURE
        }
    }
}

/// A reader that has seen enough (`| head`) is no fault: the command ends without a word.
fn end_when_nobody_reads() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let message = panic.payload_as_str().unwrap_or_default();
        if message.starts_with("failed printing to stdout") && message.contains("Broken pipe") {
            std::process::exit(0);
        }
        usual(panic);
    }));
}

fn block_on(command: impl Future<Output = Result<(), Failure>>) -> Result<(), Failure> {
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .build()?;
    runtime.block_on(command)
}

fn openapi() -> Result<(), Failure> {
    use std::io::Write;
    let document = crate::http::document().to_pretty_json()?;
    // a reader that has seen enough (`| head`) is no failure
    let _ = writeln!(std::io::stdout(), "{document}");
    Ok(())
}
