//! Outputs of a model for parameters and a maneuver, and their sensitivities.
//!
//! dx/dt = f(x, u, θ), x(0) = x0(θ), y_k = g(x_k, u_k, θ), stepped once a sample by an explicit method.
//! [`simulate`] gives y for any kind of number; [`Sensitivities`] gives y and ∂y/∂θ. A [`Scenario`] makes a
//! maneuver of known truth.

mod columns;
mod course;
mod input_design;
mod linearised;
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
mod state_sensitivities;
mod stepper;
mod trajectory;

pub use columns::Columns;
pub use input_design::InputDesign;
pub use method::{InputInterpolation, Integrator};
pub use outputs::Outputs;
pub use pack::{PACK, Pack, multiply_add, packs};
pub use scenario::{Scenario, ScenarioError};
pub use segment::{Segment, Steps};
pub use sensitivity::{Block, Sensitivities};
pub use trajectory::{Diverged, simulate};
