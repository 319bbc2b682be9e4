//! The program's commands. Each is one clap struct, which is all the configuration it has: a setting
//! has a flag, an environment variable, a default and a line of help.

mod serve;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

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
    /// Run the service: API, documentation and workers on one database file.
    Serve(serve::Serve),
    /// Print the OpenAPI document of the API.
    Openapi,
}

/// Runs what the command line says.
pub fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Serve(serve) => serve.run(),
        Command::Openapi => openapi(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("trimtab: {error}");
            ExitCode::FAILURE
        }
    }
}

type Failure = Box<dyn std::error::Error>;

fn openapi() -> Result<(), Failure> {
    use std::io::Write;
    let document = crate::http::document().to_pretty_json()?;
    // a reader that has seen enough (`| head`) is no failure
    let _ = writeln!(std::io::stdout(), "{document}");
    Ok(())
}
