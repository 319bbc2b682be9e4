//! HTTP as the service speaks it to others.

use reqwest::ClientBuilder;
use rustls::crypto::ring;

/// A client to be set up, whose TLS is computed by ring: aws-lc, which reqwest would take by itself, is a minute of C.
pub fn http_client() -> ClientBuilder {
    // it fails where it was done before
    let _ = ring::default_provider().install_default();
    ClientBuilder::new()
}
