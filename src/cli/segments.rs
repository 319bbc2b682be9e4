//! `trimtab segments`: where in a recording a maneuver is flown.

use std::path::PathBuf;

use super::Failure;
use super::mapping::MappingOption;
use super::recording::read_recording;
use super::table::bordered;
use crate::flight::{Proposal, Shown, Unit, Wanted, five_digits, segments, shown_in};

/// Proposes segments of a recording: where inputs move and the aircraft responds, and where it is trimmed.
#[derive(clap::Args, Debug)]
pub(super) struct Segments {
    /// A recording: what `fit` reads.
    file: PathBuf,
    #[command(flatten)]
    mapping: MappingOption,
    /// Channels whose motion makes a maneuver, separated by commas; without, the control surfaces, by their names.
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    inputs: Vec<String>,
    /// Nothing moves for so many seconds between two maneuvers.
    #[arg(long, value_name = "S", default_value_t = Wanted::default().quiet, value_parser = seconds)]
    quiet: f64,
    /// Seconds of trim before the first motion.
    #[arg(long, value_name = "S", default_value_t = Wanted::default().lead, value_parser = seconds)]
    lead: f64,
    /// Seconds of free response behind the last motion, at most.
    #[arg(long, value_name = "S", default_value_t = Wanted::default().response, value_parser = seconds)]
    response: f64,
    /// Print the proposal as JSON.
    #[arg(long)]
    json: bool,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (0.0..=3600.0).contains(&seconds) => Ok(seconds),
        _ => Err("seconds are a number from 0 to 3600".to_string()),
    }
}

impl Segments {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let mapping = self.mapping.read()?;
        let maneuver = read_recording(&self.file, mapping.as_ref())?;
        let wanted = Wanted {
            inputs: self.inputs.clone(),
            quiet: self.quiet,
            lead: self.lead,
            response: self.response,
        };
        let proposal = segments(&maneuver, &wanted)
            .map_err(|fault| Failure::new(format!("{}: {}", self.file.display(), fault.message)))?;
        if self.json {
            println!("{}", serde_json::to_string_pretty(&proposal)?);
            return Ok(());
        }
        let unit = |channel: &str| {
            let channel = maneuver.channels().get(channel);
            channel.map_or(String::new(), |channel| {
                Unit::si_name(&channel.recorded_unit)
            })
        };
        println!("{}", told(&proposal, unit, &self.file.to_string_lossy()));
        Ok(())
    }
}

/// The proposal as a table, each part as a command takes it.
fn told(proposal: &Proposal, unit: impl Fn(&str) -> String, file: &str) -> String {
    let rows = proposal.segments.iter().map(|segment| {
        let moves = segment.moves.iter().map(|moved| {
            let Shown { scale, unit } = shown_in(&unit(&moved.channel));
            format!(
                "{} by {} {unit}",
                moved.channel,
                five_digits(moved.excursion * scale)
            )
        });
        let moves: Vec<String> = moves.collect();
        let [from, to] = segment.seconds;
        vec![
            segment.name.clone(),
            format!("{file}:{from}s-{to}s"),
            moves.join(", "),
        ]
    });
    let table = bordered(["segment", "part of the recording", "moves"], rows, 0..0);
    format!("inputs: {}\n{table}", proposal.inputs.join(", "))
}
