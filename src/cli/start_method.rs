//! Where output error starts from, as a word on the command line.

use crate::estimate::StartMethod;

/// The words, each with what may follow behind a colon.
const WORDS: &str = "automatic, document, equation_error, nelder_mead[:SIMULATIONS], multi_start[:STARTS], multiple_shooting[:SECONDS]";

/// Reads a word with or without its number: `nelder_mead:5000`.
pub(super) fn start_method(text: &str) -> Result<StartMethod, String> {
    let (word, number) = match text.split_once(':') {
        Some((word, number)) => (word, Some(number)),
        None => (text, None),
    };
    let unfit = || format!("choose one of {WORDS}");
    let field = match word {
        "automatic" | "document" | "equation_error" => None,
        "nelder_mead" => Some("max_evaluations"),
        "multi_start" => Some("starts"),
        "multiple_shooting" => Some("interval"),
        _ => return Err(unfit()),
    };
    let mut value = serde_json::json!({"kind": word});
    if let Some(number) = number {
        let field = field.ok_or_else(unfit)?;
        value[field] = serde_json::from_str(number).map_err(|_| unfit())?;
    }
    let method: StartMethod = serde_json::from_value(value).map_err(|_| unfit())?;
    match method.unfit() {
        Some((_, message)) => Err(message),
        None => Ok(method),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_behind_the_word_is_its_setting() {
        let interval = StartMethod::MultipleShooting { interval: 0.5 };
        assert_eq!(start_method("multiple_shooting:0.5"), Ok(interval));
        let simplex = StartMethod::NelderMead {
            max_evaluations: 2000,
        };
        assert_eq!(start_method("nelder_mead"), Ok(simplex));
        for wrong in [
            "simplex",
            "document:3",
            "multi_start:x",
            "multi_start:0",
            "multiple_shooting:-1",
        ] {
            assert!(start_method(wrong).is_err(), "{wrong}");
        }
    }
}
