//! Maneuvers that come with Trimtab: made by simulation, with noise, from models and parameters that are known.

/// A maneuver, and the scenario that made it.
pub struct Bundled {
    /// The file's name without its ending.
    pub name: &'static str,
    /// The recording, as [`Format::Csv`](super::Format::Csv) reads it.
    pub csv: &'static str,
    /// A document of `trimtab simulate`, TOML.
    pub scenario: &'static str,
}

/// An elevator 3-2-1-1, for the model `short-period`.
pub const ELEVATOR: Bundled = Bundled {
    name: "elevator",
    csv: include_str!("../../../data/elevator.csv"),
    scenario: include_str!("../../../data/elevator.toml"),
};
/// Aileron, bank to bank, for the model `lateral-directional-4`.
pub const AILERON: Bundled = Bundled {
    name: "aileron",
    csv: include_str!("../../../data/aileron.csv"),
    scenario: include_str!("../../../data/aileron.toml"),
};
/// Rudder doublets, which excite the Dutch roll, for the model `lateral-directional-4`.
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
