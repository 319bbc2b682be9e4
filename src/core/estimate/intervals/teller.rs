//! Who is told how far the work is.

use crate::estimate::report::progress::{Progress, Watcher};
use crate::estimate::report::study_step::StudyStep;

pub(super) struct Teller<'a, 'w> {
    watcher: &'a mut Watcher<'w>,
    told: usize,
    of: usize,
}

impl<'a, 'w> Teller<'a, 'w> {
    /// `of`: how much there will be to tell.
    pub(super) fn new(watcher: &'a mut Watcher<'w>, of: usize) -> Self {
        Self {
            watcher,
            told: 0,
            of,
        }
    }

    /// None where the watcher wants no more.
    pub(super) fn tell(&mut self, finding: String) -> Option<()> {
        self.told += 1;
        let step = StudyStep {
            number: self.told,
            of: self.of,
            finding,
        };
        (self.watcher)(Progress::Step(&step))
            .is_continue()
            .then_some(())
    }
}
