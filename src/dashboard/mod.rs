//! Pages for people, rendered on the server: what a job found, in numbers and pictures.
//!
//! Rendering only: what is shown comes in as values, so that a page can be made from a running service, a
//! file or a test alike.

mod figure;
mod job_page;
mod style;

pub use figure::history_svg;
pub use job_page::{JobView, job_page};
