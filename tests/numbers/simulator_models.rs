//! Models for simulators: a functional mock-up unit, compiled and driven as an importing tool does, and aerodynamics of JSBSim, evaluated
//! by Python, against Trimtab's own simulation. The tools themselves read them in `tests/python/simulators`.

use std::io::Write as _;
use std::process::{Command, Stdio};

use serde_json::{Value, json};
use trimtab_core::job::{self, JobResult, NoSourceCode, Plan, SimulatorFormat};
use trimtab_core::model::{FmuSetting, Model, NoAerodynamics};

use crate::common::estimation::{fly, scenario};
use crate::common::plans::scatter;
use crate::common::recordings::maneuver;
use crate::common::repository;
use crate::source_code::{Folder, agrees, fitted, has_python, run, table};

/// The files of an archive without compression, by the local headers.
fn files(archive: &[u8]) -> Vec<(String, String)> {
    let mut all = Vec::new();
    let mut rest = archive;
    while rest.starts_with(b"PK\x03\x04") {
        let number = |at: usize| usize::from(u16::from_le_bytes([rest[at], rest[at + 1]]));
        let (size, name, extra) = (number(18) + (number(20) << 16), number(26), number(28));
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("text");
        let start = 30 + name + extra;
        all.push((text(&rest[30..30 + name]), text(&rest[start..start + size])));
        rest = &rest[start + size..];
    }
    all
}

/// The value of an attribute, where it stands first.
fn attribute<'t>(text: &'t str, name: &str) -> &'t str {
    let (_, behind) = text.split_once(&format!(" {name}=\"")).expect(name);
    behind.split('"').next().unwrap_or_default()
}

struct Fmu {
    folder: Folder,
    description: String,
}

impl Fmu {
    /// Compiled, with warnings as errors.
    fn compiled(plan: &Plan, result: &JobResult, name: &str) -> Self {
        let format = SimulatorFormat::Fmu;
        let archive = job::simulator_model(plan, &result.estimate, None, format).expect("a file");
        let folder = Folder::new(&format!("{name}-fmu"));
        let mut description = String::new();
        for (path, content) in files(&archive) {
            match path.strip_prefix("sources/") {
                Some(source) => drop(folder.write(source, &content)),
                None => description = content,
            }
        }
        let given = repository::path("tests/numbers/simulators");
        let mut compiler = Command::new("cc");
        compiler.args([
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-Wno-unused-variable",
        ]);
        compiler
            .args(["-O1", "-ffp-contract=off", "-I"])
            .arg(&given);
        compiler
            .arg(folder.0.join("fmi2.c"))
            .arg(folder.0.join("model.c"));
        compiler
            .arg(given.join("importer.c"))
            .arg("-o")
            .arg(folder.0.join("importer"));
        run(compiler.arg("-lm"));
        Self {
            folder,
            description,
        }
    }

    /// Value references of the variables whose element has these words.
    fn references(&self, words: &str) -> Vec<usize> {
        (self.description.lines())
            .filter(|line| line.starts_with("<ScalarVariable") && line.contains(words))
            .map(|line| attribute(line, "valueReference").parse().expect("a number"))
            .collect()
    }

    fn simulated(&self, plan: &Plan, kind: &str, parameters: &[(&str, f64)]) -> String {
        let inputs = self.references("causality=\"input\"");
        let outputs = self.references("causality=\"output\"");
        let places = [inputs[0], inputs.len(), outputs[0], outputs.len()];
        let inputs = self.folder.write("inputs.txt", &table(plan));
        let mut importer = Command::new(self.folder.0.join("importer"));
        importer.arg(attribute(&self.description, "guid"));
        importer.args(places.map(|place| place.to_string()));
        importer.arg(kind).arg(inputs);
        for (name, value) in parameters {
            let reference = self.references(&format!(" name=\"{name}\""))[0];
            importer.args([reference.to_string(), format!("{value:?}")]);
        }
        run(&mut importer)
    }
}

fn elevator(changes: Value) -> (Plan, JobResult) {
    let recorded = maneuver(include_bytes!("../../data/elevator.csv"));
    fitted("short-period", &recorded, changes)
}

#[test]
fn a_functional_mock_up_unit_simulates_as_trimtab_does() {
    let (plan, result) = elevator(json!({"options": {"steps_per_sample": 1}}));
    let unit = Fmu::compiled(&plan, &result, "short-period");
    agrees(&unit.simulated(&plan, "straight", &[]), &result, 1e-9);
    agrees(&unit.simulated(&plan, "exchange", &[]), &result, 1e-9);
    let (plan, result) =
        elevator(json!({"options": {"steps_per_sample": 1, "input_interpolation": "hold"}}));
    let unit = Fmu::compiled(&plan, &result, "short-period-held");
    agrees(&unit.simulated(&plan, "held", &[]), &result, 1e-9);
}

#[test]
fn six_degrees_of_freedom_are_a_functional_mock_up_unit() {
    let maneuver = fly(&scenario("six-degrees-of-freedom"));
    let changes = json!({"options": {"max_iterations": 2, "steps_per_sample": 1}});
    let (plan, result) = fitted("six-degrees-of-freedom", &maneuver, changes);
    let unit = Fmu::compiled(&plan, &result, "six-dof");
    agrees(&unit.simulated(&plan, "straight", &[]), &result, 1e-7);
}

/// A parameter and the initial state that depends on it, against a job that holds them there.
#[test]
fn parameters_of_a_functional_mock_up_unit_can_be_changed() {
    let (plan, result) = elevator(json!({"options": {"steps_per_sample": 1}}));
    let unit = Fmu::compiled(&plan, &result, "changed");
    let held = [
        "Za", "Zq", "Zde", "Ma", "Mq", "Mde", "alpha_eq", "de_eq", "alpha_0", "q_0",
    ];
    let mut parameters = serde_json::Map::new();
    let mut set = Vec::new();
    for row in &result.estimate.parameters {
        let value = match row.name.as_str() {
            "Ma" => 1.3 * row.estimate,
            "alpha_0" => row.estimate + 0.01,
            _ => row.estimate,
        };
        if held.contains(&row.name.as_str()) {
            parameters.insert(row.name.clone(), json!({"start": value, "fixed": true}));
            set.push((row.name.as_str(), value));
        } else {
            parameters.insert(row.name.clone(), json!({"start": row.estimate}));
        }
    }
    let changes = json!({"parameters": parameters, "options": {"steps_per_sample": 1}});
    let (other, moved) = elevator(changes);
    for row in moved.estimate.parameters.iter().filter(|row| !row.fixed) {
        set.push((row.name.as_str(), row.estimate));
    }
    agrees(&unit.simulated(&other, "straight", &set), &moved, 1e-9);
    let first = |result: &JobResult| result.histories[0].outputs[0].model[0];
    assert!(
        (first(&moved) - first(&result) - 0.01).abs() < 1e-3,
        "the initial state moved"
    );
}

/// Read by Python's parser: names and references once each, the structure points at what it says.
#[test]
fn the_description_of_a_functional_mock_up_unit_is_consistent() {
    if !has_python() {
        return;
    }
    let edits = json!({"edits": [{"kind": "sensor_delay", "target": "alpha"}]});
    let (plan, result) = elevator(edits);
    let unit = Fmu::compiled(&plan, &result, "description");
    assert!(attribute(&unit.description, "description").contains("NOT in it: the delay of alpha"));
    let file = unit.folder.write("modelDescription.xml", &unit.description);
    let check = r#"
import sys, xml.etree.ElementTree as xml
root = xml.parse(sys.argv[1]).getroot()
variables = root.findall("ModelVariables/ScalarVariable")
names = [v.get("name") for v in variables]
assert len(set(names)) == len(names), names
assert [int(v.get("valueReference")) for v in variables] == list(range(len(variables)))
units = {u.get("name") for u in root.findall("UnitDefinitions/Unit")}
for v in variables:
    real = v.find("Real")
    assert real.get("unit") is None or real.get("unit") in units, v.attrib
    assert (real.get("start") is not None) == (v.get("causality") in ("input", "parameter")), v.attrib
    if real.get("derivative"):
        of = variables[int(real.get("derivative")) - 1].get("name")
        assert v.get("name") == f"der({of})"
pick = lambda what: [variables[int(u.get("index")) - 1].get("name") for u in root.findall(f"ModelStructure/{what}/Unknown")]
print(pick("Outputs"), pick("Derivatives"), [n for n in names if n.startswith("state.")])
"#;
    let printed = run(Command::new("python3").arg("-c").arg(check).arg(file));
    let expected = "['alpha', 'q'] ['der(state.alpha)', 'der(state.q)'] ['state.alpha', 'state.q']";
    assert_eq!(printed.trim(), expected);
}

/// In FMI 2.0's schema `UnitDefinitions` has one `Unit` or more, and need not be there.
#[test]
fn a_model_without_units_has_no_unit_definitions() {
    let described = |unit: &str| {
        let text = format!(
            "name = \"ratio\"\n[inputs]\nu = {{ unit = \"{unit}\" }}\n[parameters]\nk = {{ start = 1 }}\n[outputs]\ny = {{ unit = \"{unit}\", equation = \"k*u\" }}\n"
        );
        let model = Model::compile(&toml::from_str(&text).expect("a document"));
        let archive = model.expect("a model").fmu(&FmuSetting {
            parameters: &[1.0],
            inputs: &[0.0],
            step: 0.1,
            duration: 1.0,
            of: "\u{ffff}",
        });
        let mut all = files(&archive).into_iter();
        let description = all.find(|(name, _)| name == "modelDescription.xml");
        description.expect("the description").1
    };
    let (without, with) = (described("-"), described("m"));
    assert!(!without.contains("UnitDefinitions"), "{without}");
    // XML cannot have it
    assert!(!without.contains('\u{ffff}'), "{without}");
    let units =
        "<UnitDefinitions>\n<Unit name=\"m\"><BaseUnit m=\"1\"/></Unit>\n</UnitDefinitions>";
    assert!(with.contains(units), "{with}");
    if has_python() {
        let folder = Folder::new("no-units-fmu");
        let file = folder.write("modelDescription.xml", &without);
        let parse = "import sys, xml.etree.ElementTree as xml; xml.parse(sys.argv[1])";
        run(Command::new("python3").arg("-c").arg(parse).arg(file));
    }
}

/// Forces and moments in N and N m of a model with its parameters, by Python from the file; JSBSim's properties from `rows`.
fn forces(file: &[u8], rows: &Value) -> Vec<Value> {
    let folder = Folder::new(&format!("jsbsim-{}", rows.to_string().len()));
    let file = folder.write("aero.xml", std::str::from_utf8(file).expect("text"));
    let script = repository::path("tests/numbers/simulators/jsbsim_functions.py");
    let mut python = Command::new("python3")
        .arg(script)
        .arg(file)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it runs");
    let input = python
        .stdin
        .take()
        .expect("its input")
        .write_all(rows.to_string().as_bytes());
    input.expect("written");
    let output = python.wait_with_output().expect("its end");
    assert!(output.status.success());
    serde_json::from_slice(&output.stdout).expect("rows")
}

const FOOT: f64 = 0.3048;
const POUND: f64 = 4.448_221_615_260_5;

/// The coefficients of the Navion by hand, at states without structure.
#[test]
fn aerodynamics_of_jsbsim_are_those_of_the_model() {
    if !has_python() {
        return;
    }
    let maneuver = fly(&scenario("six-degrees-of-freedom"));
    let changes = json!({"options": {"max_iterations": 2}});
    let (plan, result) = fitted("six-degrees-of-freedom", &maneuver, changes);
    let of = |name: &str| {
        let mut rows = result.estimate.parameters.iter();
        rows.find(|row| row.name == name).expect(name).estimate
    };
    let format = SimulatorFormat::Jsbsim;
    let file = job::simulator_model(&plan, &result.estimate, None, format).expect("a file");
    let (s, b, c) = (17.094, 10.18, 1.737);
    let mut rows = Vec::new();
    let mut expected = Vec::new();
    for k in 0..20 {
        let n = |seed: f64| scatter(k, seed);
        let (alpha, beta, v) = (0.4 * n(1.0), 0.3 * n(2.0), 60.0 + 20.0 * n(3.0));
        let (p, q, r) = (n(4.0), n(5.0), n(6.0));
        let (de, da, dr) = (0.3 * n(7.0), 0.3 * n(8.0), 0.3 * n(9.0));
        let qbar = 2000.0 + 1000.0 * n(10.0);
        rows.push(json!({
            "aero/alpha-rad": alpha, "aero/beta-rad": beta, "velocities/vt-fps": v / FOOT,
            "aero/qbar-psf": qbar * FOOT * FOOT / POUND, "aero/alphadot-rad_sec": 0.1,
            "velocities/p-aero-rad_sec": p, "velocities/q-aero-rad_sec": q, "velocities/r-aero-rad_sec": r,
            "fcs/elevator-pos-rad": de, "fcs/left-aileron-pos-rad": da, "fcs/rudder-pos-rad": dr,
            "metrics/Sw-sqft": s / FOOT / FOOT, "metrics/bw-ft": b / FOOT, "metrics/cbarw-ft": c / FOOT,
        }));
        let (ph, qh, rh) = (b * p / (2.0 * v), c * q / (2.0 * v), b * r / (2.0 * v));
        let lateral = |a: &str| {
            let sum = [
                ("0", 1.0),
                ("b", beta),
                ("p", ph),
                ("r", rh),
                ("da", da),
                ("dr", dr),
            ];
            sum.iter()
                .map(|(d, x)| of(&format!("{a}{d}")) * x)
                .sum::<f64>()
        };
        let force = qbar * s;
        expected.push([
            ("X BODY", force * (of("Cx0") + of("Cxa") * alpha)),
            ("Y BODY", force * lateral("Cy")),
            (
                "Z BODY",
                force * (of("Cz0") + of("Cza") * alpha + of("Czq") * qh + of("Czde") * de),
            ),
            ("ROLL BODY", force * b * lateral("Cl")),
            (
                "PITCH BODY",
                force * c * (of("Cm0") + of("Cma") * alpha + of("Cmq") * qh + of("Cmde") * de),
            ),
            ("YAW BODY", force * b * lateral("Cn")),
        ]);
    }
    for (found, expected) in forces(&file, &json!(rows)).iter().zip(expected) {
        assert_eq!(found.as_object().expect("axes").len(), 6);
        for (axis, si) in expected {
            let unit = if axis.len() < 7 { POUND } else { POUND * FOOT };
            let off = found[axis].as_f64().expect("a number") * unit - si;
            assert!(off.abs() < 1e-9 * (1.0 + si.abs()), "{axis}: {off} of {si}");
        }
    }
}

fn aerodynamics(text: &str) -> Result<String, NoAerodynamics> {
    let document = toml::from_str(text).expect("a document");
    let model = Model::compile(&document).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let parameters = vec![2.0; model.parameters.len()];
    model.jsbsim(&parameters, "it --- it ---- it\u{8}")
}

/// Functions that JSBSim does not have, its stability axes, controls of its own; by hand.
#[test]
fn every_function_of_an_equation_is_one_of_jsbsim() {
    if !has_python() {
        return;
    }
    let file = aerodynamics(
        r#"name = "all"
        [inputs]
        df = { unit = "-", description = "flap lever" }
        [states]
        alpha = { unit = "deg", quantity = "angle_of_attack", initial = "0", derivative = "CL*1[1/s]" }
        [parameters]
        k = { start = 1 }
        unused = { start = 1 }
        [definitions]
        stall = { equation = "tanh(3*alpha - 1) + sign(df - 0.25)*min(k, 0.5) + max(alpha, -alpha)^2.5" }
        CL = { equation = "if(alpha > 0.1, k*stall, if(alpha <= -0.1, exp(-alpha), ln(2 + alpha)/sqrt(1 + abs(alpha)))) - atan2(alpha, 2) + 30[deg]" }
        CD = { equation = "0.02 + k*CL^2/(pi*7)" }
        [outputs]
        alpha = { unit = "rad", equation = "alpha + unused*0" }
        "#,
    )
    .expect("a file");
    let (_, head) = file.split_once("<!--").expect("a head");
    let (head, _) = head.split_once("-->").expect("its end");
    assert!(head.contains("it - - - it - - - - it"), "{head}");
    assert!(!head.contains("--") && !head.contains('\u{8}'), "{head}");
    assert!(file.contains("aero/trimtab/df [-] has to be set"), "{file}");
    let k = 2.0;
    let points = [0.3, 0.12, 0.05, -0.05, -0.1, -0.4];
    let row = |alpha: f64| json!({"aero/alpha-rad": alpha, "aero/qbar-psf": 10.0, "metrics/Sw-sqft": 3.0});
    let rows: Vec<Value> = points.map(row).to_vec();
    for (found, alpha) in forces(file.as_bytes(), &json!(rows)).iter().zip(points) {
        // the flap lever begins at 0
        let stall = (3.0 * alpha - 1.0).tanh() - 0.5 + alpha.abs().powf(2.5);
        let lift = match alpha {
            alpha if alpha > 0.1 => k * stall,
            alpha if alpha <= -0.1 => (-alpha).exp(),
            alpha => (2.0 + alpha).ln() / (1.0 + alpha.abs()).sqrt(),
        } - alpha.atan2(2.0)
            + std::f64::consts::PI / 6.0;
        let drag = 0.02 + k * lift * lift / (std::f64::consts::PI * 7.0);
        for (axis, coefficient) in [("Z STABILITY", lift), ("X STABILITY", drag)] {
            let off = found[axis].as_f64().expect("a number") - 30.0 * coefficient;
            assert!(
                off.abs() < 1e-11 * (1.0 + coefficient.abs()),
                "{axis} at {alpha}: {off}"
            );
        }
        // an axis of moments there must be
        assert_eq!(found["PITCH BODY"], 0.0);
    }
}

#[test]
fn what_jsbsim_cannot_have_is_refused_with_its_name() {
    let (plan, result) = elevator(json!({}));
    let format = SimulatorFormat::Jsbsim;
    let none = job::simulator_model(&plan, &result.estimate, None, format);
    assert_eq!(
        none,
        Err(NoSourceCode::Aerodynamics(NoAerodynamics::NoCoefficient))
    );
    let with = |equation: &str, more: &str| {
        aerodynamics(&format!(
            "name = \"one\"\n[states]\nalpha = {{ unit = \"rad\", initial = \"0\", derivative = \"CL*1[1/s]\" }}\nz = {{ initial = \"0\", derivative = \"CL*1[1/s]\" }}\n[definitions]\nCL = {{ equation = \"{equation}\" }}\n{more}\n[outputs]\nalpha = {{ unit = \"rad\", equation = \"alpha\" }}\n"
        ))
    };
    assert!(with("alpha", "").is_ok());
    let name = || "z".to_string();
    assert_eq!(
        with("alpha + z", ""),
        Err(NoAerodynamics::NoProperty { name: name() })
    );
    let time = Err(NoAerodynamics::Time {
        name: "CL".to_string(),
    });
    assert_eq!(with("alpha + 1[1/s]*t", ""), time);
    let both = "CX = { quantity = \"force_coefficient_x\", equation = \"alpha\" }";
    let mixed = NoAerodynamics::MixedAxes {
        first: "CL".to_string(),
        second: "CX".to_string(),
    };
    assert_eq!(with("alpha", both), Err(mixed));
}
