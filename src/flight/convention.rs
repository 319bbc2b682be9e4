//! What a channel is, by the names that the field gives.

/// Angle of attack or of sideslip; not its rate.
pub fn is_flow_angle(name: &str) -> bool {
    let angles = ["alpha", "beta", "alfa", "aoa", "aos"];
    angles.iter().any(|angle| name.starts_with(angle)) && !name.contains("dot")
}

/// A control deflection: `de`, `da_right`, `delta_e`, ...
pub fn is_control(name: &str) -> bool {
    name.starts_with("delta") || (name.starts_with('d') && name.len() >= 2 && !name.contains("dt"))
}
