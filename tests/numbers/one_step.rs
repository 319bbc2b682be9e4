//! Models that are affine in states and inputs go by a constant matrix for each step; here against the general
//! way, which a segment of listed steps takes even where all of them are equal.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use trimtab_core::model::{Model, ModelDocument, Start, catalog};
use trimtab_core::simulate::{
    Columns, InputInterpolation, Integrator, Outputs, Segment, Sensitivities, Steps,
};

/// Both ways do the same operations in another order: some hundred roundings of 1e-16 a step over 200 steps of
/// motions that do not grow by more than a few powers of ten, relative to the largest value of a column.
const AGREEMENT: f64 = 1e-10;
const STEP: f64 = 0.04;

fn segment(model: &Model, steps: Steps, samples: usize) -> Segment {
    let wave = |channel: usize, k: usize| {
        let t = k as f64 * STEP;
        0.05 * ((1.3 + channel as f64) * t).sin()
            + if (k / 37).is_multiple_of(2) {
                0.03
            } else {
                -0.02
            }
    };
    let series = |count: usize| -> Vec<Vec<f64>> {
        let channel = |c: usize| (0..samples).map(|k| wave(c, k)).collect();
        (0..count).map(channel).collect()
    };
    Segment {
        label: "test".into(),
        time: (0..samples).map(|k| k as f64 * STEP).collect(),
        steps,
        inputs: series(model.inputs.len()),
        measured: series(model.outputs.len()),
    }
}

/// By output: y and ∂y/∂θ, as columns over the samples.
type Columned = Vec<Vec<Vec<f64>>>;

fn run(
    model: &Model,
    segment: &Segment,
    parameters: &[f64],
    (integrator, inputs): (Integrator, InputInterpolation),
) -> Columned {
    let all: Vec<usize> = (0..parameters.len()).collect();
    let columns = Columns::new(model, &all);
    let mut result: Columned = (0..model.outputs.len())
        .map(|output| vec![Vec::new(); 1 + columns.of_output(output).len()])
        .collect();
    Sensitivities::new(model, &columns, integrator, inputs)
        .run(segment, parameters, |block| {
            for (output, columns) in result.iter_mut().enumerate() {
                columns[0].extend_from_slice(block.output(output));
                for k in 0..block.len {
                    for (column, &value) in columns[1..].iter_mut().zip(block.row(output, k)) {
                        column.push(value);
                    }
                }
            }
        })
        .expect("a bounded simulation");
    let mut alone = vec![Vec::new(); model.outputs.len()];
    Outputs::new(model, integrator, inputs)
        .run(segment, parameters, |_, y| {
            alone
                .iter_mut()
                .zip(y)
                .for_each(|(all, y)| all.extend_from_slice(y));
        })
        .expect("a bounded simulation");
    let with_sensitivities: Vec<&Vec<f64>> = result.iter().map(|columns| &columns[0]).collect();
    // to the last bit: the cost of a trial step is compared with that of an iterate
    assert_eq!(alone.iter().collect::<Vec<_>>(), with_sensitivities);
    result
}

fn compare(model: &Model, parameters: &[f64], samples: usize) -> f64 {
    let mut worst: f64 = 0.0;
    for integrator in [Integrator::Euler, Integrator::Rk2, Integrator::Rk4] {
        for inputs in [InputInterpolation::Linear, InputInterpolation::Hold] {
            let even = segment(model, Steps::Even(STEP), samples);
            let listed = segment(model, Steps::Uneven(vec![STEP; samples - 1]), samples);
            let matrix = run(model, &even, parameters, (integrator, inputs));
            let stages = run(model, &listed, parameters, (integrator, inputs));
            for (a, b) in matrix.iter().flatten().zip(stages.iter().flatten()) {
                let largest = b.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                let difference = a
                    .iter()
                    .zip(b)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f64::max);
                assert_eq!((a.len(), b.len()), (samples, samples));
                worst = worst.max(if largest > 0.0 {
                    difference / largest
                } else {
                    difference
                });
            }
        }
    }
    worst
}

fn near_start(model: &Model) -> Vec<f64> {
    let value = |(i, info): (usize, &trimtab_core::model::ParameterInfo)| {
        let start = match info.document.start {
            Start::Value(value) => info.unit.to_si(value),
            Start::FromData(_) if info.name == "V_e" => 130.0,
            Start::FromData(_) => 0.04,
        };
        start * 1.1 + 0.01 * (1.0 + i as f64 / 7.0)
    };
    model.parameters.iter().enumerate().map(value).collect()
}

#[test]
fn agrees_with_the_stages_on_catalog_models() {
    let mut affine = 0;
    for document in catalog::all() {
        let model = Model::compile(&document).expect("a catalog model");
        affine += usize::from(model.is_affine());
        let error = compare(&model, &near_start(&model), 201);
        println!("{:24} relative difference {error:.1e}", document.name);
        assert!(error < AGREEMENT, "{}: {error:e}", document.name);
    }
    assert!(
        affine >= 2,
        "only {affine} models of the catalog are affine"
    );
}

/// Random models with everything that keeps an equation affine: products, quotients and functions of parameters.
#[test]
fn agrees_with_the_stages_on_random_models() {
    let mut random = ChaCha8Rng::seed_from_u64(20);
    for round in 0..60 {
        let (states, inputs, parameters) = (
            random.random_range(1..=8_usize),
            random.random_range(0..=3_usize),
            random.random_range(1..=19_usize),
        );
        let mut text = String::from("name = \"random\"\n");
        (0..inputs).for_each(|i| text += &format!("inputs.u{i} = {{}}\n"));
        (0..parameters).for_each(|i| {
            let unit = if i == 0 { "unit = \"1/s\", " } else { "" };
            text += &format!("parameters.p{i} = {{ {unit}start = 1.0 }}\n");
        });
        let mut coefficient = || {
            let mut p = || format!("p{}", random.random_range(0..parameters));
            let (a, b) = (p(), p());
            let plain = |name: &str| {
                if name == "p0" {
                    "(p0/p0)".to_string()
                } else {
                    name.to_string()
                }
            };
            let (a, b) = (plain(&a), plain(&b));
            let number: f64 = random.random_range(-1.0..1.0);
            match random.random_range(0..6) {
                0 => format!("{number}"),
                1 => format!("{a}*{number}"),
                2 => format!("sin({a})*{b}"),
                3 => format!("{number}/(1 + {a}^2)"),
                4 => format!("if({a} < {b}, {a}, -{b})"),
                _ => "0".to_string(),
            }
        };
        for i in 0..states {
            let mut sum = coefficient();
            (0..states)
                .for_each(|j| sum += &format!(" + ({})*(x{j} - {})", coefficient(), coefficient()));
            (0..inputs).for_each(|j| {
                sum += &format!(" - u{j}*({})/(2 + p{}^2*0)", coefficient(), 1 % parameters)
            });
            if parameters == 1 {
                sum = sum.replace("p0^2", "1");
            }
            text += &format!(
                "states.x{i} = {{ initial = \"{}\", derivative = \"p0*({sum} - x{i})\" }}\n",
                coefficient()
            );
        }
        let all: Vec<String> = (0..states).map(|i| format!("x{i}")).collect();
        text += &format!("outputs.sum = {{ equation = \"{}\" }}\n", all.join(" + "));
        text += &format!(
            "outputs.other = {{ equation = \"x0*x{} + ({})\" }}\n",
            states - 1,
            coefficient()
        );
        let document: ModelDocument = toml::from_str(&text).expect("a document");
        let model =
            Model::compile(&document).unwrap_or_else(|faults| panic!("{text}\n{faults:#?}"));
        assert!(model.is_affine(), "{text}");
        let values: Vec<f64> = (0..parameters)
            .map(|_| random.random_range(0.3..0.9))
            .collect();
        let error = compare(&model, &values, 150);
        assert!(error < AGREEMENT, "round {round}: {error:e}\n{text}");
    }
}

/// Equations that only look affine must not be taken for it.
#[test]
fn what_is_not_affine_is_left_to_the_stages() {
    let cases = [
        ("a*x", true),
        ("a*x*x", false),
        ("a*sin(x)", false),
        ("a*x + a*t*a", false),
        ("a*sign(x)", false),
        ("a*if(x < u, 1, 2)", false),
        ("a*if(x > 0, x, u)", false),
        ("a*max(x, u)", false),
        ("a*x/u", false),
        ("a*u/(1 + 2)", true),
        ("a*abs(u)", false),
    ];
    for (equation, affine) in cases {
        let text = format!(
            "name = \"case\"\ninputs.u = {{}}\nparameters.a = {{ start = 1.0, unit = \"1/s\" }}\n\
             states.x = {{ initial = \"0.1\", derivative = \"{equation}\" }}\noutputs.y = {{ equation = \"x\" }}\n"
        );
        let document: ModelDocument = toml::from_str(&text).expect("a document");
        let model =
            Model::compile(&document).unwrap_or_else(|faults| panic!("{equation}: {faults:#?}"));
        assert_eq!(model.is_affine(), affine, "{equation}");
    }
}
