//! The functions that machine code calls: those of [`Scalar`] for one number, to the last bit.

use multiversion::multiversion;

use crate::model::operation::Operation;
use crate::model::scalar::{self, Scalar};

/// Angles whose sines and cosines one call gives.
pub(super) const ANGLES: usize = 4;

#[multiversion(targets("x86_64+avx2+fma"))]
fn fast_sines_and_cosines(angles: [f64; ANGLES], to: &mut [[f64; ANGLES]; 2]) {
    *to = scalar::sines_and_cosines(angles);
}

extern "C" fn sines_and_cosines(to: &mut [[f64; ANGLES]; 2], a: f64, b: f64, c: f64, d: f64) {
    fast_sines_and_cosines([a, b, c, d], to);
}

macro_rules! unary {
    ($($name:ident)*) => { $(extern "C" fn $name(x: f64) -> f64 { Scalar::$name(x) })* };
}
unary!(tan asin acos atan tanh exp ln sign);

extern "C" fn power(base: f64, exponent: f64) -> f64 {
    Scalar::power(base, exponent)
}

extern "C" fn atan2(y: f64, x: f64) -> f64 {
    Scalar::atan2(y, x)
}

/// Where the function of one number stands, for the operations that are calls.
pub(super) fn of_one(operation: Operation) -> Option<usize> {
    let function: extern "C" fn(f64) -> f64 = match operation {
        Operation::Tan => tan,
        Operation::Asin => asin,
        Operation::Acos => acos,
        Operation::Atan => atan,
        Operation::Tanh => tanh,
        Operation::Exp => exp,
        Operation::Ln => ln,
        Operation::Sign => sign,
        _ => return None,
    };
    Some(function as usize)
}

/// Where the function of two numbers stands.
pub(super) fn of_two(operation: Operation) -> Option<usize> {
    let function: extern "C" fn(f64, f64) -> f64 = match operation {
        Operation::Power => power,
        Operation::Atan2 => atan2,
        _ => return None,
    };
    Some(function as usize)
}

/// Where the function stands that writes the sines of its angles to an address, then their cosines.
pub(super) fn of_sines_and_cosines() -> usize {
    sines_and_cosines as extern "C" fn(&mut [[f64; ANGLES]; 2], f64, f64, f64, f64) as usize
}
