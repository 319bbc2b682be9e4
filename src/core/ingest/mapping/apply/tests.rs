//! Mappings applied to archives that are made here.

use super::super::super::{fault::places, matrix::Matrix};
use super::*;
use crate::flight::Maneuver;

/// `t`: 3 x 1; `m`: 3 x 2; `r`: 2 x 3.
struct Three;

impl Archive for Three {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        match path.join(".").as_str() {
            "t" => Ok(Matrix::of_rows(&[0.0, 1.0, 2.0], 1)),
            "m" => Ok(Matrix::of_rows(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 2)),
            "r" => Ok(Matrix::of_rows(
                &[1.0, 2.0, 3.0, 4.0, 5.0, f64::INFINITY],
                3,
            )),
            _ => Err((code::UNKNOWN_SOURCE, "there is t, m and r".to_string())),
        }
    }
}

fn apply(time: &str, channels: &str, limits: &Limits) -> Result<Maneuver, IngestError> {
    let text = format!(r#"{{"time": {{{time}}}, "channels": {{{channels}}}}}"#);
    let reading = Mapping::from_json(&text)?.apply(&mut Three, limits)?;
    Ok(reading.maneuver)
}

const T: &str = r#""from": "t", "unit": "s""#;

#[test]
fn parts_become_channels_in_the_order_of_the_mapping() {
    let channels = r#""row": {"from": "r(2,:)", "unit": "-"}, "m": {"from": "m", "unit": "km"},
        "a": {"from": "m(:,2)", "unit": "m"}, "time": {"from": "t", "unit": "s"}"#;
    let maneuver = apply(T, channels, &Limits::default()).unwrap();
    let names: Vec<&String> = maneuver.channels().keys().collect();
    assert_eq!(names, ["row", "m_1", "m_2", "a", "time"]);
    assert_eq!(maneuver.channels()["m_2"].values, [2000.0, 4000.0, 6000.0]);
    assert_eq!(maneuver.channels()["a"].values, [2.0, 4.0, 6.0]);
    assert!(maneuver.channels()["row"].values[2].is_nan());
    assert_eq!(maneuver.channels()["row"].values[..2], [4.0, 5.0]);

    let even = apply(
        r#""step": 40, "start": 1000, "unit": "ms""#,
        r#""a": {"from": "t", "unit": "m"}"#,
        &Limits::default(),
    );
    assert_eq!(even.unwrap().time(), [1.0, 1.04, 1.08]);
}

/// Two tables, each with its own time.
struct Tables;

impl Archive for Tables {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        match path.join(".").as_str() {
            "IMU" => Ok(Matrix::of_rows(
                &[0.0, 5.0, 0.1, 6.0, 0.2, 7.0, 0.3, 8.0],
                2,
            )),
            "AIR" => Ok(Matrix::of_rows(&[100.0, 1.0, 250.0, 2.0], 2)),
            "back" => Ok(Matrix::of_rows(&[2.0, 1.0], 1)),
            _ => Err((code::UNKNOWN_SOURCE, "there is IMU and AIR".to_string())),
        }
    }
}

fn of_tables(text: &str) -> Result<Maneuver, IngestError> {
    let reading = Mapping::from_json(text)?.apply(&mut Tables, &Limits::default())?;
    Ok(reading.maneuver)
}

fn shown(maneuver: &Maneuver, name: &str) -> Vec<Option<f64>> {
    let values = maneuver.channels()[name].values.iter();
    values.map(|&v| (!v.is_nan()).then_some(v)).collect()
}

#[test]
fn channels_with_times_of_their_own_keep_their_samples() {
    let q = r#""q": {"from": "IMU(:,2)", "unit": "-"}"#;
    let time = r#""time": {"from": "IMU(:,1)", "unit": "s"}"#;
    let of = |alpha: &str| {
        let alpha = format!(r#""alpha": {{"from": "AIR(:,2)", "unit": "-", {alpha}}}"#);
        of_tables(&format!(r#"{{{time}, "channels": {{{q}, {alpha}}}}}"#))
    };
    let found = of(r#""time": {"from": "AIR(:,1)", "unit": "ms"}"#).unwrap();
    assert_eq!(found.time(), [0.0, 0.1, 0.2, 0.25, 0.3]);
    assert_eq!(
        shown(&found, "alpha"),
        [None, Some(1.0), None, Some(2.0), None]
    );
    assert_eq!(shown(&found, "q")[3], None);
    let late =
        of(r#""time": {"from": "AIR(:,1)", "unit": "ms", "offset": 0.1}, "between": "held""#);
    assert_eq!(
        shown(&late.unwrap(), "alpha"),
        [None, None, Some(1.0), Some(1.0), Some(2.0)]
    );

    let tables = r#""tables": {"AIR": {"from": "AIR(:,1)", "unit": "ms"}}"#;
    let alpha = r#""alpha": {"from": "AIR(:,2)", "unit": "-", "between": "straight"}"#;
    let same = of_tables(&format!(
        r#"{{{time}, {tables}, "channels": {{{q}, {alpha}}}}}"#
    ))
    .unwrap();
    let straight = shown(&same, "alpha");
    assert!((straight[2].unwrap() - 5.0 / 3.0).abs() < 1e-12 && straight[4].is_none());
    // the longest name holds
    let nested = tables.replace("}}", r#"}, "AI": {"from": "x"}, "AIR.x": {"from": "x"}}"#);
    let same = of_tables(&format!(
        r#"{{{time}, {nested}, "channels": {{{q}, {alpha}}}}}"#
    ))
    .unwrap();
    assert_eq!(shown(&same, "alpha"), straight);
    // no main axis at all
    let alone = of_tables(&format!(r#"{{{tables}, "channels": {{{alpha}}}}}"#)).unwrap();
    assert_eq!(alone.time(), [0.1, 0.25]);

    let of_several = r#""x": {"from": ["GPS(:,2)", "no source", "AIR(:,2)"], "unit": "-", "time": ["GPS(:,1)", "AIR(:,1)"], "scale": 3}"#;
    let several = of_tables(&format!(r#"{{{time}, "channels": {{{q}, {of_several}}}}}"#)).unwrap();
    assert_eq!(
        several.channels()["x"]
            .values
            .iter()
            .filter(|v| **v == 3.0)
            .count(),
        1
    );

    let not_there = r#""x": {"from": "GPS(:,2)", "unit": "-"}"#;
    let optional = of_tables(&format!(
        r#"{{{time}, "optional": true, "channels": {{{q}, {not_there}}}}}"#
    ));
    assert_eq!(optional.unwrap().channels().len(), 1);
}

#[test]
fn faults_of_axes_stand_at_their_place() {
    let refused = |rest: &str| {
        let text = format!(r#"{{"time": {{"from": "IMU(:,1)", "unit": "s"}}, {rest}}}"#);
        of_tables(&text).unwrap_err()
    };
    let alpha = |time: &str| {
        refused(&format!(
            r#""channels": {{"alpha": {{"from": "AIR(:,2)", "unit": "-"{time}}}}}"#
        ))
    };
    let error = alpha("");
    assert_eq!(error.faults()[0].code, code::LENGTH_MISMATCH);
    assert!(
        error.to_string().contains("has a time axis of its own"),
        "{error}"
    );
    for (time, expected) in [
        (
            r#", "time": "AIR(:,9)""#,
            "unknown_source /channels/alpha/time",
        ),
        (
            r#", "time": "back""#,
            "time_not_increasing /channels/alpha/time",
        ),
        (
            r#", "time": "IMU(:,1)", "between": "held""#,
            "length_mismatch /channels/alpha/values",
        ),
        (
            r#", "time": {"from": "IMU(:,1)", "unit": "ms"}"#,
            "length_mismatch /channels/alpha/from",
        ),
        (
            r#", "time": {"from": "AIR(:,1)", "unit": "kg"}"#,
            "time_unit /channels/alpha/time",
        ),
        (
            r#", "time": "AIR 1""#,
            "invalid_mapping /channels/alpha/time",
        ),
    ] {
        assert_eq!(places::<()>(Err(alpha(time))), [expected]);
    }
    let dated = of_tables(
        r#"{"time": {"from": "IMU(:,1)", "date": "day", "unit": "s"}, "channels": {"a": {"from": "IMU(:,2)", "unit": "-"}}}"#,
    );
    assert_eq!(places(dated), ["invalid_mapping /time/date"]);
    let unsaid = of_tables(r#"{"channels": {"a": {"from": "IMU(:,2)", "unit": "-"}}}"#);
    assert_eq!(places(unsaid), ["invalid_mapping /channels/a/from"]);
}

/// Only `b` is there, in km; of `a`, which is not, a unit is said all the same.
struct Renamed;

impl Archive for Renamed {
    fn matrix(&mut self, path: &[String]) -> Result<Matrix<'_>, (&'static str, String)> {
        match path.join(".").as_str() {
            "t" => Ok(Matrix::of_rows(&[0.0, 1.0], 1)),
            "b" | "c" => Ok(Matrix::of_rows(&[1.0, 2.0], 1)),
            _ => Err((code::UNKNOWN_SOURCE, "there is b and c".to_string())),
        }
    }

    fn unit(&self, path: &[String]) -> Option<String> {
        let units = [("a", "m"), ("b", "km")];
        let of = units.into_iter().find(|(name, _)| path == [*name]);
        of.map(|(_, unit)| unit.to_string())
    }
}

#[test]
fn a_unit_is_that_of_the_source_that_is_read() {
    let of = |from: &str| {
        let text =
            format!(r#"{{"time": {{{T}}}, "channels": {{"h": {{"from": ["a", "{from}"]}}}}}}"#);
        Mapping::from_json(&text)?.apply(&mut Renamed, &Limits::default())
    };
    assert_eq!(
        of("b").unwrap().maneuver.channels()["h"].values,
        [1000.0, 2000.0]
    );
    // of c no unit is said: that of another is none
    let refused = of("c");
    assert_eq!(places(refused), ["invalid_mapping /channels/h/unit"]);
}

#[test]
fn all_faults_stand_at_their_place_in_the_mapping() {
    let channels = r#""b": {"from": "x.y", "unit": "-"}, "c": {"from": "m(:,3)", "unit": "-"}, "d": {"from": "r(3,:)", "unit": "-"}"#;
    let refused = apply(r#""from": "m", "unit": "s""#, channels, &Limits::default());
    let expected = [
        "/time/from",
        "/channels/b/from",
        "/channels/c/from",
        "/channels/d/from",
    ];
    assert_eq!(
        places(refused),
        expected.map(|place| format!("unknown_source {place}"))
    );
    let channels = r#""a b": {"from": "t", "unit": "-"}, "c": {"from": "r(:,1)", "unit": "warp"}"#;
    assert_eq!(
        places(apply(T, channels, &Limits::default())),
        [
            "invalid_name /channels/a b",
            "length_mismatch /channels/c/values",
            "unknown_unit /channels/c/unit"
        ]
    );
}

#[test]
fn limits_hold_before_anything_is_taken() {
    let limits = Limits {
        max_columns: 4,
        max_samples: 3,
        max_values: 100,
        max_name_length: 5,
        ..Limits::default()
    };
    let refused = |sources: &[&str], limits: &Limits| {
        let channel = |(at, from)| format!(r#""c{at}": {{"from": "{from}", "unit": "-"}}"#);
        let channels: Vec<String> = sources.iter().enumerate().map(channel).collect();
        places(apply(T, &channels.join(","), limits))
    };
    assert_eq!(refused(&["t"; 4], &limits), ["too_many_columns "]);
    assert_eq!(refused(&["r", "t"], &limits), ["too_many_columns "]);
    let few_values = Limits {
        max_values: 8,
        ..limits
    };
    assert_eq!(refused(&["m"], &few_values), ["too_many_values "]);
    let few_samples = Limits {
        max_samples: 2,
        ..limits
    };
    assert_eq!(refused(&["t"], &few_samples), ["too_many_samples "]);
}
