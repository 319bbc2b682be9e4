//! Parts of a recording that begin in mid-motion: their initial state is estimated, since the model's is that of trimmed
//! flight. A part that begins at rest keeps the model's.

use super::stretch::Stretch;
use crate::estimate::{Unknown, Unknowns};
use crate::flight::{Finding, FindingCode, Severity};
use crate::job::spec::{JobKind, JobSpec};
use crate::model::{Edit, EditKind, Model, ModelDocument, Per};
use crate::simulate::Segment;

/// Samples by which it is judged whether a part begins in motion.
const WINDOW: usize = 12;
/// The slope of an output over them, in its standard errors, from which on it moves.
const MOVES: f64 = 5.0;

/// The parameters by which the initial states of some segments are estimated.
pub(super) struct FreeInitial {
    /// With those parameters in it.
    pub document: ModelDocument,
    pub names: Vec<String>,
    /// By segment of the estimation: whether its initial state is estimated.
    pub segments: Vec<bool>,
}

impl FreeInitial {
    /// `None` where no part begins in mid-motion behind a gap, or where all initial states that the outputs can see
    /// are estimated anyway.
    pub(super) fn of(
        spec: &JobSpec,
        document: &ModelDocument,
        model: &Model,
        fitted: &[(Segment, &Stretch<'_>)],
    ) -> Option<Self> {
        let segments: Vec<bool> = fitted
            .iter()
            .map(|(segment, stretch)| stretch.is_behind_gap && is_moving(segment))
            .collect();
        if !segments.contains(&true) {
            return None;
        }
        let (mut edited, mut names) = (document.clone(), Vec::new());
        let seen = seen(model);
        let held = model.states.iter().zip(seen);
        for (state, _) in held.filter(|(state, seen)| *seen && is_held(document, &state.name)) {
            // what the job says of it itself is meant
            let is_own =
                |edit: &Edit| edit.kind == EditKind::InitialState && edit.target == state.name;
            if spec.edits.iter().any(is_own) {
                continue;
            }
            // a state whose initial value takes no parameter more stays as it is
            let Ok(found) = Edit::new(EditKind::InitialState, &state.name).apply(&edited) else {
                continue;
            };
            edited = found.document;
            names.extend(found.added.into_iter().map(|added| added.name));
        }
        (!names.is_empty()).then_some(Self {
            document: edited,
            names,
            segments,
        })
    }

    /// What is done about the parts that begin in mid-motion.
    pub(super) fn finding(&self, kind: JobKind, fitted: &[(Segment, &Stretch<'_>)]) -> Finding {
        let moving = fitted
            .iter()
            .zip(&self.segments)
            .filter(|(_, moves)| **moves);
        let labels: Vec<&str> = moving
            .map(|((segment, _), _)| segment.label.as_str())
            .collect();
        let begin = format!(
            "behind a gap and in mid-motion begin: {}",
            labels.join(", ")
        );
        if kind == JobKind::Diagnose {
            let message = format!("{begin}; their initial state is held where the model has it");
            let remedy = "say \"gaps\": \"through\" beside the maneuver's \"id\", or choose \"rows\" that begin in steady flight";
            return Finding::new(FindingCode::HeldInitialState, message, remedy);
        }
        let message = format!(
            "{begin}; their initial state is estimated, by {}",
            self.names.join(", ")
        );
        let remedy = "nothing; where the model's initial state is meant, say so by an edit of the kind initial_state whose parameter is fixed";
        Finding::new(FindingCode::HeldInitialState, message, remedy)
            .with_severity(Severity::Note)
            .of_parameters(&self.names)
    }

    /// The unknowns of the estimation, with these parameters held at nothing where a part begins at rest.
    pub(super) fn hold(&self, model: &Model, unknowns: &Unknowns) -> Unknowns {
        hold(&self.names, &self.segments, model, unknowns)
    }
}

/// Unknowns with some parameters held in the segments that do not move.
fn hold(names: &[String], moves: &[bool], model: &Model, unknowns: &Unknowns) -> Unknowns {
    unknowns.with_held(|unknown: &Unknown| {
        let name = &model.parameters[unknown.parameter].name;
        let moves = unknown.segment.is_some_and(|segment| moves[segment]);
        names.contains(name) && !moves
    })
}

/// The unknowns of one segment that is predicted, with the parameters of initial states held unless it begins in
/// mid-motion behind a gap.
pub(super) fn hold_predicted(
    names: &[String],
    model: &Model,
    (segment, stretch): (&Segment, &Stretch<'_>),
    unknowns: &Unknowns,
) -> Unknowns {
    let moves = stretch.is_behind_gap && is_moving(segment);
    hold(names, &[moves], model, unknowns)
}

/// Whether some output moves at the beginning, by far more than its noise.
fn is_moving(segment: &Segment) -> bool {
    segment.measured.iter().any(|series| {
        let samples = (0..segment.len()).filter(|&k| series[k].is_finite());
        let (time, values): (Vec<f64>, Vec<f64>) = samples
            .take(WINDOW)
            .map(|k| (segment.time[k], series[k]))
            .unzip();
        slope(&time, &values).is_some_and(|(slope, error)| slope.abs() > MOVES * error)
    })
}

/// The slope of a straight line through samples, and its standard error.
fn slope(time: &[f64], values: &[f64]) -> Option<(f64, f64)> {
    let count = values.len();
    if count < WINDOW / 2 {
        return None;
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count as f64;
    let (middle, level) = (mean(time), mean(values));
    let pairs = || {
        time.iter()
            .zip(values)
            .map(|(t, v)| (t - middle, v - level))
    };
    let spread: f64 = pairs().map(|(t, _)| t * t).sum();
    let slope = pairs().map(|(t, v)| t * v).sum::<f64>() / spread;
    let left: f64 = pairs().map(|(t, v)| (v - slope * t).powi(2)).sum();
    let error = (left / (count - 2) as f64 / spread).sqrt();
    (spread > 0.0 && slope.is_finite()).then_some((slope, error))
}

/// Whether a state begins where the model has it, and not at a parameter of each segment's own that is estimated.
fn is_held(document: &ModelDocument, state: &str) -> bool {
    let initial = document.states.get(state).map(|state| state.initial.trim());
    let parameter = initial.and_then(|initial| document.parameters.get(initial));
    parameter.is_none_or(|parameter| parameter.fixed || parameter.per != Per::Maneuver)
}

/// By state: whether an output shows it, by itself or through the motion of one that an output shows.
fn seen(model: &Model) -> Vec<bool> {
    let mut seen = vec![false; model.states.len()];
    for &(_, state) in &model.observation_jacobian.by_state {
        seen[state] = true;
    }
    for _ in 0..model.states.len() {
        for &(row, state) in &model.dynamics_jacobian.by_state {
            seen[state] |= seen[row];
        }
    }
    seen
}
