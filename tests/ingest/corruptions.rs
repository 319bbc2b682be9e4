//! Clean recordings with one thing put wrong, fifty times each, by seeds: it is found every time.

use trimtab_core::flight::{Channel, Finding, Maneuver, quality};
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::Scenario;

const SEEDS: u64 = 50;

/// The bundled elevator maneuver with noise of this seed.
fn clean(seed: u64) -> Maneuver {
    let mut scenario: Scenario = toml::from_str(include_str!("../../data/elevator.toml")).unwrap();
    scenario.seed = seed;
    let model = Model::compile(&catalog::find("short-period").unwrap()).unwrap();
    scenario.fly(&model).unwrap()
}

/// A number from 0 to `below`, scattered by the seed.
fn draw(seed: u64, salt: u64, below: usize) -> usize {
    let mixed = (seed * 1000 + salt + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((mixed >> 33) as usize) % below
}

/// As a recorder writes it: four decimals of the recorded unit.
fn rounded(channel: &Channel) -> Channel {
    let unit = channel.unit;
    let round = |value: &f64| unit.to_si((unit.from_si(*value) * 1e4).round() / 1e4);
    Channel {
        values: channel.values.iter().map(round).collect(),
        ..channel.clone()
    }
}

/// What is put wrong of time and channels, by a seed.
type Wrong = dyn Fn(u64, &mut Vec<f64>, &mut Vec<(String, Channel)>);

fn corrupted(seed: u64, wrong: &Wrong) -> Vec<Finding> {
    let maneuver = clean(seed);
    let mut time = maneuver.time().to_vec();
    let channels = maneuver.channels().iter();
    let mut channels: Vec<(String, Channel)> = channels
        .map(|(name, channel)| (name.clone(), rounded(channel)))
        .collect();
    wrong(seed, &mut time, &mut channels);
    quality(&Maneuver::new(time, channels.into_iter().collect()).unwrap())
}

fn of<'c>(channels: &'c mut [(String, Channel)], name: &str) -> &'c mut Vec<f64> {
    let channel = channels.iter_mut().find(|(known, _)| known == name);
    &mut channel.expect("the channel").1.values
}

#[test]
fn what_was_put_wrong_is_found() {
    let output = |seed: u64| if draw(seed, 7, 2) == 0 { "alpha" } else { "q" };
    let held = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let every = 2 + draw(seed, 1, 9);
        let values = of(channels, output(seed));
        (0..values.len()).for_each(|k| values[k] = values[k / every * every]);
    };
    let uneven_held = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let every = 2.3 + draw(seed, 1, 60) as f64 / 10.0;
        let values = of(channels, output(seed));
        for k in 0..values.len() {
            values[k] = values[((k as f64 / every).floor() * every).ceil() as usize];
        }
    };
    let sentinel = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let number = [-9999.0, -999.25, 1e30, 65535.0, 32767.0][draw(seed, 2, 5)];
        let name = output(seed);
        let unit = channels
            .iter()
            .find(|(known, _)| known == name)
            .unwrap()
            .1
            .unit;
        let values = of(channels, name);
        for place in 0..=draw(seed, 3, 5) as u64 {
            let row = draw(seed, 10 + place, values.len());
            values[row] = unit.to_si(number);
        }
    };
    let degrees = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let down = draw(seed, 4, 2) == 0;
        let values = of(channels, output(seed));
        values
            .iter_mut()
            .for_each(|v| *v = if down { v.to_radians() } else { v.to_degrees() });
    };
    let sign = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        of(channels, output(seed)).iter_mut().for_each(|v| *v = -*v);
    };
    let milliseconds = |seed: u64, time: &mut Vec<f64>, _: &mut Vec<(String, Channel)>| {
        let factor = [1e3, 1e6, 1e-3][draw(seed, 5, 3)];
        time.iter_mut().for_each(|t| *t *= factor);
    };
    let ticks = |seed: u64, time: &mut Vec<f64>, _: &mut Vec<(String, Channel)>| {
        let tick = [1.0 / 512.0, 0.003, 0.007, 1.0 / 128.0][draw(seed, 6, 4)];
        time.iter_mut()
            .for_each(|t| *t = (*t / tick).floor() * tick);
    };
    let twice = |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let row = 20 + draw(seed, 8, 500);
        for (_, channel) in channels {
            channel.values[row] = channel.values[row - 1];
        }
    };
    let block = |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let (row, length) = (300 + draw(seed, 8, 100), 40 + draw(seed, 9, 100));
        for (_, channel) in channels {
            channel
                .values
                .copy_within(row - 200..row - 200 + length, row);
        }
    };
    let frozen = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let (row, length) = (100 + draw(seed, 8, 300), 26 + draw(seed, 9, 100));
        let values = of(channels, output(seed));
        let value = values[row];
        values[row..row + length].fill(value);
    };
    let gap = |seed: u64, time: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let (row, length) = (20 + draw(seed, 11, 500), 3 + draw(seed, 12, 60));
        time.drain(row..row + length);
        for (_, channel) in channels {
            channel.values.drain(row..row + length);
        }
    };
    // a program that waits between samples, now longer and now shorter
    let jitter = |seed: u64, time: &mut Vec<f64>, _: &mut Vec<(String, Channel)>| {
        let mut now = time[0];
        for (k, t) in time.iter_mut().enumerate() {
            *t = now;
            now += 0.04 * (0.7 + 0.6 * draw(seed, 100 + k as u64, 1000) as f64 / 1000.0);
        }
    };
    let missing = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let values = of(channels, output(seed));
        for place in 0..=draw(seed, 13, 30) as u64 {
            let row = draw(seed, 20 + place, values.len());
            values[row] = f64::NAN;
        }
    };
    let spike = move |seed: u64, _: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let values = of(channels, output(seed));
        let (least, most) = values
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
        let row = 5 + draw(seed, 14, values.len() - 10);
        let size = (most - least) * (0.5 + draw(seed, 15, 100) as f64 / 50.0);
        values[row] += if draw(seed, 16, 2) == 0 { size } else { -size };
    };
    // a heading that turns through north, or through south
    let wrap = |seed: u64, time: &mut Vec<f64>, channels: &mut Vec<(String, Channel)>| {
        let (turn, half) = (std::f64::consts::TAU, draw(seed, 17, 2) == 0);
        let rate = (4.0 + draw(seed, 18, 10) as f64).to_radians();
        let heading = |t: &f64| {
            let plain = if half { 2.5 } else { 5.0 } + rate * t;
            let wrapped = plain.rem_euclid(turn);
            if half && wrapped > turn / 2.0 {
                wrapped - turn
            } else {
                wrapped
            }
        };
        let channel = Channel {
            values: time.iter().map(heading).collect(),
            ..channels[0].1.clone()
        };
        channels.push(("psi".to_string(), channel));
    };
    let kinds: [(&str, &[&str], &Wrong); 15] = [
        ("held", &["held_channel"], &held),
        (
            "held, rates that do not divide",
            &["held_channel"],
            &uneven_held,
        ),
        ("a number for no value", &["sentinel"], &sentinel),
        ("degrees and radians", &["channels_disagree"], &degrees),
        ("a sign", &["channels_disagree"], &sign),
        (
            "a unit of time",
            &["implausible_rate", "channels_disagree"],
            &milliseconds,
        ),
        ("a clock in ticks", &["coarse_clock"], &ticks),
        ("one row twice", &["repeated_rows"], &twice),
        ("a block of rows twice", &["repeated_rows"], &block),
        ("a frozen channel", &["repeated_values"], &frozen),
        // a gap is longer than five steps
        ("lost rows", &["gap", "uneven_sampling"], &gap),
        ("uneven sampling", &["uneven_sampling"], &jitter),
        ("missing values", &["missing_values"], &missing),
        ("a spike", &["spikes"], &spike),
        ("a wrap", &["wrap"], &wrap),
    ];
    let mut missed = Vec::new();
    for (name, codes, wrong) in kinds {
        let is_found = |seed: &u64| {
            let found = corrupted(*seed, wrong);
            found
                .iter()
                .any(|finding| codes.contains(&finding.code.as_str()))
        };
        let hits = (0..SEEDS).filter(is_found).count();
        eprintln!("{name}: {hits} of {SEEDS}");
        if hits < SEEDS as usize {
            missed.push(format!("{name}: {hits} of {SEEDS}"));
        }
    }
    let clean = (0..SEEDS).flat_map(|seed| corrupted(seed, &|_, _, _| {}));
    let alarms: Vec<Finding> = clean.filter(Finding::is_warning).collect();
    eprintln!("nothing wrong: {} warnings in {SEEDS}", alarms.len());
    assert!(
        missed.is_empty() && alarms.is_empty(),
        "{missed:?} {alarms:?}"
    );
}
