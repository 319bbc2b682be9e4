//! Maneuvers that are deleted while jobs with them are submitted: one of the two is refused.

use std::time::Duration;

use crate::bench::{Bench, new_job, on_both};
use crate::common::recordings::{elevator, maneuver};
use trimtab::store::{Deleted, NewJob, Project, Rule, StoreError, Uploaded};

on_both! {
    a_job_is_not_accepted_without_its_maneuver,
    submitting_and_deleting_at_once_never_both_succeed,
    what_is_old_stays_where_a_job_was_submitted_at_once,
    a_deletion_that_is_refused_holds_no_job_back,
}

async fn uploaded(project: &Project) -> String {
    let recording = maneuver(elevator().as_bytes());
    let kept = project.add_maneuver("e", recording, "{}".into()).await;
    match kept.unwrap() {
        Uploaded::New(record) | Uploaded::Known(record) => record.id,
    }
}

fn job_with(maneuver: &str) -> NewJob {
    let plain = new_job("job");
    let mut spec: serde_json::Value = serde_json::from_str(&plain.spec).unwrap();
    spec["maneuvers"] = serde_json::json!([{"id": maneuver}]);
    NewJob {
        maneuvers: vec![maneuver.to_string()],
        spec: spec.to_string(),
        ..plain
    }
}

/// The check of the spec came before, and somebody deletes it in between.
async fn a_job_is_not_accepted_without_its_maneuver(bench: Bench) {
    let project = bench.project();
    let id = uploaded(&project).await;
    let job = job_with(&id);
    assert_eq!(project.delete_maneuver(&id).await.unwrap(), Deleted::Gone);
    let [whole, without] = [new_job("whole"), job].map(|job| (bench.clock.new_id(), job));
    let both = [&whole, &without].map(|(id, job)| (*id, job));
    let refused = project.submit_all(&both).await;
    assert!(
        matches!(refused, Err(StoreError::ManeuverGone { job: 1, place: 0 })),
        "{refused:?}"
    );
    // all or none
    assert!(project.job(whole.0).await.unwrap().is_none());
}

async fn submitting_and_deleting_at_once_never_both_succeed(bench: Bench) {
    for round in 0..40 {
        // another project each time: a job that was accepted keeps its maneuver
        let project = bench.store.project(&format!("p{round}"), "");
        let id = uploaded(&project).await;
        let job = job_with(&id);
        let number = bench.clock.new_id();
        let submit = async {
            tokio::time::sleep(Duration::from_micros(150 * (round % 10))).await;
            project.submit(number, &job).await
        };
        let (submitted, deleted) = tokio::join!(submit, project.delete_maneuver(&id));
        let deleted = deleted.unwrap();
        let is_there = project.maneuver(&id).await.unwrap().is_some();
        match submitted {
            Ok(_) => assert!(is_there && deleted == Deleted::InUse(1), "{deleted:?}"),
            Err(StoreError::ManeuverGone { .. }) => assert_eq!(deleted, Deleted::Gone),
            Err(error) => panic!("{error}"),
        }
    }
}

async fn what_is_old_stays_where_a_job_was_submitted_at_once(bench: Bench) {
    for round in 0..20 {
        let project = bench.store.project(&format!("p{round}"), "");
        let id = uploaded(&project).await;
        bench.clock.advance(Duration::from_secs(3600));
        let rule = Rule {
            project: Some(project.name().to_string()),
            before: bench.clock.now_text(),
            keep_tag: "keep".into(),
        };
        let job = job_with(&id);
        let number = bench.clock.new_id();
        let submit = async {
            tokio::time::sleep(Duration::from_micros(300 * (round % 10))).await;
            project.submit(number, &job).await
        };
        let (submitted, expired) = tokio::join!(submit, bench.store.expire(&rule, false));
        expired.unwrap();
        let is_there = project.maneuver(&id).await.unwrap().is_some();
        assert_eq!(submitted.is_ok(), is_there, "{submitted:?}");
    }
}

/// A worker passes over jobs that another transaction holds: one that was given up must not hold them any more.
async fn a_deletion_that_is_refused_holds_no_job_back(bench: Bench) {
    for number in 0..50 {
        let job = bench.submit("job").await;
        let refused = bench.project().delete_job(job).await.unwrap();
        assert_eq!(refused, Deleted::NotOver);
        let worker = format!("worker {number}");
        assert_eq!(bench.claim(&worker).await.job, job);
    }
}
