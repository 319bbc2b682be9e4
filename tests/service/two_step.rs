//! The two-step method in one command: reconstruct the flight path, then estimate from what it has corrected.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn trimtab(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trimtab"));
    let directory = Path::new(env!("CARGO_MANIFEST_DIR"));
    let output = command.args(arguments).current_dir(directory).output();
    output.expect("the program runs")
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// A flight of all axes, whose pitch rate gyro is 0.01 rad/s off.
fn flown() -> PathBuf {
    let file = std::env::temp_dir().join(format!("trimtab-two-step-{}.csv", std::process::id()));
    let scenario = "tests/numbers/catalog/six-degrees-of-freedom.toml";
    let place = file.to_string_lossy();
    let done = trimtab(&[
        "simulate",
        scenario,
        "--effect",
        "sensor_bias:q=0.01",
        "-o",
        &place,
    ]);
    assert!(done.status.success(), "{}", said(&done.stderr));
    file
}

const RECONSTRUCTION: [&str; 8] = [
    "--reconstruct",
    "flight-path-reconstruction-attitude",
    "--reconstruct-channel",
    "pdot=derivative(p,3[Hz])",
    "--reconstruct-channel",
    "qdot=derivative(q,3[Hz])",
    "--reconstruct-channel",
    "rdot=derivative(r,3[Hz])",
];

#[test]
fn aerodynamics_are_estimated_from_a_recording_that_was_corrected_first() {
    let file = flown();
    let place = file.to_string_lossy();
    let fit = |more: &[&str]| {
        let common = ["fit", &place, "-m", "six-degrees-of-freedom"];
        trimtab(&[&common[..], more].concat())
    };
    let both = fit(&RECONSTRUCTION);
    let text = said(&both.stdout);
    assert!(both.status.success(), "{}", said(&both.stderr));
    assert!(
        text.starts_with("reconstruction\n") && text.contains("q_bias") && text.contains("Cmq"),
        "{text}"
    );
    let json = |more: &[&str]| -> Value {
        let done = fit(&[more, &["--json"]].concat());
        serde_json::from_slice(&done.stdout).expect("one result")
    };
    let (two, one) = (json(&RECONSTRUCTION), json(&[]));
    let estimate = |result: &Value, name: &str| {
        let rows = result["estimate"]["parameters"].as_array().expect("rows");
        let row = rows.iter().find(|row| row["name"] == name).expect(name);
        row["estimate"].as_f64().expect("a number")
    };
    // truth as the scenario has it; of the model's longitudinal terms those of the rate of alpha are held at zero
    let truth = [
        ("Clp", -0.41),
        ("Clda", 0.134),
        ("Clb", -0.074),
        ("Cnb", 0.071),
        ("Cnr", -0.125),
        ("Cndr", -0.072),
        ("Cyb", -0.564),
    ];
    for (name, truth) in truth {
        let found = estimate(&two, name);
        assert!(
            (found / truth - 1.0).abs() < 0.03,
            "{name}: {found} for {truth}"
        );
    }
    // the bias is out of what was corrected; left in, the fit takes it up
    let residual = |result: &Value| {
        let outputs = result["estimate"]["outputs"].as_array().expect("outputs");
        let q = outputs
            .iter()
            .find(|output| output["name"] == "q")
            .expect("q");
        q["bias"].as_f64().expect("a number").abs()
    };
    assert!(
        residual(&two) < 1e-3 && residual(&one) > 2e-3,
        "{} {}",
        residual(&two),
        residual(&one)
    );

    let no_correction = ["--reconstruct", "short-period"];
    let refused = fit(&no_correction);
    assert_eq!(refused.status.code(), Some(1));
    assert!(
        said(&refused.stderr).contains("no reconstruction"),
        "{}",
        said(&refused.stderr)
    );
    let unknown = fit(&["--reconstruct", "x"]);
    assert!(
        said(&unknown.stderr)
            .contains("--reconstruct: there is no catalog model 'x'; the catalog has "),
        "{}",
        said(&unknown.stderr)
    );
    std::fs::remove_file(file).expect("removed");
}
