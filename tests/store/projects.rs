//! Projects, their keys and what they keep.

use std::time::Duration;

use crate::bench::{Bench, finish_next, new_job, on_both, succeeded};
use crate::common::recordings::{elevator, maneuver};
use trimtab::store::{
    CancelReply, DEFAULT_PROJECT, JobFilter, Key, KeyCheck, ManeuverFilter, NewKey, Once, Rule,
    Scope, Uploaded,
};

on_both! {
    projects_see_nothing_of_each_other,
    a_key_opens_until_it_is_revoked_or_expires,
    a_mapping_is_kept_under_its_name,
    what_is_old_goes_from_one_project_or_from_all,
}

async fn projects_see_nothing_of_each_other(bench: Bench) {
    let job = bench.submit("job").await;
    let claim = bench.claim("w").await;
    assert_eq!(claim.project, DEFAULT_PROJECT);
    bench
        .store
        .finish(&claim, 0, &[], succeeded(), None)
        .await
        .unwrap();
    let other = bench.store.project("other", "");
    assert_eq!(other.job(job).await.unwrap(), None);
    assert_eq!(other.job_spec(job).await.unwrap(), None);
    assert_eq!(other.events(job, 0, 10).await.unwrap().entries, []);
    assert_eq!(other.iterations(job).await.unwrap(), []);
    assert_eq!(other.cancel(job).await.unwrap(), CancelReply::Unknown);
    let all = other.jobs(&JobFilter::default(), None, 10).await.unwrap();
    assert_eq!(all.unwrap().entries, []);
    // the id of another's job is no way in, either
    let again = other.submit(job, &new_job("mine")).await;
    assert!(again.is_err());
    let ours = bench.project();
    let ids = [ours.clone(), other].map(|project| async move {
        let same = maneuver(elevator().as_bytes());
        let kept = project.add_maneuver("same", same, "{}".into()).await;
        match kept.unwrap() {
            Uploaded::New(record) => record.id,
            Uploaded::Known(_) => panic!("another has it"),
        }
    });
    let [ours_has, theirs_has] = ids;
    assert_eq!(ours_has.await, theirs_has.await, "it is the same content");
    let third = bench.store.project("third", "");
    assert_eq!(
        third
            .maneuvers(&ManeuverFilter::default(), None, 10)
            .await
            .unwrap()
            .unwrap()
            .entries,
        []
    );
    let mine = ours.take_in_hand("key", "request").await.unwrap();
    assert!(matches!(mine, Once::Do(_)));
    let another_key = bench.store.project(DEFAULT_PROJECT, "another key");
    let theirs = another_key.take_in_hand("key", "other").await.unwrap();
    assert!(matches!(theirs, Once::Do(_)), "{theirs:?}");
}

fn new_key(project: &str) -> NewKey {
    NewKey {
        project: project.into(),
        name: "a key".into(),
        scopes: [Scope::Read].into(),
        max_priority: 0,
        lifetime: None,
    }
}

async fn a_key_opens_until_it_is_revoked_or_expires(bench: Bench) {
    let store = &bench.store;
    assert!(!store.has_keys().await.unwrap());
    let short = NewKey {
        lifetime: Some(Duration::from_secs(60)),
        ..new_key("p")
    };
    let (short, of_short) = store.add_key(&short).await.unwrap();
    let (long, of_long) = store.add_key(&new_key("p")).await.unwrap();
    let shown = async |key: &Key| store.look_up_key(key.reveal()).await.unwrap();
    assert_eq!(long.lifetime, None);
    let good = |shown: KeyCheck| match shown {
        KeyCheck::Good(key) => key.id,
        bad => panic!("{bad:?}"),
    };
    assert_eq!(good(shown(&of_short).await), short.id);
    assert_eq!(good(shown(&of_long).await), long.id);
    let nobody = format!("{}0", of_long.reveal());
    assert_eq!(store.look_up_key(&nobody).await.unwrap(), KeyCheck::Unknown);
    // what is listed is not what opens
    let listed = store.keys(Some("p")).await.unwrap();
    assert_eq!(listed.len(), 2);
    assert!(listed.iter().all(|key| key.used.is_some()));
    assert!(!format!("{listed:?} {of_long:?}").contains(of_long.reveal()));
    assert_eq!(store.keys(Some("other")).await.unwrap(), []);

    bench.clock.advance(Duration::from_secs(61));
    assert_eq!(shown(&of_short).await, KeyCheck::Expired);
    let none = store.rotate_key(None, short.id, Duration::ZERO).await;
    assert!(none.unwrap().is_none(), "what is expired is not prolonged");
    let foreign = store.rotate_key(Some("other"), long.id, Duration::ZERO);
    assert!(foreign.await.unwrap().is_none());
    let hour = Duration::from_secs(3600);
    let (next, of_next) = store
        .rotate_key(Some("p"), long.id, hour)
        .await
        .unwrap()
        .unwrap();
    assert_eq!(
        (good(shown(&of_long).await), good(shown(&of_next).await)),
        (long.id, next.id)
    );
    bench.clock.advance(hour);
    assert_eq!(shown(&of_long).await, KeyCheck::Expired);

    assert_eq!(
        store.revoke_key(Some("other"), next.id).await.unwrap(),
        None
    );
    assert_eq!(good(shown(&of_next).await), next.id);
    let revoked = store.revoke_key(Some("p"), next.id).await.unwrap().unwrap();
    assert_eq!(shown(&of_next).await, KeyCheck::Revoked);
    let again = store.revoke_key(Some("p"), next.id).await.unwrap().unwrap();
    assert_eq!(again.revoked, revoked.revoked);
    assert!(
        store.has_keys().await.unwrap(),
        "revoking all opens nothing"
    );
}

async fn a_mapping_is_kept_under_its_name(bench: Bench) {
    let project = bench.project();
    assert!(project.add_mapping("logger", "{}").await.unwrap());
    assert!(
        project.add_mapping("logger", "{}").await.unwrap(),
        "it is the same"
    );
    assert!(!project.add_mapping("logger", "{\"x\": 1}").await.unwrap());
    let other = bench.store.project("other", "");
    assert!(other.add_mapping("logger", "{\"x\": 1}").await.unwrap());
    let kept = project
        .mapping("logger")
        .await
        .unwrap()
        .expect("the mapping");
    assert_eq!(kept.document, "{}");
    assert_eq!(project.mappings().await.unwrap(), [kept]);
    assert!(project.delete_mapping("logger").await.unwrap());
    assert!(!project.delete_mapping("logger").await.unwrap());
    assert_eq!(other.mappings().await.unwrap().len(), 1);
}

async fn what_is_old_goes_from_one_project_or_from_all(bench: Bench) {
    let projects = ["a", "b"].map(|name| bench.store.project(name, ""));
    for project in &projects {
        let recording = maneuver(elevator().as_bytes());
        let kept = project.add_maneuver("x", recording, "{}".into()).await;
        assert!(matches!(kept.unwrap(), Uploaded::New(_)));
        let id = bench.clock.new_id();
        project.submit(id, &new_job(project.name())).await.unwrap();
        finish_next(&bench).await;
    }
    bench.clock.advance(Duration::from_secs(100));
    let rule = |project: Option<&str>, keep_tag: &str| Rule {
        project: project.map(str::to_string),
        before: bench.clock.text_before(Duration::from_secs(50)),
        keep_tag: keep_tag.into(),
    };
    let expire = async |rule: Rule, dry_run: bool| {
        let expired = bench.store.expire(&rule, dry_run).await.unwrap();
        (expired.jobs, expired.maneuvers)
    };
    assert_eq!(expire(rule(None, "keep"), true).await, (2, 2));
    assert_eq!(
        expire(rule(None, "tag"), true).await,
        (0, 2),
        "the jobs have that tag"
    );
    assert_eq!(expire(rule(Some("nobody"), "keep"), false).await, (0, 0));
    assert_eq!(expire(rule(Some("a"), "keep"), false).await, (1, 1));
    assert_eq!(expire(rule(None, "keep"), false).await, (1, 1));
    assert_eq!(expire(rule(None, "keep"), false).await, (0, 0));
    assert_eq!(projects[1].stored_bytes().await.unwrap(), 0);
}
