//! Parameters of many jobs over a condition, or their weighted means: whether the jobs agree, and which are outliers.

use maud::{Markup, html};

use super::error_bars::{ErrorBars, Point};
use super::palette::number_of;
use crate::estimate::five_digits as number;
use crate::flight::{Shown, p_value, shown_in};
use crate::job::{Campaign, CampaignCurve, CampaignPoint, LeftOut, channel_of};

/// What parameters can be seen over.
#[derive(Default)]
pub struct Offered {
    /// Tags of the form `alpha=5`, with numbers.
    pub numbers: Vec<String>,
    /// Tags of the form `flaps=up`, with words.
    pub words: Vec<String>,
    /// Channels of the recordings, with their SI units.
    pub channels: Vec<(String, String)>,
}

/// What they are seen over.
#[derive(Default)]
pub struct Chosen {
    /// A condition: a tag or `mean(alpha)`.
    pub by: String,
    pub group: String,
}

/// Points of a curve.
const POINTS: u32 = 60;

/// The section of a page, with the form that chooses.
pub(super) fn section(
    campaign: &Campaign,
    offered: &Offered,
    chosen: &Chosen,
    ids: &[&str],
) -> Markup {
    html! {
        h2 id="conditions" { @if chosen.by.is_empty() { "Weighted means" } @else { "Over " (words(&chosen.by)) } }
        (form(offered, chosen, ids))
        @for job in &campaign.left_out { p.soft { (left_out(job, ids)) } }
        @if campaign.curves.is_empty() { p { "No parameter with a standard error is left." } }
        @else { (table(campaign, offered, chosen, ids)) }
        @if !chosen.by.is_empty() {
            div.tiles.wide {
                @for curve in &campaign.curves {
                    @let bars = figure_of(curve, offered, chosen, ids);
                    figure data-values=(bars.table()) {
                        figcaption { (curve.parameter) " [" (shown_in(&curve.unit).unit) "]" @if let Some(group) = group_of(curve) { ", " (group) } }
                        (bars.drawn())
                    }
                }
            }
            p.soft { "Error bars and bands of 2 standard errors; open circles are outliers, which do not count." }
        }
        ul.links { li { a href={ (address("/v1/campaigns", chosen, ids)) "&format=csv" } { "this table (CSV)" } } }
    }
}

fn words(by: &str) -> String {
    match channel_of(by) {
        Some(channel) => format!("the mean of {channel}"),
        None => by.to_string(),
    }
}

/// By the numbers that jobs have on the page.
fn left_out(job: &LeftOut, ids: &[&str]) -> Markup {
    let numbers = ids.iter().enumerate();
    let reason = numbers.fold(job.reason.clone(), |reason, (at, id)| {
        reason.replace(id, &(at + 1).to_string())
    });
    html! { (named(&job.job, ids)) " " (job.name) " is left out: " (reason) "." }
}

/// The number of a job.
fn named(job: &str, ids: &[&str]) -> Markup {
    html! { @if let Some(at) = ids.iter().position(|id| *id == job) { (number_of(at)) } }
}

fn form(offered: &Offered, chosen: &Chosen, ids: &[&str]) -> Markup {
    let option = |value: &str, text: String, of: &str| html! { option value=(value) selected[value == of] { (text) } };
    html! {
        form.row method="get" action="/compare#conditions" {
            input type="hidden" name="jobs" value=(ids.join(","));
            label { "Parameters over"
                select name="by" {
                    (option("", "nothing: weighted means".into(), &chosen.by))
                    @for name in &offered.numbers { (option(name, format!("tag {name}"), &chosen.by)) }
                    @for (channel, _) in &offered.channels { (option(&format!("mean({channel})"), format!("mean of {channel}"), &chosen.by)) }
                }
            }
            @if !offered.words.is_empty() {
                label { "Apart by"
                    select name="group" {
                        (option("", "nothing".into(), &chosen.group))
                        @for name in &offered.words { (option(name, format!("tag {name}"), &chosen.group)) }
                    }
                }
            }
            button { "Show" }
        }
    }
}

/// What these jobs say over what is chosen: a page, or a resource.
pub(super) fn address(path: &str, chosen: &Chosen, ids: &[&str]) -> String {
    let mut query = form_urlencoded::Serializer::new(String::new());
    query.append_pair("jobs", &ids.join(","));
    for (name, value) in [("by", &chosen.by), ("group", &chosen.group)] {
        if !value.is_empty() {
            query.append_pair(name, value);
        }
    }
    format!("{path}?{}", query.finish())
}

fn table(campaign: &Campaign, offered: &Offered, chosen: &Chosen, ids: &[&str]) -> Markup {
    let across = across(offered, chosen);
    let wide = across.as_ref().map_or(1.0, |shown| shown.scale);
    html! {
        div.scroll tabindex="0" role="region" aria-labelledby="conditions" { table {
            thead { tr {
                th scope="col" { "parameter" } th scope="col" { "unit" } th scope="col" { @match &across { Some(shown) => { "curve, " (chosen.by) " in " (shown.unit) } None => "mean or curve" } }
                th.number scope="col" { "χ²" } th.number scope="col" { "degrees of freedom" } th.number scope="col" { "by chance" } th scope="col" { "outliers" }
            } }
            tbody { @for curve in &campaign.curves { tr {
                th scope="row" { (curve.parameter) @if let Some(group) = group_of(curve) { " " span.soft { (group) } } }
                td.soft { (shown_in(&curve.unit).unit) }
                td { (curve.written(shown_in(&curve.unit).scale, wide)) }
                td.number { @match curve.tested() { Ok(tested) => (number(tested)), Err(why) => span.soft { (why) } } } td.number { (curve.degrees_of_freedom) }
                td.number { @if let Some(p) = curve.probability { (p_value(p)) } }
                td { (outliers(curve, ids)) }
            } } }
        } }
    }
}

fn group_of(curve: &CampaignCurve) -> Option<String> {
    let pairs = curve
        .group
        .iter()
        .map(|(name, value)| format!("{name}={value}"));
    let pairs: Vec<String> = pairs.collect();
    (!pairs.is_empty()).then(|| pairs.join(", "))
}

/// How the condition that was chosen is shown: angles in degrees. Nothing of a tag.
fn across(offered: &Offered, chosen: &Chosen) -> Option<Shown> {
    let channel = channel_of(&chosen.by)?;
    let (_, unit) = offered.channels.iter().find(|(name, _)| name == channel)?;
    Some(shown_in(unit))
}

fn outliers(curve: &CampaignCurve, ids: &[&str]) -> Markup {
    let outliers = curve.points.iter().filter(|point| point.is_outlier);
    html! {
        @for (at, point) in outliers.enumerate() {
            @if at > 0 { ", " } (named(&point.job, ids)) " " (point.name) " (" (format!("{:+.1}", point.deviation)) " s.e.)"
        }
    }
}

fn figure_of(curve: &CampaignCurve, offered: &Offered, chosen: &Chosen, ids: &[&str]) -> ErrorBars {
    let Shown { scale, unit } = shown_in(&curve.unit);
    let across = across(offered, chosen);
    let wide = across.as_ref().map_or(1.0, |shown| shown.scale);
    let at = |point: &CampaignPoint| point.conditions.get(&chosen.by).copied();
    let points = curve.points.iter().filter_map(|point| {
        Some(Point {
            x: at(point)? * wide,
            value: point.estimate * scale,
            error: Some(point.standard_error * scale),
            ends: None,
            series: ids
                .iter()
                .position(|id| *id == point.job)
                .unwrap_or_default(),
            is_outlier: point.is_outlier,
        })
    });
    let points: Vec<Point> = points.collect();
    let along = match across {
        Some(Shown { unit, .. }) => format!("{} [{unit}]", words(&chosen.by)),
        None => chosen.by.clone(),
    };
    ErrorBars {
        label: format!(
            "{} in {unit} over {along}; the table has the numbers",
            curve.parameter
        ),
        curve: line(curve, &chosen.by, [scale, wide]),
        along: Some(along),
        places: "job",
        points,
    }
}

/// The curve between its first and last point. Its standard error is known at the points, and taken as straight between.
fn line(curve: &CampaignCurve, by: &str, [scale, wide]: [f64; 2]) -> Vec<[f64; 3]> {
    let known = curve.points.iter();
    let known =
        known.filter_map(|point| Some((*point.conditions.get(by)?, point.curve_standard_error)));
    let mut known: Vec<(f64, f64)> = known.collect();
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(&(first, _)), Some(&(last, _))) = (known.first(), known.last()) else {
        return Vec::new();
    };
    let at = |k: u32| first + (last - first) * f64::from(k) / f64::from(POINTS);
    let point = |x: f64| {
        let next = known
            .partition_point(|(place, _)| *place < x)
            .clamp(1, known.len() - 1);
        let ((a, from), (b, to)) = (known[next - 1], known[next]);
        let share = if b > a { (x - a) / (b - a) } else { 0.0 };
        let value: f64 = curve
            .terms
            .iter()
            .map(|term| term.value * x.powi(term.power()))
            .sum();
        [
            x * wide,
            value * scale,
            (from + share * (to - from)) * scale,
        ]
    };
    if known.len() < 2 {
        Vec::new()
    } else {
        (0..=POINTS).map(at).map(point).collect()
    }
}
