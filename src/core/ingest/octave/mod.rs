//! Variables as Octave writes them as text (`save -text`, its usual format): scalars, matrices, ranges and structs of them.
//!
//! The format is that of `save_ascii` in Octave's `libinterp/octave-value/ov-*.cc`, as its manual (Simple File I/O) shows it.
//! What is no real matrix (text, cells, arrays of structs, complex numbers, functions) is passed over, and listed as what it is.

mod kind;
mod scan;
mod text;
mod variable;

use super::{IngestError, Limits, code, fault::of_file, mapping::Mapping, note, reading::Reading};
use scan::Scan;
use variable::Variables;

/// Whether a file begins as Octave's do.
pub(super) fn is_octave(bytes: &[u8]) -> bool {
    bytes.starts_with(b"# Created by Octave")
}

/// Reads variables as the mapping says.
///
/// # Errors
/// It is damaged, or does not have what the mapping names; or there is no mapping: then the message lists what the file has.
pub(super) fn read(
    bytes: &[u8],
    mapping: Option<&Mapping>,
    limits: &Limits,
) -> Result<Reading, IngestError> {
    let Scan { all, left_out, .. } = Scan::of(bytes, limits)?;
    let mut variables = Variables::of(all);
    let Some(mapping) = mapping else {
        let message = format!(
            "a file of Octave has no units; say with a mapping where time and channels are. This one has {}",
            variables.contents()
        );
        return Err(of_file(code::MAPPING_NEEDED, message).into());
    };
    let mut reading = mapping.apply(&mut variables, limits)?;
    let left_out = [left_out, variables.saved_again].concat();
    let remedy = "save what is needed of them as matrices, each under a name of its own";
    reading.findings.extend(note::left_out(&left_out, remedy));
    Ok(reading)
}
