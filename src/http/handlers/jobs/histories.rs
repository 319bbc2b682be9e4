//! Residuals and time histories of a finished job.

use axum::http::HeaderMap;
use axum::response::Response;
use serde::{Deserialize, Serialize};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::job;
use super::results;
use crate::estimate::{OutputSeries, Role, Series, TimeHistory};
use crate::http::answer::decimate::{Wanted, pick};
use crate::http::answer::format::{Format, cacheable, choose};
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::ingest::CsvWriter;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(get_residuals))
        .routes(routes!(get_time_histories))
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct HistoryQuery {
    /// Seconds of the recording: only samples from here on.
    #[param(example = 2.0)]
    from: Option<f64>,
    /// Seconds of the recording: only samples up to here.
    #[param(example = 6.5)]
    to: Option<f64>,
    /// About how many samples of each segment to answer with; absent: all. The first, the last, and
    /// the least and greatest of each series in equal stretches of time are kept, so that a plot looks
    /// the same and no peak is lost; `samples` says how many there are.
    #[param(example = 500)]
    max_points: Option<usize>,
    /// `json` or `csv`; absent: as `Accept` says.
    #[param(inline)]
    format: Option<Format>,
}

/// Residuals, measured minus model, SI.
#[derive(Serialize, ToSchema)]
pub(crate) struct Residuals {
    /// In the order of the job.
    segments: Vec<SegmentResiduals>,
}

/// Residuals of one segment.
#[derive(Serialize, ToSchema)]
struct SegmentResiduals {
    /// The segment's label.
    #[schema(example = "elevator")]
    segment: String,
    /// Whether the model was fitted to it.
    role: Role,
    /// Samples of the segment, before `from`, `to` and `max_points`.
    #[schema(example = 751)]
    samples: usize,
    /// Seconds of the recording.
    time: Vec<f64>,
    /// By output, in the order of the model.
    outputs: Vec<Series>,
}

/// Inputs, and outputs as measured and as modelled, SI.
#[derive(Serialize, ToSchema)]
pub(crate) struct TimeHistories {
    /// In the order of the job.
    segments: Vec<SegmentHistory>,
}

/// One segment over time.
#[derive(Serialize, ToSchema)]
struct SegmentHistory {
    /// Samples of the segment, before `from`, `to` and `max_points`.
    #[schema(example = 751)]
    samples: usize,
    #[serde(flatten)]
    history: TimeHistory,
}

/// The residuals of each output, as JSON or CSV.
#[utoipa::path(get, path = "/v1/jobs/{id}/residuals", tag = "Results", operation_id = "getResiduals",
    params(("id" = Uuid, Path), HistoryQuery),
    responses(
        (status = 200, description = "The residuals.", content((Residuals = "application/json"), (String = "text/csv"))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 400, description = "`invalid_query`: `from` or `to` is no number of seconds, or `from` is after `to`.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_residuals(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<HistoryQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    answer(
        &service,
        id,
        &query,
        headers,
        residuals_as_json,
        residuals_as_csv,
    )
    .await
}

/// Inputs and outputs over time, as JSON or CSV.
#[utoipa::path(get, path = "/v1/jobs/{id}/time-histories", tag = "Results", operation_id = "getTimeHistories",
    params(("id" = Uuid, Path), HistoryQuery),
    responses(
        (status = 200, description = "The time histories.", content((TimeHistories = "application/json"), (String = "text/csv"))),
        (status = 304, description = "As the `ETag` in `If-None-Match`."),
        (status = 400, description = "`invalid_query`: `from` or `to` is no number of seconds, or `from` is after `to`.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 404, description = "`unknown_job`, `no_result`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 409, description = "`not_finished`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_time_histories(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<HistoryQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    answer(
        &service,
        id,
        &query,
        headers,
        histories_as_json,
        histories_as_csv,
    )
    .await
}

/// How segments are written: those of the result, thinned, each with its number of samples before.
type Write = fn(Vec<SegmentHistory>) -> Result<Vec<u8>, Problem>;

async fn answer(
    service: &Service,
    id: Uuid,
    query: &HistoryQuery,
    headers: HeaderMap,
    as_json: Write,
    as_csv: Write,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    let wanted = Wanted::of(query.from, query.to, query.max_points)?;
    let Some(histories) = service.store.histories(id).await? else {
        return Err(results::without_result(&job::find(service, id).await?));
    };
    let write = move || {
        let segments = histories
            .into_iter()
            .map(|history| thinned(history, wanted))
            .collect();
        let body = if format == Format::Csv {
            as_csv(segments)
        } else {
            as_json(segments)
        };
        Ok(cacheable(&headers, format, body?))
    };
    service.compute.run(write).await?
}

fn thinned(mut history: TimeHistory, wanted: Wanted) -> SegmentHistory {
    let samples = history.time.len();
    let inputs = history.inputs.iter().map(|series| series.values.as_slice());
    let outputs = history
        .outputs
        .iter()
        .flat_map(|series| {
            [
                &series.measured,
                &series.model,
                &series.residual,
                &series.declared,
            ]
        })
        .filter(|values| !values.is_empty())
        .map(Vec::as_slice);
    let kept = wanted.rows(&history.time, &inputs.chain(outputs).collect::<Vec<_>>());
    if kept.len() == samples {
        return SegmentHistory { samples, history };
    }
    let thin = |values: &mut Vec<f64>| *values = pick(values, &kept);
    thin(&mut history.time);
    for input in &mut history.inputs {
        thin(&mut input.values);
    }
    for OutputSeries {
        measured,
        model,
        residual,
        declared,
        ..
    } in &mut history.outputs
    {
        [measured, model, residual].into_iter().for_each(thin);
        if !declared.is_empty() {
            thin(declared);
        }
    }
    SegmentHistory { samples, history }
}

fn histories_as_json(segments: Vec<SegmentHistory>) -> Result<Vec<u8>, Problem> {
    Ok(serde_json::to_vec(&TimeHistories { segments })?)
}

fn residuals_as_json(segments: Vec<SegmentHistory>) -> Result<Vec<u8>, Problem> {
    let segments = segments
        .into_iter()
        .map(|SegmentHistory { samples, history }| {
            let outputs = history.outputs.into_iter();
            let residual = |s: OutputSeries| Series {
                name: s.name,
                unit: s.unit,
                values: s.residual,
            };
            let outputs = outputs.map(residual).collect();
            SegmentResiduals {
                segment: history.segment,
                role: history.role,
                samples,
                time: history.time,
                outputs,
            }
        });
    Ok(serde_json::to_vec(&Residuals {
        segments: segments.collect(),
    })?)
}

/// All segments have the same inputs and outputs: they come from one model.
fn histories_as_csv(segments: Vec<SegmentHistory>) -> Result<Vec<u8>, Problem> {
    let outputs = segments.iter().flat_map(|segment| &segment.history.outputs);
    let are_declared = { outputs }.any(|output| !output.declared.is_empty());
    let columns = |history: &TimeHistory| {
        let inputs = history.inputs.iter();
        let inputs = inputs.map(|s| (title(&s.name, &s.unit), s.values.clone()));
        let outputs = history.outputs.iter().flat_map(|s| {
            let of = |what: &str| title(&format!("{}_{what}", s.name), &s.unit);
            let declared = are_declared.then(|| (of("declared"), s.declared.clone()));
            let end = [
                (of("model"), s.model.clone()),
                (of("residual"), s.residual.clone()),
            ];
            let begin = [(of("measured"), s.measured.clone())];
            begin.into_iter().chain(declared).chain(end)
        });
        inputs.chain(outputs).collect()
    };
    Ok(as_csv(&segments, columns))
}

fn residuals_as_csv(segments: Vec<SegmentHistory>) -> Result<Vec<u8>, Problem> {
    let columns = |history: &TimeHistory| {
        let outputs = history.outputs.iter();
        outputs
            .map(|s| (title(&s.name, &s.unit), s.residual.clone()))
            .collect()
    };
    Ok(as_csv(&segments, columns))
}

fn as_csv(
    segments: &[SegmentHistory],
    columns: impl Fn(&TimeHistory) -> Vec<(String, Vec<f64>)>,
) -> Vec<u8> {
    let first = segments
        .first()
        .map(|segment| columns(&segment.history))
        .unwrap_or_default();
    let names = first.iter().map(|(name, _)| name.as_str());
    let mut csv = CsvWriter::with_header(["segment", "t[s]"].into_iter().chain(names));
    for SegmentHistory { history, .. } in segments {
        let columns = columns(history);
        for (row, time) in history.time.iter().enumerate() {
            csv.text(&history.segment);
            csv.number(*time);
            for (_, values) in &columns {
                csv.number(values.get(row).copied());
            }
            csv.end_row();
        }
    }
    csv.finish().into_bytes()
}

/// `name[unit]`; a pure number has no unit.
fn title(name: &str, unit: &str) -> String {
    match unit {
        "" | "-" => name.to_string(),
        unit => format!("{name}[{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn history() -> TimeHistory {
        let series = OutputSeries {
            name: "q".into(),
            unit: "rad/s".into(),
            measured: vec![1.0, f64::NAN, 3.0],
            model: vec![1.0, 2.0, 2.0],
            declared: Vec::new(),
            residual: vec![0.0, f64::NAN, 1.0],
        };
        TimeHistory {
            segment: "a".into(),
            role: crate::estimate::Role::default(),
            time: vec![0.0, 0.1, 0.2],
            inputs: vec![Series {
                name: "de".into(),
                unit: "rad".into(),
                values: vec![0.0; 3],
            }],
            outputs: vec![series],
        }
    }

    fn most(rows: usize) -> Wanted {
        Wanted::of(None, None, Some(rows)).expect("all of the time")
    }

    #[test]
    fn csv_has_a_row_for_each_sample() {
        let segments = vec![thinned(history(), most(10))];
        let csv = String::from_utf8(histories_as_csv(segments).unwrap()).unwrap();
        let expected = "segment,t[s],de[rad],q_measured[rad/s],q_model[rad/s],q_residual[rad/s]\n\
                        a,0.0,0.0,1.0,1.0,0.0\na,0.1,0.0,,2.0,\na,0.2,0.0,3.0,2.0,1.0\n";
        assert_eq!(csv, expected);
    }

    /// In a stretch without samples, and in a diagnosis where the first segment has none and the second some.
    #[test]
    fn csv_has_the_same_columns_whatever_is_left() {
        let none = Wanted::of(Some(9.0), None, None).unwrap();
        let header = |segments| {
            let csv = String::from_utf8(histories_as_csv(segments).unwrap()).unwrap();
            csv.lines().next().unwrap().to_string()
        };
        let expected = "segment,t[s],de[rad],q_measured[rad/s],q_model[rad/s],q_residual[rad/s]";
        assert_eq!(header(vec![thinned(history(), none)]), expected);
        let mut later = history();
        later.time = vec![9.0, 9.1, 9.2];
        later.outputs[0].declared = vec![0.5; 3];
        let both = vec![thinned(history(), none), thinned(later, none)];
        let csv = String::from_utf8(histories_as_csv(both).unwrap()).unwrap();
        let (header, rows) = csv.split_once('\n').unwrap();
        assert!(header.contains("q_measured[rad/s],q_declared[rad/s],q_model[rad/s]"));
        let cells = |line: &str| line.split(',').count();
        assert_eq!(
            rows.lines().map(cells).collect::<Vec<_>>(),
            [cells(header); 3]
        );
    }

    #[test]
    fn json_says_how_many_samples_there_were() {
        let mut history = history();
        history.time = (0..100).map(f64::from).collect();
        history.inputs[0].values = vec![0.0; 100];
        let OutputSeries {
            measured,
            model,
            residual,
            ..
        } = &mut history.outputs[0];
        for values in [measured, model, residual] {
            *values = (0..100).map(|k| f64::from(k).sin()).collect();
        }
        let json = residuals_as_json(vec![thinned(history, most(20))]).unwrap();
        let json: serde_json::Value = serde_json::from_slice(&json).unwrap();
        assert_eq!(json["segments"][0]["samples"], 100);
        let kept = json["segments"][0]["time"].as_array().unwrap().len();
        assert!((5..=20).contains(&kept), "{kept}");
    }
}
