//! An unmodelled force in words: where, how large, on what it depends, when, and what would decide.

use super::equations::Equation;
use super::report::{ForceDependence, LeftBy, Unmodelled};
use crate::estimate::five_digits;
use crate::flight::{Shown, shown_in};

/// A share from which on one may speak of a dependence.
pub(super) const SPOKEN_OF: f64 = 0.3;

/// Shares that differ by less than this cannot be told apart.
const APART: f64 = 0.1;

pub(super) fn of(equation: &Equation, found: &Unmodelled) -> String {
    let Shown { scale, unit } = shown_in(&found.unit);
    let number = |value: f64| three_digits(value * scale);
    let size = format!(
        "{} {unit} (rms {})",
        number(found.largest),
        number(found.rms)
    );
    let place = equation.words();
    let when = &found.strongest;
    let when = format!(
        "half of it in {} lies between {:.1} and {:.1} s",
        when.segment, when.from, when.to
    );
    let (depends, decide) = match found.depends_on.as_slice() {
        [best, others @ ..] if best.share > SPOKEN_OF => {
            let alike: Vec<&ForceDependence> = (others.iter())
                .filter(|other| best.share - other.share < APART)
                .take(2)
                .collect();
            (on(best), separates(best, &alike))
        }
        _ => (
            format!(
                "it depends on nothing that was recorded or computed; most of its power lies between {} and {} Hz",
                three_digits(found.spectrum.lower),
                three_digits(found.spectrum.upper)
            ),
            "fly the maneuver again to see whether it returns at the same time, and record what else moves (surfaces, \
             loads, fuel, configuration)"
                .to_string(),
        ),
    };
    let what = match found.left_by {
        LeftBy::WithEffects => "what is left",
        LeftBy::Declared => "what the declared model leaves",
    };
    format!(
        "{what} looks like a force in {place} of up to {size}; {depends}; {when}. To decide, {decide}"
    )
}

fn on(best: &ForceDependence) -> String {
    format!(
        "it depends on {}: {:.0} % of it in data that the dependence was not fitted to",
        best.quantity,
        100.0 * best.share.min(1.0)
    )
}

fn separates(best: &ForceDependence, alike: &[&ForceDependence]) -> String {
    if alike.is_empty() {
        return format!(
            "fly maneuvers that take {} further to both sides, slowly and quickly",
            best.quantity
        );
    }
    let names: Vec<&str> = alike.iter().map(|other| other.quantity.as_str()).collect();
    format!(
        "fly maneuvers in which {} and {} do not move together: these data hardly tell them apart",
        best.quantity,
        names.join(" or ")
    )
}

fn three_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let text = five_digits(rounded);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.012_345, 1.0, 123.4, 0.0].map(three_digits);
        assert_eq!(shown, ["0.0123", "1", "123", "0"]);
    }
}
