//! Physical dimensions, for checking that equations add like to like.

use std::fmt;

/// Exponents of metre, kilogram, second, kelvin and ampere, counted in sixths so that square and
/// cube roots stay exact. An angle has no dimension (a radian is 1), as everywhere in flight mechanics.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Dimension([i16; 5]);

const BASE: [&str; 5] = ["m", "kg", "s", "K", "A"];
const SIXTHS: i16 = 6;

impl Dimension {
    /// A pure number, and so an angle.
    pub const NONE: Self = Self([0; 5]);
    /// Length.
    pub const METRE: Self = Self([SIXTHS, 0, 0, 0, 0]);
    /// Mass.
    pub const KILOGRAM: Self = Self([0, SIXTHS, 0, 0, 0]);
    /// Time.
    pub const SECOND: Self = Self([0, 0, SIXTHS, 0, 0]);
    /// Temperature.
    pub const KELVIN: Self = Self([0, 0, 0, SIXTHS, 0]);
    /// Electric current.
    pub const AMPERE: Self = Self([0, 0, 0, 0, SIXTHS]);

    /// Whether it is that of a pure number.
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// Whether it is a power of the second, or a pure number.
    pub fn is_of_time(self) -> bool {
        let time = 2;
        (0..self.0.len()).all(|i| i == time || self.0[i] == 0)
    }

    /// The exponent of the second, where it is whole.
    pub fn seconds(self) -> Option<i32> {
        (self.0[2] % SIXTHS == 0).then(|| i32::from(self.0[2] / SIXTHS))
    }

    /// Base units with their exponents, none of them 0; `None` where one is not whole.
    pub fn whole_exponents(self) -> Option<Vec<(&'static str, i32)>> {
        let whole = self.0.iter().all(|sixths| sixths % SIXTHS == 0);
        let exponents = (BASE.into_iter().zip(self.0)).filter(|(_, sixths)| *sixths != 0);
        whole.then(|| {
            exponents
                .map(|(base, sixths)| (base, i32::from(sixths / SIXTHS)))
                .collect()
        })
    }

    /// The dimension of a product.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| {
            self.0[i].saturating_add(other.0[i])
        }))
    }

    /// The dimension of a quotient.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| {
            self.0[i].saturating_sub(other.0[i])
        }))
    }

    /// The dimension to the power `exponent`; `None` where that is no multiple of a sixth.
    pub fn to_power(self, exponent: f64) -> Option<Self> {
        let mut result = [0; 5];
        for (to, from) in result.iter_mut().zip(self.0) {
            let exact = f64::from(from) * exponent;
            if (exact - exact.round()).abs() > 1e-9 || exact.abs() > f64::from(i16::MAX) {
                return None;
            }
            *to = exact.round() as i16;
        }
        Some(Self(result))
    }
}

impl fmt::Display for Dimension {
    /// In SI base units, as `m/s^2`; `-` for a pure number.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factor = |i: usize, sixths: i16| {
            let exponent = f64::from(sixths) / f64::from(SIXTHS);
            if exponent == 1.0 {
                BASE[i].to_string()
            } else {
                format!("{}^{exponent}", BASE[i])
            }
        };
        let above: Vec<_> = (0..5)
            .filter(|&i| self.0[i] > 0)
            .map(|i| factor(i, self.0[i]))
            .collect();
        let below: Vec<_> = (0..5)
            .filter(|&i| self.0[i] < 0)
            .map(|i| factor(i, self.0[i].saturating_neg()))
            .collect();
        match (above.is_empty(), below.as_slice()) {
            (true, []) => write!(f, "-"),
            (false, []) => write!(f, "{}", above.join("*")),
            (_, below) => {
                let above = if above.is_empty() {
                    "1".to_string()
                } else {
                    above.join("*")
                };
                match below {
                    [one] => write!(f, "{above}/{one}"),
                    many => write!(f, "{above}/({})", many.join("*")),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_as_an_engineer_writes_it() {
        let acceleration = Dimension::METRE
            .over(Dimension::SECOND)
            .over(Dimension::SECOND);
        assert_eq!(acceleration.to_string(), "m/s^2");
        assert_eq!(Dimension::NONE.over(Dimension::SECOND).to_string(), "1/s");
        assert_eq!(Dimension::NONE.to_string(), "-");
        assert_eq!(acceleration.to_power(0.5).unwrap().to_string(), "m^0.5/s");
        assert_eq!(acceleration.to_power(0.1), None);
    }
}
