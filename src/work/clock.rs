//! The clock of the machine, for studies that tell of times.

use std::time::Instant;

use cpu_time::ThreadTime;

use crate::estimate::study::Clock;

/// Wall time, and CPU time of the thread that asks.
pub struct ThreadClock {
    wall: Instant,
}

impl ThreadClock {
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
        }
    }
}

impl Clock for ThreadClock {
    fn wall(&self) -> f64 {
        self.wall.elapsed().as_secs_f64()
    }

    fn cpu(&self) -> f64 {
        // where the system does not tell, times are 0
        ThreadTime::try_now().map_or(0.0, |now| now.as_duration().as_secs_f64())
    }
}
