//! JSBSim's properties of what moves an aircraft, and what they are in SI.

use crate::flight::PhysicalQuantity;

/// A property and the factor that makes SI of it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Property {
    pub name: &'static str,
    pub factor: f64,
    /// SI: below it the property counts as this, so that what is divided by it stays finite on the ground.
    pub least: Option<f64>,
}

/// Exact: the international foot, and the pound as a force with the standard gravity.
const FOOT: f64 = 0.3048;
const POUND_FORCE: f64 = 4.448_221_615_260_5;
const SLUG: f64 = POUND_FORCE / FOOT;

/// The property of a quantity in SI unit `si`; of controls only those that are angles.
pub(super) fn property(quantity: PhysicalQuantity, si: &str) -> Option<Property> {
    use PhysicalQuantity::*;
    let of = |name, factor| {
        Some(Property {
            name,
            factor,
            least: None,
        })
    };
    let guarded = |name, factor, least| {
        Some(Property {
            name,
            factor,
            least: Some(least),
        })
    };
    let surface = |name| of(name, 1.0).filter(|_| si == "rad");
    match quantity {
        AngleOfAttack => of("aero/alpha-rad", 1.0),
        AngleOfSideslip => of("aero/beta-rad", 1.0),
        AngleOfAttackRate => of("aero/alphadot-rad_sec", 1.0),
        AngleOfSideslipRate => of("aero/betadot-rad_sec", 1.0),
        Airspeed => guarded("velocities/vt-fps", FOOT, 0.1),
        Mach => of("velocities/mach", 1.0),
        DynamicPressure => guarded("aero/qbar-psf", POUND_FORCE / (FOOT * FOOT), 0.01),
        AirDensity => of("atmosphere/rho-slugs_ft3", SLUG / (FOOT * FOOT * FOOT)),
        VelocityX => of("velocities/u-aero-fps", FOOT),
        VelocityY => of("velocities/v-aero-fps", FOOT),
        VelocityZ => of("velocities/w-aero-fps", FOOT),
        RollRate => of("velocities/p-aero-rad_sec", 1.0),
        PitchRate => of("velocities/q-aero-rad_sec", 1.0),
        YawRate => of("velocities/r-aero-rad_sec", 1.0),
        RollAngle => of("attitude/phi-rad", 1.0),
        PitchAngle => of("attitude/theta-rad", 1.0),
        HeadingAngle => of("attitude/psi-rad", 1.0),
        Altitude => of("position/h-sl-ft", FOOT),
        Elevator => surface("fcs/elevator-pos-rad"),
        Aileron => surface("fcs/left-aileron-pos-rad"),
        Rudder => surface("fcs/rudder-pos-rad"),
        Flap => surface("fcs/flap-pos-rad"),
        _ => None,
    }
}

/// Definitions of these quantities are JSBSim's own, where the document declares them.
pub(super) fn is_of_the_flow(quantity: PhysicalQuantity) -> bool {
    use PhysicalQuantity::*;
    matches!(
        quantity,
        AngleOfAttack
            | AngleOfSideslip
            | AngleOfAttackRate
            | AngleOfSideslipRate
            | Airspeed
            | Mach
            | DynamicPressure
            | AirDensity
    )
}
