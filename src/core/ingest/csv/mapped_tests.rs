//! Tables of text, and the mappings that say what their columns are.

use super::super::fault::places;
use super::super::{IngestError, Limits, Mapping, Reading};
use super::read;
use crate::flight::Maneuver;

fn reading(text: &str, mapping: Option<&str>) -> Result<Reading, IngestError> {
    let mapping =
        mapping.map(|text| Mapping::from_toml(text).unwrap_or_else(|fault| panic!("{fault}")));
    read(text.as_bytes(), None, mapping.as_ref(), &Limits::default())
}

fn read_text(text: &str) -> Result<Maneuver, IngestError> {
    reading(text, None).map(|reading| reading.maneuver)
}

const ZEIT: &str = "time = {from = \"Zeit\", unit = \"ms\"}\n[channels]\n";

fn mapped(mapping: &str, text: &str) -> Result<Maneuver, IngestError> {
    reading(text, Some(mapping)).map(|reading| reading.maneuver)
}

#[test]
fn columns_get_names_and_units_and_others_are_left_out() {
    let text = "Zeit;angle of attack [rad];mode;q(1)\n0;1,5;approach;-2\n40;;landing;0,3\n";
    let channels =
        "alpha = {from = \"(:,2)\", unit = \"deg\"}\nq = {from = \"q(1)\", unit = \"deg/s\"}\n";
    let plain = read_text("t[s],alpha[deg],q[deg/s]\n0,1.5,-2\n0.04,,0.3\n").unwrap();
    assert_eq!(
        mapped(&format!("{ZEIT}{channels}"), text).unwrap().digest(),
        plain.digest()
    );

    let stamps = "clock,q\n12:00:00,1\n12:00:00.5,2\n";
    let mapping =
        "time = {from = \"clock\", unit = \"s\"}\n[channels]\nq = {from = \"q\", unit = \"-\"}\n";
    assert_eq!(mapped(mapping, stamps).unwrap().time(), [0.0, 0.5]);
}

#[test]
fn a_mapping_says_scale_sign_missing_step_lines_and_marks() {
    let expected = |values: [f64; 2]| values.map(f64::to_bits);
    let values = |mapping: &str, text: &str| {
        let maneuver = mapped(mapping, text).unwrap_or_else(|error| panic!("{mapping}: {error}"));
        assert_eq!(maneuver.time(), [0.0, 0.5], "{mapping}");
        let values = &maneuver.channels()["a"].values;
        [values[0], values[1]].map(f64::to_bits)
    };
    let table = "t[s],a[m]\n0,1\n0.5,-9999\n";
    let a = |members: &str| format!("[channels]\na = {{from = \"a\", {members}}}\n");
    assert_eq!(values(&a("scale = 0.5"), table), expected([0.5, -4999.5]));
    assert_eq!(values(&a("sign = -1"), table), expected([-1.0, 9999.0]));
    assert_eq!(
        values(&a("unit = \"km\", missing = [-9999]"), table),
        expected([1000.0, f64::NAN])
    );
    assert_eq!(
        values("missing = [-9999]\n", table),
        expected([1.0, f64::NAN])
    );
    assert_eq!(
        values("missing = [\"ERR\"]\n", "t[s],a[m]\n0,1\n0.5,ERR\n"),
        expected([1.0, f64::NAN])
    );
    assert_eq!(
        values("time = {step = 0.5, unit = \"s\"}\n", "a[m]\n1\n2\n"),
        expected([1.0, 2.0])
    );
    assert_eq!(
        values(
            "time = {step = 500, unit = \"ms\"}\n[channels]\na = {from = \"(:,1)\", unit = \"m\"}\n",
            "1 9\n2 9\n"
        ),
        expected([1.0, 2.0])
    );
    assert_eq!(
        values("skip = 2\n", "t[s],a[m]\n7,7\nt[s],a[m]\n0,1\n0.5,2\n"),
        expected([1.0, 2.0])
    );
    assert_eq!(
        values(
            "header = 2\n",
            "x,y\nt[s],a[m]\nseconds,metres\n0,1\n0.5,2\n"
        ),
        expected([1.0, 2.0])
    );
    assert_eq!(
        values("decimal = \",\"\n", "t[s];a[m]\n0,000;1,000\n0,500;2,000\n"),
        expected([1.0, 2.0])
    );
    assert_eq!(
        values("decimal = \".\"\n", "t[s];a[m]\n0;1,000\n0.5;2\n"),
        expected([1000.0, 2.0])
    );
    let repeated = "t[s],a[m]\n0,1\n0,3\n0.5,4\n";
    assert_eq!(
        values("time = {repeated = \"mean\"}\n", repeated),
        expected([2.0, 4.0])
    );
    assert_eq!(
        values("time = {repeated = \"first\"}\n", repeated),
        expected([1.0, 4.0])
    );
    let weeks = "GPS Week,TOW (s),a[m]\n2300,604799.75,1\n2301,0.25,2\n";
    assert_eq!(
        mapped("time = {from = \"TOW\", week = \"GPS Week\"}\n", weeks)
            .unwrap()
            .duration(),
        0.5
    );
    assert_eq!(read_text(weeks).unwrap().duration(), 0.5);
    let days = "day,clock,a[m]\n2026-11-21,23:59:59.75,1\n2026-11-23,00:00:00.25,2\n";
    assert_eq!(
        mapped("time = {from = \"clock\", date = \"day\"}\n", days)
            .unwrap()
            .duration(),
        86_400.5
    );
}

#[test]
fn a_mapping_may_have_alternatives_patterns_and_gaps() {
    let channels = "optional = true\nothers = true\ntime = {from = [\"t\", \"Zeit\"], unit = \"s\"}\n[channels]\nde = {from = [\"Elev Pos\", \"Elev*\"], unit = \"deg\"}\nda = {from = \"Ail\", unit = \"deg\"}\n";
    let reading = reading("Zeit,Elevator 2,q[deg/s]\n0,1,2\n1,2,3\n", Some(channels)).unwrap();
    let names: Vec<&String> = reading.maneuver.channels().keys().collect();
    assert_eq!(names, ["de", "q"]);
    assert!(
        reading.findings[0].message.contains("da"),
        "{:?}",
        reading.findings
    );
}

#[test]
fn faults_stand_at_their_place_in_the_mapping() {
    let faults = |mapping: &str| places(mapped(mapping, "Zeit,a[deg],b,b\n0,1,2,x\n1,1,2,3\n"));
    let channels = "a = {from = \"a\", unit = \"deg\"}\nagain = {from = \"(:,2)\", unit = \"deg\"}\nb = {from = \"b\", unit = \"-\"}\nc = {from = \"c\", unit = \"-\"}\nd = {from = \"(:,9)\", unit = \"-\"}\nf = {from = \"(:,3)\", unit = \"furlong\"}\n\"g h\" = {from = \"b\", unit = \"-\"}\n";
    assert_eq!(
        faults(&format!("{ZEIT}{channels}")),
        [
            "invalid_mapping /channels/again/from",
            "unknown_source /channels/b/from",
            "unknown_source /channels/c/from",
            "unknown_source /channels/d/from",
            "unknown_unit /channels/f/unit",
            "invalid_name /channels/g h",
        ]
    );
    assert_eq!(
        faults("time = {from = \"Zeit\", unit = \"m\"}\n"),
        ["time_unit /time/unit"]
    );
    let last = format!("{ZEIT}q = {{from = \"(:,4)\", unit = \"-\"}}\n");
    assert_eq!(faults(&last), ["not_a_number /rows/1/q"]);
    let unsaid = format!("{ZEIT}q = {{from = \"(:,3)\"}}\n");
    assert_eq!(faults(&unsaid), ["unknown_unit /channels/q/unit"]);
    assert_eq!(
        faults("delimiter = \"x\"\n"),
        ["invalid_mapping /delimiter"]
    );
}

#[test]
fn channels_with_a_column_of_times_keep_their_samples() {
    let text = "t[s],q[deg/s],t_air[ms],alpha[deg]\n0,1,50,5\n0.1,2,50,5\n0.2,3,250,6\n0.3,4,,\n";
    let of = |time: &str, alpha: &str| {
        let q = "q = {from = \"q\"}";
        let mapping = format!("{time}\n[channels]\n{q}\nalpha = {{from = \"alpha\", {alpha}}}\n");
        mapped(&mapping, text).unwrap_or_else(|error| panic!("{mapping}: {error}"))
    };
    let there = |maneuver: &Maneuver, name: &str| -> Vec<usize> {
        let values = &maneuver.channels()[name].values;
        (0..values.len()).filter(|&k| !values[k].is_nan()).collect()
    };
    let main = "time = {from = \"t\"}";
    let own = of(main, "time = \"t_air\"");
    assert_eq!(own.time(), [0.0, 0.05, 0.1, 0.2, 0.25, 0.3]);
    assert_eq!(
        (there(&own, "q"), there(&own, "alpha")),
        (vec![0, 2, 3, 5], vec![1, 4])
    );
    let held = of(main, "time = \"t_air\", between = \"held\"");
    assert_eq!(there(&held, "alpha"), [1, 2, 3, 4, 5]);
    let late = of(main, "time = {from = \"t_air\", offset = 0.05}");
    assert_eq!(late.time(), [0.0, 0.1, 0.2, 0.3]);
    let shifted = of(main, "time = {offset = 0.05}");
    assert_eq!(shifted.time().len(), 8);
    let filled = of(main, "between = \"held\"");
    assert_eq!(there(&filled, "alpha"), [0, 1, 2, 3]);

    let all = "[channels]\nalpha = {from = \"alpha\", time = {from = \"t_air\", unit = \"s\"}}\n";
    assert_eq!(mapped(all, text).unwrap().time(), [50.0, 250.0]);
    let refused = |mapping: &str| places(mapped(mapping, text));
    let back = "time = {from = \"t\"}\n[channels]\nq = {from = \"q\", time = \"alpha\"}\n";
    assert_eq!(refused(back), ["time_unit /channels/q/time"]);
    let tables = "[tables]\nAIR = {from = \"t_air\"}\n";
    assert_eq!(refused(tables), ["invalid_mapping /tables"]);
}

#[test]
fn units_that_a_file_states_go_before_those_of_a_recognised_mapping() {
    let first = |text: &str, name: &str| {
        let maneuver = read_text(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let channel = &maneuver.channels()[name];
        (channel.values[0], channel.recorded_unit.clone())
    };
    let sky_view = "Session Time,GPS Fix Quality,True Airspeed (km/h),Pressure Altitude (m),Pitch\n1,2,180,1000,180\n2,2,180,1000,180\n";
    assert_eq!(first(sky_view, "V"), (50.0, "km/h".to_string()));
    assert_eq!(first(sky_view, "h"), (1000.0, "m".to_string()));
    // where it states none, or none that can be read, the mapping's
    assert_eq!(
        first(sky_view, "theta"),
        (std::f64::consts::PI, "deg".to_string())
    );
    let unread = sky_view.replace("Pitch", "Pitch (furlong)");
    assert_eq!(first(&unread, "theta"), first(sky_view, "theta"));
    let jsbsim =
        "Time (ms),Altitude ASL (ft),Alpha (rad),Q (rad/s)\n0,4200,0.25,0.5\n20,4200,0.25,0.5\n";
    assert_eq!(first(jsbsim, "alpha"), (0.25, "rad".to_string()));
    assert_eq!(first(jsbsim, "q"), (0.5, "rad/s".to_string()));
    assert_eq!(read_text(jsbsim).unwrap().time(), [0.0, 0.02]);
    // a mapping that was given says it
    let given = "time = {from = \"Time\", unit = \"s\"}\n[channels]\nalpha = {from = \"Alpha\", unit = \"deg\"}\n";
    let maneuver = mapped(given, jsbsim).unwrap();
    assert_eq!(maneuver.channels()["alpha"].recorded_unit, "deg");
    assert_eq!(maneuver.time(), [0.0, 20.0]);
}
