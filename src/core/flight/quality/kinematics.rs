//! Rates against the angles that they turn: units, signs and clocks show in the factor between an angle and the integral
//! of its rate, which is one whatever the aircraft.
//!
//! ```text
//! dθ/dt = q cos φ − r sin φ,   dφ/dt = p + tan θ (q sin φ + r cos φ),   dψ/dt = (q sin φ + r cos φ)/cos θ
//! dα/dt = q + Z α + ...,       dβ/dt = −r + Y β + (g/V) φ + ...
//! ```
//!
//! Biases are straight lines in the integrals and are taken out. A flow angle answers to its own integral, too, and where
//! its vane is ahead of the centre of gravity, to the rate itself: both are columns of the regression.

use crate::flight::{Finding, FindingCode, PhysicalQuantity};

use super::record::{Record, Series};
use super::statistics::{Regression, integral};

/// Samples of a window: long enough for a motion to turn, short enough for biases to be straight lines.
const WINDOW: usize = 600;
/// The share of an angle's variation that must be explained before its factor means anything.
const EXPLAINED: f64 = 0.8;
/// Of what is left without the rate, the share that it must explain.
const OWN_SHARE: f64 = 0.5;
/// Factors up to this, and down to its inverse, are scale factors and lags of sensors.
const USUAL: f64 = 2.0;

/// An angle, and the rate that turns it.
struct Pair<'r> {
    angle: &'r Series<'r>,
    rate: &'r Series<'r>,
    /// The rate of change of the angle at a sample, by the recorded rates.
    turns: Box<dyn Fn(usize) -> f64 + 'r>,
    /// By itself, or also by its own integral, the rate, and others.
    flows: bool,
    beside: Vec<&'r Series<'r>>,
}

pub(super) fn disagreements(record: &Record<'_>) -> Vec<Finding> {
    pairs(record)
        .iter()
        .filter(|pair| pair.angle.is_used || pair.rate.is_used)
        .filter_map(|pair| disagreement(record, pair))
        .collect()
}

fn pairs<'r>(record: &'r Record<'_>) -> Vec<Pair<'r>> {
    use PhysicalQuantity::{
        AngleOfAttack, AngleOfSideslip, HeadingAngle, PitchAngle, PitchRate, RollAngle, RollRate,
        YawRate,
    };
    let of = |quantity| record.of_quantity(quantity);
    let (p, q, r) = (of(RollRate), of(PitchRate), of(YawRate));
    let (phi, theta, psi) = (of(RollAngle), of(PitchAngle), of(HeadingAngle));
    let (alpha, beta) = (of(AngleOfAttack), of(AngleOfSideslip));
    let at = |series: Option<&'r Series<'r>>| {
        move |k: usize| series.map_or(0.0, |series| series.values[k])
    };
    let (p_at, q_at, r_at, theta_at, phi_at) = (at(p), at(q), at(r), at(theta), at(phi));
    let about_vertical = move |k: usize| q_at(k) * phi_at(k).sin() + r_at(k) * phi_at(k).cos();
    let attitudes = [
        pair(theta, q, move |k| {
            q_at(k) * phi_at(k).cos() - r_at(k) * phi_at(k).sin()
        }),
        pair(phi, p, move |k| {
            p_at(k) + theta_at(k).tan() * about_vertical(k)
        }),
        pair(psi, r, move |k| about_vertical(k) / theta_at(k).cos()),
    ];
    let flow_angles = [
        (pair(alpha, q, q_at), Vec::new()),
        (
            pair(beta, r, move |k| -r_at(k)),
            [p, phi].into_iter().flatten().collect(),
        ),
    ];
    let flowing = flow_angles.into_iter().filter_map(|(pair, beside)| {
        Some(Pair {
            flows: true,
            beside,
            ..pair?
        })
    });
    attitudes.into_iter().flatten().chain(flowing).collect()
}

/// An angle that its rate alone turns, where both are recorded.
fn pair<'r>(
    angle: Option<&'r Series<'r>>,
    rate: Option<&'r Series<'r>>,
    turns: impl Fn(usize) -> f64 + 'r,
) -> Option<Pair<'r>> {
    Some(Pair {
        angle: angle?,
        rate: rate?,
        turns: Box::new(turns),
        flows: false,
        beside: Vec::new(),
    })
}

/// The angle over the integral of its rate; `None` where the data do not tell.
fn factor(record: &Record<'_>, pair: &Pair<'_>) -> Option<f64> {
    let time = &record.time;
    let mut regression = Regression::default();
    for segment in record.segments() {
        let windows = segment.len().div_ceil(WINDOW).max(1);
        let length = segment.len().div_ceil(windows);
        for start in segment.clone().step_by(length.max(1)) {
            let rows = start..(start + length).min(segment.end);
            let time = &time[rows.clone()];
            let angle = unwrapped(&pair.angle.values[rows.clone()]);
            let mut columns = vec![integral(time, |k| (pair.turns)(rows.start + k))];
            if pair.flows {
                columns.push(integral(time, |k| angle[k]));
                columns.push(rows.clone().map(|k| (pair.turns)(k)).collect());
            }
            for series in &pair.beside {
                columns.push(integral(time, |k| series.values[rows.start + k]));
            }
            regression.add(time, &angle, &columns);
        }
    }
    let (with, without) = (regression.fit(None)?, regression.fit(Some(0)));
    let without = without.map_or(0.0, |fit| fit.explained);
    let own = (with.explained - without) / (1.0 - without).max(f64::MIN_POSITIVE);
    (with.explained > EXPLAINED && own > OWN_SHARE).then(|| with.coefficients[0])
}

fn disagreement(record: &Record<'_>, pair: &Pair<'_>) -> Option<Finding> {
    let factor = factor(record, pair)?;
    if factor > 1.0 / USUAL && factor < USUAL {
        return None;
    }
    let (angle, rate) = (pair.angle.name, pair.rate.name);
    let message = format!(
        "{angle} moves {:.3} times as far as {rate} integrates to{}",
        factor,
        looks_like(factor, angle, rate)
    );
    let remedy = match factor < 0.0 {
        true => {
            format!("turn the sign of one of them: \"channels\": {{\"{angle}\": \"-{angle}\"}}")
        }
        false => format!(
            "correct the unit in the recording's header or in a mapping, or say how the channel is made: \"channels\": {{\"{angle}\": \"{angle}*...\"}}"
        ),
    };
    Some(Finding::new(FindingCode::ChannelsDisagree, message, remedy).of_channel(angle))
}

/// What slips make of a factor.
fn looks_like(factor: f64, angle: &str, rate: &str) -> String {
    const DEGREES: f64 = 180.0 / std::f64::consts::PI;
    let near = |value: f64| (factor / value).ln().abs() < 0.3;
    if factor < 0.0 {
        return ": one of them has the other sign".to_string();
    }
    if near(DEGREES) {
        return format!(
            ": it looks like {angle} in degrees declared as radians, or {rate} in radians declared as degrees"
        );
    }
    if near(1.0 / DEGREES) {
        return format!(
            ": it looks like {angle} in radians declared as degrees, or {rate} in degrees declared as radians"
        );
    }
    for (value, slip) in [
        (1e-3, "time in milliseconds declared as seconds"),
        (1e-6, "time in microseconds declared as seconds"),
        (1e3, "time in seconds declared as milliseconds"),
        (
            1.0 / 60.0,
            "time in seconds declared as minutes, or a rate per minute",
        ),
    ] {
        if near(value) {
            return format!(": it looks like {slip}");
        }
    }
    String::new()
}

/// Jumps of more than half a turn taken out.
fn unwrapped(values: &[f64]) -> Vec<f64> {
    use std::f64::consts::TAU;
    let mut turns = 0.0;
    let mut before = f64::NAN;
    let step = |value: &f64| {
        if value.is_finite() && before.is_finite() {
            turns -= ((value - before) / TAU).round();
        }
        if value.is_finite() {
            before = *value;
        }
        value + turns * TAU
    };
    values.iter().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::noise;
    use super::*;
    use crate::flight::{Channel, Maneuver, Unit};

    const DEGREES: f64 = 180.0 / std::f64::consts::PI;

    /// The short period after pulses of the elevator, θ, and the lateral pair of a Dutch roll, at 50 Hz, rad.
    fn flown() -> Vec<(&'static str, Vec<f64>)> {
        let (mut alpha, mut q, mut theta) = (0.0, 0.0, 0.0);
        let (mut beta, mut r) = (0.03_f64, 0.0);
        let mut series = [vec![], vec![], vec![], vec![], vec![]];
        for k in 0..700 {
            let de = match k {
                50..120 => 0.02,
                120..180 => -0.02,
                300..330 => 0.02,
                _ => 0.0,
            };
            let noisy = |value: f64, seed: usize| value + 2e-4 * noise(k + seed * 1000);
            for (to, (value, seed)) in
                series
                    .iter_mut()
                    .zip([(alpha, 1), (q, 2), (theta, 3), (beta, 4), (r, 5)])
            {
                to.push(noisy(value, seed));
            }
            for _ in 0..10 {
                let (a, p, b, y) = (alpha, q, beta, r);
                alpha += 0.002 * (-1.4 * a + 0.97 * p - 0.1 * de);
                q += 0.002 * (-7.0 * a - 2.4 * p - 11.0 * de);
                theta += 0.002 * p;
                beta += 0.002 * (-0.2 * b - y);
                r += 0.002 * (4.0 * b - 0.3 * y);
            }
        }
        ["alpha", "q", "theta", "beta", "r"]
            .into_iter()
            .zip(series)
            .collect()
    }

    fn found(change: impl Fn(&str) -> f64, step: f64) -> Vec<String> {
        let unit = |name: &str| {
            if ["q", "r"].contains(&name) {
                "rad/s"
            } else {
                "rad"
            }
        };
        let channels = flown().into_iter().map(|(name, values)| {
            let values = values.iter().map(|value| value * change(name)).collect();
            let unit = unit(name);
            (
                name.to_string(),
                Channel::from_recorded(unit, Unit::parse(unit).unwrap(), values),
            )
        });
        let time = (0..700).map(|k| f64::from(k) * step).collect();
        let maneuver = Maneuver::new(time, channels.collect()).unwrap();
        let found = disagreements(&Record::of(&maneuver)).into_iter();
        found
            .map(|finding| format!("{}: {}", finding.channel.unwrap(), finding.message))
            .collect()
    }

    #[test]
    fn what_agrees_is_silent() {
        assert_eq!(found(|_| 1.0, 0.02), [""; 0]);
    }

    #[test]
    fn a_slip_of_one_channel_is_seen_and_named() {
        let slip = |channel: &'static str, factor: f64| {
            found(move |name| if name == channel { factor } else { 1.0 }, 0.02)
        };
        let q = slip("q", DEGREES);
        assert!(
            q.len() == 2 && q[1].contains("q in degrees declared as radians"),
            "{q:?}"
        );
        let theta = slip("theta", 1.0 / DEGREES);
        assert!(theta.len() == 1 && theta[0].contains("theta in radians declared as degrees"));
        let alpha = slip("alpha", DEGREES);
        assert!(alpha.len() == 1 && alpha[0].contains("alpha in degrees declared as radians"));
        let beta = slip("beta", -1.0);
        assert!(
            beta.len() == 1 && beta[0].contains("the other sign"),
            "{beta:?}"
        );
    }

    #[test]
    fn a_clock_in_another_unit_is_seen_by_all_pairs() {
        let found = found(|_| 1.0, 20.0);
        assert_eq!(found.len(), 3, "{found:?}");
        assert!(
            found
                .iter()
                .all(|text| text.contains("milliseconds declared as seconds"))
        );
    }
}
