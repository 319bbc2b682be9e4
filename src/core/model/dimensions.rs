//! Unit checking: what an expression measures, or why it cannot be added up.

use super::expression::{BinaryOperator, Expression, Function, Kind, Span};
use crate::flight::Dimension;

/// The dimension of an expression; `None` for a literal zero, which may stand for any quantity.
pub(super) type Measured = Option<Dimension>;

/// Like is not added to like: where, and in words.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Mismatch {
    pub span: Span,
    pub message: String,
}

/// Works out what `expression` measures; `dimension_of` knows the names.
/// A name it does not know counts as any quantity: that fault is reported elsewhere.
pub(super) fn measure(
    expression: &Expression,
    dimension_of: &dyn Fn(&str) -> Option<Dimension>,
) -> Result<Measured, Mismatch> {
    let of = |inner: &Expression| measure(inner, dimension_of);
    let pure = |inner: &Expression, what: &str| match of(inner)? {
        Some(dimension) if !dimension.is_none() => Err(Mismatch {
            span: inner.span,
            message: format!("{what} must be a pure number or an angle, it is in {dimension}"),
        }),
        _ => Ok(()),
    };
    let alike = |left: &Expression, right: &Expression, doing: &str| match (of(left)?, of(right)?) {
        (Some(a), Some(b)) if a != b => {
            let span = Span {
                start: left.span.start,
                end: right.span.end,
            };
            Err(Mismatch {
                span,
                message: format!("cannot {doing} {a} and {b}: '{left}' and '{right}'"),
            })
        }
        (a, b) => Ok(a.or(b)),
    };
    match &expression.kind {
        Kind::Number(value) => Ok((*value != 0.0).then_some(Dimension::NONE)),
        Kind::Name(name) => Ok(dimension_of(name)),
        Kind::Negate(inner) => of(inner),
        Kind::Binary(operator, left, right) => match operator {
            BinaryOperator::Add => alike(left, right, "add"),
            BinaryOperator::Subtract => alike(left, right, "subtract"),
            BinaryOperator::Multiply => Ok(both(of(left)?, of(right)?, Dimension::times)),
            BinaryOperator::Divide => Ok(both(of(left)?, of(right)?, Dimension::over)),
            BinaryOperator::Power => {
                pure(right, "an exponent")?;
                power(left, of(left)?, right)
            }
            _ => alike(left, right, "compare").map(|_| Some(Dimension::NONE)),
        },
        Kind::Call(function, arguments) => match (function, arguments.as_slice()) {
            (
                Function::Abs
                | Function::First
                | Function::Interpolated
                | Function::Held
                | Function::Fresh,
                [value],
            ) => of(value),
            (Function::LargestRate, [value]) => {
                Ok(of(value)?.map(|dimension| dimension.over(Dimension::SECOND)))
            }
            (Function::Sign, [value]) => of(value).map(|_| Some(Dimension::NONE)),
            (Function::Sqrt, [value]) => match of(value)? {
                None => Ok(None),
                Some(dimension) => match dimension.to_power(0.5) {
                    Some(root) => Ok(Some(root)),
                    None => Err(Mismatch {
                        span: value.span,
                        message: format!("{dimension} has no square root"),
                    }),
                },
            },
            (Function::Atan2, [y, x]) => {
                alike(y, x, "divide in atan2").map(|_| Some(Dimension::NONE))
            }
            (Function::Min | Function::Max, [left, right]) => alike(left, right, "compare"),
            (Function::Mean | Function::Delayed, [value, duration]) => {
                let what = (Dimension::SECOND, "a time in seconds");
                takes(*function, duration, of(duration)?, what)?;
                of(value)
            }
            (Function::Lowpass | Function::Smoothed | Function::Derivative, [value, frequency]) => {
                let what = (Dimension::NONE.over(Dimension::SECOND), "a frequency in Hz");
                takes(*function, frequency, of(frequency)?, what)?;
                let dimension = of(value)?;
                Ok(match function {
                    Function::Derivative => dimension.map(|d| d.over(Dimension::SECOND)),
                    _ => dimension,
                })
            }
            (Function::North | Function::East, [latitude, longitude]) => {
                pure(latitude, "a latitude")?;
                pure(longitude, "a longitude")?;
                Ok(Some(Dimension::METRE))
            }
            (Function::Airspeed, [pressure, density]) => {
                let quotient = both(of(pressure)?, of(density)?, Dimension::over);
                let speed = Dimension::METRE.over(Dimension::SECOND);
                match quotient {
                    Some(quotient) if quotient != speed.times(speed) => Err(Mismatch {
                        span: expression.span,
                        message: format!(
                            "airspeed takes a pressure and a density, whose quotient is in m^2/s^2, not in {quotient}"
                        ),
                    }),
                    _ => Ok(Some(speed)),
                }
            }
            (Function::If, [condition, yes, no]) => {
                of(condition)?;
                alike(yes, no, "choose between")
            }
            (function, arguments) => {
                for argument in arguments {
                    pure(argument, &format!("the argument of {}", function.name()))?;
                }
                Ok(Some(Dimension::NONE))
            }
        },
    }
}

/// An argument is a written number, or of this dimension.
fn takes(
    function: Function,
    argument: &Expression,
    found: Measured,
    (wanted, what): (Dimension, &str),
) -> Result<(), Mismatch> {
    match found {
        Some(found) if !found.is_none() && found != wanted => Err(Mismatch {
            span: argument.span,
            message: format!("{} takes {what}, not {found}", function.name()),
        }),
        _ => Ok(()),
    }
}

fn both(
    left: Measured,
    right: Measured,
    combine: fn(Dimension, Dimension) -> Dimension,
) -> Measured {
    match (left, right) {
        (Some(left), Some(right)) => Some(combine(left, right)),
        _ => None,
    }
}

fn power(
    base: &Expression,
    measured: Measured,
    exponent: &Expression,
) -> Result<Measured, Mismatch> {
    let Some(dimension) = measured.filter(|d| !d.is_none()) else {
        return Ok(measured);
    };
    let number = match &exponent.kind {
        Kind::Number(value) => Some(*value),
        Kind::Negate(inner) => match inner.kind {
            Kind::Number(value) => Some(-value),
            _ => None,
        },
        _ => None,
    };
    let fault = |message| Mismatch {
        span: exponent.span,
        message,
    };
    let number = number.ok_or_else(|| {
        fault(format!(
            "'{base}' is in {dimension}: its exponent must be a written number"
        ))
    })?;
    match dimension.to_power(number) {
        Some(result) => Ok(Some(result)),
        None => Err(fault(format!(
            "{dimension} to the power {number} has no meaning"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::super::expression::parse;
    use super::*;
    use crate::flight::Unit;

    fn measured(text: &str) -> Result<String, String> {
        let dimension_of = |name: &str| {
            let unit = match name {
                "V" => "m/s",
                "q" => "rad/s",
                "alpha" => "rad",
                "rho" => "kg/m^3",
                _ => return None,
            };
            Unit::parse(unit).ok().map(|unit| unit.dimension)
        };
        measure(&parse(text).unwrap(), &dimension_of)
            .map(|m| m.map_or("any".to_string(), |d| d.to_string()))
            .map_err(|mismatch| format!("{}: {}", mismatch.span.start, mismatch.message))
    }

    #[test]
    fn follows_the_rules_of_quantities() {
        assert_eq!(measured("0.5*rho*V^2"), Ok("kg/(m*s^2)".into()));
        assert_eq!(measured("sqrt(V^2 + V*V)"), Ok("m/s".into()));
        assert_eq!(measured("0"), Ok("any".into()));
        assert_eq!(measured("if(q < 0, 0, q)"), Ok("1/s".into()));
        assert_eq!(measured("sin(alpha)*V"), Ok("m/s".into()));
        assert_eq!(measured("2^alpha"), Ok("-".into()));
        assert_eq!(measured("mean(V, 5)"), Ok("m/s".into()));
        assert_eq!(measured("0.6*largest_rate(alpha)"), Ok("1/s".into()));
        assert_eq!(measured("derivative(q, 2)"), Ok("1/s^2".into()));
        assert_eq!(measured("lowpass(V, q)"), Ok("m/s".into()));
        assert_eq!(measured("north(alpha, alpha)"), Ok("m".into()));
        assert_eq!(measured("airspeed(0.5*rho*V^2, rho)"), Ok("m/s".into()));
        assert!(measured("airspeed(V, rho)").is_err() && measured("delayed(V, V)").is_err());
    }

    #[test]
    fn names_the_place() {
        assert_eq!(
            measured("V + q"),
            Err("0: cannot add m/s and 1/s: 'V' and 'q'".into())
        );
        assert_eq!(
            measured("alpha*(q - alpha)"),
            Err("7: cannot subtract 1/s and -: 'q' and 'alpha'".into())
        );
        assert!(
            measured("sin(q)")
                .unwrap_err()
                .contains("the argument of sin")
        );
        assert!(
            measured("V^alpha")
                .unwrap_err()
                .contains("must be a written number")
        );
        assert!(
            measured("if(V < q, 1, 2)")
                .unwrap_err()
                .contains("cannot compare")
        );
    }
}
