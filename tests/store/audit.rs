//! Who did what cannot be undone, or lets somebody in.

use std::time::Duration;

use crate::bench::{Bench, finish_next, on_both};
use crate::common::recordings::{elevator, maneuver};
use trimtab::store::{DEFAULT_PROJECT, NewKey, Rule, Scope, Uploaded};

on_both! {
    what_cannot_be_undone_is_written_down_with_who_did_it,
}

async fn what_cannot_be_undone_is_written_down_with_who_did_it(bench: Bench) {
    let project = bench.store.project(DEFAULT_PROJECT, "the key");
    let job = bench.submit("job").await;
    // what is refused is not done
    project.delete_job(job).await.unwrap();
    finish_next(&bench).await;
    project.delete_job(job).await.unwrap();
    project.delete_job(job).await.unwrap();
    let recording = maneuver(elevator().as_bytes());
    let kept = project.add_maneuver("e", recording, "{}".into()).await;
    let (Uploaded::New(record) | Uploaded::Known(record)) = kept.unwrap();
    project.delete_maneuver(&record.id).await.unwrap();
    project.add_mapping("logger", "{}").await.unwrap();
    project.delete_mapping("logger").await.unwrap();
    let new = NewKey {
        project: DEFAULT_PROJECT.into(),
        name: "pipeline".into(),
        scopes: [Scope::Read].into(),
        max_priority: 0,
        lifetime: None,
    };
    let (key, _) = bench.store.add_key(&new).await.unwrap();
    let next = bench.clock.new_id();
    let day = Duration::from_secs(24 * 3600);
    project.rotate_key(key.id, next, day).await.unwrap();
    project.revoke_key(next).await.unwrap();
    project.revoke_key(next).await.unwrap();
    let rule = Rule {
        project: None,
        before: bench.clock.now_text(),
        keep_tag: "keep".into(),
    };
    bench.store.expire(&rule, true).await.unwrap();
    bench.store.expire(&rule, false).await.unwrap();

    let page = project.audit(None, 100).await.unwrap().unwrap();
    let lines = page.entries.iter().rev();
    let told: Vec<(&str, Option<&str>)> = lines
        .map(|line| (line.deed.as_str(), line.key.as_deref()))
        .collect();
    let by = Some("the key");
    let expected = [
        ("job.deleted", by),
        ("maneuver.deleted", by),
        ("mapping.deleted", by),
        ("key.made", None),
        ("key.rotated", by),
        ("key.revoked", by),
        ("expired", None),
    ];
    assert_eq!(told, expected);
    assert!(page.entries[6].subject.contains(&job.to_string()));
    // another project hears of what was done in all of them, and of nothing else
    let other = bench.store.project("other", "");
    let others = other.audit(None, 100).await.unwrap().unwrap();
    assert_eq!(others.entries.len(), 1);
}
