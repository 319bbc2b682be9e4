//! Formulas over recorded channels: `(da_right - da_left)/2` as a model input, `mean(alpha, 5)` as a start value.

use super::dimensions::measure;
use super::expression::{self, BinaryOperator, Expression, Function, Kind, SyntaxError};
use super::scalar::Scalar;
use crate::flight::Dimension;

/// What a formula is evaluated on: channels in SI, all of one length, on one time axis.
pub trait Recorded {
    /// Time of each sample, s.
    fn time(&self) -> &[f64];
    /// Values and dimension of a channel.
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)>;
    /// Names of all channels, for messages.
    fn names(&self) -> Vec<String>;
}

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
        let channel = |name: &str| on.channel(name).map(|(_, dimension)| dimension);
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
    /// As [`Self::dimension`].
    pub fn samples(&self, on: &dyn Recorded) -> Result<Vec<f64>, FormulaError> {
        self.dimension(on)?;
        Ok(evaluate(&self.expression, on).into_values(on.time().len()))
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
        match evaluate(&self.expression, on) {
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

fn shortened(text: &str) -> String {
    text.chars().take(80).collect()
}

/// A number, or one for each sample.
enum Value {
    One(f64),
    Each(Vec<f64>),
}

impl Value {
    fn into_values(self, count: usize) -> Vec<f64> {
        match self {
            Self::One(value) => vec![value; count],
            Self::Each(values) => values,
        }
    }

    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::One(value) => Self::One(f(value)),
            Self::Each(mut values) => {
                values.iter_mut().for_each(|value| *value = f(*value));
                Self::Each(values)
            }
        }
    }

    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        match (self, other) {
            (Self::One(a), b) => b.map(|b| f(a, b)),
            (a, Self::One(b)) => a.map(|a| f(a, b)),
            (Self::Each(mut a), Self::Each(b)) => {
                a.iter_mut().zip(b).for_each(|(a, b)| *a = f(*a, b));
                Self::Each(a)
            }
        }
    }
}

fn evaluate(expression: &Expression, on: &dyn Recorded) -> Value {
    let of = |inner: &Expression| evaluate(inner, on);
    match &expression.kind {
        Kind::Number(value) => Value::One(*value),
        Kind::Name(name) => match on.channel(name) {
            Some((values, _)) => Value::Each(values.to_vec()),
            None => Value::One(std::f64::consts::PI),
        },
        Kind::Negate(inner) => of(inner).map(|v| -v),
        Kind::Binary(operator, left, right) => of(left).zip(of(right), |a, b| match operator {
            BinaryOperator::Add => a + b,
            BinaryOperator::Subtract => a - b,
            BinaryOperator::Multiply => a * b,
            BinaryOperator::Divide => a / b,
            BinaryOperator::Power => a.powf(b),
            BinaryOperator::Less => a.less(b),
            BinaryOperator::LessOrEqual => a.less_or_equal(b),
            BinaryOperator::Greater => b.less(a),
            BinaryOperator::GreaterOrEqual => b.less_or_equal(a),
        }),
        Kind::Call(function, arguments) => call(*function, arguments.iter().map(of).collect(), on),
    }
}

fn call(function: Function, arguments: Vec<Value>, on: &dyn Recorded) -> Value {
    let unary: fn(f64) -> f64 = match function {
        Function::Sin => f64::sin,
        Function::Cos => f64::cos,
        Function::Tan => f64::tan,
        Function::Asin => f64::asin,
        Function::Acos => f64::acos,
        Function::Atan => f64::atan,
        Function::Tanh => f64::tanh,
        Function::Exp => f64::exp,
        Function::Ln => f64::ln,
        Function::Sqrt => f64::sqrt,
        Function::Abs => f64::abs,
        Function::Sign => Scalar::sign,
        _ => return call_many(function, arguments, on),
    };
    arguments
        .into_iter()
        .next()
        .unwrap_or(Value::One(f64::NAN))
        .map(unary)
}

fn call_many(function: Function, arguments: Vec<Value>, on: &dyn Recorded) -> Value {
    let mut arguments = arguments.into_iter();
    let mut next = || arguments.next().unwrap_or(Value::One(f64::NAN));
    match function {
        Function::Atan2 => next().zip(next(), f64::atan2),
        Function::Min => next().zip(next(), f64::min),
        Function::Max => next().zip(next(), f64::max),
        Function::First => match next() {
            Value::Each(values) => Value::One(present(&values).next().unwrap_or(f64::NAN)),
            one @ Value::One(_) => one,
        },
        Function::Mean => match (next(), next()) {
            (Value::Each(values), Value::One(duration)) => {
                let time = on.time();
                let count = time
                    .iter()
                    .take_while(|&&t| t - time[0] < duration)
                    .count()
                    .max(1);
                let values = &values[..count];
                Value::One(present(values).sum::<f64>() / present(values).count() as f64)
            }
            (one, _) => one,
        },
        Function::LargestRate => match next() {
            Value::Each(values) => Value::One(largest_rate(on.time(), &values)),
            Value::One(_) => Value::One(0.0),
        },
        Function::Interpolated => match next() {
            Value::Each(values) => Value::Each(interpolated(on.time(), values)),
            one @ Value::One(_) => one,
        },
        _ => {
            let (condition, yes, no) = (next(), next(), next());
            let count = on.time().len();
            let (yes, no) = (yes.into_values(count), no.into_values(count));
            let mut condition = condition.into_values(count);
            for ((chosen, yes), no) in condition.iter_mut().zip(yes).zip(no) {
                *chosen = if *chosen != 0.0 { yes } else { no };
            }
            Value::Each(condition)
        }
    }
}

/// The values that are there.
fn present(values: &[f64]) -> impl Iterator<Item = f64> + '_ {
    values.iter().copied().filter(|value| !value.is_nan())
}

/// The largest rate of change, up or down, from one value that is there to the next.
fn largest_rate(time: &[f64], values: &[f64]) -> f64 {
    let known = time.iter().zip(values).filter(|(_, value)| !value.is_nan());
    let known: Vec<(&f64, &f64)> = known.collect();
    let rate = |pair: &[(&f64, &f64)]| ((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).abs();
    known.windows(2).map(rate).fold(f64::NAN, f64::max)
}

/// Missing values on straight lines in time between their neighbours; before the first and behind the last
/// value nothing is known, and nothing is filled in.
fn interpolated(time: &[f64], mut values: Vec<f64>) -> Vec<f64> {
    let mut known: Option<usize> = None;
    for k in 0..values.len() {
        if values[k].is_nan() {
            continue;
        }
        if let Some(before) = known {
            for between in before + 1..k {
                let share = (time[between] - time[before]) / (time[k] - time[before]);
                values[between] = (1.0 - share) * values[before] + share * values[k];
            }
        }
        known = Some(k);
    }
    values
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
        assert_eq!(
            interpolated(&[0.0, 1.0, 4.0], vec![1.0, f64::NAN, 5.0]),
            [1.0, 2.0, 5.0]
        );
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
