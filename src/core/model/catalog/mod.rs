//! The models that come with Trimtab, each one a document with its source cited.

use super::ModelDocument;

/// Name and text of each.
const DOCUMENTS: [(&str, &str); 9] = [
    ("short-period", include_str!("short-period.toml")),
    ("phugoid", include_str!("phugoid.toml")),
    ("longitudinal", include_str!("longitudinal.toml")),
    (
        "longitudinal-nonlinear",
        include_str!("longitudinal-nonlinear.toml"),
    ),
    (
        "lateral-directional-2",
        include_str!("lateral-directional-2.toml"),
    ),
    (
        "lateral-directional-4",
        include_str!("lateral-directional-4.toml"),
    ),
    (
        "six-degrees-of-freedom",
        include_str!("six-degrees-of-freedom.toml"),
    ),
    (
        "flight-path-reconstruction",
        include_str!("flight-path-reconstruction.toml"),
    ),
    (
        "flight-path-reconstruction-attitude",
        include_str!("flight-path-reconstruction-attitude.toml"),
    ),
];

/// The document as it was written, TOML.
pub fn text(name: &str) -> Option<&'static str> {
    DOCUMENTS
        .iter()
        .find(|(known, _)| *known == name)
        .map(|&(_, text)| text)
}

/// Looks a catalog model up by its name.
pub fn find(name: &str) -> Option<ModelDocument> {
    // that each of them can be read is what the test below is for
    text(name).and_then(|text| toml::from_str(text).ok())
}

/// All catalog models, in the order of the list.
pub fn all() -> Vec<ModelDocument> {
    DOCUMENTS
        .iter()
        .filter_map(|(name, _)| find(name))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::Model;
    use super::*;

    #[test]
    fn every_document_can_be_read_and_compiled_and_cites_its_source() {
        let names: Vec<String> = all().into_iter().map(|document| document.name).collect();
        assert_eq!(names, DOCUMENTS.map(|(name, _)| name));
        for document in all() {
            let model = Model::compile(&document)
                .unwrap_or_else(|faults| panic!("{}: {faults:?}", document.name));
            assert!(
                document.source.contains("eq."),
                "{} cites no equation",
                document.name
            );
            assert!(!model.states.is_empty() && !document.title.is_empty());
        }
    }

    #[test]
    fn toml_and_json_are_one_schema() {
        for document in all() {
            let json = serde_json::to_string(&document).unwrap();
            assert_eq!(
                serde_json::from_str::<ModelDocument>(&json).unwrap(),
                document
            );
            let text = toml::to_string(&document).unwrap();
            assert_eq!(toml::from_str::<ModelDocument>(&text).unwrap(), document);
        }
    }
}
