//! Before flight: inputs that excite what is to be estimated, and the error bounds that a planned maneuver will give.
//!
//! ```text
//! F = Σ_k (∂y_k/∂θ)ᵀ R⁻¹ (∂y_k/∂θ) at a priori θ,   σ_i = √(F⁻¹)_ii   (Cramér-Rao)
//! ```
//!
//! The sensitivities are those of an estimation, R is the noise that is expected, and all free parameters of the model are
//! unknown, initial states and biases with them (Klein and Morelli, Aircraft System Identification, 2006, chapter 9; Maine and Iliff,
//! NASA RP 1168, 1986). Over several maneuvers in one job information adds up, where parameters of a maneuver are
//! eliminated first: F_ss − F_so F_oo⁻¹ F_os.
//!
//! ```text
//! flight     the model at its a priori values, and what comes of inputs
//! bounds     F⁻¹, and what is not told
//! multistep  3-2-1-1 and doublets, scaled to a mode
//! multisine  orthogonal sums of sines with low relative peak factor
//! optimal    steps of least determinant of the covariance
//! maneuver   from what is asked for to inputs
//! ```
//!
//! Invariant: the same plan gives the same designs. Nothing here looks at recordings.

mod bounds;
mod flight;
mod maneuver;
mod multisine;
mod multistep;
mod optimal;
mod report;
mod spec;

pub use report::{
    CorrelatedBound, DesignedInput, DesignedManeuver, DesignedResponse, Designs, PredictedBound,
    SharedBound,
};
pub use spec::{Amplitudes, DesignKind, DesignSpec, ManeuverDesign, MultistepShape};

use nalgebra::DMatrix;

use crate::flight::{Fault, Faults, Unit};
use crate::model::{Model, Per};
use crate::simulate::{InputDesign, Scenario};
use bounds::{Bounds, among, ln_det_covariance};
use flight::{Flight, Flown, departure};
use maneuver::{Made, make};

/// Most maneuvers of a plan.
const MOST_MANEUVERS: usize = 20;

/// Designs the maneuvers of a plan for a model and predicts their bounds. No more work than `most`: samples times free
/// parameters times simulations, over all maneuvers.
///
/// # Errors
/// Every part of the plan that does not fit, by its JSON pointer.
pub fn design(spec: &DesignSpec, model: Model, most: f64) -> Result<Designs, Faults> {
    let mut flight = Flight::of(spec, model)?;
    check(spec, &flight, most)?;
    let mut maneuvers = Vec::new();
    let mut information = Vec::new();
    for (index, asked) in spec.maneuvers.iter().enumerate() {
        let within = |mut fault: Fault| {
            fault.pointer = format!("/maneuvers/{index}/design{}", fault.pointer);
            fault
        };
        let made = make(&mut flight, &asked.design).map_err(within)?;
        let scenario = made
            .scenario
            .clone()
            .unwrap_or_else(|| flight.scenario.clone());
        let inputs = flight.inputs(&scenario).map_err(within)?;
        let flown = flight.fly(inputs.clone()).map_err(|why| {
            let message = format!("the maneuver cannot be simulated: {why}");
            within(Fault::new("", "bad_design", message))
        })?;
        information.push(flown.information.clone());
        maneuvers.push(told(&flight, asked, made, scenario, inputs, &flown));
    }
    let together = together(&flight, &maneuvers, &information);
    Ok(Designs {
        maneuvers,
        together,
    })
}

fn check(spec: &DesignSpec, flight: &Flight, most: f64) -> Result<(), Faults> {
    let mut faults = Vec::new();
    let count = spec.maneuvers.len();
    if !(1..=MOST_MANEUVERS).contains(&count) {
        let message = format!("{count} maneuvers: a plan has from 1 to {MOST_MANEUVERS}");
        faults.push(Fault::new("/maneuvers", "bad_design", message));
    }
    for (index, maneuver) in spec.maneuvers.iter().enumerate() {
        let before = &spec.maneuvers[..index];
        if maneuver.name.trim().is_empty() || before.iter().any(|one| one.name == maneuver.name) {
            let pointer = format!("/maneuvers/{index}/name");
            faults.push(Fault::new(
                pointer,
                "bad_name",
                "each maneuver has a name of its own",
            ));
        }
    }
    let simulations = |maneuver: &ManeuverDesign| match &maneuver.design {
        DesignKind::Optimal { simulations, .. } => *simulations as f64,
        _ => 50.0,
    };
    let sizes = flight.problem.unknowns.len().max(1) * flight.problem.segments[0].len();
    let work: f64 = spec.maneuvers.iter().map(simulations).sum::<f64>() * sizes as f64;
    if work > most {
        let message = format!(
            "samples times free parameters times simulations are {work:.1e} where {most:.1e} are allowed: fewer \"simulations\", a longer step or a shorter duration"
        );
        faults.push(Fault::new("/maneuvers", "too_large", message));
    }
    match faults.is_empty() {
        true => Ok(()),
        false => Err(faults.into()),
    }
}

fn told(
    flight: &Flight,
    asked: &ManeuverDesign,
    made: Made,
    mut scenario: Scenario,
    inputs: Vec<Vec<f64>>,
    flown: &Flown,
) -> DesignedManeuver {
    let time = flight.problem.segments[0].time.clone();
    let designed: Vec<DesignedInput> = (0..inputs.len())
        .map(|place| input(flight, place, &inputs[place], &made))
        .collect();
    limited(flight, &mut scenario, &designed, &time);
    let is_optimal = matches!(asked.design, DesignKind::Optimal { .. });
    DesignedManeuver {
        name: asked.name.clone(),
        inputs: designed,
        responses: responses(flight, flown),
        parameters: parameters(flight, &flown.information),
        ln_det_covariance: ln_det_covariance(&flown.information, &shared(flight)),
        natural_frequency: made.natural_frequency,
        unit_time: made.unit_time,
        reduced_to: made.reduced_to,
        simulations: is_optimal.then_some(made.simulations),
        scenario,
        time,
    }
}

/// Where a limit of rate made ramps of steps, the scenario has the ramps.
fn limited(flight: &Flight, scenario: &mut Scenario, designed: &[DesignedInput], time: &[f64]) {
    for (input, limit) in designed.iter().zip(&flight.rate_limits) {
        let Some(own) = scenario
            .inputs
            .get_mut(&input.name)
            .filter(|_| limit.is_finite())
        else {
            continue;
        };
        own.design = InputDesign::Recorded {
            file: None,
            channel: None,
            time: time.to_vec(),
            values: input.values.iter().map(|value| value - own.trim).collect(),
        };
    }
}

fn input(flight: &Flight, place: usize, samples: &[f64], made: &Made) -> DesignedInput {
    let name = flight.model().inputs[place].name.clone();
    let unit = &flight.input_units[place];
    let step = flight.scenario.step;
    let values: Vec<f64> = samples.iter().map(|u| unit.from_si(*u)).collect();
    let trim = unit.from_si(flight.trim[place]);
    let square: f64 = values.iter().map(|u| (u - trim).powi(2)).sum();
    let before = std::iter::once(&trim).chain(&values);
    let rates = before.zip(&values).map(|(a, b)| (b - a).abs() / step);
    let moving: Vec<f64> = moving(&values, trim);
    let recorded = flight
        .scenario
        .inputs
        .get(&name)
        .map(|input| input.unit.clone());
    DesignedInput {
        unit: recorded.unwrap_or_else(|| flight.model().inputs[place].si.clone()),
        peak: values.iter().map(|u| (u - trim).abs()).fold(0.0, f64::max),
        rms: (square / values.len() as f64).sqrt(),
        energy: square * step,
        rate: rates.fold(0.0, f64::max),
        relative_peak_factor: (moving.len() > 2).then(|| multisine::relative_peak_factor(&moving)),
        harmonics: made.harmonics.get(&name).cloned().unwrap_or_default(),
        values,
        name,
    }
}

/// Deflections from the first that is not trim to the last.
fn moving(values: &[f64], trim: f64) -> Vec<f64> {
    let moves = |u: &&f64| (**u - trim).abs() > 1e-12 * (1.0 + trim.abs());
    let first = values.iter().position(|u| moves(&u));
    let last = values.iter().rposition(|u| moves(&u));
    match (first, last) {
        (Some(first), Some(last)) => values[first..=last].iter().map(|u| u - trim).collect(),
        _ => Vec::new(),
    }
}

fn responses(flight: &Flight, flown: &Flown) -> Vec<DesignedResponse> {
    let outputs = flight.model().outputs.iter().zip(&flown.outputs);
    let response = |(output, series): (&crate::model::Quantity, &Vec<f64>)| {
        let text = flight
            .scenario
            .outputs
            .get(&output.name)
            .map(|o| o.unit.clone());
        let text = text.unwrap_or_else(|| output.si.clone());
        let unit = Unit::parse(&text).unwrap_or(Unit::NONE);
        DesignedResponse {
            name: output.name.clone(),
            departure: departure(series) / unit.scale,
            unit: text,
        }
    };
    outputs.map(response).collect()
}

fn parameters(flight: &Flight, information: &DMatrix<f64>) -> Vec<PredictedBound> {
    const WORTH_TELLING: f64 = 0.9;
    let bounds = Bounds::of(information);
    let count = flight.problem.unknowns.len();
    let correlated = |place: usize| {
        let others = (0..count).filter(|&other| other != place && bounds.errors[other].is_some());
        let all = others.map(|other| (other, bounds.correlation(place, other)));
        let most = all.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        (most.1.abs() > WORTH_TELLING).then(|| CorrelatedBound {
            name: flight.problem.parameter(most.0).name.clone(),
            correlation: most.1,
        })
    };
    let bound = |place: usize| {
        let info = flight.problem.parameter(place);
        let value = info.unit.from_si(flight.problem.unknowns.at(place).start);
        let error = bounds.errors[place].map(|error| error / info.unit.scale);
        PredictedBound {
            name: info.name.clone(),
            unit: info.document.unit.clone(),
            value,
            standard_error: error,
            relative: error
                .filter(|_| value != 0.0)
                .map(|error| error / value.abs()),
            correlated: error.and_then(|_| correlated(place)),
        }
    };
    (0..count).map(bound).collect()
}

/// Places in θ of parameters that all maneuvers have in common.
fn shared(flight: &Flight) -> Vec<usize> {
    let is_shared = |&place: &usize| flight.problem.parameter(place).document.per == Per::Job;
    (0..flight.problem.unknowns.len())
        .filter(is_shared)
        .collect()
}

fn together(
    flight: &Flight,
    maneuvers: &[DesignedManeuver],
    information: &[DMatrix<f64>],
) -> Vec<SharedBound> {
    let shared = shared(flight);
    let mut all = DMatrix::zeros(shared.len(), shared.len());
    for one in information {
        all += among(one, &shared);
    }
    let bounds = Bounds::of(&all);
    let of = |(row, &place): (usize, &usize)| {
        let info = flight.problem.parameter(place);
        let alone = |maneuver: &DesignedManeuver| maneuver.parameters[place].standard_error;
        let told = maneuvers
            .iter()
            .filter(|maneuver| alone(maneuver).is_some());
        let best = told.min_by(|a, b| {
            let error = |one| alone(one).unwrap_or(f64::INFINITY);
            error(a).total_cmp(&error(b))
        });
        let relative = |maneuver: &DesignedManeuver| {
            (maneuver.name.clone(), maneuver.parameters[place].relative)
        };
        SharedBound {
            name: info.name.clone(),
            unit: info.document.unit.clone(),
            standard_error: bounds.errors[row].map(|error| error / info.unit.scale),
            best: best.map(|maneuver| maneuver.name.clone()),
            relative: maneuvers.iter().map(relative).collect(),
        }
    };
    shared.iter().enumerate().map(of).collect()
}
