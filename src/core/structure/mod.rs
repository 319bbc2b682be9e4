//! Structure determination: which terms an equation needs, from data.
//!
//! ```text
//! z = Xθ + v,   ŷ = Xθ̂,   MSE = (z − ŷ)ᵀ(z − ŷ)/N,   PSE = MSE + σ²_max p/N,   σ²_max = Σ(z − z̄)²/N
//! ```
//!
//! for N samples and p terms. [`stepwise()`] lets terms in and out by their partial F; [`orthogonal()`] makes terms orthogonal
//! to one another, orders them by what each explains, and keeps as many as give the least predicted squared error (PSE). Both
//! tell each step (Klein and Morelli, Aircraft System Identification, ch. 5; Morelli, J. Aircraft 32, 1995).
//!
//! Terms are columns of numbers with names here: where they come from is the matter of a job.
//!
//! Invariant: the same columns give the same steps to the last bit, and a structure says why it holds what it holds.

mod candidates;
mod generated;
mod least_squares;
mod options;
mod orthogonal;
mod report;
mod stepwise;

pub use candidates::Candidates;
pub use generated::{MOST_TERMS, polynomials};
pub use options::{StructureMethod, StructureOptions};
pub use orthogonal::orthogonal;
pub use report::{Structure, StructureStep, Term, Verdict};
pub use stepwise::stepwise;
