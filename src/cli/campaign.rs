//! `trimtab campaign`: parameters of many fits over their conditions, without a server.

use std::path::PathBuf;

use super::recording::read_text;
use super::{Failure, table};
use crate::estimate::five_digits as number;
use crate::http::campaign_as_csv;
use crate::job::{Campaign, CampaignQuestion, Flown, JobResult, campaign, conditions_of};

/// Compares what many fits say of the same parameters: curves over conditions or weighted means, whether the fits agree, and
/// which are outliers.
#[derive(clap::Args, Debug)]
pub(super) struct ShowCampaign {
    /// What `trimtab fit --json` printed, with its conditions: fit7.json@alpha=5,mach=0.4
    #[arg(required = true, value_name = "FILE[@NAME=VALUE,...]")]
    fits: Vec<String>,
    /// A condition with numbers, over which parameters are curves.
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
        let flown = self
            .fits
            .iter()
            .map(|fit| read(fit))
            .collect::<Result<Vec<_>, _>>()?;
        let question = CampaignQuestion {
            by: self.by.clone(),
            group: self.group.clone(),
            parameters: self.parameter.clone(),
            degree: self.degree.map(usize::from),
        };
        let campaign = campaign(&flown, &question);
        if self.csv {
            print!("{}", campaign_as_csv(&campaign));
        } else if self.json {
            println!("{}", serde_json::to_string_pretty(&campaign)?);
        } else {
            println!("{}", tables(&campaign));
        }
        for left_out in &campaign.left_out {
            eprintln!("{} is left out: {}", left_out.job, left_out.reason);
        }
        Ok(())
    }
}

fn read(fit: &str) -> Result<Flown, Failure> {
    let (file, conditions) = fit.split_once('@').unwrap_or((fit, ""));
    let result: JobResult =
        serde_json::from_str(&read_text(&PathBuf::from(file))?).map_err(|error| {
            Failure::new(format!(
                "{file}: {error}; give what trimtab fit --json printed"
            ))
        })?;
    let tags: Vec<String> = conditions.split(',').map(ToString::to_string).collect();
    Ok(Flown {
        job: file.to_string(),
        name: String::new(),
        conditions: conditions_of(&tags),
        estimate: result.estimate,
    })
}

fn tables(campaign: &Campaign) -> String {
    let rows = campaign.curves.iter().map(|curve| {
        let terms: Vec<String> = (curve.terms.iter())
            .map(|term| {
                let value = format!("{} ± {}", number(term.value), number(term.standard_error));
                if term.term == "1" {
                    value
                } else {
                    format!("({value}) {}", term.term)
                }
            })
            .collect();
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
            terms.join(" + "),
            format!(
                "{} of {}",
                number(curve.chi_squared),
                curve.degrees_of_freedom
            ),
            curve
                .probability
                .map(|p| format!("{p:.3}"))
                .unwrap_or_default(),
            outliers.join(", "),
        ]
    });
    let header = ["parameter", "group", "curve", "χ²", "by chance", "outliers"];
    table::bordered(header, rows, 0..0)
}
