//! The symbols of units, with their factors to SI.

use std::f64::consts::PI;

use super::Dimension;

/// A factor to SI, an offset behind it, and what is measured.
pub(super) type Meaning = (f64, f64, Dimension);

/// Standard gravity, m/s^2 (CGPM 1901).
const GRAVITY: f64 = 9.80665;
const FOOT: f64 = 0.3048;
const INCH: f64 = FOOT / 12.0;
const POUND: f64 = 0.453_592_37;
const POUND_FORCE: f64 = POUND * GRAVITY;
const NAUTICAL_MILE: f64 = 1852.0;
const MILE: f64 = 1609.344;
/// A gallon of the United States, m^3.
const GALLON: f64 = 3.785_411_784e-3;
const HOUR: f64 = 3600.0;
const FAHRENHEIT: f64 = 5.0 / 9.0;

const NONE: Dimension = Dimension::NONE;
const M: Dimension = Dimension::METRE;
const KG: Dimension = Dimension::KILOGRAM;
const S: Dimension = Dimension::SECOND;
const K: Dimension = Dimension::KELVIN;
const A: Dimension = Dimension::AMPERE;

/// Dimensions that are built from those of the base.
struct Built {
    frequency: Dimension,
    speed: Dimension,
    acceleration: Dimension,
    force: Dimension,
    pressure: Dimension,
    energy: Dimension,
    power: Dimension,
    voltage: Dimension,
    volume: Dimension,
    flux_density: Dimension,
}

fn built() -> Built {
    let frequency = NONE.over(S);
    let speed = M.over(S);
    let acceleration = speed.over(S);
    let force = KG.times(acceleration);
    let power = force.times(speed);
    Built {
        frequency,
        speed,
        acceleration,
        force,
        pressure: force.over(M).over(M),
        energy: force.times(M),
        power,
        voltage: power.over(A),
        volume: M.times(M).times(M),
        flux_density: KG.over(S).over(S).over(A),
    }
}

/// What a symbol means, in the case in which it is written.
pub(super) fn meaning(symbol: &str) -> Option<Meaning> {
    whole(symbol).or_else(|| prefixed(symbol))
}

/// Every symbol that has a meaning as a whole.
pub(super) const SYMBOLS: [&str; 84] = [
    "rad", "deg", "°", "mrad", "rev", "%", "pct", "percent", "m", "km", "cm", "mm", "ft", "kft",
    "FL", "in", "yd", "mi", "nmi", "NM", "kg", "lb", "lbm", "slug", "s", "sec", "ms", "us", "µs",
    "μs", "ns", "min", "h", "hr", "day", "Hz", "kHz", "rpm", "kt", "kts", "kn", "knot", "knots",
    "mph", "fpm", "g", "G", "gn", "mg", "mG", "N", "daN", "kN", "kgf", "lbf", "klbf", "Pa", "hPa",
    "mbar", "mb", "kPa", "bar", "psi", "psf", "inHg", "mmHg", "inH2O", "J", "W", "kW", "hp", "K",
    "degR", "degC", "°C", "celsius", "degF", "°F", "A", "V", "mV", "gal", "L", "gauss",
];

fn whole(symbol: &str) -> Option<Meaning> {
    let built = built();
    let (scale, dimension) = match symbol {
        "rad" => (1.0, NONE),
        "mrad" => (1e-3, NONE),
        "deg" | "°" => (PI / 180.0, NONE),
        "rev" => (2.0 * PI, NONE),
        "%" | "pct" | "percent" => (0.01, NONE),
        "m" => (1.0, M),
        "km" => (1e3, M),
        "cm" => (1e-2, M),
        "mm" => (1e-3, M),
        "ft" => (FOOT, M),
        "kft" => (1e3 * FOOT, M),
        "FL" => (1e2 * FOOT, M),
        "in" => (INCH, M),
        "yd" => (3.0 * FOOT, M),
        "mi" => (MILE, M),
        "nmi" | "NM" => (NAUTICAL_MILE, M),
        "kg" => (1.0, KG),
        "lb" | "lbm" => (POUND, KG),
        "slug" => (POUND_FORCE / FOOT, KG),
        "s" | "sec" => (1.0, S),
        "ms" => (1e-3, S),
        "us" | "µs" | "μs" => (1e-6, S),
        "ns" => (1e-9, S),
        "min" => (60.0, S),
        "h" | "hr" => (HOUR, S),
        "day" => (24.0 * HOUR, S),
        "Hz" => (1.0, built.frequency),
        "kHz" => (1e3, built.frequency),
        "rpm" => (2.0 * PI / 60.0, built.frequency),
        "kt" | "kts" | "kn" | "knot" | "knots" => (NAUTICAL_MILE / HOUR, built.speed),
        "mph" => (MILE / HOUR, built.speed),
        "fpm" => (FOOT / 60.0, built.speed),
        // In a flight-test recording g is the load factor's unit, never a gram.
        "g" | "G" | "gn" => (GRAVITY, built.acceleration),
        "mg" | "mG" => (1e-3 * GRAVITY, built.acceleration),
        "N" => (1.0, built.force),
        "daN" => (10.0, built.force),
        "kN" => (1e3, built.force),
        "kgf" => (GRAVITY, built.force),
        "lbf" => (POUND_FORCE, built.force),
        "klbf" => (1e3 * POUND_FORCE, built.force),
        "Pa" => (1.0, built.pressure),
        "hPa" | "mbar" | "mb" => (100.0, built.pressure),
        "kPa" => (1e3, built.pressure),
        "bar" => (1e5, built.pressure),
        "psi" => (POUND_FORCE / INCH.powi(2), built.pressure),
        "psf" => (POUND_FORCE / FOOT.powi(2), built.pressure),
        "inHg" => (3386.389, built.pressure),
        "mmHg" => (133.322_387_415, built.pressure),
        "inH2O" => (249.088_91, built.pressure),
        "J" => (1.0, built.energy),
        "W" => (1.0, built.power),
        "kW" => (1e3, built.power),
        "hp" => (550.0 * FOOT * POUND_FORCE, built.power),
        "K" => (1.0, K),
        "degR" => (FAHRENHEIT, K),
        "degC" | "°C" | "celsius" => return Some((1.0, 273.15, K)),
        "degF" | "°F" => return Some((FAHRENHEIT, 459.67 * FAHRENHEIT, K)),
        "A" => (1.0, A),
        "V" => (1.0, built.voltage),
        "mV" => (1e-3, built.voltage),
        "gal" => (GALLON, built.volume),
        "L" => (1e-3, built.volume),
        "gauss" => (1e-4, built.flux_density),
        _ => return None,
    };
    Some((scale, 0.0, dimension))
}

/// Prefixes of the SI, and the symbols that each may stand before.
const PREFIXES: [(&str, f64, &[&str]); 9] = [
    ("n", 1e-9, &["A", "V", "T"]),
    ("u", 1e-6, &["m", "A", "V", "rad", "deg", "T"]),
    ("µ", 1e-6, &["m", "A", "V", "rad", "deg", "T"]),
    ("μ", 1e-6, &["m", "A", "V", "rad", "deg", "T"]),
    (
        "m",
        1e-3,
        &["deg", "N", "Pa", "A", "W", "Hz", "T", "K", "L", "gauss"],
    ),
    ("c", 1e-2, &["deg", "rad", "s"]),
    ("d", 1e-1, &["m", "deg", "s"]),
    ("k", 1e3, &["V", "A", "J"]),
    ("M", 1e6, &["Pa", "N", "W", "J", "Hz"]),
];

fn prefixed(symbol: &str) -> Option<Meaning> {
    PREFIXES.iter().find_map(|(prefix, factor, bases)| {
        let base = symbol.strip_prefix(prefix)?;
        let (scale, dimension) = match base {
            "T" => (1.0, built().flux_density),
            _ => {
                let (scale, _, dimension) = whole(base)?;
                (scale, dimension)
            }
        };
        bases
            .contains(&base)
            .then_some((factor * scale, 0.0, dimension))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_symbol_has_a_meaning() {
        for symbol in SYMBOLS {
            assert!(whole(symbol).is_some(), "{symbol}");
        }
        for (symbol, factor) in [("cdeg", PI / 18000.0), ("uT", 1e-6), ("MPa", 1e6)] {
            let (scale, ..) = meaning(symbol).unwrap();
            assert!((scale / factor - 1.0).abs() < 1e-12, "{symbol}");
        }
        for symbol in ["nm", "Mm", "Ms", "Mg", "cft", "kdeg", "M", "S", "T"] {
            assert_eq!(meaning(symbol), None, "{symbol}");
        }
    }
}
