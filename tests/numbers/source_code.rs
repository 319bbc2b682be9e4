//! Models as source code: compiled by a C compiler, run by Python, read as MATLAB's, against Trimtab's own simulation.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;

use serde_json::json;
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobResult, NoSourceCode, Plan};
use trimtab_core::model::SourceLanguage;

use crate::common::estimation::{fly, scenario};
use crate::common::plans::plan;
use crate::common::recordings::maneuver;
use crate::common::repository;

/// RK4 over the samples of a table of inputs (a header: rows, step), straight lines between them; prints outputs.
const C_MAIN: &str = r#"
#include <stdio.h>
int main(int count, char **arguments) {
    FILE *table = fopen(arguments[count - 1], "r");
    int rows; double h;
    if (!table || fscanf(table, "%d %lf", &rows, &h) != 2) return 1;
    double x[MODEL_STATES], u[2][MODEL_INPUTS], m[MODEL_INPUTS], y[MODEL_OUTPUTS];
    double k[4][MODEL_STATES], at[MODEL_STATES];
    model_initial(x, u[0], 0.0, x);
    for (int row = 0; row < rows; row++) {
        for (int i = 0; i < MODEL_INPUTS; i++) {
            u[0][i] = u[1][i];
            if (fscanf(table, "%lf", &u[1][i]) != 1) return 1;
            m[i] = 0.5 * (u[0][i] + u[1][i]);
        }
        double t = (row - 1) * h;
        if (row > 0) {
            model_derivative(x, u[0], t, k[0]);
            for (int i = 0; i < MODEL_STATES; i++) at[i] = x[i] + 0.5 * h * k[0][i];
            model_derivative(at, m, t + 0.5 * h, k[1]);
            for (int i = 0; i < MODEL_STATES; i++) at[i] = x[i] + 0.5 * h * k[1][i];
            model_derivative(at, m, t + 0.5 * h, k[2]);
            for (int i = 0; i < MODEL_STATES; i++) at[i] = x[i] + h * k[2][i];
            model_derivative(at, u[1], t + h, k[3]);
            for (int i = 0; i < MODEL_STATES; i++)
                x[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
        }
        model_output(x, u[1], row * h, y);
        for (int i = 0; i < MODEL_OUTPUTS; i++) printf("%.17g ", y[i]);
        printf("\n");
    }
    return 0;
}
"#;

const PYTHON_MAIN: &str = r#"
import sys

with open(sys.argv[1]) as table:
    first, *lines = table.read().splitlines()
h = float(first.split()[1])
rows = [[float(cell) for cell in line.split()] for line in lines]
x = initial()
add = lambda x, h, k: [a + h * b for a, b in zip(x, k)]
for row, u in enumerate(rows):
    if row > 0:
        before, t = rows[row - 1], (row - 1) * h
        middle = [0.5 * (a + b) for a, b in zip(before, u)]
        k1 = derivative(x, before, t)
        k2 = derivative(add(x, 0.5 * h, k1), middle, t + 0.5 * h)
        k3 = derivative(add(x, 0.5 * h, k2), middle, t + 0.5 * h)
        k4 = derivative(add(x, h, k3), u, t + h)
        x = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(x, k1, k2, k3, k4)]
    print(*(repr(y) for y in output(x, u, row * h)))
"#;

pub(crate) fn fitted(
    model: &str,
    maneuver: &Arc<Maneuver>,
    changes: serde_json::Value,
) -> (Plan, JobResult) {
    let plan = plan(json!(model), changes, std::slice::from_ref(maneuver));
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(()));
    (plan, result.unwrap_or_else(|faults| panic!("{faults:#?}")))
}

/// A folder of its own for a test, removed at the end.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("trimtab-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> PathBuf {
        let file = self.0.join(name);
        std::fs::write(&file, text).expect("written");
        file
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The inputs of a plan's segment as the mains read them.
pub(crate) fn table(plan: &Plan) -> String {
    let segment = &plan.problem.segments[0];
    let mut text = format!("{} {:?}\n", segment.len(), segment.steps.length(0));
    for k in 0..segment.len() {
        let row: Vec<String> = segment
            .inputs
            .iter()
            .map(|u| format!("{:?}", u[k]))
            .collect();
        text += &format!("{}\n", row.join(" "));
    }
    text
}

pub(crate) fn run(command: &mut Command) -> String {
    let output = command.output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).to_string();
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout).expect("text")
}

/// What was printed, against the model's outputs in the result of the job.
pub(crate) fn agrees(printed: &str, result: &JobResult, within: f64) {
    let history = &result.histories[0];
    let rows: Vec<Vec<f64>> = (printed.lines())
        .map(|line| {
            line.split_whitespace()
                .map(|y| y.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), history.time.len());
    for (place, output) in history.outputs.iter().enumerate() {
        let size = output
            .model
            .iter()
            .fold(0.0, |most: f64, y| most.max(y.abs()));
        for (row, expected) in rows.iter().zip(&output.model) {
            let off = (row[place] - expected).abs();
            assert!(
                off <= within * size,
                "{}: {} for {expected}",
                output.name,
                row[place]
            );
        }
    }
}

fn in_c(plan: &Plan, result: &JobResult, name: &str, within: f64) {
    let folder = Folder::new(name);
    let text = job::source_code(plan, &result.estimate, None, SourceLanguage::C).expect("a file");
    let source = folder.write("model.c", &(text + C_MAIN));
    let inputs = folder.write("inputs.txt", &table(plan));
    let program = folder.0.join("model");
    let mut compiler = Command::new("cc");
    compiler.args([
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-Wno-unused-variable",
        "-O1",
        "-ffp-contract=off",
    ]);
    run(compiler.arg(source).arg("-o").arg(&program).arg("-lm"));
    agrees(&run(Command::new(program).arg(inputs)), result, within);
}

fn in_python(plan: &Plan, result: &JobResult, name: &str, within: f64) {
    if !has_python() {
        return;
    }
    let folder = Folder::new(&format!("{name}-py"));
    let text = job::source_code(plan, &result.estimate, None, SourceLanguage::Python);
    let source = folder.write("model.py", &(text.expect("a file") + PYTHON_MAIN));
    let inputs = folder.write("inputs.txt", &table(plan));
    agrees(
        &run(Command::new("python3").arg(source).arg(inputs)),
        result,
        within,
    );
}

/// The MATLAB file, by its own rules read into Python: Octave reads it in `tests/python/simulators`.
fn in_matlab(plan: &Plan, result: &JobResult, name: &str, within: f64) {
    if !has_python() {
        return;
    }
    let folder = Folder::new(&format!("{name}-m"));
    let text = job::source_code(plan, &result.estimate, None, SourceLanguage::Matlab);
    let source = folder.write("model.m", &text.expect("a file"));
    let reader = repository::path("tests/numbers/simulators/matlab_to_python.py");
    let module = run(Command::new("python3").arg(reader).arg(source));
    let source = folder.write("model.py", &(module + PYTHON_MAIN));
    let inputs = folder.write("inputs.txt", &table(plan));
    let printed = run(Command::new("python3").arg(source).arg(inputs));
    agrees(&printed, result, within);
}

pub(crate) fn has_python() -> bool {
    let there = Command::new("python3").arg("--version").output().is_ok();
    if !there {
        eprintln!("skipped: there is no python3");
    }
    there
}

#[test]
fn the_short_period_runs_in_c_in_python_and_in_matlab() {
    let elevator = maneuver(include_bytes!("../../data/elevator.csv"));
    let (plan, result) = fitted("short-period", &elevator, json!({}));
    in_c(&plan, &result, "short-period", 1e-9);
    in_python(&plan, &result, "short-period", 1e-9);
    in_matlab(&plan, &result, "short-period", 1e-9);
}

/// Square roots, arcs, powers and the rest.
#[test]
fn six_degrees_of_freedom_run_in_c_in_python_and_in_matlab() {
    let maneuver = fly(&scenario("six-degrees-of-freedom"));
    let changes = json!({"options": {"max_iterations": 2, "steps_per_sample": 1}});
    let (plan, result) = fitted("six-degrees-of-freedom", &maneuver, changes);
    in_c(&plan, &result, "six-dof", 1e-7);
    in_python(&plan, &result, "six-dof", 1e-7);
    in_matlab(&plan, &result, "six-dof", 1e-7);
}

/// Paths are named where they change anything, and not where they do not.
#[test]
fn what_is_not_in_the_functions_is_said() {
    let elevator = maneuver(include_bytes!("../../data/elevator.csv"));
    let edits = json!({"edits": [{"kind": "sensor_delay", "target": "alpha"}, {"kind": "actuator_lag", "target": "de"}],
        "parameters": {"de_lag": {"fixed": true}}});
    let (plan, result) = fitted("short-period", &elevator, edits);
    let text = job::source_code(&plan, &result.estimate, None, SourceLanguage::C).expect("a file");
    assert!(text.contains("NOT in it: the delay of alpha"), "{text}");
    assert_eq!(
        text.contains("the lag of de"),
        result
            .estimate
            .parameters
            .iter()
            .any(|row| row.name == "de_lag" && row.estimate != 0.0)
    );
    let refused = job::source_code(&plan, &result.estimate, Some("x"), SourceLanguage::C);
    assert!(
        matches!(refused, Err(NoSourceCode::Segment { .. })),
        "{refused:?}"
    );
}

/// Exponentials and powers that leave the range: behind a fraction they are zero, in Rust as in C and in Python.
#[test]
fn what_leaves_the_range_is_infinite_in_c_and_in_python() {
    let model = json!({
        "name": "steep", "inputs": {"de": {"unit": "rad"}},
        "parameters": {
            "b": {"unit": "1/s", "start": 1.0},
            "k": {"unit": "-", "start": 1e5, "fixed": true},
            "n": {"unit": "-", "start": 400.5, "fixed": true},
        },
        "outputs": {"q": {
            "unit": "rad/s",
            "equation": "b*de/(1 + exp(k*(de + 0.02))) + b*de/(1 + (1 + 1e4*abs(de))^n)",
        }},
    });
    let elevator = maneuver(include_bytes!("../../data/elevator.csv"));
    let plan = plan(model, json!({}), std::slice::from_ref(&elevator));
    let result = job::run(&plan, &mut |_| ControlFlow::Continue(()));
    let result = result.unwrap_or_else(|faults| panic!("{faults:#?}"));
    let beyond =
        (plan.problem.segments[0].inputs[0].iter()).filter(|de| 1e5 * (*de + 0.02) > 710.0);
    assert!(beyond.count() > 10, "the exponential leaves the range");
    in_c(&plan, &result, "steep", 1e-12);
    in_python(&plan, &result, "steep", 1e-12);
}

/// As C99 has it, annex F.9.3.1 and F.9.4.4.
#[test]
fn powers_in_python_are_those_of_c() {
    if !has_python() {
        return;
    }
    let elevator = maneuver(include_bytes!("../../data/elevator.csv"));
    let (plan, result) = fitted("short-period", &elevator, json!({}));
    let text = job::source_code(&plan, &result.estimate, None, SourceLanguage::Python);
    let main = "print(_power(0.0, -0.5), _power(-0.0, -3.0), _power(-0.0, -2.0), _power(-10.0, 309.0), _power(-10.0, 400.0), _power(-8.0, 0.5), _exp(1e4), _exp(-1e4))";
    let folder = Folder::new("powers");
    let source = folder.write("powers.py", &(text.expect("a file") + main));
    let printed = run(Command::new("python3").arg(source));
    assert_eq!(printed.trim(), "inf -inf inf -inf inf nan inf 0.0");
}
