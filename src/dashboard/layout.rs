//! What all pages have in common: the head, the way to the other pages, and the scripts.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A page of the service, with the way to the others.
pub(super) struct Frame<'a> {
    /// What the browser's tab and the heading say.
    pub title: &'a str,
    /// The address of the entry of [`WAYS`] that it belongs to.
    pub under: &'a str,
    /// Names of modules under `/assets/`.
    pub scripts: &'a [&'a str],
}

/// Where one can go from everywhere.
const WAYS: [(&str, &str); 6] = [
    ("/", "Jobs"),
    ("/maneuvers", "Maneuvers"),
    ("/models", "Models"),
    ("/new", "New job"),
    ("/docs/", "API"),
    ("/guide", "Guide"),
];

/// The whole page as HTML.
pub(super) fn page(frame: &Frame<'_>, content: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                (head(frame.title))
                link rel="icon" type="image/svg+xml" href="/assets/mark.svg";
                link rel="stylesheet" href="/assets/style.css";
                @for script in frame.scripts {
                    script type="module" src={ "/assets/" (script) } {}
                }
            }
            body {
                a.skip href="#content" { "Skip to the content" }
                header.site {
                    a.brand href="/" aria-label="Trimtab, jobs" { (mark()) "Trimtab" }
                    nav aria-label="Pages" {
                        ul {
                            @for (address, name) in WAYS {
                                li {
                                    a href=(address) aria-current=[(address == frame.under).then_some("page")] { (name) }
                                }
                            }
                        }
                    }
                }
                main id="content" tabindex="-1" { (content) }
            }
        }
    };
    page.into_string()
}

pub(super) fn head(title: &str) -> Markup {
    html! {
        meta charset="utf-8";
        meta name="viewport" content="width=device-width, initial-scale=1";
        title { (title) " - Trimtab" }
    }
}

/// A control surface with its tab.
fn mark() -> Markup {
    PreEscaped(
        r#"<svg class="mark" viewBox="0 0 32 16" aria-hidden="true"><path d="M1 8C4 3 13 3 20 6.4v3.2C13 13 4 13 1 8z"/><path class="tab" d="M21.5 6.6 31 11.4 21.5 9.6z"/></svg>"#
            .to_string(),
    )
}
