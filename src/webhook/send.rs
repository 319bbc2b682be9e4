//! One attempt to deliver one message.

use std::error::Error;
use std::sync::Arc;
use std::time::Duration;

use jiff::Timestamp;
use reqwest::{Client, Response, StatusCode, redirect};
use serde_json::json;

use super::address::Allowed;
use super::sign::signature;
use crate::store::{Attempt, Delivery};

/// A receiver that has not answered by then has not heard.
const TIMEOUT: Duration = Duration::from_secs(15);

/// The pauses between attempts; behind the last a message is given up.
const PAUSES: [Duration; 7] = [
    Duration::from_secs(5),
    Duration::from_secs(5 * 60),
    Duration::from_secs(30 * 60),
    Duration::from_secs(2 * 3600),
    Duration::from_secs(5 * 3600),
    Duration::from_secs(10 * 3600),
    Duration::from_secs(14 * 3600),
];

#[derive(Clone)]
pub(super) struct Sender {
    allowed: Allowed,
    http: Result<Client, String>,
}

impl Sender {
    pub(super) fn new(allowed: Allowed) -> Self {
        let client = |tls: bool| {
            let builder = Client::builder()
                .dns_resolver(Arc::new(allowed.clone()))
                .redirect(redirect::Policy::none())
                .no_proxy()
                .timeout(TIMEOUT)
                .user_agent(concat!("trimtab/", env!("CARGO_PKG_VERSION")));
            let builder = if tls {
                builder
            } else {
                builder.tls_certs_only([])
            };
            builder.build()
        };
        // a small image may have no certificates: plain http still goes to hosts that are allowed by name
        let http = client(true).or_else(|error| {
            tracing::warn!(%error, "there are no certificates: webhooks cannot be sent by https");
            client(false)
        });
        Self {
            allowed,
            http: http.map_err(|error| error.to_string()),
        }
    }

    pub(super) async fn send(&self, delivery: &Delivery, now: Timestamp) -> Attempt {
        match self.try_send(delivery, now.as_second()).await {
            Ok(response) => told(delivery, &response),
            Err(fault) => failed(delivery, None, fault),
        }
    }

    async fn try_send(&self, delivery: &Delivery, now: i64) -> Result<Response, String> {
        // what was allowed when the webhook was made may be so no more
        let url = self.allowed.check(&delivery.url);
        let url = url.map_err(|refused| refused.to_string())?;
        let http = self.http.as_ref().map_err(Clone::clone)?;
        let body = message(delivery);
        let signatures: Vec<String> = (delivery.secrets.iter())
            .filter_map(|secret| signature(secret, delivery.id, now, &body))
            .collect();
        let request = http
            .post(url)
            .header("content-type", "application/json")
            .header("webhook-id", delivery.id.to_string())
            .header("webhook-timestamp", now)
            .header("webhook-signature", signatures.join(" "))
            .body(body);
        request.send().await.map_err(|error| cause(&error))
    }
}

/// Thin: who is told asks for what it may see.
fn message(delivery: &Delivery) -> String {
    let data = if delivery.job.is_empty() {
        json!({})
    } else {
        json!({"job": delivery.job, "links": {"job": format!("/v1/jobs/{}", delivery.job)}})
    };
    json!({"type": delivery.event, "timestamp": delivery.created, "data": data}).to_string()
}

fn told(delivery: &Delivery, response: &Response) -> Attempt {
    let status = response.status();
    let code = status.as_u16();
    if status.is_success() {
        Attempt::Arrived(code)
    } else if status == StatusCode::GONE {
        Attempt::Gone(code)
    } else if status.is_redirection() {
        let fault = "it redirects, which is not followed; give the URL where it leads";
        failed(delivery, Some(code), fault.to_string())
    } else {
        failed(delivery, Some(code), format!("it answers {status}"))
    }
}

fn failed(delivery: &Delivery, status: Option<u16>, fault: String) -> Attempt {
    let pause = usize::try_from(delivery.attempts.saturating_sub(1)).ok();
    let pause = pause.and_then(|number| PAUSES.get(number).copied());
    // up to a fifth more, each its own: receivers that were down are not met by all at once
    let jitter = 1.0 + (delivery.id.as_u128() % 1000) as f64 / 5000.0;
    Attempt::Failed {
        status,
        fault,
        again: pause.map(|pause| pause.mul_f64(jitter)),
    }
}

/// The innermost cause says what happened; the URL is known to who reads it.
fn cause(error: &reqwest::Error) -> String {
    let mut cause: &dyn Error = error;
    while let Some(inner) = cause.source() {
        cause = inner;
    }
    if error.is_timeout() {
        return format!("it did not answer within {} s", TIMEOUT.as_secs());
    }
    cause.to_string()
}
