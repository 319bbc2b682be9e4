//! Air data against each other: dynamic pressure, airspeed, Mach number and speed over ground.

use crate::flight::PhysicalQuantity::{AirDensity, Airspeed, DynamicPressure, Mach};
use crate::flight::{Finding, FindingCode};

use super::record::{Record, Series};
use super::statistics::median;

/// kg/m³, at sea level.
const RHO_0: f64 = 1.225;

/// No quantity of a model: speeds over ground are recorded beside it.
const GROUND_SPEED: [&str; 6] = [
    "gs",
    "v_gs",
    "vg",
    "ground_speed",
    "groundspeed",
    "v_ground",
];

pub(super) fn disagreements(record: &Record<'_>) -> Vec<Finding> {
    let Some(speed) = record.of_quantity(Airspeed) else {
        return Vec::new();
    };
    let pressure = record.of_quantity(DynamicPressure);
    let density = record.of_quantity(AirDensity);
    let mach = record.of_quantity(Mach);
    let ground = record.speed_named(&GROUND_SPEED);
    let mut findings = Vec::new();
    if let Some(pressure) = pressure {
        let ratio = |k: usize| {
            let rho = density.map_or(RHO_0, |density| density.values[k]);
            pressure.values[k] / (0.5 * rho * speed.values[k].powi(2))
        };
        // without a density that of any height up to 18 km will do
        let usual = if density.is_some() {
            0.75..1.35
        } else {
            0.09..1.35
        };
        let what = "the dynamic pressure over ½ρV²";
        findings.extend(out_of(record, usual, ratio, what, [pressure, speed]));
    }
    if let Some(mach) = mach {
        let sound = |k: usize| speed.values[k] / mach.values[k];
        let what = "the airspeed over the Mach number, the speed of sound in m/s,";
        findings.extend(out_of(record, 240.0..400.0, sound, what, [speed, mach]));
    }
    if let Some(ground) = ground {
        let ratio = |k: usize| speed.values[k] / ground.values[k];
        let what = "the airspeed over the speed over ground";
        findings.extend(out_of(record, 0.55..1.8, ratio, what, [speed, ground]));
    }
    findings
}

fn out_of(
    record: &Record<'_>,
    usual: std::ops::Range<f64>,
    ratio: impl Fn(usize) -> f64,
    what: &str,
    of: [&Series<'_>; 2],
) -> Option<Finding> {
    if !of.iter().any(|series| series.is_used) {
        return None;
    }
    // on the ground nothing moves, and quotients mean nothing
    let moving = (0..record.time.len()).filter(|&k| of.iter().all(|s| s.values[k].abs() > 1e-3));
    let ratio = median(moving.map(ratio))?;
    if usual.contains(&ratio) {
        return None;
    }
    let [first, second] = of.map(|series| series.name);
    let message = format!(
        "{first} and {second} disagree: {what} is {ratio:.3}, where {} to {} is usual",
        usual.start, usual.end
    );
    let remedy = "see the units of both in the recording's header (kt, km/h, ft/s, hPa), and correct the one that has slipped";
    Some(Finding::new(FindingCode::ChannelsDisagree, message, remedy).of_channel(first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::{Channel, Maneuver, Unit};

    fn found(channels: &[(&str, &str, f64)]) -> usize {
        let channels = channels.iter().map(|(name, unit, value)| {
            let values = (0..100).map(|k| value * (1.0 + 0.02 * (f64::from(k) * 0.1).sin()));
            let unit_of = Unit::parse(unit).unwrap();
            (
                name.to_string(),
                Channel::from_recorded(unit, unit_of, values.collect()),
            )
        });
        let time = (0..100).map(|k| f64::from(k) * 0.1).collect();
        let maneuver = Maneuver::new(time, channels.collect()).unwrap();
        disagreements(&Record::of(&maneuver)).len()
    }

    #[test]
    fn a_speed_in_another_unit_contradicts_pressure_mach_and_ground_speed() {
        let right = [
            ("V", "m/s", 130.0),
            ("qbar", "Pa", 0.5 * 0.74 * 130.0 * 130.0),
        ];
        let rho = ("rho", "kg/m^3", 0.74);
        assert_eq!(found(&[right[0], right[1], rho]), 0);
        assert_eq!(found(&right), 0);
        assert_eq!(found(&[("V", "m/s", 252.7), right[1], rho]), 1, "knots");
        assert_eq!(
            found(&[("V", "m/s", 130.0), ("qbar", "Pa", 62.5), rho]),
            1,
            "hPa"
        );
        assert_eq!(found(&[right[0], ("mach", "-", 0.41)]), 0);
        assert_eq!(found(&[("V", "m/s", 252.7), ("mach", "-", 0.41)]), 1);
        assert_eq!(found(&[right[0], ("gs", "m/s", 118.0)]), 0, "wind");
        assert_eq!(found(&[right[0], ("gs", "m/s", 250.0)]), 1);
    }
}
