//! The difference of two model documents.

use serde_json::Value;

use super::report::DocumentChange;
use crate::flight::escape;
use crate::model::ModelDocument;

/// Every place where two documents differ, in the order of the later one.
pub fn difference(before: &ModelDocument, after: &ModelDocument) -> Vec<DocumentChange> {
    let value = |document: &ModelDocument| serde_json::to_value(document).unwrap_or(Value::Null);
    let mut changes = Vec::new();
    compare("", Some(&value(before)), Some(&value(after)), &mut changes);
    changes
}

fn compare(
    pointer: &str,
    before: Option<&Value>,
    after: Option<&Value>,
    changes: &mut Vec<DocumentChange>,
) {
    match (before, after) {
        (Some(Value::Object(old)), Some(Value::Object(new))) => {
            for (key, value) in new {
                compare(
                    &format!("{pointer}/{}", escape(key)),
                    old.get(key),
                    Some(value),
                    changes,
                );
            }
            for (key, value) in old.iter().filter(|(key, _)| !new.contains_key(*key)) {
                compare(
                    &format!("{pointer}/{}", escape(key)),
                    Some(value),
                    None,
                    changes,
                );
            }
        }
        (before, after) if before == after => {}
        (before, after) => changes.push(DocumentChange {
            pointer: pointer.to_string(),
            before: before.cloned(),
            after: after.cloned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Edit, EditKind, catalog};

    #[test]
    fn an_edit_shows_where_it_changed_the_document() {
        let before = catalog::find("short-period").unwrap();
        let edit = Edit::new(EditKind::SensorScale, "q");
        let changes = difference(&before, &edit.apply(&before).unwrap().document);
        let places: Vec<&str> = changes
            .iter()
            .map(|change| change.pointer.as_str())
            .collect();
        assert_eq!(places, ["/parameters/q_scale", "/outputs/q/equation"]);
        assert!(changes[0].before.is_none() && changes[1].before.is_some());
        assert!(difference(&before, &before).is_empty());
    }
}
