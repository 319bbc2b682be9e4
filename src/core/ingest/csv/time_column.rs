//! Which column of a table is time.

use super::{parts, titles::Titles};

/// The first column called t or time; or by another word for it; or that has time stamps; or the first of all where it has a
/// unit of time. `T[K]` before `t[s]` is a temperature: one with a unit of time, or with time stamps, goes first.
pub(super) fn found(titles: &Titles) -> Option<usize> {
    titles.names.as_ref()?;
    let of_all = |condition: &dyn Fn(usize) -> bool| {
        let mut columns = (0..titles.width).filter(|&at| !titles.is_empty(at));
        columns.find(|&at| condition(at))
    };
    let is_time = |at: usize| titles.any_label(at).is_called_time();
    let is_clock = |at: usize| titles.any_label(at).is_called_time_or_stamp();
    let has_unit = |at: usize| titles.any_label(at).has_unit_of_time();
    let is_stamp = |at: usize| titles.stamp(at).is_some();
    let is_readable = |at: usize| !titles.is_text(at) && !titles.has_dates(at);
    of_all(&|at| is_time(at) && has_unit(at))
        .or_else(|| of_all(&|at| is_time(at) && is_stamp(at)))
        .or_else(|| of_all(&|at| is_clock(at) && (has_unit(at) || is_stamp(at))))
        .or_else(|| of_all(&|at| is_time(at) && is_readable(at)))
        .or_else(|| of_all(&|at| is_clock(at) && is_readable(at)))
        .or_else(|| of_all(&is_stamp))
        .or_else(|| {
            of_all(&|at| {
                has_unit(at)
                    && titles.title(at).to_lowercase().contains("time")
                    && increases(titles, at)
            })
        })
        .or_else(|| of_all(&is_time))
        .or_else(|| of_all(&|at| unit_word(titles, at).is_some() && increases(titles, at)))
        .or_else(|| Some(0).filter(|&at| has_unit(at) && increases(titles, at)))
}

/// The unit that a title is, and nothing else: `Milliseconds`, `sec`.
pub(super) fn unit_word(titles: &Titles, at: usize) -> Option<&'static str> {
    parts::unit_of(titles, at).filter(|unit| ["s", "ms", "us", "ns"].contains(unit))
}

fn increases(titles: &Titles, at: usize) -> bool {
    let numbers = titles
        .first
        .iter()
        .filter_map(|row| row.get(at)?.trim().parse::<f64>().ok());
    let numbers: Vec<f64> = numbers.collect();
    numbers.len() > 1 && numbers.windows(2).all(|pair| pair[0] < pair[1])
}
