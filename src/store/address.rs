//! Where the database is: what a user writes, and what the driver wants.

use std::path::{Path, PathBuf};

use super::StoreError;

/// The connection URL of an embedded database, from a path or a `sqlite:` URL.
pub(super) fn connection_url(address: &str) -> Result<String, StoreError> {
    let refuse = |why: &str| {
        Err(StoreError::Address {
            address: address.to_string(),
            why: why.to_string(),
        })
    };
    if address.starts_with("postgres:") || address.starts_with("postgresql:") {
        return refuse("PostgreSQL is not supported yet; give the path of a file");
    }
    let path = match address.strip_prefix("sqlite:") {
        Some(rest) => rest.strip_prefix("//").unwrap_or(rest),
        None => address,
    };
    if path.contains("://") {
        return refuse("only files are supported: give a path, or sqlite:PATH");
    }
    if path.is_empty() || path.contains(":memory:") || path.contains('?') || path.contains('\0') {
        return refuse("give the path of a file; what is accepted must outlive the process");
    }
    let absolute: PathBuf = match std::path::absolute(path) {
        Ok(absolute) => absolute,
        Err(error) => return refuse(&error.to_string()),
    };
    if absolute.is_dir() {
        return refuse("it is a directory; give the path of a file");
    }
    if !absolute.parent().is_some_and(Path::is_dir) {
        return refuse("its directory does not exist");
    }
    let Some(absolute) = absolute.to_str() else {
        return refuse("its path is not UTF-8");
    };
    // what would end the path or be decoded in a URL
    let escaped = absolute.replace('%', "%25").replace('#', "%23");
    Ok(format!("sqlite://{escaped}?mode=rwc"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_urls_mean_the_same_file() {
        let url = connection_url("/tmp/a b#1%.db").unwrap();
        assert_eq!(url, "sqlite:///tmp/a b%231%25.db?mode=rwc");
        assert_eq!(connection_url("sqlite:///tmp/a b#1%.db").unwrap(), url);
        assert_eq!(
            connection_url("trimtab.db").unwrap(),
            connection_url("sqlite:trimtab.db").unwrap()
        );
    }

    #[test]
    fn what_would_lose_jobs_is_refused() {
        for address in [
            ":memory:",
            "sqlite::memory:",
            "",
            "/tmp",
            "/no/such/directory/x.db",
        ] {
            assert!(connection_url(address).is_err(), "{address}");
        }
        let refusal = connection_url("postgres://host/db")
            .unwrap_err()
            .to_string();
        assert!(refusal.contains("not supported yet"), "{refusal}");
    }
}
