//! What a signal passes on its way between the recorder and the equations of a model.

use super::document::{Input, Output};
use crate::flight::Dimension;

/// An element of a signal's path. Each has one size, and one size at which it changes nothing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Element {
    /// Half the width b of a dead band: what follows is moved only by what pushes it. 0 changes nothing.
    Play,
    /// The largest rate r. At or above the largest rate of the signal it changes nothing.
    RateLimit,
    /// The time constant T of a first-order lag. 0 changes nothing.
    Lag,
    /// How much later the signal comes out. 0 changes nothing.
    Delay,
}

impl Element {
    /// In the order in which an input passes them.
    pub const ALL: [Self; 4] = [Self::Play, Self::RateLimit, Self::Lag, Self::Delay];

    /// The field of a document.
    pub fn field(self) -> &'static str {
        match self {
            Self::Play => "play",
            Self::RateLimit => "rate_limit",
            Self::Lag => "lag",
            Self::Delay => "delay",
        }
    }

    /// What it is called.
    pub fn words(self) -> &'static str {
        match self {
            Self::RateLimit => "rate limit",
            Self::Play | Self::Lag | Self::Delay => self.field(),
        }
    }

    /// What its size measures, by what the signal measures.
    pub fn measures(self, signal: Dimension) -> Dimension {
        match self {
            Self::Play => signal,
            Self::RateLimit => signal.over(Dimension::SECOND),
            Self::Lag | Self::Delay => Dimension::SECOND,
        }
    }

    /// The fault of a size that depends on what is recorded.
    pub(super) fn depends_on_data(self) -> &'static str {
        match self {
            Self::Play => "play_depends_on_data",
            Self::RateLimit => "rate_limit_depends_on_data",
            Self::Lag => "lag_depends_on_data",
            Self::Delay => "delay_depends_on_data",
        }
    }
}

impl Input {
    /// The elements that it passes, in this order, with their sizes as they are written.
    pub fn path(&self) -> Vec<(Element, &str)> {
        present([
            (Element::Play, &self.play),
            (Element::RateLimit, &self.rate_limit),
            (Element::Lag, &self.lag),
            (Element::Delay, &self.delay),
        ])
    }
}

impl Output {
    /// The elements that it passes, in this order, with their sizes as they are written.
    pub fn path(&self) -> Vec<(Element, &str)> {
        present([(Element::Lag, &self.lag), (Element::Delay, &self.delay)])
    }
}

fn present<const N: usize>(fields: [(Element, &Option<String>); N]) -> Vec<(Element, &str)> {
    let given = fields.into_iter();
    given
        .filter_map(|(element, size)| Some((element, size.as_deref()?)))
        .collect()
}
