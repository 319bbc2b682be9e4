//! What webhooks are owed.

use std::time::Duration;

use crate::bench::{Bench, finish_next, on_both};
use trimtab::store::{Attempt, LEASE};

on_both! {
    what_a_webhook_is_owed_is_taken_by_one_and_sent_until_it_arrives,
}

async fn what_a_webhook_is_owed_is_taken_by_one_and_sent_until_it_arrives(bench: Bench) {
    let project = bench.project();
    let events = ["job.succeeded".to_string()];
    let id = bench.clock.new_id();
    let hook = project.add_webhook(id, "https://lab.example/", &events, "whsec_a");
    assert_eq!(project.webhook(id).await.unwrap(), None);
    let hook = hook.await.unwrap();
    assert_eq!(
        project.webhooks().await.unwrap(),
        std::slice::from_ref(&hook)
    );
    let other = bench.store.project("other", "");
    assert_eq!(other.webhooks().await.unwrap(), []);
    assert!(!other.rotate_webhook(id, "mine", LEASE).await.unwrap());
    assert!(!other.delete_webhook(id).await.unwrap());

    let job = bench.submit("job").await;
    assert_eq!(bench.store.take_delivery().await.unwrap(), None);
    finish_next(&bench).await;
    let taken = bench
        .store
        .take_delivery()
        .await
        .unwrap()
        .expect("a delivery");
    assert_eq!(
        (taken.job.clone(), taken.event.as_str()),
        (job.to_string(), "job.succeeded")
    );
    assert_eq!(
        (taken.attempts, &taken.secrets),
        (1, &vec!["whsec_a".to_string()])
    );
    let second = bench.other().await;
    assert_eq!(second.take_delivery().await.unwrap(), None, "it is in hand");
    // who took it died
    bench.clock.advance(Duration::from_secs(61));
    let again = second.take_delivery().await.unwrap().expect("a delivery");
    assert_eq!((again.id, again.attempts), (taken.id, 2));
    let failed = Attempt::Failed {
        status: Some(500),
        fault: "it answers 500".into(),
        again: Some(Duration::from_secs(5)),
    };
    second.settle_delivery(&again, &failed).await.unwrap();
    let hour = Duration::from_secs(3600);
    assert!(project.rotate_webhook(id, "whsec_b", hour).await.unwrap());
    bench.clock.advance(Duration::from_secs(6));
    let third = bench
        .store
        .take_delivery()
        .await
        .unwrap()
        .expect("a delivery");
    assert_eq!(third.secrets, ["whsec_b", "whsec_a"]);
    bench
        .store
        .settle_delivery(&third, &Attempt::Arrived(204))
        .await
        .unwrap();
    bench.clock.advance(hour * 100);
    assert_eq!(bench.store.take_delivery().await.unwrap(), None);
    let log = project.deliveries(id, 10).await.unwrap();
    assert_eq!(
        (log.len(), log[0].attempts, log[0].status),
        (1, 3, Some(204))
    );
    assert!(log[0].done.is_some() && log[0].next.is_none() && log[0].fault.is_none());
    assert_eq!(other.deliveries(id, 10).await.unwrap(), []);

    // two are owed when the receiver says that it is gone: neither is sent again
    for _ in 0..2 {
        project.try_webhook(id).await.unwrap();
    }
    let one = bench
        .store
        .take_delivery()
        .await
        .unwrap()
        .expect("a delivery");
    assert_eq!(
        one.secrets,
        ["whsec_b"],
        "the former secret has had its time"
    );
    bench
        .store
        .settle_delivery(&one, &Attempt::Gone(410))
        .await
        .unwrap();
    assert_eq!(bench.store.take_delivery().await.unwrap(), None);
    assert!(
        project
            .webhook(id)
            .await
            .unwrap()
            .unwrap()
            .disabled
            .is_some()
    );
    assert!(project.delete_webhook(id).await.unwrap());
    assert_eq!(project.webhooks().await.unwrap(), []);
}
