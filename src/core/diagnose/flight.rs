//! A flight, as a diagnosis needs it: every recorded channel, since an effect may bring in one that the
//! declared model does not use.

use indexmap::IndexMap;

use crate::estimate::Role;
use crate::flight::Dimension;
use crate::model::{Model, Recorded, Start};
use crate::simulate::{Segment, Steps, Substeps};

/// One continuous stretch of a recording.
#[derive(Clone, PartialEq, Debug)]
pub struct Flight {
    /// What tables call it.
    pub label: String,
    /// Whether models are fitted to it, or predict it.
    pub role: Role,
    /// Recorded time, s.
    pub time: Vec<f64>,
    /// From each sample to the next, s.
    pub steps: Steps,
    /// SI, by name: the model's inputs and outputs under the model's names, then all else that was recorded.
    pub channels: IndexMap<String, (Vec<f64>, Dimension)>,
    /// What parameters of each maneuver's own have or begin with here, in their units, by name; where there is nothing, what the
    /// document says.
    pub own: IndexMap<String, Start>,
}

impl Flight {
    /// The segment that a model is compared with; the name of what is not recorded otherwise.
    ///
    /// # Errors
    /// A channel that the model needs is not recorded, or not in its dimension.
    pub fn segment(&self, model: &Model) -> Result<Segment, String> {
        let values = |quantity: &crate::model::Quantity| {
            let name = &quantity.name;
            match self.channels.get(name) {
                None => Err(format!("no channel '{name}' is recorded")),
                Some((_, found)) if *found != quantity.unit.dimension => Err(format!(
                    "the channel '{name}' is in {found}, not in {}",
                    quantity.unit.dimension
                )),
                Some((values, _)) => Ok(values.clone()),
            }
        };
        let inputs: Vec<Vec<f64>> = model.inputs.iter().map(values).collect::<Result<_, _>>()?;
        let gap = inputs.iter().position(|u| u.iter().any(|v| !v.is_finite()));
        if let Some(input) = gap {
            let name = &model.inputs[input].name;
            return Err(format!("the channel '{name}' has samples without a value"));
        }
        Ok(Segment {
            label: self.label.clone(),
            time: self.time.clone(),
            steps: self.steps.clone(),
            substeps: Substeps::default(),
            inputs,
            measured: model.outputs.iter().map(values).collect::<Result<_, _>>()?,
        })
    }

    /// The usual step, s.
    pub fn step(&self) -> f64 {
        match &self.steps {
            Steps::Even(step) => *step,
            Steps::Uneven(steps) => steps.iter().sum::<f64>() / steps.len().max(1) as f64,
        }
    }
}

impl Recorded for Flight {
    fn time(&self) -> &[f64] {
        &self.time
    }
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let (values, dimension) = self.channels.get(name)?;
        Some((values, *dimension))
    }
    fn names(&self) -> Vec<String> {
        self.channels.keys().cloned().collect()
    }
}
