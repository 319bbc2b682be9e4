//! Outputs and their sensitivities ∂y/∂θ, by forward sensitivities of the integration scheme itself.
//!
//! The trajectory is sequential in time, its Jacobians are not. A block of samples is done in three passes:
//! 1. integrate the states, keeping every stage state (sequential, scalar);
//! 2. evaluate ∂f/∂x, ∂f/∂θ at all stages and g, ∂g/∂x, ∂g/∂θ at all samples (side by side, `LANES` at a time);
//! 3. run the recursion of ∂x/∂θ (sequential, vectors over parameters) and form the rows of ∂y/∂θ.
//!
//! Where the model is affine in states and inputs, one step is a constant matrix (`OneStep`): passes 1 and 3
//! are then products with it, and there are no Jacobians of f to evaluate.
//!
//! Where there are several integration steps between samples, blocks are of steps, and only what is at a sample is handed
//! on.
//!
//! The derivative is that of the discretised model, exact but for rounding. Memory does not grow with the
//! length of the recording.

use super::block::Block;
use super::columns::Columns;
use super::input_path::driven;
use super::linearised::Linearised;
use super::method::{InputInterpolation, Integrator};
use super::output_line::OutputLine;
use super::output_rows::OutputRows;
use super::pack::Pack;
use super::refined::{Refined, Thinning};
use super::segment::Segment;
use super::simulation::Diverged;
use super::state_sensitivities::StateSensitivities;
use super::trajectory::Trajectory;
use crate::model::{BLOCK, Model};

/// The machinery for one model and one set of columns, reusable for any segment and θ.
pub struct Sensitivities<'m> {
    model: &'m Model,
    columns: &'m Columns,
    trajectory: Trajectory<'m>,
    dynamics: Linearised<'m>,
    observation: Linearised<'m>,
    outputs: Linearised<'m>,
    states: StateSensitivities,
    rows: OutputRows,
    /// Where outputs have paths.
    line: Option<OutputLine<'m>>,
}

impl<'m> Sensitivities<'m> {
    /// Machinery with room for one block of samples; `columns` say by which parameters outputs are differentiated.
    pub fn new(
        model: &'m Model,
        columns: &'m Columns,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        let trajectory = Trajectory::new(model, integrator, interpolation);
        let stages = trajectory.stages.len();
        Self {
            model,
            columns,
            trajectory,
            dynamics: Linearised::new(&model.dynamics_jacobian.program, stages),
            observation: Linearised::new(&model.observation_jacobian.program, 1),
            outputs: Linearised::new(&model.observation, 1),
            states: StateSensitivities::new(model, columns, stages),
            rows: OutputRows::new(model, columns),
            line: OutputLine::new(model, columns),
        }
    }

    /// Runs along a segment and hands each block to `sink`. `parameters` are all of the model's, SI.
    ///
    /// # Errors
    /// The state left the range of numbers; blocks before that were handed over.
    pub fn run(
        &mut self,
        segment: &Segment,
        parameters: &[f64],
        mut sink: impl FnMut(&Block<'_>),
    ) -> Result<(), Diverged> {
        let sizes = self.model.paths.at(parameters);
        let interpolation = self.trajectory.interpolation();
        let driven = driven(self.model, interpolation, segment, &sizes);
        let segment = &*driven;
        if let Some(line) = &mut self.line {
            line.start(segment, parameters, &sizes);
        }
        let refined = match self.trajectory.stride_of(segment) {
            Some(_) => None,
            None => Refined::of(segment, self.trajectory.interpolation()),
        };
        let mut thinning = refined
            .as_ref()
            .map(|refined| (refined, Thinning::new(self.columns)));
        let segment = refined.as_ref().map_or(segment, |refined| &refined.segment);
        self.trajectory.start(segment, parameters);
        if self.trajectory.one_step().is_none() {
            self.dynamics.set_parameters(parameters);
        }
        self.observation.set_parameters(parameters);
        self.outputs.set_parameters(parameters);
        self.states.start(
            self.model,
            self.columns,
            parameters,
            &self.trajectory,
            &self.dynamics,
        );
        self.rows.place(true, &self.observation, BLOCK);
        for first in (0..segment.len()).step_by(BLOCK) {
            let len = BLOCK.min(segment.len() - first);
            let advanced = self.trajectory.advance(segment, first, len);
            advanced.map_err(|diverged| diverged.in_samples(refined.as_ref()))?;
            if self.trajectory.one_step().is_none() {
                for stage in 0..self.trajectory.stages.len() {
                    self.dynamics.evaluate(stage, len, &self.trajectory);
                }
            }
            self.observation.evaluate(0, len, &self.trajectory);
            self.outputs.evaluate(0, len, &self.trajectory);
            self.states
                .sweep(segment, (first, len), &self.trajectory, &self.dynamics);
            self.rows.place(false, &self.observation, len);
            self.rows.form(
                len,
                &self.observation,
                &self.states.rows,
                self.states.shape(),
            );
            let rows: Vec<&[Pack]> = (0..self.columns.outputs())
                .map(|o| self.rows.of(o))
                .collect();
            let block = Block {
                first,
                len,
                outputs: self.outputs.all_over_block(0),
                columns: self.columns,
                rows: &rows,
            };
            let mut hand_on = |block: &Block<'_>| match &mut self.line {
                Some(line) => line.pass(block, &mut sink),
                None => sink(block),
            };
            match &mut thinning {
                Some((refined, thinning)) => thinning.pass(refined, &block, hand_on),
                None => hand_on(&block),
            }
            self.states.carry_over();
        }
        Ok(())
    }
}
