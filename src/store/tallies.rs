//! Counts for those that run the service: how long jobs wait and run, and how they end.
//!
//! They are written in the transaction of what they count, by whichever machine, and are read where somebody asks: so they
//! are exact, and stay so over restarts. Of a duration, the count of its bucket and the sum of all are kept.

use sqlx::{AnyConnection, Row};

use super::{Store, StoreError};

/// Upper bounds of the buckets of a duration, s; what is longer is in one more.
pub const BUCKETS: [f64; 12] = [
    0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0,
];

const WAITED: &str = "waited";
const RAN: &str = "ran";
const ENDED: &str = "ended";

/// Durations, as a histogram.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Histogram {
    pub sum: f64,
    /// Of each bucket by itself; the last one has no upper bound.
    pub counts: [u64; BUCKETS.len() + 1],
}

/// The state of the service's work, over all machines and projects.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Census {
    /// Jobs by status, as they are now.
    pub jobs: Vec<(String, u64)>,
    /// Age of the job that has waited longest, s.
    pub oldest_wait: f64,
    /// From submission to the first claim.
    pub waited: Histogram,
    /// From the first claim to the end.
    pub ran: Histogram,
    /// Jobs that ended: how, and of those that failed the code of the first fault.
    pub ended: Vec<(String, u64)>,
}

pub(super) async fn count_wait(
    connection: &mut AnyConnection,
    seconds: f64,
) -> Result<(), StoreError> {
    count(connection, WAITED, &bucket(seconds), seconds).await
}

/// `how` is the status, or of a job that failed the code of its first fault.
pub(super) async fn count_end(
    connection: &mut AnyConnection,
    how: &str,
    ran: Option<f64>,
) -> Result<(), StoreError> {
    if let Some(seconds) = ran {
        count(&mut *connection, RAN, &bucket(seconds), seconds).await?;
    }
    count(connection, ENDED, how, 0.0).await
}

async fn count(
    connection: &mut AnyConnection,
    name: &str,
    label: &str,
    value: f64,
) -> Result<(), StoreError> {
    let sql = "INSERT INTO tallies (name, label, count, sum) VALUES ($1, $2, 1, $3) \
               ON CONFLICT (name, label) DO UPDATE SET count = tallies.count + 1, sum = tallies.sum + excluded.sum";
    sqlx::query(sql)
        .bind(name)
        .bind(label)
        .bind(value)
        .execute(connection)
        .await?;
    Ok(())
}

fn bucket(seconds: f64) -> String {
    BUCKETS
        .partition_point(|bound| *bound < seconds)
        .to_string()
}

impl Store {
    /// # Errors
    /// The database does not answer.
    pub async fn census(&self) -> Result<Census, StoreError> {
        let mut census = Census::default();
        let sql = "SELECT status, COUNT(*) AS jobs FROM jobs GROUP BY status ORDER BY status";
        for row in sqlx::query(sql).fetch_all(&self.readers).await? {
            census
                .jobs
                .push((row.try_get("status")?, unsigned(row.try_get("jobs")?)));
        }
        let sql = "SELECT MIN(created) AS created FROM jobs WHERE status = 'queued'";
        let row = sqlx::query(sql).fetch_one(&self.readers).await?;
        if let Some(created) = row.try_get::<Option<&str>, _>("created")? {
            census.oldest_wait = self.clock.seconds_since(created);
        }
        let sql = "SELECT name, label, count, sum FROM tallies ORDER BY name, label";
        for row in sqlx::query(sql).fetch_all(&self.readers).await? {
            let (label, count): (String, _) =
                (row.try_get("label")?, unsigned(row.try_get("count")?));
            let histogram = match row.try_get::<&str, _>("name")? {
                WAITED => &mut census.waited,
                RAN => &mut census.ran,
                _ => {
                    census.ended.push((label, count));
                    continue;
                }
            };
            histogram.sum += row.try_get::<f64, _>("sum")?;
            let bucket = label
                .parse()
                .ok()
                .and_then(|at: usize| histogram.counts.get_mut(at));
            if let Some(bucket) = bucket {
                *bucket += count;
            }
        }
        Ok(census)
    }
}

fn unsigned(count: i64) -> u64 {
    u64::try_from(count).unwrap_or(0)
}
