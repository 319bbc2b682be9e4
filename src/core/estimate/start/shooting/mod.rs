//! Multiple shooting: the trajectory in short intervals, each from an initial state of its own.
//!
//! ```text
//! minimise  J(θ, s) + ½ ρ Σ_j |Φ_j(s_j, θ) − s_(j+1)|²_w   over θ and the nodes s_j, for ρ growing
//! ```
//!
//! Φ_j is the state at the end of interval j (Bock's multiple shooting; the jumps are closed by a growing penalty
//! rather than by constraints, so that each step is one of least squares and its success is told by one number).
//! With ρ small each interval follows what was measured, however wrong θ is and however unstable the aircraft; as ρ
//! grows the jumps close and the cost becomes that of output error. The nodes start from measured states. What
//! comes out is a start: the estimate itself is always that of the whole trajectory.
//!
//! With R estimated, the optima along that way need not lead to the lowest one of the whole trajectory, and from an
//! early one the way down may be long. So output error is tried from more than one ρ, as soon as the whole trajectory
//! explains something, and the best is kept. Where none explains anything, all is done again with R held at what
//! smoothing takes from the measurements.

mod beginning;
mod elimination;
mod intervals;
mod measured;

use std::ops::ControlFlow;

use nalgebra::DVector;

use crate::estimate::descent::gauss_newton::descend;
use crate::estimate::descent::step::{Newton, advanced, held};
use crate::estimate::evaluation::evaluator::Evaluator;
use crate::estimate::likelihood::constants::cost_of_constants;
use crate::estimate::likelihood::weighting::Weighting;
use crate::estimate::problem::Problem;
use crate::estimate::problem::unusable::Unusable;
use crate::estimate::report::progress::unobserved;
use crate::estimate::report::start::{StartKind, StartReport};
use crate::stop;
use beginning::beginning;
use elimination::eliminate;
use intervals::{Cut, Nodes};
use measured::{first_nodes, with_measured_noise};

/// Penalties: the first, how they grow, and the last.
const PENALTY_START: f64 = 1e-2;
const PENALTY_GROWTH: f64 = 10.0;
const PENALTY_END: f64 = 1e10;
/// Steps at the first penalty, which have the longest way to go, and at a later one; and the gain in -ln L below which
/// the next penalty's turn comes.
const MOST_FIRST_STEPS: usize = 40;
const MOST_STEPS: usize = 8;
const SMALL_GAIN: f64 = 0.1;
/// Closed when the whole trajectory costs no more than this above the pieces.
const CLOSED: f64 = 1.0;
/// From how many penalties output error is tried, and how far.
const MOST_DESCENTS: usize = 4;
const DESCENT_ITERATIONS: usize = 20;

/// The damping starts here, grows by a factor after a step that fails, and falls to a share after one that succeeds.
const DAMPING_START: f64 = 1e-3;
const DAMPING_RAISED: f64 = 10.0;
const DAMPING_EASED: f64 = 0.1;
const MOST_TRIALS: usize = 10;

/// How often intervals are halved when the first simulation runs away: its jumps are longer, in the states' noise,
/// than this.
const MOST_HALVINGS: usize = 8;
const RUN_AWAY: f64 = 1e4;

/// Told of each step; may stop.
pub(crate) type Told<'o> = dyn FnMut(&StartReport) -> ControlFlow<()> + 'o;

/// Where shooting led.
pub(crate) struct Shot {
    /// SI, within bounds.
    pub theta: Vec<f64>,
    /// Somebody asked to stop on the way.
    pub stopped: bool,
}

/// A start for output error, from a θ that need not be good for a simulation.
///
/// # Errors
/// Even the shortest intervals leave the range of numbers, or the model is too large for the edit.
pub(crate) fn multiple_shooting(
    problem: &Problem,
    theta: Vec<f64>,
    interval: f64,
    told: &mut Told<'_>,
) -> Result<Shot, Unusable> {
    let constants = cost_of_constants(problem).unwrap_or(f64::INFINITY);
    let mut best: Option<Closed> = None;
    let mut stopped = false;
    // the second way only where the first leads nowhere: it costs as much again
    for measured_noise in [false, true] {
        let way = match measured_noise {
            false => problem.clone(),
            true => with_measured_noise(problem),
        };
        let closed = match stop::droppable(|| shoot(&way, problem, &theta, interval, told)) {
            Ok(Some(closed)) => closed,
            Ok(None) => continue,
            // half a way leads nowhere
            Err(_) => {
                let theta = best.map_or(theta, |best| best.theta);
                return Ok(Shot {
                    theta,
                    stopped: true,
                });
            }
        };
        stopped = closed.stopped;
        if best.as_ref().is_none_or(|best| closed.cost < best.cost) {
            best = Some(closed);
        }
        if stopped || best.as_ref().is_some_and(|best| best.cost < constants) {
            break;
        }
    }
    let best = best.ok_or(Unusable::NotFinite)?;
    Ok(Shot {
        theta: best.theta,
        stopped,
    })
}

/// A trajectory whose jumps were closed, as far as they could be.
struct Closed {
    theta: Vec<f64>,
    /// -ln L of the whole trajectory, infinite where it leaves the range of numbers.
    cost: f64,
    stopped: bool,
}

/// Shoots along the costs of `way`, the problem or one with another R; `None` where even the shortest intervals leave
/// the range of numbers.
fn shoot(
    way: &Problem,
    problem: &Problem,
    theta: &[f64],
    interval: f64,
    told: &mut Told<'_>,
) -> Option<Closed> {
    let halves = (0..=MOST_HALVINGS).map(|i| interval / f64::from(1 << i));
    let mut found = None;
    for length in halves {
        let cut = Cut::new(way, length)?;
        let (nodes, noise) = first_nodes(&cut, theta);
        if let Some(point) = Point::at(&cut, theta.to_vec(), nodes, &noise) {
            let runs_away = point.jump(&cut) > RUN_AWAY;
            found = Some((cut, point, noise));
            if !runs_away {
                break;
            }
        }
    }
    let (cut, point, noise) = found?;
    Some(close(&cut, problem, point, &noise, told))
}

/// θ and nodes, and what is known there.
struct Point {
    theta: Vec<f64>,
    nodes: Nodes,
    weighting: Weighting,
    /// Σ (jump / noise)²
    jumps: f64,
}

impl Point {
    fn at(cut: &Cut<'_>, theta: Vec<f64>, nodes: Nodes, noise: &DVector<f64>) -> Option<Self> {
        let simulated = cut.simulate(&theta, &nodes)?;
        let problem = cut.problem;
        let weighting = Weighting::at(problem, &theta, &simulated.residuals).ok()?;
        let size = |jump: DVector<f64>| jump.component_div(noise).norm_squared();
        let mut jumps = 0.0;
        for (segment, (ends, nodes)) in simulated.ends.iter().zip(&nodes).enumerate() {
            jumps += size(beginning(problem, segment, &theta, &nodes[0])?.jump);
            jumps += ends
                .iter()
                .zip(&nodes[1..])
                .map(|(end, next)| size(end - next))
                .sum::<f64>();
        }
        jumps.is_finite().then_some(Self {
            theta,
            nodes,
            weighting,
            jumps,
        })
    }

    /// Root mean square of the jumps, in the states' noise.
    fn jump(&self, cut: &Cut<'_>) -> f64 {
        let intervals: usize = cut.intervals.iter().map(Vec::len).sum();
        (self.jumps / (intervals * self.nodes[0][0].len().max(1)) as f64).sqrt()
    }

    fn merit(&self, penalty: f64) -> f64 {
        self.weighting.cost + 0.5 * penalty * self.jumps
    }
}

/// Closes the jumps, penalty by penalty.
fn close(
    cut: &Cut<'_>,
    problem: &Problem,
    mut point: Point,
    noise: &DVector<f64>,
    told: &mut Told<'_>,
) -> Closed {
    let mut evaluator = Evaluator::new(cut.problem);
    let constants = cost_of_constants(cut.problem);
    let (mut damping, mut penalty) = (DAMPING_START, PENALTY_START);
    let (mut steps, mut descents) = (0, 0);
    let mut stopped = false;
    let mut best: Option<(f64, Vec<f64>)> = None;
    let mut short = problem.clone();
    short.options.max_iterations = DESCENT_ITERATIONS;
    while penalty <= PENALTY_END {
        let most = if penalty > PENALTY_START {
            MOST_STEPS
        } else {
            MOST_FIRST_STEPS
        };
        for _ in 0..most {
            let before = point.merit(penalty);
            let Some(next) = step(cut, &point, noise, penalty, &mut damping) else {
                damping = DAMPING_START;
                break;
            };
            point = next;
            steps += 1;
            let report = report(cut, &point, steps, penalty);
            stopped = told(&report).is_break();
            if stopped || before - point.merit(penalty) < SMALL_GAIN {
                break;
            }
        }
        let whole = evaluator.cost(&point.theta).unwrap_or(f64::INFINITY);
        let closed = whole < point.weighting.cost + CLOSED;
        if closed || constants.is_some_and(|constants| whole < constants) {
            descents += 1;
            let end = descend(&short, point.theta.clone(), &mut unobserved);
            let end = end.map(|end| (end.last.weighting.cost, end.last.theta));
            if let Ok(end) = end
                && best.as_ref().is_none_or(|best| end.0 < best.0)
            {
                best = Some(end);
            }
        }
        if stopped || closed || descents == MOST_DESCENTS {
            break;
        }
        penalty *= PENALTY_GROWTH;
    }
    let (cost, theta) = best.unwrap_or_else(|| {
        let cost = Evaluator::new(problem).cost(&point.theta);
        (cost.unwrap_or(f64::INFINITY), point.theta)
    });
    Closed {
        theta,
        cost,
        stopped,
    }
}

/// One Levenberg-Marquardt step at a penalty; `None` where none lowers the merit.
fn step(
    cut: &Cut<'_>,
    point: &Point,
    noise: &DVector<f64>,
    penalty: f64,
    damping: &mut f64,
) -> Option<Point> {
    let problem = cut.problem;
    let pieces = cut.pieces(&point.theta, &point.nodes, &point.weighting.inverse)?;
    let beginnings = (0..problem.segments.len())
        .map(|segment| beginning(problem, segment, &point.theta, &point.nodes[segment][0]))
        .collect::<Option<Vec<_>>>()?;
    let weights = noise.map(|noise| penalty / (noise * noise));
    for _ in 0..MOST_TRIALS {
        let reduced = eliminate(&beginnings, &pieces, &point.nodes, &weights, *damping);
        if let Some(reduced) = reduced {
            let held = held(&problem.unknowns, &point.theta, &reduced.descent);
            let newton = Newton::new(&reduced.information, None, &reduced.descent, &held)?;
            let theta = advanced(&problem.unknowns, &point.theta, &newton.step(*damping), 1.0);
            let moved = theta.iter().zip(&point.theta).map(|(a, b)| a - b);
            let moved = reduced.nodes(&DVector::from_iterator(theta.len(), moved));
            let mut nodes = point.nodes.clone();
            for (node, step) in nodes.iter_mut().flatten().zip(moved.iter().flatten()) {
                *node += step;
            }
            if let Some(next) = Point::at(cut, theta, nodes, noise)
                && next.merit(penalty) < point.merit(penalty)
            {
                *damping *= DAMPING_EASED;
                return Some(next);
            }
        }
        *damping = (*damping * DAMPING_RAISED).max(DAMPING_START);
    }
    None
}

fn report(cut: &Cut<'_>, point: &Point, steps: usize, penalty: f64) -> StartReport {
    let intervals: usize = cut.intervals.iter().map(Vec::len).sum();
    StartReport {
        method: StartKind::MultipleShooting,
        evaluations: steps,
        cost: Some(point.weighting.cost),
        text: format!(
            "multiple shooting, {intervals} intervals: jumps of {:.1e} of the states' noise, penalty {penalty:.0e}",
            point.jump(cut)
        ),
    }
}
