//! How quantities are shown to people: angles in degrees, all else as it is.

/// What a value in SI is multiplied by, and the unit it then has.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Shown {
    pub scale: f64,
    pub unit: String,
}

/// Degrees for radians, and for radians per something.
pub(super) fn shown_in(unit: &str) -> Shown {
    if unit == "rad" || unit.starts_with("rad/") {
        Shown {
            scale: 1.0_f64.to_degrees(),
            unit: unit.replacen("rad", "deg", 1),
        }
    } else {
        Shown {
            scale: 1.0,
            unit: unit.to_string(),
        }
    }
}
