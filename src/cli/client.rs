//! A client of a Trimtab server: uploads, jobs, events, results.

use std::path::Path;
use std::time::Duration;

use eventsource_stream::Eventsource;
use futures_util::StreamExt;
use reqwest::header::{AUTHORIZATION, HeaderMap, HeaderValue};
use reqwest::{RequestBuilder, Response, Url};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::Failure;
use super::recording::format_of;
use super::server::ServerOption;
use crate::diagnose::Diagnosis;
use crate::estimate::{Estimate, TimeHistory};
use crate::job::{Event, JobSpec};
use crate::webhook::http_client;

pub(super) struct Client {
    http: reqwest::Client,
    server: Url,
}

/// What of a stored maneuver or job a client needs to go on.
#[derive(Deserialize)]
pub(super) struct Stored {
    pub id: String,
}

/// How often a lost event stream is taken up again before giving up, and after what pause.
const MOST_RECONNECTS: usize = 30;
const RECONNECT_AFTER: Duration = Duration::from_secs(1);

/// Entries that a page of a list may have.
const LONGEST_PAGE: usize = 200;

/// A server that takes longer to say that it is ready is not.
const READY_WITHIN: Duration = Duration::from_secs(4);

impl Client {
    pub(super) fn of(server: &ServerOption) -> Result<Self, Failure> {
        Self::new(&server.url, server.key.as_deref())
    }

    pub(super) fn new(server: &str, key: Option<&str>) -> Result<Self, Failure> {
        let server: Url = server
            .parse()
            .map_err(|error| Failure::new(format!("'{server}' is not a URL: {error}")))?;
        let builder = http_client();
        // without TLS no certificates are needed, and a small image may have none
        let builder = if server.scheme() == "http" {
            builder.tls_certs_only([])
        } else {
            builder
        };
        let mut headers = HeaderMap::new();
        if let Some(key) = key {
            let mut value = HeaderValue::try_from(format!("Bearer {key}"))
                .map_err(|_| Failure::new("the key has characters that keys do not have"))?;
            value.set_sensitive(true);
            headers.insert(AUTHORIZATION, value);
        }
        let http = builder
            .default_headers(headers)
            .build()
            .map_err(|error| Failure::new(format!("the HTTP client cannot be set up: {error}")))?;
        Ok(Self { http, server })
    }

    pub(super) fn url(&self, path: &str) -> Result<Url, Failure> {
        self.server
            .join(path)
            .map_err(|error| Failure::new(format!("{path}: {error}")))
    }

    /// Fails unless the server can serve requests, and says so in time.
    pub(super) async fn ready(&self) -> Result<(), Failure> {
        let url = self.url("/health/ready")?;
        self.send(self.http.get(url).timeout(READY_WITHIN)).await?;
        Ok(())
    }

    /// Uploads a recording, with the mapping that it may need; the same one again is no harm.
    pub(super) async fn upload<T: DeserializeOwned>(
        &self,
        name: &str,
        file: &Path,
        mapping: Option<&str>,
        bytes: Vec<u8>,
    ) -> Result<T, Failure> {
        let mut url = self.url("/v1/maneuvers")?;
        url.query_pairs_mut().append_pair("name", name);
        if let Some(mapping) = mapping {
            url.query_pairs_mut().append_pair("mapping", mapping);
        }
        let request = self
            .http
            .post(url)
            .header("content-type", format_of(file).content_type())
            .body(bytes);
        json(self.send(request).await?).await
    }

    /// A page of the recordings that are wanted.
    pub(super) async fn maneuvers<T: DeserializeOwned>(
        &self,
        wanted: &[(&str, &str)],
    ) -> Result<T, Failure> {
        let mut url = self.url("/v1/maneuvers")?;
        url.query_pairs_mut().extend_pairs(wanted);
        json(self.send(self.http.get(url)).await?).await
    }

    pub(super) async fn maneuver<T: DeserializeOwned>(&self, id: &str) -> Result<T, Failure> {
        let url = self.url(&format!("/v1/maneuvers/{id}"))?;
        json(self.send(self.http.get(url)).await?).await
    }

    /// Changes what is said of a recording, by a merge patch.
    pub(super) async fn change_maneuver<T: DeserializeOwned>(
        &self,
        id: &str,
        change: &Value,
    ) -> Result<T, Failure> {
        let url = self.url(&format!("/v1/maneuvers/{id}"))?;
        json(self.send(self.http.patch(url).json(change)).await?).await
    }

    pub(super) async fn submit(&self, spec: &JobSpec) -> Result<Stored, Failure> {
        json(
            self.send(self.http.post(self.url("/v1/jobs")?).json(spec))
                .await?,
        )
        .await
    }

    /// Entries of a list under `/v1`, page by page, at most so many.
    pub(super) async fn list(
        &self,
        name: &str,
        wanted: &[(&str, Option<&str>)],
        most: usize,
    ) -> Result<Vec<Value>, Failure> {
        let mut entries = Vec::new();
        let mut cursor: Option<String> = None;
        while entries.len() < most {
            let mut url = self.url(&format!("/v1/{name}"))?;
            let limit = (most - entries.len()).min(LONGEST_PAGE).to_string();
            let paging = [
                ("limit", Some(limit.as_str())),
                ("cursor", cursor.as_deref()),
            ];
            let given = wanted.iter().copied().chain(paging);
            url.query_pairs_mut()
                .extend_pairs(given.filter_map(|(name, value)| Some((name, value?))));
            let mut page: Value = json(self.send(self.http.get(url)).await?).await?;
            if let Some(Value::Array(more)) = page.get_mut(name).map(Value::take) {
                entries.extend(more);
            }
            cursor = page["next_cursor"].as_str().map(str::to_string);
            if cursor.is_none() {
                break;
            }
        }
        Ok(entries)
    }

    /// What is at a path under `/v1`, as it is sent.
    pub(super) async fn text(
        &self,
        path: &str,
        wanted: &[(&str, &str)],
    ) -> Result<String, Failure> {
        let mut url = self.url(&format!("/v1/{path}"))?;
        if !wanted.is_empty() {
            url.query_pairs_mut().extend_pairs(wanted);
        }
        let text = self.send(self.http.get(url)).await?.text().await;
        text.map_err(|error| Failure::new(format!("the server's answer cannot be read: {error}")))
    }

    /// Asks for something to be done at a path under `/v1`.
    pub(super) async fn post(&self, path: &str) -> Result<Value, Failure> {
        let url = self.url(&format!("/v1/{path}"))?;
        json(self.send(self.http.post(url)).await?).await
    }

    pub(super) async fn delete(&self, path: &str) -> Result<(), Failure> {
        let url = self.url(&format!("/v1/{path}"))?;
        self.send(self.http.delete(url)).await?;
        Ok(())
    }

    /// Stores a model document.
    pub(super) async fn add_model(
        &self,
        media_type: &'static str,
        document: String,
    ) -> Result<Stored, Failure> {
        let url = self.url("/v1/models")?;
        let request = self.http.post(url).header("content-type", media_type);
        json(self.send(request.body(document)).await?).await
    }

    pub(super) async fn estimate(&self, job: &str) -> Result<Estimate, Failure> {
        let url = self.url(&format!("/v1/jobs/{job}/estimate"))?;
        json(self.send(self.http.get(url)).await?).await
    }

    /// Of a job of the kind `diagnose` that came to its end.
    pub(super) async fn diagnosis(&self, job: &str) -> Result<Diagnosis, Failure> {
        let url = self.url(&format!("/v1/jobs/{job}/diagnosis"))?;
        json(self.send(self.http.get(url)).await?).await
    }

    /// Inputs and outputs over time, of each flight about so many samples.
    pub(super) async fn histories(
        &self,
        job: &str,
        most: usize,
    ) -> Result<Vec<TimeHistory>, Failure> {
        #[derive(serde::Deserialize)]
        struct Histories {
            segments: Vec<TimeHistory>,
        }
        let url = self.url(&format!("/v1/jobs/{job}/time-histories?max_points={most}"))?;
        let histories: Histories = json(self.send(self.http.get(url)).await?).await?;
        Ok(histories.segments)
    }

    /// Two or more finished jobs, side by side.
    pub(super) async fn compare<T: DeserializeOwned>(&self, jobs: &[String]) -> Result<T, Failure> {
        let mut url = self.url("/v1/compare")?;
        url.query_pairs_mut().append_pair("jobs", &jobs.join(","));
        json(self.send(self.http.get(url)).await?).await
    }

    pub(super) async fn spec(&self, job: &str) -> Result<JobSpec, Failure> {
        let url = self.url(&format!("/v1/jobs/{job}/spec"))?;
        json(self.send(self.http.get(url)).await?).await
    }

    /// Hands every event of a job to `sink`, from the first to the last, each once, over lost connections.
    pub(super) async fn follow(
        &self,
        job: &str,
        mut sink: impl FnMut(&Event),
    ) -> Result<(), Failure> {
        let url = self.url(&format!("/v1/jobs/{job}/events"))?;
        let mut seen = 0;
        let mut failures = 0;
        loop {
            let request = self
                .http
                .get(url.clone())
                .header("accept", "text/event-stream");
            let request = if seen > 0 {
                request.header("last-event-id", seen.to_string())
            } else {
                request
            };
            match request.send().await {
                Ok(response) if response.status().is_server_error() => {}
                Ok(response) => {
                    let mut stream = accepted(response).await?.bytes_stream().eventsource();
                    while let Some(Ok(message)) = stream.next().await {
                        let event: Event =
                            serde_json::from_str(&message.data).map_err(|error| {
                                Failure::new(format!("an event cannot be read: {error}"))
                            })?;
                        seen = event.seq;
                        failures = 0;
                        sink(&event);
                        if event.body.is_last() {
                            return Ok(());
                        }
                    }
                }
                Err(error) if failures == MOST_RECONNECTS => {
                    return Err(Failure::new(unreachable(&error)));
                }
                Err(_) => {}
            }
            failures += 1;
            tokio::time::sleep(RECONNECT_AFTER).await;
        }
    }

    async fn send(&self, request: RequestBuilder) -> Result<Response, Failure> {
        let response = request
            .send()
            .await
            .map_err(|error| Failure::new(unreachable(&error)))?;
        accepted(response).await
    }
}

/// An id as it stands in a path, whatever letters somebody gave it.
pub(super) fn in_path(id: &str) -> String {
    let encoded: String = form_urlencoded::byte_serialize(id.as_bytes()).collect();
    encoded.replace('+', "%20")
}

fn unreachable(error: &reqwest::Error) -> String {
    use std::error::Error;
    let mut cause: &dyn Error = error;
    while let Some(deeper) = cause.source() {
        cause = deeper;
    }
    format!(
        "the server does not answer: {error} ({cause}); start one with `trimtab serve`, or name it with --server"
    )
}

/// The response, or what the server's problem document says.
async fn accepted(response: Response) -> Result<Response, Failure> {
    let status = response.status();
    if status.is_success() {
        return Ok(response);
    }
    let problem: Value = response.json().await.unwrap_or(Value::Null);
    let faults: Vec<String> = problem["errors"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|fault| {
            let text = |key: &str| fault[key].as_str().unwrap_or("").to_string();
            match text("pointer").as_str() {
                "" => text("message"),
                pointer => format!("{pointer}: {}", text("message")),
            }
        })
        .collect();
    // the detail tells the first fault, which is among them
    let members = match faults.is_empty() {
        true => ["detail", "title"],
        false => ["title", "detail"],
    };
    let said = { members.iter() }.find_map(|member| problem[*member].as_str());
    let what = format!(
        "the server answers {status}: {}",
        said.unwrap_or("no explanation")
    );
    Err(match faults.is_empty() {
        true => Failure::new(what),
        false => Failure::faults(&what, &faults),
    })
}

async fn json<T: DeserializeOwned>(response: Response) -> Result<T, Failure> {
    response
        .json()
        .await
        .map_err(|error| Failure::new(format!("the server's answer cannot be read: {error}")))
}
