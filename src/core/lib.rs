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
//! | X(f), U(f), Z(f) | finite Fourier transforms of signals | [`spectral`] |
//! | J, R, F, the estimate | cost, steps, error bounds | [`estimate`] |
//! | A, B, C, D, H(jω) | linear system, flying qualities, trim | [`dynamics`] |
//! | u(t), F⁻¹ before flight | inputs designed, bounds predicted | [`design`] |
//! | H, γ², ε | frequency responses of recorded signals | [`response`] |
//! | θ_k, P_k | estimates as samples come in: least squares, Fourier regression, Kalman filter | [`recursive`] |
//! | X, F, PSE, PRESS | which terms an equation needs | [`structure`] |
//! | S⊥, ψ, the effect that is missing | screening, trials, verdict | [`diagnose`] |
//!
//! [`stop`] is how each of these is told to end, from within its loops.
//!
//! [`job`] is what may be asked of all this in one document, and the events by which its progress is told. Arrows go
//! one way: `job → diagnose → estimate → simulate → model → flight`, `job → design → dynamics → estimate`,
//! `estimate, response → spectral`, `job → structure`, `recursive → estimate`, `ingest, structure → flight`. Everything here is synchronous
//! and deterministic: no server, no database, no clock, no environment, no hidden randomness. The service around it
//! is the crate `trimtab`.
//!
//! # A fit
//!
//! ```
//! use trimtab_core::ingest::{Format, Limits, read};
//! use trimtab_core::{job, model::catalog};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//! #   std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))?;
//!     let recording = std::fs::read("data/elevator.csv")?;
//!     let maneuver = read(&recording, Format::Csv, &Limits::default())?;
//!     let model = catalog::find("short-period").ok_or("no model of this name")?;
//!
//!     let estimate = job::fit(&model, [maneuver])?.estimate;
//!     for row in &estimate.parameters {
//!         let bound = row.standard_error.unwrap_or_default();
//!         println!("{:8} {:9.4} ± {bound:.4} {}", row.name, row.estimate, row.unit);
//!     }
//!     // data/elevator.toml says what was flown: Ma = -3.4 1/s²
//!     let ma = estimate.parameters.iter().find(|row| row.name == "Ma").ok_or("no Ma")?;
//!     assert!((ma.estimate + 3.4).abs() < 3.0 * ma.standard_error.ok_or("no bound")?);
//!     Ok(())
//! }
//! ```
//!
//! # A diagnosis
//!
//! ```
//! use trimtab_core::diagnose::Verdict;
//! use trimtab_core::estimate::Role;
//! use trimtab_core::ingest::{Format, Limits, read};
//! use trimtab_core::{job, model::catalog};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//! #   std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))?;
//!     // the elevator's linkage has 0.6 deg of play, which no model in the catalog knows of
//!     let flights = [("fit", Role::Estimation), ("check", Role::Validation), ("final", Role::Final)];
//!     let mut flown = Vec::new();
//!     for (flight, role) in flights {
//!         let recording = std::fs::read(format!("data/effects/elevator-backlash-{flight}.csv"))?;
//!         flown.push((read(&recording, Format::Csv, &Limits::default())?, role));
//!     }
//!     let model = catalog::find("short-period").ok_or("no model of this name")?;
//!
//!     let found = job::diagnose(&model, flown)?.diagnosis.ok_or("it was stopped")?;
//!     println!("{}: {}", found.verdict.name(), found.sentence);
//!     assert_eq!(found.verdict, Verdict::Named);
//!     assert_eq!(found.effects[0].effect.name(), "backlash of de");
//!     Ok(())
//! }
//! ```
//!
//! What a job can ask besides (options, edits, priors, other channels) is a [`job::JobSpec`], which [`job::prepare()`] makes
//! a plan of and [`job::run()`] runs, telling of each iteration.

#![warn(missing_docs)]

pub mod design;
pub mod diagnose;
pub mod dynamics;
pub mod estimate;
pub mod flight;
pub mod ingest;
pub mod job;
pub mod model;
pub mod recursive;
pub mod response;
pub mod simulate;
pub mod spectral;
pub mod stop;
pub mod structure;
