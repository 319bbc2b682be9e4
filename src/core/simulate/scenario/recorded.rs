//! Inputs of a scenario that were flown once.

use super::document::{Scenario, ScenarioError, unit_like};
use super::input_design::InputDesign;
use crate::flight::Maneuver;

impl Scenario {
    /// Reads the inputs whose design is `recorded` in a file: `read` gives the recording of a path. Times count from
    /// its first sample, values are taken over into the unit of the input. The scenario then has the samples in place of the file.
    ///
    /// # Errors
    /// A file that cannot be read, or a channel or unit that is not in it.
    pub fn read_recorded(
        &mut self,
        mut read: impl FnMut(&str) -> Result<Maneuver, String>,
    ) -> Result<(), ScenarioError> {
        for (name, input) in &mut self.inputs {
            let unfit = |message: String| ScenarioError::Unfit {
                what: format!("inputs.{name}.design"),
                message,
            };
            let InputDesign::Recorded {
                file: Some(file),
                channel,
                ..
            } = &input.design
            else {
                continue;
            };
            let maneuver = read(file).map_err(unfit)?;
            let channel = channel.as_ref().unwrap_or(name);
            let Some(recorded) = maneuver.channels().get(channel) else {
                let known: Vec<_> = maneuver.channels().keys().map(String::as_str).collect();
                let known = known.join(", ");
                return Err(unfit(format!("{file} has no '{channel}'; it has {known}")));
            };
            let unit = unit_like(&input.unit, recorded.unit, &format!("inputs.{name}.unit"))?;
            let begin = maneuver.time()[0];
            let samples = maneuver.time().iter().zip(&recorded.values);
            let (time, values) = samples
                .filter(|(_, value)| value.is_finite())
                .map(|(t, value)| (t - begin, unit.from_si(*value)))
                .unzip();
            input.design = InputDesign::Recorded {
                file: None,
                channel: None,
                time,
                values,
            };
        }
        Ok(())
    }
}
