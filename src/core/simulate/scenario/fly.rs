//! Flying a scenario: its maneuver is simulated, and noise is added.

use indexmap::IndexMap;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::affected::Affected;
use super::document::{Scenario, ScenarioError, ScenarioOutput, unit_like};
use super::noise::NoiseColour;
use crate::flight::{Channel, Dimension, Maneuver, Unit};
use crate::model::{ChannelFormula, Model, Recorded, Start};
use crate::simulate::method::{InputInterpolation, Integrator};
use crate::simulate::segment::{Segment, Steps, Substeps};
use crate::simulate::simulation::simulate_disturbed;

/// Integration steps between two samples: the truth is finer than what is recorded of it.
const SUBSTEPS: usize = 10;

/// Most samples of a simulated maneuver.
const MOST_SAMPLES: f64 = 1e6;

impl Scenario {
    /// Simulates the maneuver, with its effects in it, and adds noise. Channels are in the units of the scenario.
    ///
    /// # Errors
    /// Names or units that the model does not have, or a simulation that leaves the range of numbers.
    pub fn fly(&self, model: &Model) -> Result<Maneuver, ScenarioError> {
        if self.effects.is_empty() {
            let (time, channels) = self.record(model, &[])?;
            return maneuver(time, channels);
        }
        let affected = Affected::new(self, &model.document)?;
        let edited = affected.compile()?;
        let (time, mut channels) = (affected.scenario).record(&edited, &affected.added)?;
        affected.spoil(&mut channels)?;
        maneuver(time, channels)
    }

    /// Inputs and parameters as they are planned; of the parameters, `read_off` are read off the designed inputs where
    /// their start says so.
    fn plan(&self, model: &Model, read_off: &[String]) -> Result<Planned, ScenarioError> {
        let unfit = |what: &str, message: String| ScenarioError::Unfit {
            what: what.to_string(),
            message,
        };
        let samples = (self.duration / self.step).round() + 1.0;
        if !(self.step > 0.0 && (2.0..=MOST_SAMPLES).contains(&samples)) {
            return Err(unfit(
                "step",
                format!("duration over step must give 2 to {MOST_SAMPLES:e} samples"),
            ));
        }
        let count = samples as usize;
        let time: Vec<f64> = (0..count).map(|k| k as f64 * self.step).collect();
        let inputs = model.inputs.iter().map(|input| {
            let what = format!("inputs.{}", input.name);
            if let Some(design) = self.inputs.get(&input.name) {
                if let Some(message) = design.design.fault() {
                    return Err(unfit(&format!("{what}.design"), message));
                }
                let unit = unit_like(&design.unit, input.unit, &format!("{what}.unit"))?;
                let at = |&t: &f64| unit.to_si(design.trim + design.design.at(t));
                return Ok((design.unit.clone(), time.iter().map(at).collect()));
            }
            // what the model sees is the truth, what is recorded below has noise
            let Some(held) = self.channels.get(&input.name) else {
                let message = "the model's input is not designed here".to_string();
                return Err(unfit(&what, message));
            };
            let what = format!("channels.{}.unit", input.name);
            let value = unit_like(&held.unit, input.unit, &what)?.to_si(held.value);
            Ok((held.unit.clone(), vec![value; count]))
        });
        let inputs = inputs.collect::<Result<Vec<(String, Vec<f64>)>, ScenarioError>>()?;
        let (units, inputs): (Vec<String>, Vec<Vec<f64>>) = inputs.into_iter().unzip();
        let designed = Designed {
            model,
            time: time.clone(),
            inputs: &inputs,
        };
        let parameters = self.parameters(model, read_off, &designed)?;
        Ok(Planned {
            time,
            units,
            inputs,
            parameters,
        })
    }

    /// What the model sees of the maneuver before it is flown, and the parameters that are expected.
    ///
    /// # Errors
    /// Names or units that the model does not have, parameters without a value.
    pub fn planned(&self, model: &Model) -> Result<Planned, ScenarioError> {
        self.plan(model, &[])
    }

    /// Standard deviations of the noise of the outputs, SI, in the model's order.
    ///
    /// # Errors
    /// An output that the scenario does not have, or a unit of another dimension.
    pub fn noise(&self, model: &Model) -> Result<Vec<f64>, ScenarioError> {
        let of = |output: &crate::model::Quantity| {
            let (recorded, unit) = self.recorded_as(output)?;
            Ok(recorded.noise * unit.scale)
        };
        model.outputs.iter().map(of).collect()
    }

    /// How an output is recorded, and its unit.
    fn recorded_as(
        &self,
        output: &crate::model::Quantity,
    ) -> Result<(&ScenarioOutput, Unit), ScenarioError> {
        let what = format!("outputs.{}", output.name);
        let Some(recorded) = self.outputs.get(&output.name) else {
            let message = "the scenario does not say how this output is recorded".to_string();
            return Err(ScenarioError::Unfit { what, message });
        };
        let unit = unit_like(&recorded.unit, output.unit, &format!("{what}.unit"))?;
        Ok((recorded, unit))
    }

    /// What is recorded. Of the parameters, `read_off` are read off the designed inputs where their start says so.
    fn record(&self, model: &Model, read_off: &[String]) -> Result<TimeAndChannels, ScenarioError> {
        let unfit = |what: &str, message: String| ScenarioError::Unfit {
            what: what.to_string(),
            message,
        };
        let Planned {
            time,
            units,
            inputs,
            parameters,
        } = self.plan(model, read_off)?;
        let count = time.len();
        let intensities = self.intensities(model)?;
        let outputs = self.simulate(model, &parameters, &intensities, &inputs, count);
        if outputs.iter().flatten().any(|y| !y.is_finite()) {
            return Err(unfit(
                "truth",
                "the simulation leaves the range of numbers".to_string(),
            ));
        }

        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut channels = IndexMap::new();
        for ((input, values), unit) in model.inputs.iter().zip(inputs).zip(units) {
            channels.insert(input.name.clone(), channel(&unit, values)?);
        }
        for (output, values) in model.outputs.iter().zip(outputs) {
            let what = format!("outputs.{}", output.name);
            let (recorded, unit) = self.recorded_as(output)?;
            if let Some(message) = recorded.colour.fault(self.step, count) {
                return Err(unfit(&format!("{what}.colour"), message));
            }
            let deviation = recorded.noise * unit.scale;
            let noise = recorded.colour.samples(self.step, count, &mut random);
            let noisy = values.iter().zip(noise).map(|(y, e)| y + deviation * e);
            let values = noisy.collect();
            channels.insert(output.name.clone(), channel(&recorded.unit, values)?);
        }
        for (name, recorded) in &self.channels {
            let unit = Unit::parse(&recorded.unit)
                .map_err(|e| unfit(&format!("channels.{name}.unit"), e.to_string()))?;
            let noise = NoiseColour::White.samples(self.step, count, &mut random);
            let noisy = noise
                .iter()
                .map(|e| unit.to_si(recorded.value + recorded.noise * e));
            let values = noisy.collect();
            channels.insert(name.clone(), channel(&recorded.unit, values)?);
        }
        Ok((time, channels))
    }

    /// SI, by state of the model.
    fn intensities(&self, model: &Model) -> Result<Vec<f64>, ScenarioError> {
        let unfit = |(name, value): (&String, &f64)| {
            let known = model.states.iter().any(|state| state.name == *name);
            (!(known && *value >= 0.0 && value.is_finite())).then(|| ScenarioError::Unfit {
                what: format!("process_noise.{name}"),
                message: "give the intensity of a state of the model, 0 or more".into(),
            })
        };
        match self.process_noise.iter().find_map(unfit) {
            Some(error) => Err(error),
            None => Ok((model.states.iter())
                .map(|state| {
                    let intensity = self.process_noise.get(&state.name);
                    intensity.copied().unwrap_or(0.0) * state.unit.scale
                })
                .collect()),
        }
    }

    fn parameters(
        &self,
        model: &Model,
        read_off: &[String],
        designed: &Designed,
    ) -> Result<Vec<f64>, ScenarioError> {
        let what = |name: &str| format!("truth.{name}");
        if let Some(name) = self
            .truth
            .keys()
            .find(|name| !model.parameters.iter().any(|p| p.name == **name))
        {
            return Err(ScenarioError::Unfit {
                what: what(name),
                message: "the model has no such parameter".into(),
            });
        }
        let value = |info: &crate::model::ParameterInfo| match (
            self.truth.get(&info.name),
            &info.document.start,
        ) {
            (Some(value), _) | (None, Start::Value(value)) => Ok(info.unit.to_si(*value)),
            (None, Start::FromData(text)) if read_off.contains(&info.name) => {
                let formula = ChannelFormula::parse(text);
                let number = formula.and_then(|formula| formula.number(designed));
                number.map_err(|error| ScenarioError::Unfit {
                    what: what(&info.name),
                    message: format!("{error}; give its true value"),
                })
            }
            (None, Start::FromData(_)) => {
                let message =
                    "the model reads this parameter off the data: give its true value".to_string();
                Err(ScenarioError::Unfit {
                    what: what(&info.name),
                    message,
                })
            }
        };
        model.parameters.iter().map(value).collect()
    }

    /// Outputs at the samples, integrated with finer steps; after each the states are disturbed.
    fn simulate(
        &self,
        model: &Model,
        parameters: &[f64],
        intensities: &[f64],
        inputs: &[Vec<f64>],
        count: usize,
    ) -> Vec<Vec<f64>> {
        let fine = (count - 1) * SUBSTEPS + 1;
        let between = |samples: &Vec<f64>| -> Vec<f64> {
            let at = |i: usize| {
                let (k, share) = (i / SUBSTEPS, (i % SUBSTEPS) as f64 / SUBSTEPS as f64);
                samples[k] + share * (samples[(k + 1).min(count - 1)] - samples[k])
            };
            (0..fine).map(at).collect()
        };
        let step = self.step / SUBSTEPS as f64;
        let segment = Segment {
            label: String::new(),
            time: (0..fine).map(|i| i as f64 * step).collect(),
            steps: Steps::Even(step),
            substeps: Substeps::default(),
            inputs: inputs.iter().map(between).collect(),
            measured: Vec::new(),
        };
        let mut outputs = vec![Vec::with_capacity(count); model.outputs.len()];
        // a stream of its own, so that the measurement noise is the same with and without
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(1);
        let disturb = |state: &mut [f64]| {
            for (x, intensity) in state.iter_mut().zip(intensities) {
                if *intensity > 0.0 {
                    let unit: f64 = StandardNormal.sample(&mut random);
                    *x += intensity * step.sqrt() * unit;
                }
            }
        };
        simulate_disturbed(
            model,
            Integrator::Rk4,
            InputInterpolation::Linear,
            &segment,
            parameters,
            disturb,
            |i, y: &[f64]| {
                if i.is_multiple_of(SUBSTEPS) {
                    outputs
                        .iter_mut()
                        .zip(y)
                        .for_each(|(series, &y)| series.push(y));
                }
            },
        );
        outputs
    }
}

/// A maneuver before it is flown, SI.
#[derive(Clone, PartialEq, Debug)]
pub struct Planned {
    /// Seconds from its start.
    pub time: Vec<f64>,
    /// By input of the model: the unit in which it is recorded.
    pub units: Vec<String>,
    /// By input, then sample.
    pub inputs: Vec<Vec<f64>>,
    /// All parameters of the model.
    pub parameters: Vec<f64>,
}

/// Time and channels.
type TimeAndChannels = (Vec<f64>, IndexMap<String, Channel>);

fn maneuver(
    time: Vec<f64>,
    channels: IndexMap<String, Channel>,
) -> Result<Maneuver, ScenarioError> {
    Maneuver::new(time, channels).map_err(|error| ScenarioError::Unfit {
        what: "scenario".to_string(),
        message: error.to_string(),
    })
}

/// A channel whose values are in SI already.
fn channel(unit: &str, values: Vec<f64>) -> Result<Channel, ScenarioError> {
    let parsed = Unit::parse(unit).map_err(|error| ScenarioError::Unfit {
        what: "unit".to_string(),
        message: error.to_string(),
    })?;
    Ok(Channel {
        recorded_unit: unit.to_string(),
        unit: parsed,
        values,
    })
}

/// The designed inputs as a recording, for parameters that are read off one.
struct Designed<'m> {
    model: &'m Model,
    time: Vec<f64>,
    inputs: &'m [Vec<f64>],
}

impl Recorded for Designed<'_> {
    fn time(&self) -> &[f64] {
        &self.time
    }

    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let place = (self.model.inputs.iter()).position(|input| input.name == name)?;
        Some((&self.inputs[place], self.model.inputs[place].unit.dimension))
    }

    fn names(&self) -> Vec<String> {
        (self.model.inputs.iter())
            .map(|input| input.name.clone())
            .collect()
    }
}
