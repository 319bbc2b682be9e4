//! Telling those who wait that something was written.
//!
//! A signal says "look again", never what there is to see: whoever waits subscribes *before* looking
//! in the tables, so that what is written in between wakes it, and looks again after a while anyway,
//! because another process on the same database cannot signal.

use std::time::Duration;

use tokio::sync::broadcast;
use uuid::Uuid;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Signal {
    /// A job can be claimed.
    Work,
    /// The log of this job has grown.
    Log(Uuid),
    /// This job was asked to stop.
    Cancel(Uuid),
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
                    Ok(signal) if signal == wanted => return,
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
