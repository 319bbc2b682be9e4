//! A model's aerodynamic coefficients as the `<aerodynamics>` of JSBSim (JSBSim Reference Manual; FGAerodynamics, FGFunction).
//!
//! ```text
//! parameters     properties aero/trimtab/NAME, where they were estimated; a simulation can change them
//! definitions    functions aero/trimtab/NAME, SI, of JSBSim's own properties
//! coefficients   axes: force = aero/qbar-psf · metrics/Sw-sqft · C, moment also · metrics/bw-ft or metrics/cbarw-ft
//! ```
//!
//! What is alpha, what is a pitch rate, is told by the quantities of the document. Kinematics, gravity and thrust are JSBSim's.

mod axes;
mod element;
mod no_aerodynamics;
mod property;
mod writer;

pub use no_aerodynamics::NoAerodynamics;

use super::Model;
use writer::Writer;

impl Model {
    /// The file that `<aerodynamics file="...">` of an aircraft names, for parameters, SI. `of` says in a line what they are of.
    ///
    /// # Errors
    /// The model has no coefficients, or they depend on what JSBSim does not have.
    pub fn jsbsim(&self, parameters: &[f64], of: &str) -> Result<String, NoAerodynamics> {
        Writer::new(self, parameters).file(of)
    }
}
