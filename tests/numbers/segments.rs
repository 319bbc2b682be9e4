//! Segments that are proposed: on simulated flights, where the truth is known, and on recorded ones, cut together with trims.

use indexmap::IndexMap;
use trimtab_core::flight::{Channel, Maneuver, ProposedSegment, SegmentKind, Wanted, segments};
use trimtab_core::ingest::{Format, Limits, read};

use crate::common::flight_data;
use crate::common::repository;

fn bundled(name: &str) -> Maneuver {
    let path = repository::path(&format!("data/{name}.csv"));
    let bytes = std::fs::read(path).expect("a recording");
    read(&bytes, Format::Csv, &Limits::default()).expect("it is good")
}

fn proposed(maneuver: &Maneuver, wanted: &Wanted) -> Vec<ProposedSegment> {
    segments(maneuver, wanted).expect("a proposal").segments
}

/// Names with first and last second.
fn told(segments: &[ProposedSegment]) -> Vec<(String, f64, f64)> {
    let told = segments.iter();
    told.map(|segment| (segment.name.clone(), segment.seconds[0], segment.seconds[1]))
        .collect()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, within: f64) {
    assert!(
        (found - expected).abs() <= within,
        "{found} s is not {expected} s"
    );
}

/// Channels of recordings one behind the other, as if flown without a break. Those that not all have are left out.
fn joined(parts: &[(&Maneuver, std::ops::Range<usize>)], step: f64) -> Maneuver {
    let mut channels: IndexMap<String, Channel> = IndexMap::new();
    for (name, channel) in parts[0].0.channels() {
        let of_part = |(part, rows): &(&Maneuver, std::ops::Range<usize>)| {
            let channel = part.channels().get(name)?;
            Some(channel.values[rows.clone()].to_vec())
        };
        let all: Option<Vec<Vec<f64>>> = parts.iter().map(of_part).collect();
        if let Some(all) = all {
            let Channel {
                recorded_unit,
                unit,
                ..
            } = channel;
            let channel = Channel {
                recorded_unit: recorded_unit.clone(),
                unit: *unit,
                values: all.concat(),
            };
            channels.insert(name.clone(), channel);
        }
    }
    let samples: usize = parts.iter().map(|(_, rows)| rows.len()).sum();
    let time = (0..samples).map(|k| k as f64 * step).collect();
    Maneuver::new(time, channels).expect("a recording")
}

/// The scenarios beside the data say when inputs move: `start` and the lengths of the pulses.
#[test]
fn simulated_flights_have_one_maneuver_where_it_was_flown() {
    for (name, word, from, to) in [
        ("elevator", "elevator 1", 6.0, 6.0 + 7.0 * 0.8),
        (
            "aileron",
            "aileron 1",
            6.0,
            6.0 + 1.2 + 1.6 + 2.4 + 1.6 + 1.2,
        ),
    ] {
        let maneuver = bundled(name);
        let found = proposed(&maneuver, &Wanted::default());
        let told = told(&found);
        let at = told
            .iter()
            .position(|(name, ..)| name == word)
            .unwrap_or_else(|| panic!("{told:?}"));
        let segment = &found[at];
        assert_eq!(segment.kind, SegmentKind::Maneuver);
        assert_near(segment.seconds[0], from - 2.0, 0.3);
        assert!(
            segment.seconds[1] >= to && segment.seconds[1] <= to + 10.3,
            "{told:?}"
        );
        assert_eq!((told[0].0.as_str(), told[0].1), ("trim 1", 0.0));
        assert_near(told[0].2, segment.seconds[0], 0.05);
        let [first, last] = segment.rows;
        let time = maneuver.time();
        assert_eq!([time[first - 1], time[last - 1]], segment.seconds);
    }
    // six seconds between the doublets are more than the quiet that parts maneuvers, and less than ten
    let rudder = bundled("rudder");
    let count = |quiet: f64| {
        let wanted = Wanted {
            quiet,
            ..Wanted::default()
        };
        let found = proposed(&rudder, &wanted);
        found
            .iter()
            .filter(|segment| segment.kind == SegmentKind::Maneuver)
            .count()
    };
    assert_eq!((count(5.0), count(10.0)), (2, 1));
    let found = proposed(&rudder, &Wanted::default());
    let starts: Vec<f64> = (found.iter())
        .filter(|segment| segment.kind == SegmentKind::Maneuver)
        .map(|segment| segment.seconds[0])
        .collect();
    assert_near(starts[0], 4.0, 0.3);
    assert_near(starts[1], 6.0 + 2.4 + 6.0 - 2.0, 0.3);
}

#[test]
fn names_say_what_moves_and_gaps_part() {
    let (aileron, rudder) = (bundled("aileron"), bundled("rudder"));
    let both = joined(&[(&aileron, 0..750), (&rudder, 0..750)], 0.04);
    let names: Vec<String> = told(&proposed(&both, &Wanted::default()))
        .into_iter()
        .map(|(name, ..)| name)
        .collect();
    for name in ["aileron 1", "rudder 1", "rudder 2", "trim 1"] {
        assert!(names.contains(&name.to_string()), "{names:?}");
    }
    // the same with a minute between them
    let later = |k: usize| k as f64 * 0.04 + if k < 750 { 0.0 } else { 60.0 };
    let time = (0..1500).map(later).collect();
    let apart = Maneuver::new(time, both.channels().clone()).unwrap();
    for segment in proposed(&apart, &Wanted::default()) {
        let [from, to] = segment.seconds;
        assert!(to < 30.0 || from > 89.0, "{segment:?}");
    }
    let wanted = |inputs: &[&str]| Wanted {
        inputs: inputs.iter().map(ToString::to_string).collect(),
        ..Wanted::default()
    };
    let only = told(&proposed(&both, &wanted(&["dr"])));
    assert!(
        only.iter().all(|(name, ..)| !name.contains("aileron")),
        "{only:?}"
    );
    let unknown = segments(&both, &wanted(&["elev"])).unwrap_err();
    assert_eq!(unknown.code, "unknown_channel");
    let without: IndexMap<String, Channel> = (both.channels().iter())
        .filter(|(name, _)| !["da", "dr"].contains(&name.as_str()))
        .map(|(name, channel)| (name.clone(), channel.clone()))
        .collect();
    let without = Maneuver::new(both.time().to_vec(), without).unwrap();
    assert_eq!(
        segments(&without, &Wanted::default()).unwrap_err().code,
        "no_inputs"
    );
}

/// Noise alone is no motion, whatever its size; a ramp that takes a minute is quasi-steady.
#[test]
fn noise_does_not_move_and_ramps_are_slow() {
    let noise = |k: usize| f64::from((k as u32).wrapping_mul(2_654_435_761) >> 16) / 65536.0 - 0.5;
    let flight = |of: &dyn Fn(usize) -> f64| {
        let time = (0..3000).map(|k| k as f64 * 0.04).collect();
        let values = (0..3000).map(of).collect();
        let deg = trimtab_core::flight::Unit::parse("deg").unwrap();
        let channels = [("de".to_string(), Channel::from_recorded("deg", deg, values))];
        Maneuver::new(time, channels.into()).unwrap()
    };
    let names = |maneuver: &Maneuver| -> Vec<String> {
        let found = proposed(maneuver, &Wanted::default());
        found.into_iter().map(|segment| segment.name).collect()
    };
    for size in [0.01, 5.0] {
        assert_eq!(names(&flight(&|k| size * noise(k))), ["trim 1"]);
    }
    assert_eq!(
        names(&flight(&|k| 0.004 * k as f64 + 0.02 * noise(k))),
        ["quasi-steady elevator 1"]
    );
    // a last digit that flickers
    let digit = |k: usize| 0.02 * f64::from(noise(k) > 0.3);
    assert_eq!(names(&flight(&digit)), ["trim 1"]);
    let step = |k: usize| if k < 1500 { 0.0 } else { 2.0 };
    let found = proposed(&flight(&|k| step(k) + 0.02 * noise(k)), &Wanted::default());
    let told = told(&found);
    assert_eq!(told[1].0, "elevator 1", "{told:?}");
    // no rate is recorded: all of the response that is asked for
    assert_near(told[1].1, 58.0, 0.3);
    assert_near(told[1].2, 70.0, 0.3);
}

fn flight(time: Vec<f64>, values: Vec<f64>) -> Maneuver {
    let deg = trimtab_core::flight::Unit::parse("deg").unwrap();
    let channels = [("de".to_string(), Channel::from_recorded("deg", deg, values))];
    Maneuver::new(time, channels.into()).unwrap()
}

/// A step between two samples is a motion from the one to the other, whatever lies around it.
#[test]
fn a_step_between_two_samples_is_a_segment() {
    let step = |at: usize| move |k: usize| if k < at { 0.0 } else { 2.0 };
    let time = |k: usize| k as f64 * 0.04;
    let bare = Wanted {
        quiet: 0.0,
        lead: 0.0,
        response: 0.0,
        ..Wanted::default()
    };
    for at in [250, 251, 500] {
        let maneuver = flight(
            (0..1000).map(time).collect(),
            (0..1000).map(step(at)).collect(),
        );
        let found = proposed(&maneuver, &bare);
        let segment = &found[1];
        assert_eq!(segment.name, "elevator 1");
        // rows count from 1
        assert_eq!(segment.rows, [at, at + 1], "{segment:?}");
        assert_eq!(segment.seconds, [time(at - 1), time(at)]);
        assert!((segment.moves[0].excursion.to_degrees() - 2.0).abs() < 1e-12);
    }
    // over a gap of 0.4 s nothing is seen to move
    let late = |k: usize| time(k) + if k < 500 { 0.0 } else { 0.4 };
    let maneuver = flight(
        (0..1000).map(late).collect(),
        (0..1000).map(step(500)).collect(),
    );
    assert_eq!(maneuver.sampling().gaps.len(), 1);
    let names: Vec<String> = (proposed(&maneuver, &Wanted::default()).into_iter())
        .map(|segment| segment.name)
        .collect();
    assert_eq!(names, ["trim 1", "trim 2"]);
}

/// Inputs that jump, ramp and pause at random: a proposal is in order, and says of each maneuver what moves.
#[test]
fn every_proposal_is_in_order_and_has_names() {
    let mut state = 1u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as f64 / f64::from(1u32 << 31)
    };
    for case in 0..300 {
        let (mut now, mut value, mut rate) = (0.0, 0.0, 0.0);
        let (mut time, mut values) = (Vec::new(), Vec::new());
        for _ in 0..400 {
            now += if random() < 0.01 {
                3.0 * random()
            } else {
                0.02 + 0.02 * random()
            };
            if random() < 0.03 {
                rate = if random() < 0.6 {
                    0.0
                } else {
                    4.0 * random() - 2.0
                };
            }
            if random() < 0.02 {
                value += 4.0 * random() - 2.0;
            }
            value += 0.04 * rate;
            time.push(now);
            values.push(value);
        }
        let maneuver = flight(time, values);
        let wanted = Wanted {
            quiet: [0.0, 0.3, 2.0][case % 3],
            lead: [0.0, 0.0, 1.0, 2.0][case % 4],
            response: [0.0, 1.0, 10.0, 0.0, 3.0][case % 5],
            ..Wanted::default()
        };
        let found = proposed(&maneuver, &wanted);
        for segment in &found {
            let [from, to] = segment.seconds;
            let [first, last] = segment.rows;
            let are_of_rows = maneuver.time()[first - 1] == from && maneuver.time()[last - 1] == to;
            assert!(from < to && are_of_rows, "{case}: {segment:?}");
            if segment.kind == SegmentKind::Maneuver {
                assert!(segment.name.starts_with("elevator "), "{case}: {segment:?}");
                assert!(!segment.moves.is_empty(), "{case}: {segment:?}");
            }
            let is_across =
                |gap: &trimtab_core::flight::Gap| first <= gap.before && gap.before < last;
            assert!(
                !maneuver.sampling().gaps.iter().any(is_across),
                "{case}: {segment:?}"
            );
        }
        for pair in found.windows(2) {
            assert!(pair[0].seconds[1] <= pair[1].seconds[0], "{case}: {pair:?}");
        }
    }
}

#[test]
fn a_name_given_twice_is_watched_once() {
    let maneuver = bundled("elevator");
    let wanted = |inputs: Vec<String>| Wanted {
        inputs,
        ..Wanted::default()
    };
    let once = segments(&maneuver, &wanted(vec!["de".to_string()])).unwrap();
    let often = segments(&maneuver, &wanted(vec!["de".to_string(); 20_000])).unwrap();
    assert_eq!(once, often);
}

/// Recorded flights, with trims between them that are their own quiet beginnings, there and back.
#[test]
fn recorded_flights_are_found_between_trims() {
    let Some(directory) = flight_data::directory("recorded_flights_are_found_between_trims") else {
        return;
    };
    let flight = |name: &str| {
        let bytes = std::fs::read(directory.join(name)).expect("a recording");
        read(&bytes, Format::Csv, &Limits::default()).expect("it is good")
    };
    let [elevator, aileron, rudder] =
        ["attas_elv1.csv", "attas_ail1.csv", "attas_rud1.csv"].map(flight);
    let mut parts = Vec::new();
    let quiet = 0..120;
    for maneuver in [&elevator, &aileron, &rudder] {
        for _ in 0..3 {
            parts.push((maneuver, quiet.clone()));
        }
        parts.push((maneuver, 0..maneuver.len()));
    }
    let all = joined(&parts, 0.04);
    let wanted = Wanted {
        inputs: ["de", "da_left", "da_right", "dr"]
            .map(str::to_string)
            .to_vec(),
        ..Wanted::default()
    };
    let found = proposed(&all, &wanted);
    let told = told(&found);
    let maneuvers: Vec<&ProposedSegment> = (found.iter())
        .filter(|segment| segment.kind == SegmentKind::Maneuver)
        .collect();
    let trim = 3.0 * 120.0 * 0.04;
    // inputs move from 5.4 to 12.5 s, from 5.4 to 10.9 s and from 5.7 to 12.5 s of the recordings, as one sees
    let mut at = 0.0;
    for (maneuver, length, from, to, word) in [
        (0, 626.0, 5.4, 12.5, "elevator"),
        (1, 751.0, 5.4, 10.9, "aileron"),
        (2, 751.0, 5.7, 12.5, "rudder"),
    ] {
        let begins = at + trim;
        let segment = maneuvers
            .get(maneuver)
            .unwrap_or_else(|| panic!("{told:?}"));
        assert!(segment.name.starts_with(word), "{told:?}");
        assert_near(segment.seconds[0], begins + from - 2.0, 0.7);
        let end = segment.seconds[1];
        assert!(
            (begins + to - 0.3..=begins + to + 10.5).contains(&end),
            "{told:?}"
        );
        at = begins + length * 0.04;
    }
    assert_eq!(maneuvers.len(), 3, "{told:?}");
    let trims = found
        .iter()
        .filter(|segment| segment.kind == SegmentKind::Trim);
    assert!(trims.count() >= 3, "{told:?}");
    // the Hansa Jet: a 3-2-1-1, and a pulse up and down; radians at 10 Hz
    let hansa = flight("hfb320_1_10.csv");
    let found = proposed(&hansa, &Wanted::default());
    let starts: Vec<f64> = (found.iter())
        .filter(|segment| {
            segment.kind == SegmentKind::Maneuver && segment.name.starts_with("elevator")
        })
        .map(|segment| segment.seconds[0])
        .collect();
    assert_eq!(starts.len(), 3, "{found:?}");
    for (found, expected) in starts.iter().zip([2.3, 23.2, 39.1]) {
        assert_near(*found, expected, 0.7);
    }
}
