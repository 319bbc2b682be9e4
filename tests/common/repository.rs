//! Files of the repository, from whichever of its packages a test is run.

use std::path::{Path, PathBuf};

/// # Panics
/// The package is not in the repository.
pub(crate) fn path(inside: &str) -> PathBuf {
    let mut folders = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let root = folders.find(|folder| folder.join("Cargo.lock").is_file());
    root.expect("the workspace").join(inside)
}
