//! Webhooks: the end of a job, told to who asked to be told.
//!
//! By the Standard Webhooks specification, version 1: a thin JSON message, signed, with an id by which the receiver knows a
//! repetition, tried again over a day and a half. What is owed is in the store; any process may pay it.
//!
//! Invariant: nothing is sent to an address inside the network unless that was allowed.

mod address;
mod client;
mod send;
mod sign;

use std::time::Duration;

use tokio::task::JoinSet;
use tokio_util::sync::CancellationToken;

use crate::store::Store;

pub use address::{Allowed, Refused};
pub use client::http_client;
pub use sign::{new_secret, signature};

use send::Sender;

/// How often to look for what is due.
const LOOK_AGAIN: Duration = Duration::from_millis(500);

/// Messages under way at a time: a receiver that is slow holds up no other.
const AT_ONCE: usize = 32;

/// Sends what is due until `shutdown`. What is under way then is sent again by another process, or later.
pub async fn run(store: Store, allowed: Allowed, shutdown: CancellationToken) {
    let sender = Sender::new(allowed);
    let mut under_way = JoinSet::new();
    while !shutdown.is_cancelled() {
        while under_way.try_join_next().is_some() {}
        let due = if under_way.len() < AT_ONCE {
            store.take_delivery().await
        } else {
            Ok(None)
        };
        match due {
            Ok(Some(delivery)) => {
                let (store, sender) = (store.clone(), sender.clone());
                under_way.spawn(async move {
                    let attempt = sender.send(&delivery, store.clock().now()).await;
                    if let Err(error) = store.settle_delivery(&delivery, &attempt).await {
                        tracing::warn!(%error, delivery = %delivery.id, "it will be sent again");
                    }
                });
                continue;
            }
            Ok(None) => {}
            Err(error) => tracing::warn!(%error, "cannot look for webhooks that are due"),
        }
        tokio::select! {
            () = tokio::time::sleep(LOOK_AGAIN) => {}
            () = shutdown.cancelled() => {}
        }
    }
}
