//! The problems of the derivative study: models and simulated data of known truth.

use std::fmt::Write;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use trimtab_core::estimate::{Options, Problem, Unknowns};
use trimtab_core::model::{Model, ModelDocument, Start, catalog};
use trimtab_core::simulate::{Segment, Steps, Substeps, simulate};

/// As many samples as Machado's tables are made with.
pub(crate) const SAMPLES: usize = 1502;

pub(crate) fn short_period() -> Problem {
    let document = catalog::find("short-period").expect("in the catalog");
    let truth = |name: &str| match name {
        "Za" => -0.85,
        "Zq" => 0.97,
        "Zde" => -0.08,
        "Ma" => -3.4,
        "Mq" => -1.6,
        "Mde" => -4.8,
        "q_bias" => 0.002,
        "alpha_eq" | "alpha_0" => 0.06,
        "de_eq" => -0.02,
        _ => 0.0,
    };
    made(
        &document,
        truth,
        |i| 0.8 + 0.02 * i as f64,
        0.02,
        5e-4,
        Options::default(),
    )
}

pub(crate) fn lateral() -> Problem {
    let document = catalog::find("lateral-directional-2").expect("in the catalog");
    let truth = |name: &str| match name {
        "Lp" => -3.8,
        "Lr" => 1.6,
        "Lda" => -10.0,
        "Ldr" => 1.6,
        "Lb" => -5.5,
        "Np" => -0.4,
        "Nr" => -0.6,
        "Nda" => -0.7,
        "Ndr" => -3.1,
        "Nb" => 2.5,
        "Yp" => -0.1,
        "Yr" => 2.0,
        "Yda" => -0.6,
        "Ydr" => 4.2,
        "Yb" => -28.0,
        _ => 0.01,
    };
    made(
        &document,
        truth,
        |i| 0.8 + 0.02 * i as f64,
        0.02,
        2e-3,
        Options::default(),
    )
}

/// As large as the flexible aircraft that Machado's table 12 names (20 states, 42 outputs, 7 inputs, 210
/// parameters), of our own making.
pub(crate) fn flexible_aircraft() -> Problem {
    let document = flexible_aircraft_document();
    let values: Vec<f64> = document
        .parameters
        .values()
        .map(|p| match p.start {
            Start::Value(value) => value,
            Start::FromData(_) => 0.0,
        })
        .collect();
    let names: Vec<String> = document.parameters.keys().cloned().collect();
    let truth = |name: &str| values[names.iter().position(|n| n == name).expect("a name")];
    let off = |i: usize| 1.0 + 0.04 * (i as f64 * 1.7).sin();
    made(&document, truth, off, 0.02, 1e-3, Options::default())
}

/// Symmetric and antisymmetric flexible modes, the inputs that drive each kind of motion.
const SYMMETRIC: usize = 4;
const MODES: usize = 7;
const LONGITUDINAL: [&str; 3] = ["de", "ds", "dt"];
const LATERAL: [&str; 4] = ["dai", "dao", "dr", "dsa"];

/// State, unit, what its rate is without parameters, derivatives by states, whether symmetric, size of controls.
type Rigid = (
    &'static str,
    &'static str,
    &'static str,
    &'static [(&'static str, f64)],
    bool,
    f64,
);

/// Rigid short period and lateral-directional motion (6 states), seven flexible modes (14 states), each mode driven
/// by rates, angles and controls of its symmetry and acting back on moments and forces. Sensors: six of the rigid
/// motion, 18 vertical and six lateral accelerometers along the structure, 12 strain gauges, of which the first
/// seven read one mode each: they fix the modes' scales. Parameters start at their true values.
pub(crate) fn flexible_aircraft_document() -> ModelDocument {
    let mut text = Text::default();
    for input in LONGITUDINAL.iter().chain(&LATERAL) {
        writeln!(text.inputs, "[inputs.{input}]\nunit = \"rad\"").expect("memory");
    }
    let modes = |symmetric: bool| {
        if symmetric {
            1..=SYMMETRIC
        } else {
            SYMMETRIC + 1..=MODES
        }
    };
    // angles and rates: derivatives by state, controls of the symmetry, modes of the symmetry
    let rigid: [Rigid; 5] = [
        ("alpha", "rad", "q", &[("alpha", -0.9)], true, -0.08),
        (
            "q",
            "rad/s",
            "",
            &[("alpha", -4.0), ("q", -1.4)],
            true,
            -3.0,
        ),
        (
            "beta",
            "rad",
            "0.05*phi/s_ - r",
            &[("beta", -0.2)],
            false,
            0.03,
        ),
        (
            "p",
            "rad/s",
            "",
            &[("beta", -5.0), ("p", -3.0), ("r", 0.8)],
            false,
            4.0,
        ),
        (
            "r",
            "rad/s",
            "",
            &[("beta", 2.5), ("p", -0.1), ("r", -0.5)],
            false,
            -1.2,
        ),
    ];
    for (number, (state, unit, known, derivatives, symmetric, control)) in rigid.iter().enumerate()
    {
        let mut terms: Vec<String> = Vec::new();
        for (by, value) in *derivatives {
            terms.push(text.term(&format!("{state}_{by}"), by, *value, per(state, by)));
        }
        let inputs: &[&str] = if *symmetric { &LONGITUDINAL } else { &LATERAL };
        for (i, input) in inputs.iter().enumerate() {
            let value = control * (1.0 - 0.35 * i as f64 + 0.1 * number as f64);
            terms.push(text.term(&format!("{state}_{input}"), input, value, per(state, input)));
        }
        if *state != "beta" {
            for mode in modes(*symmetric) {
                let (by, value) = (format!("eta{mode}"), 0.4 * control / (mode as f64 + 1.0));
                terms.push(text.term(&format!("{state}_{by}"), &by, value, per(state, &by)));
            }
        }
        if !known.is_empty() {
            terms.insert(0, (*known).to_string());
        }
        text.state(state, unit, &terms.join(" + "));
    }
    text.state("phi", "rad", "p");
    for mode in 1..=MODES {
        let symmetric = mode <= SYMMETRIC;
        let (eta, rate) = (format!("eta{mode}"), format!("xi{mode}"));
        text.state(&eta, "-", &rate);
        let (w, z) = (format!("w{mode}"), format!("z{mode}"));
        text.parameter(&w, 7.0 + 3.5 * mode as f64, "1/s");
        text.parameter(&z, 0.03 + 0.004 * mode as f64, "-");
        let mut terms = vec![format!("-{w}^2*{eta}"), format!("-2*{z}*{w}*{rate}")];
        let (bys, inputs): (_, &[&str]) = if symmetric {
            (["alpha", "q"], &LONGITUDINAL)
        } else {
            (["p", "r"], &LATERAL)
        };
        for (i, by) in bys.iter().enumerate() {
            let value = 6.0 * (mode as f64 * 1.3 + i as f64).sin() + 9.0;
            terms.push(text.term(&format!("{rate}_{by}"), by, value, per(&rate, by)));
        }
        for (i, input) in inputs.iter().enumerate() {
            let value = 25.0 * (mode as f64 * 0.9 + 2.0 * i as f64).cos() + 12.0;
            terms.push(text.term(&format!("{rate}_{input}"), input, value, per(&rate, input)));
        }
        text.state(&rate, "1/s", &terms.join(" + ").replace("+ -", "- "));
    }
    for (i, (state, unit)) in [
        ("alpha", "rad"),
        ("q", "rad/s"),
        ("beta", "rad"),
        ("p", "rad/s"),
        ("r", "rad/s"),
        ("phi", "rad"),
    ]
    .into_iter()
    .enumerate()
    {
        let bias = format!("{state}_bias");
        text.parameter(&bias, 1e-3 * (1.0 + i as f64), unit);
        text.output(state, unit, &format!("{state} + {bias}"));
    }
    for station in 1..=18 {
        let (a, b) = (1 + station % SYMMETRIC, 1 + (station + 1) % SYMMETRIC);
        text.sensor(
            &format!("az{station}"),
            &["alpha", &format!("eta{a}"), &format!("eta{b}")],
            station,
        );
    }
    for station in 1..=6 {
        let mode = SYMMETRIC + 1 + station % (MODES - SYMMETRIC);
        text.sensor(
            &format!("ay{station}"),
            &["beta", &format!("eta{mode}")],
            20 + station,
        );
    }
    for gauge in 1..=MODES {
        let bias = format!("e{gauge}_bias");
        text.parameter(&bias, 2e-3 * gauge as f64, "-");
        text.output(&format!("e{gauge}"), "-", &format!("eta{gauge} + {bias}"));
    }
    for gauge in MODES + 1..=12 {
        let a = format!("eta{}", 1 + gauge % SYMMETRIC);
        let b = format!("eta{}", SYMMETRIC + 1 + gauge % (MODES - SYMMETRIC));
        let seen: &[&str] = if gauge <= MODES + 3 { &[&a, &b] } else { &[&a] };
        text.sensor(&format!("e{gauge}"), seen, 30 + gauge);
    }
    let head = "name = \"flexible-aircraft\"\n[constants.s_]\nvalue = 1.0\nunit = \"s\"\n";
    let all = [
        head,
        &text.inputs,
        &text.parameters,
        &text.states,
        &text.outputs,
    ]
    .concat();
    toml::from_str(&all).expect("a document")
}

/// The unit of a derivative of `state`'s rate by `by`: what is left of time.
fn per(state: &str, by: &str) -> &'static str {
    let is_rate = |name: &str| matches!(name, "q" | "p" | "r") || name.starts_with("xi");
    match (is_rate(state), is_rate(by)) {
        (true, false) => "1/s^2",
        (false, true) => "-",
        _ => "1/s",
    }
}

#[derive(Default)]
struct Text {
    inputs: String,
    parameters: String,
    states: String,
    outputs: String,
}

impl Text {
    fn parameter(&mut self, name: &str, start: f64, unit: &str) {
        writeln!(
            self.parameters,
            "[parameters.{name}]\nunit = \"{unit}\"\nstart = {start:?}"
        )
        .expect("memory");
    }

    /// A product with a parameter of its own.
    fn term(&mut self, name: &str, by: &str, value: f64, unit: &str) -> String {
        let parameter = format!("d_{name}");
        self.parameter(&parameter, value, unit);
        format!("{parameter}*{by}")
    }

    fn state(&mut self, name: &str, unit: &str, derivative: &str) {
        writeln!(
            self.states,
            "[states.{name}]\nunit = \"{unit}\"\ninitial = \"0\"\nderivative = \"{derivative}\""
        )
        .expect("memory");
    }

    fn output(&mut self, name: &str, unit: &str, equation: &str) {
        writeln!(
            self.outputs,
            "[outputs.{name}]\nunit = \"{unit}\"\nequation = \"{equation}\""
        )
        .expect("memory");
    }

    /// A sum of what it sees, each with a parameter, and a bias.
    fn sensor(&mut self, name: &str, seen: &[&str], number: usize) {
        let mut terms = Vec::new();
        for (i, by) in seen.iter().enumerate() {
            let value = 1.0 + 0.6 * (number as f64 * 0.7 + i as f64 * 2.0).sin();
            terms.push(self.term(&format!("{name}_{by}"), by, value, "-"));
        }
        let bias = format!("{name}_bias");
        self.parameter(&bias, 1e-3 * (number as f64).cos(), "-");
        terms.push(bias);
        self.output(name, "-", &terms.join(" + "));
    }
}

/// Data of `truth` with white noise, and start values that are `off(i)` times the truth.
pub(crate) fn made(
    document: &ModelDocument,
    truth: impl Fn(&str) -> f64,
    off: impl Fn(usize) -> f64,
    step: f64,
    noise: f64,
    options: Options,
) -> Problem {
    let model = Model::compile(document).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let inputs = |name: &str, channel: usize| -> Vec<f64> {
        (0..SAMPLES)
            .map(|k| input(name, channel, k as f64 * step))
            .collect()
    };
    let mut segment = Segment {
        label: "1".into(),
        time: (0..SAMPLES).map(|k| k as f64 * step).collect(),
        steps: Steps::Even(step),
        substeps: Substeps::default(),
        inputs: (model.inputs.iter().enumerate())
            .map(|(i, input)| inputs(&input.name, i))
            .collect(),
        measured: vec![Vec::new(); model.outputs.len()],
    };
    let parameters: Vec<f64> = model
        .parameters
        .iter()
        .map(|info| info.unit.to_si(truth(&info.name)))
        .collect();
    let mut rng = ChaCha8Rng::seed_from_u64(42);
    let (integrator, interpolation) = (options.integrator, options.input_interpolation);
    let mut measured = segment.measured.clone();
    simulate(
        &model,
        integrator,
        interpolation,
        &segment,
        &parameters,
        |_, y: &[f64]| {
            for (series, y) in measured.iter_mut().zip(y) {
                let white: f64 = StandardNormal.sample(&mut rng);
                series.push(y + noise * white);
            }
        },
    );
    segment.measured = measured;
    let start = |parameter: usize, _: usize| -> Result<f64, std::convert::Infallible> {
        let fixed = model.parameters[parameter].document.fixed;
        Ok(parameters[parameter] * if fixed { 1.0 } else { off(parameter) })
    };
    let Ok(unknowns) = Unknowns::new(&model, 1, start);
    Problem::new(model, vec![segment], unknowns, options)
}

/// Controls: a train of pulses, different for each. Specific forces and rates: gentle turns and climbs.
fn input(name: &str, channel: usize, t: f64) -> f64 {
    let wave = |frequency: f64, phase: f64| (frequency * t + phase).sin();
    match name {
        "ax" => 0.5 + 0.6 * wave(0.5, 0.3),
        "ay" => 0.4 * wave(0.7, 1.0),
        "az" => -9.8 + 0.8 * wave(0.6, 0.0),
        "p" | "q" | "r" => 0.05 * wave(0.4 + 0.13 * channel as f64, channel as f64),
        _ => {
            let slot = 0.35 + 0.17 * channel as f64;
            let square = wave(std::f64::consts::PI / slot, 0.4 * channel as f64).signum();
            let active = ((t / 2.1) as usize + channel).is_multiple_of(3);
            0.03 * square * f64::from(u8::from(active && t > 0.5))
                + 0.004 * wave(1.1 + channel as f64, 0.0)
        }
    }
}
