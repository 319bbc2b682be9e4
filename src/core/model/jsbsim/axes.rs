//! Which coefficient acts on which axis of JSBSim.

use crate::flight::PhysicalQuantity;

/// Forces and moments of one axis.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Axis {
    pub name: &'static str,
    pub frame: &'static str,
    /// What the coefficient is multiplied by beside dynamic pressure and wing area.
    pub length: Option<&'static str>,
}

/// Stability axes of JSBSim have drag aft and lift up.
pub(super) const STABILITY: &str = "STABILITY";
pub(super) const BODY: &str = "BODY";

/// The axis of a coefficient; a side force is in the axes of the other forces.
pub(super) fn axis(coefficient: PhysicalQuantity, forces: &'static str) -> Option<Axis> {
    use PhysicalQuantity::*;
    let force = |name, frame| {
        Some(Axis {
            name,
            frame,
            length: None,
        })
    };
    let moment = |name, length| {
        Some(Axis {
            name,
            frame: BODY,
            length: Some(length),
        })
    };
    match coefficient {
        DragCoefficient => force("X", STABILITY),
        LiftCoefficient => force("Z", STABILITY),
        SideForceCoefficient => force("Y", forces),
        ForceCoefficientX => force("X", BODY),
        ForceCoefficientZ => force("Z", BODY),
        RollingMomentCoefficient => moment("ROLL", "metrics/bw-ft"),
        PitchingMomentCoefficient => moment("PITCH", "metrics/cbarw-ft"),
        YawingMomentCoefficient => moment("YAW", "metrics/bw-ft"),
        _ => None,
    }
}
