//! Pictures written to a directory.

use std::path::Path;

use super::Failure;

/// Writes SVGs under their names, in a directory that is made where it is not.
pub(super) fn write(
    directory: &Path,
    figures: impl IntoIterator<Item = (String, Result<String, String>)>,
) -> Result<(), Failure> {
    let unwritten = |path: &Path, error: std::io::Error| {
        Failure::new(format!(
            "{}: {error}; name a directory for --figures that can be written to",
            path.display()
        ))
    };
    std::fs::create_dir_all(directory).map_err(|error| unwritten(directory, error))?;
    for (name, svg) in figures {
        let path = directory.join(name);
        std::fs::write(&path, svg.map_err(Failure::new)?)
            .map_err(|error| unwritten(&path, error))?;
    }
    Ok(())
}
