//! What Octave calls the kinds of its values.

/// How a value is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Scalar,
    Matrix,
    Sparse,
    Diagonal,
    Permutation,
    Range,
    Text,
    Cell,
    /// One struct, whose fields are values.
    Struct,
    /// An array of structs, or an object: the fields are cells.
    Structs,
    Function,
    /// What `find` answers: the value itself is within.
    Index,
    Unknown,
}

impl Kind {
    /// Of the word behind `# type:`, without `global` before it.
    pub(super) fn of(word: &str) -> Self {
        match word {
            "bool" => Self::Scalar,
            "cell" => Self::Cell,
            "scalar struct" => Self::Struct,
            "struct" | "class" => Self::Structs,
            "function handle" => Self::Function,
            "lazy_index" => Self::Index,
            "string" | "sq_string" | "string array" => Self::Text,
            "permutation matrix" => Self::Permutation,
            _ if word.starts_with("sparse") => Self::Sparse,
            _ if word.ends_with("diagonal matrix") => Self::Diagonal,
            _ if word.ends_with("matrix") => Self::Matrix,
            _ if word.ends_with("scalar") => Self::Scalar,
            _ if word.ends_with("range") => Self::Range,
            _ => Self::Unknown,
        }
    }
}

/// Whether numbers of this kind have two parts.
pub(super) fn is_complex(word: &str) -> bool {
    word.contains("complex")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_known_by_their_words() {
        for (word, kind) in [
            ("scalar", Kind::Scalar),
            ("uint8 scalar", Kind::Scalar),
            ("float complex matrix", Kind::Matrix),
            ("bool matrix", Kind::Matrix),
            ("sparse bool matrix", Kind::Sparse),
            ("float diagonal matrix", Kind::Diagonal),
            ("double_range", Kind::Range),
            ("java object", Kind::Unknown),
        ] {
            assert_eq!(Kind::of(word), kind, "{word}");
        }
    }
}
