//! The cost of a gradient in operations and memory: by formula, and counted on the compiled model.

use super::report::{FormulaOperations, ProblemSize};
use crate::estimate::evaluation::derivatives::perturbation::STRETCH;
use crate::estimate::options::technique::Derivatives;
use crate::estimate::problem::Problem;
use crate::simulate::{March, Segment};

/// Operations on real numbers that one on complex numbers takes: two for a sum, six for a product.
const COMPLEX: u64 = 4;

/// Machado 2022, table 11: multiplications and additions of algorithms 2 and 3, Euler scheme, full matrices.
pub fn formula(size: &ProblemSize) -> FormulaOperations {
    let of = |n: usize| n as i64;
    let (n, nx, ny, nt) = (
        of(size.samples),
        of(size.states),
        of(size.outputs),
        of(size.unknowns),
    );
    let direct_output = ny * (nt * (nx + 2) + 2 * ny + 1);
    let direct_multiplications =
        n * (direct_output + nt * nx * (2 * nx + 1) + nx * (nx + 1) + 1) + direct_output + 1;
    let direct_additions = n * (2 * ny * ny + 2 * nx + nt * (nx * (2 * nx + ny - 2) + ny) + 1)
        + ny * (nt * nx + nt + 2 * ny);
    let reverse_multiplications = n * (ny * (nt + 2 * ny + 3) + nx * (nt + nx + ny + 1) + 1)
        + ny * (nt + nx + 2 * ny + 3)
        + 1;
    let reverse_additions =
        n * (2 * ny * ny + nt * ny + nx * (nt + nx + ny) + 1) + 2 * ny * ny + (ny - 1) * (nt + nx);
    FormulaOperations {
        direct_multiplications: direct_multiplications as u64,
        direct_additions: direct_additions as u64,
        reverse_multiplications: reverse_multiplications as u64,
        reverse_additions: reverse_additions as u64,
    }
}

/// Structure of a compiled problem that costs follow from.
struct Counts {
    samples: u64,
    stages: u64,
    states: u64,
    outputs: u64,
    unknowns: u64,
    /// Free parameters behind ∂x/∂θ.
    dynamic: u64,
    /// Entries of ∂f/∂x, ∂g/∂x, and of ∂f/∂θ, ∂g/∂θ.
    by_state: [u64; 2],
    by_parameter: [u64; 2],
    /// Entries of rows of ∂y/∂θ.
    row_entries: u64,
    /// One simulated sample.
    sample: u64,
    /// Jacobians of one sample.
    jacobians: u64,
}

impl Counts {
    fn of(problem: &Problem) -> Self {
        let model = &problem.model;
        let count = |n: usize| n as u64;
        let stages = count(problem.options.integrator.stage_count());
        let states = count(model.states.len());
        let (f, g) = (&model.dynamics_jacobian, &model.observation_jacobian);
        let is_free = |p: usize| {
            let own =
                |u: &&crate::estimate::problem::unknowns::Unknown| u.parameter == p && !u.fixed;
            problem.unknowns.all.iter().any(|u| own(&u))
        };
        let moves_states = |p: &usize| {
            let mut entries = f
                .by_parameter
                .iter()
                .chain(&model.initial_jacobian.by_parameter);
            is_free(*p) && entries.any(|&(_, column)| column == *p)
        };
        let row_entries = (0..model.outputs.len()).map(|i| problem.columns.of_output(i).len());
        // two operations a stage and state for the stage's state, two for the sum
        let step = stages * (count(model.dynamics.operations()) + 4 * states) + states;
        Self {
            samples: count(problem.samples()),
            stages,
            states,
            outputs: count(model.outputs.len()),
            unknowns: count(problem.unknowns.len()),
            dynamic: count((0..model.parameters.len()).filter(moves_states).count()),
            by_state: [count(f.by_state.len()), count(g.by_state.len())],
            by_parameter: [count(f.by_parameter.len()), count(g.by_parameter.len())],
            row_entries: count(row_entries.sum()),
            sample: step + count(model.observation.operations()),
            jacobians: stages * count(f.program.operations()) + count(g.program.operations()),
        }
    }
}

/// Simulations that one gradient takes.
pub fn simulations(problem: &Problem, technique: &Derivatives) -> usize {
    let unknowns = problem.unknowns.len();
    match technique {
        Derivatives::ForwardDifference { .. } | Derivatives::ComplexStep { .. } => unknowns + 1,
        Derivatives::CentralDifference { .. } => 2 * unknowns + 1,
        Derivatives::ForwardSensitivities {} => 1,
        // the way back simulates once more, from checkpoints
        Derivatives::Adjoint { .. } => 2,
    }
}

/// Operations that one gradient takes.
pub fn operations(problem: &Problem, technique: &Derivatives) -> u64 {
    let n = Counts::of(problem);
    // S and then Σ Sᵀ R⁻¹ e
    let slopes_to_gradient = 2 * n.row_entries + 2 * n.outputs;
    let per_sample = match technique {
        Derivatives::ForwardDifference { .. } => {
            (n.unknowns + 1) * n.sample + 2 * n.unknowns * n.outputs + slopes_to_gradient
        }
        Derivatives::CentralDifference { .. } => {
            (2 * n.unknowns + 1) * n.sample + 2 * n.unknowns * n.outputs + slopes_to_gradient
        }
        Derivatives::ComplexStep { .. } => {
            (COMPLEX * n.unknowns + 1) * n.sample + n.unknowns * n.outputs + slopes_to_gradient
        }
        Derivatives::ForwardSensitivities {} => {
            let recursion = n.stages
                * (2 * n.by_state[0] * n.dynamic + n.by_parameter[0] + 4 * n.states * n.dynamic)
                + n.states * n.dynamic;
            let rows = 2 * n.by_state[1] * n.dynamic + n.by_parameter[1];
            n.sample + n.jacobians + recursion + rows + slopes_to_gradient
        }
        Derivatives::Adjoint { .. } => {
            let way_back =
                n.stages * (2 * n.by_state[0] + 2 * n.by_parameter[0] + 5 * n.states) + n.states;
            let seeds = 2 * n.by_state[1] + 2 * n.by_parameter[1] + 3 * n.outputs;
            2 * n.sample + n.jacobians + way_back + seeds
        }
    };
    n.samples * per_sample
}

/// Bytes that the differences and complex steps work in: columns of a stretch, and a state for each simulation.
pub(super) fn perturbation_bytes(problem: &Problem, technique: &Derivatives) -> usize {
    let outputs = problem.model.outputs.len();
    let (runs, number) = match technique {
        Derivatives::CentralDifference { .. } => (2, 8),
        Derivatives::ComplexStep { .. } => (1, 16),
        _ => (1, 8),
    };
    let unknowns = problem.unknowns.len();
    let segments = problem.segments.iter();
    let stretch = |s: &Segment| March::<f64>::stretch(&problem.model, s, STRETCH).min(s.len());
    let samples = segments.map(stretch).max().unwrap_or(0);
    let columns = 8 * samples * outputs * (unknowns + 1) + number * runs * samples * outputs;
    columns + number * runs * unknowns * problem.model.states.len()
}

/// Bytes that the forward sensitivities work in: Jacobians, forcing and rows of one block.
pub(super) fn sensitivity_bytes(problem: &Problem) -> usize {
    let n = Counts::of(problem);
    let block = 4 * crate::model::LANES as u64;
    let entries = |i: usize| n.by_state[i] + n.by_parameter[i];
    let jacobians = n.stages * entries(0) + entries(1) + n.outputs;
    let forcing = n.stages * n.states * n.dynamic;
    let states = n.stages * n.states;
    (8 * block * (jacobians + forcing + states + n.row_entries)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Machado 2022, tables 12 and 13. The number of samples is not printed; 1502 reproduces all sixteen numbers.
    #[test]
    fn formulas_reproduce_the_printed_table() {
        let models = [
            (3, 2, 6, [240_414, 151_774, 105_192, 88_652]),
            (5, 2, 22, [1_084_940, 710_826, 354_658, 329_084]),
            (7, 7, 10, [2_767_420, 2_273_184, 548_469, 506_374]),
            (
                42,
                20,
                210,
                [556_284_573, 523_469_026, 26_951_685, 26_732_036],
            ),
        ];
        for (outputs, states, unknowns, printed) in models {
            let found = formula(&ProblemSize {
                samples: 1502,
                states,
                outputs,
                unknowns,
                stages: 1,
            });
            let found = [
                found.direct_multiplications,
                found.direct_additions,
                found.reverse_multiplications,
                found.reverse_additions,
            ];
            assert_eq!(found, printed, "{outputs} outputs, {states} states");
        }
    }
}
