//! Maneuvers, identified by what is in them.

use std::collections::HashMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sqlx::any::AnyRow;
use sqlx::{AssertSqlSafe, Row};

use super::reactor::off_reactor;
use super::search::{Search, words_of_maneuver};
use super::{Project, StoreError, columns};
use crate::flight::{Channel, Flown, Maneuver, Unit};

/// A maneuver without its data.
#[derive(Clone, PartialEq, Debug)]
pub struct ManeuverRecord {
    /// [`Maneuver::digest`].
    pub id: String,
    pub name: String,
    pub created: String,
    /// JSON, as it was given.
    pub summary: String,
    /// What was flown, as it was said last.
    pub flown: Flown,
}

/// Which maneuvers a list shows; `None` shows all.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct ManeuverFilter {
    pub tag: Option<String>,
    pub aircraft: Option<String>,
    pub registration: Option<String>,
    pub flight: Option<String>,
    pub test_point: Option<String>,
    /// In its name, tags, notes, or what else was said of the flight in words.
    pub search: Search,
}

/// What an upload amounted to.
#[derive(Clone, PartialEq, Debug)]
pub enum Uploaded {
    New(ManeuverRecord),
    /// The same content was here before, under the name it had then.
    Known(ManeuverRecord),
}

/// Why a recording was not loaded, with its place among those that were asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum NotLoaded {
    Unknown(usize),
    /// With it, what was loaded would be too much.
    TooMuch(usize),
}

/// What stands beside the numbers of a maneuver. The numbers are SI; `unit` tells what they measure.
#[derive(Serialize, Deserialize)]
struct Header {
    channels: Vec<ChannelHeader>,
}

#[derive(Serialize, Deserialize)]
struct ChannelHeader {
    name: String,
    recorded_unit: String,
}

fn encode(maneuver: &Maneuver) -> serde_json::Result<Vec<u8>> {
    let channels = maneuver
        .channels()
        .iter()
        .map(|(name, channel)| ChannelHeader {
            name: name.clone(),
            recorded_unit: channel.recorded_unit.clone(),
        });
    let header = Header {
        channels: channels.collect(),
    };
    let values = maneuver
        .channels()
        .values()
        .map(|channel| channel.values.as_slice());
    let columns: Vec<&[f64]> = std::iter::once(maneuver.time()).chain(values).collect();
    columns::encode(&header, &columns)
}

fn decode(id: &str, bytes: &[u8]) -> Result<Maneuver, StoreError> {
    let corrupt = |why: String| StoreError::corrupt(format!("maneuver {id}"), why);
    let (header, columns): (Header, _) =
        columns::decode(bytes).map_err(|error| corrupt(error.to_string()))?;
    if columns.len() != 1 + header.channels.len() {
        return Err(corrupt(
            "it does not have as many columns as its header says".into(),
        ));
    }
    let mut columns = columns.into_iter();
    let time = columns.next().unwrap_or_default();
    let channels = header
        .channels
        .into_iter()
        .zip(columns)
        .map(|(header, values)| {
            let unit =
                Unit::parse(&header.recorded_unit).map_err(|error| corrupt(error.to_string()))?;
            Ok((
                header.name,
                Channel {
                    recorded_unit: header.recorded_unit,
                    unit,
                    values,
                },
            ))
        });
    let channels = channels.collect::<Result<_, StoreError>>()?;
    Maneuver::new(time, channels).map_err(|error| corrupt(error.to_string()))
}

/// What is read of a maneuver.
pub(super) const COLUMNS: &str = "id, name, created, summary, flown";

pub(super) fn read_record(row: &AnyRow) -> Result<ManeuverRecord, StoreError> {
    let id: String = row.try_get("id")?;
    let flown = serde_json::from_str(row.try_get("flown")?)
        .map_err(|error| StoreError::corrupt(format!("maneuver {id}"), error))?;
    Ok(ManeuverRecord {
        id,
        flown,
        name: row.try_get("name")?,
        created: row.try_get("created")?,
        summary: row.try_get("summary")?,
    })
}

impl Project {
    /// Keeps a maneuver, if it is not here already. `summary` is JSON for lists.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn add_maneuver(
        &self,
        name: &str,
        maneuver: Arc<Maneuver>,
        summary: String,
    ) -> Result<Uploaded, StoreError> {
        let (id, content) = off_reactor("a maneuver", move || {
            let content = encode(&maneuver).map_err(|error| StoreError::Unwritable {
                what: "the maneuver".into(),
                why: error.to_string(),
            })?;
            Ok((maneuver.digest(), content))
        })
        .await?;
        let record = ManeuverRecord {
            id,
            name: name.to_string(),
            created: self.store.clock.now_text(),
            summary,
            flown: Flown::default(),
        };
        let sql = "INSERT INTO maneuvers (project, id, name, created, summary, content, bytes, words) \
                   VALUES ($1, $2, $3, $4, $5, $6, $7, $8) ON CONFLICT (project, id) DO NOTHING";
        let bytes = i64::try_from(content.len()).unwrap_or(i64::MAX);
        let inserted = sqlx::query(sql)
            .bind(&*self.name)
            .bind(&record.id)
            .bind(&record.name)
            .bind(&record.created)
            .bind(&record.summary)
            .bind(content)
            .bind(bytes)
            .bind(words_of_maneuver(name, &record.flown))
            .execute(&self.store.writer)
            .await?;
        if inserted.rows_affected() > 0 {
            return Ok(Uploaded::New(record));
        }
        let known = self.maneuver(&record.id).await?;
        known
            .map(Uploaded::Known)
            .ok_or_else(|| StoreError::corrupt("a maneuver", "it vanished"))
    }

    /// Bytes that the maneuvers of the project take.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn stored_bytes(&self) -> Result<u64, StoreError> {
        let sql = "SELECT CAST(COALESCE(SUM(bytes), 0) AS BIGINT) AS bytes FROM maneuvers WHERE project = $1";
        let row = sqlx::query(sql)
            .bind(&*self.name)
            .fetch_one(&self.store.readers)
            .await?;
        Ok(u64::try_from(row.try_get::<i64, _>("bytes")?).unwrap_or(0))
    }

    /// # Errors
    /// The database does not answer.
    pub async fn maneuver(&self, id: &str) -> Result<Option<ManeuverRecord>, StoreError> {
        // safe: put together from a constant
        let sql = format!("SELECT {COLUMNS} FROM maneuvers WHERE project = $1 AND id = $2");
        let row = sqlx::query(AssertSqlSafe(sql))
            .bind(&*self.name)
            .bind(id)
            .fetch_optional(&self.store.readers)
            .await?;
        row.as_ref().map(read_record).transpose()
    }

    /// The recording itself.
    ///
    /// # Errors
    /// The database does not answer, or what it keeps was damaged.
    pub async fn maneuver_data(&self, id: &str) -> Result<Option<Maneuver>, StoreError> {
        let row = sqlx::query("SELECT content FROM maneuvers WHERE project = $1 AND id = $2")
            .bind(&*self.name)
            .bind(id)
            .fetch_optional(&self.store.readers)
            .await?;
        let Some(row) = row else { return Ok(None) };
        let id = id.to_string();
        let decode = move || decode(&id, row.try_get("content")?);
        off_reactor("a maneuver", decode).await.map(Some)
    }

    /// Recordings in the order of `ids`, each read once, or why some are not there. Beyond `most_values` (samples times
    /// channels, time included) no more are read.
    ///
    /// # Errors
    /// As [`Project::maneuver_data`].
    pub async fn load(
        &self,
        ids: &[&str],
        most_values: usize,
    ) -> Result<Result<Vec<Arc<Maneuver>>, Vec<NotLoaded>>, StoreError> {
        let mut known: HashMap<&str, Arc<Maneuver>> = HashMap::new();
        let (mut loaded, mut missing, mut values) = (Vec::new(), Vec::new(), 0);
        for (place, &id) in ids.iter().enumerate() {
            // parts of one recording are often used side by side
            if let Some(maneuver) = known.get(id) {
                loaded.push(maneuver.clone());
                continue;
            }
            let Some(maneuver) = self.maneuver_data(id).await? else {
                missing.push(NotLoaded::Unknown(place));
                continue;
            };
            values += maneuver.len() * (1 + maneuver.channels().len());
            if values > most_values {
                missing.push(NotLoaded::TooMuch(place));
                break;
            }
            let maneuver = Arc::new(maneuver);
            known.insert(id, maneuver.clone());
            loaded.push(maneuver);
        }
        Ok(if missing.is_empty() {
            Ok(loaded)
        } else {
            Err(missing)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_maneuver_keeps_its_digest() {
        let deg = Unit::parse("deg").unwrap();
        let channels = [
            (
                "q".to_string(),
                Channel::from_recorded("deg", deg, vec![1.0, f64::NAN, 3.0]),
            ),
            (
                "alpha".to_string(),
                Channel::from_recorded("deg", deg, vec![0.1, -0.0, 1e-300]),
            ),
        ];
        let maneuver = Maneuver::new(vec![0.0, 0.1, 0.2], channels.into()).unwrap();
        let decoded = decode("x", &encode(&maneuver).unwrap()).unwrap();
        assert_eq!(decoded.digest(), maneuver.digest());
        assert!(decoded.channels().keys().eq(["q", "alpha"]));
    }
}
