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
//! The derivative is that of the discretised model, exact but for rounding. Memory does not grow with the
//! length of the recording.

use super::block::Block;
use super::columns::Columns;
use super::course::Course;
use super::input_path::driven;
use super::linearised::Linearised;
use super::method::{InputInterpolation, Integrator};
use super::output_line::OutputLine;
use super::output_rows::OutputRows;
use super::pack::Pack;
use super::segment::Segment;
use super::state_sensitivities::StateSensitivities;
use super::trajectory::Diverged;
use crate::model::{BLOCK, Model};

/// The machinery for one model and one set of columns, reusable for any segment and θ.
pub struct Sensitivities<'m> {
    model: &'m Model,
    columns: &'m Columns,
    course: Course<'m>,
    dynamics: Linearised<'m>,
    observation: Linearised<'m>,
    outputs: Linearised<'m>,
    states: StateSensitivities,
    rows: OutputRows,
    /// Where outputs have paths.
    line: Option<OutputLine<'m>>,
}

impl<'m> Sensitivities<'m> {
    pub fn new(
        model: &'m Model,
        columns: &'m Columns,
        integrator: Integrator,
        interpolation: InputInterpolation,
    ) -> Self {
        let course = Course::new(model, integrator, interpolation);
        let stages = course.stages.len();
        Self {
            model,
            columns,
            course,
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
        let interpolation = self.course.interpolation();
        let driven = driven(self.model, interpolation, segment, &sizes);
        let segment = &*driven;
        if let Some(line) = &mut self.line {
            line.start(segment, parameters, &sizes);
        }
        self.course.start(segment, parameters);
        if self.course.one_step().is_none() {
            self.dynamics.set_parameters(parameters);
        }
        self.observation.set_parameters(parameters);
        self.outputs.set_parameters(parameters);
        self.states.start(
            self.model,
            self.columns,
            parameters,
            &self.course,
            &self.dynamics,
        );
        self.rows.place(true, &self.observation, BLOCK);
        for first in (0..segment.len()).step_by(BLOCK) {
            let len = BLOCK.min(segment.len() - first);
            self.course.advance(segment, first, len)?;
            if self.course.one_step().is_none() {
                for stage in 0..self.course.stages.len() {
                    self.dynamics.evaluate(stage, len, &self.course);
                }
            }
            self.observation.evaluate(0, len, &self.course);
            self.outputs.evaluate(0, len, &self.course);
            self.states
                .sweep(segment, (first, len), &self.course, &self.dynamics);
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
            match &mut self.line {
                Some(line) => line.pass(&block, &mut sink),
                None => sink(&block),
            }
            self.states.carry_over();
        }
        Ok(())
    }
}
