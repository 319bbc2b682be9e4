//! Parameters of many jobs over a condition, or their weighted means: whether the jobs agree, and which are outliers.

use maud::{Markup, html};

use super::error_bars::{ErrorBars, Point};
use crate::estimate::five_digits as number;
use crate::flight::{Shown, p_value, shown_in, with_error};
use crate::job::{Campaign, CampaignCurve, CampaignPoint, CampaignTerm, channel_of};

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
        @for job in &campaign.left_out { p.soft { (job.name) " is left out: " (job.reason) "." } }
        @if campaign.curves.is_empty() { p { "No parameter with a standard error is left." } }
        @else { (table(campaign, across(offered, chosen).map_or(1.0, |shown| shown.scale))) }
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
        ul.links { li { a href=(address(chosen, ids)) { "this table (CSV)" } } }
    }
}

fn words(by: &str) -> String {
    match channel_of(by) {
        Some(channel) => format!("the mean of {channel}"),
        None => by.to_string(),
    }
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

fn address(chosen: &Chosen, ids: &[&str]) -> String {
    let mut query = form_urlencoded::Serializer::new(String::new());
    query.append_pair("jobs", &ids.join(","));
    for (name, value) in [("by", &chosen.by), ("group", &chosen.group)] {
        if !value.is_empty() {
            query.append_pair(name, value);
        }
    }
    query.append_pair("format", "csv");
    format!("/v1/campaigns?{}", query.finish())
}

fn table(campaign: &Campaign, wide: f64) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-labelledby="conditions" { table {
            thead { tr {
                th scope="col" { "parameter" } th scope="col" { "unit" } th scope="col" { "mean or curve" }
                th.number scope="col" { "χ²" } th.number scope="col" { "degrees of freedom" } th.number scope="col" { "by chance" } th scope="col" { "outliers" }
            } }
            tbody { @for curve in &campaign.curves { tr {
                th scope="row" { (curve.parameter) @if let Some(group) = group_of(curve) { " " span.soft { (group) } } }
                td.soft { (shown_in(&curve.unit).unit) }
                td { (terms(curve, wide)) }
                td.number { (number(curve.chi_squared)) } td.number { (curve.degrees_of_freedom) }
                td.number { @if let Some(p) = curve.probability { (p_value(p)) } }
                td { (outliers(curve)) }
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

/// In the units of the figures.
fn terms(curve: &CampaignCurve, wide: f64) -> String {
    let Shown { scale, .. } = shown_in(&curve.unit);
    let text = |term: &CampaignTerm| {
        let scale = scale / wide.powi(power(&term.term));
        let value = with_error(term.value * scale, term.standard_error * scale);
        if term.term == "1" {
            value
        } else {
            format!("({value}) {}", term.term)
        }
    };
    curve.terms.iter().map(text).collect::<Vec<_>>().join(" + ")
}

/// How the condition that was chosen is shown: angles in degrees. Nothing of a tag.
fn across(offered: &Offered, chosen: &Chosen) -> Option<Shown> {
    let channel = channel_of(&chosen.by)?;
    let (_, unit) = offered.channels.iter().find(|(name, _)| name == channel)?;
    Some(shown_in(unit))
}

fn outliers(curve: &CampaignCurve) -> String {
    let of = curve.points.iter().filter(|point| point.is_outlier);
    let of = of.map(|point| format!("{} ({:+.1} s.e.)", point.name, point.deviation));
    of.collect::<Vec<_>>().join(", ")
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
            .map(|term| term.value * x.powi(power(&term.term)))
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

/// Of a term in one condition: `1`, `alpha`, `alpha^2`.
fn power(term: &str) -> i32 {
    match term.rsplit_once('^') {
        Some((_, power)) => power.parse().unwrap_or(1),
        None => i32::from(term != "1"),
    }
}
