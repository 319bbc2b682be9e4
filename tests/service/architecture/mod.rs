//! The rooms of the house and the arrows between them and between their files, held against the code.

mod circles;
mod core;
mod modules;
mod planted;
mod tokens;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use modules::Modules;

/// The core is a crate of its own within the folder of the service.
const CRATES: [(&str, &str); 2] = [
    ("trimtab", "src/lib.rs"),
    ("trimtab_core", "src/core/lib.rs"),
];

/// Each room and those it may use. An arrow that is not here is a change of design: make it on purpose.
const ROOMS: [(&str, &[&str]); 20] = [
    ("stop", &[]),
    ("flight", &["stop"]),
    ("spectral", &["stop"]),
    ("structure", &["flight", "stop"]),
    ("response", &["spectral", "flight"]),
    ("ingest", &["flight"]),
    ("model", &["flight", "stop"]),
    ("simulate", &["model", "flight", "stop"]),
    (
        "estimate",
        &["simulate", "spectral", "model", "flight", "stop"],
    ),
    (
        "diagnose",
        &["estimate", "simulate", "model", "flight", "stop"],
    ),
    (
        "recursive",
        &["estimate", "simulate", "spectral", "model", "flight"],
    ),
    ("dynamics", &["estimate", "simulate", "model", "flight"]),
    (
        "design",
        &["dynamics", "estimate", "simulate", "model", "flight"],
    ),
    (
        "job",
        &[
            "design",
            "diagnose",
            "dynamics",
            "structure",
            "estimate",
            "simulate",
            "model",
            "flight",
            "stop",
        ],
    ),
    ("store", &["job", "estimate", "model", "flight", "ingest"]),
    (
        "work",
        &["store", "job", "estimate", "model", "flight", "stop"],
    ),
    (
        "dashboard",
        &[
            "job", "ingest", "diagnose", "dynamics", "estimate", "model", "flight",
        ],
    ),
    ("webhook", &["store", "job"]),
    (
        "http",
        &[
            "webhook",
            "store",
            "job",
            "ingest",
            "design",
            "diagnose",
            "dynamics",
            "structure",
            "response",
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
            "recursive",
            "design",
            "diagnose",
            "dynamics",
            "structure",
            "response",
            "estimate",
            "model",
            "flight",
            "dashboard",
        ],
    ),
];

/// Rooms of the service that are as synchronous and deterministic as the core.
const LIKE_THE_CORE: [&str; 1] = ["dashboard"];

/// The text of every file of both crates, by its path from the root of the repository.
fn sources() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = BTreeMap::new();
    let mut pending = vec![root.join("src")];
    while let Some(folder) = pending.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).expect("a source file");
                let name = path.strip_prefix(root).expect("a file of the repository");
                files.insert(name.to_string_lossy().replace('\\', "/"), text);
            }
        }
    }
    files
}

fn modules() -> Modules {
    Modules::read(&sources(), &CRATES)
}

fn is_of_the_core(file: &str) -> bool {
    file.starts_with("src/core/")
}

/// The folder of the first floor in which a file is.
fn room(file: &str) -> Option<&str> {
    let inside = file
        .strip_prefix("src/core/")
        .or_else(|| file.strip_prefix("src/"))?;
    inside.split_once('/').map(|(room, _)| room)
}

fn fail_if_any(faults: &[String]) {
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn every_folder_is_a_room() {
    let sources = sources();
    let found: BTreeSet<&str> = sources.keys().filter_map(|file| room(file)).collect();
    let known: BTreeSet<&str> = ROOMS.iter().map(|(room, _)| *room).collect();
    assert_eq!(found, known, "the folders of src, and the map of rooms");
}

#[test]
fn arrows_between_rooms_go_one_way() {
    let uses = modules().uses();
    let mut faults = Vec::new();
    for used in &uses {
        let (Some(from), Some(to)) = (room(&used.from), room(&used.to)) else {
            continue;
        };
        let (_, may_use) = ROOMS
            .iter()
            .find(|(room, _)| *room == from)
            .expect("a room");
        if from != to && !may_use.contains(&to) {
            faults.push(format!("`{from}` must not use `{to}`: {used}"));
        }
    }
    fail_if_any(&faults);
    let arrows = uses.len();
    assert!(
        arrows > 2000,
        "only {arrows} arrows were found: the test does not see the code"
    );
}

/// Files that need each other are one file in several pieces: none can be read, or changed, without the others.
#[test]
fn no_files_and_no_folders_use_each_other_in_a_circle() {
    let modules = modules();
    let uses = modules.uses();
    let circles = circles::circles(&modules.files(), &uses);
    let told: Vec<String> = circles.iter().map(ToString::to_string).collect();
    fail_if_any(&told);
}

#[test]
fn nothing_is_imported_without_its_name() {
    fail_if_any(&modules().globs());
}

#[test]
fn the_core_is_synchronous_and_deterministic() {
    let modules = modules();
    let bound = |file: &str| {
        is_of_the_core(file) || room(file).is_some_and(|room| LIKE_THE_CORE.contains(&room))
    };
    let faults: Vec<String> = modules
        .named()
        .filter(|(file, path, _)| bound(file) && core::is_foreign(path))
        .map(|(file, path, line)| {
            format!("{file}:{line}: `{}` does not belong here", path.join("::"))
        })
        .collect();
    fail_if_any(&faults);
}

/// What a thread of its own does ends with the rest only if it heeds the same flag: `stop::shared`.
#[test]
fn work_that_is_shared_out_heeds_the_wish_to_stop() {
    const SHARES_OUT: [&str; 5] = [
        "par_iter",
        "par_chunks",
        "par_bridge",
        ".spawn(",
        "rayon::join",
    ];
    let faults: Vec<String> = (sources().iter())
        .filter(|(file, _)| is_of_the_core(file))
        .filter_map(|(file, text)| {
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            let places: usize = SHARES_OUT.map(|word| code.matches(word).count()).iter().sum();
            let heeding = code.matches("shared(").count();
            (places > heeding).then(|| {
                format!("{file}: work is shared out in {places} places, and {heeding} take the flag along")
            })
        })
        .collect();
    fail_if_any(&faults);
}

#[test]
fn the_core_brings_no_server_and_no_database() {
    let read = |file: &str| {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
        std::fs::read_to_string(file).expect("a file of the repository")
    };
    let foreign = core::foreign_crates(&read("src/core/Cargo.toml"), &read("Cargo.lock"));
    assert!(foreign.is_empty(), "in the core: {foreign:?}");
}

/// Schemas of the API document are known by name: of two types of one name the one that is met last takes the other's place.
#[test]
fn no_two_schemas_have_one_name() {
    let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (file, text) in sources() {
        for name in schemas(&text) {
            files.entry(name).or_default().push(file.clone());
        }
    }
    assert!(files.len() > 100, "{} schemas", files.len());
    let twice = files.into_iter().filter(|(_, files)| files.len() > 1);
    let faults: Vec<String> = twice
        .map(|(name, files)| format!("schema {name}: in {}; rename one", files.join(" and ")))
        .collect();
    fail_if_any(&faults);
    let planted = "#[derive(\n    Debug,\n    ToSchema,\n)]\n/// A struct.\npub struct Planted {}\n#[derive(Debug)]\nenum Other {}";
    assert_eq!(schemas(planted), ["Planted"]);
}

/// Types of a file that derive `ToSchema`.
fn schemas(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    for part in text.split("#[derive(").skip(1) {
        let (derived, rest) = part.split_once(")]").unwrap_or_default();
        if !derived
            .split([',', ' ', '\n', ':'])
            .any(|word| word == "ToSchema")
        {
            continue;
        }
        let lines = rest.lines().map(str::trim_start);
        let mut declared = lines.filter_map(|line| {
            let words = line
                .split_once("struct ")
                .or_else(|| line.split_once("enum "));
            let (_, name) =
                words.filter(|(before, _)| before.is_empty() || before.starts_with("pub"))?;
            name.split([' ', '<', '(', ';', '{']).next()
        });
        names.extend(declared.next().map(String::from));
    }
    names
}

#[test]
fn files_are_of_a_size_to_be_read() {
    let too_long: Vec<String> = sources()
        .iter()
        .map(|(file, text)| (file, text.lines().count()))
        .filter(|(_, lines)| *lines > 400)
        .map(|(file, lines)| format!("{file} has {lines} lines"))
        .collect();
    fail_if_any(&too_long);
}
