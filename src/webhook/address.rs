//! Where messages may go: to the world, and not to the machines beside this one, unless they were allowed by name.
//!
//! Whoever may set up a webhook could otherwise have the service speak to what only it can reach. The address is looked at
//! where the connection is made, by the resolver itself: a name that means something else a moment later (DNS rebinding)
//! gains nothing.

use std::collections::BTreeSet;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::sync::Arc;

use reqwest::Url;
use reqwest::dns::{Addrs, Name, Resolve, Resolving};

/// Hosts that may be spoken to although they are on this machine or its network, and without TLS.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Allowed(Arc<BTreeSet<String>>);

#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum Refused {
    #[error("'{0}' is not a URL; write it as https://HOST/PATH")]
    NoUrl(String),
    #[error("'{0}' has a user or password in it; what signs a message is its secret")]
    Credentials(String),
    #[error("hosts that are not allowed by name are spoken to by https only (--webhook-allow)")]
    NotHttps,
    #[error(
        "{0} is on this machine or its network; messages are sent there only if the host is allowed by name (--webhook-allow)"
    )]
    NotPublic(String),
}

impl Allowed {
    pub fn new(hosts: impl IntoIterator<Item = String>) -> Self {
        let hosts = hosts.into_iter().map(|host| host.to_ascii_lowercase());
        Self(Arc::new(hosts.collect()))
    }

    fn has(&self, host: &str) -> bool {
        self.0
            .contains(&host.trim_matches(['[', ']']).to_ascii_lowercase())
    }

    /// Whether a message may be sent to `url`, as far as can be told without looking its name up.
    ///
    /// # Errors
    /// Why it may not.
    pub fn check(&self, url: &str) -> Result<Url, Refused> {
        let parsed = Url::parse(url).map_err(|_| Refused::NoUrl(url.to_string()))?;
        let Some(host) = parsed.host_str().map(ToString::to_string) else {
            return Err(Refused::NoUrl(url.to_string()));
        };
        if !["http", "https"].contains(&parsed.scheme()) {
            return Err(Refused::NoUrl(url.to_string()));
        }
        if !parsed.username().is_empty() || parsed.password().is_some() {
            return Err(Refused::Credentials(host));
        }
        if self.has(&host) {
            return Ok(parsed);
        }
        if parsed.scheme() != "https" {
            return Err(Refused::NotHttps);
        }
        let is_inside = match host.trim_matches(['[', ']']).parse::<IpAddr>() {
            Ok(address) => !is_public(address),
            Err(_) => host.eq_ignore_ascii_case("localhost") || host.ends_with(".localhost"),
        };
        if is_inside {
            return Err(Refused::NotPublic(host));
        }
        Ok(parsed)
    }
}

/// Looks names up, and finds only addresses that may be spoken to.
impl Resolve for Allowed {
    fn resolve(&self, name: Name) -> Resolving {
        let is_allowed = self.has(name.as_str());
        let name = name.as_str().to_string();
        Box::pin(async move {
            let found = tokio::net::lookup_host((name.as_str(), 0)).await?;
            let found: Vec<SocketAddr> = found
                .filter(|address| is_allowed || is_public(address.ip()))
                .collect();
            if found.is_empty() {
                return Err(Refused::NotPublic(name).into());
            }
            Ok::<Addrs, _>(Box::new(found.into_iter()))
        })
    }
}

/// Whether an address is one of the world's.
fn is_public(address: IpAddr) -> bool {
    match address {
        IpAddr::V4(address) => is_public_v4(address),
        IpAddr::V6(address) => is_public_v6(address),
    }
}

/// By the registry of special-purpose addresses (RFC 6890 and its successors).
fn is_public_v4(address: Ipv4Addr) -> bool {
    let [a, b, c, _] = address.octets();
    !(address.is_private()
        || address.is_loopback()
        || address.is_link_local()
        || address.is_multicast()
        || address.is_documentation()
        || a == 0
        || a >= 240
        || (a == 100 && (64..128).contains(&b))
        || (a == 192 && b == 0 && c == 0)
        || (a == 192 && b == 88 && c == 99)
        || (a == 198 && (18..20).contains(&b)))
}

/// Global unicast only, and what has an IPv4 address inside goes by that.
fn is_public_v6(address: Ipv6Addr) -> bool {
    if let Some(inner) = address.to_ipv4_mapped() {
        return is_public_v4(inner);
    }
    let segments = address.segments();
    let inner = |high: u16, low: u16| {
        let [[a, b], [c, d]] = [high, low].map(u16::to_be_bytes);
        is_public_v4(Ipv4Addr::new(a, b, c, d))
    };
    match segments {
        // NAT64, 6to4
        [0x64, 0xff9b, 0, 0, 0, 0, high, low] => inner(high, low),
        [0x2002, high, low, ..] => inner(high, low),
        // Teredo and other protocol assignments, documentation
        [0x2001, second, ..] if second < 0x200 => false,
        [0x2001, 0xdb8, ..] => false,
        [0x3fff, second, ..] if second < 0x1000 => false,
        [first, ..] => (0x2000..0x4000).contains(&first),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_this_network_are_not_public_however_they_are_written() {
        for inside in [
            "127.0.0.1",
            "10.1.2.3",
            "172.16.0.1",
            "172.31.255.255",
            "192.168.1.1",
            "169.254.169.254",
            "100.64.0.1",
            "0.0.0.0",
            "0.1.2.3",
            "224.0.0.1",
            "255.255.255.255",
            "192.0.0.1",
            "198.18.0.1",
            "203.0.113.1",
            "::",
            "::1",
            "::127.0.0.1",
            "::ffff:127.0.0.1",
            "::ffff:10.0.0.1",
            "64:ff9b::a00:1",
            "64:ff9b:1::1",
            "2002:7f00:1::1",
            "2002:c0a8:101::1",
            "2001:0:4136:e378:8000:63bf:3fff:fdd2",
            "2001:db8::1",
            "fe80::1",
            "fc00::1",
            "fd12:3456::1",
            "fec0::1",
            "ff02::1",
            "100::1",
        ] {
            assert!(!is_public(inside.parse().unwrap()), "{inside}");
        }
        for outside in [
            "8.8.8.8",
            "1.1.1.1",
            "172.32.0.1",
            "100.128.0.1",
            "2606:4700::1111",
            "::ffff:8.8.8.8",
            "64:ff9b::808:808",
            "2002:808:808::1",
            "2a00::1",
        ] {
            assert!(is_public(outside.parse().unwrap()), "{outside}");
        }
    }

    /// The address is looked at when the connection is made: what a name meant before does not count.
    #[tokio::test]
    async fn a_name_that_leads_inside_is_not_found() {
        let name = || "localhost".parse::<Name>().unwrap();
        let refused = Allowed::default().resolve(name()).await;
        let Err(why) = refused else {
            panic!("localhost is found")
        };
        assert!(why.to_string().contains("on this machine"), "{why}");
        let allowed = Allowed::new(["LocalHost".to_string()]);
        assert!(allowed.resolve(name()).await.is_ok());
    }

    #[test]
    fn a_url_is_refused_for_what_can_be_seen_of_it() {
        let allowed = Allowed::new(["Hooks.lab".to_string(), "10.0.0.7".to_string()]);
        for good in [
            "https://example.org/hook",
            "http://hooks.lab:8080/x",
            "http://10.0.0.7/",
            "https://8.8.8.8/",
        ] {
            assert!(allowed.check(good).is_ok(), "{good}");
        }
        for bad in [
            "example.org",
            "ftp://example.org",
            "file:///etc/passwd",
            "http://example.org",
            "https://user:pw@example.org",
            "https://127.0.0.1/",
            "https://127.1/",
            "https://2130706433/",
            "https://0x7f.1/",
            "https://0177.0.0.1/",
            "https://[::1]/",
            "https://[::ffff:10.0.0.1]/",
            "https://localhost/",
            "https://a.localhost/",
            "https://10.0.0.8/",
            "https://169.254.169.254/latest/meta-data",
        ] {
            assert!(allowed.check(bad).is_err(), "{bad}");
        }
    }
}
