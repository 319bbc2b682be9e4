//! A formula's tree on the samples of a recording.

use super::super::expression::{BinaryOperator, Expression, Function, Kind, Span, written_unit};
use super::super::scalar::Scalar;
use super::filter::{derivative, lowpass, smoothed};
use super::position::{east, north};
use super::recorded::Recorded;
use super::samples::{delayed, fresh, held, interpolated, largest_rate, present, unwrapped};

/// A number, or one for each sample.
pub(super) enum Value {
    One(f64),
    Each(Vec<f64>),
}

/// An argument that does not fit the recording.
pub(super) struct Unfit {
    pub(super) span: Span,
    pub(super) message: String,
}

impl Value {
    pub(super) fn into_values(self, count: usize) -> Vec<f64> {
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

    /// Of two values one that is missing makes the result missing, whatever `f` makes of it.
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let f = |a: f64, b: f64| match a.is_nan() || b.is_nan() {
            true => f64::NAN,
            false => f(a, b),
        };
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

pub(super) fn evaluate(expression: &Expression, on: &dyn Recorded) -> Result<Value, Unfit> {
    let of = |inner: &Expression| evaluate(inner, on);
    Ok(match &expression.kind {
        Kind::Number(value) => Value::One(*value),
        Kind::Name(name) => match (on.channel(name), written_unit(name)) {
            (_, Some(unit)) => Value::One(unit.map_or(f64::NAN, |unit| unit.scale)),
            (Some((values, _)), None) => Value::Each(values.to_vec()),
            (None, None) => Value::One(std::f64::consts::PI),
        },
        Kind::Negate(inner) => of(inner)?.map(|v| -v),
        Kind::Binary(operator, left, right) => of(left)?.zip(of(right)?, |a, b| match operator {
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
        Kind::Call(function, arguments) => {
            let values = arguments.iter().map(of).collect::<Result<_, _>>()?;
            let call = call(*function, values, on);
            // what is wrong with a call is wrong with its last argument: a frequency, a time
            let last = arguments.last().map_or(expression.span, |last| last.span);
            call.map_err(|message| Unfit {
                span: last,
                message,
            })?
        }
    })
}

fn call(function: Function, arguments: Vec<Value>, on: &dyn Recorded) -> Result<Value, String> {
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
    let argument = arguments.into_iter().next();
    Ok(argument.unwrap_or(Value::One(f64::NAN)).map(unary))
}

fn call_many(
    function: Function,
    arguments: Vec<Value>,
    on: &dyn Recorded,
) -> Result<Value, String> {
    let (time, count) = (on.time(), on.time().len());
    let mut arguments = arguments.into_iter();
    let mut next = || arguments.next().unwrap_or(Value::One(f64::NAN));
    Ok(match function {
        Function::Atan2 => next().zip(next(), f64::atan2),
        Function::Min => next().zip(next(), f64::min),
        Function::Max => next().zip(next(), f64::max),
        Function::Airspeed => next().zip(next(), airspeed),
        Function::First => match next() {
            Value::Each(values) => Value::One(present(&values).next().unwrap_or(f64::NAN)),
            one @ Value::One(_) => one,
        },
        Function::Mean => match (next(), next()) {
            (Value::Each(values), Value::One(duration)) => {
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
        Function::North => Value::Each(north(
            &next().into_values(count),
            &next().into_values(count),
        )),
        Function::East => Value::Each(east(&next().into_values(count), &next().into_values(count))),
        Function::If => {
            let (condition, yes, no) = (next(), next(), next());
            let (yes, no) = (yes.into_values(count), no.into_values(count));
            let mut condition = condition.into_values(count);
            for ((chosen, yes), no) in condition.iter_mut().zip(yes).zip(no) {
                *chosen = match *chosen {
                    missing if missing.is_nan() => missing,
                    0.0 => no,
                    _ => yes,
                };
            }
            Value::Each(condition)
        }
        _ => match (next(), function) {
            // a number is the same at all times
            (Value::One(_), Function::Derivative | Function::LargestRate) => Value::One(0.0),
            (one @ Value::One(_), _) => one,
            (Value::Each(values), Function::LargestRate) => Value::One(largest_rate(time, &values)),
            (Value::Each(values), Function::Interpolated) => {
                Value::Each(interpolated(time, values))
            }
            (Value::Each(values), Function::Held) => Value::Each(held(values)),
            (Value::Each(values), Function::Fresh) => Value::Each(fresh(values)),
            (Value::Each(values), Function::Unwrap) => Value::Each(unwrapped(values)),
            (Value::Each(values), _) => {
                let Value::One(number) = next() else {
                    return Err(format!(
                        "the second argument of {} is one number, not a channel",
                        function.name()
                    ));
                };
                Value::Each(match function {
                    Function::Delayed => delayed(time, &values, number),
                    Function::Lowpass => lowpass(time, &values, number)?,
                    Function::Smoothed => smoothed(time, &values, number)?,
                    _ => derivative(time, &values, number)?,
                })
            }
        },
    })
}

/// Incompressible, with the sign of the pressure.
fn airspeed(dynamic_pressure: f64, density: f64) -> f64 {
    let speed = (2.0 * dynamic_pressure.abs() / density).sqrt();
    speed.copysign(dynamic_pressure)
}
