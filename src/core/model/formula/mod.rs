//! Formulas over recorded channels: `(da_right - da_left)/2` as a model input, `mean(alpha, 5)` as a start value.

mod evaluate;
mod filter;
mod position;
mod recorded;
mod samples;
mod spline;

use super::dimensions::measure;
use super::expression::{self, Expression, SyntaxError, written_unit};
use crate::flight::Dimension;
use evaluate::{Unfit, Value, evaluate};
pub use recorded::Recorded;

/// A formula that is evaluated on the samples of one recording, in SI.
#[derive(Clone, Debug)]
pub struct ChannelFormula {
    text: String,
    expression: Expression,
}

/// Why a formula gives no numbers on a recording.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum FormulaError {
    /// The text is no expression.
    #[error("'{text}': {source}")]
    Syntax {
        /// The formula, shortened where it is long.
        text: String,
        /// What is wrong, and where.
        source: SyntaxError,
    },
    /// A name that the recording does not have.
    #[error("'{text}': there is no channel '{channel}'; recorded are {}", known.join(", "))]
    UnknownChannel {
        /// The formula, shortened where it is long.
        text: String,
        /// The name.
        channel: String,
        /// All channels of the recording.
        known: Vec<String>,
    },
    /// Units that do not agree, as in a sum of an angle and a speed.
    #[error("'{text}': column {column}: {message}")]
    UnitMismatch {
        /// The formula, shortened where it is long.
        text: String,
        /// The place in it, from 1.
        column: usize,
        /// Which units they are.
        message: String,
    },
    /// A function's argument that does not fit the recording, as a frequency beyond half its rate.
    #[error("'{text}': column {column}: {message}")]
    BadArgument {
        /// The formula, shortened where it is long.
        text: String,
        /// The place in it, from 1.
        column: usize,
        /// What does not fit, and what would.
        message: String,
    },
    /// A single finite number was asked for, and it gives none.
    #[error("'{text}' gives no number: {why}")]
    NoNumber {
        /// The formula, shortened where it is long.
        text: String,
        /// What is in the way.
        why: String,
    },
}

impl FormulaError {
    /// The stable word for it.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Syntax { .. } => "syntax_error",
            Self::UnknownChannel { .. } => "unknown_channel",
            Self::UnitMismatch { .. } => "unit_mismatch",
            Self::BadArgument { .. } => "bad_argument",
            Self::NoNumber { .. } => "missing_values",
        }
    }
}

impl ChannelFormula {
    /// # Errors
    /// The text is no expression.
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        match expression::parse(text) {
            Ok(expression) => Ok(Self {
                text: text.to_string(),
                expression,
            }),
            Err(source) => Err(FormulaError::Syntax {
                text: shortened(text),
                source,
            }),
        }
    }

    /// Checks names and units against a recording and says what the formula measures;
    /// `None` where it is a literal zero.
    ///
    /// # Errors
    /// A channel that is not recorded, or units that do not agree.
    pub fn dimension(&self, on: &dyn Recorded) -> Result<Option<Dimension>, FormulaError> {
        let channel = |name: &str| match written_unit(name) {
            Some(unit) => unit.ok().map(|unit| unit.dimension),
            None => on.channel(name).map(|(_, dimension)| dimension),
        };
        for (name, _) in self.expression.names() {
            if name != "pi" && channel(name).is_none() {
                let known = on.names();
                return Err(FormulaError::UnknownChannel {
                    text: shortened(&self.text),
                    channel: name.to_string(),
                    known,
                });
            }
        }
        let dimension = |name: &str| {
            if name == "pi" {
                Some(Dimension::NONE)
            } else {
                channel(name)
            }
        };
        measure(&self.expression, &dimension).map_err(|mismatch| FormulaError::UnitMismatch {
            text: shortened(&self.text),
            column: mismatch.span.start + 1,
            message: mismatch.message,
        })
    }

    /// One value a sample; NaN where a channel has none.
    ///
    /// # Errors
    /// As [`Self::dimension`]; or a function's argument does not fit the recording.
    pub fn samples(&self, on: &dyn Recorded) -> Result<Vec<f64>, FormulaError> {
        self.dimension(on)?;
        let value = evaluate(&self.expression, on).map_err(|unfit| self.unfit(unfit))?;
        Ok(value.into_values(on.time().len()))
    }

    /// A single number: `first`, `mean` and `largest_rate` reduce a channel to one.
    ///
    /// # Errors
    /// As [`Self::dimension`]; or the formula varies with the sample, or gives no finite number.
    pub fn number(&self, on: &dyn Recorded) -> Result<f64, FormulaError> {
        self.dimension(on)?;
        let no_number = |why: &str| FormulaError::NoNumber {
            text: shortened(&self.text),
            why: why.to_string(),
        };
        match evaluate(&self.expression, on).map_err(|unfit| self.unfit(unfit))? {
            Value::One(value) if value.is_finite() => Ok(value),
            Value::One(_) => Err(no_number(
                "a value is missing there, or the arithmetic has no result",
            )),
            Value::Each(_) => Err(no_number(
                "it varies with the sample; use first(channel), mean(channel, seconds) or largest_rate(channel)",
            )),
        }
    }
}

impl ChannelFormula {
    fn unfit(&self, Unfit { span, message }: Unfit) -> FormulaError {
        FormulaError::BadArgument {
            text: shortened(&self.text),
            column: span.start + 1,
            message,
        }
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(80).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Two;

    impl Recorded for Two {
        fn time(&self) -> &[f64] {
            &[0.0, 1.0, 2.0, 3.0]
        }
        fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
            let values: &[f64] = match name {
                "left" => &[1.0, 2.0, 3.0, 4.0],
                "right" => &[5.0, 4.0, 3.0, f64::NAN],
                "sparse" => &[f64::NAN, 7.0, f64::NAN, 9.0],
                _ => return None,
            };
            Some((values, Dimension::NONE))
        }
        fn names(&self) -> Vec<String> {
            ["left", "right", "sparse"].map(String::from).to_vec()
        }
    }

    #[test]
    fn derives_channels() {
        let values = ChannelFormula::parse("(right - left)/2")
            .unwrap()
            .samples(&Two)
            .unwrap();
        assert_eq!(values[..3], [2.0, 1.0, 0.0]);
        assert!(values[3].is_nan());
        let number = |text: &str| ChannelFormula::parse(text).unwrap().number(&Two);
        assert_eq!(number("mean(left, 2)"), Ok(1.5));
        assert_eq!(number("2*first(right)"), Ok(10.0));
        // missing values do not count, but there must be some
        assert_eq!(number("mean(right, 9)"), Ok(4.0));
        assert_eq!(number("first(sparse)"), Ok(7.0));
        assert_eq!(number("largest_rate(left^2)"), Ok(7.0));
        assert_eq!(number("largest_rate(sparse)"), Ok(1.0));
        assert_eq!(number("largest_rate(2)"), Ok(0.0));
        assert_eq!(
            number("mean(sparse, 1)").unwrap_err().code(),
            "missing_values"
        );
        assert!(
            number("left")
                .unwrap_err()
                .to_string()
                .contains("varies with the sample")
        );
    }

    #[test]
    fn fills_in_between_values_only() {
        let filled = |text: &str| ChannelFormula::parse(text).unwrap().samples(&Two).unwrap();
        let sparse = filled("2*interpolated(sparse)");
        assert!(sparse[0].is_nan());
        assert_eq!(sparse[1..], [14.0, 16.0, 18.0]);
        assert!(filled("interpolated(right)")[3].is_nan());
    }

    #[test]
    fn what_is_missing_stays_missing() {
        for text in [
            "min(right, 9)",
            "max(0, right)",
            "if(9 >= right, 1, 2)",
            "right^0",
            "1^right",
            "sign(right)",
            "if(right > 0, 1, 2)",
        ] {
            let values = ChannelFormula::parse(text).unwrap().samples(&Two).unwrap();
            assert!(values[3].is_nan(), "{text}: {values:?}");
            assert!(values[..3].iter().all(|value| value.is_finite()), "{text}");
        }
        // what is not chosen may be missing
        let chosen = ChannelFormula::parse("if(left < 4, right, 7)").unwrap();
        assert_eq!(chosen.samples(&Two).unwrap(), [5.0, 4.0, 3.0, 7.0]);
    }

    #[test]
    fn names_what_is_not_recorded() {
        let error = ChannelFormula::parse("left - middle")
            .unwrap()
            .samples(&Two)
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            "'left - middle': there is no channel 'middle'; recorded are left, right, sparse"
        );
    }
}
