//! Trimtab estimates aircraft parameters from flight-test maneuvers, as a service.
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
//! Around them: what a job is ([`job`]), what keeps it ([`store`]), who runs it ([`work`]), who is told of its end
//! ([`webhook`]), how it is asked for ([`http`], [`cli`]), how its result looks ([`dashboard`]). Arrows go one way:
//! `estimate → simulate → model → flight`, `ingest → flight`, `job → estimate`, `store → job`, `work → store`,
//! `webhook → store`, `http → store, job, ingest, dashboard, webhook`. `http` and `work` meet only at the store. From `flight` to `job` all is synchronous and deterministic.

pub mod cli;
pub mod dashboard;
pub mod diagnose;
pub mod estimate;
pub mod flight;
pub mod http;
pub mod ingest;
pub mod job;
pub mod model;
pub mod simulate;
pub mod store;
pub mod webhook;
pub mod work;
