//! A scenario: a maneuver to be simulated, with the truth that an estimation should find.

mod affected;
mod document;
mod effect;
mod fly;
mod input_design;
mod noise;
mod recorded;

pub use document::{Scenario, ScenarioChannel, ScenarioError, ScenarioInput, ScenarioOutput};
pub use effect::ScenarioEffect;
pub use fly::Planned;
pub use input_design::InputDesign;
pub use noise::NoiseColour;
