//! `trimtab campaign`: parameters of many fits over their conditions, without a server.

use std::path::PathBuf;

use indexmap::IndexMap;
use sha2::{Digest, Sha256};

use super::recording::read_text;
use super::{Failure, table};
use crate::estimate::{Role, TimeHistory, five_digits as number};
use crate::flight::p_value;
use crate::http::campaign_as_csv;
use crate::job::{
    Campaign, CampaignQuestion, Flown, JobResult, UsedRecording, campaign, channel_of,
    conditions_of, mean_over,
};

/// Compares what many fits say of the same parameters: curves over conditions or weighted means, whether the fits agree, and
/// which are outliers. Of fits to the same samples the last counts.
#[derive(clap::Args, Debug)]
pub(super) struct ShowCampaign {
    /// What `trimtab fit --json` printed, with its conditions: fit7.json@alpha=5,mach=0.4
    #[arg(required = true, value_name = "FILE[@NAME=VALUE,...]")]
    fits: Vec<String>,
    /// A condition with numbers, over which parameters are curves; mean(NAME) is the mean of an input or output, SI.
    #[arg(long, value_name = "NAME")]
    by: Vec<String>,
    /// A condition with words, each of whose values has curves of its own.
    #[arg(long, value_name = "NAME")]
    group: Vec<String>,
    /// One parameter; all without it.
    #[arg(long, value_name = "NAME")]
    parameter: Vec<String>,
    /// Highest degree of the polynomials, 0 to 3; 2, or less where there are too few conditions.
    #[arg(long, value_parser = clap::value_parser!(u8).range(0..=3))]
    degree: Option<u8>,
    /// Print a table as CSV, a row for each parameter and fit.
    #[arg(long)]
    csv: bool,
    /// Print JSON.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
}

impl ShowCampaign {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let question = CampaignQuestion {
            by: self.by.clone(),
            group: self.group.clone(),
            parameters: self.parameter.clone(),
            degree: self.degree.map(usize::from),
        };
        if let Some((field, message)) = question.fault() {
            return Err(Failure::new(format!("--{field}: {message}")));
        }
        let flown = self
            .fits
            .iter()
            .map(|fit| read(fit, &self.by))
            .collect::<Result<Vec<_>, _>>()?;
        let campaign = campaign(&flown, &question);
        if self.csv {
            print!("{}", campaign_as_csv(&campaign));
        } else if self.json {
            println!("{}", serde_json::to_string_pretty(&campaign)?);
        } else {
            println!("{}", tables(&campaign, &self.by));
        }
        for left_out in &campaign.left_out {
            eprintln!("{} is left out: {}", left_out.job, left_out.reason);
        }
        for (terms, parameters) in untold(&campaign) {
            eprintln!("{}: the fits do not tell {terms}", parameters.join(", "));
        }
        Ok(())
    }
}

fn read(fit: &str, by: &[String]) -> Result<Flown, Failure> {
    let (file, conditions) = fit.split_once('@').unwrap_or((fit, ""));
    let result: JobResult =
        serde_json::from_str(&read_text(&PathBuf::from(file))?).map_err(|error| {
            Failure::new(format!(
                "{file}: {error}; give what trimtab fit --json printed"
            ))
        })?;
    let tags: Vec<String> = conditions.split(',').map(ToString::to_string).collect();
    let mut conditions = conditions_of(&tags);
    for condition in by {
        if let Some(mean) = channel_of(condition).and_then(|name| mean_of(&result.histories, name))
        {
            conditions.insert(condition.clone(), mean.to_string());
        }
    }
    Ok(Flown {
        job: file.to_string(),
        name: String::new(),
        conditions,
        recordings: measured(&result.histories),
        estimate: result.estimate,
    })
}

/// Of an input, or of an output as it was measured, over all that was fitted.
fn mean_of(histories: &[TimeHistory], name: &str) -> Option<f64> {
    let fitted = histories.iter().filter(|of| of.role == Role::Estimation);
    let of = |history: &TimeHistory| -> Option<Vec<f64>> {
        let input = history.inputs.iter().find(|input| input.name == name);
        let output = || history.outputs.iter().find(|output| output.name == name);
        let values = input.map(|input| &input.values);
        values
            .or_else(|| output().map(|output| &output.measured))
            .cloned()
    };
    let all: Option<Vec<Vec<f64>>> = fitted.map(of).collect();
    mean_over(all?.iter().map(Vec::as_slice))
}

/// What a fit was made to, by the samples that its result has of it: the name of its recording is not in it.
fn measured(histories: &[TimeHistory]) -> Vec<UsedRecording> {
    let of = |history: &TimeHistory| {
        let outputs = history.outputs.iter().flat_map(|output| &output.measured);
        let mut hash = Sha256::new();
        for sample in history.time.iter().chain(outputs) {
            hash.update(sample.to_le_bytes());
        }
        UsedRecording {
            id: hash
                .finalize()
                .iter()
                .map(|byte| format!("{byte:02x}"))
                .collect(),
            rows: None,
            seconds: None,
        }
    };
    let fitted = histories.iter().filter(|of| of.role == Role::Estimation);
    fitted.map(of).collect()
}

/// Terms that curves lack, with the parameters whose curves lack them.
fn untold(campaign: &Campaign) -> IndexMap<String, Vec<&str>> {
    let mut untold: IndexMap<String, Vec<&str>> = IndexMap::new();
    for curve in (campaign.curves.iter()).filter(|curve| !curve.terms_left_out.is_empty()) {
        let parameters = untold.entry(curve.terms_left_out.join(", ")).or_default();
        if !parameters.contains(&curve.parameter.as_str()) {
            parameters.push(&curve.parameter);
        }
    }
    untold
}

/// Means of channels are SI here, as the results are.
fn tables(campaign: &Campaign, by: &[String]) -> String {
    let rows = campaign.curves.iter().map(|curve| {
        let outliers = curve.points.iter().filter(|point| point.is_outlier);
        let outliers: Vec<String> = outliers
            .map(|point| format!("{} ({:+.1} s.e.)", point.job, point.deviation))
            .collect();
        let group: Vec<String> = curve
            .group
            .iter()
            .map(|(name, value)| format!("{name}={value}"))
            .collect();
        vec![
            format!("{} [{}]", curve.parameter, curve.unit),
            group.join(", "),
            curve.written(1.0, 1.0),
            match curve.tested() {
                Ok(tested) => format!("{} of {}", number(tested), curve.degrees_of_freedom),
                Err(why) => why.to_string(),
            },
            curve.probability.map(p_value).unwrap_or_default(),
            outliers.join(", "),
        ]
    });
    let curve = match by.iter().any(|name| channel_of(name).is_some()) {
        true => "curve, means in SI",
        false => "curve",
    };
    let header = ["parameter", "group", curve, "χ²", "by chance", "outliers"];
    table::bordered(header, rows, 0..0)
}
