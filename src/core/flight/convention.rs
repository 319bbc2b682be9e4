//! What a channel is, by the names that the field gives.

use super::{Dimension, Unit};

/// Angle of attack or of sideslip; not its rate.
pub fn is_flow_angle(name: &str) -> bool {
    let angles = ["alpha", "beta", "alfa", "aoa", "aos"];
    angles.iter().any(|angle| name.starts_with(angle)) && !name.contains("dot")
}

/// A control deflection: `de`, `da_right`, `delta_e`, ...
pub fn is_control(name: &str) -> bool {
    name.starts_with("delta") || (name.starts_with('d') && name.len() >= 2 && !name.contains("dt"))
}

/// What a sensor records of the aircraft's motion: a flow angle, a velocity, a rate, an acceleration.
pub fn is_motion(name: &str, unit: &str) -> bool {
    let dimension = Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension);
    let per_second = Dimension::NONE.over(Dimension::SECOND);
    let velocities = [Dimension::NONE, Dimension::METRE].map(|of| of.times(per_second));
    is_flow_angle(name)
        || velocities.contains(&dimension)
        || velocities.contains(&dimension.times(Dimension::SECOND))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gyros_and_vanes_are_told_from_surfaces_and_engines() {
        for (name, unit) in [
            ("beta", "deg"),
            ("p", "deg/s"),
            ("qdot", "rad/s^2"),
            ("az", "m/s^2"),
            ("V", "kt"),
            ("alphadot", "rad/s"),
        ] {
            assert!(is_motion(name, unit), "{name}");
        }
        for (name, unit) in [("de", "deg"), ("F", "N"), ("delta_t", "-"), ("m", "kg")] {
            assert!(!is_motion(name, unit), "{name}");
        }
    }
}
