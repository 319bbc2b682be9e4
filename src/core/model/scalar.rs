//! The numbers that a compiled model can be evaluated on: one, several side by side, complex.

use std::ops::{Add, Div, Mul, Neg, Sub};

use num_complex::Complex64;

use super::trigonometry;

/// A number as compiled equations need it.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A real number.
    fn from_f64(value: f64) -> Self;
    /// The number without what is infinitely small about it: the real part of a complex one. Of lanes, the first.
    fn real(self) -> f64;
    /// Sine of an angle in radians.
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    fn cos(self) -> Self;
    /// Tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Inverse sine, in radians.
    fn asin(self) -> Self;
    /// Inverse cosine, in radians.
    fn acos(self) -> Self;
    /// Inverse tangent, in radians.
    fn atan(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// -1, 0 or 1.
    fn sign(self) -> Self;
    /// The number raised to `exponent`.
    fn power(self, exponent: Self) -> Self;
    /// The angle of the direction (`x`, self), in radians.
    fn atan2(self, x: Self) -> Self;
    /// 1 where self < other, else 0.
    fn less(self, other: Self) -> Self;
    /// 1 where self ≤ other, else 0.
    fn less_or_equal(self, other: Self) -> Self;
    /// `yes` where self is not 0, else `no`.
    fn select(self, yes: Self, no: Self) -> Self;
    /// self * factor + addend, rounded once where the number is real: the same on every machine, and one
    /// instruction on those made since 2013. Where there is none it is slow, but the numbers are the same.
    fn multiply_add(self, factor: Self, addend: Self) -> Self;
    /// The numbers by their kind: some work is faster on one kind than on others.
    #[inline(always)]
    fn told_apart(numbers: &mut [Self]) -> Numbers<'_, Self> {
        Numbers::Other(numbers)
    }
}

/// Numbers by their kind.
pub enum Numbers<'n, T> {
    Real(&'n mut [f64]),
    SideBySide(&'n mut [Lanes]),
    Other(&'n mut [T]),
}

fn truth(value: bool) -> f64 {
    f64::from(u8::from(value))
}

/// Whether an angle is one that needs no help from the system library.
#[inline(always)]
fn is_small(angle: f64) -> bool {
    angle.abs() <= trigonometry::LARGEST_ANGLE
}

macro_rules! forward {
    ($type:ty: $($name:ident)*) => { $(#[inline(always)] fn $name(self) -> Self { <$type>::$name(self) })* };
}

impl Scalar for f64 {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }
    fn real(self) -> f64 {
        self
    }
    forward!(f64: tan asin acos atan tanh exp ln sqrt abs);
    #[inline(always)]
    fn sin(self) -> Self {
        if is_small(self) {
            trigonometry::sin(self)
        } else {
            f64::sin(self)
        }
    }
    #[inline(always)]
    fn cos(self) -> Self {
        if is_small(self) {
            trigonometry::cos(self)
        } else {
            f64::cos(self)
        }
    }
    #[inline(always)]
    fn sign(self) -> Self {
        if self == 0.0 { 0.0 } else { self.signum() }
    }
    #[inline(always)]
    fn power(self, exponent: Self) -> Self {
        self.powf(exponent)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        f64::atan2(self, x)
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self {
        truth(self < other)
    }
    #[inline(always)]
    fn less_or_equal(self, other: Self) -> Self {
        truth(self <= other)
    }
    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        if self != 0.0 { yes } else { no }
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }
    #[inline(always)]
    fn told_apart(numbers: &mut [Self]) -> Numbers<'_, Self> {
        Numbers::Real(numbers)
    }
}

/// Complex numbers, for complex-step differences: what is not analytic follows the real part.
///
/// The general complex formulas of the inverse functions and powers go through logarithms, which lose an
/// imaginary part of 1e-40 beside a real part of 1. These follow the first order of the imaginary part, which
/// is all that a complex step needs.
impl Scalar for Complex64 {
    fn from_f64(value: f64) -> Self {
        Self::new(value, 0.0)
    }
    fn real(self) -> f64 {
        self.re
    }
    forward!(Complex64: sin cos tan tanh exp ln sqrt);
    fn asin(self) -> Self {
        Self::new(self.re.asin(), self.im / (1.0 - self.re * self.re).sqrt())
    }
    fn acos(self) -> Self {
        Self::new(self.re.acos(), -self.im / (1.0 - self.re * self.re).sqrt())
    }
    fn atan(self) -> Self {
        Self::new(self.re.atan(), self.im / (1.0 + self.re * self.re))
    }
    fn abs(self) -> Self {
        if self.re < 0.0 { -self } else { self }
    }
    fn sign(self) -> Self {
        Self::from_f64(Scalar::sign(self.re))
    }
    fn power(self, exponent: Self) -> Self {
        let real = self.re.powf(exponent.re);
        let slope = exponent.re * self.re.powf(exponent.re - 1.0) * self.im
            + if exponent.im == 0.0 {
                0.0
            } else {
                real * self.re.ln() * exponent.im
            };
        Self::new(real, slope)
    }
    fn atan2(self, x: Self) -> Self {
        let squares = self.re * self.re + x.re * x.re;
        Self::new(
            self.re.atan2(x.re),
            (x.re * self.im - self.re * x.im) / squares,
        )
    }
    fn less(self, other: Self) -> Self {
        Self::from_f64(truth(self.re < other.re))
    }
    fn less_or_equal(self, other: Self) -> Self {
        Self::from_f64(truth(self.re <= other.re))
    }
    fn select(self, yes: Self, no: Self) -> Self {
        if self.re != 0.0 { yes } else { no }
    }
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
}

/// Sines, then cosines, to the last bit as each alone, in little more than the time of one.
#[inline(always)]
pub(super) fn sines_and_cosines<const COUNT: usize>(angles: [f64; COUNT]) -> [[f64; COUNT]; 2] {
    let mut both = [[0.0; COUNT]; 2];
    if angles.iter().all(|&angle| is_small(angle)) {
        for i in 0..COUNT {
            (both[0][i], both[1][i]) = trigonometry::sin_cos(angles[i]);
        }
    } else {
        for i in 0..COUNT {
            (both[0][i], both[1][i]) = (Scalar::sin(angles[i]), Scalar::cos(angles[i]));
        }
    }
    both
}

/// How many samples are evaluated side by side.
pub(crate) const LANES: usize = 16;

/// How many samples are simulated at a time.
pub(crate) const BLOCK: usize = 4 * LANES;

/// Samples side by side: one instruction of a program serves all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

// Loops, not `map` or `from_fn`: those may stay functions of their own, compiled for the least of machines.
impl Lanes {
    #[inline(always)]
    fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for value in &mut self.0 {
            *value = f(*value);
        }
        self
    }

    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        for (value, other) in self.0.iter_mut().zip(other.0) {
            *value = f(*value, other);
        }
        self
    }
}

macro_rules! lanes_operator {
    ($($trait:ident $name:ident $operator:tt),*) => {
        $(impl $trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.zip(other, |a, b| a $operator b)
            }
        })*
    };
}
lanes_operator!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

macro_rules! lanes_unary {
    ($($name:ident)*) => { $(#[inline(always)] fn $name(self) -> Self { self.map(Scalar::$name) })* };
}
macro_rules! lanes_binary {
    ($($name:ident)*) => { $(#[inline(always)] fn $name(self, other: Self) -> Self { self.zip(other, Scalar::$name) })* };
}

impl Scalar for Lanes {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self([value; LANES])
    }
    fn real(self) -> f64 {
        self.0[0]
    }
    lanes_unary!(tan asin acos atan tanh exp ln sqrt abs sign);
    #[inline(always)]
    fn sin(self) -> Self {
        if self.0.iter().all(|&angle| is_small(angle)) {
            self.map(trigonometry::sin)
        } else {
            self.map(Scalar::sin)
        }
    }
    #[inline(always)]
    fn cos(self) -> Self {
        if self.0.iter().all(|&angle| is_small(angle)) {
            self.map(trigonometry::cos)
        } else {
            self.map(Scalar::cos)
        }
    }
    lanes_binary!(power atan2 less less_or_equal);
    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        let mut chosen = no;
        for i in 0..LANES {
            chosen.0[i] = self.0[i].select(yes.0[i], no.0[i]);
        }
        chosen
    }
    #[inline(always)]
    fn multiply_add(self, factor: Self, addend: Self) -> Self {
        let mut sum = addend;
        for i in 0..LANES {
            sum.0[i] = self.0[i].mul_add(factor.0[i], addend.0[i]);
        }
        sum
    }
    #[inline(always)]
    fn told_apart(numbers: &mut [Self]) -> Numbers<'_, Self> {
        Numbers::SideBySide(numbers)
    }
}
