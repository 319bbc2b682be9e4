//! The functions that machine code calls: those of [`Scalar`] for one number, to the last bit.

use multiversion::multiversion;

use crate::model::instruction::Operation;
use crate::model::scalar::{Scalar, sin_cos};

/// Two numbers, returned in two registers.
#[repr(C)]
struct Pair(f64, f64);

#[multiversion(targets("x86_64+avx2+fma"))]
fn fast_sin(x: f64) -> f64 {
    Scalar::sin(x)
}

#[multiversion(targets("x86_64+avx2+fma"))]
fn fast_cos(x: f64) -> f64 {
    Scalar::cos(x)
}

#[multiversion(targets("x86_64+avx2+fma"))]
fn fast_sin_cos(x: f64) -> (f64, f64) {
    sin_cos(x)
}

extern "C" fn sine(x: f64) -> f64 {
    fast_sin(x)
}

extern "C" fn cosine(x: f64) -> f64 {
    fast_cos(x)
}

extern "C" fn sine_and_cosine(x: f64) -> Pair {
    let (sine, cosine) = fast_sin_cos(x);
    Pair(sine, cosine)
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
        Operation::Sin => sine,
        Operation::Cos => cosine,
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

/// Where the function stands that gives sine and cosine, in this order.
pub(super) fn of_sine_and_cosine() -> usize {
    sine_and_cosine as extern "C" fn(f64) -> Pair as usize
}
