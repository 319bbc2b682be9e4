//! Outputs alone, along the same trajectory as [`super::Sensitivities`]: the same numbers, for less work.

use super::input_path::driven;
use super::interpolation::Axis;
use super::linearised::Linearised;
use super::method::{InputInterpolation, Integrator};
use super::output_path;
use super::refined::Refined;
use super::segment::Segment;
use super::simulation::Diverged;
use super::trajectory::Trajectory;
use crate::model::{BLOCK, Model};

/// The machinery for one model, reusable for any segment and θ.
pub struct Outputs<'m> {
    model: &'m Model,
    trajectory: Trajectory<'m>,
    outputs: Linearised<'m>,
    /// See [`Self::passed`].
    passed: Vec<(usize, Vec<f64>)>,
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
            trajectory: Trajectory::new(model, integrator, interpolation),
            outputs: Linearised::new(&model.observation, 1),
            passed: Vec::new(),
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
        self.passed.clear();
        let model = self.model;
        let sizes = model.paths.at(parameters);
        let segment = &*driven(model, self.trajectory.interpolation(), segment, &sizes);
        if model.paths.of_outputs().is_empty() {
            return self.advance(segment, parameters, sink);
        }
        // a delayed output looks back and ahead: the whole segment is one block
        let mut outputs = vec![Vec::with_capacity(segment.len()); model.outputs.len()];
        self.advance(segment, parameters, |_, y| {
            let series = outputs.iter_mut().zip(y);
            series.for_each(|(series, y)| series.extend_from_slice(y));
        })?;
        let sizes = &sizes[model.paths.of_inputs().len()..];
        output_path::pass(model, &Axis::new(segment), sizes, &mut outputs);
        let outputs: Vec<&[f64]> = outputs.iter().map(Vec::as_slice).collect();
        sink(0, &outputs);
        Ok(())
    }

    /// Along a driven segment, outputs before their paths.
    fn advance(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        mut sink: impl FnMut(usize, &[&[f64]]),
    ) -> Result<(), Diverged> {
        let refined = match self.trajectory.stride_of(segment) {
            Some(_) => None,
            None => Refined::of(segment, self.trajectory.interpolation()),
        };
        let samples = segment.len();
        let segment = refined.as_ref().map_or(segment, |refined| &refined.segment);
        self.trajectory.start(segment, parameters);
        self.outputs.set_parameters(parameters);
        let results = self.outputs.results();
        let mut kept: Vec<Vec<f64>> = vec![Vec::new(); results];
        let mut next = 0;
        for first in (0..segment.len()).step_by(BLOCK) {
            let len = BLOCK.min(segment.len() - first);
            let advanced = self.trajectory.advance(segment, first, len);
            advanced.map_err(|diverged| diverged.in_samples(refined.as_ref()))?;
            let sample = refined
                .as_ref()
                .map_or(first, |refined| refined.sample_from(first));
            self.passed.push((sample, self.trajectory.first_state()));
            self.outputs.evaluate(0, len, &self.trajectory);
            let over_block = |output: usize| &self.outputs.over_block(0, output)[..len];
            let Some(refined) = &refined else {
                let outputs: Vec<&[f64]> = (0..results).map(over_block).collect();
                sink(first, &outputs);
                continue;
            };
            // of the steps, those that are at a sample
            let until = refined.sample_from(first + len);
            for (output, kept) in kept.iter_mut().enumerate() {
                let at = refined.at[next + kept.len()..until].iter();
                kept.extend(at.map(|&at| over_block(output)[at - first]));
            }
            if until - next >= BLOCK || until == samples {
                let outputs: Vec<&[f64]> = kept.iter().map(Vec::as_slice).collect();
                sink(next, &outputs);
                kept.iter_mut().for_each(Vec::clear);
                next = until;
            }
        }
        Ok(())
    }

    /// States that the last run went through, each with the sample it was at or came to next: one for some dozen steps.
    pub(crate) fn passed(&self) -> &[(usize, Vec<f64>)] {
        &self.passed
    }
}
