//! Groups of channels, and where their values come from.

use super::super::label::Label;
use crate::flight::Fault;

/// What a file has: groups of channels, whose values it gives when it is asked.
pub(in super::super) struct Groups<S> {
    pub(in super::super) groups: Vec<Group>,
    pub(in super::super) samples: S,
    /// Channels that cannot be read, and why.
    pub(in super::super) left_out: Vec<(String, String)>,
}

/// Channels of one length with one time axis. Several may have one name.
pub(in super::super) struct Group {
    pub(in super::super) name: String,
    pub(in super::super) rows: usize,
    /// As many as the file says there are: more, where it is cut off.
    pub(in super::super) said: usize,
    pub(in super::super) time: Time,
    pub(in super::super) channels: Vec<Channel>,
}

/// The times of a group.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in super::super) enum Time {
    /// Seconds.
    Even { start: f64, step: f64 },
    /// Seconds, by the channel that has them.
    Recorded(usize),
    /// The file does not say them.
    Unknown,
}

#[derive(Clone)]
pub(in super::super) struct Channel {
    pub(in super::super) name: String,
    /// As the file says it; empty where it does not.
    pub(in super::super) unit: String,
    /// What the file knows it by.
    pub(in super::super) at: usize,
}

impl Channel {
    /// Its name without its unit, and the unit: that beside the name, else the one in brackets or at the end of the name.
    pub(super) fn label(&self) -> (&str, &str) {
        let label = Label::split(&self.name);
        // Altitude (baro): what is in brackets is no unit where the file says one beside the name
        match self.unit.is_empty() {
            false => (&self.name, &self.unit),
            true if label.unit.is_empty() => (label.name, label.unit_in_name().unwrap_or("")),
            true => (label.name, label.unit),
        }
    }
}

/// The values in a file.
pub(in super::super) trait Samples {
    /// The values of a channel, as many as its group has rows.
    ///
    /// # Errors
    /// They are damaged.
    fn values(&mut self, at: usize) -> Result<Vec<f64>, Fault>;
}
