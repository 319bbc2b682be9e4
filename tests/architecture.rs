//! The rooms of the house and the arrows between them, held against the code.

use std::path::{Path, PathBuf};

/// Each room and those it may use. An arrow that is not here is a change of design: make it on purpose.
const ROOMS: [(&str, &[&str]); 13] = [
    ("flight", &[]),
    ("ingest", &["flight"]),
    ("model", &["flight"]),
    ("simulate", &["model", "flight"]),
    ("estimate", &["simulate", "model", "flight"]),
    ("diagnose", &["estimate", "simulate", "model", "flight"]),
    (
        "job",
        &["diagnose", "estimate", "simulate", "model", "flight"],
    ),
    ("store", &["job", "estimate", "model", "flight", "ingest"]),
    ("work", &["store", "job", "estimate", "model", "flight"]),
    (
        "dashboard",
        &["job", "ingest", "diagnose", "estimate", "model", "flight"],
    ),
    ("webhook", &["store", "job"]),
    (
        "http",
        &[
            "webhook",
            "store",
            "job",
            "ingest",
            "diagnose",
            "estimate",
            "model",
            "flight",
            "dashboard",
        ],
    ),
    (
        "cli",
        &[
            "http",
            "webhook",
            "work",
            "store",
            "job",
            "ingest",
            "simulate",
            "diagnose",
            "estimate",
            "model",
            "flight",
            "dashboard",
        ],
    ),
];

/// What is synchronous and deterministic: no server, no database, no clock, no environment, no files.
const CORE: [&str; 8] = [
    "flight",
    "ingest",
    "model",
    "simulate",
    "estimate",
    "diagnose",
    "job",
    "dashboard",
];
const NOT_IN_THE_CORE: [&str; 12] = [
    "tokio",
    "axum",
    "sqlx",
    "reqwest",
    "hyper",
    "tower",
    "tracing",
    "std::time",
    "std::env",
    "std::fs",
    "std::net",
    "rand::rng",
];

fn sources(room: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut pending = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(room)];
    while let Some(directory) = pending.pop() {
        for entry in std::fs::read_dir(&directory).expect("a room") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files
}

/// The code of a file without comments and unit tests.
fn code(file: &Path) -> String {
    let text = std::fs::read_to_string(file).expect("a source file");
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or("");
    code.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n")
}

/// Rooms that a file names: `crate::room`, whether in a `use` or in the middle of a line.
fn rooms_used(code: &str) -> Vec<&str> {
    let names = code.split("crate::").skip(1).flat_map(|rest| {
        // `use crate::{a, b}` names several
        let end = rest.find(';').unwrap_or(rest.len());
        let list = rest.strip_prefix('{').map_or(&rest[..0], |_| &rest[1..end]);
        let word = |text: &'_ str| {
            text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
                .unwrap_or(text.len())
        };
        let first = &rest[..word(rest)];
        let listed = list.split(',').map(move |item| {
            let item = item.trim();
            &item[..word(item)]
        });
        std::iter::once(first).chain(listed)
    });
    names
        .filter(|name| ROOMS.iter().any(|(room, _)| room == name))
        .collect()
}

#[test]
fn every_directory_is_a_room() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in std::fs::read_dir(source).expect("src") {
        let entry = entry.expect("an entry");
        if entry.path().is_dir() {
            let name = entry.file_name().into_string().expect("a name");
            assert!(
                ROOMS.iter().any(|(room, _)| *room == name),
                "src/{name} is not in the map of rooms"
            );
        }
    }
}

#[test]
fn arrows_go_one_way() {
    let mut arrows = 0;
    for (room, may_use) in ROOMS {
        for file in sources(room) {
            for used in rooms_used(&code(&file)) {
                arrows += 1;
                assert!(
                    used == room || may_use.contains(&used),
                    "{}: `{room}` must not use `{used}`",
                    file.display()
                );
            }
        }
    }
    assert!(
        arrows > 100,
        "only {arrows} arrows were found: the test does not see the code"
    );
}

#[test]
fn the_core_is_synchronous_and_deterministic() {
    for room in CORE {
        for file in sources(room) {
            for line in code(&file).lines() {
                for word in NOT_IN_THE_CORE {
                    let used = line.contains(&format!("{word}::"))
                        || line.contains(&format!("use {word}"));
                    assert!(
                        !used,
                        "{}: `{word}` does not belong in the core: {line}",
                        file.display()
                    );
                }
            }
        }
    }
}

#[test]
fn files_are_of_a_size_to_be_read() {
    for (room, _) in ROOMS {
        for file in sources(room) {
            let lines = std::fs::read_to_string(&file)
                .expect("a source file")
                .lines()
                .count();
            assert!(lines <= 400, "{} has {lines} lines", file.display());
        }
    }
}
