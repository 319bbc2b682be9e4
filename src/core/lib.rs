//! Aircraft parameter estimation from flight test: models as data, output error, and what a model lacks.
//!
//! ```text
//! dx/dt = f(x, u, θ),  x(0) = x0(θ),   z_k = g(x_k, u_k, θ) + v_k,  v ~ N(0, R)
//! J(θ, R) = ½ Σ_k (z_k − y_k)ᵀ R⁻¹ (z_k − y_k) + (N/2) ln|R| + (N n_y/2) ln 2π
//! ```
//!
//! | symbol | what it is | room |
//! |---|---|---|
//! | z, u | recorded channels | [`flight`], read from files by [`ingest`] |
//! | f, g, x0, θ | a model document and what it compiles to | [`model`] |
//! | x, y, ∂y/∂θ | trajectories and sensitivities | [`simulate`] |
//! | J, R, F, the estimate | cost, steps, error bounds | [`estimate`] |
//! | S⊥, ψ, the effect that is missing | screening, trials, verdict | [`diagnose`] |
//!
//! [`job`] is what may be asked of all this in one document, and the events by which its progress is told. Arrows go
//! one way: `job → diagnose → estimate → simulate → model → flight`, `ingest → flight`. Everything here is synchronous
//! and deterministic: no server, no database, no clock, no environment, no hidden randomness. The service around it
//! is the crate `trimtab`.

#![warn(missing_docs)]

pub mod diagnose;
pub mod estimate;
pub mod flight;
pub mod ingest;
pub mod job;
pub mod model;
pub mod simulate;
