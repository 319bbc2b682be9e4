//! Jobs about as large as the limits allow, and how often they ask whether they are to end.

use std::backtrace::Backtrace;
use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use cpu_time::ThreadTime;
use serde_json::{Value, json};
use trimtab_core::estimate::study::Clock;
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobKind, JobResult, JobSpec};
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::Scenario;
use trimtab_core::stop::{Moment, StopFlag};

/// What a job is made of.
pub(crate) struct LargeJob {
    spec: JobSpec,
    document: ModelDocument,
    maneuvers: Vec<Arc<Maneuver>>,
}

impl LargeJob {
    pub(crate) fn new(document: &Value, maneuver: Arc<Maneuver>, changes: &Value) -> Self {
        let mut spec = json!({"model": document, "maneuvers": [{"id": maneuver.digest()}]});
        for (key, value) in changes.as_object().expect("an object") {
            spec[key] = value.clone();
        }
        let document = match document {
            Value::String(name) => catalog::find(name).expect("a catalog model"),
            document => serde_json::from_value(document.clone()).expect("a document"),
        };
        Self {
            spec: serde_json::from_value(spec).expect("a spec"),
            document,
            maneuvers: vec![maneuver],
        }
    }

    /// As a worker runs it.
    fn run(&self, flag: &StopFlag) -> JobResult {
        let go_on = || match flag.is_asked() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let plan = job::prepare(&self.spec, &self.document, &self.maneuvers);
        let plan = plan.unwrap_or_else(|faults| panic!("{faults:#?}"));
        let result = match self.spec.kind {
            JobKind::Estimate => job::run(&plan, &mut |_| go_on()),
            JobKind::Structure => job::run_structure(&plan, &mut |_| go_on()),
            JobKind::DerivativeStudy => job::run_study(&plan, &NoClock, &mut |_| go_on()),
            JobKind::Diagnose => job::run_diagnosis(&plan, &mut |_| go_on()),
        };
        result.unwrap_or_else(|faults| panic!("{faults:#?}"))
    }
}

/// Times are not asked about.
struct NoClock;

impl Clock for NoClock {
    fn wall(&self) -> f64 {
        0.0
    }

    fn cpu(&self) -> f64 {
        0.0
    }
}

/// What a worker leaves to the solver when a job is cancelled: CPU time to wind up.
const WIND_UP: Duration = Duration::from_millis(600);

/// How long a thread may work between two asks whether it is to end: with [`WIND_UP`], less than a second. It is CPU time,
/// so that what else the machine does is no matter.
pub(crate) const LONGEST: Duration = Duration::from_millis(300);

/// Runs a job as a worker does, cancels it when its threads have worked `until`, and holds how long they went without an ask.
pub(crate) fn asks_often(name: &str, job: &LargeJob, until: Duration, longest: Duration) {
    let heard = Arc::new(Heard {
        until,
        spent: AtomicU64::new(0),
        longest: Mutex::default(),
    });
    let flag = StopFlag::heard_by({
        let heard = heard.clone();
        move |flag, moment| heard.hear(flag, moment)
    });
    // threads of its own: those of all take work of other tests meanwhile
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let result = pool
        .expect("threads")
        .install(|| flag.heed(|| job.run(&flag)));
    let kept = result.map(|result| result.estimate.outcome.name());
    let gap = heard.longest.lock().expect("no panic").take();
    let gap = gap.expect("it asked");
    println!(
        "| {name} | {:.1} s | longest without an ask {:.0} ms | {kept:?} |",
        Duration::from_nanos(heard.spent.load(Ordering::Relaxed)).as_secs_f64(),
        gap.length.as_secs_f64() * 1000.0,
    );
    assert!(
        gap.length < longest,
        "{name}: {:?} without an ask, until\n{}",
        gap.length,
        gap.until
    );
    if until == Duration::MAX {
        assert!(kept.is_ok(), "{name}: {kept:?}");
    } else {
        assert!(flag.is_asked(), "{name}: it was not long enough");
        assert!(kept.is_err() || kept == Ok("cancelled"), "{name}: {kept:?}");
    }
}

/// What is heard of all threads of a job.
struct Heard {
    until: Duration,
    /// ns
    spent: AtomicU64,
    longest: Mutex<Option<Gap>>,
}

/// A time without an ask.
struct Gap {
    length: Duration,
    /// The ask at its end.
    until: Backtrace,
}

thread_local! {
    /// CPU time of this thread when it asked last.
    static LAST: Cell<Duration> = const { Cell::new(Duration::ZERO) };
}

impl Heard {
    fn hear(&self, flag: &StopFlag, moment: Moment) {
        let now = ThreadTime::now().as_duration();
        let length = now.saturating_sub(LAST.replace(now));
        if moment == Moment::Begins {
            return;
        }
        let nanoseconds = length.as_nanos() as u64;
        let before = self.spent.fetch_add(nanoseconds, Ordering::Relaxed);
        let spent = Duration::from_nanos(before + nanoseconds);
        if spent > self.until {
            flag.wind_up();
        }
        if spent > self.until.saturating_add(WIND_UP) {
            flag.end();
        }
        let mut longest = self.longest.lock().unwrap_or_else(PoisonError::into_inner);
        if longest.as_ref().is_none_or(|gap| gap.length < length) {
            let until = match length > WORTH_A_PLACE {
                true => Backtrace::force_capture(),
                false => Backtrace::disabled(),
            };
            *longest = Some(Gap { length, until });
            // finding the place is not the job's time
            LAST.set(ThreadTime::now().as_duration());
        }
    }
}

/// Times shorter than this need no place.
const WORTH_A_PLACE: Duration = Duration::from_millis(10);

/// The bundled elevator maneuver, flown over so many samples.
pub(crate) fn long_elevator(samples: usize) -> Arc<Maneuver> {
    let text = include_str!("../../data/elevator.toml");
    let mut scenario: Scenario = toml::from_str(text).expect("a scenario");
    scenario.duration = scenario.step * (samples - 1) as f64;
    let model = catalog::find("short-period").expect("a catalog model");
    let model = Model::compile(&model).expect("a model");
    Arc::new(scenario.fly(&model).expect("a maneuver"))
}
