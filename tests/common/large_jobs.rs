//! Jobs about as large as the limits allow, and how soon they end when they are told to.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use trimtab_core::estimate::study::Clock;
use trimtab_core::flight::Maneuver;
use trimtab_core::job::{self, JobKind, JobResult, JobSpec};
use trimtab_core::model::{Model, ModelDocument, catalog};
use trimtab_core::simulate::Scenario;
use trimtab_core::stop::StopFlag;

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

/// One large job at a time: they would take the cores from one another.
static ALONE: Mutex<()> = Mutex::new(());

/// What a worker leaves to the solver: to wind up, then to drop everything.
const WIND_UP: Duration = Duration::from_millis(600);

/// A cancelled job is over within this.
const LONGEST: Duration = Duration::from_secs(1);

/// Cancels a job after each of some times, in seconds, as a worker does, and holds how long it then goes on.
pub(crate) fn ends_within_a_second(name: &str, job: &LargeJob, after: &[f64]) {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    for &seconds in after {
        let flag = StopFlag::default();
        let over = AtomicBool::new(false);
        let (took, kept) = std::thread::scope(|scope| {
            let solver = scope.spawn(|| {
                let result = flag.heed(|| job.run(&flag));
                over.store(true, Ordering::Relaxed);
                (Instant::now(), result)
            });
            sleep(Duration::from_secs_f64(seconds));
            assert!(
                !over.load(Ordering::Relaxed),
                "{name}: it was not long enough"
            );
            let asked = Instant::now();
            flag.wind_up();
            while asked.elapsed() < WIND_UP && !over.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(5));
            }
            flag.end();
            let (ended, result) = solver.join().expect("it does not panic");
            let outcome = result.map(|result| result.estimate.outcome.name());
            (ended - asked, outcome)
        });
        println!(
            "| {name} | {seconds} | {:.2} | {kept:?} |",
            took.as_secs_f64()
        );
        assert!(
            took < LONGEST,
            "{name}, cancelled after {seconds} s: {took:?}"
        );
        assert!(kept.is_err() || kept == Ok("cancelled"), "{name}: {kept:?}");
    }
}

/// The bundled elevator maneuver, flown over so many samples.
pub(crate) fn long_elevator(samples: usize) -> Arc<Maneuver> {
    let text = include_str!("../../data/elevator.toml");
    let mut scenario: Scenario = toml::from_str(text).expect("a scenario");
    scenario.duration = scenario.step * (samples - 1) as f64;
    let model = catalog::find("short-period").expect("a catalog model");
    let model = Model::compile(&model).expect("a model");
    Arc::new(scenario.fly(&model).expect("a maneuver"))
}
