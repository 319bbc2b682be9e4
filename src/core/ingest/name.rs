//! Names of channels. Model equations and channel expressions refer to them, so they are identifiers.

use std::collections::HashSet;

use super::{Limits, code, text::quoted};

/// The time axis in expressions; no channel can have its name.
const TIME: &str = "t";

/// The names of one recording as they are met.
pub(super) struct Names<'a> {
    limits: &'a Limits,
    taken: HashSet<String>,
    suggested: HashSet<String>,
}

impl<'a> Names<'a> {
    pub(super) fn new(limits: &'a Limits) -> Self {
        Self {
            limits,
            taken: HashSet::from([TIME.to_string()]),
            suggested: HashSet::new(),
        }
    }

    /// Takes a channel's name.
    ///
    /// # Errors
    /// A code and a message with a name that would do.
    pub(super) fn take(&mut self, name: &str) -> Result<(), (&'static str, String)> {
        if name.is_empty() {
            let message = "this channel has no name; name it, or leave it out".to_string();
            return Err((code::EMPTY_NAME, message));
        }
        let longest = self.limits.max_name_length;
        if name.len() > longest {
            let message = format!(
                "the name {} is {} bytes long, more than max_name_length = {longest}; shorten it",
                quoted(name),
                name.len()
            );
            return Err((code::NAME_TOO_LONG, message));
        }
        if !is_identifier(name) {
            let message = format!(
                "{} cannot be a channel's name: equations refer to it, so it has letters a-z A-Z, digits and '_' only, and no digit first; {} would do",
                quoted(name),
                quoted(&self.suggestion(name))
            );
            return Err((code::INVALID_NAME, message));
        }
        if self.taken.insert(name.to_string()) {
            return Ok(());
        }
        let free = quoted(&self.suggestion(name));
        if name == TIME {
            let message = format!("'{TIME}' is the time axis; rename this channel, {free} is free");
            return Err((code::INVALID_NAME, message));
        }
        let message = format!(
            "there is a channel '{name}' already; leave one out, or rename it, {free} is free"
        );
        Err((code::DUPLICATE_CHANNEL, message))
    }

    /// Takes a name for a title: the title itself where it is an identifier and free, else one close to it.
    pub(super) fn take_like(&mut self, title: &str) -> String {
        let mut stem = identifier_like(title);
        if is_identifier(title) {
            stem = title.to_string();
        }
        stem.truncate(self.limits.max_name_length.saturating_sub(6).max(1));
        let numbered = (2usize..).map(|n| format!("{stem}_{n}"));
        let free = std::iter::once(stem.clone())
            .chain(numbered)
            .find(|name| !self.taken.contains(name))
            .unwrap_or(stem);
        self.taken.insert(free.clone());
        free
    }

    /// An identifier close to `name` that is free so far and suggested once only: two faulty names
    /// are not told to become the same.
    fn suggestion(&mut self, name: &str) -> String {
        let stem = identifier_like(name);
        let numbered = (2usize..).map(|n| format!("{stem}_{n}"));
        let free = std::iter::once(stem.clone())
            .chain(numbered)
            .find(|name| !self.taken.contains(name) && !self.suggested.contains(name))
            .unwrap_or(stem);
        self.suggested.insert(free.clone());
        free
    }
}

/// Whether `[A-Za-z_][A-Za-z0-9_]*`.
pub(super) fn is_identifier(name: &str) -> bool {
    let mut bytes = name.bytes();
    bytes
        .next()
        .is_some_and(|first| first.is_ascii_alphabetic() || first == b'_')
        && bytes.all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
}

/// An identifier close to a name.
pub(super) fn identifier_like(name: &str) -> String {
    let mut like = String::new();
    for c in name.chars() {
        match c {
            'α' => like.push_str("alpha"),
            'β' => like.push_str("beta"),
            'γ' => like.push_str("gamma"),
            'δ' => like.push_str("delta"),
            'θ' | 'Θ' => like.push_str("theta"),
            'φ' | 'Φ' => like.push_str("phi"),
            'ψ' | 'Ψ' => like.push_str("psi"),
            'ρ' => like.push_str("rho"),
            _ if c.is_ascii_alphanumeric() => like.push(c),
            _ if like.ends_with('_') => {}
            _ => like.push('_'),
        }
    }
    let trimmed = like.trim_matches('_');
    match trimmed.as_bytes().first() {
        None => "channel".to_string(),
        Some(first) if first.is_ascii_digit() => format!("_{trimmed}"),
        Some(_) => trimmed.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_pass_and_others_get_a_suggestion() {
        let limits = Limits::default();
        let mut names = Names::new(&limits);
        for good in ["alpha", "_1", "ay_ckp", "T"] {
            assert_eq!(names.take(good), Ok(()), "{good}");
        }
        let mut refused = |name: &str, code: &str, suggestion: &str| {
            let (found, message) = names.take(name).unwrap_err();
            assert_eq!(found, code, "{name}");
            assert!(message.contains(suggestion), "{message}");
        };
        refused("angle of attack", code::INVALID_NAME, "'angle_of_attack'");
        refused("angle-of attack", code::INVALID_NAME, "'angle_of_attack_2'");
        refused("δ_e", code::INVALID_NAME, "'delta_e'");
        refused("1st", code::INVALID_NAME, "'_1st'");
        refused("%%", code::INVALID_NAME, "'channel'");
        refused("t", code::INVALID_NAME, "'t_2'");
        refused("alpha", code::DUPLICATE_CHANNEL, "'alpha_2'");
        refused("", code::EMPTY_NAME, "no name");
        refused(
            &"x".repeat(129),
            code::NAME_TOO_LONG,
            "max_name_length = 128",
        );
    }

    #[test]
    fn titles_get_a_name_of_their_own() {
        let limits = Limits::default();
        let mut names = Names::new(&limits);
        for (title, name) in [
            ("Engine 1 RPM", "Engine_1_RPM"),
            ("xyz[0]", "xyz_0"),
            ("alpha", "alpha"),
            ("alpha", "alpha_2"),
            ("t", "t_2"),
            ("imu/rates[1]", "imu_rates_1"),
        ] {
            assert_eq!(names.take_like(title), name);
        }
    }

    #[test]
    fn a_suggestion_does_not_take_the_name() {
        let limits = Limits::default();
        let mut names = Names::new(&limits);
        assert!(names.take("a b").is_err());
        assert_eq!(names.take("a_b"), Ok(()));
    }
}
