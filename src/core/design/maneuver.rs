//! One maneuver, from how it is asked for to its inputs.

use indexmap::IndexMap;

use super::flight::Flight;
use super::optimal::Search;
use super::spec::{DesignKind, MultistepShape};
use super::{multisine, multistep};
use crate::flight::{Fault, escape};
use crate::model::Per;
use crate::simulate::{InputDesign, Scenario};

/// Inputs that were made, and what was chosen on the way.
#[derive(Default)]
pub(super) struct Made {
    pub scenario: Option<Scenario>,
    /// rad/s
    pub natural_frequency: Option<f64>,
    /// s
    pub unit_time: Option<f64>,
    /// By moved input: harmonics of the period.
    pub harmonics: IndexMap<String, Vec<usize>>,
    /// What amplitudes were multiplied by to keep responses within their limits.
    pub reduced_to: f64,
    pub simulations: usize,
}

/// Steps by which amplitudes are made smaller.
const MOST_REDUCTIONS: usize = 40;

/// The inputs of a maneuver.
///
/// # Errors
/// What does not fit, by its pointer within the design.
pub(super) fn make(flight: &mut Flight, design: &DesignKind) -> Result<Made, Fault> {
    match design {
        DesignKind::Scenario {} => Ok(Made {
            scenario: Some(flight.scenario.clone()),
            reduced_to: 1.0,
            ..Made::default()
        }),
        DesignKind::Multistep {
            input,
            shape,
            amplitude,
            start,
            natural_frequency,
        } => of_multistep(
            flight,
            (input, *amplitude),
            (*shape, *start),
            *natural_frequency,
        ),
        DesignKind::Multisine {
            amplitudes,
            band,
            start,
            period,
        } => of_multisine(flight, &amplitudes.0, (*band, *start, *period)),
        DesignKind::Optimal {
            amplitudes,
            pulse,
            start,
            end,
            parameters,
            simulations,
        } => of_optimal(
            flight,
            &amplitudes.0,
            (*pulse, *start, *end),
            (parameters, *simulations),
        ),
    }
}

fn of_multistep(
    flight: &mut Flight,
    (input, amplitude): (&str, f64),
    (shape, start): (MultistepShape, f64),
    natural_frequency: Option<f64>,
) -> Result<Made, Fault> {
    let (place, _) = moved(flight, "/input", input, amplitude, false)?;
    let frequency = match natural_frequency {
        Some(frequency) if frequency > 0.0 && frequency.is_finite() => frequency,
        Some(_) => {
            return Err(bad(
                "/natural_frequency",
                "a natural frequency is above 0, rad/s",
            ));
        }
        None => multistep::fastest(flight, place)?,
    };
    let unit_time = multistep::unit_time(shape, frequency, flight.scenario.step);
    let end = start + multistep::units(shape) * unit_time;
    if !(start >= 0.0 && end <= flight.scenario.duration) {
        let message = format!(
            "the input lasts from {start} to {end:.2} s, and the scenario {} s: make it longer",
            flight.scenario.duration
        );
        return Err(bad("/start", &message));
    }
    let scenario = |factor: f64, flight: &Flight| {
        let design = multistep::input(shape, start, unit_time, factor * amplitude);
        with(flight, [(input.to_string(), design)])
    };
    let (scenario, reduced_to) = within_limits(flight, scenario)?;
    Ok(Made {
        scenario: Some(scenario),
        natural_frequency: Some(frequency),
        unit_time: Some(unit_time),
        reduced_to,
        ..Made::default()
    })
}

fn of_multisine(
    flight: &mut Flight,
    amplitudes: &IndexMap<String, f64>,
    (band, start, period): ([f64; 2], f64, Option<f64>),
) -> Result<Made, Fault> {
    all_moved(flight, amplitudes)?;
    let duration = flight.scenario.duration;
    let period = period.unwrap_or(duration - start);
    if !(start >= 0.0 && period > 0.0 && start + period <= duration * (1.0 + 1e-9)) {
        let message = format!(
            "from {start} s a period of {period} s must end within the {duration} s of the scenario"
        );
        return Err(bad("/period", &message));
    }
    if band[1] > 0.4 / flight.scenario.step {
        return Err(bad(
            "/band",
            "the highest frequency is at most 0.4 of the sampling rate",
        ));
    }
    let dealt = multisine::harmonics(band, period, amplitudes.len())
        .map_err(|message| bad("/band", &message))?;
    let mut unit = Vec::new();
    for (place, harmonics) in dealt.iter().enumerate() {
        let phases = multisine::phases(harmonics, flight.scenario.seed.wrapping_add(place as u64));
        let frequencies: Vec<f64> = harmonics.iter().map(|&k| k as f64 / period).collect();
        let one = InputDesign::Multisine {
            start,
            duration: period,
            frequencies: frequencies.clone(),
            amplitude: 1.0,
            phases: phases.clone(),
        };
        let steps = (period / flight.scenario.step).round() as usize;
        let samples = (0..=steps).map(|k| one.at(start + k as f64 * flight.scenario.step).abs());
        let peak = samples.fold(0.0, f64::max);
        unit.push((frequencies, phases, peak));
    }
    let scenario = |factor: f64, flight: &Flight| {
        let designs = amplitudes.iter().zip(&unit);
        with(
            flight,
            designs.map(|((name, amplitude), (frequencies, phases, peak))| {
                let design = InputDesign::Multisine {
                    start,
                    duration: period,
                    frequencies: frequencies.clone(),
                    amplitude: factor * amplitude / peak,
                    phases: phases.clone(),
                };
                (name.clone(), design)
            }),
        )
    };
    let (scenario, reduced_to) = within_limits(flight, scenario)?;
    Ok(Made {
        scenario: Some(scenario),
        harmonics: amplitudes.keys().cloned().zip(dealt).collect(),
        reduced_to,
        ..Made::default()
    })
}

fn of_optimal(
    flight: &mut Flight,
    amplitudes: &IndexMap<String, f64>,
    (pulse, start, end): (f64, f64, Option<f64>),
    (parameters, simulations): (&[String], usize),
) -> Result<Made, Fault> {
    const MOST_SIMULATIONS: usize = 20_000;
    const MOST_INTERVALS: usize = 400;
    let moved = all_moved(flight, amplitudes)?;
    let end = end.unwrap_or(flight.scenario.duration);
    let intervals = ((end - start) / pulse + 1e-9).floor();
    let step = flight.scenario.step;
    if pulse.is_nan() || pulse < step * (1.0 - 1e-9) {
        return Err(bad(
            "/pulse",
            "the shortest pulse is no shorter than the step of the scenario",
        ));
    }
    if !(start >= 0.0 && end <= flight.scenario.duration && intervals >= 2.0) {
        return Err(bad(
            "/end",
            "two pulses at least lie between start and end, within the scenario",
        ));
    }
    if intervals > MOST_INTERVALS as f64 {
        let message = format!(
            "more than {MOST_INTERVALS} pulses between start and end: make the pulse longer"
        );
        return Err(bad("/pulse", &message));
    }
    if !(1..=MOST_SIMULATIONS).contains(&simulations) {
        return Err(bad(
            "/simulations",
            &format!("from 1 to {MOST_SIMULATIONS}"),
        ));
    }
    let of = wanted(flight, parameters)?;
    let search = Search {
        moved: &moved,
        pulse,
        start,
        intervals: intervals as usize,
        of: &of,
        simulations,
    };
    let found = search.run(flight);
    if found.ln_det.is_none() {
        return Err(bad(
            "",
            "within the limits no pattern that was tried tells all parameters: allow larger responses or amplitudes, hold parameters that cannot be told (\"fixed\" in the model), or name those that matter under \"parameters\"",
        ));
    }
    Ok(Made {
        scenario: Some(found.scenario),
        reduced_to: 1.0,
        simulations: found.simulations,
        ..Made::default()
    })
}

/// Places in θ of the parameters of these names; of all that maneuvers share, where none are named.
fn wanted(flight: &Flight, names: &[String]) -> Result<Vec<usize>, Fault> {
    let (problem, model) = (&flight.problem, flight.model());
    let info = |place: usize| &model.parameters[problem.unknowns.at(place).parameter];
    let places = 0..problem.unknowns.len();
    if names.is_empty() {
        let shared: Vec<usize> = places
            .clone()
            .filter(|&p| info(p).document.per == Per::Job)
            .collect();
        return Ok(match shared.is_empty() {
            true => places.collect(),
            false => shared,
        });
    }
    let place = |(at, name): (usize, &String)| {
        let found = places.clone().find(|&place| info(place).name == *name);
        found.ok_or_else(|| {
            let known: Vec<&str> = places
                .clone()
                .map(|place| info(place).name.as_str())
                .collect();
            let message = format!(
                "'{name}' is no free parameter of the model; these are {}",
                known.join(", ")
            );
            bad(&format!("/parameters/{at}"), &message)
        })
    };
    names.iter().enumerate().map(place).collect()
}

fn all_moved(
    flight: &Flight,
    amplitudes: &IndexMap<String, f64>,
) -> Result<Vec<(usize, f64)>, Fault> {
    if amplitudes.is_empty() {
        return Err(bad(
            "/amplitudes",
            "name an input that moves, and its amplitude",
        ));
    }
    let each = amplitudes.iter().map(|(name, amplitude)| {
        let pointer = format!("/amplitudes/{}", escape(name));
        moved(flight, &pointer, name, *amplitude, true)
    });
    each.collect()
}

/// The place of an input that the scenario has, and its amplitude.
fn moved(
    flight: &Flight,
    pointer: &str,
    name: &str,
    amplitude: f64,
    is_size: bool,
) -> Result<(usize, f64), Fault> {
    let model = flight.model();
    let place = flight
        .input(name)
        .filter(|_| flight.scenario.inputs.contains_key(name));
    let Some(place) = place else {
        let known: Vec<&str> = (model.inputs.iter().map(|input| input.name.as_str()))
            .filter(|name| flight.scenario.inputs.contains_key(*name))
            .collect();
        let message = format!(
            "'{name}' is no input of the scenario and its model; these are {}",
            known.join(", ")
        );
        return Err(bad(pointer, &message));
    };
    let is_fit = amplitude.is_finite() && amplitude != 0.0 && !(is_size && amplitude < 0.0);
    match is_fit {
        true => Ok((place, amplitude)),
        false => Err(bad(
            pointer,
            "an amplitude is a number above 0, in the unit of the input",
        )),
    }
}

fn with(flight: &Flight, designs: impl IntoIterator<Item = (String, InputDesign)>) -> Scenario {
    let mut scenario = flight.scenario.clone();
    for (name, design) in designs {
        if let Some(input) = scenario.inputs.get_mut(&name) {
            input.design = design;
        }
    }
    scenario
}

/// The scenario with amplitudes as they are asked for, or as much smaller as keeps responses within their limits.
fn within_limits(
    flight: &mut Flight,
    scenario: impl Fn(f64, &Flight) -> Scenario,
) -> Result<(Scenario, f64), Fault> {
    let mut factor = 1.0;
    for _ in 0..MOST_REDUCTIONS {
        let made = scenario(factor, flight);
        let inputs = flight.inputs(&made)?;
        let excess = match flight.respond(inputs) {
            Ok(outputs) => flight.excess(&outputs),
            Err(_) => 2.0,
        };
        if excess <= 1.0 {
            return Ok((made, factor));
        }
        factor *= 0.99 / excess;
    }
    Err(bad(
        "",
        "no amplitude keeps the responses within their limits: the model leaves them without inputs as well, or is unstable",
    ))
}

fn bad(pointer: &str, message: &str) -> Fault {
    Fault::new(pointer, "bad_design", message)
}
