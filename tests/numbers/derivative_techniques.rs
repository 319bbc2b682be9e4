//! All derivative techniques give the same gradient, each to its own accuracy, on every catalog model.

use std::ops::ControlFlow;

use crate::common::printed_adjoint::{Line25, algorithm_3};
use crate::common::study_problems;
use nalgebra::{DMatrix, DVector};
use trimtab_core::estimate::derivatives::CostAndGradient;
use trimtab_core::estimate::study;
use trimtab_core::estimate::{
    Derivatives, Evaluator, Noise, NoiseStructure, NormalEquations, Options, Problem, Unknowns,
    output_error,
};
use trimtab_core::model::{Model, Start, catalog};
use trimtab_core::simulate::{InputInterpolation, Integrator, Segment, Steps, Substeps, simulate};

/// A segment in which every input moves, deterministic; what is measured is still to be made.
fn segment(model: &Model, samples: usize, uneven: bool) -> Segment {
    let step = 0.04;
    let wave = |channel: usize, k: usize| {
        let pulse = if (k / 37).is_multiple_of(2) {
            0.03
        } else {
            -0.02
        };
        0.05 * ((1.3 + channel as f64) * k as f64 * step).sin() + pulse
    };
    let inputs = |channel| (0..samples).map(|k| wave(channel, k)).collect();
    let length = |k: usize| step * (1.0 + 0.3 * (k % 5) as f64);
    Segment {
        label: "1".into(),
        time: (0..samples).map(|k| k as f64 * step).collect(),
        substeps: Substeps::default(),
        steps: if uneven {
            Steps::Uneven((0..samples - 1).map(length).collect())
        } else {
            Steps::Even(step)
        },
        inputs: (0..model.inputs.len()).map(inputs).collect(),
        measured: Vec::new(),
    }
}

/// A problem whose data are the model's own for other parameters, with something added that no model makes.
fn problem(model: &Model, options: Options, samples: usize, uneven: bool) -> Problem {
    let mut segment = segment(model, samples, uneven);
    let start = |parameter: usize, _: usize| {
        let info = &model.parameters[parameter];
        let start = match info.document.start {
            Start::Value(value) => info.unit.to_si(value),
            // a speed, which must not be near zero
            Start::FromData(_) if info.document.unit == "m/s" => 130.0,
            Start::FromData(_) => 0.04,
        };
        Ok::<_, std::convert::Infallible>(start * 1.1 + 0.01 * (1.0 + parameter as f64 / 7.0))
    };
    let Ok(unknowns) = Unknowns::new(model, 1, start);
    let (mut parameters, mut measured) = (Vec::new(), vec![Vec::new(); model.outputs.len()]);
    unknowns.parameters(0, &unknowns.start(), &mut parameters);
    let truth: Vec<f64> = parameters.iter().map(|value| value * 1.02).collect();
    let (integrator, interpolation) = (options.integrator, options.input_interpolation);
    simulate(
        model,
        integrator,
        interpolation,
        &segment,
        &truth,
        |k, y| {
            for (i, (series, y)) in measured.iter_mut().zip(y).enumerate() {
                series.push(y + 1e-3 * ((0.7 + 0.13 * i as f64) * k as f64 + i as f64).sin());
            }
        },
    );
    segment.measured = measured;
    Problem::new(model.clone(), vec![segment], unknowns, options)
}

fn gradient(problem: &Problem, derivatives: Derivatives) -> DVector<f64> {
    let mut problem = problem.clone();
    problem.options.derivatives = derivatives;
    let theta = problem.unknowns.start();
    if let Derivatives::Adjoint { .. } = derivatives {
        let (_, gradient) = CostAndGradient::new(&problem)
            .at(&theta)
            .expect("a gradient");
        return gradient;
    }
    -NormalEquations::at(&mut Evaluator::new(&problem), &theta)
        .expect("a gradient")
        .descent
}

/// Error relative to the gradient, each component times what its parameter's standard error would be alone.
fn error(problem: &Problem, found: &DVector<f64>) -> f64 {
    let theta = problem.unknowns.start();
    let exact = NormalEquations::at(&mut Evaluator::new(problem), &theta).expect("a gradient");
    let scale = exact.information.diagonal().map(|f| f.sqrt().recip());
    let (size, error) = (exact.descent.component_mul(&scale), found + &exact.descent);
    assert!(size.norm() > 1.0, "there is no gradient to compare");
    error.component_mul(&scale).norm() / size.norm()
}

fn models() -> impl Iterator<Item = Model> {
    catalog::all()
        .into_iter()
        .map(|document| Model::compile(&document).expect("a model"))
}

/// Rounding, ε = 2.2e-16, is amplified by what cancels in Σ Sᵀ R⁻¹ e: the sum is here down to some hundredths of
/// its terms, and samples are some hundreds. A factor of a thousand covers it, and still leaves no room for a
/// wrong term.
const ROUNDING: f64 = 1e3 * f64::EPSILON;

/// Outputs at the start, less what was measured, and the outputs' own root mean squares.
fn residuals(problem: &Problem) -> (DMatrix<f64>, Vec<f64>) {
    let mut parameters = Vec::new();
    (problem.unknowns).parameters(0, &problem.unknowns.start(), &mut parameters);
    let segment = &problem.segments[0];
    let outputs = problem.model.outputs.len();
    let mut residuals = DMatrix::zeros(segment.len(), outputs);
    let mut squares = vec![0.0; outputs];
    simulate(
        &problem.model,
        problem.options.integrator,
        problem.options.input_interpolation,
        segment,
        &parameters,
        |k, y: &[f64]| {
            for (i, &y) in y.iter().enumerate() {
                squares[i] += y * y;
                residuals[(k, i)] = segment.measured[i][k] - y;
            }
        },
    );
    let samples = segment.len() as f64;
    let sizes = squares.iter().map(|sum| (sum / samples).sqrt());
    (residuals, sizes.collect())
}

/// What rounding may make of a gradient: outputs are rounded as what they are, and weighed as what they are off.
/// A speed of 130 m/s that is off by some metres loses by that ratio, sensitivities that are off by as much too.
/// R⁻¹ of correlated residuals loses by the condition of their correlation.
fn rounding(problem: &Problem) -> f64 {
    let (residuals, sizes) = residuals(problem);
    let off: Vec<f64> = (residuals.column_iter())
        .map(|e| e.norm() / (e.len() as f64).sqrt())
        .collect();
    let ratios = sizes.iter().zip(&off).map(|(size, off)| size / off);
    let condition = if problem.options.noise.is_full() {
        let scale = DMatrix::from_diagonal(&DVector::from_iterator(
            off.len(),
            off.iter().map(|off| off.recip()),
        ));
        let values = (residuals * scale).singular_values();
        (values.max() / values.min()).powi(2)
    } else {
        1.0
    };
    ROUNDING * condition * ratios.fold(1.0, f64::max)
}

/// Differences have the order of their theory: the error falls with the step, or with its square, where the cut-off
/// series outweighs rounding; steps are relative.
fn has_its_order(problem: &Problem, of: fn(f64) -> Derivatives, order: i32, steps: [f64; 2]) {
    let name = &problem.model.document.name;
    let [coarse, fine] = steps.map(|step| error(problem, &gradient(problem, of(step))));
    let (fall, expected) = (coarse / fine, (steps[0] / steps[1]).powi(order));
    let technique = of(1.0).name();
    println!("{name:36} {technique:20} {coarse:.1e} {fine:.1e}");
    // the next term of the series is some tenths of the first at the coarse step
    assert!(
        (0.5 * expected..2.0 * expected).contains(&fall),
        "{name} {technique}: {coarse:.1e} falls to {fine:.1e}"
    );
}

fn differences_have_their_orders(problem: &Problem) {
    let forward = |step| Derivatives::ForwardDifference { step };
    let central = |step| Derivatives::CentralDifference { step };
    has_its_order(problem, forward, 1, [1e-3, 1e-4]);
    has_its_order(problem, central, 2, [1e-2, 1e-3]);
}

fn exact() -> [Derivatives; 2] {
    let complex = Derivatives::ComplexStep { step: 1e-20 };
    [complex, Derivatives::adjoint()]
}

#[test]
fn every_technique_on_every_model() {
    for model in models() {
        let problem = problem(&model, Options::default(), 300, false);
        let name = &model.document.name;
        for technique in exact() {
            let error = error(&problem, &gradient(&problem, technique));
            println!("{name:36} {:20} {error:.1e}", technique.name());
            let most = rounding(&problem);
            assert!(
                error <= most,
                "{name} {}: {error:.1e} {most:.1e}",
                technique.name()
            );
        }
        differences_have_their_orders(&problem);
    }
}

/// With the usual steps, √ε and ε^(2/3) of each parameter, where outputs are about as large as what they are off:
/// truncation and rounding are then balanced. Measured are factors up to 12; 50 are allowed.
#[test]
fn the_usual_steps_are_as_good_as_differences_get() {
    for name in [
        "short-period",
        "lateral-directional-2",
        "lateral-directional-4",
    ] {
        let model = Model::compile(&catalog::find(name).expect("in the catalog")).expect("a model");
        let problem = problem(&model, Options::default(), 300, false);
        for (technique, best) in [
            (Derivatives::all()[0], f64::EPSILON.sqrt()),
            (Derivatives::all()[1], f64::EPSILON.powf(2.0 / 3.0)),
        ] {
            let error = error(&problem, &gradient(&problem, technique));
            assert!(
                error <= 50.0 * best,
                "{name} {}: {error:.1e}",
                technique.name()
            );
        }
    }
}

#[test]
fn the_adjoint_of_every_scheme() {
    for model in models() {
        for integrator in [Integrator::Euler, Integrator::Rk2, Integrator::Rk4] {
            for input_interpolation in [InputInterpolation::Linear, InputInterpolation::Hold] {
                // 64 samples are a block: less than one, whole ones, one sample more, uneven steps
                for (samples, uneven) in [(40, false), (128, true), (193, false)] {
                    let options = Options {
                        integrator,
                        input_interpolation,
                        ..Options::default()
                    };
                    let problem = problem(&model, options, samples, uneven);
                    let error = error(&problem, &gradient(&problem, Derivatives::adjoint()));
                    let most = rounding(&problem);
                    assert!(error <= most, "{integrator:?} {samples}: {error:.1e}");
                }
            }
        }
    }
}

#[test]
fn correlated_and_given_noise() {
    for model in models() {
        let full = Noise::Estimated {
            structure: NoiseStructure::Full,
        };
        let given = Noise::Given {
            variance: (0..model.outputs.len())
                .map(|i| 1e-4 * (1.0 + i as f64))
                .collect(),
        };
        for noise in [full, given] {
            let options = Options {
                noise,
                ..Options::default()
            };
            let problem = problem(&model, options, 200, false);
            for technique in exact() {
                let error = error(&problem, &gradient(&problem, technique));
                let most = rounding(&problem);
                let name = &problem.model.document.name;
                println!(
                    "{name:36} {:20} {error:.1e} of {most:.1e}",
                    technique.name()
                );
                assert!(error <= most, "{name} {}: {error:.1e}", technique.name());
            }
            // rounding, amplified by the condition of R, hides the order where outputs are nearly dependent
            if !problem.options.noise.is_full() {
                differences_have_their_orders(&problem);
            }
        }
    }
}

#[test]
fn the_complex_step_may_be_as_small_as_numbers_go() {
    for model in models() {
        let problem = problem(&model, Options::default(), 200, false);
        for step in [1e-8, 1e-20, 1e-100, 1e-200, 1e-300] {
            let error = error(
                &problem,
                &gradient(&problem, Derivatives::ComplexStep { step }),
            );
            // below 1e-308 numbers lose digits: of 1e-300, slopes of 1e-4 and less do
            let most = if step < 1e-299 {
                1e-9
            } else {
                rounding(&problem)
            };
            assert!(
                error <= most,
                "{} {step:e}: {error:.1e}",
                model.document.name
            );
        }
    }
}

#[test]
fn every_technique_finds_the_same_estimate() {
    let document = catalog::find("short-period").expect("in the catalog");
    let model = Model::compile(&document).expect("a model");
    let mut costs = Vec::new();
    for derivatives in Derivatives::all() {
        let mut problem = problem(&model, Options::default(), 300, false);
        problem.options.derivatives = derivatives;
        let solution = output_error(&problem, &mut |_| ControlFlow::Continue(()));
        let estimate = solution.expect("an estimate").estimate;
        println!(
            "{:24} {:3} {}",
            derivatives.name(),
            estimate.iterations,
            estimate.reason
        );
        assert!(
            estimate.outcome.is_minimum(),
            "{}: {}",
            derivatives.name(),
            estimate.reason
        );
        assert!(
            estimate
                .parameters
                .iter()
                .all(|p| p.fixed || p.standard_error.is_some())
        );
        costs.push(estimate.cost);
    }
    let (least, most) = (
        costs.iter().copied().fold(f64::MAX, f64::min),
        costs.iter().copied().fold(f64::MIN, f64::max),
    );
    // each stops 1e-5 standard errors from the minimum: half the square of that above it, and rounding of a
    // cost of some thousands
    assert!(most - least < 1e-9, "{costs:?}");
}

/// Machado 2022, table 12: 7 inputs, 42 outputs, 20 states, 210 parameters.
#[test]
fn a_problem_as_large_as_a_flexible_aircraft() {
    let problem = study_problems::flexible_aircraft();
    let model = &problem.model;
    let size = (model.inputs.len(), model.outputs.len(), model.states.len());
    assert_eq!((size, problem.unknowns.len()), ((7, 42, 20), 210));
    let error = error(&problem, &gradient(&problem, Derivatives::adjoint()));
    assert!(error <= ROUNDING, "{error:.1e}");
    let (direct, adjoint) = (Derivatives::default(), Derivatives::adjoint());
    let counted = |technique| study::operations(&problem, technique) as f64;
    let ratio = counted(&direct) / counted(&adjoint);
    println!("a direct gradient takes {ratio:.1} times the operations of an adjoint one");
    assert!(ratio > 10.0, "{ratio}");
}

/// Machado's algorithm 3 is the adjoint where line 25 adds; as printed it forgets what comes back from later samples.
#[test]
fn the_printed_reverse_mode_lacks_a_sum() {
    for problem in [study_problems::short_period(), study_problems::lateral()] {
        let mut problem = problem;
        let variance = vec![1e-6_f64; problem.model.outputs.len()];
        let inverse: Vec<f64> = variance.iter().map(|v| v.recip()).collect();
        problem.options.noise = Noise::Given { variance };
        problem.options.integrator = Integrator::Euler;
        let theta = problem.unknowns.start();
        let by_place = |line_25| {
            let (_, by_parameter) = algorithm_3(&problem, &theta, &inverse, line_25);
            let parameter = |place: usize| problem.unknowns.at(place).parameter;
            DVector::from_fn(theta.len(), |place, _| by_parameter[parameter(place)])
        };
        let added = error(&problem, &by_place(Line25::Added));
        assert!(added <= ROUNDING, "{added:.1e}");
        let printed = error(&problem, &by_place(Line25::AsPrinted));
        println!(
            "{}: error {printed:.2} as printed",
            problem.model.document.name
        );
        assert!(printed > 0.1, "{printed}");
    }
}
