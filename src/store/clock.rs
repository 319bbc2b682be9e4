//! The one place where the service asks for the time.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::Duration;

use jiff::{SignedDuration, Timestamp};
use uuid::{ContextV7, Uuid};

/// The system's clock, or the database's where many machines share one; a test may put it forward.
#[derive(Clone, Default)]
pub struct Clock {
    /// Of the database's clock before the system's.
    offset_ms: Arc<AtomicI64>,
    ahead_ms: Arc<AtomicI64>,
}

impl Clock {
    pub fn now(&self) -> Timestamp {
        let [offset, ahead] =
            [&self.offset_ms, &self.ahead_ms].map(|of| of.load(Ordering::Relaxed));
        let ahead = SignedDuration::from_millis(offset.saturating_add(ahead));
        Timestamp::now()
            .saturating_add(ahead)
            .unwrap_or(Timestamp::MAX)
    }

    /// Now, as it is written in the tables.
    pub fn now_text(&self) -> String {
        text(self.now())
    }

    /// The moment `duration` from now, as it is written in the tables.
    pub fn text_after(&self, duration: Duration) -> String {
        let duration = SignedDuration::try_from(duration).unwrap_or(SignedDuration::MAX);
        text(
            self.now()
                .saturating_add(duration)
                .unwrap_or(Timestamp::MAX),
        )
    }

    /// The moment `duration` before now, as it is written in the tables.
    pub fn text_before(&self, duration: Duration) -> String {
        let duration = SignedDuration::try_from(duration).unwrap_or(SignedDuration::MAX);
        text(
            self.now()
                .saturating_sub(duration)
                .unwrap_or(Timestamp::MIN),
        )
    }

    /// The time that has passed since a moment of the tables, s.
    pub fn seconds_since(&self, moment: &str) -> f64 {
        Self::seconds_between(moment, &self.now_text()).unwrap_or(0.0)
    }

    /// The time between two moments of the tables, s.
    pub fn seconds_between(from: &str, to: &str) -> Option<f64> {
        let [from, to] = [from, to].map(|text| text.parse::<Timestamp>().ok());
        Some((to?.as_millisecond() - from?.as_millisecond()) as f64 / 1000.0)
    }

    /// A moment that a user wrote (RFC 3339), as it is written in the tables.
    pub fn read(moment: &str) -> Option<String> {
        moment.parse().ok().map(text)
    }

    /// Goes by another clock from now on, which shows `now`, ms since 1970.
    pub(super) fn follow(&self, now: i64) {
        let offset = now.saturating_sub(Timestamp::now().as_millisecond());
        self.offset_ms.store(offset, Ordering::Relaxed);
    }

    /// Puts the clock of this store forward: what would happen later happens now.
    pub fn advance(&self, by: Duration) {
        let by = i64::try_from(by.as_millis()).unwrap_or(i64::MAX);
        self.ahead_ms.fetch_add(by, Ordering::Relaxed);
    }

    /// A UUID v7 of now; those of one process sort in the order in which they were made.
    pub fn new_id(&self) -> Uuid {
        id_of(self.now())
    }
}

/// A UUID v7 of a moment of the tables.
pub(super) fn id_at(moment: &str) -> Uuid {
    id_of(moment.parse().unwrap_or(Timestamp::UNIX_EPOCH))
}

fn id_of(moment: Timestamp) -> Uuid {
    static CONTEXT: std::sync::Mutex<ContextV7> = std::sync::Mutex::new(ContextV7::new());
    let seconds = u64::try_from(moment.as_second()).unwrap_or(0);
    let nanoseconds = u32::try_from(moment.subsec_nanosecond()).unwrap_or(0);
    Uuid::new_v7(uuid::Timestamp::from_unix(&CONTEXT, seconds, nanoseconds))
}

/// RFC 3339 with exactly three decimals: of one length, so that text sorts as time.
fn text(at: Timestamp) -> String {
    format!("{at:.3}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_sorts_as_time_and_ids_as_made() {
        let clock = Clock::default();
        let (now, later) = (clock.now_text(), clock.text_after(Duration::from_secs(1)));
        assert_eq!(now.len(), "2026-11-21T12:00:00.123Z".len());
        assert!(now < later);
        let ids: Vec<Uuid> = (0..1000).map(|_| clock.new_id()).collect();
        assert!(ids.is_sorted());
        clock.advance(Duration::from_secs(2));
        assert!(clock.now_text() > later);
        clock.follow(Timestamp::now().as_millisecond() - 3_600_000);
        assert!(clock.now_text() < now);
    }
}
