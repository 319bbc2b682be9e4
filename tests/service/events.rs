//! Following a job: server-sent events, resumed wherever they were cut off.

use crate::common::jobs::{endless_job, job};
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Server, send};
use crate::common::sse::{Received, Stream, bytes, complete_in};
use reqwest::Method;
use serde_json::Value;
use trimtab::job::Event;

fn ids(events: &[Received]) -> Vec<u64> {
    events.iter().map(|event| event.id).collect()
}

#[tokio::test]
async fn a_stream_tells_the_whole_job_and_ends() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    // from before it runs to its end
    let live = Stream::open(&server.url, &id, None)
        .await
        .unwrap()
        .rest()
        .await;
    let names: Vec<&str> = live.iter().map(|event| event.event.as_str()).collect();
    assert_eq!(
        names[..5],
        ["queued", "claimed", "prepared", "start", "iteration"]
    );
    assert_eq!(names[names.len() - 1], "succeeded");
    assert_eq!(ids(&live), (1..=live.len() as u64).collect::<Vec<_>>());
    for received in &live {
        let event: Event = serde_json::from_str(&received.data).unwrap();
        assert_eq!(
            (event.seq, event.body.name()),
            (received.id, received.event.as_str())
        );
    }
    // the same once more when it is over, and the same as pages
    let replayed = Stream::open(&server.url, &id, None)
        .await
        .unwrap()
        .rest()
        .await;
    assert_eq!(replayed, live);
    let (mut paged, mut after) = (Vec::new(), 0);
    loop {
        let page = server
            .get(&format!("/v1/jobs/{id}/events?after={after}&limit=3"))
            .await
            .json();
        paged.extend(page["events"].as_array().unwrap().clone());
        after = page["next_after"].as_u64().unwrap();
        if page["complete"] == true {
            break;
        }
    }
    let streamed: Vec<Value> = live
        .iter()
        .map(|e| serde_json::from_str(&e.data).unwrap())
        .collect();
    assert_eq!(paged, streamed);
}

#[tokio::test]
async fn cut_off_at_any_byte_and_resumed_every_event_comes_once() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    server.wait(&id).await;
    let whole = bytes(&server.url, &id).await;
    let events = complete_in(&whole);
    let last = events.len() as u64;
    // what a resumed stream says depends on the number only: ask once for each
    let mut resumed = Vec::new();
    for seen in 0..=last {
        resumed.push(match Stream::open(&server.url, &id, Some(seen)).await {
            Some(stream) => stream.rest().await,
            None => Vec::new(),
        });
    }
    for cut in 0..=whole.len() {
        let mut seen = complete_in(&whole[..cut]);
        let number = seen.last().map_or(0, |event| event.id);
        seen.extend(resumed[number as usize].clone());
        assert_eq!(seen, events, "cut at byte {cut}");
    }
    assert!(
        Stream::open(&server.url, &id, Some(last)).await.is_none(),
        "over is said by 204"
    );
}

#[tokio::test]
async fn cut_off_while_it_runs_and_resumed_every_event_comes_once() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator_of(200.0, 7)).await;
    let mut spec = endless_job(&maneuver);
    spec["options"]["max_iterations"] = 30.into();
    let id = server.submit(&spec).await;
    let mut seen: Vec<Received> = Vec::new();
    // a new connection for each event
    while let Some(mut stream) =
        Stream::open(&server.url, &id, seen.last().map(|event| event.id)).await
    {
        seen.extend(stream.next().await);
    }
    assert_eq!(ids(&seen), (1..=seen.len() as u64).collect::<Vec<_>>());
    assert_eq!(seen[seen.len() - 1].event, "succeeded");
    let replayed = Stream::open(&server.url, &id, None)
        .await
        .unwrap()
        .rest()
        .await;
    assert_eq!(seen, replayed);
}

#[tokio::test]
async fn two_followers_see_the_same() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    let follow = async || {
        Stream::open(&server.url, &id, None)
            .await
            .unwrap()
            .rest()
            .await
    };
    let (first, second) = tokio::join!(follow(), follow());
    assert_eq!(first, second);
}

#[tokio::test]
async fn the_header_counts_before_the_query() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator()).await;
    let id = server.submit(&job(&maneuver)).await;
    server.wait(&id).await;
    let path = format!("/v1/jobs/{id}/events?after=1");
    let ask = async |id: &'static str| {
        send(
            server
                .request(Method::GET, &path)
                .header("last-event-id", id),
        )
        .await
    };
    assert_eq!(ask("2").await.json()["events"][0]["seq"], 3);
    assert_eq!(server.get(&path).await.json()["events"][0]["seq"], 2);
    assert_eq!(ask("two").await.problem(400, "invalid_header"), []);
    assert_eq!(ask("-1").await.problem(400, "invalid_header"), []);
    let beyond = ask("18446744073709551615").await.json();
    assert_eq!(
        (
            beyond["events"].as_array().unwrap().len(),
            &beyond["complete"]
        ),
        (0, &true.into())
    );
    let nobody = format!("/v1/jobs/{}/events", uuid::Uuid::nil());
    let answer = server.get_as(&nobody, "text/event-stream").await;
    assert_eq!(answer.problem(404, "unknown_job"), []);
}

/// A number behind the last event, of another job or from before a backup was put back: who asked with it heard nothing, not
/// even of the end.
#[tokio::test]
async fn whoever_is_ahead_of_the_log_is_told_the_end() {
    let server = Server::start().await;
    let maneuver = server.upload(&elevator_of(2000.0, 5)).await;
    let id = server.submit(&endless_job(&maneuver)).await;
    let ahead = Stream::open(&server.url, &id, Some(100_000)).await.unwrap();
    server
        .post(&format!("/v1/jobs/{id}/cancel"), "application/json", "")
        .await;
    let end = tokio::time::timeout(std::time::Duration::from_secs(60), ahead.rest());
    let events = end.await.expect("the stream ends");
    assert_eq!(events.last().unwrap().event, "cancelled");
    // and once it is over there is nothing more
    assert!(
        Stream::open(&server.url, &id, Some(100_000))
            .await
            .is_none()
    );
    let path = format!("/v1/jobs/{id}/events?after=100000");
    let page = server.get(&path).await.json();
    assert_eq!(page["complete"], true);
    assert_eq!(page["next_after"], events.last().unwrap().id);
}
