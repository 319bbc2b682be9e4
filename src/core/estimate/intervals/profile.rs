//! The likelihood as a function of one parameter, all others refitted: where it has fallen by so much.
//!
//! With z(v) = √(2 (ln L(θ̂) − max ln L(θ | θ_i = v))), which is linear in v where the likelihood is normal, an end is
//! where z is 1.96. That is looked for by secants, so that two or three refits tell it.

use super::fitted::Fitted;
use super::refit::{Minimum, refit};
use crate::estimate::problem::Problem;
use crate::estimate::report::intervals::IntervalEnd;

/// An end is found where z is this near to what is wanted, as a share of it.
const NEAR: f64 = 0.002;

/// Refits on the way to one end.
const MOST_LOOKS: usize = 14;

/// How often a refit may fail on the way.
const MOST_FAILURES: usize = 4;

/// Beyond so many standard errors nobody looks for an end.
const FARTHEST: f64 = 100.0;

/// One end of an interval, SI.
#[derive(Clone, Copy)]
pub(super) struct End {
    pub kind: IntervalEnd,
    pub value: Option<f64>,
}

/// Both ends for each fall of the likelihood that was asked for.
pub(super) struct Profile {
    /// Lower and upper end, by what z was to be.
    pub ends: Vec<[End; 2]>,
    /// How far -ln L came below that of the estimate; 0 where it did not.
    pub below: f64,
}

/// Follows the likelihood of the unknown at a place until z has each of `targets`, the smallest first. None of an unknown
/// that has no standard error to step by. `least` is -ln L at the estimate.
pub(super) fn profile(
    fitted: &Fitted,
    place: usize,
    least: f64,
    targets: &[f64],
) -> Option<Profile> {
    let error = fitted.conventional[place]?;
    let mut below = 0.0_f64;
    let mut side = |direction: f64| -> Vec<End> {
        let mut side = Side::new(fitted, place, least, direction * error);
        let ends = targets.iter().map(|&target| side.end(target)).collect();
        below = below.max(side.below);
        ends
    };
    let (lower, upper) = (side(-1.0), side(1.0));
    Some(Profile {
        ends: lower.into_iter().zip(upper).map(|(a, b)| [a, b]).collect(),
        below,
    })
}

/// One side of the estimate. Distances are in standard errors.
struct Side<'f> {
    fitted: &'f Fitted,
    /// With the unknown held.
    problem: Problem,
    place: usize,
    least: f64,
    /// One standard error, with the sign of the side.
    step: f64,
    /// How far the parameter's bound is.
    room: f64,
    /// The others refitted, where that was last done, and how far away.
    latest: Option<(f64, Vec<f64>)>,
    /// Distance and z of all refits so far.
    known: Vec<(f64, f64)>,
    below: f64,
}

impl<'f> Side<'f> {
    fn new(fitted: &'f Fitted, place: usize, least: f64, step: f64) -> Self {
        let unknown = fitted.problem.unknowns.at(place);
        let bound = if step > 0.0 {
            unknown.upper
        } else {
            unknown.lower
        };
        Self {
            problem: held(&fitted.problem, place),
            room: ((bound - fitted.theta[place]) / step).max(0.0),
            latest: None,
            known: Vec::new(),
            below: 0.0,
            fitted,
            place,
            least,
            step,
        }
    }

    fn end(&mut self, target: f64) -> End {
        let farthest = self.room.min(FARTHEST);
        let (mut reach, mut failures) = (farthest, 0);
        for _ in 0..MOST_LOOKS {
            let (low, high) = self.around(target);
            if let Some(found) = self.near(target) {
                return self.found(found);
            }
            if low.0 >= farthest {
                break;
            }
            let distance = guess(low, high, target).min(reach);
            if self.look(distance).is_none() {
                failures += 1;
                reach = 0.5 * (low.0 + distance);
                if failures > MOST_FAILURES {
                    return OPEN;
                }
            }
        }
        match self.around(target) {
            (low, Some(high)) => self.found(between(low, high, target)),
            (low, None) if low.0 >= self.room => End {
                kind: IntervalEnd::Bound,
                value: self.found(self.room).value,
            },
            _ => OPEN,
        }
    }

    /// The farthest place where z is less, and the nearest where it is not.
    fn around(&self, target: f64) -> ((f64, f64), Option<(f64, f64)>) {
        let less = self.known.iter().filter(|(_, z)| *z < target);
        let low = less
            .copied()
            .fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
        let more = (self.known.iter()).filter(|(distance, z)| *z >= target && *distance > low.0);
        (low, more.copied().min_by(|a, b| a.0.total_cmp(&b.0)))
    }

    fn near(&self, target: f64) -> Option<f64> {
        let near = |z: f64| (z - target).abs() <= NEAR * target;
        let mut known = self.known.iter();
        known.find(|(_, z)| near(*z)).map(|(distance, _)| *distance)
    }

    fn found(&self, distance: f64) -> End {
        let unknown = self.fitted.problem.unknowns.at(self.place);
        let value = self.fitted.theta[self.place] + distance * self.step;
        End {
            kind: IntervalEnd::Found,
            value: Some(value.clamp(unknown.lower, unknown.upper)),
        }
    }

    /// Refits the others with the unknown held so far away.
    fn look(&mut self, distance: f64) -> Option<()> {
        let value = self.found(distance).value?;
        let index = self.fitted.problem.unknowns.free[self.place];
        self.problem.unknowns.all[index].start = value;
        let minimum = self.minimum(distance)?;
        let fall = minimum.cost - self.least;
        self.below = self.below.max(-fall);
        self.known.push((distance, (2.0 * fall.max(0.0)).sqrt()));
        self.latest = Some((distance, minimum.theta));
        Some(())
    }

    /// From where the others would be if they moved on as they did, or else from the estimate.
    fn minimum(&self, distance: f64) -> Option<Minimum> {
        let mut others = self.fitted.theta.clone();
        others.remove(self.place);
        let onward = self.latest.as_ref().map(|(before, theta)| {
            let share = distance / before;
            let moved = others.iter().zip(theta).enumerate();
            moved
                .map(|(place, (from, to))| {
                    let unknown = self.problem.unknowns.at(place);
                    (from + share * (to - from)).clamp(unknown.lower, unknown.upper)
                })
                .collect()
        });
        let found = onward.and_then(|theta| refit(&self.problem, theta));
        found.or_else(|| refit(&self.problem, others))
    }
}

const OPEN: End = End {
    kind: IntervalEnd::Open,
    value: None,
};

/// The next distance to look at.
fn guess(low: (f64, f64), high: Option<(f64, f64)>, target: f64) -> f64 {
    match high {
        Some(high) => {
            let at = between(low, high, target);
            let room = 0.02 * (high.0 - low.0);
            at.clamp(low.0 + room, high.0 - room)
        }
        None if low.0 == 0.0 => target,
        None => (low.0 * target / low.1).clamp(1.02 * low.0, 3.0 * low.0),
    }
}

fn between(low: (f64, f64), high: (f64, f64), target: f64) -> f64 {
    low.0 + (target - low.1) / (high.1 - low.1) * (high.0 - low.0)
}

/// The problem with the unknown at a place held.
fn held(problem: &Problem, place: usize) -> Problem {
    let index = problem.unknowns.free[place];
    let meant = problem.unknowns.all[index].clone();
    let unknowns = problem.unknowns.with_held(|unknown| {
        (unknown.parameter, unknown.segment) == (meant.parameter, meant.segment)
    });
    let mut own = Problem::new(
        problem.model.clone(),
        problem.segments.clone(),
        unknowns,
        problem.options.clone(),
    );
    for (segment, as_before) in own.segments.iter_mut().zip(&problem.segments) {
        segment.substeps = as_before.substeps;
    }
    own
}
