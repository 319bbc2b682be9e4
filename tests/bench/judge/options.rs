//! The command line.

use crate::design::Set;

pub(crate) struct Options {
    /// Seeds from, and up to but without.
    pub seeds: (u64, u64),
    /// Part of a case's key.
    pub only: String,
    /// Sets; none: all, three nulls, five effects, a pair and an unknown of ten seeds.
    pub set: Option<Set>,
    pub threads: usize,
    pub json: Option<String>,
    pub list: bool,
    pub usual_names: bool,
    pub steps: bool,
    pub oracle: bool,
    pub dry: bool,
}

pub(crate) const HELP: &str = "\
cargo bench -p trimtab-core --bench judge -- [options]

  --seeds A..B     seeds of the cases, B excluded; one case each (1..101). 1 to 999 may be used while tuning,
                   those from 1000 on are for judging alone
  --cases N        the first N of them
  --set NAME       nulls, effects, pairs or unknown; without it each ten seeds are 3 nulls, 5 effects, a pair and an unknown
  --only TEXT      cases whose key contains the text, such as `lateral/`, `/sensor_delay`, `/clear`
  --names usual    channels, states and inputs called as in the catalog's models (own)
  --threads N      cases at a time (1)
  --json FILE      a line of JSON for each case
  --steps          each step of each diagnosis, to stderr
  --oracle         how far the catalogue's own edit of each effect falls short of the truth, in ln L
  --dry            make the cases, but diagnose none
  --list           all cases that there are";

/// # Errors
/// In words what cannot be read.
pub(crate) fn parse(arguments: impl Iterator<Item = String>) -> Result<Options, String> {
    let mut options = Options {
        seeds: (1, 101),
        only: String::new(),
        set: None,
        threads: 1,
        json: None,
        list: false,
        usual_names: false,
        steps: false,
        oracle: false,
        dry: false,
    };
    let mut cases = None;
    let mut arguments = arguments.filter(|argument| argument != "--bench");
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--seeds" => options.seeds = seeds(&value()?)?,
            "--cases" => cases = Some(number(&value()?)?),
            "--set" => {
                let name = value()?;
                let found = Set::ALL.into_iter().find(|set| set.name() == name);
                options.set = Some(found.ok_or(format!("no set '{name}'"))?);
            }
            "--only" => options.only = value()?,
            "--names" => options.usual_names = value()? == "usual",
            "--threads" => options.threads = number(&value()?)? as usize,
            "--json" => options.json = Some(value()?),
            "--steps" => options.steps = true,
            "--oracle" => options.oracle = true,
            "--dry" => options.dry = true,
            "--list" => options.list = true,
            other => return Err(format!("no option '{other}'")),
        }
    }
    if let Some(cases) = cases {
        options.seeds.1 = options.seeds.1.min(options.seeds.0 + cases);
    }
    Ok(options)
}

fn number(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("'{text}' is no number"))
}

fn seeds(text: &str) -> Result<(u64, u64), String> {
    match text.split_once("..") {
        Some((from, to)) => Ok((number(from)?, number(to)?)),
        None => number(text).map(|seed| (seed, seed + 1)),
    }
}
