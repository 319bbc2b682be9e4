//! What the service does, counted, and told in the format of Prometheus.
//!
//! Requests and followers are this process's own; jobs are counted in the store, over all machines.

use std::fmt;
use std::sync::Arc;

use prometheus_client::collector::Collector;
use prometheus_client::encoding::text::encode;
use prometheus_client::encoding::{DescriptorEncoder, EncodeLabelSet, EncodeMetric, NoLabelSet};
use prometheus_client::metrics::MetricType;
use prometheus_client::metrics::counter::{ConstCounter, Counter};
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::{ConstGauge, Gauge};
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::Registry;

use crate::store::{BUCKETS, Census, Histogram as Durations};

/// What this process counts.
#[derive(Clone)]
pub(super) struct Metrics {
    registry: Arc<Registry>,
    requests: Family<Route, Counter>,
    seconds: Family<Route, Histogram, fn() -> Histogram>,
    followers: Gauge,
}

#[derive(Clone, PartialEq, Eq, Hash, Debug, EncodeLabelSet)]
pub(super) struct Route {
    pub method: String,
    /// As it stands in the OpenAPI document; what is in none is one route.
    pub route: String,
    pub status: u16,
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

    /// Counts a request, and how many seconds its answer took.
    pub(super) fn answered(&self, route: &Route, seconds: f64) {
        self.requests.get_or_create(route).inc();
        self.seconds.get_or_create(route).observe(seconds);
    }

    /// Counts a follower until what is returned goes away.
    pub(super) fn follower(&self) -> Follower {
        self.followers.inc();
        Follower(self.followers.clone())
    }

    /// All that was counted, and the jobs, as OpenMetrics text.
    pub(super) fn written(&self, jobs: Census) -> Result<String, fmt::Error> {
        let mut of_jobs = Registry::with_prefix("trimtab");
        of_jobs.register_collector(Box::new(OfJobs(jobs)));
        let mut text = String::new();
        encode(&mut text, &self.registry)?;
        // one document has one end
        let end = text.rfind("# EOF").unwrap_or(text.len());
        text.truncate(end);
        encode(&mut text, &of_jobs)?;
        Ok(text)
    }
}

pub(super) struct Follower(Gauge);

impl Drop for Follower {
    fn drop(&mut self) {
        self.0.dec();
    }
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
