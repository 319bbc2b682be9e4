//! The flag that a thread heeds, and how a loop that is to end does so.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use super::flag::{END, Interrupted, Moment, StopFlag, WIND_UP};

/// How many steps of a short loop are taken between two looks at the flag.
const STEPS: usize = 64;

/// A flag, and the urgency from which on loops end.
#[derive(Clone)]
pub(super) struct Heeded {
    pub flag: StopFlag,
    pub ends_at: u8,
}

impl Heeded {
    #[inline]
    fn may_have_to_end(&self) -> bool {
        self.flag.may_reach(self.ends_at)
    }

    fn is_to_end(&self) -> bool {
        self.flag.urgency() >= self.ends_at
    }
}

impl StopFlag {
    /// Runs work whose loops ask this flag. Its watchers are to ask it as well ([`Self::is_asked`]).
    ///
    /// # Errors
    /// It was asked to end before the work was done.
    pub fn heed<T>(&self, work: impl FnOnce() -> T) -> Result<T, Interrupted> {
        let heeded = Heeded {
            flag: self.clone(),
            ends_at: END,
        };
        within(Some(heeded), || caught(work))
    }
}

thread_local! {
    static HEEDED: RefCell<Option<Heeded>> = const { RefCell::new(None) };
}

/// A place where work may end: in each turn of a loop whose turns take long beside some ten instructions.
#[inline]
pub(crate) fn check() {
    if HEEDED.with_borrow(|heeded| heeded.as_ref().is_some_and(Heeded::may_have_to_end)) {
        ask();
    }
}

/// As [`check`], in turn `number` of a loop whose turns are short.
#[inline]
pub(crate) fn check_sometimes(number: usize) {
    if number.is_multiple_of(STEPS) {
        check();
    }
}

#[cold]
fn ask() {
    let Some(heeded) = current() else { return };
    heeded.flag.tell(Moment::Asks);
    if heeded.is_to_end() {
        // not `panic!`: this is no defect, and nothing is to be said of it
        resume_unwind(Box::new(Interrupted));
    }
}

/// Work towards an improvement that is dropped as soon as somebody asks to stop, though what there was before it is kept.
///
/// # Errors
/// It was dropped. Values that the work had hold of may be half changed: they are not to be read any more.
pub(crate) fn droppable<T>(work: impl FnOnce() -> T) -> Result<T, Interrupted> {
    let Some(heeded) = current() else {
        return Ok(work());
    };
    let sooner = Heeded {
        ends_at: heeded.ends_at.min(WIND_UP),
        ..heeded
    };
    let done = within(Some(sooner), || caught(work));
    if done.is_err() {
        // what was to go on may have been told to end, too
        check();
    }
    done
}

/// What each of several threads is to do, heeding what this one heeds.
pub(crate) fn shared<I, T>(work: impl Fn(I) -> T + Send + Sync) -> impl Fn(I) -> T + Send + Sync {
    let heeded = Shared(current());
    move |item| heeded.within(|| work(item))
}

/// The flag that a thread took from another one.
struct Shared(Option<Heeded>);

impl Shared {
    fn within<T>(&self, work: impl FnOnce() -> T) -> T {
        within(self.0.clone(), work)
    }
}

fn current() -> Option<Heeded> {
    HEEDED.with_borrow(Clone::clone)
}

/// Does work under another flag, and comes back to the former one however it ends.
pub(super) fn within<T>(heeded: Option<Heeded>, work: impl FnOnce() -> T) -> T {
    let former = Former(HEEDED.replace(heeded));
    tell_of_first(&former.0, Moment::Begins);
    work()
}

struct Former(Option<Heeded>);

impl Drop for Former {
    fn drop(&mut self) {
        tell_of_first(&self.0, Moment::Leaves);
        HEEDED.replace(self.0.take());
    }
}

/// A thread that had no flag before begins with its first and leaves with it.
fn tell_of_first(former: &Option<Heeded>, moment: Moment) {
    if former.is_none()
        && let Some(first) = current()
    {
        first.flag.tell(moment);
    }
}

/// Work on a thread whose end nobody but its own work waits for. A panic goes on its way.
///
/// # Errors
/// It ended because it was asked to.
pub(crate) fn caught<T>(work: impl FnOnce() -> T) -> Result<T, Interrupted> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|cause| match cause.downcast::<Interrupted>() {
        Ok(_) => Interrupted,
        Err(panic) => resume_unwind(panic),
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::sync::{Arc, Mutex};

    use rayon::prelude::*;

    use super::*;

    /// Never ends by itself.
    fn endless() {
        loop {
            check();
        }
    }

    #[test]
    fn work_ends_where_it_asks_and_its_thread_is_free_again() {
        let flag = StopFlag::default();
        assert_eq!(flag.heed(|| 7), Ok(7));
        flag.end();
        assert_eq!(flag.heed(endless), Err(Interrupted));
        // nobody's flag any more
        check();
    }

    #[test]
    fn winding_up_drops_what_may_be_dropped_and_lets_the_rest_be_done() {
        let flag = StopFlag::default();
        let rest = flag.heed(|| {
            flag.wind_up();
            let dropped = droppable(endless);
            check();
            dropped
        });
        assert_eq!(rest, Ok(Err(Interrupted)));
        // within something larger that may be dropped, the smaller one is no place to go on from
        let reached = AtomicUsize::new(0);
        let larger = flag.heed(|| {
            droppable(|| {
                let _ = droppable(endless);
                reached.fetch_add(1, Ordering::Relaxed);
            })
        });
        assert_eq!(larger, Ok(Err(Interrupted)));
        assert_eq!(reached.load(Ordering::Relaxed), 0);
        flag.end();
        assert_eq!(flag.heed(|| droppable(endless)), Err(Interrupted));
    }

    #[test]
    fn other_threads_that_share_the_work_end_with_it() {
        let flag = StopFlag::default();
        let begun = AtomicUsize::new(0);
        let ended = std::thread::scope(|scope| {
            let work = scope.spawn(|| {
                flag.heed(|| {
                    let one = shared(|_: usize| {
                        begun.fetch_add(1, Ordering::Relaxed);
                        endless();
                    });
                    (0..8).into_par_iter().for_each(one);
                })
            });
            while begun.load(Ordering::Relaxed) == 0 {
                std::thread::yield_now();
            }
            flag.end();
            work.join().expect("it does not panic")
        });
        assert_eq!(ended, Err(Interrupted));
    }

    #[test]
    fn who_listens_is_told_of_each_ask_of_each_thread_and_may_end_the_work() {
        let told = Arc::new(Mutex::new(Vec::new()));
        let flag = StopFlag::heard_by({
            let told = told.clone();
            move |flag, moment| {
                let mut told = told.lock().unwrap();
                told.push((std::thread::current().id(), moment));
                if told.len() > 100 {
                    flag.end();
                }
            }
        });
        let here = std::thread::current().id();
        assert_eq!(flag.heed(check), Ok(()));
        let one = [Moment::Begins, Moment::Asks, Moment::Leaves].map(|moment| (here, moment));
        assert_eq!(*told.lock().unwrap(), one);
        let ended = flag.heed(|| {
            let one = shared(|_| endless());
            std::thread::scope(|scope| {
                scope
                    .spawn(|| caught(|| one(())))
                    .join()
                    .unwrap()
                    .unwrap_err();
            });
            check();
        });
        assert_eq!(ended, Err(Interrupted));
        assert!(flag.is_asked());
        let told = told.lock().unwrap();
        let of_another = told.iter().filter(|(thread, _)| *thread != here);
        assert_eq!(of_another.count(), 97 + 1, "{told:?}");
    }

    #[test]
    fn a_panic_is_no_wish_to_stop() {
        let flag = StopFlag::default();
        let defect = || flag.heed(|| resume_unwind(Box::new("a defect")));
        let found = catch_unwind(AssertUnwindSafe(defect));
        let cause = found
            .map(|never: Result<(), _>| never)
            .expect_err("it goes on its way");
        assert_eq!(cause.downcast_ref::<&str>(), Some(&"a defect"));
    }
}
