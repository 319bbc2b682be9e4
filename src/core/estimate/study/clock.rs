//! Where times come from: the core has no clock of its own.

/// Seconds since some moment.
pub trait Clock {
    /// Wall time.
    fn wall(&self) -> f64;
    /// Of this thread.
    fn cpu(&self) -> f64;
}

/// CPU and wall time of a call, s.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(super) struct Times {
    pub cpu: f64,
    pub wall: f64,
}

pub(super) fn once<T>(clock: &dyn Clock, call: impl FnOnce() -> T) -> (T, Times) {
    let (cpu, wall) = (clock.cpu(), clock.wall());
    let made = call();
    let times = Times {
        cpu: clock.cpu() - cpu,
        wall: clock.wall() - wall,
    };
    (made, times)
}

/// Calls repeated for this long, s, but no more often than `MOST_CALLS`.
const LONG_ENOUGH: f64 = 0.05;
const MOST_CALLS: usize = 50;

/// The least times of repeated calls.
pub(super) fn least<T>(clock: &dyn Clock, mut call: impl FnMut() -> T) -> (T, Times) {
    let began = clock.wall();
    let (mut made, mut least) = once(clock, &mut call);
    for _ in 1..MOST_CALLS {
        if clock.wall() - began > LONG_ENOUGH {
            break;
        }
        let times;
        (made, times) = once(clock, &mut call);
        least.cpu = least.cpu.min(times.cpu);
        least.wall = least.wall.min(times.wall);
    }
    (made, least)
}
