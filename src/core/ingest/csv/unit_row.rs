//! A row of units below the header: `s;deg;deg/s`.

use super::super::{
    cell::{Decimal, is_missing, number},
    label::Label,
    stamp::Stamp,
};

/// Whether the cells of the first row are units and no sample: words, and in the columns called time no
/// number and no time stamp. `1` is the unit of a pure number.
pub(super) fn is_one(names: &[&str], cells: &[&str], decimal: Decimal) -> bool {
    let is_value = |cell: &str| {
        number(cell, decimal).is_some_and(f64::is_finite) || Stamp::parse(cell).is_some()
    };
    let is_time = |name: &str| {
        let label = Label::split(name);
        label.is_called_time() || label.is_called_timestamp()
    };
    let may_be_unit =
        |(name, cell): (&&str, &&str)| !is_value(cell) || (*cell == "1" && !is_time(name));
    let is_word = |cell: &&str| !is_missing(cell) && number(cell, decimal).is_none();
    names.len() == cells.len()
        && names.iter().zip(cells).all(may_be_unit)
        && cells.iter().any(is_word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_told_from_samples() {
        let is_one = |names: &str, row: &str| {
            let cells = |line: &'static str| line.split(';').collect::<Vec<_>>();
            let names = cells(Box::leak(names.to_string().into_boxed_str()));
            is_one(
                &names,
                &cells(Box::leak(row.to_string().into_boxed_str())),
                Decimal::Point,
            )
        };
        for row in ["s;deg;deg/s", "[s];(deg);1", "UTC;;deg", ";deg;-", "ms;%;%"] {
            assert!(is_one("t;a;b", row), "{row}");
        }
        for row in [
            "0;deg;deg/s",
            "12:00:00;-;-",
            "x;2;1",
            ";;",
            "nan;na;",
            "s;deg",
            "1;-;-",
        ] {
            assert!(!is_one("t;a;b", row), "{row}");
        }
    }
}
