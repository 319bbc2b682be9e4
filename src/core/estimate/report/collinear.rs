//! Parameters that the data cannot tell apart.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Parameters of which the data see only some combinations.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CollinearSet {
    /// One name: the data cannot see it. Several: only a combination of them shows.
    #[schema(example = json!(["a_eq", "de_eq"]))]
    pub parameters: Vec<String>,
    /// The direction in which nothing changes, by parameter, in the parameters' units, largest component 1.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub direction: Vec<f64>,
}

impl CollinearSet {
    /// From places of θ and the direction, SI, in which nothing changes.
    pub(crate) fn named(members: &[(usize, f64)], name: impl Fn(usize) -> (String, f64)) -> Self {
        let own = |&(place, component): &(usize, f64)| {
            let (name, scale) = name(place);
            (name, component / scale)
        };
        let (parameters, mut direction): (Vec<String>, Vec<f64>) = members.iter().map(own).unzip();
        let largest = direction
            .iter()
            .fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a });
        direction
            .iter_mut()
            .for_each(|component| *component /= largest);
        Self {
            parameters,
            direction,
        }
    }
}
