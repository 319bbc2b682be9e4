//! A number of several jobs, or by several methods, as points with error bars: side by side, or over a condition with a
//! curve.

use maud::{Markup, html};

use super::palette::colour;
use super::ticks::{steps, tidy};
use crate::ingest::CsvWriter;

/// A point of the figure.
pub(super) struct Point {
    /// Along the axis: its place from 0, or a condition.
    pub x: f64,
    pub value: f64,
    /// None of a fixed parameter.
    pub error: Option<f64>,
    /// Where the bar ends, if that is not two standard errors to each side.
    pub ends: Option<[f64; 2]>,
    /// Whose it is: the place of a job or a method from 0.
    pub series: usize,
    pub is_outlier: bool,
}

/// What is drawn.
pub(super) struct ErrorBars {
    /// For those who do not see it.
    pub label: String,
    /// Where `x` are places, a number for each: that of the series from 1. Else the condition with its unit.
    pub along: Option<String>,
    /// What a series is.
    pub places: &'static str,
    pub points: Vec<Point>,
    /// By `x`: the curve, and its band of 2 standard errors.
    pub curve: Vec<[f64; 3]>,
}

const HEIGHT: f64 = 190.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = 38.0;

/// Error bars are two standard errors to each side.
const TIMES: f64 = 2.0;

impl Point {
    /// Where its bar begins and ends.
    fn bar(&self) -> Option<[f64; 2]> {
        let of_error = |error: f64| [self.value - TIMES * error, self.value + TIMES * error];
        let bar = self.ends.or_else(|| self.error.map(of_error));
        bar.filter(|ends| ends.iter().all(|end| end.is_finite()))
    }
}

impl ErrorBars {
    /// As SVG, in the colours of the page.
    pub(super) fn drawn(&self) -> Markup {
        let width = match self.along {
            Some(_) => 400.0,
            None => (LEFT + RIGHT + 34.0 * self.points.len() as f64).max(200.0),
        };
        let (low, high) = self.range();
        let (first, last) = self.domain();
        let x = |at: f64| LEFT + (at - first) / (last - first) * (width - LEFT - RIGHT);
        let y = |value: f64| TOP + (high - value) / (high - low) * (HEIGHT - TOP - BOTTOM);
        let base = HEIGHT - BOTTOM;
        html! {
            svg viewBox={ "0 0 " (width) " " (HEIGHT) } width=(width) style="max-width: 100%; height: auto" role="img"
                aria-label=(self.label) fill="currentColor" font-size="11" {
                line x1=(LEFT) x2=(width - RIGHT) y1=(base) y2=(base) stroke="currentColor" opacity=".5" {}
                @for tick in steps(low, high) {
                    line x1=(LEFT) x2=(width - RIGHT) y1=(round(y(tick))) y2=(round(y(tick))) stroke="var(--line)" {}
                    text x=(LEFT - 6.0) y=(round(y(tick) + 4.0)) text-anchor="end" { (tidy(tick)) }
                }
                (self.band(x, y))
                @for point in self.points.iter().filter(|point| point.value.is_finite()) {
                    @let (cx, cy) = (round(x(point.x)), round(y(point.value)));
                    g stroke=(colour(point.series)) stroke-width="2" fill=(colour(point.series)) {
                        @if let Some([lower, upper]) = point.bar() {
                            line x1=(cx) x2=(cx) y1=(round(y(lower))) y2=(round(y(upper))) {}
                        }
                        circle cx=(cx) cy=(cy) r="3.5" fill=[point.is_outlier.then_some("var(--paper)")] {}
                    }
                }
                @match self.along {
                    None => @for point in &self.points {
                        text x=(round(x(point.x))) y=(base + 15.0) text-anchor="middle" { (point.series + 1) }
                    },
                    Some(_) => @for tick in steps(first, last) {
                        line x1=(round(x(tick))) x2=(round(x(tick))) y1=(base) y2=(base + 4.0) stroke="currentColor" {}
                        text x=(round(x(tick))) y=(base + 15.0) text-anchor="middle" { (tidy(tick)) }
                    },
                }
                text x=(round(0.5 * (LEFT + width - RIGHT))) y=(HEIGHT - 6.0) text-anchor="middle" { (self.along.as_deref().unwrap_or(self.places)) }
            }
        }
    }

    /// What is drawn, as CSV.
    pub(super) fn table(&self) -> String {
        let along = self.along.as_deref().unwrap_or("place");
        let has_ends = self.points.iter().any(|point| point.ends.is_some());
        let mut csv = match has_ends {
            true => CsvWriter::with_header([along, "value", "lower", "upper", self.places]),
            false => CsvWriter::with_header([along, "value", "standard_error", self.places]),
        };
        for point in &self.points {
            csv.number(point.x);
            csv.number(point.value);
            match (has_ends, point.bar()) {
                (true, bar) => {
                    csv.number(bar.map(|[lower, _]| lower));
                    csv.number(bar.map(|[_, upper]| upper));
                }
                (false, _) => csv.number(point.error),
            }
            csv.text(&(point.series + 1).to_string());
            csv.end_row();
        }
        csv.finish()
    }

    fn band(&self, x: impl Fn(f64) -> f64, y: impl Fn(f64) -> f64) -> Markup {
        let within = |value: f64| y(value).clamp(TOP, HEIGHT - BOTTOM);
        let at = |place: f64, value: f64| format!("{:.1},{:.1}", x(place), within(value));
        let upper = self
            .curve
            .iter()
            .map(|[place, value, error]| at(*place, value + TIMES * error));
        let lower = (self.curve.iter().rev())
            .map(|[place, value, error]| at(*place, value - TIMES * error));
        let outline: Vec<String> = upper.chain(lower).collect();
        let line: Vec<String> = (self.curve.iter())
            .map(|[place, value, _]| at(*place, *value))
            .collect();
        html! {
            @if line.len() > 1 {
                polygon points=(outline.join(" ")) fill="var(--soft)" opacity=".18" {}
                polyline points=(line.join(" ")) fill="none" stroke="var(--soft)" stroke-width="1.5" {}
            }
        }
    }

    /// Of all points with their bars, and of the curve; its band may be wider.
    fn range(&self) -> (f64, f64) {
        let bars = self.points.iter().flat_map(|point| {
            let none = [point.value, point.value];
            point.bar().unwrap_or(none)
        });
        let (low, high) = extremes(bars.chain(self.curve.iter().map(|[_, value, _]| *value)));
        let room = 0.06 * (high - low);
        (low - room, high + room)
    }

    fn domain(&self) -> (f64, f64) {
        let (first, last) = extremes(self.points.iter().map(|point| point.x));
        let room = match self.along {
            Some(_) => 0.05 * (last - first),
            None => 0.5,
        };
        (first - room, last + room)
    }
}

/// The smallest and the largest of finite values, never equal.
fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    if low > high {
        return (-1.0, 1.0);
    }
    let room = 1e-6 * low.abs().max(high.abs()).max(1e-9);
    if high - low < room {
        (low - room, high + room)
    } else {
        (low, high)
    }
}

fn round(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_has_two_ends() {
        assert!(extremes([2.0, f64::NAN].into_iter()).0 < 2.0);
        assert_eq!(extremes([].into_iter()), (-1.0, 1.0));
    }

    /// Between two points far apart a curve may be hardly known.
    #[test]
    fn a_wide_band_stays_within_the_axes() {
        let point = |x: f64| Point {
            x,
            value: x,
            error: Some(0.1),
            ends: None,
            series: 0,
            is_outlier: false,
        };
        let figure = ErrorBars {
            label: "Ma".into(),
            along: Some("alpha".into()),
            places: "job",
            points: vec![point(0.0), point(1.0)],
            curve: vec![[0.0, 0.0, 0.1], [0.5, 0.5, 40.0], [1.0, 1.0, 0.1]],
        };
        let svg = figure.drawn().into_string();
        let (_, outline) = svg.split_once("polygon points=\"").expect("a band");
        let (outline, _) = outline.split_once('"').expect("its end");
        let heights: Vec<f64> = (outline.split(' '))
            .map(|point| {
                point
                    .split_once(',')
                    .expect("a pair")
                    .1
                    .parse()
                    .expect("a number")
            })
            .collect();
        let (low, high) = extremes(heights.into_iter());
        assert_eq!((low, high), (TOP, HEIGHT - BOTTOM));
    }

    #[test]
    fn a_point_stands_between_the_ends_of_its_bar() {
        let figure = ErrorBars {
            label: "Ma".into(),
            along: None,
            places: "job",
            points: vec![Point {
                x: 0.0,
                value: 1.0,
                error: Some(0.5),
                ends: None,
                series: 2,
                is_outlier: false,
            }],
            curve: Vec::new(),
        };
        let svg = figure.drawn().into_string();
        // from 0 to 2 with 6 % of room on a plot of 142: the bar from 17.6 to 144.4, the point between
        assert!(
            svg.contains("y1=\"144.4\" y2=\"17.6\"") && svg.contains("cy=\"81\""),
            "{svg}"
        );
        assert!(svg.contains(">3</text>"), "{svg}");
    }
}
