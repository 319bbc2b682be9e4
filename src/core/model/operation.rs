//! What is done with numbers: by the nodes of a graph, and by the instructions that are made of them.

/// With one operand.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Unary {
    Negate,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
}

/// With two.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
    /// 1 where the left operand is less than the right one, else 0.
    Less,
    LessOrEqual,
}

/// What an instruction does with its operands a, b, c. Flat, so that it is told by one jump.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operation {
    Negate,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
    Less,
    LessOrEqual,
    Select,
    /// c + a b, rounded once.
    MultiplyAdd,
    /// c - a b, rounded once.
    MultiplySubtract,
}

impl Operation {
    /// How many operands it has: a, then b, then c.
    pub(super) fn operands(self) -> usize {
        match self {
            Self::Negate
            | Self::Sin
            | Self::Cos
            | Self::Tan
            | Self::Asin
            | Self::Acos
            | Self::Atan
            | Self::Tanh
            | Self::Exp
            | Self::Ln
            | Self::Sqrt
            | Self::Abs
            | Self::Sign => 1,
            Self::Add
            | Self::Subtract
            | Self::Multiply
            | Self::Divide
            | Self::Power
            | Self::Atan2
            | Self::Less
            | Self::LessOrEqual => 2,
            Self::Select | Self::MultiplyAdd | Self::MultiplySubtract => 3,
        }
    }
}

impl From<Unary> for Operation {
    fn from(unary: Unary) -> Self {
        match unary {
            Unary::Negate => Self::Negate,
            Unary::Sin => Self::Sin,
            Unary::Cos => Self::Cos,
            Unary::Tan => Self::Tan,
            Unary::Asin => Self::Asin,
            Unary::Acos => Self::Acos,
            Unary::Atan => Self::Atan,
            Unary::Tanh => Self::Tanh,
            Unary::Exp => Self::Exp,
            Unary::Ln => Self::Ln,
            Unary::Sqrt => Self::Sqrt,
            Unary::Abs => Self::Abs,
            Unary::Sign => Self::Sign,
        }
    }
}

impl From<Binary> for Operation {
    fn from(binary: Binary) -> Self {
        match binary {
            Binary::Add => Self::Add,
            Binary::Subtract => Self::Subtract,
            Binary::Multiply => Self::Multiply,
            Binary::Divide => Self::Divide,
            Binary::Power => Self::Power,
            Binary::Atan2 => Self::Atan2,
            Binary::Less => Self::Less,
            Binary::LessOrEqual => Self::LessOrEqual,
        }
    }
}
