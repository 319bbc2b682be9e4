//! What a user may ask of a structure determination.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Which output is explained, by what, and when a term is worth it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct StructureOptions {
    /// The output of the model whose equation is looked for; the model has no states. What stands in its equation stays
    /// there, with its parameters at their start values: terms are looked for in what is left. Write `0` for nothing.
    #[schema(example = "Cm")]
    pub output: String,
    /// How terms are chosen.
    #[serde(default)]
    pub method: StructureMethod,
    /// Terms of your own: expressions in the inputs of the model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["alpha", "alpha^2", "alpha*de", "sin(alpha)"]))]
    pub terms: Vec<String>,
    /// Inputs of whose powers and products all terms up to `order` are made.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["alpha", "q_hat", "de"]))]
    pub variables: Vec<String>,
    /// The highest order of a term that is made of `variables`: the sum of the powers.
    #[serde(default = "default_order")]
    #[schema(example = 2, minimum = 1, maximum = 8)]
    pub order: usize,
    /// Whether there is a constant term; it then is in the model from the start.
    #[serde(default = "yes")]
    pub constant: bool,
    /// Of stepwise regression: a term comes in where its partial F is above this.
    #[serde(default = "default_f")]
    #[schema(example = 4.0, minimum = 0.0)]
    pub f_to_enter: f64,
    /// Of stepwise regression: a term goes out where its partial F falls below this; not above `f_to_enter`.
    #[serde(default = "default_f")]
    #[schema(example = 4.0, minimum = 0.0)]
    pub f_to_remove: f64,
    /// Of stepwise regression: no term comes in that explains less than this share of the variation of the output.
    #[serde(default)]
    #[schema(example = 0.005, minimum = 0.0, maximum = 1.0)]
    pub least_r_squared: f64,
    /// Most terms, the constant not counted; absent: as many as there are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 8)]
    pub most_terms: Option<usize>,
}

/// How terms are chosen.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum StructureMethod {
    /// Stepwise regression: in each step the term of the largest partial F comes in, and those go out that it makes
    /// superfluous.
    #[default]
    Stepwise,
    /// Multivariate orthogonal functions: terms are made orthogonal to those before them, in the order of what they explain,
    /// and those of the least predicted squared error are kept.
    Orthogonal,
}

const fn default_order() -> usize {
    2
}

const fn yes() -> bool {
    true
}

const fn default_f() -> f64 {
    4.0
}

/// The highest order of a generated term.
const MOST_ORDER: usize = 8;

impl StructureOptions {
    /// How terms are chosen, in words.
    pub fn words(&self) -> String {
        let output = &self.output;
        let mut words = match self.method {
            StructureMethod::Stepwise => format!(
                "stepwise regression of {output}: partial F to enter {}, to remove {}",
                self.f_to_enter, self.f_to_remove
            ),
            StructureMethod::Orthogonal => format!(
                "multivariate orthogonal functions of {output}: least predicted squared error"
            ),
        };
        if self.method == StructureMethod::Stepwise && self.least_r_squared > 0.0 {
            words += &format!("; at least {} of the variation", self.least_r_squared);
        }
        if let Some(most) = self.most_terms {
            words += &format!("; at most {most} terms");
        }
        words
    }

    /// Which field is out of range, and what is allowed.
    pub fn fault(&self) -> Option<(&'static str, String)> {
        let is_bound = |value: f64| value >= 0.0 && value.is_finite();
        if self.terms.is_empty() && self.variables.is_empty() {
            let message = "give \"terms\", or \"variables\" of which terms are made";
            return Some(("terms", message.to_string()));
        }
        if !(1..=MOST_ORDER).contains(&self.order) {
            return Some(("order", format!("order must be from 1 to {MOST_ORDER}")));
        }
        if !is_bound(self.f_to_enter) {
            let message = "f_to_enter must be a number from 0";
            return Some(("f_to_enter", message.to_string()));
        }
        if !(is_bound(self.f_to_remove) && self.f_to_remove <= self.f_to_enter) {
            let message = "f_to_remove must be a number from 0 to f_to_enter: a term would come in and go out forever";
            return Some(("f_to_remove", message.to_string()));
        }
        if !(0.0..=1.0).contains(&self.least_r_squared) {
            let message = "least_r_squared must be a share from 0 to 1";
            return Some(("least_r_squared", message.to_string()));
        }
        (self.most_terms == Some(0)).then(|| {
            let message = "most_terms must be at least 1, or left out";
            ("most_terms", message.to_string())
        })
    }
}
