//! How often a key may ask.

use std::num::NonZeroU32;
use std::sync::Arc;

use axum::http::{HeaderValue, header};
use governor::clock::{Clock, DefaultClock};
use governor::{DefaultKeyedRateLimiter, Quota};
use uuid::Uuid;

use super::code::Code;
use super::problem::Problem;

/// Counts the requests of each key; those without keys are not counted.
#[derive(Clone)]
pub(super) struct Rates {
    per_second: u32,
    limiter: Option<Arc<DefaultKeyedRateLimiter<Uuid>>>,
}

impl Rates {
    /// Each key may ask so often in a second, and twice as often at once; with 0 as often as it will.
    pub(super) fn new(per_second: u32) -> Self {
        let quota = NonZeroU32::new(per_second).map(|rate| {
            let at_once = rate.saturating_add(per_second);
            Quota::per_second(rate).allow_burst(at_once)
        });
        Self {
            per_second,
            limiter: quota.map(|quota| Arc::new(DefaultKeyedRateLimiter::keyed(quota))),
        }
    }

    pub(super) fn check(&self, key: Uuid) -> Result<(), Problem> {
        let Some(limiter) = &self.limiter else {
            return Ok(());
        };
        limiter.check_key(&key).map_err(|not_until| {
            let wait = not_until.wait_time_from(DefaultClock::default().now());
            let seconds = wait.as_secs() + 1;
            let detail = format!(
                "the key may ask {} times a second (--max-requests-per-second); ask again in {seconds} s, and follow events instead of polling",
                self.per_second
            );
            Problem::new(Code::TooManyRequests, detail)
                .with_header(header::RETRY_AFTER, HeaderValue::from(seconds))
        })
    }
}
