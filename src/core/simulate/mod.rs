//! Outputs of a model for parameters and a maneuver, and their sensitivities.
//!
//! dx/dt = f(x, u, θ), x(0) = x0(θ), y_k = g(x_k, u_k, θ), stepped once a sample by an explicit method.
//! [`simulate`] gives y for any kind of number; [`Sensitivities`] gives y and ∂y/∂θ, the adjoint the
//! product (∂y/∂θ)ᵀ ȳ alone. A [`Scenario`] makes a maneuver of known truth. Inputs and outputs that the model delays
//! are delayed here: inputs before a run, outputs behind it.

mod adjoint;
mod aligned;
mod block;
mod columns;
mod delay_line;
mod delayed_inputs;
mod interpolation;
mod linearised;
mod march;
mod method;
mod one_step;
mod one_step_recursion;
mod output_rows;
mod outputs;
mod pack;
mod recursion;
mod scenario;
mod segment;
mod sensitivity;
mod side_by_side;
mod simulation;
mod state_sensitivities;
mod stepper;
mod trajectory;
mod transition;
mod transition_recursion;

pub(crate) use adjoint::{Adjoint, Checkpoints};
pub use block::Block;
pub use columns::Columns;
pub(crate) use delayed_inputs::{MOST_DELAY, delay_out_of_bounds};
pub(crate) use march::{March, Standing};
pub use method::{InputInterpolation, Integrator};
pub use outputs::Outputs;
pub(crate) use pack::{PACK, Pack, multiply_add, packs};
pub use scenario::{
    InputDesign, NoiseColour, Scenario, ScenarioChannel, ScenarioEffect, ScenarioError,
    ScenarioInput, ScenarioOutput,
};
pub use segment::{Segment, Steps};
pub use sensitivity::Sensitivities;
pub use simulation::{Diverged, initial_state, simulate};
pub(crate) use stepper::{Stepper, between};
