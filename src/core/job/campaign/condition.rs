//! The conditions in which a job's maneuvers were flown: tags of the form `name=value`.

use indexmap::IndexMap;

use super::mean::channel_of;
use super::report::{CampaignQuestion, Flown};

/// What tags say: `alpha=5`, `flaps=14`. Others say nothing of conditions.
pub fn conditions_of(tags: &[String]) -> IndexMap<String, String> {
    let pair = |tag: &String| {
        let (name, value) = tag.split_once('=')?;
        Some((name.trim().to_string(), value.trim().to_string()))
    };
    tags.iter().filter_map(pair).collect()
}

/// Numbers for the curves and words for the group of a job, or why it cannot be used.
pub(super) fn place(
    flown: &Flown,
    question: &CampaignQuestion,
) -> Result<(Vec<f64>, IndexMap<String, String>), String> {
    if flown.estimate.outcome.is_short() {
        return Err(format!(
            "its fit has not converged: {}",
            flown.estimate.reason
        ));
    }
    let value = |name: &String| {
        let value = flown.conditions.get(name);
        value.ok_or_else(|| match channel_of(name) {
            Some(channel) => format!(
                "a recording that it was fitted to has no channel {channel}, or was deleted"
            ),
            None => format!("it has no tag {name}=..."),
        })
    };
    let number = |name: &String| {
        let text = value(name)?;
        let number: Option<f64> = text.parse().ok();
        let number = number.filter(|number| number.is_finite());
        number.ok_or_else(|| format!("its tag {name}={text} is no number"))
    };
    let numbers = question
        .by
        .iter()
        .map(number)
        .collect::<Result<_, String>>()?;
    let words = question.group.iter();
    let words = words.map(|name| Ok((name.clone(), value(name)?.clone())));
    Ok((numbers, words.collect::<Result<_, String>>()?))
}
