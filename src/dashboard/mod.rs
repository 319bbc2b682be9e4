//! Pages for people, rendered on the server: what a job found, in numbers and pictures.
//!
//! Rendering only: what is shown comes in as values, so that a page can be made from a running service, a
//! file or a test alike. Scripts add what moves: live iterations, plots to zoom into, forms.
//!
//! Invariant: a page is a function of its view; nothing here asks a store, a clock or a network.

mod assets;
mod bode_figure;
mod chart;
mod compare_page;
mod conditions;
mod correlation;
mod decimate;
mod diagnosis;
mod dynamics_page;
mod eigenvalues;
mod error_bars;
mod estimate_tables;
mod figure;
mod force_figure;
mod guide;
mod guide_page;
mod guide_text;
mod intervals;
mod job_page;
mod jobs_page;
mod layout;
mod maneuver_page;
mod maneuvers_page;
mod mathml;
#[cfg(test)]
mod mathml_tests;
mod model_diff;
mod model_page;
mod model_tables;
mod models_page;
mod new_job_page;
mod notation;
mod palette;
mod problem_page;
mod report;
mod report_basis;
mod report_method;
mod residual_figures;
mod search;
mod study;
mod study_figure;
mod style;
mod ticks;
mod tolerances;
mod unit_list;
mod unmodelled;

pub use assets::{Asset, asset};
pub use bode_figure::bode_svg;
pub use compare_page::{CompareView, compare_page};
pub use conditions::{Chosen as ChosenCondition, Offered};
pub use decimate::rows_to_plot;
pub use dynamics_page::{DynamicsView, dynamics_page};
pub use figure::history_svg;
pub use guide::guide_picture;
pub use guide_page::guide_page;
pub use job_page::{JobView, ModelPlace, NamedModel, UsedManeuver, job_page};
pub use jobs_page::{Chosen, JobRow, JobsView, jobs_page};
pub use maneuver_page::{ManeuverView, maneuver_page};
pub use maneuvers_page::{ManeuverRow, ManeuversView, maneuvers_page};
pub use model_diff::Comparison;
pub use model_page::{ModelView, OtherModel, model_page};
pub use models_page::{Draft, ModelRow, ModelsView, models_page};
pub use new_job_page::new_job_page;
pub use problem_page::{ProblemView, problem_page};
pub use report::{ReportView, report};
pub use report_basis::ReportRecording;
pub use study_figure::{cost_figure, error_figure};
pub use unmodelled::force_svg;
