//! How the names of a model are typeset: Greek letters, subscripts, the field's derivatives.
//!
//! A name is never lost: it stands in the `title` of what is typeset for it, and two names of a document that
//! would look alike stay as they are written.

use std::collections::{HashMap, HashSet};

use maud::{Markup, html};

use crate::flight::Unit;
use crate::model::ModelDocument;

/// The symbols of a document's names.
#[derive(Default)]
pub(super) struct Notation {
    symbols: HashMap<String, Symbol>,
}

/// A letter or word with an accent over it and subscripts.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
struct Symbol {
    base: String,
    accent: Option<char>,
    /// Commas stand between groups.
    subscripts: Vec<Vec<Symbol>>,
}

const DOT: char = '˙';
const ACCENTS: [(&str, char); 4] = [("bar", '¯'), ("hat", '^'), ("tilde", '~'), ("dot", DOT)];

const GREEK: [(&str, &str); 30] = [
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("epsilon", "ε"),
    ("zeta", "ζ"),
    ("eta", "η"),
    ("theta", "θ"),
    ("kappa", "κ"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("nu", "ν"),
    ("xi", "ξ"),
    ("pi", "π"),
    ("rho", "ρ"),
    ("sigma", "σ"),
    ("tau", "τ"),
    ("phi", "φ"),
    ("chi", "χ"),
    ("psi", "ψ"),
    ("omega", "ω"),
    ("Gamma", "Γ"),
    ("Delta", "Δ"),
    ("Theta", "Θ"),
    ("Lambda", "Λ"),
    ("Xi", "Ξ"),
    ("Sigma", "Σ"),
    ("Phi", "Φ"),
    ("Psi", "Ψ"),
    ("Omega", "Ω"),
];

/// What derivatives are called by where the whole word is too long.
const SHORT: [(&str, &str); 3] = [("a", "alpha"), ("b", "beta"), ("ad", "alphadot")];

impl Notation {
    /// Of all names of the document.
    pub(super) fn of(document: &ModelDocument) -> Self {
        let names: HashSet<&String> = (document.constants.keys())
            .chain(document.inputs.keys())
            .chain(document.parameters.keys())
            .chain(document.definitions.keys())
            .chain(document.states.keys())
            .chain(document.outputs.keys())
            .collect();
        let mut symbols: HashMap<String, Symbol> = (names.into_iter())
            .map(|name| (name.clone(), symbol(name, document)))
            .collect();
        let mut uses: HashMap<Symbol, usize> = HashMap::new();
        for symbol in symbols.values() {
            *uses.entry(symbol.clone()).or_default() += 1;
        }
        for (name, symbol) in &mut symbols {
            if uses.get(symbol).is_some_and(|count| *count > 1) {
                *symbol = Symbol::plain(name);
            }
        }
        Self { symbols }
    }

    /// A name as a symbol.
    pub(super) fn name(&self, name: &str) -> Markup {
        self.symbol(name).markup(name)
    }

    /// The name's rate of change: with a dot over it.
    pub(super) fn rate(&self, name: &str) -> Markup {
        let mut symbol = self.symbol(name);
        if symbol.accent.is_some() {
            return html! { mfrac { mrow { mi mathvariant="normal" { "d" } (symbol.markup(name)) } mrow { mi mathvariant="normal" { "d" } mi { "t" } } } };
        }
        symbol.accent = Some(DOT);
        symbol.markup(name)
    }

    /// What the model says of an output, which may be called like a state.
    pub(super) fn output(&self, name: &str) -> Markup {
        if self.symbols.contains_key(&format!("{name}_out")) {
            return html! { mrow { mtext { "output " } (self.name(name)) } };
        }
        let mut symbol = self.symbol(name);
        symbol.subscripts.push(vec![Symbol::plain("out")]);
        symbol.markup(name)
    }

    fn symbol(&self, name: &str) -> Symbol {
        let known = self.symbols.get(name).cloned();
        known.unwrap_or_else(|| symbol(name, &ModelDocument::default()))
    }
}

impl Symbol {
    fn plain(text: &str) -> Self {
        Self {
            base: text.to_string(),
            accent: None,
            subscripts: Vec::new(),
        }
    }

    fn with_subscript(base: &str, subscript: &str) -> Self {
        Self {
            subscripts: vec![vec![Self::plain(subscript)]],
            ..Self::plain(base)
        }
    }

    fn markup(&self, name: &str) -> Markup {
        html! { mrow title=(name) { (self.inner(true)) } }
    }

    /// Words in subscripts are upright, all others slanted, to be told from functions.
    fn inner(&self, is_slanted: bool) -> Markup {
        let is_number = self.base.chars().all(|c| c.is_ascii_digit());
        let is_word = is_slanted && self.base.chars().count() > 1;
        let letter = html! {
            @if is_number { mn { (self.base) } }
            @else { mi class=[is_word.then_some("word")] { (self.base) } }
        };
        let base = html! {
            @match self.accent {
                Some(accent) => { mover accent="true" { (letter) mo stretchy="false" { (accent) } } }
                None => { (letter) }
            }
        };
        if self.subscripts.is_empty() {
            return base;
        }
        html! {
            msub {
                (base)
                mrow {
                    @for (at, group) in self.subscripts.iter().enumerate() {
                        @if at > 0 { mo separator="true" { "," } }
                        @for symbol in group { (symbol.inner(false)) }
                    }
                }
            }
        }
    }
}

/// The symbol of a name: its head, and what follows each `_` as a subscript.
fn symbol(name: &str, document: &ModelDocument) -> Symbol {
    let mut parts = name.split('_');
    let head = parts.next().unwrap_or_default();
    if head.is_empty() || name.split('_').any(str::is_empty) {
        return Symbol::plain(name);
    }
    let derivative = document.parameters.contains_key(name);
    let derivative = derivative.then(|| derivative_symbol(head, document));
    let mut symbol = derivative
        .flatten()
        .unwrap_or_else(|| head_symbol(head, document));
    symbol
        .subscripts
        .extend(parts.map(|part| vec![letter(part)]));
    symbol
}

/// A parameter such as `Mde` or `CLalpha`, where what follows the force or moment is a quantity of the document.
fn derivative_symbol(head: &str, document: &ModelDocument) -> Option<Symbol> {
    let quantity = |name: &str| {
        document.states.contains_key(name)
            || document.inputs.contains_key(name)
            || document.definitions.contains_key(name)
            || document.outputs.contains_key(name)
    };
    let (base, axis, rest) = if let Some((axis, rest)) = coefficient(head) {
        ("C", Some(axis), rest)
    } else {
        let rest = head.strip_prefix(['X', 'Y', 'Z', 'L', 'M', 'N'])?;
        (&head[..1], None, rest)
    };
    let of = if rest == "0" {
        Symbol::plain("0")
    } else if quantity(rest) {
        head_symbol(rest, document)
    } else {
        let (_, whole) = SHORT.iter().find(|(short, _)| *short == rest)?;
        quantity(whole).then(|| head_symbol(whole, document))?
    };
    let group = axis.map(Symbol::plain).into_iter().chain([of]);
    Some(Symbol {
        subscripts: vec![group.collect()],
        ..Symbol::plain(base)
    })
}

/// The axis of a force or moment coefficient, and what follows.
fn coefficient(head: &str) -> Option<(&str, &str)> {
    let rest = head.strip_prefix('C')?;
    rest.starts_with(['D', 'L', 'T', 'X', 'Y', 'Z', 'l', 'm', 'n', 'x', 'y', 'z'])
        .then(|| rest.split_at(1))
}

fn head_symbol(head: &str, document: &ModelDocument) -> Symbol {
    if let Some((axis, "")) = coefficient(head) {
        return Symbol::with_subscript("C", axis);
    }
    let axes = |rest: &str, most: usize| {
        (1..=most).contains(&rest.len()) && rest.chars().all(|c| ('x'..='z').contains(&c))
    };
    // accelerations and moments of inertia
    for (base, most) in [("a", 1), ("I", 2)] {
        if let Some(rest) = head.strip_prefix(base)
            && axes(rest, most)
        {
            return Symbol::with_subscript(base, rest);
        }
    }
    if let Some(surface) = head.strip_prefix('d')
        && (1..=2).contains(&surface.len())
        && (document.inputs.get(head)).is_some_and(|input| is_angle(&input.unit))
    {
        return Symbol::with_subscript("δ", surface);
    }
    for (word, accent) in ACCENTS {
        // a state with a dot is its rate, which a name may stand for in part only
        if let Some(rest) = head.strip_suffix(word)
            && (rest.len() == 1 || greek(rest).is_some())
            && !(accent == DOT && document.states.contains_key(rest))
        {
            return Symbol {
                accent: Some(accent),
                ..letter(rest)
            };
        }
    }
    letter(head)
}

fn is_angle(unit: &str) -> bool {
    let radian = Unit::parse("rad").map(|unit| unit.dimension);
    Unit::parse(unit).map(|unit| unit.dimension).ok() == radian.ok()
}

fn letter(word: &str) -> Symbol {
    Symbol::plain(greek(word).unwrap_or(word))
}

fn greek(word: &str) -> Option<&'static str> {
    let found = GREEK.iter().find(|(name, _)| *name == word);
    found.map(|(_, letter)| *letter)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::catalog;

    /// What is left of the markup without its elements.
    fn bare(markup: &Markup) -> String {
        let pieces = markup
            .0
            .split('<')
            .filter_map(|piece| piece.split_once('>'));
        pieces.map(|(_, text)| text).collect()
    }

    fn shown(model: &str, name: &str) -> String {
        let document = catalog::find(model).expect("in the catalog");
        bare(&Notation::of(&document).name(name))
    }

    #[test]
    fn names_are_typeset_as_the_field_writes_them() {
        for (model, name, expected) in [
            ("short-period", "alpha_eq", "αeq"),
            ("short-period", "q_bias", "qbias"),
            ("short-period", "de_eq", "δe,eq"),
            ("short-period", "Mde", "Mδe"),
            ("short-period", "Za", "Zα"),
            ("six-degrees-of-freedom", "Clb", "Clβ"),
            ("six-degrees-of-freedom", "Cmad", "Cmα˙"),
            ("six-degrees-of-freedom", "qbar", "q¯"),
            ("six-degrees-of-freedom", "Ixz", "Ixz"),
            ("six-degrees-of-freedom", "Cm0", "Cm0"),
            ("six-degrees-of-freedom", "Cz_steady", "Cz,steady"),
            ("longitudinal-nonlinear", "CLalpha", "CLα"),
            ("flight-path-reconstruction", "K_beta_alpha", "Kβ,α"),
        ] {
            assert_eq!(shown(model, name), expected, "{model} {name}");
        }
        // u with a dot is the rate of the state u, and not a name
        assert_eq!(shown("six-degrees-of-freedom", "udot"), "udot");
    }

    #[test]
    fn what_is_not_known_stays_as_it_is_written() {
        let none = Notation::default();
        for name in ["Mde", "de", "_x", "a__b", "Ma", "dd", "q_"] {
            assert_eq!(bare(&none.name(name)), name);
        }
        let mut document = catalog::find("short-period").expect("in the catalog");
        document.inputs["de"].unit = "m".into();
        assert_eq!(bare(&Notation::of(&document).name("Mde")), "Mde");
    }

    #[test]
    fn names_that_would_look_alike_are_told_apart() {
        let mut document = catalog::find("six-degrees-of-freedom").expect("in the catalog");
        let mass = document.constants["m"].clone();
        document.constants.insert("a_x".into(), mass);
        let notation = Notation::of(&document);
        assert_eq!(bare(&notation.name("ax")), "ax");
        assert!(!notation.name("ax").0.contains("msub"));
        assert!(!notation.name("a_x").0.contains("msub"));
    }

    #[test]
    fn names_of_one_document_look_different_and_keep_their_title() {
        for document in catalog::all() {
            let notation = Notation::of(&document);
            let names = document.parameters.keys().chain(document.states.keys());
            let names = names
                .chain(document.constants.keys())
                .chain(document.inputs.keys())
                .chain(document.definitions.keys());
            let mut seen = HashSet::new();
            for name in names {
                let markup = notation.name(name).0;
                let title = format!("<mrow title=\"{name}\">");
                assert!(
                    seen.insert(markup.replacen(&title, "", 1)) && markup.starts_with(&title),
                    "{name}"
                );
            }
        }
    }
}
