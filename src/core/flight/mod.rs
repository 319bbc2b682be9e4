//! What was flown: channels with units, maneuvers, their sampling; aircraft constants and derivatives.
//!
//! Values inside Trimtab are SI (angles in radians). A channel is converted once, when it is built;
//! nothing behind this room ever sees a degree or a knot.
//!
//! Invariant: a maneuver never changes, its time increases, and its channels are as long as its time.

mod aircraft;
mod convention;
mod derivatives;
mod described;
mod dimension;
mod fault;
mod finding;
mod finding_code;
mod flown;
mod maneuver;
mod null;
mod physical;
mod quality;
mod sampling;
mod segments;
mod severity;
mod shown;
mod si_name;
mod unit;
mod unit_spelling;
mod unit_symbols;
mod unit_words;

pub use aircraft::Aircraft;
pub use convention::{by_name, coefficient, steady_speed, wind};
pub use derivatives::{Derivative, WeightedSum, coefficients, derivatives};
pub use described::by_description;
pub use dimension::Dimension;
pub use fault::{Fault, Faults, escape};
pub use finding::{Finding, FindingTally};
pub use finding_code::FindingCode;
pub use flown::{CentreOfGravity, DerivedFrom, Flown, Inertia, Quantity};
pub use maneuver::{Channel, Maneuver, ManeuverError};
pub(crate) use null::null_as_nan;
pub use physical::{Family, Motion, PhysicalQuantity};
pub use quality::{Record, Series, quality, quality_of};
pub use sampling::{GAP_FACTOR, Gap, Sampling};
pub use segments::{Moved, Proposal, ProposedSegment, SegmentKind, Wanted, segments};
pub use severity::Severity;
pub use shown::{
    Shown, bounded, decimals, five_digits, five_digits_beside, p_value, shown_in, two_digits,
    value_and_error, with_digits, with_error,
};
pub use unit::{Unit, UnitError};
