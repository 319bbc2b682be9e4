//! Frequency responses as CSV.

use crate::dynamics::FrequencyResponse;
use crate::ingest::CsvWriter;

/// A row for each response and frequency.
pub fn responses_as_csv(responses: &[FrequencyResponse]) -> String {
    let unit = responses
        .first()
        .map(|response| response.frequency_unit)
        .unwrap_or_default();
    let mut csv = CsvWriter::with_header([
        "input".to_string(),
        "output".to_string(),
        format!("frequency[{}]", unit.symbol()),
        "magnitude[dB]".to_string(),
        "magnitude_standard_error[dB]".to_string(),
        "phase[deg]".to_string(),
        "phase_standard_error[deg]".to_string(),
    ]);
    for response in responses {
        for (row, frequency) in response.frequency.iter().enumerate() {
            csv.text(&response.input);
            csv.text(&response.output);
            csv.number(*frequency);
            csv.number(response.magnitude_db[row]);
            csv.number(response.magnitude_db_standard_error.get(row).copied());
            csv.number(response.phase_deg[row]);
            csv.number(response.phase_deg_standard_error.get(row).copied());
            csv.end_row();
        }
    }
    csv.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::FrequencyUnit;

    #[test]
    fn what_has_no_standard_error_has_empty_cells() {
        let response = FrequencyResponse {
            input: "de".into(),
            output: "q".into(),
            unit: "(rad/s)/rad".into(),
            frequency_unit: FrequencyUnit::Hertz,
            frequency: vec![0.5],
            magnitude_db: vec![6.0],
            magnitude_db_standard_error: Vec::new(),
            phase_deg: vec![-90.0],
            phase_deg_standard_error: Vec::new(),
        };
        let expected = "input,output,frequency[Hz],magnitude[dB],magnitude_standard_error[dB],phase[deg],phase_standard_error[deg]\nde,q,0.5,6.0,,-90.0,\n";
        assert_eq!(responses_as_csv(&[response]), expected);
    }
}
