//! What measured numbers are turned into: straight lines and polynomials, one behind the other.

use super::property::{Properties, Value};

/// Scales in their order: the lowest power first in each.
#[derive(Default)]
pub(super) struct Scales(Vec<Vec<f64>>);

const MOST: usize = 20;
const MOST_COEFFICIENTS: usize = 20;

impl Scales {
    /// `None` where there is one that is not read.
    pub(super) fn of(properties: &Properties) -> Option<Self> {
        let number = |name: &str| match properties.get(name) {
            Some(Value::Number(number)) => Some(*number),
            _ => None,
        };
        let text = |name: &str| match properties.get(name) {
            Some(Value::Text(text)) => Some(text.as_str()),
            _ => None,
        };
        let count = number("NI_Number_Of_Scales").unwrap_or(0.0) as usize;
        if count == 0 || text("NI_Scaling_Status") == Some("scaled") {
            return Some(Self::default());
        }
        if count > MOST {
            return None;
        }
        let mut scales = Vec::new();
        for at in 0..count {
            let of = |name: &str| format!("NI_Scale[{at}]_{name}");
            // the first one of DAQmx says only how its numbers are stored
            let Some(kind) = text(&of("Scale_Type")) else {
                continue;
            };
            let coefficients = match kind {
                "Linear" => vec![
                    number(&of("Linear_Y_Intercept"))?,
                    number(&of("Linear_Slope"))?,
                ],
                "Polynomial" => {
                    let count = number(&of("Polynomial_Coefficients_Size"))? as usize;
                    let coefficient =
                        |k: usize| number(&of(&format!("Polynomial_Coefficients[{k}]")));
                    (0..count.min(MOST_COEFFICIENTS))
                        .map(coefficient)
                        .collect::<Option<_>>()?
                }
                _ => return None,
            };
            scales.push(coefficients);
        }
        Some(Self(scales))
    }

    pub(super) fn apply(&self, value: f64) -> f64 {
        let polynomial = |value: f64, coefficients: &Vec<f64>| {
            coefficients
                .iter()
                .rev()
                .fold(0.0, |sum, coefficient| sum * value + coefficient)
        };
        self.0.iter().fold(value, polynomial)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_applied_one_behind_the_other() {
        let mut properties = Properties::new();
        assert_eq!(Scales::of(&properties).unwrap().apply(3.0), 3.0);
        let mut say = |name: &str, value: Value| properties.insert(name.to_string(), value);
        say("NI_Number_Of_Scales", Value::Number(3.0));
        say("NI_Scale[1]_Scale_Type", Value::Text("Linear".to_string()));
        say("NI_Scale[1]_Linear_Slope", Value::Number(2.0));
        say("NI_Scale[1]_Linear_Y_Intercept", Value::Number(1.0));
        say(
            "NI_Scale[2]_Scale_Type",
            Value::Text("Polynomial".to_string()),
        );
        say(
            "NI_Scale[2]_Polynomial_Coefficients_Size",
            Value::Number(3.0),
        );
        for (k, coefficient) in [1.0, 0.0, 0.5].into_iter().enumerate() {
            say(
                &format!("NI_Scale[2]_Polynomial_Coefficients[{k}]"),
                Value::Number(coefficient),
            );
        }
        assert_eq!(Scales::of(&properties).unwrap().apply(3.0), 25.5);
        let table = Value::Text("Table".to_string());
        properties.insert("NI_Scale[2]_Scale_Type".to_string(), table);
        assert!(Scales::of(&properties).is_none());
    }
}
