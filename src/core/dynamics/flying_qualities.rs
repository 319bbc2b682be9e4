//! Flying qualities of an estimate: modes, equivalent systems, control anticipation, bandwidth, and the levels they reach.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::bandwidth::{Bandwidth, bandwidth};
use super::channel::Channel;
use super::equivalent_system::{self, EquivalentForm, EquivalentSystem};
use super::level::{AirplaneClass, Criterion, FlightPhaseCategory, control_anticipation, of_modes};
use super::linearisation::Linearisation;
use super::no_linear_system::NoLinearSystem;
use crate::estimate::{Estimate, Measure, Mode, ModeName, Problem};
use crate::flight::{Motion, PhysicalQuantity};

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;

/// What is to be judged, and as what.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct FlyingQualityQuestion {
    /// The segment at whose start the model is linearised; the first where absent.
    pub segment: Option<String>,
    /// Levels want both of these.
    pub category: Option<FlightPhaseCategory>,
    /// Levels want both of these.
    pub class: Option<AirplaneClass>,
    /// True airspeed, m/s, of a model that does not have it.
    pub airspeed: Option<f64>,
    /// Frequencies that equivalent systems are fitted over, rad/s; where absent 0.1 to 10, and above a phugoid.
    pub band: Option<[f64; 2]>,
}

/// Flying qualities at the start of a segment, with the standard errors that the covariance of the parameters carries over.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct FlyingQualities {
    /// The segment at whose start the model was linearised.
    #[schema(example = "elevator")]
    pub segment: String,
    /// Modes of the motion, fastest first.
    pub modes: Vec<Mode>,
    /// From controls to pitch rate, roll rate and sideslip, as far as the model has them.
    pub equivalent_systems: Vec<EquivalentSystem>,
    /// ω²/(n/α) of the short period, rad/s² per g (1/(g s²)), with n/α = V/(g T) and the numerator's time constant T of the pitch
    /// rate's equivalent system (MIL-F-8785C, 3.2.2.1.1). Absent where the model has no short period, or the airspeed is not
    /// known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control_anticipation_parameter: Option<Measure>,
    /// True airspeed that it was made with, m/s; it counts as known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub airspeed: Option<f64>,
    /// Of pitch and bank attitude.
    pub bandwidths: Vec<Bandwidth>,
    /// Levels; none where category of the flight phase or class of the airplane were not said.
    pub levels: Vec<Criterion>,
    /// What the reader should know, mostly nothing.
    pub remarks: Vec<String>,
}

/// The flying qualities of an estimate.
///
/// # Errors
/// There is no such segment, or a derivative is not finite.
pub fn flying_qualities(
    problem: &Problem,
    estimate: &Estimate,
    question: &FlyingQualityQuestion,
) -> Result<FlyingQualities, NoLinearSystem> {
    let linear = Linearisation::at(problem, estimate, question.segment.as_deref())?;
    let of_segment = |mode: &&Mode| mode.segment.as_ref().is_none_or(|of| *of == linear.segment);
    let modes: Vec<Mode> = estimate.modes.iter().filter(of_segment).cloned().collect();
    let band = band(question, &modes)?;
    let equivalent_systems = equivalent_systems(&linear, band);
    let airspeed = question.airspeed.or_else(|| airspeed(&linear));
    let has = |name: ModeName| modes.iter().any(|mode| mode.name == Some(name));
    let anticipation = airspeed
        .filter(|_| has(ModeName::ShortPeriod))
        .and_then(|airspeed| anticipation(&linear, band, airspeed));
    let mut levels = Vec::new();
    if let Some((category, class)) = question.category.zip(question.class) {
        levels = of_modes(&modes, category, class);
        levels.extend(anticipation.map(|measure| control_anticipation(measure, category)));
    }
    let mut remarks = Vec::new();
    if has(ModeName::ShortPeriod) && airspeed.is_none() {
        remarks.push(
            "the model has no airspeed: say airspeed for the control anticipation parameter"
                .to_string(),
        );
    }
    if linear.is_kinematic {
        remarks.push("the motion is recorded and not computed from forces: there are no flying qualities in it".to_string());
    }
    Ok(FlyingQualities {
        segment: linear.segment.clone(),
        bandwidths: bandwidths(&linear),
        modes,
        equivalent_systems,
        control_anticipation_parameter: anticipation,
        airspeed: anticipation.and(airspeed),
        levels,
        remarks,
    })
}

/// Frequencies that equivalent systems are fitted over: what was asked for, or 0.1 to 10 rad/s, above a phugoid, which they
/// do not have.
fn band(question: &FlyingQualityQuestion, modes: &[Mode]) -> Result<(f64, f64), NoLinearSystem> {
    const ABOVE_PHUGOID: f64 = 5.0;
    let phugoid = (modes.iter())
        .filter(|mode| mode.name == Some(ModeName::Phugoid))
        .filter_map(|mode| Some(ABOVE_PHUGOID * mode.natural_frequency?.value));
    let lowest = phugoid.fold(0.1, f64::max).min(1.0);
    let [from, to] = question.band.unwrap_or([lowest, 10.0]);
    // written so that NaN is refused
    if !(from > 0.0 && from < to && to.is_finite()) {
        let why =
            format!("band: {from} to {to} rad/s: two frequencies above 0, the lower one first");
        return Err(NoLinearSystem::Frequencies(why));
    }
    Ok((from, to))
}

/// The inputs that a pilot moves for one of the motions: those that are named so, or any control where none is.
fn controls(linear: &Linearisation<'_>, motion: Motion, named: &[PhysicalQuantity]) -> Vec<usize> {
    let all = || linear.inputs.iter().enumerate();
    let of = |is: &dyn Fn(PhysicalQuantity) -> bool| -> Vec<usize> {
        let inputs = all().filter(|(_, input)| input.quantity.is_some_and(is));
        inputs.map(|(place, _)| place).collect()
    };
    let found = of(&|quantity| named.contains(&quantity));
    if !found.is_empty() {
        return found;
    }
    of(&|quantity| quantity.is_control() && quantity.motion().is_none_or(|of| of == motion))
}

/// The output that shows a quantity as a state has it: without a sensor's delay or bias it is the state itself.
fn outputs(linear: &Linearisation<'_>, quantity: PhysicalQuantity) -> Option<usize> {
    linear
        .outputs
        .iter()
        .position(|output| output.quantity == Some(quantity))
}

const PITCH: [PhysicalQuantity; 2] = [PhysicalQuantity::Elevator, PhysicalQuantity::Canard];

fn channels<'l>(
    linear: &'l Linearisation<'l>,
    motion: Motion,
    controls_of: &[PhysicalQuantity],
    output: PhysicalQuantity,
) -> Vec<Channel<'l>> {
    let Some(output) = outputs(linear, output) else {
        return Vec::new();
    };
    (controls(linear, motion, controls_of).into_iter())
        .filter_map(|input| Channel::of(linear, input, output))
        .collect()
}

fn equivalent_systems(linear: &Linearisation<'_>, band: (f64, f64)) -> Vec<EquivalentSystem> {
    use PhysicalQuantity::{Aileron, AngleOfSideslip, PitchRate, RollRate, Rudder};
    let wanted: [(
        Motion,
        &[PhysicalQuantity],
        PhysicalQuantity,
        EquivalentForm,
    ); 3] = [
        (
            Motion::Longitudinal,
            &PITCH,
            PitchRate,
            EquivalentForm::PitchRate,
        ),
        (
            Motion::Lateral,
            &[Aileron],
            RollRate,
            EquivalentForm::RollRate,
        ),
        (
            Motion::Lateral,
            &[Rudder],
            AngleOfSideslip,
            EquivalentForm::Sideslip,
        ),
    ];
    if linear.is_kinematic {
        return Vec::new();
    }
    let of = |(motion, controls, output, form): (Motion, &[PhysicalQuantity], _, _)| {
        let channels = channels(linear, motion, controls, output);
        let systems = channels.iter();
        let systems = systems.filter_map(|c| equivalent_system::equivalent_system(c, form, band));
        systems.collect::<Vec<_>>()
    };
    wanted.into_iter().flat_map(of).collect()
}

/// ω²/(n/α) by the pitch rate's equivalent system: n/α = V/(g T).
fn anticipation(linear: &Linearisation<'_>, band: (f64, f64), airspeed: f64) -> Option<Measure> {
    let pitch = channels(
        linear,
        Motion::Longitudinal,
        &PITCH,
        PhysicalQuantity::PitchRate,
    );
    let channel = pitch.first()?;
    equivalent_system::anticipation(channel, band, GRAVITY / airspeed)
}

fn bandwidths(linear: &Linearisation<'_>) -> Vec<Bandwidth> {
    use PhysicalQuantity::{Aileron, PitchAngle, PitchRate, RollAngle, RollRate};
    let wanted: [(Motion, &[PhysicalQuantity], [PhysicalQuantity; 2]); 2] = [
        (Motion::Longitudinal, &PITCH, [PitchAngle, PitchRate]),
        (Motion::Lateral, &[Aileron], [RollAngle, RollRate]),
    ];
    if linear.is_kinematic {
        return Vec::new();
    }
    let of = |(motion, controls, [angle, rate]): (Motion, &[PhysicalQuantity], [_; 2])| {
        let angles = channels(linear, motion, controls, angle);
        let is_rate = angles.is_empty();
        let channels = if is_rate {
            channels(linear, motion, controls, rate)
        } else {
            angles
        };
        channels
            .iter()
            .map(|channel| bandwidth(channel, is_rate))
            .collect::<Vec<_>>()
    };
    wanted.into_iter().flat_map(of).collect()
}

/// True airspeed of a model that has it: a state at its start, an input, a parameter or a constant.
fn airspeed(linear: &Linearisation<'_>) -> Option<f64> {
    let model = &linear.problem.model;
    let state = |name: &str| model.states.iter().position(|state| state.name == name);
    let input = |name: &str| model.inputs.iter().position(|input| input.name == name);
    let parameter = |name: &str| model.parameters.iter().position(|p| p.name == name);
    let constant = |name: &str| {
        let constant = model.document.constants.get(name)?;
        let unit = crate::flight::Unit::parse(&constant.unit).ok()?;
        Some(unit.to_si(constant.value))
    };
    let value = |name: &str| {
        (state(name).map(|i| linear.at.state[i]))
            .or_else(|| input(name).map(|i| linear.input_values[i]))
            .or_else(|| parameter(name).map(|i| linear.parameters[i]))
            .or_else(|| constant(name))
    };
    let first = |quantity| linear.quantities.all_of(quantity).find_map(value);
    let by_velocities = || {
        use PhysicalQuantity::{VelocityX, VelocityY, VelocityZ};
        let across = [VelocityY, VelocityZ].map(|quantity| first(quantity).unwrap_or_default());
        Some(first(VelocityX)?.hypot(across[0]).hypot(across[1]))
    };
    first(PhysicalQuantity::Airspeed)
        .or_else(by_velocities)
        .filter(|airspeed| *airspeed > 0.0)
}
