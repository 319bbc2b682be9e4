//! Tests of the typesetting of equations.

use super::mathml::{Left, equation};
use super::notation::Notation;
use crate::model::expression::parse;
use crate::model::{Element, catalog};

/// The right side in a line: fractions as `[a|b]`, powers as `{a|b}`, products with a blank.
fn line(text: &str) -> String {
    let markup = equation(&Notation::default(), Left::Value("y"), text).0;
    let (_, right) = markup.split_once("<mo>=</mo>").expect("an equation");
    flat(right)
}

fn flat(markup: &str) -> String {
    let mut out = String::new();
    // an element that stands for brackets, and how many of its parts are over
    let mut open: Vec<(String, usize)> = Vec::new();
    for piece in markup.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').expect("a tag ends");
        let name = tag.split(' ').next().expect("a name");
        if let Some(closed) = name.strip_prefix('/') {
            if let Some((opened, _)) = open.pop() {
                assert_eq!(opened, closed, "{markup}");
                out.push_str(match closed {
                    "mfrac" => "]",
                    "msup" => "}",
                    "msqrt" => ")",
                    _ => "",
                });
            }
        } else {
            if let Some((parent, parts)) = open.last_mut() {
                if *parts > 0 && ["mfrac", "msup"].contains(&parent.as_str()) {
                    out.push('|');
                }
                *parts += 1;
            }
            out.push_str(match name {
                "mfrac" => "[",
                "msup" => "{",
                "msqrt" => "sqrt(",
                _ => "",
            });
            open.push((name.to_string(), 0));
        }
        out.push_str(&text.replace('\u{2062}', " ").replace('\u{2061}', ""));
    }
    out.replace("&lt;", "<").replace("&gt;", ">")
}

#[test]
fn parentheses_stand_where_they_are_needed() {
    for (text, expected) in [
        ("a + b*c", "a+b c"),
        ("(a + b)*c", "(a+b) c"),
        ("a - (b - c)", "a−(b−c)"),
        ("a + (b - c)", "a+b−c"),
        ("a*(b*c)", "a b c"),
        ("a - b*(c + d)", "a−b (c+d)"),
    ] {
        assert_eq!(line(text), expected, "{text}");
    }
}

#[test]
fn quotients_are_fractions() {
    for (text, expected) in [
        ("a/b", "[a|b]"),
        ("(a + b)/(c - d)", "[a+b|c−d]"),
        ("a/b*c", "[a|b] c"),
        ("a*b/c", "[a b|c]"),
        ("a/b/c", "[a|b c]"),
        ("a/(b + c)/d", "[a|(b+c) d]"),
        ("a/b*c/d", "[[a|b] c|d]"),
        ("a/(b/c)", "[a|[b|c]]"),
        ("a*(b/c)", "a [b|c]"),
        ("-a*b/c", "−[a b|c]"),
        ("(-a)/b*2", "−[a|b]·2"),
        ("(a/b)^2", "{([a|b])|2}"),
    ] {
        assert_eq!(line(text), expected, "{text}");
    }
}

#[test]
fn powers_are_raised() {
    for (text, expected) in [
        ("V^2", "{V|2}"),
        ("a^b^c", "{a|{b|c}}"),
        ("(a^b)^c", "{({a|b})|c}"),
        ("(a + b)^(c + d)", "{(a+b)|c+d}"),
        ("-a^2", "−{a|2}"),
        ("(-a)^2", "{(−a)|2}"),
        ("a^-2", "{a|−2}"),
        ("sin(a)^2", "{(sin(a))|2}"),
        ("1e-8^2", "{(1×{10|−8})|2}"),
    ] {
        assert_eq!(line(text), expected, "{text}");
    }
}

#[test]
fn signs_do_not_run_into_operators() {
    for (text, expected) in [
        ("a + -b", "a+(−b)"),
        ("a - -b*c", "a−(−b c)"),
        ("a*-b", "a (−b)"),
        ("--a", "−(−a)"),
        ("-(a + b)", "−(a+b)"),
        ("-(a + b)*c", "−(a+b) c"),
        ("-a + b", "−a+b"),
        ("a - (-b + c)", "a−(−b+c)"),
        ("a + (-b)^2", "a+{(−b)|2}"),
        ("a/-b", "[a|−b]"),
    ] {
        assert_eq!(line(text), expected, "{text}");
    }
}

#[test]
fn functions_and_numbers() {
    for (text, expected) in [
        ("g*sin(a - b)", "g sin(a−b)"),
        ("sqrt(u^2 + w^2)", "sqrt({u|2}+{w|2})"),
        ("abs(a)*b", "|a| b"),
        ("atan2(w, u)", "atan2(w,u)"),
        ("asin(a)", "arcsin(a)"),
        ("2*3", "2·3"),
        ("a*2^b", "a·{2|b}"),
        ("0.5*a", "0.5 a"),
        ("2.5e-8*a", "2.5×{10|−8} a"),
        ("2*pi*t", "2 π t"),
        ("if(a < 2, b, c)", "{bif\u{a0}a<2cotherwise"),
        ("k*if(a >= 2, b, c)", "k ({bif\u{a0}a≥2cotherwise)"),
    ] {
        assert_eq!(line(text), expected, "{text}");
    }
}

#[test]
fn the_left_side_says_what_it_is() {
    let left = |left: Left<'_>| {
        let markup = equation(&Notation::default(), left, "1").0;
        flat(markup.split("<mo>=</mo>").next().expect("a left side"))
    };
    assert_eq!(left(Left::Rate("alpha")), "α˙");
    assert_eq!(left(Left::Initial("q")), "q(0)");
    assert_eq!(left(Left::Output("q")), "qout");
    assert_eq!(left(Left::Size(Element::Delay, "q")), "delay of\u{a0}q");
    assert_eq!(left(Left::Rate("qbar")), "[dq¯|dt]");
}

#[test]
fn every_equation_of_the_catalog_is_typeset_with_all_its_names() {
    let mut count = 0;
    for document in catalog::all() {
        let notation = Notation::of(&document);
        let mut check = |left: Left<'_>, text: &str| {
            let markup = equation(&notation, left, text).0;
            assert!(markup.starts_with("<math"), "{text}");
            let expression = parse(text).expect("the catalog can be parsed");
            for (name, _) in expression.names() {
                let title = format!("title=\"{name}\"");
                assert!(markup.contains(&title), "{name} of {text}: {markup}");
            }
            count += 1;
        };
        for (name, state) in &document.states {
            check(Left::Rate(name), &state.derivative);
            check(Left::Initial(name), &state.initial);
        }
        for (name, definition) in &document.definitions {
            check(Left::Value(name), &definition.equation);
        }
        for (name, output) in &document.outputs {
            check(Left::Output(name), &output.equation);
        }
    }
    assert!(count > 100, "{count}");
}

#[test]
fn hostile_texts_are_escaped_and_long_ones_typeset() {
    let hostile = "<script>\"&'";
    let none = Notation::default();
    for left in [
        Left::Rate(hostile),
        Left::Output(hostile),
        Left::Size(Element::RateLimit, hostile),
    ] {
        for text in ["1", "a + ", "<b>", "x\" onload=\"y"] {
            let markup = equation(&none, left, text).0;
            assert!(
                !markup.contains("<script") && !markup.contains("<b>"),
                "{markup}"
            );
            assert!(!markup.contains("\" onload"), "{markup}");
        }
    }
    for operator in ["+", "*", "/", "-"] {
        let text = vec!["a"; 900].join(operator);
        assert!(
            equation(&none, Left::Value("y"), &text)
                .0
                .starts_with("<math")
        );
    }
    let text = vec!["a/b"; 450].join("*");
    assert!(
        equation(&none, Left::Value("y"), &text)
            .0
            .starts_with("<math")
    );
}
