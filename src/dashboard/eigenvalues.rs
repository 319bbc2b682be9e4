//! Eigenvalues of the estimated model in the complex plane, with their error bounds.

use maud::{Markup, html};

use super::ticks::{steps, tidy};
use crate::estimate::{Measure, Mode};
use crate::ingest::CsvWriter;

const WIDTH: f64 = 420.0;
const HEIGHT: f64 = 300.0;
const MARGIN: f64 = 42.0;

/// An eigenvalue in the plane.
struct Cross<'a> {
    mode: &'a Mode,
    /// As style sheets write it.
    colour: &'a str,
    text: String,
    /// How far its text is moved on, so that those of several sets do not lie over each other.
    shift: f64,
}

/// The upper half of the plane and the real axis, as a picture; lower ones are mirror images.
pub(super) fn plane(modes: &[Mode]) -> Markup {
    let cross = |mode| Cross {
        mode,
        colour: "var(--measured)",
        text: short(mode),
        shift: 0.0,
    };
    drawn(modes.iter().map(cross).collect())
}

/// Several sets in one plane, each in its colour and with its name at each eigenvalue.
pub(super) fn plane_of_several(sets: &[(String, &str, &[Mode])]) -> Markup {
    let crosses = sets
        .iter()
        .enumerate()
        .flat_map(|(at, (name, colour, modes))| {
            modes.iter().map(move |mode| Cross {
                mode,
                colour,
                text: name.clone(),
                shift: 12.0 * (at % 8) as f64,
            })
        });
    drawn(crosses.collect())
}

fn drawn(crosses: Vec<Cross<'_>>) -> Markup {
    let crosses: Vec<Cross<'_>> = (crosses.into_iter())
        .filter(|Cross { mode, .. }| {
            mode.real.value.is_finite() && mode.imaginary.value.is_finite()
        })
        .collect();
    let shown: Vec<&Mode> = crosses.iter().map(|cross| cross.mode).collect();
    let with_bound = |measure: Measure| measure.value.abs() + bound(measure);
    let furthest = |of: fn(&Mode) -> Measure| {
        let largest = shown
            .iter()
            .map(|mode| with_bound(of(mode)))
            .fold(0.0, f64::max);
        if largest > 0.0 { 1.15 * largest } else { 1.0 }
    };
    let (most_real, most_imaginary) = (furthest(|mode| mode.real), furthest(|mode| mode.imaginary));
    // room on the unstable side, too, if something is there
    let rightmost =
        (shown.iter().map(|mode| mode.real.value + bound(mode.real))).fold(0.0, f64::max);
    let right = (1.3 * rightmost).max(0.15 * most_real);
    let x = |real: f64| MARGIN + (real + most_real) / (most_real + right) * (WIDTH - 1.5 * MARGIN);
    let y = |imaginary: f64| HEIGHT - MARGIN - imaginary / most_imaginary * (HEIGHT - 1.7 * MARGIN);
    let words: Vec<String> = (crosses.iter())
        .map(|cross| format!("{} {}", cross.text, cross.mode.eigenvalue()))
        .collect();
    html! {
        figure data-name="eigenvalues" data-values=(table(&crosses)) {
            svg.plane viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } role="img" aria-label={ "eigenvalues, 1/s: " (words.join("; ")) }
                width=(WIDTH) style="max-width: 100%; height: auto" fill="currentColor" font-size="12" {
                rect x=(x(0.0)) y="8" width=((WIDTH - 0.5 * MARGIN - x(0.0)).max(0.0)) height=(HEIGHT - MARGIN - 8.0)
                    fill="var(--model)" opacity=".13" {}
                line x1=(MARGIN) x2=(WIDTH - 0.5 * MARGIN) y1=(y(0.0)) y2=(y(0.0)) stroke="currentColor" {}
                line x1=(x(0.0)) x2=(x(0.0)) y1="8" y2=(y(0.0)) stroke="currentColor" {}
                @for tick in steps(-most_real, right) {
                    line x1=(x(tick)) x2=(x(tick)) y1=(y(0.0)) y2=(y(0.0) + 4.0) stroke="currentColor" {}
                    text x=(x(tick)) y=(y(0.0) + 17.0) text-anchor="middle" { (tidy(tick)) }
                }
                @for tick in steps(0.0, most_imaginary).into_iter().filter(|tick| *tick > 0.0) {
                    line x1=(x(0.0) - 4.0) x2=(x(0.0)) y1=(y(tick)) y2=(y(tick)) stroke="currentColor" {}
                    text x=(x(0.0) + 5.0) y=(y(tick) + 4.0) { (tidy(tick)) }
                }
                text x=(WIDTH / 2.0) y=(HEIGHT - 6.0) text-anchor="middle" { "real part, 1/s" }
                @for Cross { mode, colour, text, shift } in &crosses {
                    @let (re, im) = (mode.real, mode.imaginary);
                    @let (cx, cy) = (x(re.value), y(im.value.abs()));
                    g stroke=(colour) stroke-width="2" fill="none" {
                        line x1=(x(re.value - bound(re))) x2=(x(re.value + bound(re))) y1=(cy) y2=(cy) stroke-width="1" {}
                        line x1=(cx) x2=(cx) y1=(y((im.value.abs() - bound(im)).max(0.0))) y2=(y(im.value.abs() + bound(im))) stroke-width="1" {}
                        path d={ "M" (cx - 5.0) " " (cy - 5.0) "l10 10m0 -10l-10 10" } {}
                    }
                    // towards the side where there is room
                    @let is_left = cx < 0.6 * WIDTH;
                    text x=(cx + if is_left { 8.0 + shift } else { -8.0 - shift }) y=(cy - 8.0) text-anchor=(if is_left { "start" } else { "end" }) { (text) }
                }
            }
            figcaption { "Eigenvalues with 2 standard errors; what is right of the axis grows. Imaginary part upwards, rad/s." }
        }
    }
}

/// What is drawn, as CSV.
fn table(crosses: &[Cross<'_>]) -> String {
    let mut csv = CsvWriter::with_header([
        "name",
        "real[1/s]",
        "real_standard_error[1/s]",
        "imaginary[rad/s]",
        "imaginary_standard_error[rad/s]",
    ]);
    for Cross { mode, text, .. } in crosses {
        csv.text(text);
        for measure in [mode.real, mode.imaginary] {
            csv.number(measure.value);
            csv.number(measure.standard_error);
        }
        csv.end_row();
    }
    csv.finish()
}

/// Its name alone, where it has one: the table has the states.
fn short(mode: &Mode) -> String {
    match (mode.name, &mode.segment) {
        (Some(name), Some(segment)) => format!("{} [{segment}]", name.words()),
        (Some(name), None) => name.words().to_string(),
        (None, _) => mode.label(),
    }
}

/// Two standard errors.
fn bound(measure: Measure) -> f64 {
    2.0 * measure
        .standard_error
        .filter(|error| error.is_finite())
        .unwrap_or(0.0)
}
