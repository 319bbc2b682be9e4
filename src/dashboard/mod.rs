//! Pages for people, rendered on the server: what a job found, in numbers and pictures.
//!
//! Rendering only: what is shown comes in as values, so that a page can be made from a running service, a
//! file or a test alike.

mod assets;
mod figure;
mod job_page;
mod study;
mod study_figure;
mod style;

pub use assets::{Asset, asset};
pub use figure::history_svg;
pub use job_page::{JobView, job_page};
pub use study_figure::{cost_figure, error_figure};
