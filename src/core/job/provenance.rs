//! What made a result: enough to make it again.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The program that made a result, and on what.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Maker {
    /// The version of Trimtab.
    #[schema(example = "0.1.0")]
    pub version: String,
    /// SHA-256 of the program file: the same file gives the same numbers on the same kind of processor.
    #[schema(example = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08")]
    pub program: String,
    /// The processor's architecture.
    #[schema(example = "x86_64")]
    pub architecture: String,
    /// The widest vector instructions that were used. Sums of other widths are rounded in another order: estimates then
    /// differ by rounding.
    #[schema(example = "avx2+fma")]
    pub vector_instructions: String,
}
