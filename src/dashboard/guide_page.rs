//! A page of the guide with the way to the others.

use maud::{Markup, PreEscaped, html};

use super::guide::{GuidePage, Part, pages};
use super::layout::{Frame, page};

/// The page of that name; `None` if there is none.
pub fn guide_page(name: &str) -> Option<String> {
    let shown = pages().iter().find(|page| page.name == name)?;
    let frame = Frame {
        title: &shown.text.title,
        under: "/guide",
        scripts: &[],
    };
    let content = html! {
        div.guide {
            nav.contents aria-label="Guide" { (contents(shown)) }
            article { (PreEscaped(&shown.text.html)) }
        }
    };
    Some(page(&frame, &content))
}

/// All pages by their parts, and the sections of the one that is shown.
fn contents(shown: &GuidePage) -> Markup {
    html! {
        @for part in Part::ALL {
            p.soft { (part.title()) }
            ul {
                @for page in pages().iter().filter(|page| page.part == part) {
                    @let is_shown = page.name == shown.name;
                    li {
                        a href=(address(page.name)) aria-current=[is_shown.then_some("page")] { (page.text.title) }
                        @if is_shown && page.text.sections.len() > 1 {
                            ul {
                                @for (text, anchor) in &page.text.sections {
                                    li { a href={ "#" (anchor) } { (text) } }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn address(name: &str) -> String {
    match name {
        "index" => "/guide".to_string(),
        name => format!("/guide/{name}"),
    }
}
