//! The derivative study on four problems, and why an adjoint run once took thousands of iterations.
//!
//! `cargo bench --bench derivative_study [-- PROBLEM ...]` prints the cost of one gradient for all problems, then
//! the tables of those named (all without a name; `none` for none), and writes two figures for each to
//! `target/derivative-study`.

#[path = "../common"]
mod common {
    pub(crate) mod printed_adjoint;
    pub(crate) mod study_problems;
}

use std::cell::Cell;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use common::printed_adjoint::{Line25, algorithm_3};
use common::study_problems;
use nalgebra::{DMatrix, DVector};
use trimtab::cli::study_tables;
use trimtab::dashboard::{cost_figure, error_figure};
use trimtab::estimate::derivatives::CostAndGradient;
use trimtab::estimate::quasi_newton::{Optimiser, Update};
use trimtab::estimate::study::{operations, study};
use trimtab::estimate::{
    Derivatives, Evaluator, Noise, NormalEquations, Options, Problem, output_error,
};
use trimtab::model::catalog;
use trimtab::simulate::Integrator;
use trimtab::work::ThreadClock;

/// Góes, Hemerly, Maciel eq. 18-23: nine states, position biases held since initial positions say the same.
fn flight_path() -> Problem {
    let document = catalog::find("flight-path-reconstruction").expect("a catalog model");
    let truth = |name: &str| match name {
        "K_V" => 1.02,
        "W_x" => 4.0,
        "W_y" => -3.0,
        "W_z" => 0.5,
        "x_bias" | "y_bias" | "z_bias" => 0.0,
        "u_0" => 100.0,
        "v_0" => 1.0,
        "w_0" => 5.0,
        "psi_0" => 0.5,
        "z_0" => -1000.0,
        "ax_bias" | "ay_bias" | "az_bias" => 0.02,
        "p_bias" | "q_bias" | "r_bias" => 5e-4,
        _ => 0.01,
    };
    study_problems::made(
        &document,
        truth,
        |i| 0.97 + 0.002 * i as f64,
        0.02,
        2e-2,
        Options::default(),
    )
}

fn compare(name: &str, problem: &Problem, directory: &Path) {
    println!("\n== {name}");
    let found = study(problem, &ThreadClock::start(), &mut |step| {
        if let Some(step) = step {
            eprintln!("{name} {}/{}: {}", step.number, step.of, step.finding);
        }
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|why| panic!("{name}: {why:?}"));
    println!("{}", study_tables(&found));
    for (what, svg) in [
        ("error", error_figure(&found.error_curves)),
        ("cost", cost_figure(&found.costs)),
    ] {
        let path = directory.join(format!("{name}-{what}.svg"));
        std::fs::write(&path, svg.expect("a figure")).expect("a directory to write to");
    }
}

/// Algorithm 3 as printed and as the chain rule has it, with the optimisers that live on a gradient: Euler's scheme and
/// R given, as there.
fn printed(name: &str, problem: Problem) {
    let problem = euler(problem);
    let Noise::Given { variance } = &problem.options.noise else {
        unreachable!("given above")
    };
    let inverse: Vec<f64> = variance.iter().map(|v| v.recip()).collect();
    let mut lowest = f64::INFINITY;
    output_error(&problem, &mut |iteration| {
        lowest = lowest.min(iteration.cost);
        ControlFlow::Continue(())
    })
    .expect("an estimate");
    let theta = problem.unknowns.start();
    let constant = {
        let (own, _) = algorithm_3(&problem, &theta, &inverse, Line25::Added);
        CostAndGradient::new(&problem).at(&theta).expect("a cost").0 - own
    };
    let n = theta.len();
    for (update, line_25) in [
        (Update::Bfgs, Line25::Added),
        (Update::Bfgs, Line25::AsPrinted),
        (Update::None, Line25::Added),
        (Update::None, Line25::AsPrinted),
    ] {
        let gradients = Cell::new(0);
        let mut evaluate = |theta: &[f64]| {
            gradients.set(gradients.get() + 1);
            let (cost, by_parameter) = algorithm_3(&problem, theta, &inverse, line_25);
            let parameter = |place: usize| problem.unknowns.at(place).parameter;
            let gradient = DVector::from_fn(n, |place, _| by_parameter[parameter(place)]);
            (cost + constant)
                .is_finite()
                .then_some((cost + constant, gradient))
        };
        let (cost, gradient) = evaluate(&theta).expect("a cost");
        let (_, exact) = CostAndGradient::new(&problem)
            .at(&theta)
            .expect("a gradient");
        let cosine = gradient.dot(&exact) / (gradient.norm() * exact.norm());
        let open = (vec![f64::NEG_INFINITY; n], vec![f64::INFINITY; n]);
        let start = (theta.clone(), cost, gradient);
        let mut descent = Optimiser::new(start, open, DMatrix::identity(n, n), true, update);
        let mut iterations = 0;
        while gradients.get() < MOST_GRADIENTS && descent.cost > lowest + 0.5e-4 {
            if descent.step(&mut evaluate).is_err() {
                break;
            }
            iterations += 1;
        }
        println!(
            "{name:14} {line_25:?} {update:?}: cosine to the gradient {cosine:.3}, {iterations} iterations, {} gradients, {:.1e} above the minimum",
            gradients.get(),
            descent.cost - lowest
        );
    }
}

/// Gradients after which a descent is given up.
const MOST_GRADIENTS: usize = 1000;

fn euler(mut problem: Problem) -> Problem {
    let outputs = problem.model.outputs.len();
    problem.options = Options {
        integrator: Integrator::Euler,
        noise: Noise::Given {
            variance: vec![1e-6; outputs],
        },
        ..problem.options
    };
    problem
}

/// One gradient: direct with the information matrix that comes with it, and by the adjoint.
fn glance(name: &str, problem: &Problem) {
    let theta = problem.unknowns.start();
    let mut evaluator = Evaluator::new(problem);
    let direct = least(|| drop(NormalEquations::at(&mut evaluator, &theta).expect("a cost")));
    let adjoint = least(|| drop(CostAndGradient::new(problem).at(&theta).expect("a cost")));
    let counted = |technique| operations(problem, &technique) as f64;
    let ratio = counted(Derivatives::default()) / counted(Derivatives::adjoint());
    println!(
        "{name:18} n_x {:2} n_y {:2} n_theta {:3}: operations direct/adjoint {ratio:5.2}; direct with information matrix {direct:8.3} ms, adjoint {adjoint:7.3} ms, ratio {:.2}",
        problem.model.states.len(),
        problem.model.outputs.len(),
        problem.unknowns.len(),
        direct / adjoint
    );
}

/// Least wall time of some calls, ms.
fn least(mut call: impl FnMut()) -> f64 {
    let time = |_| {
        let began = Instant::now();
        call();
        began.elapsed().as_secs_f64() * 1e3
    };
    (0..20).map(time).fold(f64::INFINITY, f64::min)
}

fn main() {
    let named: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with("--"))
        .collect();
    let wanted = |name: &str| named.is_empty() || named.iter().any(|own| own == name);
    let directory = Path::new("target/derivative-study");
    std::fs::create_dir_all(directory).expect("a directory to write to");
    let problems = [
        ("short-period", study_problems::short_period()),
        ("lateral", study_problems::lateral()),
        ("flight-path", flight_path()),
        ("flexible-aircraft", study_problems::flexible_aircraft()),
    ];
    for (name, problem) in &problems {
        glance(name, problem);
    }
    if wanted("printed") {
        println!("\n== algorithm 3 as printed, and with line 25 adding");
        printed("short-period", study_problems::short_period());
        printed("lateral", study_problems::lateral());
    }
    for (name, problem) in problems.iter().filter(|(name, _)| wanted(name)) {
        compare(name, problem, directory);
    }
}
