//! Why a model has no aerodynamics for JSBSim.

use crate::model::expression::SyntaxError;

/// Why a model has no aerodynamics for JSBSim.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum NoAerodynamics {
    /// Dimensional derivatives, or a reconstruction.
    #[error(
        "definitions: none is an aerodynamic coefficient; write forces and moments by definitions with \"quantity\" (lift_coefficient, drag_coefficient, pitching_moment_coefficient, ...), as the catalog model longitudinal-nonlinear does"
    )]
    NoCoefficient,
    /// Lift or drag beside a force along a body axis.
    #[error(
        "definitions: {first} is a force in stability axes and {second} one in body axes; JSBSim takes one kind: define both in the same axes"
    )]
    MixedAxes {
        /// The definition in stability axes.
        first: String,
        /// The definition in body axes.
        second: String,
    },
    /// A quantity that JSBSim does not have.
    #[error(
        "{name}: a coefficient depends on it, and JSBSim has no such quantity; say its \"quantity\" in the model if it is an angle of attack, a rate or another motion of the aircraft"
    )]
    NoProperty {
        /// The state.
        name: String,
    },
    /// The time since the start of the segment.
    #[error(
        "{name}: it depends on the time t since the start of a maneuver, which a simulation does not have"
    )]
    Time {
        /// The definition.
        name: String,
    },
    /// An equation that was compiled is read again.
    #[error("{0}")]
    Syntax(#[from] SyntaxError),
}
