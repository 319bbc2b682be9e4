//! Which cases there are, and which of them a seed is.

use crate::aircraft::{ALL, Kind};
use crate::random::Random;
use crate::strength::Strength;

#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) enum Set {
    /// Nothing is wrong.
    Nulls,
    /// One effect of the catalogue.
    Effects,
    /// Two of them at once.
    Pairs,
    /// Something that is in no catalogue.
    Unknown,
}

impl Set {
    pub(crate) const ALL: [Self; 4] = [Self::Nulls, Self::Effects, Self::Pairs, Self::Unknown];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Nulls => "nulls",
            Self::Effects => "effects",
            Self::Pairs => "pairs",
            Self::Unknown => "unknown",
        }
    }
}

/// Pairs for each aircraft.
const PAIRS: usize = 40;

/// What a case is but for its seed.
#[derive(Clone, Debug)]
pub(crate) struct Design {
    pub set: Set,
    pub aircraft: usize,
    /// By number in the aircraft's list.
    pub faults: Vec<usize>,
    pub strength: Strength,
    pub key: String,
}

impl Design {
    pub(crate) fn kind(&self) -> &'static Kind {
        &ALL[self.aircraft]
    }
}

/// All designs of a set whose key contains the text.
pub(crate) fn designs(set: Set, only: &str) -> Vec<Design> {
    let mut all = Vec::new();
    for (aircraft, kind) in ALL.iter().enumerate() {
        let made = (kind.make)(&mut Random::new(0, "list"), None);
        let design = |faults: Vec<usize>, strength: Strength, what: String| Design {
            set,
            aircraft,
            faults,
            strength,
            key: format!("{}/{what}", kind.name),
        };
        let name = |fault: usize| made.faults[fault].name.clone();
        let known = made.faults.iter().filter(|fault| fault.known).count();
        match set {
            Set::Nulls => all.push(design(Vec::new(), Strength::Clear, "null".to_string())),
            Set::Effects => {
                for (fault, strength) in (0..known).flat_map(|f| Strength::ALL.map(|s| (f, s))) {
                    all.push(design(
                        vec![fault],
                        strength,
                        format!("{}/{}", name(fault), strength.name()),
                    ));
                }
            }
            Set::Unknown => {
                for fault in known..made.faults.len() {
                    for strength in [Strength::Clear, Strength::Moderate] {
                        all.push(design(
                            vec![fault],
                            strength,
                            format!("{}/{}", name(fault), strength.name()),
                        ));
                    }
                }
            }
            Set::Pairs => {
                let mut random = Random::new(0, kind.name);
                for _ in 0..PAIRS {
                    let first = random.index(known);
                    let second = (first + 1 + random.index(known - 1)) % known;
                    let what = format!("{} and {}", name(first), name(second));
                    all.push(design(vec![first, second], Strength::Moderate, what));
                }
            }
        }
    }
    all.retain(|design| design.key.contains(only));
    all
}

/// The design of a seed: seeds that follow each other are far apart in the list, and all are met before one returns.
pub(crate) fn of_seed(designs: &[Design], seed: u64) -> &Design {
    let count = designs.len() as u64;
    let mut stride = (count as f64 * 0.618).round().max(1.0) as u64;
    while divisor(stride, count) != 1 {
        stride += 1;
    }
    &designs[(seed.wrapping_mul(stride) % count) as usize]
}

fn divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { divisor(b, a % b) }
}
