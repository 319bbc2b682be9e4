//! A parameter that changes in flight.

use std::sync::Arc;

use serde_json::json;
use trimtab_core::flight::Maneuver;
use trimtab_core::model::ModelDocument;

use super::{normal, place, push, tracker, with};
use crate::common::plans::plan;

/// Ma changes from -3.4 to -2.4 1/s² while the elevator goes on with a sum of sines.
pub(super) fn changing(seed: u64) -> (ModelDocument, Arc<Maneuver>) {
    let document = r#"
        name = "changing"
        [inputs.de]
        unit = "rad"
        [parameters]
        Za = { unit = "1/s", start = -0.8 }
        Zde = { unit = "1/s", start = -0.1 }
        Ma = { unit = "1/s^2", start = -3.0 }
        Mq = { unit = "1/s", start = -1.5 }
        Mde = { unit = "1/s^2", start = -5.0 }
        [states.alpha]
        unit = "rad"
        initial = "0"
        derivative = "Za*alpha + q + Zde*de"
        [states.q]
        unit = "rad/s"
        initial = "0"
        derivative = "Ma*alpha + Mq*q + Mde*de"
        [outputs.alpha]
        unit = "rad"
        equation = "alpha"
        [outputs.q]
        unit = "rad/s"
        equation = "q"
    "#;
    let (step, count) = (0.02, 4001);
    let de = |t: f64| {
        0.01 * [0.3, 0.5, 0.8, 1.1]
            .iter()
            .enumerate()
            .map(|(i, f)| (std::f64::consts::TAU * f * t + i as f64).sin())
            .sum::<f64>()
    };
    let slope = |t: f64, [alpha, q]: [f64; 2]| {
        let ma = if t < 40.0 { -3.4 } else { -2.4 };
        [
            -0.85 * alpha + q - 0.08 * de(t),
            ma * alpha - 1.6 * q - 4.8 * de(t),
        ]
    };
    let mut x = [0.0, 0.0];
    let (mut time, mut channels) = (Vec::new(), [const { Vec::new() }; 3]);
    for k in 0..count {
        let t = f64::from(k) * step;
        let noise = |n: u64| normal(seed * 100_000 + 2 * u64::try_from(k).expect("a count") + n);
        time.push(t);
        for (channel, value) in
            channels
                .iter_mut()
                .zip([de(t), x[0] + 2e-4 * noise(0), x[1] + 4e-4 * noise(1)])
        {
            channel.push(value);
        }
        let along = |x: [f64; 2], h: f64, k: [f64; 2]| [x[0] + h * k[0], x[1] + h * k[1]];
        let k1 = slope(t, x);
        let k2 = slope(t + step / 2.0, along(x, step / 2.0, k1));
        let k3 = slope(t + step / 2.0, along(x, step / 2.0, k2));
        let k4 = slope(t + step, along(x, step, k3));
        for i in 0..2 {
            x[i] += step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    let names = [("de", "rad"), ("alpha", "rad"), ("q", "rad/s")];
    let channels = names.iter().zip(channels).map(|((name, unit), values)| {
        let unit_of = trimtab_core::flight::Unit::parse(unit).expect("a unit");
        let channel = trimtab_core::flight::Channel::from_recorded(unit, unit_of, values);
        (name.to_string(), channel)
    });
    let maneuver = Maneuver::new(time, channels.collect()).expect("a maneuver");
    (
        toml::from_str(document).expect("a document"),
        Arc::new(maneuver),
    )
}

/// 80 s, the change at 40 s. At 70 s what forgets knows the new value, and what forgets nothing does not.
#[test]
fn a_parameter_that_changes_in_flight_is_followed_with_forgetting() {
    let noise = json!({"alpha": 2e-4, "q": 4e-4});
    let band = json!({"band_hz": [0.1, 1.5]});
    let cases = [
        (json!({"method": "rls"}), json!({"forgetting": 0.996})),
        (
            json!({"method": "rft", "frequency": band}),
            json!({"forgetting": 0.996}),
        ),
        (
            json!({"method": "ekf", "noise": noise}),
            json!({"drift": {"Ma": 0.1}}),
        ),
    ];
    let (document, maneuver) = changing(3);
    let document = serde_json::to_value(document).expect("JSON");
    let plan = plan(document, json!({}), &[maneuver]);
    let segment = &plan.problem.segments[0];
    for (asked, forgetting) in cases {
        for (asked, follows) in [(with(asked.clone(), forgetting), true), (asked, false)] {
            let mut tracker = tracker(&plan, asked.clone());
            let (ma, mq) = (place(&tracker, "Ma"), place(&tracker, "Mq"));
            let mut at = Vec::new();
            for k in 0..segment.len() {
                let found = push(&mut tracker, segment, k).expect("a sample");
                if [39.5, 70.0]
                    .iter()
                    .any(|t| (segment.time[k] - t).abs() < 1e-6)
                {
                    at.push([
                        found.values[ma],
                        found.standard_errors[ma],
                        found.values[mq],
                    ]);
                }
            }
            println!("{asked}: {at:?}");
            let off = |at: [f64; 3], truth: f64| (at[0] - truth).abs();
            assert!(
                off(at[0], -3.4) < 0.1,
                "{asked}: before the change {:?}",
                at[0]
            );
            assert_eq!(
                off(at[1], -2.4) < 0.1,
                follows,
                "{asked}: after it {:?}",
                at[1]
            );
            if follows {
                assert!(off(at[1], -2.4) < 4.0 * at[1][1], "{asked}: {:?}", at[1]);
            }
        }
    }
}
