//! Units as they stand in file headers and model documents: `deg/s`, `kg/m^3`, `1/rad`, `hPa`, `-`.

use std::f64::consts::PI;

use super::Dimension;

/// A unit: how to get to SI (`si = scale * value + offset`) and what it measures.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Unit {
    /// The factor to SI.
    pub scale: f64,
    /// Zero but for temperatures in degrees Celsius and Fahrenheit.
    pub offset: f64,
    /// What is measured, in SI base units.
    pub dimension: Dimension,
}

/// Why a text is no unit.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum UnitError {
    /// A symbol of the unit is not known.
    #[error(
        "unknown unit '{symbol}'; known units include m, ft, s, rad, deg, m/s, kt, m/s^2, g, N, Pa, hPa, K, kg, %, and '-' for a pure number"
    )]
    Unknown {
        /// The symbol as written.
        symbol: String,
    },
    /// The text does not read as factors and powers of symbols.
    #[error("unit '{text}' cannot be read: {why}; write it like m/s^2, 1/s or kg/(m*s)")]
    Malformed {
        /// The unit as written, at most its first 64 characters.
        text: String,
        /// What is wrong with it.
        why: &'static str,
    },
}

const LONGEST_UNIT: usize = 64;

/// Beyond these conversion would turn values into zero or nothing.
const SCALES: std::ops::RangeInclusive<f64> = 1e-30..=1e30;

impl Unit {
    /// Of a pure number.
    pub const NONE: Self = Self {
        scale: 1.0,
        offset: 0.0,
        dimension: Dimension::NONE,
    };

    /// A value in this unit, in SI.
    pub fn to_si(self, value: f64) -> f64 {
        value * self.scale + self.offset
    }

    /// The inverse of [`Self::to_si`].
    pub fn from_si(self, value: f64) -> f64 {
        (value - self.offset) / self.scale
    }

    /// Reads a unit expression: factors joined by `*`, `.` or a space and `/`, powers by `^`.
    ///
    /// # Errors
    /// Names the symbol that is not known, or what is malformed.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let trimmed = text.trim();
        let malformed = |why| UnitError::Malformed {
            text: text.chars().take(LONGEST_UNIT).collect(),
            why,
        };
        if trimmed.len() > LONGEST_UNIT {
            return Err(malformed("it is longer than 64 characters"));
        }
        if matches!(trimmed, "" | "-" | "1") {
            return Ok(Self::NONE);
        }
        let mut parser = Parser {
            rest: trimmed,
            depth: 0,
        };
        let unit = parser.product().map_err(|fault| match fault {
            Misread::Unknown(symbol) => UnitError::Unknown { symbol },
            Misread::Malformed(why) => malformed(why),
        })?;
        if !parser.rest.is_empty() {
            return Err(malformed("something follows its end"));
        }
        if !SCALES.contains(&unit.scale) {
            return Err(malformed("it is too far from SI to be converted"));
        }
        Ok(unit)
    }

    fn scaled(scale: f64, dimension: Dimension) -> Self {
        Self {
            scale,
            offset: 0.0,
            dimension,
        }
    }
}

enum Misread {
    Unknown(String),
    Malformed(&'static str),
}

struct Parser<'a> {
    rest: &'a str,
    depth: usize,
}

impl Parser<'_> {
    fn product(&mut self) -> Result<Unit, Misread> {
        let mut unit = self.power()?;
        loop {
            let had_space = self.skip_spaces();
            let Some(next) = self.rest.chars().next() else {
                return Ok(unit);
            };
            let divide = next == '/';
            match next {
                '*' | '.' | '·' | '/' => self.advance(next),
                ')' => return Ok(unit),
                _ if had_space => {}
                _ => return Err(Misread::Malformed("factors need '*' or '/' between them")),
            }
            let factor = self.power()?;
            if unit.offset != 0.0 || factor.offset != 0.0 {
                return Err(Misread::Malformed(
                    "a temperature with an offset (degC, degF) must stand alone",
                ));
            }
            unit = if divide {
                Unit::scaled(
                    unit.scale / factor.scale,
                    unit.dimension.over(factor.dimension),
                )
            } else {
                Unit::scaled(
                    unit.scale * factor.scale,
                    unit.dimension.times(factor.dimension),
                )
            };
        }
    }

    fn power(&mut self) -> Result<Unit, Misread> {
        let base = self.factor()?;
        if !self.rest.starts_with('^') {
            return Ok(base);
        }
        self.advance('^');
        let digits = self.take_while(|c| c.is_ascii_digit() || matches!(c, '-' | '.'));
        let exponent: f64 = digits
            .parse()
            .map_err(|_| Misread::Malformed("'^' needs a number after it"))?;
        if exponent.abs() > 9.0 {
            return Err(Misread::Malformed("a power is larger than 9"));
        }
        let dimension = base
            .dimension
            .to_power(exponent)
            .ok_or(Misread::Malformed("a power must be a multiple of a sixth"))?;
        Ok(Unit::scaled(base.scale.powf(exponent), dimension))
    }

    fn factor(&mut self) -> Result<Unit, Misread> {
        self.skip_spaces();
        if self.rest.starts_with('(') {
            self.depth += 1;
            if self.depth > 8 {
                return Err(Misread::Malformed("its brackets are nested too deep"));
            }
            self.advance('(');
            let inner = self.product()?;
            if !self.rest.starts_with(')') {
                return Err(Misread::Malformed("a ')' is missing"));
            }
            self.advance(')');
            self.depth -= 1;
            return Ok(inner);
        }
        if self.rest.starts_with('1') {
            self.advance('1');
            return Ok(Unit::NONE);
        }
        let symbol = self.take_while(|c| c.is_alphabetic() || matches!(c, '%' | '°' | '_'));
        if symbol.is_empty() {
            return Err(Misread::Malformed("a unit symbol is missing"));
        }
        named(&symbol).ok_or(Misread::Unknown(symbol))
    }

    fn advance(&mut self, c: char) {
        self.rest = &self.rest[c.len_utf8()..];
    }

    fn skip_spaces(&mut self) -> bool {
        let before = self.rest.len();
        self.rest = self.rest.trim_start();
        self.rest.len() < before
    }

    fn take_while(&mut self, accept: impl Fn(char) -> bool) -> String {
        let end = self.rest.find(|c| !accept(c)).unwrap_or(self.rest.len());
        let (taken, rest) = self.rest.split_at(end);
        self.rest = rest;
        taken.to_string()
    }
}

/// Standard gravity, m/s^2 (CGPM 1901).
const GRAVITY: f64 = 9.80665;
const FOOT: f64 = 0.3048;
const POUND: f64 = 0.453_592_37;
const NAUTICAL_MILE: f64 = 1852.0;

fn named(symbol: &str) -> Option<Unit> {
    let length = Dimension::METRE;
    let mass = Dimension::KILOGRAM;
    let time = Dimension::SECOND;
    let frequency = Dimension::NONE.over(time);
    let speed = length.over(time);
    let acceleration = speed.over(time);
    let force = mass.times(acceleration);
    let pressure = force.over(length).over(length);
    let power = force.times(speed);
    let temperature = Dimension::KELVIN;
    let voltage = power.over(Dimension::AMPERE);

    let (scale, dimension) = match symbol {
        "rad" => (1.0, Dimension::NONE),
        "mrad" => (1e-3, Dimension::NONE),
        "deg" | "°" => (PI / 180.0, Dimension::NONE),
        "rev" => (2.0 * PI, Dimension::NONE),
        "%" | "pct" | "percent" => (0.01, Dimension::NONE),
        "m" => (1.0, length),
        "km" => (1e3, length),
        "cm" => (1e-2, length),
        "mm" => (1e-3, length),
        "ft" => (FOOT, length),
        "in" => (FOOT / 12.0, length),
        "nmi" | "NM" => (NAUTICAL_MILE, length),
        "kg" => (1.0, mass),
        "lb" | "lbm" => (POUND, mass),
        "slug" => (POUND * GRAVITY / FOOT, mass),
        "s" | "sec" => (1.0, time),
        "ms" => (1e-3, time),
        "us" | "µs" | "μs" => (1e-6, time),
        "min" => (60.0, time),
        "h" | "hr" => (3600.0, time),
        "Hz" => (1.0, frequency),
        "kHz" => (1e3, frequency),
        "rpm" => (2.0 * PI / 60.0, frequency),
        "kt" | "kts" | "knot" | "knots" => (NAUTICAL_MILE / 3600.0, speed),
        "mph" => (1609.344 / 3600.0, speed),
        "fpm" => (FOOT / 60.0, speed),
        // In a flight-test recording g is the load factor's unit, never a gram.
        "g" | "G" | "gn" => (GRAVITY, acceleration),
        "N" => (1.0, force),
        "daN" => (10.0, force),
        "kN" => (1e3, force),
        "kgf" => (GRAVITY, force),
        "lbf" => (POUND * GRAVITY, force),
        "Pa" => (1.0, pressure),
        "hPa" | "mbar" | "mb" => (100.0, pressure),
        "kPa" => (1e3, pressure),
        "bar" => (1e5, pressure),
        "psi" => (POUND * GRAVITY / (FOOT / 12.0).powi(2), pressure),
        "psf" => (POUND * GRAVITY / FOOT.powi(2), pressure),
        "inHg" => (3386.389, pressure),
        "J" => (1.0, force.times(length)),
        "W" => (1.0, power),
        "kW" => (1e3, power),
        "hp" => (550.0 * FOOT * POUND * GRAVITY, power),
        "K" => (1.0, temperature),
        "degR" => (5.0 / 9.0, temperature),
        "degC" | "°C" | "celsius" => {
            return Some(Unit {
                scale: 1.0,
                offset: 273.15,
                dimension: temperature,
            });
        }
        "degF" | "°F" => {
            return Some(Unit {
                scale: 5.0 / 9.0,
                offset: 459.67 * 5.0 / 9.0,
                dimension: temperature,
            });
        }
        "A" => (1.0, Dimension::AMPERE),
        "V" => (1.0, voltage),
        "mV" => (1e-3, voltage),
        _ => return None,
    };
    Some(Unit::scaled(scale, dimension))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn si(unit: &str, value: f64) -> f64 {
        Unit::parse(unit).unwrap().to_si(value)
    }

    #[test]
    fn converts_what_flight_test_files_carry() {
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} is not {b}");
        close(si("deg/s", 180.0), PI);
        close(si("deg/s^2", 90.0), PI / 2.0);
        close(si("ft", 16000.0), 4876.8);
        close(si("kt", 3600.0), 1852.0);
        close(si("g", 1.0), 9.80665);
        close(si("hPa", 1013.25), 101_325.0);
        close(si("degC", 15.0), 288.15);
        close(si("degF", 59.0), 288.15);
        close(si("slug/ft^3", 1.0), 515.378_818_393_196_2);
        close(si("%", 82.0), 0.82);
        close(si("psf", 1.0), 47.880_258_980_335_84);
    }

    #[test]
    fn reads_products_quotients_and_powers() {
        let dimension = |text: &str| Unit::parse(text).unwrap().dimension.to_string();
        assert_eq!(dimension("kg/m^3"), "kg/m^3");
        assert_eq!(dimension("m/(kg*m^2)"), "1/(m*kg)");
        assert_eq!(dimension("1/rad"), "-");
        assert_eq!(dimension("N"), "m*kg/s^2");
        assert_eq!(dimension("-"), "-");
        assert_eq!(dimension(""), "-");
        assert_eq!(dimension("m s^-2"), "m/s^2");
        assert_eq!(dimension("s^0.5/m^0.5"), "s^0.5/m^0.5");
    }

    #[test]
    fn refuses_with_the_symbol_named() {
        assert_eq!(
            Unit::parse("furlong/s"),
            Err(UnitError::Unknown {
                symbol: "furlong".into()
            })
        );
        for text in [
            "m//s",
            "m^",
            "m^99",
            "(m",
            "m)",
            "degC/s",
            "((((((((((m))))))))))",
            &"m*".repeat(99),
            "2m",
            "km^9*km^9*km^9*km^9*km^9",
            "mm^9*mm^9*mm^9*mm^9",
            "m^0.1",
        ] {
            assert!(Unit::parse(text).is_err(), "{text} was accepted");
        }
    }
}
