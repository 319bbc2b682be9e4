//! What an engineer knows before the data: what things are, what cannot be, how large it may be, what shares a clock.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::effect::{Effect, EffectKind};
use super::plausible::Plausible;
use crate::flight::{PhysicalQuantity, Unit};
use crate::model::EditKind;

/// What is known before the data.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Knowledge {
    /// What recorded channels are that the model does not use, where their names do not say so.
    #[serde(
        default,
        deserialize_with = "crate::model::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    #[schema(example = json!({"boom_1": "angle_of_attack"}))]
    pub quantities: IndexMap<String, PhysicalQuantity>,
    /// Effects that are not there: a kind (`sensor_delay`), a target (`alpha`), or a kind and a target
    /// (`sensor_scale of alpha`), as effects are named in the answer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["sensor_delay", "sensor_scale of alpha"]))]
    pub exclude: Vec<String>,
    /// How large effects may be, in place of what is usual.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub known: Vec<KnownSize>,
    /// Inputs and outputs that share a clock: each list is one candidate for a delay.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!([["alpha", "beta"], ["p", "q", "r"]]))]
    pub clocks: Vec<Vec<String>>,
}

/// How large an effect may be: its first parameter.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct KnownSize {
    /// The kind of effect.
    pub kind: EditKind,
    /// Absent: of all targets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "alpha")]
    pub target: Option<String>,
    /// Absent: with all terms.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "x")]
    pub term: Option<String>,
    /// Standard deviation about no effect, which counts in the estimate; 0: it is not there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = 0.1, minimum = 0.0)]
    pub size_sd: Option<f64>,
    /// Where its estimate may not go beyond.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<f64>,
    /// Largest size, SI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<f64>,
    /// Of these numbers; absent: SI.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(example = "m")]
    pub unit: Option<String>,
}

/// Beyond this many standard deviations nothing is looked for.
const FAR: f64 = 5.0;

impl Knowledge {
    /// Whether an entry of `exclude` means an effect.
    pub fn excludes(entry: &str, effect: &Effect) -> bool {
        let kind = effect.word();
        let of = format!("{kind} of {}", effect.target);
        entry == kind || entry == effect.target || entry == of || entry == effect.name()
    }

    /// Whether an effect may be there, for all that is known.
    pub(super) fn allows(&self, effect: &Effect) -> bool {
        let is_excluded = |entry: &String| Self::excludes(entry, effect);
        let is_nothing = |known: &KnownSize| known.size_sd == Some(0.0) && known.means(effect);
        !self.exclude.iter().any(is_excluded) && !self.known.iter().any(is_nothing)
    }

    /// Takes out what is known not to be there, and bounds what is known.
    pub(super) fn apply(&self, effects: &mut Vec<Effect>) {
        effects.retain(|effect| self.allows(effect));
        for known in &self.known {
            for effect in effects.iter_mut().filter(|effect| known.means(effect)) {
                effect.plausible = Some(known.range(effect.plausible));
            }
        }
    }
}

impl KnownSize {
    /// Whether an effect is one of those that it speaks of.
    pub fn means(&self, effect: &Effect) -> bool {
        effect.kind == EffectKind::Edit(self.kind)
            && self
                .target
                .as_ref()
                .is_none_or(|target| *target == effect.target)
            && self
                .term
                .as_ref()
                .is_none_or(|term| Some(term) == effect.term.as_ref())
    }

    fn range(&self, usual: Option<Plausible>) -> Plausible {
        let scale = (self.unit.as_deref())
            .and_then(|unit| Unit::parse(unit).ok())
            .map_or(1.0, |unit| unit.scale);
        let sd = self.size_sd.map(|sd| sd * scale);
        let far = sd.map(|sd| FAR * sd);
        let usual_lower = far.map(|far| -far).or(usual.map(|usual| usual.lower));
        let usual_upper = far.or(usual.map(|usual| usual.upper));
        let lower = self.lower.map(|lower| lower * scale).or(usual_lower);
        let upper = self.upper.map(|upper| upper * scale).or(usual_upper);
        let (lower, upper) = (lower.unwrap_or(f64::MIN), upper.unwrap_or(f64::MAX));
        Plausible {
            lower,
            upper,
            sd: sd
                .or(usual.map(|usual| usual.sd))
                .unwrap_or(0.5 * (upper - lower)),
            known: sd.is_some(),
        }
    }
}
