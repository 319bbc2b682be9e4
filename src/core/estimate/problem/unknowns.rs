//! The unknowns of a problem: parameters of the model, one for all segments or one for each.

use crate::model::{Model, Per, Prior};

/// One unknown, SI.
#[derive(Clone, PartialEq, Debug)]
pub struct Unknown {
    /// Index of the model's parameter.
    pub parameter: usize,
    /// The segment it belongs to, where each has its own.
    pub segment: Option<usize>,
    /// The start value; of a fixed one the value.
    pub start: f64,
    /// The smallest value it may take; -∞ where it is free.
    pub lower: f64,
    /// The largest value it may take; ∞ where it is free.
    pub upper: f64,
    /// Whether it is held at its start value.
    pub fixed: bool,
    /// Knowledge of it from before the data, SI.
    pub prior: Option<Prior>,
}

/// All unknowns, and where each segment finds its parameters.
#[derive(Clone, PartialEq, Debug)]
pub struct Unknowns {
    /// Free and fixed ones, by parameter of the model, then segment.
    pub all: Vec<Unknown>,
    /// Indices into `all` of those that are free; θ has them in this order.
    pub free: Vec<usize>,
    /// By segment, then parameter of the model: index into `all`.
    places: Vec<Vec<usize>>,
    /// By index into `all`: place in θ.
    place_in_theta: Vec<Option<usize>>,
}

impl Unknowns {
    /// Lays out the parameters of `model` over `segments`; `start(parameter, segment)` gives start values in SI.
    pub fn new<E>(
        model: &Model,
        segments: usize,
        mut start: impl FnMut(usize, usize) -> Result<f64, E>,
    ) -> Result<Self, E> {
        let mut all = Vec::new();
        let mut places = vec![vec![0; model.parameters.len()]; segments];
        for (parameter, info) in model.parameters.iter().enumerate() {
            let bound =
                |value: Option<f64>, open: f64| value.map_or(open, |value| info.unit.to_si(value));
            let lower = bound(info.document.lower, f64::NEG_INFINITY);
            let upper = bound(info.document.upper, f64::INFINITY);
            let fixed = info.document.fixed;
            let prior = info.document.prior.map(|prior| prior.in_si(&info.unit));
            let own = info.document.per == Per::Maneuver;
            for (segment, places) in places.iter_mut().enumerate() {
                if segment == 0 || own {
                    let start = start(parameter, segment)?.clamp(lower, upper);
                    let segment = own.then_some(segment);
                    all.push(Unknown {
                        parameter,
                        segment,
                        start,
                        lower,
                        upper,
                        fixed,
                        prior,
                    });
                }
                places[parameter] = all.len() - 1;
            }
        }
        Ok(Self::of(all, places))
    }

    fn of(all: Vec<Unknown>, places: Vec<Vec<usize>>) -> Self {
        let free: Vec<usize> = (0..all.len()).filter(|&i| !all[i].fixed).collect();
        let mut place_in_theta = vec![None; all.len()];
        free.iter()
            .enumerate()
            .for_each(|(place, &i)| place_in_theta[i] = Some(place));
        Self {
            all,
            free,
            places,
            place_in_theta,
        }
    }

    /// The same, with parameters that `value` knows held there.
    pub fn with_shared_held(&self, value: impl Fn(usize) -> Option<f64>) -> Self {
        let hold = |unknown: &Unknown| match value(unknown.parameter) {
            Some(value) => Unknown {
                start: value,
                fixed: true,
                ..unknown.clone()
            },
            None => unknown.clone(),
        };
        Self::of(self.all.iter().map(hold).collect(), self.places.clone())
    }

    /// The same, with the unknowns that `is_meant` picks held at their start.
    #[must_use]
    pub fn with_held(&self, is_meant: impl Fn(&Unknown) -> bool) -> Self {
        let hold = |unknown: &Unknown| Unknown {
            fixed: unknown.fixed || is_meant(unknown),
            ..unknown.clone()
        };
        Self::of(self.all.iter().map(hold).collect(), self.places.clone())
    }

    /// The same, with unknowns that are free in other segments only ([`Parameter::only_in`]) held at zero, or at the bound
    /// next to it; `is_called` says whether a segment has a label.
    ///
    /// [`Parameter::only_in`]: crate::model::Parameter::only_in
    #[must_use]
    pub fn held_elsewhere(&self, model: &Model, is_called: impl Fn(usize, &str) -> bool) -> Self {
        let hold = |unknown: &Unknown| {
            let only_in = &model.parameters[unknown.parameter].document.only_in;
            let is_meant = |segment| only_in.iter().any(|label| is_called(segment, label));
            match unknown.segment {
                Some(segment) if !only_in.is_empty() && !is_meant(segment) => Unknown {
                    start: 0.0_f64.clamp(unknown.lower, unknown.upper),
                    fixed: true,
                    ..unknown.clone()
                },
                _ => unknown.clone(),
            }
        };
        Self::of(self.all.iter().map(hold).collect(), self.places.clone())
    }

    /// The same, with each at a value, in the order of `all`: free ones start there, the others are held there.
    #[must_use]
    pub fn with_starts(&self, values: &[f64]) -> Self {
        let at = |(unknown, start): (&Unknown, &f64)| Unknown {
            start: *start,
            ..unknown.clone()
        };
        Self::of(
            self.all.iter().zip(values).map(at).collect(),
            self.places.clone(),
        )
    }

    /// The same, with `more` parameters behind those of the model, free in each segment, that start at zero.
    #[must_use]
    pub(crate) fn with_more(&self, more: usize) -> Self {
        let (mut all, mut places) = (self.all.clone(), self.places.clone());
        for (segment, places) in places.iter_mut().enumerate() {
            for _ in 0..more {
                all.push(Unknown {
                    parameter: places.len(),
                    segment: Some(segment),
                    start: 0.0,
                    lower: f64::NEG_INFINITY,
                    upper: f64::INFINITY,
                    fixed: false,
                    prior: None,
                });
                places.push(all.len() - 1);
            }
        }
        Self::of(all, places)
    }

    /// Unknowns that `is_meant` picks are no less than `least`, and start no lower.
    pub fn raise_lower(&mut self, least: f64, is_meant: impl Fn(&Unknown) -> bool) {
        for unknown in self.all.iter_mut().filter(|unknown| is_meant(unknown)) {
            unknown.lower = unknown.lower.max(least);
            unknown.start = unknown.start.max(unknown.lower);
        }
    }

    /// Start values of the free unknowns.
    pub fn start(&self) -> Vec<f64> {
        self.free.iter().map(|&i| self.all[i].start).collect()
    }

    /// All parameters of the model as `segment` sees them for θ.
    pub fn parameters(&self, segment: usize, theta: &[f64], to: &mut Vec<f64>) {
        to.clear();
        to.extend(
            self.places[segment]
                .iter()
                .map(|&i| match self.place_in_theta[i] {
                    Some(place) => theta[place],
                    None => self.all[i].start,
                }),
        );
    }

    /// Where `segment`'s value of a parameter of the model stands in θ; `None` when fixed.
    pub fn place(&self, segment: usize, parameter: usize) -> Option<usize> {
        self.place_in_theta[self.places[segment][parameter]]
    }

    /// The unknown at a place of θ.
    pub fn at(&self, place: usize) -> &Unknown {
        &self.all[self.free[place]]
    }

    /// The length of θ: free unknowns.
    pub fn len(&self) -> usize {
        self.free.len()
    }

    /// Whether nothing is free.
    pub fn is_empty(&self) -> bool {
        self.free.is_empty()
    }
}
