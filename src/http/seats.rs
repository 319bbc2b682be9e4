//! Connections: how many may be open, in all and of one peer, and a few on reserve, so that whoever watches the service is
//! answered however many others are there.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// Connections on reserve: each is for one request that comes soon, and is answered at once.
const RESERVE: usize = 64;

/// Given out to connections; clones give out the same.
#[derive(Clone)]
pub(super) struct Seats {
    all: Arc<Semaphore>,
    reserve: Arc<Semaphore>,
    peers: Arc<Mutex<HashMap<IpAddr, usize>>>,
    most_of_a_peer: usize,
}

/// What a connection has got; it is given back when this goes away.
pub(super) enum Seat {
    Whole {
        _seat: OwnedSemaphorePermit,
        _peer: OfPeer,
    },
    /// All others are taken, or all that the peer may have.
    Reserve { _seat: OwnedSemaphorePermit },
}

/// One connection more of a peer.
pub(super) struct OfPeer {
    peers: Arc<Mutex<HashMap<IpAddr, usize>>>,
    peer: IpAddr,
}

impl Seats {
    /// `most_of_a_peer` 0: as many as there are.
    pub(super) fn new(all: usize, most_of_a_peer: usize) -> Self {
        Self {
            all: Arc::new(Semaphore::new(all.min(Semaphore::MAX_PERMITS))),
            reserve: Arc::new(Semaphore::new(RESERVE)),
            peers: Arc::default(),
            most_of_a_peer: match most_of_a_peer {
                0 => usize::MAX,
                most => most,
            },
        }
    }

    /// `None`: there is nothing left, not even on reserve.
    pub(super) fn take(&self, peer: IpAddr) -> Option<Seat> {
        if let Some(of_peer) = self.of_peer(peer)
            && let Ok(seat) = self.all.clone().try_acquire_owned()
        {
            return Some(Seat::Whole {
                _seat: seat,
                _peer: of_peer,
            });
        }
        let seat = self.reserve.clone().try_acquire_owned().ok()?;
        Some(Seat::Reserve { _seat: seat })
    }

    fn of_peer(&self, peer: IpAddr) -> Option<OfPeer> {
        let mut peers = self.peers.lock().unwrap_or_else(PoisonError::into_inner);
        let open = peers.entry(peer).or_default();
        if *open >= self.most_of_a_peer {
            return None;
        }
        *open += 1;
        let peers = self.peers.clone();
        Some(OfPeer { peers, peer })
    }
}

impl Drop for OfPeer {
    fn drop(&mut self) {
        let mut peers = self.peers.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(open) = peers.get_mut(&self.peer) {
            *open -= 1;
            if *open == 0 {
                peers.remove(&self.peer);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peer_has_its_share_and_the_rest_is_for_others() {
        let seats = Seats::new(3, 2);
        let [one, other]: [IpAddr; 2] = ["10.0.0.1", "10.0.0.2"].map(|ip| ip.parse().unwrap());
        let is_whole = |seat: &Option<Seat>| matches!(seat, Some(Seat::Whole { .. }));
        let held: Vec<_> = (0..2).map(|_| seats.take(one)).collect();
        assert!(held.iter().all(is_whole));
        let beyond = seats.take(one);
        assert!(matches!(beyond, Some(Seat::Reserve { .. })));
        let of_other = seats.take(other);
        assert!(is_whole(&of_other));
        assert!(matches!(seats.take(other), Some(Seat::Reserve { .. })));
        drop(of_other);
        // given back, in all and of the peer
        assert!(is_whole(&seats.take(other)) && is_whole(&seats.take(other)));
        let reserve: Vec<_> = (1..RESERVE).map(|_| seats.take(one)).collect();
        assert!(reserve.iter().all(Option::is_some));
        assert!(seats.take(one).is_none());
        drop(held);
        assert!(is_whole(&seats.take(one)));
        assert!(seats.peers.lock().unwrap().is_empty());
    }
}
