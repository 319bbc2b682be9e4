//! Queries and paths: what cannot be read is a problem like any other.

use axum::extract::{FromRequestParts, Path, Query};
use axum::http::request::Parts;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use utoipa::IntoParams;
use uuid::Uuid;

use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::store::Search;

/// The query of a request.
pub(crate) struct Parameters<T>(pub T);

impl<T: DeserializeOwned, S: Sync> FromRequestParts<S> for Parameters<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        if parts.uri.query().is_some_and(|query| query.contains("%00")) {
            let detail = "the query has the character U+0000 (%00), which is not allowed";
            return Err(Problem::new(Code::InvalidQuery, detail));
        }
        match Query::try_from_uri(&parts.uri) {
            Ok(Query(value)) => Ok(Self(value)),
            Err(rejection) => {
                // its cause is what names the parameter
                let cause = std::error::Error::source(&rejection).map(ToString::to_string);
                let cause = cause.unwrap_or_else(|| rejection.to_string());
                Err(Problem::new(Code::InvalidQuery, cause))
            }
        }
    }
}

/// The `{id}` of a path, as text.
pub(crate) struct Id(pub String);

impl<S: Send + Sync> FromRequestParts<S> for Id {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let path = Path::<String>::from_request_parts(parts, state).await;
        let invalid = |rejection| Problem::new(Code::InvalidPath, format!("{rejection}"));
        let Path(id) = path.map_err(invalid)?;
        if id.contains('\0') {
            let detail = "the path has the character U+0000 (%00), which is not allowed";
            return Err(Problem::new(Code::InvalidPath, detail));
        }
        Ok(Self(id))
    }
}

/// The `{id}` of a job. Text that is no id is the id of no job.
pub(crate) struct JobId(pub Uuid);

impl<S: Send + Sync> FromRequestParts<S> for JobId {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let Id(text) = Id::from_request_parts(parts, state).await?;
        Uuid::parse_str(&text)
            .map(Self)
            .map_err(|_| unknown_job(&text))
    }
}

pub(crate) fn unknown_job(id: impl std::fmt::Display) -> Problem {
    Problem::new(Code::UnknownJob, format!("there is no job '{id}'"))
}

/// Which page of a list.
#[derive(Clone, Debug, Default, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
pub(crate) struct PageQuery {
    /// `next_cursor` of the page before; absent: the first page.
    pub cursor: Option<String>,
    /// Entries of the page, 1 to 200; 50 if absent.
    #[param(minimum = 1, maximum = 200)]
    pub limit: Option<usize>,
}

pub(crate) const PAGE: usize = 50;
pub(crate) const LONGEST_PAGE: usize = 200;

/// The number of entries that a page may have.
pub(crate) fn page_limit(asked: Option<usize>) -> Result<usize, Problem> {
    match asked.unwrap_or(PAGE) {
        limit @ 1..=LONGEST_PAGE => Ok(limit),
        limit => Err(Problem::new(
            Code::InvalidQuery,
            format!("limit: {limit} is not between 1 and {LONGEST_PAGE}"),
        )),
    }
}

/// Of `q`, in characters.
const LONGEST_SEARCH: usize = 200;

/// What a list is searched for; nothing finds everything.
pub(crate) fn search(q: Option<&str>) -> Result<Search, Problem> {
    let text = q.unwrap_or_default();
    if text.chars().count() > LONGEST_SEARCH {
        let detail = format!("q: longer than {LONGEST_SEARCH} characters; search for fewer words");
        return Err(Problem::new(Code::InvalidQuery, detail));
    }
    Ok(Search::of(text))
}

pub(crate) fn bad_cursor(error: crate::store::BadCursor) -> Problem {
    Problem::new(
        Code::InvalidCursor,
        format!("cursor: {error}; begin the list without it"),
    )
}
