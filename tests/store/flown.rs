//! What was flown: said of a recording, changed and found by.

use std::time::Duration;

use crate::bench::{Bench, on_both};
use crate::common::recordings::{elevator, maneuver};
use trimtab::flight::{Flown, Quantity};
use trimtab::store::{ManeuverFilter, ManeuverRecord, Rule, Uploaded};

on_both! {
    what_is_said_is_kept_and_found_by,
    changes_come_one_after_the_other,
    what_was_said_goes_with_its_recording,
}

async fn uploaded(bench: &Bench) -> String {
    let recording = maneuver(elevator().as_bytes());
    let kept = bench
        .project()
        .add_maneuver("e", recording, "{}".into())
        .await;
    match kept.unwrap() {
        Uploaded::New(record) | Uploaded::Known(record) => record.id,
    }
}

fn flight(name: &str) -> Flown {
    Flown {
        flight: Some(name.to_string()),
        tags: vec!["one".to_string(), "two".to_string()],
        mass: Some(Quantity {
            value: 17600.0,
            unit: "kg".to_string(),
        }),
        ..Flown::default()
    }
}

async fn found(bench: &Bench, filter: &ManeuverFilter) -> usize {
    let page = bench.project().maneuvers(filter, None, 10).await;
    page.unwrap().unwrap().entries.len()
}

async fn what_is_said_is_kept_and_found_by(bench: Bench) {
    let id = uploaded(&bench).await;
    let project = bench.project();
    assert!(
        project
            .maneuver(&id)
            .await
            .unwrap()
            .unwrap()
            .flown
            .is_empty()
    );
    let said = |_: &ManeuverRecord| Ok::<_, ()>(("named".to_string(), flight("F 12")));
    let changed = project
        .change_maneuver(&id, said)
        .await
        .unwrap()
        .unwrap()
        .unwrap();
    assert_eq!(
        (changed.name.as_str(), &changed.flown),
        ("named", &flight("F 12"))
    );
    assert_eq!(project.maneuver(&id).await.unwrap(), Some(changed));
    assert_eq!(
        project.flown(&[&id, "x"]).await.unwrap(),
        [Some(flight("F 12")), None]
    );
    // the same content again is what it was
    assert_eq!(uploaded(&bench).await, id);
    assert_eq!(
        project.maneuver(&id).await.unwrap().unwrap().flown,
        flight("F 12")
    );
    let by = |flight: &str, tag: &str| ManeuverFilter {
        flight: Some(flight.to_string()),
        tag: Some(tag.to_string()),
        ..ManeuverFilter::default()
    };
    for (filter, expected) in [
        (ManeuverFilter::default(), 1),
        (by("F 12", "two"), 1),
        (by("F 12", "three"), 0),
        (by("F 13", "two"), 0),
        (by("' OR 1=1 --", "two"), 0),
    ] {
        assert_eq!(found(&bench, &filter).await, expected, "{filter:?}");
    }
    let refused = project.change_maneuver(&id, |_| Err("no")).await.unwrap();
    assert_eq!(refused, Some(Err("no")));
    let none = project.change_maneuver("x", |_| Err("no")).await.unwrap();
    assert_eq!(none, None);
    let again = |now: &ManeuverRecord| Ok::<_, ()>((now.name.clone(), flight("F 13")));
    project
        .change_maneuver(&id, again)
        .await
        .unwrap()
        .unwrap()
        .unwrap();
    assert_eq!(found(&bench, &by("F 12", "two")).await, 0);
    assert_eq!(found(&bench, &by("F 13", "two")).await, 1);
    let other = bench.store.project("other", "");
    assert_eq!(
        other.change_maneuver(&id, |_| Err("no")).await.unwrap(),
        None
    );
    let page = other.maneuvers(&by("F 13", "two"), None, 10).await;
    assert_eq!(page.unwrap().unwrap().entries, []);
}

async fn changes_come_one_after_the_other(bench: Bench) {
    let id = uploaded(&bench).await;
    let tasks: Vec<_> = (0..16)
        .map(|number| {
            let (project, id) = (bench.project(), id.clone());
            tokio::spawn(async move {
                let add = |now: &ManeuverRecord| {
                    let mut flown = now.flown.clone();
                    flown.tags.push(format!("{number}"));
                    Ok::<_, ()>((now.name.clone(), flown))
                };
                project
                    .change_maneuver(&id, add)
                    .await
                    .unwrap()
                    .unwrap()
                    .unwrap();
            })
        })
        .collect();
    for task in tasks {
        task.await.unwrap();
    }
    let record = bench.project().maneuver(&id).await.unwrap().unwrap();
    assert_eq!(record.flown.tags.len(), 16, "{:?}", record.flown.tags);
}

async fn what_was_said_goes_with_its_recording(bench: Bench) {
    let id = uploaded(&bench).await;
    let said = |now: &ManeuverRecord| Ok::<_, ()>((now.name.clone(), flight("F 12")));
    bench
        .project()
        .change_maneuver(&id, said)
        .await
        .unwrap()
        .unwrap()
        .unwrap();
    bench.clock.advance(Duration::from_secs(100));
    let rule = Rule {
        project: None,
        before: bench.clock.now_text(),
        keep_tag: "keep".to_string(),
    };
    assert_eq!(bench.store.expire(&rule, false).await.unwrap().maneuvers, 1);
    assert_eq!(uploaded(&bench).await, id);
    let record = bench.project().maneuver(&id).await.unwrap().unwrap();
    assert!(record.flown.is_empty());
    let filter = ManeuverFilter {
        tag: Some("one".to_string()),
        ..ManeuverFilter::default()
    };
    assert_eq!(found(&bench, &filter).await, 0);
}
