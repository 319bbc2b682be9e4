//! What the core must do without: it is synchronous and deterministic.

use std::collections::BTreeSet;

use toml::Table;

/// No server, no database, no clock, no environment, no files.
const FOREIGN_PATHS: [&str; 12] = [
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
const FOREIGN_CRATES: [&str; 7] = [
    "tokio", "axum", "sqlx", "reqwest", "hyper", "tower", "tracing",
];

/// Whether a path leads to what does not belong in the core.
pub(super) fn is_foreign(path: &[String]) -> bool {
    let path = path.join("::") + "::";
    FOREIGN_PATHS
        .iter()
        .any(|foreign| path.starts_with(&format!("{foreign}::")))
}

/// Crates that do not belong in the core, of those that its manifest asks for and those that come with them.
pub(super) fn foreign_crates(manifest: &str, lock: &str) -> Vec<&'static str> {
    let manifest: Table = manifest.parse().expect("a manifest");
    let lock: Table = lock.parse().expect("a lock file");
    let own = manifest["package"]["name"].as_str().expect("a name");
    let asked = manifest["dependencies"].as_table().expect("a table");
    let mut pending: Vec<&str> = asked.keys().map(String::as_str).chain([own]).collect();
    let mut needed = BTreeSet::new();
    while let Some(name) = pending.pop() {
        if needed.insert(name) {
            pending.extend(dependencies(&lock, name));
        }
    }
    FOREIGN_CRATES
        .into_iter()
        .filter(|name| needed.contains(name))
        .collect()
}

/// Of all versions of a package.
fn dependencies<'a>(lock: &'a Table, name: &str) -> Vec<&'a str> {
    let packages = lock["package"].as_array().expect("packages").iter();
    packages
        .filter(|package| package["name"].as_str() == Some(name))
        .filter_map(|package| package.get("dependencies")?.as_array())
        .flatten()
        // with its version where there are several
        .filter_map(|dependency| dependency.as_str()?.split(' ').next())
        .collect()
}
