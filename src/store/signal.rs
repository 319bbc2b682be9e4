//! Telling those who wait that something was written.
//!
//! A signal says "look again", never what there is to see: whoever waits subscribes *before* looking
//! in the tables, so that what is written in between wakes it, and looks again after a while anyway,
//! because another process on the same SQLite file cannot signal, and a connection may be lost.

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use tokio::sync::broadcast;
use uuid::Uuid;

/// The name under which processes on one PostgreSQL hear of each other's signals.
pub(super) const CHANNEL: &str = "trimtab";

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Signal {
    /// A job can be claimed.
    Work,
    /// The log of this job has grown.
    Log(Uuid),
    /// This job was asked to stop.
    Cancel(Uuid),
    /// Others may have been missed: look again, whatever is waited for.
    Missed,
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Work => f.write_str("work"),
            Self::Log(job) => write!(f, "log {job}"),
            Self::Cancel(job) => write!(f, "cancel {job}"),
            Self::Missed => f.write_str("missed"),
        }
    }
}

impl FromStr for Signal {
    type Err = uuid::Error;

    /// What is of no kind that is known here comes from a later version: look again.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text.split_once(' ') {
            Some(("log", job)) => Self::Log(job.parse()?),
            Some(("cancel", job)) => Self::Cancel(job.parse()?),
            _ if text == "work" => Self::Work,
            _ => Self::Missed,
        })
    }
}

#[derive(Clone)]
pub(super) struct Signals(broadcast::Sender<Signal>);

/// One who waits.
pub struct Listener(broadcast::Receiver<Signal>);

impl Signals {
    pub(super) fn new() -> Self {
        Self(broadcast::Sender::new(1024))
    }

    /// Only ever called behind a commit.
    pub(super) fn send(&self, signal: Signal) {
        // nobody listening is no fault
        let _ = self.0.send(signal);
    }

    pub(super) fn listen(&self) -> Listener {
        Listener(self.0.subscribe())
    }
}

impl Listener {
    /// Returns on `wanted`, and without it after `at_most`: time to look in the table either way.
    pub async fn wait_for(&mut self, wanted: Signal, at_most: Duration) {
        let heard = async {
            loop {
                match self.0.recv().await {
                    Ok(signal) if signal == wanted || signal == Signal::Missed => return,
                    Ok(_) => {}
                    // too many to keep: the wanted one may have been among them
                    Err(broadcast::error::RecvError::Lagged(_)) => return,
                    Err(broadcast::error::RecvError::Closed) => std::future::pending().await,
                }
            }
        };
        let _ = tokio::time::timeout(at_most, heard).await;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_signal_is_heard_as_it_was_sent() {
        for signal in [
            Signal::Work,
            Signal::Log(Uuid::now_v7()),
            Signal::Cancel(Uuid::now_v7()),
            Signal::Missed,
        ] {
            assert_eq!(signal.to_string().parse(), Ok(signal));
        }
        assert_eq!("of a later version".parse(), Ok(Signal::Missed));
        assert!("log nonsense".parse::<Signal>().is_err());
    }
}
