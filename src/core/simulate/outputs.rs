//! Outputs alone, along the same trajectory as [`super::Sensitivities`]: the same numbers, for less work.

use super::linearised::Linearised;
use super::method::{InputInterpolation, Integrator};
use super::segment::Segment;
use super::simulation::{Diverged, simulate};
use super::trajectory::Trajectory;
use crate::model::{BLOCK, Model};

/// The machinery for one model, reusable for any segment and θ.
pub struct Outputs<'m> {
    model: &'m Model,
    integrator: Integrator,
    interpolation: InputInterpolation,
    trajectory: Trajectory<'m>,
    outputs: Linearised<'m>,
}

impl<'m> Outputs<'m> {
    /// Machinery with room for one block of samples.
    pub fn new(
        model: &'m Model,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        Self {
            model,
            integrator,
            interpolation,
            trajectory: Trajectory::new(model, integrator, interpolation),
            outputs: Linearised::new(&model.observation, 1),
        }
    }

    /// Runs along a segment and hands over y of each block of samples: the index of the first, and
    /// by output y sample by sample. `parameters` are all of the model's, SI.
    ///
    /// # Errors
    /// The state left the range of numbers; blocks before that were handed over.
    pub fn run(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        mut sink: impl FnMut(usize, &[&[f64]]),
    ) -> Result<(), Diverged> {
        if !self.model.delays.is_empty() {
            self.run_delayed(segment, parameters, sink);
            return Ok(());
        }
        self.trajectory.start(segment, parameters);
        self.outputs.set_parameters(parameters);
        for first in (0..segment.len()).step_by(BLOCK) {
            let len = BLOCK.min(segment.len() - first);
            self.trajectory.advance(segment, first, len)?;
            self.outputs.evaluate(0, len, &self.trajectory);
            let outputs: Vec<&[f64]> = (0..self.outputs.results())
                .map(|output| &self.outputs.over_block(0, output)[..len])
                .collect();
            sink(first, &outputs);
        }
        Ok(())
    }
    /// Delayed outputs look back and ahead: the whole segment is one block.
    fn run_delayed(
        &self,
        segment: &Segment,
        parameters: &[f64],
        mut sink: impl FnMut(usize, &[&[f64]]),
    ) {
        let mut outputs = vec![Vec::with_capacity(segment.len()); self.outputs.results()];
        let keep = |_, y: &[f64]| {
            outputs
                .iter_mut()
                .zip(y)
                .for_each(|(series, &y)| series.push(y));
        };
        simulate(
            self.model,
            self.integrator,
            self.interpolation,
            segment,
            parameters,
            keep,
        );
        let outputs: Vec<&[f64]> = outputs.iter().map(Vec::as_slice).collect();
        sink(0, &outputs);
    }
}
