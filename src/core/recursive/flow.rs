//! From one sample to the next: x, and its derivatives by the x before and by θ, by the stages of the integrator.

use crate::model::{Jacobian, Model, Workspace};
use crate::simulate::{InputInterpolation, Stage, between};

/// Inputs at both ends of an interval, and when it is.
pub(super) struct Interval<'s> {
    pub before: &'s [f64],
    pub after: &'s [f64],
    /// Seconds from the first sample to its begin.
    pub elapsed: f64,
    /// s.
    pub length: f64,
    /// Integration steps.
    pub count: usize,
}

/// The machinery, made once.
pub(super) struct Flow {
    stages: &'static [Stage],
    interpolation: InputInterpolation,
    dynamics: Workspace<f64>,
    slopes: Workspace<f64>,
    /// By parameter of the model: its column.
    column: Vec<Option<usize>>,
    width: usize,
    x: Rates,
    /// ∂x, row by state: by the states before, then by the parameters.
    tangent: Rates,
}

/// A quantity within a step: at the stage, its slope there, and the sum of slopes.
struct Rates {
    at: Vec<f64>,
    slope: Vec<f64>,
    sum: Vec<f64>,
}

impl Rates {
    fn new(len: usize) -> Self {
        Self {
            at: vec![0.0; len],
            slope: vec![0.0; len],
            sum: vec![0.0; len],
        }
    }

    /// To a stage, `advance` seconds along the slope of the one before it.
    fn advance(&mut self, from: &[f64], advance: f64, is_first: bool) {
        if is_first {
            self.at.copy_from_slice(from);
            return;
        }
        for ((at, from), slope) in self.at.iter_mut().zip(from).zip(&self.slope) {
            *at = from + advance * slope;
        }
    }

    fn add(&mut self, weight: f64) {
        for (sum, slope) in self.sum.iter_mut().zip(&self.slope) {
            *sum += weight * slope;
        }
    }
}

impl Flow {
    /// `parameters` are those that are derived by, in the order of their columns.
    pub(super) fn new(
        model: &Model,
        stages: &'static [Stage],
        interpolation: InputInterpolation,
        parameters: &[usize],
    ) -> Self {
        let states = model.states.len();
        let width = states + parameters.len();
        let mut column = vec![None; model.parameters.len()];
        for (place, &parameter) in parameters.iter().enumerate() {
            column[parameter] = Some(states + place);
        }
        Self {
            stages,
            interpolation,
            dynamics: model.dynamics.workspace(),
            slopes: model.dynamics_jacobian.program.workspace(),
            column,
            width,
            x: Rates::new(states),
            tangent: Rates::new(states * width),
        }
    }

    pub(super) fn set_parameters(&mut self, model: &Model, parameters: &[f64]) {
        model
            .dynamics
            .set_parameters(&mut self.dynamics, parameters);
        let program = &model.dynamics_jacobian.program;
        program.set_parameters(&mut self.slopes, parameters);
    }

    /// Takes `state` through an interval, and `tangent` with it, which is ∂x by x and θ to begin with.
    pub(super) fn run(
        &mut self,
        model: &Model,
        interval: &Interval<'_>,
        state: &mut [f64],
        tangent: &mut [f64],
    ) {
        for part in 0..interval.count {
            self.part(model, interval, part, state, tangent);
        }
    }

    fn part(
        &mut self,
        model: &Model,
        interval: &Interval<'_>,
        part: usize,
        state: &mut [f64],
        tangent: &mut [f64],
    ) {
        let count = interval.count as f64;
        let h = interval.length / count;
        self.x.sum.fill(0.0);
        self.tangent.sum.fill(0.0);
        for (s, stage) in self.stages.iter().enumerate() {
            self.x.advance(state, h * stage.advance, s == 0);
            self.tangent.advance(tangent, h * stage.advance, s == 0);
            let node = (part as f64 + stage.node) / count;
            self.slopes_at(model, interval, node);
            self.x.add(h * stage.weight);
            self.tangent.add(h * stage.weight);
        }
        add(state, &self.x.sum);
        add(tangent, &self.tangent.sum);
    }

    /// Slopes of x and ∂x at a stage, a share of the interval behind its begin.
    fn slopes_at(&mut self, model: &Model, interval: &Interval<'_>, node: f64) {
        let jacobian = &model.dynamics_jacobian;
        let time = interval.elapsed + node * interval.length;
        let share = self.interpolation.share_of_next(node);
        let programs = [
            (&model.dynamics, &mut self.dynamics),
            (&jacobian.program, &mut self.slopes),
        ];
        for (program, workspace) in programs {
            program.states(workspace).copy_from_slice(&self.x.at);
            let ends = interval.before.iter().zip(interval.after);
            for (to, (&before, &after)) in program.inputs(workspace).iter_mut().zip(ends) {
                *to = between(before, after, share);
            }
            *program.time(workspace) = time;
            program.run(workspace);
        }
        model.dynamics.results(&self.dynamics, &mut self.x.slope);
        self.tangent.slope.fill(0.0);
        along(
            jacobian,
            &self.slopes,
            &self.column,
            self.width,
            &self.tangent.at,
            &mut self.tangent.slope,
        );
    }
}

/// to += ∂h/∂x from + ∂h/∂θ, row by row.
pub(super) fn along(
    jacobian: &Jacobian,
    at: &Workspace<f64>,
    column: &[Option<usize>],
    width: usize,
    from: &[f64],
    to: &mut [f64],
) {
    jacobian.add_by_state(at, width, from, to);
    jacobian.add_by_parameter(at, column, width, to);
}

fn add(to: &mut [f64], what: &[f64]) {
    to.iter_mut().zip(what).for_each(|(to, what)| *to += what);
}
