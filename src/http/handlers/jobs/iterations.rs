//! `/v1/jobs/{id}/iterations`: the course of the solver, read off the log.

use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use super::events::no_store;
use super::job;
use super::results::FormatQuery;
use crate::estimate::Iteration;
use crate::http::answer::format::{Format, choose};
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};
use crate::ingest::CsvWriter;
use crate::job::{EventBody, Prepared};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(list_iterations))
}

/// The iterations of a job's latest attempt.
#[derive(Serialize, ToSchema)]
pub(crate) struct Iterations {
    /// From the start values to the last step.
    #[schema(value_type = Vec<Iteration>)]
    iterations: Vec<serde_json::Map<String, serde_json::Value>>,
}

/// The iterations so far, number 0 being the start value, as JSON or CSV.
#[utoipa::path(get, path = "/v1/jobs/{id}/iterations", tag = "Jobs", operation_id = "listIterations",
    params(("id" = Uuid, Path), FormatQuery),
    responses(
        (status = 200, description = "Those of the latest attempt.", content((Iterations = "application/json"), (String = "text/csv"))),
        (status = 404, description = "`unknown_job`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn list_iterations(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<FormatQuery>,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let format = choose(query.format, &headers, &[Format::Json, Format::Csv])?;
    job::find(&service, id).await?;
    let events = service.store.iterations(id).await?;
    if format == Format::Csv {
        let prepared = prepared(&service, id).await?;
        let iterations = events.iter().map(|event| serde_json::from_str(&event.body));
        let iterations: Vec<EventBody> = iterations.collect::<Result<_, _>>()?;
        let csv = as_csv(&iterations, prepared.as_ref());
        let media_type = HeaderValue::from_static("text/csv; charset=utf-8; header=present");
        return Ok(no_store(
            ([(header::CONTENT_TYPE, media_type)], csv).into_response(),
        ));
    }
    let mut iterations = Vec::new();
    for event in events {
        let mut iteration: serde_json::Map<_, _> = serde_json::from_str(&event.body)?;
        // the event's type; what is left is the iteration
        iteration.shift_remove("type");
        iterations.push(iteration);
    }
    Ok(no_store(
        axum::Json(Iterations { iterations }).into_response(),
    ))
}

/// What the job amounts to, which its log begins with.
async fn prepared(service: &Service, id: Uuid) -> Result<Option<Prepared>, Problem> {
    let log = service.store.events(id, 0, 16).await?;
    let mut bodies = log.entries.iter().rev();
    Ok(
        bodies.find_map(|event| match serde_json::from_str(&event.body) {
            Ok(EventBody::Prepared(prepared)) => Some(prepared),
            _ => None,
        }),
    )
}

/// A row for each iteration; variances by output and parameters by name, in their own units.
fn as_csv(events: &[EventBody], prepared: Option<&Prepared>) -> String {
    let iterations: Vec<&Iteration> = (events.iter())
        .filter_map(|event| match event {
            EventBody::Iteration(iteration) => Some(iteration),
            _ => None,
        })
        .collect();
    let first = iterations.first();
    let named = |names: Option<&Vec<String>>, count: usize, prefix: &str| {
        let name = |place: usize| {
            let number = (place + 1).to_string();
            names
                .and_then(|names| names.get(place))
                .cloned()
                .unwrap_or(number)
        };
        let names = (0..count).map(|place| format!("{prefix}{}", name(place)));
        names.collect::<Vec<String>>()
    };
    let outputs = named(
        prepared.map(|prepared| &prepared.outputs),
        first.map_or(0, |iteration| iteration.variance.len()),
        "variance ",
    );
    let parameters = named(
        prepared.map(|prepared| &prepared.parameters),
        first.map_or(0, |iteration| iteration.parameters.len()),
        "",
    );
    let fixed = [
        "number",
        "cost",
        "det_r",
        "gradient_norm",
        "step",
        "damping",
        "halvings",
    ];
    let fixed = fixed.map(String::from).into_iter();
    let header: Vec<String> = fixed.chain(outputs).chain(parameters).collect();
    let mut csv = CsvWriter::with_header(header.iter().map(String::as_str));
    for iteration in iterations {
        csv.text(&iteration.number.to_string());
        csv.number(iteration.cost);
        csv.number(iteration.det_r);
        csv.number(iteration.gradient_norm);
        csv.number(iteration.step);
        csv.number(iteration.damping);
        csv.text(&iteration.halvings.to_string());
        for value in iteration.variance.iter().chain(&iteration.parameters) {
            csv.number(*value);
        }
        csv.end_row();
    }
    csv.finish()
}
