//! Other sites that are trusted.

use std::str::FromStr;

use axum::http::{HeaderValue, Uri};

/// Another site whose pages may use the service from a browser: scheme, host and port.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Origin(HeaderValue);

impl Origin {
    pub fn as_str(&self) -> &str {
        self.0.to_str().unwrap_or_default()
    }

    pub(super) fn header(&self) -> HeaderValue {
        self.0.clone()
    }
}

impl FromStr for Origin {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let refuse =
            || format!("'{text}' is not an origin; write it as https://HOST or https://HOST:PORT");
        let uri: Uri = text.parse().map_err(|_| refuse())?;
        let is_web = matches!(uri.scheme_str(), Some("http" | "https"));
        let plain = uri.authority().map(|authority| {
            let scheme = uri.scheme_str().unwrap_or_default();
            format!("{scheme}://{authority}")
        });
        if !is_web || plain.as_deref() != Some(text) || text.contains('@') {
            return Err(refuse());
        }
        HeaderValue::from_str(text).map(Self).map_err(|_| refuse())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_origin_is_scheme_host_and_port() {
        for good in ["https://lab.example", "http://10.0.0.1:8080"] {
            assert_eq!(good.parse::<Origin>().unwrap().as_str(), good);
        }
        for bad in [
            "lab.example",
            "https://lab.example/",
            "ftp://lab.example",
            "https://u@lab",
            "*",
            "null",
        ] {
            assert!(bad.parse::<Origin>().is_err(), "{bad}");
        }
    }
}
