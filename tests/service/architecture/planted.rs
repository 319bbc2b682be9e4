//! Whether the test would see what it is to see: faults planted in small programs.

use std::collections::BTreeMap;

use super::circles::circles;
use super::core::{foreign_crates, is_foreign};
use super::modules::Modules;

fn program(files: &[(&str, &str)]) -> Modules {
    let files: BTreeMap<String, String> = files
        .iter()
        .map(|(file, text)| ((*file).to_owned(), (*text).to_owned()))
        .collect();
    Modules::read(&files, &[("own", "src/lib.rs"), ("other", "other/lib.rs")])
}

/// `file:line file` of each use between files.
fn uses(modules: &Modules) -> Vec<String> {
    let uses = modules.uses().into_iter();
    uses.map(|used| format!("{}:{} {}", used.from, used.line, used.to))
        .collect()
}

#[test]
fn names_are_followed_to_the_file_that_defines_them() {
    let found = uses(&program(&[
        ("src/lib.rs", "pub mod a;\npub mod b;\npub use other::far;"),
        (
            "src/a/mod.rs",
            "mod x;\nmod y;\npub use x::{X, make};\npub struct Here;",
        ),
        ("src/a/x.rs", "pub struct X;\npub fn make() {}"),
        (
            "src/a/y.rs",
            "use super::{Here, x::{self}};\nfn y() { x::make(); super::super::b::z() }",
        ),
        (
            "src/b.rs",
            "use std::fmt;\nuse crate::{a::{self as first, X as Y}, far};\n\
             fn b() { first::make() }\nfn c() { html! { (far::Far::new()) } }\n\
             #[serde(with = \"crate::a::Here\")]\nfn z() { b::z() }",
        ),
        ("other/lib.rs", "pub mod far;"),
        ("other/far.rs", "pub struct Far;"),
    ]));
    let expected = [
        "src/a/y.rs:1 src/a/mod.rs",
        "src/a/y.rs:2 src/a/x.rs",
        "src/a/y.rs:2 src/b.rs",
        "src/b.rs:4 other/far.rs",
        "src/b.rs:5 src/a/mod.rs",
        "src/b.rs:2 src/a/x.rs",
        "src/b.rs:3 src/a/x.rs",
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_module_and_a_function_of_one_name_are_told_apart() {
    let found = uses(&program(&[
        ("src/lib.rs", "mod a; mod b;"),
        ("src/a/mod.rs", "mod run; pub use run::run;"),
        ("src/a/run.rs", "pub fn run() {} pub struct R;"),
        ("src/b.rs", "use crate::a::run;\nfn b() { run() }"),
        ("other/lib.rs", ""),
    ]));
    assert_eq!(found, ["src/b.rs:1 src/a/run.rs"]);
}

#[test]
fn a_planted_circle_is_found_with_the_import_that_closes_it() {
    let a = "use crate::b::B;\nuse crate::b::C;\npub struct A;";
    let b = "pub struct B;\npub struct C;\n\nfn back() -> crate::a::A {}";
    let with = |b: &str| {
        let modules = program(&[
            ("src/lib.rs", "mod a; mod b;"),
            ("src/a.rs", a),
            ("src/b.rs", b),
            ("other/lib.rs", ""),
        ]);
        let uses = modules.uses();
        let told = circles(&modules.files(), &uses);
        told.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let circles = with(b);
    assert_eq!(circles.len(), 1);
    let (closes, because) = circles[0].split_once("because of").expect("two parts");
    assert!(
        closes.contains("src/b.rs:4 uses `A` of src/a.rs"),
        "{closes}"
    );
    assert!(
        because.contains("src/a.rs:2 uses `C` of src/b.rs"),
        "{because}"
    );
    assert!(
        with("pub struct B;\npub struct C;\n#[cfg(test)]\nmod tests { use crate::a::A; }")
            .is_empty()
    );
}

#[test]
fn a_child_that_uses_what_its_parent_defines_closes_a_circle_and_a_declaration_does_not() {
    let with = |parent: &str| {
        let modules = program(&[
            ("src/lib.rs", "mod room;"),
            ("src/room/mod.rs", parent),
            ("src/room/child.rs", "use super::Parent;\npub struct Child;"),
            ("other/lib.rs", ""),
        ]);
        let uses = modules.uses();
        circles(&modules.files(), &uses).len()
    };
    assert_eq!(
        with("mod child;\npub use child::Child;\npub struct Parent;"),
        0
    );
    assert_eq!(
        with("mod child;\nuse child::Child;\npub struct Parent(Child);"),
        1
    );
    assert_eq!(with("mod child;\npub struct Parent(child::Child);"), 1);
}

#[test]
fn folders_that_use_each_other_are_a_circle_though_their_files_are_none() {
    let modules = program(&[
        ("src/lib.rs", "mod room;"),
        ("src/room/mod.rs", "mod left; mod right;"),
        ("src/room/left/mod.rs", "pub mod top; pub mod bottom;"),
        (
            "src/room/left/top.rs",
            "use crate::room::right::only::Only;",
        ),
        ("src/room/left/bottom.rs", "pub struct Bottom;"),
        ("src/room/right/mod.rs", "pub mod only;"),
        (
            "src/room/right/only.rs",
            "use crate::room::left::bottom::Bottom;\npub struct Only;",
        ),
        ("other/lib.rs", ""),
    ]);
    let uses = modules.uses();
    let circles = circles(&modules.files(), &uses);
    let folders: Vec<&str> = circles.iter().map(|circle| &*circle.folder).collect();
    assert_eq!(folders, ["src/room/"]);
}

#[test]
fn a_glob_of_a_module_is_found_and_of_an_enum_is_none() {
    let modules = program(&[
        ("src/lib.rs", "mod a; mod b;"),
        ("src/a.rs", "pub enum E { X }"),
        (
            "src/b.rs",
            "use crate::a::E::*;\nuse plotters::prelude::*;\nuse crate::a::*;",
        ),
        ("other/lib.rs", ""),
    ]);
    assert_eq!(modules.globs(), ["src/b.rs:3"]);
}

#[test]
fn a_planted_tokio_is_found_in_code() {
    let modules = program(&[
        (
            "src/lib.rs",
            "use std::{fmt, time::Instant};\nuse tokio as runtime;\nfn f() { std::env::var(fmt) }",
        ),
        ("other/lib.rs", ""),
    ]);
    let lines: Vec<usize> = modules
        .named()
        .filter(|(_, path, _)| is_foreign(path))
        .map(|(_, _, line)| line)
        .collect();
    assert_eq!(lines, [1, 2, 3]);
}

#[test]
fn a_planted_tokio_is_found_among_the_crates() {
    let manifest = |dependency: &str| {
        format!("[package]\nname = \"core\"\n[dependencies]\n{dependency} = \"1\"\n")
    };
    let lock = "[[package]]\nname = \"core\"\ndependencies = [\"middle 1.0.0\"]\n\
                [[package]]\nname = \"middle\"\ndependencies = [\"tokio\"]\n\
                [[package]]\nname = \"tokio\"\n[[package]]\nname = \"other\"\n";
    assert_eq!(foreign_crates(&manifest("sqlx"), "package = []"), ["sqlx"]);
    assert_eq!(foreign_crates(&manifest("middle"), lock), ["tokio"]);
    let direct = lock.replace("[\"tokio\"]", "[\"other\"]");
    assert!(foreign_crates(&manifest("middle"), &direct).is_empty());
}
