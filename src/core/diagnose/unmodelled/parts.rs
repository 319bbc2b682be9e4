//! Parts of the flights: where a dependence is learned, and where it then has to hold.
//!
//! Flights that were held out are where it has to hold. Where there are none each flight takes its turn, of many a quarter
//! of them, and of a lone one each quarter of it.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::flown::{Flown, Samples};
use super::metric::Metric;
use super::normal::Normal;
use super::responses::Response;
use super::smoothness::{Posterior, Smoothness};
use crate::diagnose::colour::Colour;

/// Parts of a lone flight, or of many, at most.
const PARTS: usize = 4;

/// One way to part the flights.
pub(super) struct Parted {
    /// Flights of which all or a part is learned from.
    learning: Vec<usize>,
    /// Flights in which it has to hold.
    holding: Vec<usize>,
    train: Metric<'static>,
    normal: Normal,
    test: Metric<'static>,
    /// Sensitivities to what is not estimated anew where it has to hold.
    carried: DMatrix<f64>,
    /// How far that moves without a force.
    alone: DVector<f64>,
    /// What any force could explain where it has to hold, less what it would of noise.
    pub possible: f64,
    /// The force there as it is estimated by itself.
    pub held_out: Posterior,
}

/// Which samples are learned from and which are to hold.
struct Plan {
    learning: Vec<usize>,
    holding: Vec<usize>,
    /// Of a lone flight: the block that has to hold.
    block: Option<usize>,
}

fn plans(flown: &Flown) -> Vec<Plan> {
    let flights = flown.problem.segments.len();
    if flown.fitted < flights {
        return vec![Plan {
            learning: (0..flown.fitted).collect(),
            holding: (flown.fitted..flights).collect(),
            block: None,
        }];
    }
    if flights > 1 {
        let folds = flights.min(PARTS);
        let without = |fold: usize| {
            let (holding, learning) = (0..flights).partition(|flight| flight % folds == fold);
            Plan {
                learning,
                holding,
                block: None,
            }
        };
        return (0..folds).map(without).collect();
    }
    let block = |block: usize| Plan {
        learning: vec![0],
        holding: vec![0],
        block: Some(block),
    };
    (0..PARTS).map(block).collect()
}

impl Plan {
    /// The residual where samples are learned from, or where they have to hold; NaN elsewhere.
    fn part(&self, flown: &Flown, holds: bool) -> Vec<f64> {
        let mut part = vec![f64::NAN; flown.samples.layout.len];
        let flights = if holds { &self.holding } else { &self.learning };
        let series = flown.samples.layout.series.iter();
        for series in series.filter(|series| flights.contains(&series.segment)) {
            let length = series.range.len();
            for (k, at) in series.range.clone().enumerate() {
                let block = (k * PARTS / length.max(1)).min(PARTS - 1);
                if self.block.is_none_or(|held| (held == block) == holds) {
                    part[at] = flown.samples.residual[at];
                }
            }
        }
        part
    }

    /// Whether an unknown is estimated anew where a dependence has to hold.
    fn is_anew(&self, flown: &Flown, place: usize) -> bool {
        let own = flown.problem.unknowns.at(place).segment;
        own.is_some_and(|flight| !self.learning.contains(&flight))
    }
}

/// All ways to part the flights. `None` where something is not a number.
pub(super) fn all(flown: &Flown, responses: &[Response], colour: &Colour) -> Option<Vec<Parted>> {
    let plans = plans(flown).into_iter();
    plans
        .map(|plan| Parted::of(plan, flown, responses, colour))
        .collect()
}

impl Parted {
    fn of(plan: Plan, flown: &Flown, responses: &[Response], colour: &Colour) -> Option<Self> {
        let chosen = |flights: &[usize]| -> Vec<&Response> {
            flights.iter().map(|&flight| &responses[flight]).collect()
        };
        let samples = Samples {
            residual: plan.part(flown, false),
            ..flown.samples.clone()
        };
        let train = Metric::new(Cow::Owned(samples), colour.clone())?;
        let normal = train.normal(&chosen(&plan.learning));
        let alone = train.moved_alone();
        let (mut own, mut carried) = (
            flown.samples.declared.clone(),
            flown.samples.declared.clone(),
        );
        for place in 0..own.ncols() {
            let other = if plan.is_anew(flown, place) {
                &mut carried
            } else {
                &mut own
            };
            other.column_mut(place).fill(0.0);
        }
        let moved = &carried * &alone;
        let part = plan.part(flown, true);
        let samples = Samples {
            residual: part.iter().zip(&moved).map(|(e, y)| e - y).collect(),
            declared: own,
            layout: flown.samples.layout.clone(),
        };
        let test = Metric::new(Cow::Owned(samples), colour.clone())?;
        let responses = chosen(&plan.holding);
        let held = test.normal(&responses);
        let counts: Vec<usize> = responses.iter().map(|r| r.columns.ncols()).collect();
        let smoothness = Smoothness::all(&counts)?;
        let held_out = Posterior::likeliest((test.clear, test.samples), &held, &smoothness)?;
        let explained = held.moment.dot(&held_out.sizes);
        Some(Self {
            possible: explained - held_out.noise.powi(2) * held_out.freedom,
            learning: plan.learning,
            holding: plan.holding,
            train,
            normal,
            test,
            carried,
            alone,
            held_out,
        })
    }

    /// By how much the squared errors fall where a force has to hold that is learned elsewhere. The force is made of a few
    /// numbers, `made` by flight; `learn` finds them.
    pub(super) fn gain(
        &self,
        responses: &[Response],
        made: &[DMatrix<f64>],
        learn: impl Fn((f64, f64), &Normal) -> Option<DVector<f64>>,
    ) -> Option<f64> {
        let together = stacked(made, &self.learning);
        let seen = self.normal.through(&together);
        let numbers = learn((self.train.clear, self.train.samples), &seen)?;
        let moved = self.train.moved(&self.normal, &(&together * &numbers)) - &self.alone;
        let mut error = self.test.residual();
        error -= &self.carried * moved;
        for &flight in &self.holding {
            let response = &responses[flight];
            let sizes = &made[flight] * &numbers;
            let mut rows = error.rows_mut(response.rows.start, response.rows.len());
            rows -= &response.columns * sizes;
        }
        Some(self.test.clear - self.test.length(error.as_slice()))
    }
}

/// What a force is made of, over some flights.
pub(super) fn stacked(made: &[DMatrix<f64>], flights: &[usize]) -> DMatrix<f64> {
    let rows = flights.iter().map(|&flight| made[flight].nrows()).sum();
    let columns = made.first().map_or(0, DMatrix::ncols);
    let mut all = DMatrix::zeros(rows, columns);
    let mut first = 0;
    for &flight in flights {
        let part = &made[flight];
        all.rows_mut(first, part.nrows()).copy_from(part);
        first += part.nrows();
    }
    all
}
