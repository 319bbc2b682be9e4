mod common;
use serde_json::json;
use std::ops::ControlFlow;
use std::sync::Arc;
use trimtab::{ingest, job};

fn solve(name: &str, method: &str) {
    let Some(dir) = common::flight_data::directory(name) else {
        return;
    };
    let case = common::published_cases::read(&dir, name);
    let bytes = std::fs::read(dir.join(&case.segments[0].0)).unwrap();
    let m =
        Arc::new(ingest::read(&bytes, ingest::Format::Csv, &ingest::Limits::default()).unwrap());
    let spec: job::JobSpec = serde_json::from_value(json!({
        "model": case.model, "channels": case.channels,
        "maneuvers": [{"id": m.digest(), "rows": case.segments[0].1, "gaps": "join"}],
        "options": {"method": method}
    }))
    .unwrap();
    let job::ModelSource::Document(doc) = &spec.model else {
        panic!()
    };
    let plan = job::prepare(&spec, doc, &[m.clone()]).unwrap_or_else(|f| panic!("{f:#?}"));
    let t = std::time::Instant::now();
    let result = job::run(&plan, &mut |i| {
        println!(
            "{:3} cost {:.9e} det {:.9e} step {:.2e} damping {:.1e} halv {}",
            i.number, i.cost, i.det_r, i.step, i.damping, i.halvings
        );
        ControlFlow::Continue(())
    })
    .unwrap();
    let e = &result.estimate;
    println!(
        "{name} {method} {:?} {} it {} ev {} sim {} {:?}",
        e.outcome,
        e.reason,
        e.iterations,
        e.evaluations,
        e.simulations,
        t.elapsed()
    );
    println!(
        "det {} ref {} rel {:.2e}",
        e.det_r,
        case.det_r,
        e.det_r / case.det_r - 1.0
    );
    for (n, v, s) in &case.reference {
        let p = e.parameters.iter().find(|p| &p.name == n).unwrap();
        println!(
            "{n:8} {:14.8} {:14.8} d/se {:8.4} se {:.6e} ref {:.6e} {:.2e}",
            p.estimate,
            v,
            (p.estimate - v) / s,
            p.standard_error.unwrap(),
            s,
            p.standard_error.unwrap() / s - 1.0
        );
    }
}
#[test]
fn all() {
    for n in ["TC11_elv1", "TC03_ailrud1", "TC01", "TC04"] {
        for m in ["gauss_newton", "levenberg_marquardt"] {
            solve(n, m);
        }
    }
}
