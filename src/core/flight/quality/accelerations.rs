//! Accelerometers against gravity and attitude: which of the three carries the weight, with which sign, in which unit.
//!
//! In steady flight specific force is the reaction to gravity: a_x = g sin θ, a_y ≈ 0, a_z = −g cos θ cos φ with x
//! forward, y right, z down.

use crate::flight::PhysicalQuantity::{AccelerationX, AccelerationY, AccelerationZ, PitchAngle};
use crate::flight::{Finding, FindingCode};

use super::record::{Record, Series};
use super::statistics::median;

/// m/s².
const G: f64 = 9.80665;

pub(super) fn disagreements(record: &Record<'_>) -> Vec<Finding> {
    let axes = [AccelerationX, AccelerationY, AccelerationZ].map(|axis| record.of_quantity(axis));
    let used = axes.iter().flatten().any(|series| series.is_used);
    let [ax, ay, Some(az)] = axes else {
        return Vec::new();
    };
    let theta = record.of_quantity(PitchAngle);
    let usual = |series: &Series<'_>| median(series.values.iter().copied());
    let tilt = theta.and_then(|theta| median(theta.values.iter().map(|theta| theta.sin())));
    // on its tail or its nose other axes carry the weight
    if !used || tilt.is_some_and(|tilt| tilt.abs() > 0.7) {
        return Vec::new();
    }
    let Some(down) = usual(az) else {
        return Vec::new();
    };
    let (forward, right) = (ax.and_then(usual), ay.and_then(usual));
    if let Some(finding) = weight(az.name, down, [(ax, forward), (ay, right)]) {
        return vec![finding];
    }
    let (Some(ax), Some(ay), Some(forward), Some(right), Some(tilt)) =
        (ax, ay, forward, right, tilt)
    else {
        return Vec::new();
    };
    attitude([ax.name, ay.name], [forward, right], G * tilt)
        .into_iter()
        .collect()
}

/// Whether the axis that points down carries the weight.
fn weight(
    name: &str,
    down: f64,
    others: [(Option<&Series<'_>>, Option<f64>); 2],
) -> Option<Finding> {
    let finding = |message: String, remedy: String| {
        Some(Finding::new(FindingCode::ChannelsDisagree, message, remedy).of_channel(name))
    };
    let heaviest = others
        .iter()
        .filter_map(|(series, usual)| Some((series.as_ref()?.name, (*usual)?)))
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    if let Some((other, usual)) = heaviest
        && usual.abs() > 0.7 * G
        && down.abs() < 0.4 * G
    {
        let message = format!(
            "{other} is {usual:.1} m/s^2 on average and {name} {down:.1}: {other} carries the weight of the aircraft, as {name} should; they look exchanged"
        );
        let remedy = format!(
            "exchange them: \"channels\": {{\"{name}\": \"{other}\", \"{other}\": \"{name}\"}}, with the signs of x forward, y right, z down"
        );
        return finding(message, remedy);
    }
    if (0.6 * G..1.6 * G).contains(&down) {
        let message = format!(
            "{name} is {down:.1} m/s^2 on average: it points up, where the models have z down and {name} about -9.8"
        );
        let remedy = format!("turn its sign: \"channels\": {{\"{name}\": \"-{name}\"}}");
        return finding(message, remedy);
    }
    if (0.6..1.6).contains(&down.abs()) {
        let message = format!(
            "{name} is {down:.2} m/s^2 on average: it looks like multiples of g declared as m/s^2"
        );
        let remedy = format!(
            "correct the unit in the recording's header to g, or say \"channels\": {{\"{name}\": \"9.80665*{name}\"}}"
        );
        return finding(message, remedy);
    }
    None
}

/// Whether the axes that point forward and right are those, by the share of gravity that the pitch attitude gives them.
fn attitude(names: [&str; 2], [forward, right]: [f64; 2], expected: f64) -> Option<Finding> {
    let [x, y] = names;
    let as_they_are = (forward - expected).abs() + right.abs();
    let exchanged = (right - expected).abs() + forward.abs();
    let turned = (forward + expected).abs() + right.abs();
    let (message, remedy) = if as_they_are > 0.5 && exchanged < as_they_are / 3.0 {
        (
            format!(
                "{x} is {forward:.2} and {y} {right:.2} m/s^2 on average, where the pitch attitude asks for {expected:.2} along x and 0 along y: they look exchanged"
            ),
            format!("exchange them: \"channels\": {{\"{x}\": \"{y}\", \"{y}\": \"{x}\"}}"),
        )
    } else if as_they_are > 0.8 && turned < as_they_are / 3.0 {
        (
            format!(
                "{x} is {forward:.2} m/s^2 on average, where the pitch attitude asks for {expected:.2}: it has the other sign"
            ),
            format!("turn its sign: \"channels\": {{\"{x}\": \"-{x}\"}}"),
        )
    } else {
        return None;
    };
    Some(Finding::new(FindingCode::ChannelsDisagree, message, remedy).of_channel(x))
}

#[cfg(test)]
mod tests {
    use super::super::tests::noise;
    use super::*;
    use crate::flight::{Channel, Maneuver, Unit};

    /// Of the columns ax, ay, az as they are headed, the axis that each has, with a factor; θ is 5 deg.
    fn found(columns: [(usize, f64); 3]) -> Option<String> {
        let tilt = 5f64.to_radians();
        let axes = [G * tilt.sin(), 0.02, -G * tilt.cos()];
        let channel = |unit: &str, value: f64, seed: usize| {
            let values = (0..200).map(|k| value + 0.01 * noise(k + seed)).collect();
            Channel::from_recorded(unit, Unit::parse(unit).unwrap(), values)
        };
        let mut channels: indexmap::IndexMap<String, Channel> = (["ax", "ay", "az"].iter())
            .zip(columns)
            .map(|(name, (axis, factor))| {
                (
                    name.to_string(),
                    channel("m/s^2", axes[axis] * factor, axis * 999),
                )
            })
            .collect();
        channels.insert("theta".to_string(), channel("rad", tilt, 9999));
        let time = (0..200).map(|k| f64::from(k) * 0.1).collect();
        let maneuver = Maneuver::new(time, channels).unwrap();
        let found = disagreements(&Record::of(&maneuver));
        assert!(found.len() <= 1);
        found.into_iter().next().map(|finding| finding.message)
    }

    #[test]
    fn order_sign_and_unit_are_told() {
        assert_eq!(found([(0, 1.0), (1, 1.0), (2, 1.0)]), None);
        let says = |columns, words: &str| {
            let message = found(columns).unwrap();
            assert!(message.contains(words), "{message}");
        };
        says([(0, 1.0), (2, 1.0), (1, 1.0)], "they look exchanged");
        says([(2, 1.0), (1, 1.0), (0, 1.0)], "they look exchanged");
        says([(1, 1.0), (0, 1.0), (2, 1.0)], "they look exchanged");
        says([(0, 1.0), (1, 1.0), (2, -1.0)], "it points up");
        says([(0, -1.0), (1, 1.0), (2, 1.0)], "it has the other sign");
        says([(0, 1.0 / G), (1, 1.0 / G), (2, 1.0 / G)], "multiples of g");
    }
}
