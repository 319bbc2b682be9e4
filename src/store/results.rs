//! Results, kept in parts so that a reader loads only what it is asked for.

use serde::{Deserialize, Serialize};
use sqlx::{AnyConnection, Row};
use uuid::Uuid;

use super::reactor::off_reactor;
use super::{Project, StoreError, columns};
use crate::estimate::{Estimate, OutputSeries, Role, Series, TimeHistory};
use crate::job::{JobResult, Maker};

/// A part that is kept as JSON.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// [`crate::estimate::Estimate`].
    Estimate,
    /// [`crate::model::ModelDocument`], as estimated.
    Model,
    /// [`crate::estimate::study::DerivativeStudy`]; only of jobs of that kind.
    Study,
    /// [`crate::diagnose::Diagnosis`]; only of jobs of that kind.
    Diagnosis,
    /// [`crate::structure::Structure`]; only of jobs of that kind.
    Structure,
    /// [`Maker`].
    Maker,
}

impl Part {
    fn name(self) -> &'static str {
        match self {
            Self::Estimate => "estimate",
            Self::Model => "model",
            Self::Study => "study",
            Self::Diagnosis => "diagnosis",
            Self::Structure => "structure",
            Self::Maker => "maker",
        }
    }
}

/// A result, ready to be written.
pub struct ResultParts {
    parts: Box<[(String, Vec<u8>)]>,
    /// JSON of the summary that lists show.
    fit: Option<Box<str>>,
}

impl ResultParts {
    /// Takes as long as the histories are: not for the reactor's threads.
    ///
    /// # Errors
    /// A part has no encoding.
    pub fn encode(result: &JobResult, maker: &Maker) -> Result<Self, StoreError> {
        let unwritable = |error: serde_json::Error| StoreError::Unwritable {
            what: "the result".into(),
            why: error.to_string(),
        };
        let mut parts = vec![
            (
                Part::Estimate.name().to_string(),
                serde_json::to_vec(&result.estimate),
            ),
            (
                Part::Model.name().to_string(),
                serde_json::to_vec(&result.model),
            ),
            (Part::Maker.name().to_string(), serde_json::to_vec(maker)),
        ];
        if let Some(study) = &result.study {
            let study = serde_json::to_vec(study);
            parts.push((Part::Study.name().to_string(), study));
        }
        if let Some(diagnosis) = &result.diagnosis {
            let diagnosis = serde_json::to_vec(diagnosis);
            parts.push((Part::Diagnosis.name().to_string(), diagnosis));
        }
        if let Some(structure) = &result.structure {
            let structure = serde_json::to_vec(structure);
            parts.push((Part::Structure.name().to_string(), structure));
        }
        for (number, history) in result.histories.iter().enumerate() {
            parts.push((history_part(number), encode_history(history)));
        }
        let encoded = parts
            .into_iter()
            .map(|(name, bytes)| bytes.map(|bytes| (name, bytes)));
        let summary = result.estimate.fit_summary();
        let fit = summary.map(|fit| serde_json::to_string(&fit).map(String::into_boxed_str));
        Ok(Self {
            parts: encoded.collect::<Result<_, _>>().map_err(unwritable)?,
            fit: fit.transpose().map_err(unwritable)?,
        })
    }
}

/// The summary of an estimate that is kept; nothing where it cannot be read, or has none.
pub(super) fn fit_of(estimate: &[u8]) -> Option<String> {
    let estimate: Estimate = serde_json::from_slice(estimate).ok()?;
    serde_json::to_string(&estimate.fit_summary()?).ok()
}

fn history_part(number: usize) -> String {
    format!("history/{number:06}")
}

/// What stands beside the numbers of a [`TimeHistory`].
#[derive(Serialize, Deserialize)]
struct HistoryHeader {
    segment: String,
    #[serde(default)]
    role: Role,
    inputs: Vec<SeriesHeader>,
    outputs: Vec<SeriesHeader>,
}

#[derive(Serialize, Deserialize)]
struct SeriesHeader {
    name: String,
    unit: String,
    /// Of an output: whether there is a column of the declared model.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    declared: bool,
}

impl SeriesHeader {
    fn of(name: &str, unit: &str) -> Self {
        Self {
            name: name.to_string(),
            unit: unit.to_string(),
            declared: false,
        }
    }

    fn of_output(series: &OutputSeries) -> Self {
        Self {
            declared: !series.declared.is_empty(),
            ..Self::of(&series.name, &series.unit)
        }
    }

    fn columns(&self) -> usize {
        if self.declared { 4 } else { 3 }
    }
}

/// Columns: time; each input; of each output measured, model, residual, and of a diagnosis the declared model.
fn encode_history(history: &TimeHistory) -> serde_json::Result<Vec<u8>> {
    let header = HistoryHeader {
        segment: history.segment.clone(),
        role: history.role,
        inputs: history
            .inputs
            .iter()
            .map(|s| SeriesHeader::of(&s.name, &s.unit))
            .collect(),
        outputs: history
            .outputs
            .iter()
            .map(SeriesHeader::of_output)
            .collect(),
    };
    let inputs = history.inputs.iter().map(|series| series.values.as_slice());
    let outputs = history.outputs.iter().flat_map(|series| {
        let all = [
            &series.measured,
            &series.model,
            &series.residual,
            &series.declared,
        ];
        let count = SeriesHeader::of_output(series).columns();
        all.into_iter().take(count).map(Vec::as_slice)
    });
    let all: Vec<&[f64]> = std::iter::once(history.time.as_slice())
        .chain(inputs)
        .chain(outputs)
        .collect();
    columns::encode(&header, &all)
}

fn decode_history(bytes: &[u8]) -> Result<TimeHistory, StoreError> {
    let corrupt = |why: String| StoreError::corrupt("a time history", why);
    let (header, columns): (HistoryHeader, _) =
        columns::decode(bytes).map_err(|error| corrupt(error.to_string()))?;
    let of_outputs: usize = header.outputs.iter().map(SeriesHeader::columns).sum();
    if columns.len() != 1 + header.inputs.len() + of_outputs {
        return Err(corrupt(
            "it does not have as many columns as its header says".into(),
        ));
    }
    let mut columns = columns.into_iter();
    // as many as were counted
    let mut next = || columns.next().unwrap_or_default();
    let time = next();
    let inputs = header.inputs.into_iter();
    let inputs = inputs
        .map(|s| Series {
            name: s.name,
            unit: s.unit,
            values: next(),
        })
        .collect();
    let outputs = header.outputs.into_iter().map(|s| OutputSeries {
        name: s.name,
        unit: s.unit,
        measured: next(),
        model: next(),
        residual: next(),
        declared: if s.declared { next() } else { Vec::new() },
    });
    let outputs = outputs.collect();
    Ok(TimeHistory {
        segment: header.segment,
        role: header.role,
        time,
        inputs,
        outputs,
    })
}

pub(super) async fn insert(
    connection: &mut AnyConnection,
    job: Uuid,
    result: &ResultParts,
) -> Result<(), StoreError> {
    for (part, body) in result.parts.iter() {
        sqlx::query("INSERT INTO results (job, part, body) VALUES ($1, $2, $3)")
            .bind(job.to_string())
            .bind(part)
            .bind(body.as_slice())
            .execute(&mut *connection)
            .await?;
    }
    if let Some(fit) = &result.fit {
        sqlx::query("UPDATE jobs SET fit = $2 WHERE id = $1")
            .bind(job.to_string())
            .bind(&**fit)
            .execute(connection)
            .await?;
    }
    Ok(())
}

impl Project {
    /// JSON of a part of a result; `None` where there is no result.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn result_part(&self, job: Uuid, part: Part) -> Result<Option<String>, StoreError> {
        let row = sqlx::query(
            "SELECT body FROM results WHERE job = (SELECT id FROM jobs WHERE id = $1 AND project = $2) AND part = $3",
        )
            .bind(job.to_string())
            .bind(&*self.name)
            .bind(part.name())
            .fetch_optional(&self.store.readers)
            .await?;
        let Some(row) = row else { return Ok(None) };
        let json = String::from_utf8(row.try_get("body")?).map_err(|error| {
            StoreError::corrupt(format!("the {} of job {job}", part.name()), error)
        })?;
        Ok(Some(json))
    }

    /// The time histories of a result, segment by segment; `None` where there is no result.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn histories(&self, job: Uuid) -> Result<Option<Vec<TimeHistory>>, StoreError> {
        let sql = "SELECT body FROM results WHERE job = (SELECT id FROM jobs WHERE id = $1 AND project = $2) \
                   AND part LIKE 'history/%' ORDER BY part";
        let rows = sqlx::query(sql)
            .bind(job.to_string())
            .bind(&*self.name)
            .fetch_all(&self.store.readers)
            .await?;
        // every result has an estimate
        if rows.is_empty() && self.result_part(job, Part::Estimate).await?.is_none() {
            return Ok(None);
        }
        let decode = move || {
            let histories = rows.iter();
            histories
                .map(|row| decode_history(row.try_get("body")?))
                .collect::<Result<_, _>>()
                .map(Some)
        };
        off_reactor("a time history", decode).await
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_history_comes_back_as_it_was() {
        let series = |name: &str| OutputSeries {
            name: name.into(),
            unit: "rad".into(),
            measured: vec![1.0, 2.0],
            model: vec![1.5, 2.5],
            residual: vec![-0.5, -0.5],
            declared: Vec::new(),
        };
        let diagnosed = OutputSeries {
            declared: vec![1.75, 2.75],
            ..series("r")
        };
        let history = TimeHistory {
            segment: "a".into(),
            role: crate::estimate::Role::default(),
            time: vec![0.0, 0.1],
            inputs: vec![Series {
                name: "de".into(),
                unit: "rad".into(),
                values: vec![0.0, 1.0],
            }],
            outputs: vec![series("q"), diagnosed, series("alpha")],
        };
        let bytes = encode_history(&history).unwrap();
        assert_eq!(decode_history(&bytes).unwrap(), history);
        assert!(decode_history(&bytes[..bytes.len() - 8]).is_err());
    }
}
