//! What can go wrong, as documentation: the `type` of every problem leads here.

use axum::Json;
use serde::Serialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::flight::{FindingCode, Severity};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::Id;
use crate::http::service::Server;
use crate::ingest;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(list_problems))
        .routes(routes!(get_problem))
}

/// One code.
#[derive(Serialize, ToSchema)]
pub(crate) struct Explanation {
    /// The stable word.
    #[schema(example = "not_finished")]
    code: &'static str,
    /// The HTTP status that it comes with.
    #[schema(example = 409)]
    status: u16,
    /// The code in words.
    #[schema(example = "The job is not finished")]
    title: &'static str,
    /// What is meant, and what would put it right.
    #[schema(example = "The job is not over yet. Follow its events, and ask again when it is.")]
    meaning: &'static str,
}

impl Explanation {
    fn of(code: Code) -> Self {
        let (status, title) = (code.status().as_u16(), code.title());
        Self {
            code: code.name(),
            status,
            title,
            meaning: code.meaning(),
        }
    }
}

/// One code of an entry of `errors`.
#[derive(Serialize, ToSchema)]
pub(crate) struct FaultExplanation {
    /// The stable word.
    #[schema(example = "time_not_increasing")]
    code: &'static str,
    /// What is meant.
    #[schema(example = "Time does not increase.")]
    meaning: &'static str,
}

/// All codes that the API has.
#[derive(Serialize, ToSchema)]
pub(crate) struct Explanations {
    /// What `code` of a problem can be.
    problems: Vec<Explanation>,
    /// What `code` of an entry of `errors` can be where a recording is refused.
    recording_faults: Vec<FaultExplanation>,
    /// What `code` of a finding can be: of a recording, of a job's use of it, of a fit.
    findings: Vec<FindingExplanation>,
}

/// One code of a finding.
#[derive(Serialize, ToSchema)]
pub(crate) struct FindingExplanation {
    /// The stable word.
    #[schema(example = "gap")]
    code: &'static str,
    /// Where nothing lessens it.
    severity: Severity,
    /// What is meant.
    #[schema(example = "The recording stopped and started again.")]
    meaning: &'static str,
}

/// All codes that a problem can have.
#[utoipa::path(get, path = "/v1/problems", tag = "Problems", operation_id = "listProblems",
    responses((status = 200, description = "The table of codes.", body = Explanations)))]
async fn list_problems() -> Json<Explanations> {
    let faults = ingest::code::ALL.iter();
    Json(Explanations {
        problems: Code::ALL.iter().copied().map(Explanation::of).collect(),
        recording_faults: faults
            .map(|&(code, meaning)| FaultExplanation { code, meaning })
            .collect(),
        findings: (FindingCode::ALL.iter())
            .map(|code| FindingExplanation {
                code: code.name(),
                severity: code.severity(),
                meaning: code.meaning(),
            })
            .collect(),
    })
}

/// What a code means.
#[utoipa::path(get, path = "/v1/problems/{code}", tag = "Problems", operation_id = "getProblem",
    params(("code" = String, Path, example = "not_finished")),
    responses(
        (status = 200, description = "The code.", body = Explanation),
        (status = 404, description = "`unknown_code`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn get_problem(Id(code): Id) -> Result<Json<Explanation>, Problem> {
    let known = Code::find(&code).map(Explanation::of).map(Json);
    known.ok_or_else(|| Problem::new(Code::UnknownCode, format!("there is no code '{code}'")))
}
