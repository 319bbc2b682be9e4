//! What a quantity is, by the words in which it is described.

use super::{Dimension, PhysicalQuantity};

/// Words that may stand before the quantity.
const BEFORE: [&str; 9] = [
    "the ",
    "a ",
    "an ",
    "measured ",
    "recorded ",
    "true ",
    "indicated ",
    "calibrated ",
    "corrected ",
];

/// Words with which a motion is not what is described, but what is wanted or wrong of it.
const NOT_ITSELF: [&str; 7] = [
    "bias",
    "error",
    "command",
    "commanded",
    "demand",
    "demanded",
    "reference",
];

/// What a description begins with, and what that is. Of two that begin alike the longer comes first.
#[rustfmt::skip]
const WORDS: [(&str, PhysicalQuantity); 71] = {
    use PhysicalQuantity::*;
    [
        ("angle of attack rate", AngleOfAttackRate),
        ("angle-of-attack rate", AngleOfAttackRate),
        ("rate of the angle of attack", AngleOfAttackRate),
        ("rate of angle of attack", AngleOfAttackRate),
        ("angle of attack", AngleOfAttack),
        ("angle-of-attack", AngleOfAttack),
        ("angle of incidence", AngleOfAttack),
        ("sideslip rate", AngleOfSideslipRate),
        ("rate of the angle of sideslip", AngleOfSideslipRate),
        ("angle of sideslip", AngleOfSideslip),
        ("sideslip", AngleOfSideslip),
        ("airspeed", Airspeed),
        ("mach number", Mach),
        ("dynamic pressure", DynamicPressure),
        ("air density", AirDensity),
        ("density of the air", AirDensity),
        ("velocity forward", VelocityX),
        ("forward velocity", VelocityX),
        ("velocity to the right", VelocityY),
        ("lateral velocity", VelocityY),
        ("velocity down", VelocityZ),
        ("downward velocity", VelocityZ),
        ("roll rate", RollRate),
        ("pitch rate", PitchRate),
        ("yaw rate", YawRate),
        ("roll acceleration", RollAcceleration),
        ("pitch acceleration", PitchAcceleration),
        ("yaw acceleration", YawAcceleration),
        ("specific force forward", AccelerationX),
        ("acceleration forward", AccelerationX),
        ("forward acceleration", AccelerationX),
        ("longitudinal acceleration", AccelerationX),
        ("specific force to the right", AccelerationY),
        ("acceleration to the right", AccelerationY),
        ("lateral acceleration", AccelerationY),
        ("specific force down", AccelerationZ),
        ("acceleration down", AccelerationZ),
        ("normal acceleration", AccelerationZ),
        ("vertical acceleration", AccelerationZ),
        ("roll angle", RollAngle),
        ("roll attitude", RollAngle),
        ("bank angle", RollAngle),
        ("pitch angle", PitchAngle),
        ("pitch attitude", PitchAngle),
        ("yaw angle", HeadingAngle),
        ("heading", HeadingAngle),
        ("position north", PositionX),
        ("position east", PositionY),
        ("position down", PositionZ),
        ("altitude", Altitude),
        ("pressure altitude", Altitude),
        ("height", Altitude),
        ("lift coefficient", LiftCoefficient),
        ("drag coefficient", DragCoefficient),
        ("side force coefficient", SideForceCoefficient),
        ("side-force coefficient", SideForceCoefficient),
        ("force coefficient forward", ForceCoefficientX),
        ("force coefficient down", ForceCoefficientZ),
        ("rolling moment coefficient", RollingMomentCoefficient),
        ("rolling-moment coefficient", RollingMomentCoefficient),
        ("pitching moment coefficient", PitchingMomentCoefficient),
        ("pitching-moment coefficient", PitchingMomentCoefficient),
        ("yawing moment coefficient", YawingMomentCoefficient),
        ("yawing-moment coefficient", YawingMomentCoefficient),
        ("elevator", Elevator),
        ("aileron", Aileron),
        ("rudder", Rudder),
        ("canard", Canard),
        ("flap", Flap),
        ("thrust", Thrust),
        ("throttle", Thrust),
    ]
};

/// What a description says, if what it names is measured in a dimension that fits.
pub fn by_description(description: &str, dimension: Dimension) -> Option<PhysicalQuantity> {
    let lower = description.trim().to_lowercase();
    let mut rest = lower.as_str();
    while let Some(after) = BEFORE.iter().find_map(|word| rest.strip_prefix(word)) {
        rest = after;
    }
    let begins = |(words, _): &&(&str, PhysicalQuantity)| {
        let ends = |after: &str| !after.starts_with(char::is_alphanumeric);
        rest.strip_prefix(words).is_some_and(ends)
    };
    let (_, quantity) = WORDS.iter().find(begins)?;
    let mut words = rest.split(|c: char| !c.is_alphanumeric());
    let is_another = !quantity.is_control() && words.any(|word| NOT_ITSELF.contains(&word));
    (!is_another && quantity.measures(dimension)).then_some(*quantity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::Unit;

    #[test]
    fn a_description_says_what_it_begins_with_where_the_unit_fits() {
        use PhysicalQuantity::{AccelerationZ, AngleOfAttack, AngleOfAttackRate, PitchRate};
        for (description, unit, quantity) in [
            (
                "angle of attack about the steady one",
                "deg",
                Some(AngleOfAttack),
            ),
            ("The measured angle of attack", "rad", Some(AngleOfAttack)),
            ("Angle of attack rate", "rad/s", Some(AngleOfAttackRate)),
            ("pitch rate", "deg/s", Some(PitchRate)),
            (
                "specific force down, less that of steady flight",
                "m/s^2",
                Some(AccelerationZ),
            ),
            // not in this unit, not at the beginning, no whole word
            ("pitch rate", "rad", None),
            ("bias of the pitch rate", "rad/s", None),
            ("pitch rate bias", "rad/s", None),
            ("commanded pitch rate", "rad/s", None),
            ("pitch attitude command", "rad", None),
            ("pitch rates", "rad/s", None),
            ("", "rad/s", None),
        ] {
            let dimension = Unit::parse(unit).unwrap().dimension;
            assert_eq!(
                by_description(description, dimension),
                quantity,
                "{description}"
            );
        }
    }
}
