//! ∂x/∂θ along the samples of a block: sequential in time, packs of parameters side by side.

use super::columns::Columns;
use super::course::Course;
use super::linearised::{BLOCK, Linearised};
use super::one_step_recursion::OneStepRecursion;
use super::pack::{PACK, Pack, packs};
use super::recursion::Recursion;
use super::segment::Segment;
use super::transition_recursion::TransitionRecursion;
use crate::model::Model;

/// What a product costs where each stage waits for the one before it, beside one that waits for nothing.
const STAGE_COST: usize = 2;

/// ∂x/∂θ at each sample of a block and at the first one behind it.
pub(super) struct StateSensitivities {
    states: usize,
    /// Packs of a row of ∂x/∂θ.
    width: usize,
    /// By sample of the block, then state: a row of packs. One sample more than a block has.
    pub rows: Vec<Pack>,
    general: General,
    one_step: OneStepRecursion,
}

/// The way of a model that has no one-step matrix.
pub(super) enum General {
    StageByStage(Recursion),
    Composed(TransitionRecursion),
}

impl General {
    /// Whichever takes fewer vector operations: composing is side by side, but its cost grows with the cube of
    /// the number of states.
    fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
        let stage_by_stage = Recursion::new(model, columns, stages);
        let composed = TransitionRecursion::new(model, columns, stages);
        let (side_by_side, in_turn) = composed.products();
        if side_by_side / PACK + in_turn <= STAGE_COST * stages * stage_by_stage.products() {
            Self::Composed(composed)
        } else {
            Self::StageByStage(stage_by_stage)
        }
    }
}

impl StateSensitivities {
    pub fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
        let states = model.states.len();
        let width = packs(columns.dynamic.len());
        Self {
            states,
            width,
            rows: vec![Pack::default(); (BLOCK + 1) * states * width],
            general: General::new(model, columns, stages),
            one_step: OneStepRecursion::default(),
        }
    }

    /// Begins with ∂x0/∂θ.
    pub fn start(
        &mut self,
        model: &Model,
        columns: &Columns,
        parameters: &[f64],
        course: &Course<'_>,
        dynamics: &Linearised<'_>,
    ) {
        let jacobian = &model.initial_jacobian;
        let mut workspace = jacobian.program.workspace::<f64>();
        jacobian.program.set_parameters(&mut workspace, parameters);
        jacobian.program.run(&mut workspace);
        self.rows.fill(Pack::default());
        for (entry, &(state, parameter)) in jacobian.by_parameter.iter().enumerate() {
            if let Some(column) = columns.dynamic.iter().position(|&p| p == parameter) {
                let result = jacobian.by_state.len() + entry;
                let row = &mut self.rows[state * self.width..(state + 1) * self.width];
                row.as_flattened_mut()[column] = jacobian.program.result(&workspace, result);
            }
        }
        match (course.one_step(), &mut self.general) {
            (Some((one_step, h)), _) => {
                self.one_step.set(one_step, h, course, columns, self.width);
            }
            (None, General::StageByStage(stages)) => stages.place(true, dynamics, BLOCK),
            (None, General::Composed(_)) => {}
        }
    }

    /// Goes along the samples of a block whose states and Jacobians are known.
    pub fn sweep(
        &mut self,
        segment: &Segment,
        (first, len): (usize, usize),
        course: &Course<'_>,
        dynamics: &Linearised<'_>,
    ) {
        let steps = len.min(segment.len() - 1 - first);
        let (stages, range, rows) = (course.stages, (first, steps), &mut self.rows);
        match (course.one_step(), &mut self.general) {
            (Some((one_step, _)), _) => {
                (self.one_step).sweep(one_step, segment, first, steps, course, rows);
            }
            (None, General::StageByStage(general)) => {
                general.place(false, dynamics, steps);
                general.sweep(stages, segment, range, dynamics, rows);
            }
            (None, General::Composed(general)) => {
                general.sweep(stages, segment, range, dynamics, rows);
            }
        }
    }

    /// States, and packs of a row.
    pub fn shape(&self) -> (usize, usize) {
        (self.states, self.width)
    }

    /// The end of one block is the beginning of the next.
    pub fn carry_over(&mut self) {
        let sample = self.states * self.width;
        self.rows.copy_within(BLOCK * sample.., 0);
    }
}
