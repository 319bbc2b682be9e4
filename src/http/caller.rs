//! Who may ask for what.
//!
//! As soon as the database has had a key, nobody comes in without one; before that, whoever can reach the service may do
//! everything, and only this machine can reach it (see `serve`). What a route needs is decided here, for all routes: one
//! that is added later is closed until somebody says otherwise.

use std::collections::BTreeSet;

use axum::http::Method;
use uuid::Uuid;

use crate::job::HIGHEST_PRIORITY;
use crate::store::{DEFAULT_PROJECT, Scope};

/// Who sent a request.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Caller {
    pub project: String,
    /// Without one nobody needs one.
    pub key: Option<Uuid>,
    pub scopes: BTreeSet<Scope>,
    pub max_priority: i32,
}

impl Caller {
    pub(super) fn without_key() -> Self {
        Self {
            project: DEFAULT_PROJECT.to_string(),
            key: None,
            scopes: Scope::ALL.into(),
            max_priority: HIGHEST_PRIORITY,
        }
    }

    /// How the store knows the sender.
    pub(super) fn submitter(&self) -> String {
        self.key.map(|id| id.to_string()).unwrap_or_default()
    }
}

/// What a request needs; nothing, if it tells nothing of any project.
pub(super) fn needed(method: &Method, path: &str) -> Option<Scope> {
    let under = |root: &str| path == root || path.starts_with(&format!("{root}/"));
    if ["/health", "/docs", "/openapi.json", "/v1/problems"]
        .into_iter()
        .any(under)
    {
        return None;
    }
    if under("/metrics") {
        return Some(Scope::Metrics);
    }
    let is_admins = ["/v1/keys", "/v1/webhooks", "/v1/retention", "/v1/audit"]
        .into_iter()
        .any(under);
    if is_admins || *method == Method::DELETE {
        return Some(Scope::Admin);
    }
    // works out numbers from what is kept, and keeps nothing
    let only_asks = under("/v1/simulations")
        || under("/v1/trims")
        || under("/v1/designs")
        || under("/v1/maneuvers") && path.ends_with("/frequency-responses")
        || under("/v1/jobs")
            && ["/coefficients", "/predictions", "/trim"]
                .iter()
                .any(|end| path.ends_with(end));
    if method.is_safe() || only_asks {
        Some(Scope::Read)
    } else {
        Some(Scope::Submit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_is_closed() {
        let of = |method: Method, path| needed(&method, path);
        assert_eq!(of(Method::GET, "/health/live"), None);
        assert_eq!(of(Method::GET, "/docs"), None);
        assert_eq!(of(Method::GET, "/docsx"), Some(Scope::Read));
        assert_eq!(of(Method::GET, "/nothing/here"), Some(Scope::Read));
        assert_eq!(of(Method::PUT, "/v1/anything"), Some(Scope::Submit));
        assert_eq!(of(Method::GET, "/v1/keys"), Some(Scope::Admin));
        assert_eq!(of(Method::DELETE, "/v1/jobs/x"), Some(Scope::Admin));
    }
}
