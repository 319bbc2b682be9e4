//! Forward sensitivities against complex-step differences, on every catalog model.

use num_complex::Complex64;
use trimtab_core::model::{Model, catalog};
use trimtab_core::simulate::{
    Columns, InputInterpolation, Integrator, Segment, Sensitivities, Steps, Substeps, simulate,
};

/// The two differ by rounding alone: the complex step has no truncation error at this size, and
/// both differentiate the discretised model.
const AGREEMENT: f64 = 1e-9;
const COMPLEX_STEP: f64 = 1e-40;

/// A segment in which every input moves, deterministic.
fn segment(model: &Model, samples: usize) -> Segment {
    let step = 0.04;
    let wave = |channel: usize, k: usize| {
        let t = k as f64 * step;
        0.05 * ((1.3 + channel as f64) * t).sin()
            + if (k / 37).is_multiple_of(2) {
                0.03
            } else {
                -0.02
            }
    };
    let series = |count: usize| {
        (0..count)
            .map(|c| (0..samples).map(|k| wave(c, k)).collect())
            .collect()
    };
    Segment {
        label: "test".into(),
        time: (0..samples).map(|k| k as f64 * step).collect(),
        steps: Steps::Even(step),
        substeps: Substeps::default(),
        inputs: series(model.inputs.len()),
        measured: series(model.outputs.len()),
    }
}

/// Values near the start, none of them zero or equal to another.
fn parameters(model: &Model) -> Vec<f64> {
    let value = |(i, info): (usize, &trimtab_core::model::ParameterInfo)| {
        let start = match info.document.start {
            trimtab_core::model::Start::Value(value) => info.unit.to_si(value),
            // a speed, which must not be near zero
            trimtab_core::model::Start::FromData(_) if info.document.unit == "m/s" => 130.0,
            trimtab_core::model::Start::FromData(_) => 0.04,
        };
        start * 1.1 + 0.01 * (1.0 + i as f64 / 7.0)
    };
    model.parameters.iter().enumerate().map(value).collect()
}

/// ∂y/∂θ by output, sample and column, by forward sensitivities.
fn forward(
    model: &Model,
    integrator: Integrator,
    inputs: InputInterpolation,
    segment: &Segment,
) -> Vec<Vec<f64>> {
    let all: Vec<usize> = (0..model.parameters.len()).collect();
    let columns = Columns::new(model, &all);
    let mut rows = vec![vec![0.0; segment.len() * all.len()]; model.outputs.len()];
    let mut machinery = Sensitivities::new(model, &columns, integrator, inputs);
    machinery
        .run(segment, &parameters(model), |block| {
            for (output, rows) in rows.iter_mut().enumerate() {
                for k in 0..block.len {
                    for (&parameter, &value) in
                        columns.of_output(output).iter().zip(block.row(output, k))
                    {
                        rows[(block.first + k) * all.len() + parameter] = value;
                    }
                }
            }
        })
        .expect("a bounded simulation");
    rows
}

fn complex_step(
    model: &Model,
    integrator: Integrator,
    inputs: InputInterpolation,
    segment: &Segment,
) -> Vec<Vec<f64>> {
    let values = parameters(model);
    let mut rows = vec![vec![0.0; segment.len() * values.len()]; model.outputs.len()];
    for parameter in 0..values.len() {
        let mut theta: Vec<Complex64> = values.iter().map(|&v| Complex64::new(v, 0.0)).collect();
        theta[parameter].im = COMPLEX_STEP;
        simulate(model, integrator, inputs, segment, &theta, |k, y| {
            for (rows, y) in rows.iter_mut().zip(y) {
                rows[k * values.len() + parameter] = y.im / COMPLEX_STEP;
            }
        });
    }
    rows
}

/// The largest difference of a column of ∂y/∂θ, relative to the column.
fn worst(model: &Model, a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let count = model.parameters.len();
    let mut worst: f64 = 0.0;
    for (a, b) in a.iter().zip(b) {
        for parameter in 0..count {
            let column = |rows: &[f64]| -> Vec<f64> {
                rows.iter()
                    .skip(parameter)
                    .step_by(count)
                    .copied()
                    .collect()
            };
            let (a, b) = (column(a), column(b));
            assert!(
                a.iter().chain(&b).all(|value| value.is_finite()),
                "{}",
                model.document.name
            );
            let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let difference: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
            // a column of zeros must be one in both
            let error = if norm(&b) > 0.0 {
                norm(&difference) / norm(&b)
            } else {
                norm(&a)
            };
            worst = worst.max(error);
        }
    }
    worst
}

#[test]
fn agree_with_complex_steps_on_every_catalog_model() {
    for document in catalog::all() {
        let model = Model::compile(&document).expect("a catalog model");
        // 201 samples: more than one block, and a last block that is not full
        let segment = segment(&model, 201);
        for integrator in [Integrator::Euler, Integrator::Rk2, Integrator::Rk4] {
            for inputs in [InputInterpolation::Linear, InputInterpolation::Hold] {
                let ours = forward(&model, integrator, inputs, &segment);
                let theirs = complex_step(&model, integrator, inputs, &segment);
                assert!(theirs.iter().flatten().any(|&v| v != 0.0));
                let error = worst(&model, &ours, &theirs);
                println!(
                    "{:24} {integrator:?} {inputs:?}: relative error {error:.1e}",
                    document.name
                );
                assert!(error < AGREEMENT, "{}: {error:e}", document.name);
            }
        }
    }
}

#[test]
fn agree_on_functions_and_uneven_steps() {
    let text = r#"
        name = "everything"
        inputs.u = {}
        parameters.a = { start = 0.7 }
        parameters.b = { start = 1.3 }
        parameters.c = { start = 0.2 }
        parameters.d = { start = 0.4 }
        parameters.rate = { start = 0.9, unit = "1/s" }
        definitions.w = { equation = "tanh(a*x) + atan2(x + 2, b) + sqrt(1 + x^2)*c + abs(x - 0.1)*d" }
        definitions.v = { equation = "if(x < u, a*x^3, b*x) + exp(-x)*ln(2 + a) + (1 + a^2)^b + min(x, c) + max(x*a, d)" }
        states.x = { initial = "c + d^2", derivative = "rate*(-a*x + b*sin(u) + c*cos(x)*w + d*tan(0.1*x)*t*rate/10)" }
        outputs.y = { equation = "w + v*asin(0.3*tanh(x)) + acos(0.2*c) + atan(x)*sign(a)" }
    "#;
    let document = toml::from_str(text).expect("a document");
    let model = Model::compile(&document).unwrap_or_else(|faults| panic!("{faults:#?}"));
    let mut segment = segment(&model, 130);
    segment.steps = Steps::Uneven((0..129).map(|k| 0.02 + 0.01 * f64::from(k % 5)).collect());
    let ours = forward(
        &model,
        Integrator::Rk4,
        InputInterpolation::Linear,
        &segment,
    );
    let theirs = complex_step(
        &model,
        Integrator::Rk4,
        InputInterpolation::Linear,
        &segment,
    );
    let error = worst(&model, &ours, &theirs);
    println!("every function: relative error {error:.1e}");
    assert!(error < AGREEMENT, "{error:e}");
}
