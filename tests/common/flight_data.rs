//! Recorded flight data for tests. The files are not part of the project: their copyright is the
//! publisher's. `TRIMTAB_FLIGHT_DATA` names their directory, else they are looked for beside the
//! project, in `../shared/data/flight`.

use std::path::PathBuf;

use super::repository;

/// The directory, or `None` after saying loudly that the test is skipped.
///
/// # Panics
/// If there are no files though `TRIMTAB_REQUIRE_FLIGHT_DATA` demands them.
pub(crate) fn directory(test: &str) -> Option<PathBuf> {
    let directory = std::env::var_os("TRIMTAB_FLIGHT_DATA")
        .map_or_else(|| repository::path("../shared/data/flight"), PathBuf::from);
    if directory.join("attas_elv1.csv").is_file() {
        return Some(directory);
    }
    let place = directory.display();
    assert!(
        std::env::var_os("TRIMTAB_REQUIRE_FLIGHT_DATA").is_none(),
        "no flight data in {place}, and TRIMTAB_REQUIRE_FLIGHT_DATA is set"
    );
    eprintln!("SKIPPED {test}: no flight data in {place}; set TRIMTAB_FLIGHT_DATA");
    None
}
