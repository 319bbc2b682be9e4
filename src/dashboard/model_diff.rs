//! How one model differs from another: place by place, with equations typeset side by side.

use maud::{Markup, html};
use serde_json::Value;

use super::mathml::{Left, equation};
use super::model_tables::number;
use super::notation::Notation;
use crate::diagnose::DocumentChange;
use crate::flight::escape;
use crate::flight::{Shown, shown_in};
use crate::model::{Element, ModelDocument};

/// Another model, and what it has that this one has not.
pub struct Comparison {
    /// As in the address.
    pub reference: String,
    pub name: String,
    /// Its own page.
    pub address: String,
    pub document: ModelDocument,
    pub changes: Vec<DocumentChange>,
}

/// What the other model has that `document` has not, equations first.
pub(super) fn comparison(document: &ModelDocument, against: &Comparison) -> Markup {
    html! {
        section aria-labelledby="difference" {
            h2 id="difference" { "Compared with " a href=(against.address) { (against.name) } }
            @if against.changes.is_empty() {
                p { "Nothing: the two documents are the same." }
            } @else {
                (changes([(document, &document.name), (&against.document, &against.name)], &against.changes))
            }
        }
    }
}

/// Changes from one document to another, each with what it is called in the heading.
pub(super) fn changes(
    [before, after]: [(&ModelDocument, &str); 2],
    changes: &[DocumentChange],
) -> Markup {
    let mut changes: Vec<DocumentChange> = changes.iter().flat_map(by_entry).collect();
    // the sort keeps the order of the document within each section
    changes.sort_by_key(|change| rank(&change.pointer));
    let [of_before, of_after] = [before, after].map(|(document, _)| Notation::of(document));
    html! {
        p { (in_numbers(&changes)) }
        div.scroll tabindex="0" role="region" aria-label="Changes of the model" {
            table.difference {
                thead { tr {
                    th scope="col" { "place" } th scope="col" { "change" } th scope="col" { (before.1) } th scope="col" { (after.1) }
                } }
                tbody {
                    @for change in &changes {
                        tr {
                            th scope="row" { (place(&change.pointer)) }
                            td class=(word(change)) { (word(change)) }
                            td { @if let Some(value) = &change.before { (side(&of_before, before.0, &change.pointer, value)) } }
                            td { @if let Some(value) = &change.after { (side(&of_after, after.0, &change.pointer, value)) } }
                        }
                    }
                }
            }
        }
    }
}

/// A change of a whole section, which only one of the documents has, as one of each of its entries.
pub(super) fn by_entry(change: &DocumentChange) -> Vec<DocumentChange> {
    let (before, after) = (change.before.as_ref(), change.after.as_ref());
    let is_section = change.pointer.matches('/').count() == 1;
    match (before, after) {
        (None, Some(Value::Object(entries))) | (Some(Value::Object(entries)), None)
            if is_section =>
        {
            let entries = entries.iter();
            entries
                .map(|(name, entry)| DocumentChange {
                    pointer: format!("{}/{}", change.pointer, escape(name)),
                    before: before.map(|_| entry.clone()),
                    after: after.map(|_| entry.clone()),
                })
                .collect()
        }
        _ => vec![change.clone()],
    }
}

/// Equations that stand at a place of a document, typeset: that of `/states/q/derivative`, or all that
/// are in what was added at `/outputs/ay`. Empty where there is none.
pub(super) fn equations_at(notation: &Notation, pointer: &str, value: &Value) -> Vec<Markup> {
    let steps = steps(pointer);
    let (section, name, member) = match steps.as_slice() {
        [section, name] => (section, name, None),
        [section, name, member] => (section, name, Some(member.as_str())),
        _ => return Vec::new(),
    };
    let text = |key: &str| match member {
        Some(member) => value.as_str().filter(|_| member == key),
        None => value.get(key).and_then(Value::as_str),
    };
    let size = |element: Element| (element.field(), Left::Size(element, name));
    let lefts = match section.as_str() {
        "states" => vec![
            ("derivative", Left::Rate(name)),
            ("initial", Left::Initial(name)),
        ],
        "definitions" => vec![("equation", Left::Value(name))],
        "inputs" => Element::ALL.map(size).to_vec(),
        "outputs" => std::iter::once(("equation", Left::Output(name)))
            .chain(Element::ALL.map(size))
            .collect(),
        _ => Vec::new(),
    };
    lefts
        .into_iter()
        .filter_map(|(key, left)| Some(equation(notation, left, text(key)?)))
        .collect()
}

/// What stands at the place in one of the two documents.
fn side(notation: &Notation, document: &ModelDocument, pointer: &str, value: &Value) -> Markup {
    let equations = equations_at(notation, pointer, value);
    if let Value::Object(members) = value {
        let steps = steps(pointer);
        let shown = unit_at(document, pointer);
        let is_equation = |key: &str| {
            let is_size = Element::ALL.iter().any(|element| element.field() == key);
            !equations.is_empty()
                && (is_size || ["derivative", "initial", "equation"].contains(&key))
        };
        return html! {
            @for equation in &equations { div { (equation) } }
            @if steps.len() == 2 {
                @let listed = members.iter().filter(|(key, _)| *key != "description" && !is_equation(key));
                @for (at, (key, member)) in listed.enumerate() {
                    @if at > 0 { ", " }
                    span.soft { (key) } " "
                    @if key == "unit" && !shown.unit.is_empty() { (shown.unit) } @else { (plain(member, &shown)) }
                }
                @if let Some(description) = members.get("description") { div.soft { (plain(description, &shown)) } }
            } @else {
                (plain(value, &shown))
            }
        };
    }
    if !equations.is_empty() {
        return html! {
            @for equation in &equations { div { (equation) } }
            code.soft { (plain(value, &shown_in(""))) }
        };
    }
    let shown = unit_at(document, pointer);
    html! {
        (plain(value, &shown))
        @if value.is_number() && !["", "-"].contains(&shown.unit.as_str()) { " " span.soft { (shown.unit) } }
    }
}

/// A value as people read it.
fn plain(value: &Value, shown: &Shown) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Bool(true) => "yes".to_string(),
        Value::Bool(false) => "no".to_string(),
        Value::Number(_) => number(value.as_f64().unwrap_or(f64::NAN), shown.scale),
        Value::Object(members) if members.contains_key("mean") => {
            let of = |key: &str| plain(members.get(key).unwrap_or(&Value::Null), shown);
            format!("{} ± {}", of("mean"), of("sd"))
        }
        other => other.to_string(),
    }
}

/// The unit of the number at a place.
fn unit_at(document: &ModelDocument, pointer: &str) -> Shown {
    let steps = steps(pointer);
    let unit = match steps.as_slice() {
        [section, name, ..] if section == "parameters" => {
            document.parameters.get(name).map(|one| &one.unit)
        }
        [section, name, ..] if section == "constants" => {
            document.constants.get(name).map(|one| &one.unit)
        }
        _ => None,
    };
    shown_in(unit.map(String::as_str).unwrap_or_default())
}

/// Equations first, what is only said last.
fn rank(pointer: &str) -> usize {
    const ORDER: [&str; 6] = [
        "states",
        "definitions",
        "outputs",
        "inputs",
        "parameters",
        "constants",
    ];
    let section = pointer.split('/').nth(1).unwrap_or_default();
    let at = ORDER.iter().position(|known| *known == section);
    at.unwrap_or(ORDER.len())
}

fn in_numbers(changes: &[DocumentChange]) -> String {
    let count = |word_of: &str| {
        changes
            .iter()
            .filter(|change| word(change) == word_of)
            .count()
    };
    format!(
        "{} changed, {} added, {} removed.",
        count("changed"),
        count("added"),
        count("removed")
    )
}

fn word(change: &DocumentChange) -> &'static str {
    match (&change.before, &change.after) {
        (None, _) => "added",
        (_, None) => "removed",
        _ => "changed",
    }
}

/// A place in a document for people: `/states/q/derivative` is the derivative of the state q.
pub(super) fn place(pointer: &str) -> String {
    let steps = steps(pointer);
    let Some((section, rest)) = steps.split_first() else {
        return "the document".to_string();
    };
    // `parameters` is of many, `parameter` of one
    let one = section.strip_suffix('s').unwrap_or(section);
    match rest {
        [] => section.clone(),
        [name] => format!("{one} {name}"),
        [name, member @ ..] => format!("{one} {name}: {}", member.join(" ")),
    }
}

/// The steps of an RFC 6901 pointer.
fn steps(pointer: &str) -> Vec<String> {
    let steps = pointer.split('/').skip(1);
    steps
        .map(|step| step.replace("~1", "/").replace("~0", "~"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn equations_are_found_where_they_stand() {
        let none = Notation::default();
        let count = |pointer: &str, value: Value| equations_at(&none, pointer, &value).len();
        assert_eq!(count("/states/q/derivative", json!("a*q")), 1);
        assert_eq!(count("/states/q/unit", json!("rad")), 0);
        assert_eq!(
            count("/states/q", json!({"derivative": "a", "initial": "0"})),
            2
        );
        assert_eq!(
            count("/outputs/q", json!({"equation": "q", "unit": "rad"})),
            1
        );
        assert_eq!(count("/parameters/a/start", json!("first(q)")), 0);
        assert_eq!(count("", json!(null)) + count("/a/b/c/d", json!("x")), 0);
    }

    #[test]
    fn a_section_that_is_new_is_told_by_its_entries() {
        let change = DocumentChange {
            pointer: "/definitions".into(),
            before: None,
            after: Some(json!({"a": {"equation": "b"}, "c/d": {"equation": "e"}})),
        };
        let entries = by_entry(&change);
        let places: Vec<&str> = entries.iter().map(|one| one.pointer.as_str()).collect();
        assert_eq!(places, ["/definitions/a", "/definitions/c~1d"]);
        assert!(entries.iter().all(|one| one.before.is_none()));
        assert_eq!(by_entry(&entries[0]), entries[..1]);
    }

    #[test]
    fn places_are_said_in_words() {
        assert_eq!(place("/states/q/derivative"), "state q: derivative");
        assert_eq!(place("/parameters/q_bias"), "parameter q_bias");
        assert_eq!(place("/title"), "title");
    }
}
