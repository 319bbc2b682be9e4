//! The functions that equations may call.

/// A function by name. Those behind `if` look at a recording: they are allowed only in channel formulas and where a
/// parameter's start value is worked out. A recording with gaps is filtered part by part.
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
    /// `held(channel)`: a missing sample is the one before; before the first one nothing is known.
    Held,
    /// `fresh(channel)`: only samples that differ from the one before, of a channel that a logger has held up to a higher
    /// rate; the others are missing.
    Fresh,
    /// `unwrap(angle)`: full turns added where an angle jumps by more than half a turn.
    Unwrap,
    /// `delayed(channel, seconds)`: what the channel was so many seconds before, on straight lines between its samples; the
    /// first seconds are missing. A negative delay advances it.
    Delayed,
    /// `lowpass(channel, frequency)`: a Butterworth filter of second order, as a computer on board has it: gain 1/√2 at the
    /// frequency, late by 0.225/frequency where the channel is slow. It starts steady at the first sample.
    Lowpass,
    /// `smoothed(channel, frequency)`: the same forwards and backwards, which delays nothing: gain 1/√2 at the frequency, 1/4
    /// about 1.7 times above. At its ends the channel goes on turned about its last sample; what is closer than about
    /// 0.5/frequency to an end, or to a gap, is smoothed less well.
    Smoothed,
    /// `derivative(channel, frequency)`: the rate of change of `smoothed(channel, frequency)`, by cubic splines; delays
    /// nothing.
    Derivative,
    /// `north(latitude, longitude)`: metres north of the first position there is, on the plane that touches the ellipsoid of
    /// WGS 84 there.
    North,
    /// `east(latitude, longitude)`: metres east of it.
    East,
    /// `airspeed(dynamic pressure, density)`: √(2 qc/ρ), negative where the pressure is; compressibility is left out, which is
    /// 1 % too fast at Mach 0.28.
    Airspeed,
}

const ALL: [(&str, Function, usize); 30] = [
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
    ("held", Function::Held, 1),
    ("fresh", Function::Fresh, 1),
    ("unwrap", Function::Unwrap, 1),
    ("delayed", Function::Delayed, 2),
    ("lowpass", Function::Lowpass, 2),
    ("smoothed", Function::Smoothed, 2),
    ("derivative", Function::Derivative, 2),
    ("north", Function::North, 2),
    ("east", Function::East, 2),
    ("airspeed", Function::Airspeed, 2),
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

    /// Whether it is for recorded channels only, and has no place in the equations of a model.
    pub fn is_of_recordings(self) -> bool {
        let place = |function| ALL.iter().position(|(_, known, _)| *known == function);
        place(self) > place(Self::If)
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
        assert_eq!(Function::Airspeed as usize + 1, ALL.len());
        assert!(!Function::If.is_of_recordings() && Function::First.is_of_recordings());
    }
}
