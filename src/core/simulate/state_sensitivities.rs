//! ∂x/∂θ along the samples of a block: sequential in time, packs of parameters side by side.

use super::aligned::Aligned;
use super::columns::Columns;
use super::linearised::Linearised;
use super::one_step_recursion::OneStepRecursion;
use super::pack::{PACK, Pack, packs};
use super::recursion::Recursion;
use super::segment::Segment;
use super::trajectory::Trajectory;
use super::transition_recursion::TransitionRecursion;
use crate::model::{BLOCK, Model};

/// What a product costs where each stage waits for the one before it, beside one that waits for nothing.
const STAGE_COST: usize = 2;

/// ∂x/∂θ at each sample of a block and at the first one behind it.
pub(super) struct StateSensitivities {
    states: usize,
    /// Packs of a row of ∂x/∂θ.
    width: usize,
    /// By sample of the block, then state: a row of packs. One sample more than a block has.
    pub rows: Aligned<Pack>,
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
    pub(super) fn new(model: &Model, columns: &Columns, stages: usize) -> Self {
        let states = model.states.len();
        let width = packs(columns.dynamic.len());
        Self {
            states,
            width,
            rows: Aligned::zeros((BLOCK + 1) * states * width),
            general: General::new(model, columns, stages),
            one_step: OneStepRecursion::default(),
        }
    }

    /// Begins with ∂x0/∂θ.
    pub(super) fn start(
        &mut self,
        model: &Model,
        columns: &Columns,
        parameters: &[f64],
        trajectory: &Trajectory<'_>,
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
        match (trajectory.one_step(), &mut self.general) {
            (Some((one_step, h)), _) => {
                self.one_step
                    .set(one_step, h, trajectory, columns, self.width);
            }
            (None, General::StageByStage(stages)) => stages.place(true, dynamics, BLOCK),
            (None, General::Composed(_)) => {}
        }
    }

    /// Goes along the samples of a block whose states and Jacobians are known.
    pub(super) fn sweep(
        &mut self,
        segment: &Segment,
        (first, len): (usize, usize),
        trajectory: &Trajectory<'_>,
        dynamics: &Linearised<'_>,
    ) {
        let steps = len.min(segment.len() - 1 - first);
        let (stages, range, rows) = (trajectory.stages, (first, steps), &mut self.rows);
        match (trajectory.one_step(), &mut self.general) {
            (Some((one_step, _)), _) => {
                (self.one_step).sweep(one_step, segment, first, steps, trajectory, rows);
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
    pub(super) fn shape(&self) -> (usize, usize) {
        (self.states, self.width)
    }

    /// The end of one block is the beginning of the next.
    pub(super) fn carry_over(&mut self) {
        let sample = self.states * self.width;
        self.rows.copy_within(BLOCK * sample.., 0);
    }
}

#[cfg(test)]
mod tests {
    use super::super::method::{InputInterpolation, Integrator};
    use super::super::segment::Steps;
    use super::*;
    use crate::model::{Start, catalog};

    const SAMPLES: usize = 150;

    /// Uneven steps, so that no model goes by a matrix.
    fn segment(model: &Model) -> Segment {
        let steps: Vec<f64> = (0..SAMPLES - 1)
            .map(|k| 0.02 + 0.001 * (k % 7) as f64)
            .collect();
        let wave = |channel: usize, k: usize| 0.05 * ((1 + channel) as f64 * 0.03 * k as f64).sin();
        Segment {
            label: "test".into(),
            time: (0..SAMPLES).map(|k| k as f64).collect(),
            steps: Steps::Uneven(steps),
            inputs: (0..model.driven_inputs())
                .map(|channel| (0..SAMPLES).map(|k| wave(channel, k)).collect())
                .collect(),
            measured: vec![vec![0.0; SAMPLES]; model.outputs.len()],
        }
    }

    /// ∂x/∂θ behind each sample.
    fn rows(model: &Model, columns: &Columns, parameters: &[f64], general: General) -> Vec<Pack> {
        let mut trajectory = Trajectory::new(model, Integrator::Rk4, InputInterpolation::Linear);
        let stages = trajectory.stages.len();
        let mut dynamics = Linearised::new(&model.dynamics_jacobian.program, stages);
        let mut states = StateSensitivities::new(model, columns, stages);
        states.general = general;
        let segment = segment(model);
        trajectory.start(&segment, parameters);
        dynamics.set_parameters(parameters);
        states.start(model, columns, parameters, &trajectory, &dynamics);
        let sample = states.states * states.width;
        let mut all = Vec::new();
        for first in (0..SAMPLES).step_by(BLOCK) {
            let len = BLOCK.min(SAMPLES - first);
            trajectory.advance(&segment, first, len).expect("bounded");
            (0..stages).for_each(|stage| dynamics.evaluate(stage, len, &trajectory));
            states.sweep(&segment, (first, len), &trajectory, &dynamics);
            all.extend_from_slice(&states.rows[..len * sample]);
            states.carry_over();
        }
        all
    }

    /// Some hundred roundings of 1e-16 a step over 150 steps, relative to the largest value of an entry.
    #[test]
    fn composed_steps_agree_with_stage_by_stage() {
        for document in catalog::all() {
            let model = Model::compile(&document).expect("a catalog model");
            let value = |(i, info): (usize, &crate::model::ParameterInfo)| match info.document.start
            {
                Start::Value(value) => info.unit.to_si(value) * 1.1 + 0.01 * (1.0 + i as f64 / 7.0),
                // a speed, which must not be near zero
                Start::FromData(_) if info.document.unit == "m/s" => 130.0,
                Start::FromData(_) => 0.04,
            };
            let parameters: Vec<f64> = model.parameters.iter().enumerate().map(value).collect();
            let columns = Columns::new(&model, &(0..parameters.len()).collect::<Vec<_>>());
            let stages = Integrator::Rk4.stages().len();
            let stage_by_stage = General::StageByStage(Recursion::new(&model, &columns, stages));
            let composed = General::Composed(TransitionRecursion::new(&model, &columns, stages));
            let expected = rows(&model, &columns, &parameters, stage_by_stage);
            let found = rows(&model, &columns, &parameters, composed);
            assert_eq!(expected.len(), found.len());
            let entries = expected.len() / SAMPLES * PACK;
            let (expected, found) = (expected.as_flattened(), found.as_flattened());
            for entry in 0..entries {
                let of = |all: &[f64]| -> Vec<f64> {
                    all[entry..].iter().step_by(entries).copied().collect()
                };
                let (expected, found) = (of(expected), of(found));
                let largest = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                for (a, b) in expected.iter().zip(&found) {
                    let error = (a - b).abs();
                    assert!(error <= 1e-10 * largest, "{}: {a:e} {b:e}", document.name);
                }
            }
        }
    }
}
