//! From one θ to the next until there is a reason to stop. The cost never rises from one iterate to the next, but for
//! rounding.

pub(super) mod acceleration;
pub(super) mod gauss_newton;
pub(super) mod iterate;
pub mod quasi_newton;
pub(super) mod search;
pub(super) mod step;
pub(super) mod stopped;
