//! Machado 2022, algorithm 3, line by line: the reverse mode of the Euler scheme with R given.
//!
//! As printed, line 25 *sets* the adjoint state to what the output gives, where it has to be *added* to what came
//! back from later samples (line 21). So each output reaches one step back and no further.

use trimtab_core::estimate::Problem;
use trimtab_core::model::Jacobian;
use trimtab_core::simulate::Steps;

/// Line 25 as it is printed, or as the chain rule has it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Line25 {
    AsPrinted,
    Added,
}

/// Entries of a Jacobian at one sample, by (row, column): by state, by parameter.
type Entries = (Vec<(usize, usize, f64)>, Vec<(usize, usize, f64)>);

/// Cost (without its constant) and gradient by parameter of the model, SI; one segment, even steps, `inverse` the
/// diagonal of R⁻¹.
pub(crate) fn algorithm_3(
    problem: &Problem,
    theta: &[f64],
    inverse: &[f64],
    line_25: Line25,
) -> (f64, Vec<f64>) {
    let (model, segment) = (&problem.model, &problem.segments[0]);
    let Steps::Even(step) = segment.steps else {
        panic!("even steps")
    };
    let mut parameters = Vec::new();
    problem.unknowns.parameters(0, theta, &mut parameters);
    let run = |program: &trimtab_core::model::Program, k: usize, state: &[f64]| -> Vec<f64> {
        let mut workspace = program.workspace::<f64>();
        program.set_parameters(&mut workspace, &parameters);
        program.states(&mut workspace).copy_from_slice(state);
        for (to, samples) in program
            .inputs(&mut workspace)
            .iter_mut()
            .zip(&segment.inputs)
        {
            *to = samples[k];
        }
        *program.time(&mut workspace) = k as f64 * step;
        program.run(&mut workspace);
        let mut results = vec![0.0; program.len()];
        program.results(&workspace, &mut results);
        results
    };
    let entries = |jacobian: &Jacobian, k: usize, state: &[f64]| -> Entries {
        let values = run(&jacobian.program, k, state);
        let (by_state, by_parameter) = values.split_at(jacobian.by_state.len());
        let place = |((row, column), value): (&(usize, usize), &f64)| (*row, *column, *value);
        (
            jacobian.by_state.iter().zip(by_state).map(place).collect(),
            jacobian
                .by_parameter
                .iter()
                .zip(by_parameter)
                .map(place)
                .collect(),
        )
    };
    // lines 1 to 12
    let last = segment.len() - 1;
    let mut states = vec![run(&model.initial, 0, &vec![0.0; model.states.len()])];
    let (mut cost, mut errors) = (0.0, Vec::new());
    for k in 0..=last {
        let y = run(&model.observation, k, &states[k]);
        let e: Vec<f64> = (0..y.len())
            .map(|i| segment.measured[i][k] - y[i])
            .collect();
        cost += 0.5 * e.iter().zip(inverse).map(|(e, r)| e * e * r).sum::<f64>();
        errors.push(e);
        if k < last {
            let f = run(&model.dynamics, k, &states[k]);
            states.push(
                states[k]
                    .iter()
                    .zip(&f)
                    .map(|(x, f)| x + step * f)
                    .collect(),
            );
        }
    }
    // lines 13 to 29
    let mut gradient = vec![0.0; parameters.len()];
    let mut x_bar = vec![0.0; model.states.len()];
    for k in (0..=last).rev() {
        if k < last {
            let f_bar: Vec<f64> = x_bar.iter().map(|x| step * x).collect();
            let (by_state, by_parameter) = entries(&model.dynamics_jacobian, k, &states[k]);
            by_state
                .iter()
                .for_each(|&(row, column, value)| x_bar[column] += value * f_bar[row]);
            by_parameter
                .iter()
                .for_each(|&(row, p, value)| gradient[p] += value * f_bar[row]);
        }
        let y_bar: Vec<f64> = errors[k].iter().zip(inverse).map(|(e, r)| -e * r).collect();
        let (by_state, by_parameter) = entries(&model.observation_jacobian, k, &states[k]);
        if line_25 == Line25::AsPrinted {
            x_bar.fill(0.0);
        }
        by_state
            .iter()
            .for_each(|&(row, column, value)| x_bar[column] += value * y_bar[row]);
        by_parameter
            .iter()
            .for_each(|&(row, p, value)| gradient[p] += value * y_bar[row]);
    }
    // the printed algorithm takes the initial state for known; here it may depend on θ
    let initial = &model.initial_jacobian;
    let (_, by_parameter) = entries(initial, 0, &states[0]);
    by_parameter
        .iter()
        .for_each(|&(row, p, value)| gradient[p] += value * x_bar[row]);
    (cost, gradient)
}
