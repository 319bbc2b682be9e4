//! The options that change a model for one job: start values, bounds, priors, what is held and what is free, edits.

use indexmap::IndexMap;

use super::Failure;
use super::pairs::{once, pair};
use crate::job::ParameterOverride;
use crate::model::{Edit, EditKind, Prior, Start};

#[derive(clap::Args, Debug)]
pub(super) struct Changes {
    /// Another start value: "Ma=-3.5", or "alpha_0=first(alpha)".
    #[arg(long = "start", short, value_name = "NAME=VALUE")]
    starts: Vec<String>,
    /// Hold a parameter at its start value.
    #[arg(long, value_name = "NAME")]
    fix: Vec<String>,
    /// Estimate a parameter that the model holds.
    #[arg(long, value_name = "NAME")]
    free: Vec<String>,
    /// The smallest value that a parameter may take.
    #[arg(long = "lower", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    lower: Vec<String>,
    /// The largest value that a parameter may take.
    #[arg(long = "upper", value_name = "NAME=VALUE", allow_hyphen_values = true)]
    upper: Vec<String>,
    /// What is known of a parameter before the data, mean and standard deviation: "Ma=-3.5±0.2", or "Ma=-3.5:0.2".
    #[arg(long = "prior", value_name = "NAME=MEAN±SD")]
    priors: Vec<String>,
    /// An effect that the model is given: kind:target or kind:target:term, such as sensor_delay:q or missing_term:q:alpha^2.
    #[arg(long = "edit", value_name = "KIND:TARGET[:TERM]", value_parser = edit)]
    pub edits: Vec<Edit>,
}

impl Changes {
    /// By parameter, in the order in which they are named.
    pub(super) fn parameters(&self) -> Result<IndexMap<String, ParameterOverride>, Failure> {
        let mut parameters: IndexMap<String, ParameterOverride> = IndexMap::new();
        for text in &self.starts {
            let (name, value) = pair(text, "--start")?;
            let start = value
                .parse()
                .map_or_else(|_| Start::FromData(value.to_string()), Start::Value);
            let of = parameters.entry(name.to_string()).or_default();
            once("--start", name, of.start.replace(start).is_some())?;
        }
        for (names, fixed) in [(&self.fix, true), (&self.free, false)] {
            for name in names {
                let of = parameters.entry(name.clone()).or_default();
                once("--fix or --free", name, of.fixed.replace(fixed).is_some())?;
            }
        }
        for text in &self.lower {
            let (name, value) = number(text, "--lower")?;
            let of = parameters.entry(name.to_string()).or_default();
            once("--lower", name, of.lower.replace(value).is_some())?;
        }
        for text in &self.upper {
            let (name, value) = number(text, "--upper")?;
            let of = parameters.entry(name.to_string()).or_default();
            once("--upper", name, of.upper.replace(value).is_some())?;
        }
        for text in &self.priors {
            let (name, prior) = prior(text)?;
            let of = parameters.entry(name.to_string()).or_default();
            once("--prior", name, of.prior.replace(prior).is_some())?;
        }
        Ok(parameters)
    }
}

fn number<'t>(text: &'t str, option: &str) -> Result<(&'t str, f64), Failure> {
    let (name, value) = pair(text, option)?;
    let number = value
        .parse()
        .map_err(|_| Failure::new(format!("{option} '{text}': '{value}' is not a number")))?;
    Ok((name, number))
}

fn prior(text: &str) -> Result<(&str, Prior), Failure> {
    let (name, value) = pair(text, "--prior")?;
    let unfit = || {
        Failure::new(format!(
            "--prior '{text}' should read NAME=MEAN±SD or NAME=MEAN:SD"
        ))
    };
    let (mean, sd) = value
        .split_once('±')
        .or_else(|| value.split_once(':'))
        .ok_or_else(unfit)?;
    let number = |text: &str| text.trim().parse().map_err(|_| unfit());
    let (mean, sd) = (number(mean)?, number(sd)?);
    Ok((name, Prior { mean, sd }))
}

fn edit(text: &str) -> Result<Edit, String> {
    let mut parts = text.splitn(3, ':').map(str::to_string);
    let kind = parts.next().unwrap_or_default();
    let target = parts.next().filter(|target| !target.is_empty());
    let target =
        target.ok_or_else(|| format!("'{text}' is not kind:target or kind:target:term"))?;
    let found = EditKind::find(&kind).ok_or_else(|| {
        let known = EditKind::ALL.map(EditKind::name).join(", ");
        format!("there is no effect '{kind}'; choose one of {known}")
    })?;
    Ok(Edit {
        kind: found,
        target,
        term: parts.next(),
        parameter: None,
        unit: None,
        channels: IndexMap::new(),
        about: IndexMap::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn priors_are_read_both_ways() {
        let expected = Prior {
            mean: -3.5,
            sd: 0.2,
        };
        for text in ["Ma=-3.5±0.2", "Ma = -3.5 : 0.2"] {
            assert_eq!(prior(text).expect("a prior"), ("Ma", expected));
        }
        for text in ["Ma", "Ma=-3.5", "Ma=x:1"] {
            assert!(prior(text).is_err(), "{text}");
        }
    }

    #[test]
    fn edits_are_told_by_kind_target_and_term() {
        let found = edit("missing_term:q:alpha^2").expect("an edit");
        assert_eq!(
            (found.target.as_str(), found.term.as_deref()),
            ("q", Some("alpha^2"))
        );
        assert_eq!(edit("sensor_delay:q").expect("an edit").term, None);
        assert!(edit("sensor_delay").is_err());
        assert!(
            edit("sensor_dely:q")
                .expect_err("unknown")
                .contains("sensor_delay")
        );
    }
}
