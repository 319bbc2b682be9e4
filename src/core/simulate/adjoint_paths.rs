//! The adjoint of outputs that pass paths, by inputs that do: the ways forward and back, with the paths at their ends.

use super::adjoint::Adjoint;
use super::checkpoints::Checkpoints;
use super::input_path::driven;
use super::interpolation::Axis;
use super::output_path;
use super::segment::Segment;
use super::simulation::Diverged;

impl Adjoint<'_> {
    /// The way forward: outputs of each sample to `sink`, checkpoints for the way back.
    ///
    /// # Errors
    /// The state left the range of numbers; samples up to the end of a block before that were handed over.
    pub(crate) fn forward(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        sink: impl FnMut(usize, &[f64]),
    ) -> Result<Checkpoints, Diverged> {
        let paths = &self.model.paths;
        let sizes = paths.at(parameters);
        let driven = driven(self.model, self.interpolation, segment, &sizes);
        if paths.of_outputs().is_empty() {
            return self.advance(&driven, parameters, sink);
        }
        let mut outputs = vec![Vec::with_capacity(segment.len()); self.model.outputs.len()];
        let keep = |_, y: &[f64]| output_path::push(&mut outputs, y);
        let mut kept = self.advance(&driven, parameters, keep)?;
        kept.outputs.clone_from(&outputs);
        let sizes = &sizes[paths.of_inputs().len()..];
        output_path::pass(self.model, &Axis::new(segment), sizes, &mut outputs);
        output_path::samples(&outputs, sink);
        Ok(kept)
    }

    /// The way back. `seed` is given each sample with its outputs and answers with ȳ; `gradient`, of all
    /// parameters of the model, is added to. `checkpoints` are those of the way forward with the same θ.
    pub(crate) fn reverse(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        checkpoints: &Checkpoints,
        mut seed: impl FnMut(usize, &[f64], &mut [f64]),
        gradient: &mut [f64],
    ) {
        let paths = &self.model.paths;
        let sizes = paths.at(parameters);
        let driven = driven(self.model, self.interpolation, segment, &sizes);
        if paths.of_outputs().is_empty() {
            self.step_back_along(&driven, parameters, checkpoints, seed, gradient);
            return;
        }
        let (axis, sizes) = (Axis::new(segment), &sizes[paths.of_inputs().len()..]);
        let mut outputs = checkpoints.outputs.clone();
        output_path::pass(self.model, &axis, sizes, &mut outputs);
        let mut bars = vec![Vec::with_capacity(segment.len()); outputs.len()];
        let mut y_bar = vec![0.0; outputs.len()];
        output_path::samples(&outputs, |k, y: &[f64]| {
            seed(k, y, &mut y_bar);
            output_path::push(&mut bars, &y_bar);
        });
        let prompt = &checkpoints.outputs;
        let of_sizes = output_path::pass_back(self.model, &axis, sizes, prompt, &mut bars);
        for (place, parameter, value) in paths.output_derivatives(parameters) {
            gradient[parameter] += of_sizes[place] * value;
        }
        let seed = |k: usize, _: &[f64], y_bar: &mut [f64]| {
            (y_bar.iter_mut().zip(&bars)).for_each(|(to, series)| *to = series[k]);
        };
        self.step_back_along(&driven, parameters, checkpoints, seed, gradient);
    }
}
