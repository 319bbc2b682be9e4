//! Where the database is: what a user writes, and what the driver wants.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use sqlx::postgres::PgConnectOptions;

use super::StoreError;
use super::engine::Engine;

/// The engine and the connection URL, from a path, a `sqlite:` URL or a `postgres:` URL.
pub(super) fn connection(address: &str) -> Result<(Engine, String), StoreError> {
    let refuse = |why: &str| {
        Err(StoreError::Address {
            address: without_password(address),
            why: why.to_string(),
        })
    };
    if is_postgres(address) {
        // what the driver says of a URL that it cannot read has no remedy in it
        return match PgConnectOptions::from_str(address) {
            Ok(_) => Ok((Engine::Postgres, address.to_string())),
            Err(error) => refuse(&format!(
                "{error}; give it as postgres://USER:PASSWORD@HOST:PORT/DATABASE"
            )),
        };
    }
    let path = path(address);
    if path.contains("://") {
        return refuse(
            "only files (a path, or sqlite:PATH) and PostgreSQL (postgres://...) are supported",
        );
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
    Ok((Engine::Sqlite, format!("sqlite://{escaped}?mode=rwc")))
}

/// Whether the address is that of a file that is not there yet.
#[must_use]
pub fn is_missing(address: &str) -> bool {
    !is_postgres(address) && !Path::new(path(address)).exists()
}

pub(super) fn path(address: &str) -> &str {
    let path = address.strip_prefix("sqlite:");
    path.map_or(address, |rest| rest.strip_prefix("//").unwrap_or(rest))
}

fn is_postgres(address: &str) -> bool {
    address.starts_with("postgres:") || address.starts_with("postgresql:")
}

/// An address as it may be shown and logged, however it is misspelt: nothing between a ':' and an '@' is shown, nor
/// parameters.
#[must_use]
pub fn without_password(address: &str) -> String {
    let (scheme, rest) = address.split_once("://").unwrap_or(("", address));
    let begin = match scheme {
        "" => String::new(),
        scheme => format!("{scheme}://"),
    };
    let (rest, parameters) = rest.split_once('?').unwrap_or((rest, ""));
    // a password with a '?' in it, most likely, or parameters with an '@': what is what cannot be told
    if parameters.contains('@') {
        return format!("{begin}…");
    }
    let Some((user, host)) = rest.rsplit_once('@') else {
        return format!("{begin}{rest}");
    };
    match user.split_once(':') {
        // an address without "//", or with too much before it
        Some((user, _)) if scheme.is_empty() || user.contains('/') => {
            format!("{begin}{user}:…@{host}")
        }
        Some((user, _)) => format!("{begin}{user}@{host}"),
        None => format!("{begin}{rest}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_urls_mean_the_same_file() {
        let file = |address| connection(address).unwrap();
        let (engine, url) = file("/tmp/a b#1%.db");
        assert_eq!(engine, Engine::Sqlite);
        assert_eq!(url, "sqlite:///tmp/a b%231%25.db?mode=rwc");
        assert_eq!(file("sqlite:///tmp/a b#1%.db").1, url);
        assert_eq!(file("trimtab.db"), file("sqlite:trimtab.db"));
    }

    #[test]
    fn what_would_lose_jobs_is_refused() {
        for address in [
            ":memory:",
            "sqlite::memory:",
            "",
            "/tmp",
            "/no/such/directory/x.db",
            "mysql://host/db",
            "postgres://host:port/db",
        ] {
            assert!(connection(address).is_err(), "{address}");
        }
    }

    #[test]
    fn a_password_is_not_shown() {
        let address = "postgres://lab:s3cr@t@host:5432/trimtab?password=s3cret&sslmode=require";
        assert_eq!(connection(address).unwrap().0, Engine::Postgres);
        assert_eq!(
            without_password(address),
            "postgres://lab@host:5432/trimtab"
        );
        let refusal = connection("postgres://lab:s3cret@host:nonsense/x").unwrap_err();
        assert!(!refusal.to_string().contains("s3cret"), "{refusal}");
        assert_eq!(without_password("/data/a@b.db"), "/data/a@b.db");
        assert_eq!(
            without_password("postgres://host/db?user=lab"),
            "postgres://host/db"
        );
    }

    /// As an address is mistyped: each of these was shown whole.
    #[test]
    fn a_misspelt_address_does_not_show_its_password_either() {
        for address in [
            "postgre://lab:s3cret@host/trimtab",
            "Postgres://lab:s3cret@host/trimtab",
            "postgres//lab:s3cret@host/trimtab",
            "postgres:/lab:s3cret@host/trimtab",
            "postgres:lab:s3cret@host/trimtab",
            "lab:s3cret@host/trimtab",
            "mysql://host/trimtab?user=lab&password=s3cret",
            "postgres://lab:a?s3cret@host/trimtab",
            "postgres://lab:s3cret@a?b@host/trimtab",
            "postgres://host/trimtab?password=a@s3cret",
            "sqlite:lab:s3cret@host",
        ] {
            let shown = without_password(address);
            assert!(!shown.contains("s3cret"), "{shown}");
            if let Err(refusal) = connection(address) {
                assert!(!refusal.to_string().contains("s3cret"), "{refusal}");
            }
        }
    }
}
