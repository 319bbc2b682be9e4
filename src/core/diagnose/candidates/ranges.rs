//! How large an effect may be: what is plausible by kind of instrument, unless the job knows better.

use super::subject::Subject;
use crate::diagnose::effect::{Effect, EffectKind};
use crate::diagnose::plausible::Plausible;
use crate::flight::{Dimension, Family, PhysicalQuantity, Unit};
use crate::model::expression;
use crate::model::{EditKind, Start};

/// Instruments that err alike.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Instrument {
    Vane,
    Airspeed,
    Gyro,
    Accelerometer,
    Attitude,
    Control,
}

impl Instrument {
    fn of(quantity: PhysicalQuantity) -> Option<Self> {
        Some(match quantity.family() {
            Family::AirData if quantity.is_flow_angle() => Self::Vane,
            Family::AirData => Self::Airspeed,
            Family::Gyro => Self::Gyro,
            Family::Accelerometer => Self::Accelerometer,
            Family::Attitude => Self::Attitude,
            Family::Control if quantity != PhysicalQuantity::Thrust => Self::Control,
            _ => return None,
        })
    }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Kind, instrument, lower and upper, usual standard deviation.
#[rustfmt::skip]
const TABLE: [(EditKind, Instrument, f64, f64, f64); 28] = {
    use EditKind::*;
    use Instrument::*;
    [
        (SensorScale, Vane, -0.4, 0.4, 0.1),
        (SensorScale, Airspeed, -0.3, 0.3, 0.05),
        (SensorScale, Gyro, -0.3, 0.3, 0.05),
        (SensorScale, Accelerometer, -0.3, 0.3, 0.05),
        (SensorScale, Attitude, -0.2, 0.2, 0.03),
        (InputScale, Control, -0.4, 0.4, 0.1),
        (SensorDelay, Vane, 0.0, 0.5, 0.1),
        (SensorDelay, Airspeed, 0.0, 0.5, 0.1),
        (SensorDelay, Gyro, -0.2, 0.3, 0.05),
        (SensorDelay, Accelerometer, -0.2, 0.3, 0.05),
        (SensorDelay, Attitude, -0.2, 0.3, 0.05),
        (InputDelay, Control, -0.3, 0.3, 0.06),
        (SensorBias, Vane, -5.0 * DEGREE, 5.0 * DEGREE, DEGREE),
        (SensorBias, Airspeed, -10.0, 10.0, 2.0),
        (SensorBias, Gyro, -3.0 * DEGREE, 3.0 * DEGREE, 0.5 * DEGREE),
        (SensorBias, Accelerometer, -1.0, 1.0, 0.2),
        (SensorBias, Attitude, -5.0 * DEGREE, 5.0 * DEGREE, DEGREE),
        (InputBias, Control, -5.0 * DEGREE, 5.0 * DEGREE, DEGREE),
        (SensorCrossAxis, Vane, -0.3, 0.3, 0.05),
        (SensorCrossAxis, Gyro, -0.3, 0.3, 0.05),
        (SensorCrossAxis, Accelerometer, -0.3, 0.3, 0.05),
        (SensorPosition, Vane, -15.0, 15.0, 5.0),
        (SensorPosition, Accelerometer, -3.0, 3.0, 1.0),
        (SensorLag, Vane, 0.0, 1.0, 0.1),
        (SensorLag, Airspeed, 0.0, 2.0, 0.3),
        (SensorLag, Gyro, 0.0, 1.0, 0.05),
        (SensorLag, Accelerometer, 0.0, 1.0, 0.05),
        (ActuatorLag, Control, 0.0, 1.0, 0.1),
    ]
};

/// How far from where the model has it a vane is, m.
const DECLARED_ARM: Plausible = Plausible {
    lower: -0.5,
    upper: 0.5,
    sd: 0.2,
    known: true,
};

/// Gives each effect the range of its size, where there is one.
pub(super) fn bound(subject: &Subject<'_>, effects: &mut [Effect]) {
    for effect in effects {
        effect.plausible = plausible(subject, effect);
    }
}

/// Of several sensors, the range that holds those of all.
fn plausible(subject: &Subject<'_>, effect: &Effect) -> Option<Plausible> {
    let EffectKind::Edit(kind) = effect.kind else {
        return None;
    };
    if kind == EditKind::SensorPosition && subject.declares_arm(&effect.target) {
        return Some(DECLARED_ARM);
    }
    let targets = effect.target.split('+');
    let ranges: Option<Vec<Plausible>> = targets
        .map(|target| {
            let outputs = subject.document.outputs.contains_key(target);
            let quantity = match outputs {
                true => subject.quantities.output(target),
                false => subject.quantities.get(target),
            };
            of(kind, quantity?)
        })
        .collect();
    ranges?.into_iter().reduce(|a, b| Plausible {
        lower: a.lower.min(b.lower),
        upper: a.upper.max(b.upper),
        sd: a.sd.max(b.sd),
        known: false,
    })
}

fn of(kind: EditKind, quantity: PhysicalQuantity) -> Option<Plausible> {
    let instrument = Instrument::of(quantity)?;
    // a pressure or a density has units of its own, and so have biases of load factors
    let plain = !matches!(kind, EditKind::SensorBias)
        || !matches!(instrument, Instrument::Airspeed)
        || quantity == PhysicalQuantity::Airspeed;
    let row = TABLE
        .iter()
        .find(|row| row.0 == kind && row.1 == instrument)?;
    plain.then_some(Plausible {
        lower: row.2,
        upper: row.3,
        sd: row.4,
        known: false,
    })
}

impl Subject<'_> {
    /// Whether the equation of a vane holds a length, not zero, beside a rate: where the vane is.
    fn declares_arm(&self, output: &str) -> bool {
        let document = self.document;
        let is_vane = self
            .quantities
            .output(output)
            .is_some_and(PhysicalQuantity::is_flow_angle);
        let Some(equation) = document.outputs.get(output).filter(|_| is_vane) else {
            return false;
        };
        let mut pending = vec![equation.equation.clone()];
        let mut seen: Vec<String> = Vec::new();
        while let Some(text) = pending.pop() {
            let Ok(parsed) = expression::parse(&text) else {
                continue;
            };
            for (name, _) in parsed.names() {
                if self.is_length(name) {
                    return true;
                }
                let definition = document.definitions.get(name);
                if let (Some(definition), false) = (definition, seen.iter().any(|s| s == name)) {
                    seen.push(name.to_string());
                    pending.push(definition.equation.clone());
                }
            }
        }
        false
    }

    fn is_length(&self, name: &str) -> bool {
        let document = self.document;
        let constant = document.constants.get(name).map(|x| (&x.unit, x.value));
        let parameter = document.parameters.get(name).map(|x| match x.start {
            Start::Value(value) => (&x.unit, value),
            Start::FromData(_) => (&x.unit, 0.0),
        });
        constant.or(parameter).is_some_and(|(unit, value)| {
            let unit = Unit::parse(unit).map(|unit| unit.dimension);
            unit == Ok(Dimension::METRE) && value != 0.0
        })
    }
}
