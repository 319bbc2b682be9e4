//! The one place where the service asks for the time.

use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use jiff::{SignedDuration, Timestamp};
use uuid::{ContextV7, Uuid};

use super::boot;

/// The system's clock, or the database's where many machines share one; a test may put it forward. Leases go by a clock that
/// nobody sets.
#[derive(Clone, Default)]
pub struct Clock {
    /// What the database's clock showed, ms since 1970, and when it was asked.
    shown: Arc<Mutex<Option<(i64, Instant)>>>,
    ahead_ms: Arc<AtomicI64>,
    turned_ms: Arc<AtomicI64>,
}

impl Clock {
    pub fn now(&self) -> Timestamp {
        let ahead = self.ahead_ms.load(Ordering::Relaxed);
        // however somebody sets the machine's clock meanwhile
        if let Some(shown) = self.database_ms() {
            let now = shown.saturating_add(ahead);
            return Timestamp::from_millisecond(now).unwrap_or(Timestamp::MAX);
        }
        let turned = self.turned_ms.load(Ordering::Relaxed);
        let ahead = SignedDuration::from_millis(ahead.saturating_add(turned));
        Timestamp::now()
            .saturating_add(ahead)
            .unwrap_or(Timestamp::MAX)
    }

    /// What the database's clock shows now, where there is one that all go by.
    fn database_ms(&self) -> Option<i64> {
        let shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let (shown, at) = (*shown)?;
        Some(shown.saturating_add(milliseconds(at.elapsed())))
    }

    /// When a lease ends that is taken now, or how leases look that have ended by now (`after` zero). Text of one clock sorts
    /// as its time.
    pub(super) fn lease_text(&self, after: Duration) -> String {
        let own = match self.database_ms() {
            Some(_) => None,
            None => boot::id().zip(boot::milliseconds()),
        };
        let Some((id, now)) = own else {
            return self.text_after(after);
        };
        let ahead = self.ahead_ms.load(Ordering::Relaxed);
        let at = now
            .saturating_add(ahead)
            .saturating_add(milliseconds(after));
        format!("boot {id} {at:015}")
    }

    /// A pattern of leases by the same clock. Others are of before the machine was started, and over.
    pub(super) fn lease_pattern(&self) -> String {
        match boot::id() {
            Some(id) if self.database_ms().is_none() => format!("boot {id} %"),
            _ => "%".to_string(),
        }
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
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        *shown = Some((now, Instant::now()));
    }

    /// Ids that are made from now on sort behind this one, whatever the clock shows.
    pub(super) fn go_on_from(&self, id: Uuid) {
        let made = id.get_timestamp().map(|at| at.to_unix());
        if let Some((seconds, nanoseconds)) = made {
            let at = i64::try_from(seconds).unwrap_or(0).saturating_mul(1000);
            let at = at.saturating_add(i64::from(nanoseconds / 1_000_000) + 1);
            let _ = id_of(Timestamp::from_millisecond(at).unwrap_or_default());
        }
    }

    /// Turns the machine's clock, as this store sees it: leases do not go by it.
    pub fn turn(&self, by: SignedDuration) {
        let by = i64::try_from(by.as_millis()).unwrap_or(i64::MAX);
        self.turned_ms.fetch_add(by, Ordering::Relaxed);
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

fn milliseconds(duration: Duration) -> i64 {
    i64::try_from(duration.as_millis()).unwrap_or(i64::MAX)
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
        let lease = clock.lease_text(Duration::from_secs(15));
        clock.turn(SignedDuration::from_hours(-1));
        assert!(clock.now_text() < now);
        // ids and leases do not follow it
        assert!(clock.new_id() > *ids.last().unwrap());
        assert!(clock.lease_text(Duration::ZERO) < lease);
        clock.advance(Duration::from_secs(16));
        assert!(clock.lease_text(Duration::ZERO) > lease);
        clock.follow(Timestamp::now().as_millisecond() - 7_200_000);
        assert!(clock.now_text() < now);
        assert!(clock.lease_text(Duration::ZERO) < clock.lease_text(Duration::from_secs(1)));
        let later = clock.text_after(Duration::from_secs(1));
        assert_eq!(clock.lease_text(Duration::from_secs(1)).len(), later.len());
    }
}
