//! Units as they stand in file headers and model documents: `deg/s`, `kg/m^3`, `1/rad`, `hPa`, `-`.

use super::Dimension;
use super::unit_spelling::{number_length, other_than_written, plain, suggestion};
use super::unit_symbols::meaning;

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
        "unknown unit '{symbol}'{}; known units include m, ft, s, rad, deg, m/s, kt, m/s^2, g, N, Pa, hPa, K, kg, %, and '-' for a pure number",
        did_you_mean(symbol)
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

fn did_you_mean(symbol: &str) -> String {
    suggestion(symbol).map_or(String::new(), |meant| format!("; did you mean {meant}?"))
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

    /// Reads a unit: symbols, or what people write for them, in any case where case does not tell two apart.
    ///
    /// In symbols a unit is factors joined by `*`, `.` or a space and `/`, powers by `^`, and perhaps a number before them.
    /// `DEG/SEC`, `m/s²`, `M/S**2`, `degrees`, `ft msl` and the like are read, too.
    ///
    /// # Errors
    /// Names the symbol that is not known, with what may have been meant, or what is malformed.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        if text.len() <= LONGEST_UNIT
            && let Some(meant) = other_than_written(text)
        {
            return Self::of_symbols(meant);
        }
        let as_written = Self::of_symbols(text);
        if as_written.is_ok() || text.len() > LONGEST_UNIT {
            return as_written;
        }
        let plain = plain(text);
        if plain == text.trim() {
            return as_written;
        }
        // a fault of what was written is told in its own words
        Self::of_symbols(&plain).map_err(|fault| match as_written {
            Err(UnitError::Malformed { text, why })
                if !matches!(fault, UnitError::Unknown { .. }) =>
            {
                UnitError::Malformed { text, why }
            }
            _ => fault,
        })
    }

    /// A unit in symbols: as it is written where that is symbols, else in those that are meant. What cannot be read stays.
    pub fn in_symbols(text: &str) -> String {
        if text.len() <= LONGEST_UNIT
            && let Some(meant) = other_than_written(text)
        {
            return meant.to_string();
        }
        if Self::of_symbols(text).is_err() && text.len() <= LONGEST_UNIT {
            let plain = plain(text);
            if Self::of_symbols(&plain).is_ok() {
                return plain;
            }
        }
        text.trim().to_string()
    }

    fn of_symbols(text: &str) -> Result<Self, UnitError> {
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
        if self.rest.starts_with(|c: char| c.is_ascii_digit()) {
            return self.number();
        }
        let symbol = if self.rest.starts_with("inH2O") {
            self.take("inH2O".len())
        } else {
            self.take_while(|c| c.is_alphabetic() || matches!(c, '%' | '°' | '_'))
        };
        if symbol.is_empty() {
            return Err(Misread::Malformed("a unit symbol is missing"));
        }
        let unit = |(scale, offset, dimension)| Unit {
            scale,
            offset,
            dimension,
        };
        meaning(&symbol).map(unit).ok_or(Misread::Unknown(symbol))
    }

    /// A number as a factor: `0.01`, `1e-7`. What follows stands apart from it.
    fn number(&mut self) -> Result<Unit, Misread> {
        let number: f64 = self
            .take(number_length(self.rest))
            .parse()
            .map_err(|_| Misread::Malformed("a factor is not a number"))?;
        if number <= 0.0 {
            return Err(Misread::Malformed("a factor must be positive"));
        }
        Ok(Unit::scaled(number, Dimension::NONE))
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
        self.take(end)
    }

    fn take(&mut self, bytes: usize) -> String {
        let (taken, rest) = self.rest.split_at(bytes);
        self.rest = rest;
        taken.to_string()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

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
    fn converts_what_people_write() {
        let same = |written: &str, symbols: &str| {
            assert_eq!(Unit::parse(written), Unit::parse(symbols), "{written}");
            assert_eq!(Unit::in_symbols(symbols), symbols);
            let read_back = Unit::parse(&Unit::in_symbols(written));
            assert_eq!(read_back, Unit::parse(symbols), "{written}");
        };
        for (written, symbols) in [
            ("DEG", "deg"),
            ("DEG/S2", "deg/s^2"),
            ("M/S**2", "m/s^2"),
            ("FT/SEC**2", "ft/s^2"),
            ("kg/m3", "kg/m^3"),
            ("slug/ft3", "slug/ft^3"),
            ("KIAS", "kt"),
            ("lbs", "lb"),
            ("RPM", "rpm"),
            ("deg F", "degF"),
            ("degrees/s", "deg/s"),
            ("usec", "us"),
            ("ft-lbs", "ft*lbf"),
            ("S", "s"),
            ("enum", "-"),
            ("cdeg", "0.01 deg"),
            ("1E-7 DEG", "1e-7 deg"),
        ] {
            same(written, symbols);
        }
        let unknown = Unit::parse("degg/s").unwrap_err().to_string();
        assert!(unknown.contains("did you mean deg?"), "{unknown}");
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
