//! The real server on a port of its own, with a database of its own.

use std::path::{Path, PathBuf};

use reqwest::{Method, RequestBuilder, StatusCode};
use serde_json::Value;
use tempfile::TempDir;
use tokio::task::JoinHandle;
use tokio_util::sync::CancellationToken;
use trimtab::{http, store::Store, webhook, work};

/// API and workers in the test's process. It ends with the test.
pub(crate) struct Server {
    pub url: String,
    pub store: Store,
    pub directory: TempDir,
    client: reqwest::Client,
    shutdown: CancellationToken,
    task: JoinHandle<()>,
}

/// What was answered.
#[derive(Debug)]
pub(crate) struct Answer {
    pub status: StatusCode,
    pub headers: reqwest::header::HeaderMap,
    pub bytes: Vec<u8>,
}

impl Server {
    pub(crate) async fn start() -> Self {
        Self::start_with(http::Config::default(), 2).await
    }

    /// With no workers, jobs stay in the queue.
    pub(crate) async fn start_with(
        config: http::Config,
        workers: impl Into<work::Workers>,
    ) -> Self {
        let workers = workers.into();
        let directory = TempDir::new().unwrap();
        let store = Store::open(database(directory.path()).to_str().unwrap())
            .await
            .unwrap();
        let listener = http::bind("127.0.0.1:0", &store).await.unwrap();
        let url = format!("http://{}", listener.local_addr().unwrap());
        let shutdown = CancellationToken::new();
        let [api, jobs, hooks] = [(); 3].map(|()| store.clone());
        let [of_api, of_jobs, of_hooks] = [(); 3].map(|()| shutdown.clone());
        let allowed = config.webhooks.clone();
        let task = tokio::spawn(async move {
            tokio::join!(
                http::run(config, listener, api, of_api),
                work::run(jobs, workers, of_jobs),
                webhook::run(hooks, allowed, of_hooks)
            );
        });
        Self {
            url,
            store,
            directory,
            client: client(),
            shutdown,
            task,
        }
    }

    /// Ends as on SIGTERM.
    pub(crate) async fn stop(mut self) {
        self.shutdown.cancel();
        (&mut self.task).await.unwrap();
    }

    pub(crate) fn request(&self, method: Method, path: &str) -> RequestBuilder {
        self.client.request(method, format!("{}{path}", self.url))
    }

    pub(crate) async fn get(&self, path: &str) -> Answer {
        send(self.request(Method::GET, path)).await
    }

    pub(crate) async fn get_as(&self, path: &str, accept: &str) -> Answer {
        send(self.request(Method::GET, path).header("accept", accept)).await
    }

    pub(crate) async fn post(
        &self,
        path: &str,
        content_type: &str,
        body: impl Into<reqwest::Body>,
    ) -> Answer {
        let request = self.request(Method::POST, path);
        send(request.header("content-type", content_type).body(body)).await
    }

    pub(crate) async fn post_json(&self, path: &str, body: &Value) -> Answer {
        self.post(path, "application/json", body.to_string()).await
    }

    /// Uploads a recording; its id.
    pub(crate) async fn upload(&self, csv: &str) -> String {
        let answer = self
            .post("/v1/maneuvers", "text/csv", csv.to_string())
            .await;
        assert!(answer.status.is_success(), "{answer:?}");
        answer.json()["id"].as_str().unwrap().to_string()
    }

    /// Submits a job; its id.
    pub(crate) async fn submit(&self, spec: &Value) -> String {
        let answer = self.post_json("/v1/jobs", spec).await;
        assert_eq!(answer.status, StatusCode::ACCEPTED, "{}", answer.text());
        answer.json()["id"].as_str().unwrap().to_string()
    }

    /// Waits until a job is over; the job.
    pub(crate) async fn wait(&self, job: &str) -> Value {
        wait(&self.url, job).await
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shutdown.cancel();
    }
}

pub(crate) fn database(directory: &Path) -> PathBuf {
    directory.join("test.db")
}

pub(crate) fn client() -> reqwest::Client {
    // plain HTTP needs no certificates, and a small machine may have none
    webhook::http_client()
        .tls_certs_only([])
        .no_proxy()
        .build()
        .unwrap()
}

pub(crate) async fn send(request: RequestBuilder) -> Answer {
    let response = request.send().await.unwrap();
    let (status, headers) = (response.status(), response.headers().clone());
    Answer {
        status,
        headers,
        bytes: response.bytes().await.unwrap().to_vec(),
    }
}

/// Waits until a job of the server at `url` is over; the job.
pub(crate) async fn wait(url: &str, job: &str) -> Value {
    let client = client();
    for _ in 0..1200 {
        let answer = send(client.get(format!("{url}/v1/jobs/{job}"))).await;
        let job = answer.json();
        if !job["finished"].is_null() {
            return job;
        }
        tokio::time::sleep(std::time::Duration::from_millis(50)).await;
    }
    panic!("job {job} is not over after a minute");
}

impl Answer {
    pub(crate) fn text(&self) -> String {
        String::from_utf8(self.bytes.clone()).unwrap()
    }

    pub(crate) fn json(&self) -> Value {
        serde_json::from_slice(&self.bytes).unwrap_or_else(|_| panic!("no JSON: {}", self.text()))
    }

    pub(crate) fn header(&self, name: &str) -> &str {
        self.headers
            .get(name)
            .map_or("", |value| value.to_str().unwrap())
    }

    /// The faults of a problem with that status and code: pointer and code of each.
    #[track_caller]
    pub(crate) fn problem(&self, status: u16, code: &str) -> Vec<(String, String)> {
        let problem = self.json();
        assert_eq!(self.status.as_u16(), status, "{problem:#}");
        assert_eq!(self.header("content-type"), "application/problem+json");
        assert_eq!(problem["code"], code, "{problem:#}");
        assert_eq!(problem["status"], status);
        assert_eq!(problem["type"], format!("/v1/problems/{code}"));
        assert!(!problem["detail"].as_str().unwrap().is_empty());
        assert_eq!(problem["request_id"], self.header("x-request-id"));
        let text = |fault: &Value, key: &str| fault[key].as_str().unwrap().to_string();
        let faults = problem["errors"].as_array().unwrap().iter();
        faults
            .map(|fault| (text(fault, "pointer"), text(fault, "code")))
            .collect()
    }
}
