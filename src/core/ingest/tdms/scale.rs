//! What measured numbers are turned into: straight lines and polynomials, one behind the other.

use super::property::{Properties, Value};

/// Scales in their order: the lowest power first in each.
#[derive(Default)]
pub(super) struct Scales(Vec<Vec<f64>>);

const MOST: usize = 20;
const MOST_COEFFICIENTS: usize = 20;
/// Those of a polynomial that does not say how many it has.
const USUAL_COEFFICIENTS: usize = 4;
/// The source of a scale that has what was measured.
const MEASURED: f64 = 0xffff_ffffu32 as f64;

impl Scales {
    /// The first that one of these says: a channel, its group, the file. `None` where there is a scale that is not read.
    pub(super) fn first<'p>(of: impl IntoIterator<Item = &'p Properties>) -> Option<Self> {
        let says = |properties: &&Properties| {
            let is_scaled = Some(&Value::Text("scaled".to_string()));
            matches!(properties.get("NI_Number_Of_Scales"), Some(Value::Number(count)) if *count >= 1.0)
                || properties.get("NI_Scaling_Status") == is_scaled
        };
        match of.into_iter().find(says) {
            Some(properties) => Self::of(properties),
            None => Some(Self::default()),
        }
    }

    fn of(properties: &Properties) -> Option<Self> {
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
        let mut before = None;
        for at in 0..count {
            let of = |name: &str| format!("NI_Scale[{at}]_{name}");
            // the first one of DAQmx says only how its numbers are stored
            let Some(kind) = text(&of("Scale_Type")) else {
                continue;
            };
            // the first has what was measured, each other one what the one before makes of it
            let source = number(&of(&format!("{kind}_Input_Source")));
            let is_of_before = match (source, before) {
                (None, _) => true,
                (Some(source), Some(before)) => source == before as f64,
                (Some(source), None) => {
                    source == MEASURED || at.checked_sub(1).is_some_and(|at| source == at as f64)
                }
            };
            if !is_of_before {
                return None;
            }
            before = Some(at);
            let coefficients = match kind {
                "Linear" => vec![
                    number(&of("Linear_Y_Intercept"))?,
                    number(&of("Linear_Slope"))?,
                ],
                "Polynomial" => {
                    let count = number(&of("Polynomial_Coefficients_Size"));
                    let count = count.map_or(USUAL_COEFFICIENTS, |count| count as usize);
                    if count > MOST_COEFFICIENTS {
                        return None;
                    }
                    let coefficient =
                        |k: usize| number(&of(&format!("Polynomial_Coefficients[{k}]")));
                    (0..count).map(coefficient).collect::<Option<_>>()?
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
        // those of a group, or of a channel that has its own
        let none = Properties::new();
        let scaled = |of: [&Properties; 2]| Scales::first(of).unwrap().apply(3.0);
        assert_eq!(scaled([&none, &properties]), 25.5);
        assert_eq!(scaled([&none, &none]), 3.0);
        let mut done = Properties::new();
        let status = Value::Text("scaled".to_string());
        done.insert("NI_Scaling_Status".to_string(), status);
        assert_eq!(scaled([&done, &properties]), 3.0);
        // another source than the scale before
        let source = "NI_Scale[2]_Polynomial_Input_Source".to_string();
        properties.insert(source.clone(), Value::Number(1.0));
        assert_eq!(Scales::of(&properties).unwrap().apply(3.0), 25.5);
        properties.insert(source.clone(), Value::Number(0.0));
        assert!(Scales::of(&properties).is_none());
        properties.remove(&source);
        // a polynomial of four, where it does not say how many; and one of too many
        let size = "NI_Scale[2]_Polynomial_Coefficients_Size".to_string();
        properties.remove(&size);
        assert!(Scales::of(&properties).is_none());
        let fourth = "NI_Scale[2]_Polynomial_Coefficients[3]".to_string();
        properties.insert(fourth, Value::Number(1.0));
        assert_eq!(Scales::of(&properties).unwrap().apply(3.0), 368.5);
        properties.insert(size, Value::Number(21.0));
        assert!(Scales::of(&properties).is_none());
        let table = Value::Text("Table".to_string());
        properties.insert("NI_Scale[2]_Scale_Type".to_string(), table);
        assert!(Scales::of(&properties).is_none());
    }
}
