//! Sums of products, and the symmetric matrices that are solved with them. Of parameters or flights nothing is known
//! here.

pub(super) mod definite;
mod elimination;
pub(super) mod products;
mod skyline;
pub(super) mod spectrum;
