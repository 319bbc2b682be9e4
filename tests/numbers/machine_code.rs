//! Steps as machine code against the interpreter: the same numbers to the last bit.

use trimtab_core::model::{Model, ModelDocument, Start, catalog};
use trimtab_core::simulate::{
    Columns, InputInterpolation, Integrator, Outputs, Segment, Sensitivities, Steps, Substeps,
    simulate,
};

const SAMPLES: usize = 150;

/// Every function and operator, in the body of f, with angles that are small and large.
const EVERY_FUNCTION: &str = r#"
    name = "every-function"
    [constants]
    T = { value = 1.0, unit = "s" }
    [inputs.u]
    [parameters]
    a = { start = 0.7 }
    b = { start = 1.3 }
    [definitions]
    angles = { equation = "sin(x)*cos(x) + sin(3*y) - cos(u + y) + tan(x - y) + sin(1e7*x) + cos(2e7*x)*sin(2e7*x)" }
    inverse = { equation = "asin(x/9) - acos(y/9) + atan(a*x)/b + atan2(y, x - 2)" }
    growth = { equation = "tanh(x) + exp(-x^2) - ln(2 + y^2) + sqrt(1 + u^2)*abs(y) + (1 + x^2)^(b*y/9)" }
    choice = { equation = "sign(x) + sign(u - u) + min(x, y) - max(u, a) + if(x < y, x, -y) + if(x <= u, a*t/T, b) + if(y, 1, 2) + if(u >= y, y, 3)" }
    sums = { equation = "a - x*y + (b*x - u*y) - (-y)*(x/(3 + y^2)) - x" }
    [states.x]
    initial = "a/9"
    derivative = "(0.1*(angles + inverse) - x)/T"
    [states.y]
    initial = "-0.2"
    derivative = "(0.1*(growth + choice) + 0.01*sums - y)/T"
    [states.z]
    initial = "-0.0"
    derivative = "u/T"
    [states.same]
    initial = "0"
    derivative = "y/T"
    [states.never]
    initial = "-0.0"
    derivative = "-0.0*a/T"
    [outputs]
    x = { equation = "x" }
    y = { equation = "y" }
    z = { equation = "z" }
    same = { equation = "same" }
    never = { equation = "never" }
"#;

/// The state leaves the range of numbers after some time.
const DIVERGING: &str = r#"
    name = "diverging"
    [constants]
    T = { value = 1.0, unit = "s" }
    [inputs.u]
    [parameters]
    a = { start = 3.0 }
    [states.x]
    initial = "1"
    derivative = "(a*x^2 + u)/T"
    [outputs]
    x = { equation = "x" }
"#;

fn segment(model: &Model) -> Segment {
    let wave = |channel: usize, k: usize| {
        let t = k as f64 * 0.04;
        0.05 * ((1.3 + channel as f64) * t).sin()
            + if (k / 37).is_multiple_of(2) {
                0.03
            } else {
                -0.02
            }
    };
    let series = |count: usize| {
        let channel = |c: usize| (0..SAMPLES).map(|k| wave(c, k)).collect();
        (0..count).map(channel).collect()
    };
    let steps: Vec<f64> = (1..SAMPLES)
        .map(|k| 0.04 + 0.001 * (k % 5) as f64)
        .collect();
    let time = |k| steps[..k].iter().sum();
    Segment {
        label: "test".into(),
        time: (0..SAMPLES).map(time).collect(),
        // listed steps: no model goes by a constant matrix
        steps: Steps::Uneven(steps.clone()),
        substeps: Substeps::default(),
        inputs: series(model.inputs.len()),
        measured: series(model.outputs.len()),
    }
}

fn parameters(model: &Model) -> Vec<f64> {
    let value = |info: &trimtab_core::model::ParameterInfo| match info.document.start {
        Start::Value(value) => info.unit.to_si(value) * 1.1,
        Start::FromData(_) if info.document.unit == "m/s" => 130.0,
        Start::FromData(_) => 0.04,
    };
    model.parameters.iter().map(value).collect()
}

type Scheme = (Integrator, InputInterpolation);

/// Bits of all outputs and sensitivities, and where the simulation ends if it does not reach the end.
fn sensitivities(model: &Model, scheme: Scheme) -> (Vec<u64>, Option<usize>) {
    let all: Vec<usize> = (0..model.parameters.len()).collect();
    let columns = Columns::new(model, &all);
    let mut bits = Vec::new();
    let end = Sensitivities::new(model, &columns, scheme.0, scheme.1).run(
        &segment(model),
        &parameters(model),
        |block| {
            for output in 0..model.outputs.len() {
                bits.extend(block.output(output).iter().map(|y| y.to_bits()));
                for k in 0..block.len {
                    bits.extend(block.row(output, k).iter().map(|slope| slope.to_bits()));
                }
            }
        },
    );
    (bits, end.err().map(|diverged| diverged.sample))
}

/// Bits of the outputs, by sample.
fn outputs(model: &Model, scheme: Scheme) -> Vec<u64> {
    let mut bits = vec![0; SAMPLES * model.outputs.len()];
    let mut outputs = Outputs::new(model, scheme.0, scheme.1);
    let run = outputs.run(&segment(model), &parameters(model), |first, series| {
        for (i, series) in series.iter().enumerate() {
            for (k, y) in series.iter().enumerate() {
                bits[(first + k) * model.outputs.len() + i] = y.to_bits();
            }
        }
    });
    run.expect("a bounded simulation");
    bits
}

/// The same by the interpreter.
fn interpreted(model: &Model, scheme: Scheme) -> Vec<u64> {
    let mut bits = Vec::new();
    let sink = |_, y: &[f64]| bits.extend(y.iter().map(|y| y.to_bits()));
    simulate(
        model,
        scheme.0,
        scheme.1,
        &segment(model),
        &parameters(model),
        sink,
    );
    bits
}

fn schemes() -> impl Iterator<Item = Scheme> {
    let integrators = [Integrator::Euler, Integrator::Rk2, Integrator::Rk4];
    let inputs = [InputInterpolation::Linear, InputInterpolation::Hold];
    integrators
        .into_iter()
        .flat_map(move |integrator| inputs.map(|inputs| (integrator, inputs)))
}

fn compile(document: &ModelDocument) -> Model {
    Model::compile(document).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn own(text: &str) -> ModelDocument {
    toml::from_str(text).expect("a document")
}

/// Whether this machine is one that code is made for.
fn is_served() -> bool {
    let served = compile(&own(DIVERGING)).make_native();
    if !served {
        eprintln!("SKIPPED: no machine code on this machine");
    }
    served
}

#[test]
fn machine_code_gives_the_numbers_of_the_interpreter_to_the_last_bit() {
    if !is_served() {
        return;
    }
    let mut documents = catalog::all();
    documents.push(own(EVERY_FUNCTION));
    documents.push(own(include_str!(
        "../bench/flight-path-reconstruction.toml"
    )));
    documents.push(own(include_str!("../bench/hfb320.toml")));
    for document in documents {
        for scheme in schemes() {
            let model = compile(&document);
            assert!(model.make_native(), "{}", document.name);
            let what = format!("{} {scheme:?}", document.name);
            if model.paths.is_empty() {
                assert!(
                    outputs(&model, scheme) == interpreted(&model, scheme),
                    "outputs of {what}"
                );
            }
            // too short a work for the other model to be compiled
            let same = sensitivities(&model, scheme) == sensitivities(&compile(&document), scheme);
            assert!(same, "sensitivities of {what}");
        }
    }
}

#[test]
fn a_simulation_that_diverges_does_so_at_the_same_sample() {
    let scheme = (Integrator::Rk4, InputInterpolation::Linear);
    let model = compile(&own(DIVERGING));
    let (bits, end) = sensitivities(&model, scheme);
    assert!(end.is_some());
    model.make_native();
    assert!(sensitivities(&model, scheme) == (bits, end));
}

#[test]
fn copies_share_the_code_and_may_outlive_the_model() {
    let scheme = (Integrator::Rk4, InputInterpolation::Linear);
    let model = compile(&own(EVERY_FUNCTION));
    let expected = outputs(&model, scheme);
    let served = model.make_native();
    let copies: Vec<Model> = (0..4).map(|_| model.clone()).collect();
    drop(model);
    std::thread::scope(|threads| {
        for copy in &copies {
            threads.spawn(|| {
                assert_eq!(copy.make_native(), served);
                for _ in 0..20 {
                    assert!(outputs(copy, scheme) == expected);
                }
            });
        }
    });
}

#[test]
fn many_steps_are_compiled_on_the_way_and_change_nothing() {
    let scheme = (Integrator::Rk4, InputInterpolation::Linear);
    let model = compile(&own(EVERY_FUNCTION));
    let expected = outputs(&model, scheme);
    let rounds = 4_000_000 / (model.dynamics.operations() * 4 * SAMPLES);
    assert!(rounds > 10);
    std::thread::scope(|threads| {
        for _ in 0..2 {
            threads.spawn(|| {
                for _ in 0..rounds {
                    assert!(outputs(&model, scheme) == expected);
                }
            });
        }
    });
}

/// A state whose derivative has so many terms; none of them is shared.
fn large(terms: usize) -> ModelDocument {
    let definition = |i: usize| {
        let terms =
            (0..50).map(|j| format!("sin(x*{}.5)*exp(x/{}.25)", i * 50 + j, i * 50 + j + 1));
        let sum = terms.collect::<Vec<_>>().join(" + ");
        format!("definitions.d{i} = {{ equation = \"{sum}\" }}\n")
    };
    let count = terms / 50;
    let definitions: String = (0..count).map(definition).collect();
    let sum = (0..count)
        .map(|i| format!("d{i}"))
        .collect::<Vec<_>>()
        .join(" + ");
    own(&format!(
        "name = \"large\"\ninputs.u = {{}}\nparameters.a = {{ start = 1.0 }}\nconstants.T = {{ value = 1.0, unit = \"s\" }}\n{definitions}\
         [states.x]\ninitial = \"0\"\nderivative = \"(1e-6*({sum}) - a*x + u)/T\"\n\
         [outputs]\nx = {{ equation = \"x\" }}"
    ))
}

#[test]
fn very_many_equations_are_left_to_the_interpreter() {
    let scheme = (Integrator::Rk4, InputInterpolation::Linear);
    let model = compile(&large(50));
    assert!((200..500).contains(&model.dynamics.operations()));
    assert_eq!(model.make_native(), is_served());
    assert!(outputs(&model, scheme) == interpreted(&model, scheme));
    let model = compile(&large(600));
    assert!(model.dynamics.operations() > 2_000);
    assert!(!model.make_native());
    assert!(outputs(&model, scheme) == interpreted(&model, scheme));
}
