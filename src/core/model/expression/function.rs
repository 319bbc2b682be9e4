//! The functions that equations may call.

/// A function by name. `first`, `mean`, `largest_rate` and `interpolated` look at a whole recording: they are allowed only in
/// channel formulas and where a parameter's start value is worked out.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Function {
    /// Sine of an angle in radians.
    Sin,
    /// Cosine of an angle in radians.
    Cos,
    /// Tangent of an angle in radians.
    Tan,
    /// The angle from -π/2 to π/2 of a sine.
    Asin,
    /// The angle from 0 to π of a cosine.
    Acos,
    /// The angle between -π/2 and π/2 of a tangent.
    Atan,
    /// `atan2(y, x)`: the angle from -π to π of the direction (x, y).
    Atan2,
    /// Hyperbolic tangent.
    Tanh,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Square root.
    Sqrt,
    /// Absolute value.
    Abs,
    /// -1, 0 or 1.
    Sign,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
    /// `if(condition, a, b)`: a where the condition holds, else b.
    If,
    /// `first(channel)`: the first sample.
    First,
    /// `mean(channel, seconds)`: the mean over the first seconds.
    Mean,
    /// `largest_rate(channel)`: the largest rate of change from one sample to the next, up or down.
    LargestRate,
    /// `interpolated(channel)`: missing samples filled linearly from their neighbours.
    Interpolated,
}

const ALL: [(&str, Function, usize); 20] = [
    ("sin", Function::Sin, 1),
    ("cos", Function::Cos, 1),
    ("tan", Function::Tan, 1),
    ("asin", Function::Asin, 1),
    ("acos", Function::Acos, 1),
    ("atan", Function::Atan, 1),
    ("atan2", Function::Atan2, 2),
    ("tanh", Function::Tanh, 1),
    ("exp", Function::Exp, 1),
    ("ln", Function::Ln, 1),
    ("sqrt", Function::Sqrt, 1),
    ("abs", Function::Abs, 1),
    ("sign", Function::Sign, 1),
    ("min", Function::Min, 2),
    ("max", Function::Max, 2),
    ("if", Function::If, 3),
    ("first", Function::First, 1),
    ("mean", Function::Mean, 2),
    ("largest_rate", Function::LargestRate, 1),
    ("interpolated", Function::Interpolated, 1),
];

impl Function {
    /// The function of this name.
    pub fn find(name: &str) -> Option<Self> {
        ALL.iter()
            .find(|(known, ..)| *known == name)
            .map(|&(_, function, _)| function)
    }

    /// As equations write it.
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// How many arguments it takes.
    pub fn arguments(self) -> usize {
        self.entry().2
    }

    /// Names of all functions, for messages.
    pub fn names() -> impl Iterator<Item = &'static str> {
        ALL.iter().map(|(name, ..)| *name)
    }

    fn entry(self) -> &'static (&'static str, Self, usize) {
        // the table holds every variant: `every_function_is_in_the_table` below
        ALL.iter()
            .find(|(_, function, _)| *function == self)
            .unwrap_or(&ALL[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_is_in_the_table() {
        for &(name, function, count) in &ALL {
            assert_eq!(Function::find(name), Some(function));
            assert_eq!((function.name(), function.arguments()), (name, count));
        }
        assert_eq!(Function::Interpolated as usize + 1, ALL.len());
    }
}
