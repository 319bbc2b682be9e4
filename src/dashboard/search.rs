//! The search of a list.

use maud::{Markup, html};

/// The field in which a list is searched, with what it has been searched for.
pub(super) fn search_field(text: &str, what: &str) -> Markup {
    html! {
        label.search { "Search"
            input type="search" name="q" value=(text) maxlength="200" size="28" autocomplete="off" placeholder=(what);
        }
    }
}

/// A form of its own over a list that has nothing else to choose by.
pub(super) fn search_form(address: &str, list: &str, text: &str, what: &str) -> Markup {
    html! {
        form.row method="get" action=(address) role="search" aria-label={ "Search " (list) } {
            (search_field(text, what))
            button { "Search" }
            @if !text.is_empty() { a href=(address) { "Show all" } }
        }
    }
}
