//! `/metrics`: what the service does, in the format of Prometheus.
//!
//! Requests and followers are this process's own; jobs are counted in the store, over all machines.

use std::fmt;
use std::sync::Arc;
use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::http::header;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use prometheus_client::collector::Collector;
use prometheus_client::encoding::text::encode;
use prometheus_client::encoding::{DescriptorEncoder, EncodeLabelSet, EncodeMetric, NoLabelSet};
use prometheus_client::metrics::MetricType;
use prometheus_client::metrics::counter::{ConstCounter, Counter};
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::{ConstGauge, Gauge};
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::Registry;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::Server;
use super::problem::Problem;
use crate::store::{BUCKETS, Census, Histogram as Durations};

pub(super) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(get_metrics))
}

const MEDIA_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// What this process counts.
#[derive(Clone)]
pub(super) struct Metrics {
    registry: Arc<Registry>,
    requests: Family<Route, Counter>,
    seconds: Family<Route, Histogram, fn() -> Histogram>,
    followers: Gauge,
}

#[derive(Clone, PartialEq, Eq, Hash, Debug, EncodeLabelSet)]
struct Route {
    method: String,
    /// As it stands in the OpenAPI document; what is in none is one route.
    route: String,
    status: u16,
}

impl Metrics {
    pub(super) fn new() -> Self {
        let mut registry = Registry::with_prefix("trimtab");
        let requests = Family::default();
        let buckets: fn() -> Histogram = || Histogram::new(BUCKETS);
        let seconds = Family::new_with_constructor(buckets);
        let followers = Gauge::default();
        let say = "Requests that were answered";
        registry.register("http_requests", say, requests.clone());
        let say = "Time to the head of the answer";
        registry.register("http_request_seconds", say, seconds.clone());
        let say = "Clients that follow the events of a job now";
        registry.register("event_streams", say, followers.clone());
        Self {
            registry: Arc::new(registry),
            requests,
            seconds,
            followers,
        }
    }

    /// Counts a follower until what is returned goes away.
    pub(super) fn follower(&self) -> Follower {
        self.followers.inc();
        Follower(self.followers.clone())
    }
}

pub(super) struct Follower(Gauge);

impl Drop for Follower {
    fn drop(&mut self) {
        self.0.dec();
    }
}

/// Counts every request.
pub(super) async fn count(State(server): State<Server>, request: Request, next: Next) -> Response {
    let began = Instant::now();
    let route = request.extensions().get::<MatchedPath>();
    let route = route.map_or("none", MatchedPath::as_str).to_string();
    // methods are anybody's invention: only those that are known become a label
    let method = match request.method().as_str() {
        known @ ("GET" | "POST" | "DELETE" | "HEAD" | "OPTIONS") => known,
        _ => "other",
    };
    let method = method.to_string();
    let response = next.run(request).await;
    let route = Route {
        method,
        route,
        status: response.status().as_u16(),
    };
    let metrics = &server.metrics;
    metrics.requests.get_or_create(&route).inc();
    let seconds = began.elapsed().as_secs_f64();
    metrics.seconds.get_or_create(&route).observe(seconds);
    response
}

/// What the service does, for Prometheus.
///
/// Requests and event streams are those of this process; jobs are those of all machines: how many there are by status, how
/// long they wait and run, and how they ended (of those that failed, the code of the fault).
#[utoipa::path(get, path = "/metrics", tag = "Operations", operation_id = "getMetrics",
    responses((status = 200, description = "OpenMetrics text.", body = String, content_type = "application/openmetrics-text")))]
async fn get_metrics(State(server): State<Server>) -> Result<Response, Problem> {
    let mut of_jobs = Registry::with_prefix("trimtab");
    of_jobs.register_collector(Box::new(OfJobs(server.store.census().await?)));
    let mut text = String::new();
    encode(&mut text, &server.metrics.registry).map_err(unwritten)?;
    // one document has one end
    let end = text.rfind("# EOF").unwrap_or(text.len());
    text.truncate(end);
    encode(&mut text, &of_jobs).map_err(unwritten)?;
    Ok(([(header::CONTENT_TYPE, MEDIA_TYPE)], text).into_response())
}

fn unwritten(error: fmt::Error) -> Problem {
    tracing::error!(%error, "metrics");
    Problem::internal()
}

#[derive(Debug)]
struct OfJobs(Census);

impl Collector for OfJobs {
    fn encode(&self, mut encoder: DescriptorEncoder) -> Result<(), fmt::Error> {
        let census = &self.0;
        let say = "Jobs that there are, by status.";
        let mut jobs = encoder.encode_descriptor("jobs", say, None, MetricType::Gauge)?;
        for (status, count) in &census.jobs {
            let labels = [("status", status.as_str())];
            let count = i64::try_from(*count).unwrap_or(i64::MAX);
            ConstGauge::new(count).encode(jobs.encode_family(&labels)?)?;
        }
        let say = "Age of the job that has waited longest.";
        let oldest =
            encoder.encode_descriptor("queue_oldest_seconds", say, None, MetricType::Gauge)?;
        ConstGauge::new(census.oldest_wait).encode(oldest)?;
        let say = "Time from a job's submission to its first claim.";
        durations(&mut encoder, "job_wait_seconds", say, &census.waited)?;
        let say = "Time from a job's first claim to its end.";
        durations(&mut encoder, "job_run_seconds", say, &census.ran)?;
        let say = "Jobs that ended, by how: a status, or the code of a failure.";
        let mut ended = encoder.encode_descriptor("jobs_ended", say, None, MetricType::Counter)?;
        for (how, count) in &census.ended {
            let labels = [("how", how.as_str())];
            ConstCounter::new(*count).encode(ended.encode_family(&labels)?)?;
        }
        Ok(())
    }
}

fn durations(
    encoder: &mut DescriptorEncoder,
    name: &str,
    say: &str,
    durations: &Durations,
) -> Result<(), fmt::Error> {
    let bounds = BUCKETS.into_iter().chain([f64::INFINITY]);
    let buckets: Vec<(f64, u64)> = bounds.zip(durations.counts).collect();
    let count = durations.counts.iter().sum();
    let mut metric = encoder.encode_descriptor(name, say, None, MetricType::Histogram)?;
    metric.encode_histogram::<NoLabelSet>(durations.sum, count, &buckets, None)
}
