//! Signatures: that a message is Trimtab's, is whole, and is not an old one sent again.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use hmac::{Hmac, KeyInit, Mac};
use sha2::Sha256;
use uuid::Uuid;

const PREFIX: &str = "whsec_";

/// A secret of 256 random bits, as the specification writes it.
///
/// # Errors
/// The machine gives no random numbers.
pub fn new_secret() -> Result<String, getrandom::Error> {
    let mut secret = [0; 32];
    getrandom::fill(&mut secret)?;
    Ok(format!("{PREFIX}{}", BASE64_STANDARD.encode(secret)))
}

/// `v1,` and the HMAC-SHA256 of `id.timestamp.body` in base64. A secret that is none signs nothing.
pub fn signature(secret: &str, id: Uuid, timestamp: i64, body: &str) -> Option<String> {
    let secret = BASE64_STANDARD.decode(secret.strip_prefix(PREFIX)?).ok()?;
    let mut mac = Hmac::<Sha256>::new_from_slice(&secret).ok()?;
    mac.update(format!("{id}.{timestamp}.{body}").as_bytes());
    Some(format!(
        "v1,{}",
        BASE64_STANDARD.encode(mac.finalize().into_bytes())
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against an independent computation: `openssl dgst -sha256 -mac HMAC` of the same text under the same key.
    #[test]
    fn a_signature_is_what_others_compute() {
        let secret = "whsec_MDEyMzQ1Njc4OTAxMjM0NTY3ODkwMTIzNDU2Nzg5MDE=";
        let id = Uuid::parse_str("01950000-0000-7000-8000-000000000001").unwrap();
        let text = signature(secret, id, 1_700_000_000, "{\"type\":\"x\"}").unwrap();
        assert_eq!(text, "v1,OUxvwGOjRFgtwmOcuMo54Vg6Vz9PZQDteVTY6V+0QEE=");
        assert_eq!(signature("secret", id, 0, ""), None);
        assert_ne!(new_secret().unwrap(), new_secret().unwrap());
    }
}
