//! Maneuvers that come with Trimtab: made by simulation, with noise, from models and parameters that are known.

/// A maneuver, and the scenario that made it.
pub struct Bundled {
    pub name: &'static str,
    pub csv: &'static str,
    /// A document of `trimtab simulate`, TOML.
    pub scenario: &'static str,
}

pub const ELEVATOR: Bundled = Bundled {
    name: "elevator",
    csv: include_str!("../../../data/elevator.csv"),
    scenario: include_str!("../../../data/elevator.toml"),
};
pub const AILERON: Bundled = Bundled {
    name: "aileron",
    csv: include_str!("../../../data/aileron.csv"),
    scenario: include_str!("../../../data/aileron.toml"),
};
pub const RUDDER: Bundled = Bundled {
    name: "rudder",
    csv: include_str!("../../../data/rudder.csv"),
    scenario: include_str!("../../../data/rudder.toml"),
};

/// Flights of an aircraft whose elevator linkage has play, which no model in the catalog knows of: to fit, to check, and
/// to judge at last.
pub const UNDECLARED: [Bundled; 3] = [
    Bundled {
        name: "elevator-backlash-fit",
        csv: include_str!("../../../data/effects/elevator-backlash-fit.csv"),
        scenario: include_str!("../../../data/effects/elevator-backlash-fit.toml"),
    },
    Bundled {
        name: "elevator-backlash-check",
        csv: include_str!("../../../data/effects/elevator-backlash-check.csv"),
        scenario: include_str!("../../../data/effects/elevator-backlash-check.toml"),
    },
    Bundled {
        name: "elevator-backlash-final",
        csv: include_str!("../../../data/effects/elevator-backlash-final.csv"),
        scenario: include_str!("../../../data/effects/elevator-backlash-final.toml"),
    },
];
