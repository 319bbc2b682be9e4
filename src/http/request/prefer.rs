//! `Prefer: wait=N` (RFC 7240): the answer waits until a job is over, if it soon is.

use std::time::Duration;

use axum::http::{HeaderMap, HeaderName, HeaderValue};
use tokio::time::Instant;

use crate::http::problem::Problem;
use crate::http::service::Service;
use crate::store::{JobRecord, Signal};

pub(crate) const PREFER: HeaderName = HeaderName::from_static("prefer");
pub(crate) const APPLIED: HeaderName = HeaderName::from_static("preference-applied");

/// Nobody waits longer than this; proxies hang up after about as long.
const LONGEST: Duration = Duration::from_secs(60);

/// How often to look without being signalled.
const LOOK_AGAIN: Duration = Duration::from_secs(1);

/// How long the client would wait. A preference that cannot be read is none, as the RFC has it.
pub(crate) fn wait(headers: &HeaderMap) -> Option<Duration> {
    let preferences = headers.get_all(PREFER).into_iter();
    let seconds = preferences
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .filter_map(|preference| preference.trim().split_once('='))
        .find(|(name, _)| name.trim().eq_ignore_ascii_case("wait"))
        .and_then(|(_, seconds)| seconds.trim().parse().ok())?;
    Some(Duration::from_secs(seconds).min(LONGEST))
}

/// Says that the wait was granted, if not always to its end.
pub(crate) fn applied(wait: Duration) -> (HeaderName, HeaderValue) {
    let text = format!("wait={}", wait.as_secs());
    let value = HeaderValue::from_str(&text).unwrap_or(HeaderValue::from_static("wait"));
    (APPLIED, value)
}

/// The job when it is over, or when the time is.
pub(crate) async fn until_over(
    service: &Service,
    mut job: JobRecord,
    wait: Duration,
) -> Result<JobRecord, Problem> {
    let deadline = Instant::now() + wait;
    // before looking
    let mut signals = service.store.listen();
    loop {
        job = service.store.job(job.id).await?.unwrap_or(job);
        let left = deadline.saturating_duration_since(Instant::now());
        if job.status.is_over() || left.is_zero() {
            return Ok(job);
        }
        tokio::select! {
            () = signals.wait_for(Signal::Log(job.id), left.min(LOOK_AGAIN)) => {}
            () = service.shutdown.cancelled() => return Ok(job),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_read_is_no_preference() {
        let of = |value: &str| {
            let headers = [(PREFER, HeaderValue::from_str(value).unwrap())];
            wait(&headers.into_iter().collect())
        };
        assert_eq!(of("wait=5"), Some(Duration::from_secs(5)));
        assert_eq!(of("respond-async, Wait = 5"), Some(Duration::from_secs(5)));
        assert_eq!(of("wait=100000"), Some(LONGEST));
        assert_eq!(of("wait=soon"), None);
        assert_eq!(of("handling=lenient"), None);
        assert_eq!(wait(&HeaderMap::new()), None);
    }
}
