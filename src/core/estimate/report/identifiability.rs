//! What the data can tell of the parameters.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::collinear::CollinearSet;

/// What the data tell of the parameters, before and after.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Identifiability {
    /// At the start values.
    pub before: DataInformation,
    /// At the estimate; absent where none was asked for (`max_iterations` 0).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<DataInformation>,
}

/// What the sensitivities at one θ say of the free parameters.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct DataInformation {
    /// Of the scaled sensitivities, largest first; as many as there are free parameters.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub singular_values: Vec<f64>,
    /// Largest over smallest singular value; `null` where one is zero.
    #[schema(example = 12.7)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub condition_number: f64,
    /// Parameters that no output depends on.
    pub unseen: Vec<String>,
    /// Sets of which the data see only some combinations, exactly: fix one parameter of each.
    pub redundant: Vec<CollinearSet>,
    /// Sets that are nearly so: estimated, but with errors many times what each alone would have.
    pub nearly_collinear: Vec<NearlyCollinearSet>,
    /// Pairs whose errors are correlated by more than 0.99 (white residuals taken for granted).
    pub highly_correlated: Vec<CorrelatedPair>,
}

/// Parameters whose errors a near dependency of the sensitivities magnifies (Belsley, Kuh and Welsch 1980).
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct NearlyCollinearSet {
    /// The names of the set.
    #[schema(example = json!(["b_az", "K_az"]))]
    pub parameters: Vec<String>,
    /// Largest singular value over that of this set: how much the set's errors are magnified.
    #[schema(example = 65.0)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub condition_index: f64,
    /// Of each parameter's variance, the share that is owed to this near dependency.
    #[schema(example = json!([0.99, 0.98]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub variance_proportions: Vec<f64>,
}

/// Two parameters whose errors go together.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct CorrelatedPair {
    /// Their names.
    #[schema(example = json!(["b_az", "K_az"]))]
    pub parameters: [String; 2],
    /// Correlation of their errors, from -1 to 1.
    #[schema(example = -0.997)]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub correlation: f64,
}
