//! What a functional mock-up unit is made with.

/// What stands in the functional mock-up unit beside the equations.
#[derive(Clone, Debug)]
pub struct FmuSetting<'s> {
    /// SI, in the model's order: where its parameters begin.
    pub parameters: &'s [f64],
    /// SI, by input: where they begin.
    pub inputs: &'s [f64],
    /// The longest integration step of co-simulation, s.
    pub step: f64,
    /// Seconds of the default experiment.
    pub duration: f64,
    /// In a line what it is of.
    pub of: &'s str,
}
