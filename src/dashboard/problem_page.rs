//! What went wrong, for people who came to a page that there is not, or that could not be shown.

use maud::html;

use super::layout::{Frame, page};
use crate::job::Fault;

/// What the page says.
pub struct ProblemView<'a> {
    /// What kind of problem it is.
    pub title: &'a str,
    /// What is wrong this time, and what would mend it.
    pub detail: &'a str,
    pub faults: &'a [Fault],
    /// By which operators find the request in the log.
    pub request: &'a str,
}

/// The whole page as HTML.
pub fn problem_page(view: &ProblemView<'_>) -> String {
    let content = html! {
        h1 { (view.title) }
        p.note { (view.detail) }
        @if !view.faults.is_empty() {
            ul { @for fault in view.faults { li { code { (fault.pointer) } " " (fault.message) } } }
        }
        p { a href="/" { "To the jobs" } }
        @if !view.request.is_empty() { p.soft { "Request " code { (view.request) } } }
    };
    let frame = Frame {
        title: view.title,
        under: "",
        scripts: &[],
    };
    page(&frame, &content)
}
