//! Times that are none of a flight: what is worked out from them would leave the range of numbers.

use super::{IngestError, code, fault::of_file};

/// A nanosecond, s. Nothing that is recorded in flight is sampled faster.
const SHORTEST_STEP: f64 = 1e-9;

/// Three hundred years, s.
const LONGEST: f64 = 1e10;

/// # Errors
/// A step is shorter than a nanosecond, or the recording longer than three hundred years.
pub(super) fn check(time: &[f64]) -> Result<(), IngestError> {
    let [first, .., last] = time else {
        return Ok(());
    };
    let is_short = |pair: &[f64]| pair[1] - pair[0] < SHORTEST_STEP;
    let refuse = |message: String| Err(of_file(code::TIME_RANGE, message).into());
    if let Some(at) = time.windows(2).position(is_short) {
        let (before, step) = (time[at], time[at + 1] - time[at]);
        return refuse(format!(
            "time goes on by {step:e} s from {before} s in row {}, which is less than a nanosecond; see to the unit of time, or drop the row",
            at + 1
        ));
    }
    let duration = last - first;
    if duration > LONGEST {
        return refuse(format!(
            "the recording lasts {duration:e} s, more than {LONGEST:e} s; see to the unit of time"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Format, Limits, read};

    /// A step of 5e-324 s has no rate that is a number: its recording was taken, and no list with it could be read any more.
    #[test]
    fn times_of_no_flight_are_refused() {
        let refused = |times: [&str; 3]| {
            let rows = times.map(|time| format!("{time},1\n")).concat();
            let csv = format!("t[s],q[rad/s]\n{rows}");
            let error = read(csv.as_bytes(), Format::Csv, &Limits::default()).err();
            error.map(|error| (error.faults()[0].code.clone(), error.to_string()))
        };
        assert_eq!(refused(["0", "1e-6", "2e-6"]), None);
        assert_eq!(refused(["0", "1", "1e9"]), None);
        for (times, place) in [
            (["0", "5e-324", "1e-323"], "row 1"),
            (["-1", "0", "1e-300"], "row 2"),
            (["0", "1", "1e20"], "1e20 s"),
            (["-1e308", "0", "1e308"], "the recording lasts"),
        ] {
            let (code, message) = refused(times).expect("refused");
            assert_eq!(code, "time_range", "{message}");
            assert!(message.contains(place), "{message}");
        }
    }
}
