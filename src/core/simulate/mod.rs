//! Outputs of a model for parameters and a maneuver, and their sensitivities.
//!
//! dx/dt = f(x, u, θ), x(0) = x0(θ), y_k = g(x_k, u_k, θ), stepped by an explicit method, once a sample or more often.
//! [`simulate`] gives y for any kind of number; [`Sensitivities`] gives y and ∂y/∂θ, the adjoint the
//! product (∂y/∂θ)ᵀ ȳ alone. A [`Scenario`] makes a maneuver of known truth. Inputs and outputs pass their paths (play,
//! rate limit, lag, delay) here: inputs before a run, outputs behind it.
//!
//! Invariant: derivatives are those of the discretised model itself, and numbers do not depend on how many threads or
//! lanes there are.

mod adjoint;
mod adjoint_paths;
mod aligned;
mod block;
mod checkpoints;
mod columns;
mod input_path;
mod interpolation;
mod lag;
mod linearised;
mod march;
mod method;
mod one_step;
mod one_step_recursion;
mod output_line;
mod output_path;
mod output_rows;
mod outputs;
mod pack;
mod rates;
mod recursion;
mod refined;
mod scenario;
mod segment;
mod sensitivity;
mod side_by_side;
mod signal;
mod simulation;
mod state_sensitivities;
mod stepper;
mod trajectory;
mod transition;
mod transition_recursion;

pub(crate) use adjoint::Adjoint;
pub use block::Block;
pub(crate) use checkpoints::Checkpoints;
pub use columns::Columns;
pub use input_path::MOST_DELAY;
pub(crate) use input_path::{driven, path_out_of_bounds};
pub(crate) use march::{March, Standing};
pub(crate) use method::Stage;
pub use method::{InputInterpolation, Integrator};
pub use outputs::Outputs;
pub(crate) use pack::{PACK, Pack, multiply_add, packs};
pub use rates::Rates;
pub(crate) use rates::StateMatrixAt;
pub use scenario::{
    InputDesign, NoiseColour, Planned, Scenario, ScenarioChannel, ScenarioEffect, ScenarioError,
    ScenarioInput, ScenarioOutput,
};
pub use segment::{Segment, Steps, Substeps};
pub use sensitivity::Sensitivities;
pub use simulation::{Diverged, initial_state, simulate};
pub(crate) use stepper::{Stepper, between};
