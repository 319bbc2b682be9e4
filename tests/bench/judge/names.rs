//! Two vocabularies: the judge's own, and the one of the catalog's models. A verdict must not depend on which.

/// Names changed to others, whole words only.
pub(crate) fn renamed(text: &str, names: &[(&str, &str)]) -> String {
    let mut result = String::new();
    let mut word = String::new();
    let finish = |word: &mut String, result: &mut String| {
        let to = names.iter().find(|(from, _)| from == word);
        result.push_str(to.map_or(word.as_str(), |(_, to)| to));
        word.clear();
    };
    for c in text.chars() {
        if c.is_alphanumeric() || c == '_' {
            word.push(c);
        } else {
            finish(&mut word, &mut result);
            result.push(c);
        }
    }
    finish(&mut word, &mut result);
    result
}

/// The way back.
pub(crate) fn reversed<'n>(names: &[(&'n str, &'n str)]) -> Vec<(&'n str, &'n str)> {
    names.iter().map(|(own, usual)| (*usual, *own)).collect()
}
