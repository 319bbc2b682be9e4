//! Progress, told as it is made; and whether to go on.

use std::ops::ControlFlow;

use super::report::Step;

/// Told of all progress, and asked every now and then with nothing to tell; may stop the diagnosis.
pub type Watcher<'o> = dyn FnMut(Option<&Step>) -> ControlFlow<()> + 'o;

/// The watcher asked to stop.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Stopped;

pub(super) fn tell(watcher: &mut Watcher<'_>, step: &Step) -> Result<(), Stopped> {
    go_on(watcher(Some(step)))
}

pub(super) fn ask(watcher: &mut Watcher<'_>) -> Result<(), Stopped> {
    go_on(watcher(None))
}

fn go_on(flow: ControlFlow<()>) -> Result<(), Stopped> {
    if flow.is_break() {
        Err(Stopped)
    } else {
        Ok(())
    }
}
