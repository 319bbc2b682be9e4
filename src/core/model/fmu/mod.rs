//! A model as a functional mock-up unit: FMI 2.0 (Modelica Association, 2014, with 2.0.4) for model exchange and co-simulation, as
//! C sources that the importing tool compiles.
//!
//! ```text
//! modelDescription.xml   variables, units, structure
//! sources/model.c        x0, dx/dt, y of the parameters p, written from the flat programs
//! sources/fmi2.c         the functions of the standard around them
//! ```
//!
//! Inputs, outputs and parameters have the names of the document, a state `alpha` is `state.alpha`, and all are in SI. Parameters
//! can be changed. In co-simulation a step is taken in equal Runge-Kutta steps of fourth order, no longer than `step`, with
//! inputs held, or straight where the importer sets their derivatives. Signal paths are not in it.

mod archive;
mod description;
mod setting;

pub use setting::FmuSetting;

use super::Model;
use super::source::c;
use super::source::function::Parameters;
use archive::archive;
use description::Description;

/// The functions of the standard.
const FMI2: &str = include_str!("fmi2.c");

impl Model {
    /// The model as a functional mock-up unit, a zip archive whose bytes are the same for the same model and numbers.
    pub fn fmu(&self, setting: &FmuSetting<'_>) -> Vec<u8> {
        let source = format!(
            "#include \"model.h\"\n#include <math.h>\n\n{}",
            c::functions(self, Parameters::Array(setting.parameters.len()))
        );
        let description = Description::new(self, setting, &source);
        let header = self.header(setting, &description.guid);
        archive(&[
            ("modelDescription.xml", description.xml().as_bytes()),
            ("sources/fmi2.c", FMI2.as_bytes()),
            ("sources/model.c", source.as_bytes()),
            ("sources/model.h", header.as_bytes()),
        ])
    }

    /// Sizes, start values and prototypes.
    fn header(&self, setting: &FmuSetting<'_>, guid: &str) -> String {
        let notes: String = (self.notes(setting.parameters, setting.of).iter())
            .map(|note| format!(" * {note}\n"))
            .collect();
        format!(
            "/*\n{notes} */\n#ifndef TRIMTAB_MODEL_H\n#define TRIMTAB_MODEL_H\n\n#include <math.h>\n\n\
             #define MODEL_GUID \"{guid}\"\n#define MODEL_STEP {:?}\n\
             enum {{ MODEL_STATES = {}, MODEL_INPUTS = {}, MODEL_OUTPUTS = {}, MODEL_PARAMETERS = {} }};\n\n\
             /* where inputs and parameters begin; one more, since no array of C is empty */\n\
             #define MODEL_INPUT_STARTS {{ {} }}\n#define MODEL_PARAMETER_STARTS {{ {} }}\n\n\
             void model_initial(const double *p, const double *x, const double *u, double t, double *x0);\n\
             void model_derivative(const double *p, const double *x, const double *u, double t, double *dx);\n\
             void model_output(const double *p, const double *x, const double *u, double t, double *y);\n\n#endif\n",
            setting.step,
            self.states.len(),
            self.inputs.len(),
            self.outputs.len(),
            setting.parameters.len(),
            numbers(setting.inputs),
            numbers(setting.parameters),
        )
    }
}

fn numbers(values: &[f64]) -> String {
    let written = values.iter().map(|&value| c::number(value));
    let all: Vec<String> = written.chain(["0.0".to_string()]).collect();
    all.join(", ")
}
