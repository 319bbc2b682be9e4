//! What is computed, from models to diagnoses, held against truth, theory and publications: `cargo test --test numbers`,
//! one subject by its name, `cargo test --test numbers delays::`.

#[path = "../common"]
mod common {
    pub(crate) mod chain;
    pub(crate) mod coloured;
    pub(crate) mod coverage;
    pub(crate) mod estimation;
    pub(crate) mod flight_data;
    pub(crate) mod large_jobs;
    pub(crate) mod plans;
    pub(crate) mod preprocessing;
    pub(crate) mod printed_adjoint;
    pub(crate) mod published_cases;
    pub(crate) mod random_starts;
    pub(crate) mod reconstruction;
    pub(crate) mod recordings;
    pub(crate) mod repository;
    pub(crate) mod study_problems;
}

mod absence;
mod accuracy;
mod bundled_data;
mod bundled_effects;
mod campaign;
mod catalog;
mod catalog_published;
mod channel_formulas;
mod corners;
mod corrected;
mod coverage;
mod delays;
mod derivative_techniques;
mod design;
mod dynamics;
mod effects;
mod estimation;
mod filter_error;
mod findings;
mod frequency;
mod intervals;
mod invisible_effects;
mod knowledge;
mod likelihood;
mod machine_code;
mod missing_samples;
mod model_documents;
mod modes;
mod one_step;
mod only_in;
mod options;
mod paths;
mod play_and_limits;
mod predictions;
mod priors;
mod recursive;
mod response;
mod segments;
mod sensitivities;
mod simulator_models;
mod source_code;
mod starts;
mod steps;
mod stops;
mod structure;
mod trajectories;
mod trim;
mod unstable;
