//! What is sent to break the service, and is refused.

use std::time::{Duration, Instant};

use crate::common::database::Database;
use crate::common::jobs::job;
use crate::common::process::Process;
use crate::common::recordings::elevator;
use crate::common::server::{Server, client, send};
use reqwest::Method;
use serde_json::json;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use trimtab::http::Config;

/// A PostgreSQL cannot keep it; what is refused on one engine is refused on the other.
async fn no_text_has_the_character_nul(database: &Database) {
    let server = Process::serve(&database.address, "127.0.0.1:0", 0);
    let client = client();
    let json_bodies = [
        (
            "/v1/jobs",
            r#"{"name": "a\u0000b", "model": "short-period", "maneuvers": [{"id": "x"}]}"#,
        ),
        (
            "/v1/jobs",
            r#"{"tags": ["a\u0000"], "model": "short-period", "maneuvers": [{"id": "x"}]}"#,
        ),
        (
            "/v1/jobs",
            r#"{"model": "short-period", "maneuvers": [{"id": "\u0000"}]}"#,
        ),
        ("/v1/models", r#"{"title": "\u0000"}"#),
        (
            "/v1/retention",
            r#"{"older_than_days": 1, "keep_tag": "\u0000"}"#,
        ),
        ("/v1/webhooks", r#"{"url": "https://lab.example/\u0000"}"#),
        ("/v1/keys", r#"{"name": "\u0000"}"#),
    ];
    for (path, body) in json_bodies {
        let request = client.post(format!("{}{path}", server.url));
        let request = request
            .header("content-type", "application/json")
            .body(body);
        let answer = send(request).await;
        assert_eq!(answer.status, 422, "{path}: {}", answer.text());
        assert!(
            answer.text().contains("U+0000"),
            "{path}: {}",
            answer.text()
        );
    }
    for path in [
        "/v1/jobs?tag=%00",
        "/v1/maneuvers/a%00b",
        "/v1/models/%00",
        "/v1/mappings/%00",
    ] {
        let answer = send(client.get(format!("{}{path}", server.url))).await;
        assert_eq!(answer.status, 400, "{path}: {}", answer.text());
    }
    let upload = client.post(format!("{}/v1/maneuvers?name=a%00b", server.url));
    let upload = upload.header("content-type", "text/csv").body(elevator());
    assert_eq!(send(upload).await.status, 400);
    let toml = client.post(format!("{}/v1/models", server.url));
    let toml = toml
        .header("content-type", "application/toml")
        .body("title = \"\\u0000\"");
    assert_eq!(send(toml).await.status, 422);
    // a backslash and digits are text like any other
    let harmless = client.post(format!("{}/v1/jobs", server.url));
    let harmless = harmless.header("content-type", "application/json");
    let answer =
        send(harmless.body(r#"{"name": "\\u0000", "model": "short-period", "maneuvers": []}"#))
            .await;
    assert!(!answer.text().contains("U+0000"), "{}", answer.text());
}

#[tokio::test]
async fn no_text_has_the_character_nul_on_a_file() {
    no_text_has_the_character_nul(&Database::file()).await;
}

#[tokio::test]
async fn no_text_has_the_character_nul_on_postgresql() {
    if let Some(database) = Database::postgres("no_text_has_the_character_nul").await {
        no_text_has_the_character_nul(&database).await;
    }
}

#[tokio::test]
async fn an_answer_does_not_repeat_all_that_was_sent() {
    let server = Server::start_with(Config::default(), 0).await;
    let body = json!({"k".repeat(1_000_000): 1});
    let answer = server.post_json("/v1/jobs", &body).await;
    assert_eq!(answer.status, 422);
    assert!(answer.bytes.len() < 10_000, "{} bytes", answer.bytes.len());
}

/// Nobody could come in any more who may make keys.
#[tokio::test]
async fn the_first_key_is_not_made_over_the_network() {
    let server = Server::start_with(Config::default(), 0).await;
    let answer = server
        .post_json("/v1/keys", &json!({"name": "first"}))
        .await;
    answer.problem(409, "no_key_yet");
    assert_eq!(server.get("/v1/jobs").await.status, 200);
}

#[tokio::test]
async fn a_body_that_is_packed_is_not_unpacked() {
    let server = Server::start_with(Config::default(), 0).await;
    let request = server.request(Method::POST, "/v1/jobs");
    let request = request.header("content-type", "application/json");
    let answer = send(request.header("content-encoding", "gzip").body("x")).await;
    answer.problem(415, "unsupported_media_type");
}

/// Bodies that are sent and never ended take no more than the room there is, and it is free again when they are gone.
#[tokio::test]
async fn bodies_that_do_not_end_leave_room_for_others() {
    let config = Config {
        max_maneuver_body: 1_000_000,
        max_json_body: 100_000,
        max_body_memory: 2_200_000,
        ..Config::default()
    };
    let server = Server::start_with(config, 1).await;
    let address = server.url.strip_prefix("http://").unwrap().to_string();
    let mut stuck = Vec::new();
    for _ in 0..3 {
        let mut stream = TcpStream::connect(&address).await.unwrap();
        let head = "POST /v1/maneuvers HTTP/1.1\r\nhost: localhost\r\ncontent-type: text/csv\r\ncontent-length: 950000\r\n\r\n";
        stream.write_all(head.as_bytes()).await.unwrap();
        stream.write_all(&vec![b'1'; 900_000]).await.unwrap();
        stuck.push(stream);
    }
    // one of them finds no room and is told so
    let answers = stuck.iter_mut().map(|stream| {
        Box::pin(async move {
            let mut answer = vec![0; 4096];
            let length = stream.read(&mut answer).await.unwrap();
            String::from_utf8_lossy(&answer[..length]).to_string()
        })
    });
    let (text, ..) = futures_util::future::select_all(answers).await;
    assert!(
        text.starts_with("HTTP/1.1 503") && text.contains("retry-after"),
        "{text}"
    );
    drop(stuck);
    let mut id = None;
    for _ in 0..100 {
        let answer = server.post("/v1/maneuvers", "text/csv", elevator()).await;
        if answer.status.is_success() {
            id = answer.json()["id"].as_str().map(str::to_string);
            break;
        }
        answer.problem(503, "busy");
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    let done = server.submit(&job(&id.expect("room"))).await;
    assert_eq!(server.wait(&done).await["status"], "succeeded");
}

/// The body comes behind the answer, and the connection is good for the next request.
#[tokio::test]
async fn a_body_that_nobody_wants_does_not_end_the_connection() {
    let server = Server::start_with(Config::default(), 0).await;
    let address = server.url.strip_prefix("http://").unwrap();
    let mut stream = TcpStream::connect(address).await.unwrap();
    for _ in 0..20 {
        let head =
            "POST /no/such/route HTTP/1.1\r\nhost: localhost\r\ncontent-length: 100000\r\n\r\n";
        stream.write_all(head.as_bytes()).await.unwrap();
        let mut answer = vec![0; 4096];
        let length = stream.read(&mut answer).await.unwrap();
        let text = String::from_utf8_lossy(&answer[..length]).to_string();
        assert!(text.starts_with("HTTP/1.1 404"), "{text}");
        stream.write_all(&vec![b'x'; 100_000]).await.unwrap();
    }
}

/// Who asks and does not read the answer keeps no connection from others for long.
#[tokio::test]
async fn who_does_not_read_is_hung_up_on() {
    let config = Config {
        max_connections: 2,
        ..Config::default()
    };
    let server = Server::start_with(config, 0).await;
    let address = server.url.strip_prefix("http://").unwrap().to_string();
    let began = Instant::now();
    let mut silent = Vec::new();
    for _ in 0..2 {
        let mut stream = TcpStream::connect(&address).await.unwrap();
        let ask = "GET /docs/swagger-ui-bundle.js HTTP/1.1\r\nhost: localhost\r\n\r\n".repeat(20);
        stream.write_all(ask.as_bytes()).await.unwrap();
        silent.push(stream);
    }
    tokio::time::sleep(Duration::from_secs(1)).await;
    loop {
        let answer = server.get("/v1/jobs").await;
        if answer.status == 200 {
            break;
        }
        assert_eq!(answer.problem(503, "busy"), []);
        assert_eq!(answer.header("retry-after"), "1");
        tokio::time::sleep(Duration::from_millis(500)).await;
    }
    let took = began.elapsed();
    assert!((20..60).contains(&took.as_secs()), "{took:?}");
}

/// A flood of connections shut out everybody, those who watch the service included.
#[tokio::test]
async fn whoever_watches_the_service_is_answered_in_a_flood() {
    let config = Config {
        max_connections: 20,
        max_connections_per_peer: 10,
        ..Config::default()
    };
    let server = Server::start_with(config, 0).await;
    let address = server.url.strip_prefix("http://").unwrap().to_string();
    let mut flood = Vec::new();
    for _ in 0..60 {
        flood.push(TcpStream::connect(&address).await.unwrap());
    }
    tokio::time::sleep(Duration::from_millis(200)).await;
    for path in ["/health/live", "/health/ready"] {
        let asked = Instant::now();
        assert_eq!(server.get(path).await.status, 200, "{path}");
        assert!(asked.elapsed() < Duration::from_secs(2), "{path}");
    }
    assert_eq!(server.get("/v1/jobs").await.problem(503, "busy"), []);
    // of another address there is room: half of the connections are not this peer's
    let port = address.rsplit_once(':').unwrap().1;
    let socket = tokio::net::TcpSocket::new_v4().unwrap();
    socket.bind("127.0.0.77:0".parse().unwrap()).unwrap();
    let mut other = socket
        .connect(format!("127.0.0.1:{port}").parse().unwrap())
        .await
        .unwrap();
    let ask = b"GET /v1/jobs HTTP/1.1\r\nhost: localhost\r\nconnection: close\r\n\r\n";
    other.write_all(ask).await.unwrap();
    let mut answer = Vec::new();
    other.read_to_end(&mut answer).await.unwrap();
    let answer = String::from_utf8_lossy(&answer);
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    // what says nothing is hung up on, and those who come are served again
    drop(flood);
    tokio::time::sleep(Duration::from_millis(500)).await;
    assert_eq!(server.get("/v1/jobs").await.status, 200);
}
