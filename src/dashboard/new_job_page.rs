//! The page where a job is made: a form over the same document that the API takes.
//!
//! What there is to choose from is asked of the API by the page's script, so that it is what a job may really name.

use maud::{Markup, html};

use super::layout::{Frame, page};

/// A choice of the form: its place in the job, and what may stand there.
struct Choice {
    pointer: &'static str,
    label: &'static str,
    /// Value and text; the first is what the service takes without it.
    values: &'static [(&'static str, &'static str)],
}

const CHOICES: [Choice; 8] = [
    Choice {
        pointer: "/options/estimator",
        label: "Estimator",
        values: &[
            ("output_error", "output error"),
            ("filter_error", "filter error (process noise)"),
            ("equation_error", "equation error"),
        ],
    },
    Choice {
        pointer: "/options/start/kind",
        label: "Start values",
        values: &[
            ("automatic", "automatic"),
            ("document", "of the model"),
            ("equation_error", "equation error"),
            ("nelder_mead", "Nelder-Mead"),
            ("multi_start", "many random starts"),
            ("multiple_shooting", "multiple shooting"),
        ],
    },
    Choice {
        pointer: "/options/method",
        label: "Steps",
        values: &[
            ("levenberg_marquardt", "Levenberg-Marquardt"),
            ("gauss_newton", "Gauss-Newton"),
        ],
    },
    Choice {
        pointer: "/options/derivatives/technique",
        label: "Derivatives",
        values: &[
            ("forward_sensitivities", "forward sensitivities"),
            ("forward_difference", "forward differences"),
            ("central_difference", "central differences"),
            ("complex_step", "complex step"),
            ("adjoint", "adjoint"),
        ],
    },
    Choice {
        pointer: "/options/noise/structure",
        label: "Noise covariance",
        values: &[("diagonal", "diagonal"), ("full", "full")],
    },
    Choice {
        pointer: "/options/error_bounds",
        label: "Error bounds",
        values: &[
            ("corrected", "corrected for coloured residuals"),
            ("conventional", "conventional"),
        ],
    },
    Choice {
        pointer: "/options/integrator",
        label: "Integrator",
        values: &[
            ("rk4", "Runge-Kutta 4"),
            ("rk2", "Runge-Kutta 2"),
            ("euler", "Euler"),
        ],
    },
    Choice {
        pointer: "/options/input_interpolation",
        label: "Inputs between samples",
        values: &[("linear", "linear"), ("hold", "held")],
    },
];

/// The whole page as HTML.
pub fn new_job_page() -> String {
    let content = html! {
        h1 { "New job" }
        noscript { p.note { "This page needs scripts. Without them, post the job to " code { "/v1/jobs" } "." } }
        form id="form" novalidate {
            fieldset {
                legend { "1. Maneuvers" }
                p.soft { "Those of the estimation are fitted together. Of each a part may be used, from one second to another of its own time, or several parts. Validation flights decide whether an effect that was found is real; a final test takes part in no decision. "
                    a href="/maneuvers" { "Upload a maneuver" } }
                div id="maneuvers" { p.soft { "Asking the service ..." } }
            }
            fieldset {
                legend { "2. Model" }
                div.row { label { "Model" select id="model" name="model" data-at="/model" {} } a id="about-model" href="/models" { "Look at it" } }
                p.soft id="model-text" {}
                div id="channels" {}
            }
            fieldset {
                legend { "3. What to find" }
                div.row role="radiogroup" aria-label="Kind" {
                    (kind("estimate", "Parameters", true))
                    (kind("diagnose", "Parameters, and what the model lacks (takes longer: hundreds of fits)", false))
                    (kind("derivative_study", "Parameters, and derivative techniques compared", false))
                }
                details {
                    summary { "Parameters: start values, bounds, what is held" }
                    div id="parameters" {}
                }
                details {
                    summary { "How it is estimated" }
                    div.row {
                        @for choice in &CHOICES { (selection(choice)) }
                        label { "Most iterations"
                            input type="number" min="0" step="1" data-pointer="/options/max_iterations" placeholder="50"; }
                        label { "Tolerance, standard errors"
                            input type="number" min="0" step="any" data-pointer="/options/tolerance" placeholder="1e-5"; }
                    }
                }
            }
            fieldset {
                legend { "4. Submit" }
                div.row {
                    label { "Name" input data-pointer="/name" maxlength="200" size="40" autocomplete="off"; }
                    label { "Tags, with commas between" input id="tags" data-at="/tags" size="30" autocomplete="off"; }
                    label { "Priority" input type="number" min="-10" max="10" step="1" data-pointer="/priority" placeholder="0"; }
                }
                div.row.center style="margin-top: .75rem" {
                    button.main { "Submit" }
                    button type="button" id="check" { "Check only" }
                    span id="said" role="status" {}
                }
                div id="faults" role="alert" {}
            }
        }
        details {
            summary { "The same with curl, and what the form does not offer" }
            p.soft { "The job as the API takes it. What is changed here is in the job, whether the form knows it or not." }
            label { "Job (JSON)" textarea id="json" rows="16" spellcheck="false" {} }
            p id="json-fault" role="status" {}
            pre id="curl" tabindex="0" aria-label="curl command" {}
        }
    };
    let frame = Frame {
        title: "New job",
        under: "/new",
        scripts: &["new_job.js"],
    };
    page(&frame, &content)
}

fn kind(value: &str, text: &str, is_chosen: bool) -> Markup {
    html! {
        label.beside { input type="radio" name="kind" value=(value) checked[is_chosen]; (text) }
    }
}

fn selection(choice: &Choice) -> Markup {
    html! {
        label { (choice.label)
            select data-pointer=(choice.pointer) {
                @for (value, text) in choice.values { option value=(value) { (text) } }
            }
        }
    }
}
