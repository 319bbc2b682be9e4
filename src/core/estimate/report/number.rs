//! JSON has no word for a number out of range: it is written `null`, and read back as NaN.

use serde::{Deserialize, Deserializer};

pub(crate) fn null_as_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Option::<f64>::deserialize(deserializer).map(|number| number.unwrap_or(f64::NAN))
}

pub(crate) fn nulls_as_nan<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Vec<f64>, D::Error> {
    let numbers = Vec::<Option<f64>>::deserialize(deserializer)?;
    Ok(numbers
        .into_iter()
        .map(|number| number.unwrap_or(f64::NAN))
        .collect())
}

#[cfg(test)]
mod tests {
    use crate::estimate::report::fit::{OutputFit, TheilShares};
    use crate::estimate::report::history::OutputSeries;

    #[test]
    fn a_number_out_of_range_is_read_back() {
        let fit = OutputFit {
            name: "a".into(),
            unit: "-".into(),
            rms: 0.0,
            bias: 0.0,
            r_squared: f64::NAN,
            theil: 0.5,
            theil_shares: TheilShares::default(),
            autocorrelation: 0.0,
            effective_samples: 1.0,
            samples: 3,
        };
        let read: OutputFit = serde_json::from_str(&serde_json::to_string(&fit).unwrap()).unwrap();
        assert!(read.r_squared.is_nan() && read.theil == 0.5);
        let series = OutputSeries {
            name: "a".into(),
            unit: "-".into(),
            measured: vec![1.0, f64::NAN],
            model: vec![0.5, 0.5],
            declared: Vec::new(),
            residual: vec![0.5, f64::NAN],
        };
        let text = serde_json::to_string(&series).unwrap();
        assert!(text.contains("[1.0,null]"), "{text}");
        let read: OutputSeries = serde_json::from_str(&text).unwrap();
        assert!(read.measured[0] == 1.0 && read.measured[1].is_nan());
    }
}
