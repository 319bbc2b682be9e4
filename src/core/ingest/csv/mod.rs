//! Tables of text: a header of names and units, one row a sample.
//!
//! The table is found in the first lines: what separates cells, which lines are the header, where the rows begin. Cells are
//! separated by commas, semicolons, tabs, vertical bars or blanks; numbers have decimal points or commas. Units stand in
//! brackets or in a row of their own. Time is a number with a unit, or time stamps, in one column or two. Lines that begin
//! with `#` or `%` are comments. What of this a file has is found out from the file; what can be read in two ways is refused,
//! with the draft of a mapping that says it. What is not needed does no harm: a column that cannot be read is left out.

mod clock;
mod column;
mod decimal;
mod delimiter;
mod described;
mod draft;
mod elsewhere;
mod ending;
mod head;
mod inspection;
mod labview;
mod layout;
mod own_times;
mod parts;
mod plan;
mod read;
mod repeated;
mod report;
mod rows;
mod sample;
mod sample_rows;
mod samples;
mod stated;
mod table;
mod time;
mod time_column;
mod titles;
mod trouble;
mod typed;

pub(super) use inspection::inspect;
pub use inspection::{InspectedColumn, Inspection};
pub(super) use read::read;
pub(super) use typed::{inspect_columns, read_columns};

#[cfg(test)]
mod mapped_tests;
#[cfg(test)]
mod tests;
