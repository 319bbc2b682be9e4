//! `/v1/keys`: the keys of the caller's project. The first one is made with `trimtab key new`.

use std::collections::BTreeSet;
use std::time::Duration;

use axum::Json;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use crate::http::caller::Caller;
use crate::http::code::Code;
use crate::http::middleware::once::NewId;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::Id;
use crate::http::service::{Server, Service};
use crate::job::{Fault, HIGHEST_PRIORITY};
use crate::store::{Key, KeyRecord, NewKey, Scope};

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(list_keys, make_key))
        .routes(routes!(revoke_key))
        .routes(routes!(rotate_key))
}

const LONGEST_NAME: usize = 200;
const LONGEST_DAYS: u32 = 3650;
const LONGEST_OVERLAP_HOURS: u32 = 24 * 30;

/// A key without its secret.
#[derive(Serialize, ToSchema)]
#[schema(as = Key)]
struct KeyResource {
    /// Under which it is rotated and revoked.
    id: Uuid,
    /// The project that it opens.
    #[schema(example = "icing")]
    project: String,
    /// What it is used by, for people.
    #[schema(example = "data pipeline of the lab")]
    name: String,
    /// What it allows.
    scopes: BTreeSet<Scope>,
    /// The highest priority of jobs that are submitted with it.
    max_priority: i32,
    /// When it was made, RFC 3339.
    created: String,
    /// From when on it is no longer good; `null`: never.
    expires: Option<String>,
    /// When it was revoked; `null`: it was not.
    revoked: Option<String>,
    /// When it was last used, to ten minutes.
    used: Option<String>,
}

impl KeyResource {
    fn of(key: KeyRecord) -> Self {
        Self {
            id: key.id,
            project: key.project,
            name: key.name,
            scopes: key.scopes,
            max_priority: key.max_priority,
            created: key.created,
            expires: key.expires,
            revoked: key.revoked,
            used: key.used,
        }
    }
}

/// A key that was made just now.
#[derive(Serialize, ToSchema)]
struct MadeKey {
    /// The secret. It is shown this once and kept nowhere: absent where a request is answered again (`Idempotency-Key`).
    #[schema(required = false, example = "trimtab_2f6c…")]
    secret: String,
    #[serde(flatten)]
    key: KeyResource,
}

/// The keys of a project.
#[derive(Serialize, ToSchema)]
struct KeyList {
    /// Newest first, without secrets.
    keys: Vec<KeyResource>,
}

/// What a new key is for.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct KeyOrder {
    /// What it is used by, for people.
    #[schema(min_length = 1, max_length = 200, example = "data pipeline of the lab")]
    name: String,
    /// `read` and `submit` if absent.
    #[serde(default = "usual_scopes")]
    #[schema(example = json!(["read", "submit"]))]
    scopes: BTreeSet<Scope>,
    /// Days until it expires; absent: it does not.
    #[schema(minimum = 1, maximum = 3650)]
    days: Option<u32>,
    /// The highest priority of jobs that are submitted with it; not above that of the key that asks.
    #[serde(default)]
    #[schema(minimum = -10, maximum = 10)]
    max_priority: i32,
}

fn usual_scopes() -> BTreeSet<Scope> {
    [Scope::Read, Scope::Submit].into()
}

/// List the project's keys, newest first.
#[utoipa::path(get, path = "/v1/keys", tag = "Keys", operation_id = "listKeys",
    responses((status = 200, description = "All of them, without secrets.", body = KeyList)))]
async fn list_keys(service: Service) -> Result<Json<KeyList>, Problem> {
    let keys = service.store.keys().await?;
    let keys = keys.into_iter().map(KeyResource::of).collect();
    Ok(Json(KeyList { keys }))
}

/// Make a key for the project.
///
/// Its secret is shown in this answer and never again. Without keys at all the first is made where the database is, with
/// `trimtab key new`; from then on every request needs one.
#[utoipa::path(post, path = "/v1/keys", tag = "Keys", operation_id = "makeKey",
    request_body = KeyOrder,
    responses(
        (status = 201, description = "It is made.", body = MadeKey),
        (status = 409, description = "`no_key_yet`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`invalid_key`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn make_key(
    service: Service,
    NewId(id): NewId,
    JsonBody { value: order, .. }: JsonBody<KeyOrder>,
) -> Result<Response, Problem> {
    if service.caller.key.is_none() {
        let detail = "there are no keys yet; make the first where the database is (trimtab key new --scope admin), so that somebody has one that makes others";
        return Err(Problem::new(Code::NoKeyYet, detail));
    }
    let faults = faults(&order, &service.caller);
    if !faults.is_empty() {
        return Err(Problem::of_faults(Code::InvalidKey, faults));
    }
    let new = NewKey {
        project: service.store.name().to_string(),
        name: order.name,
        scopes: order.scopes,
        max_priority: order.max_priority,
        lifetime: order.days.map(days),
    };
    Ok(shown_once(service.store.add_key(id, &new).await?))
}

pub fn days(days: u32) -> Duration {
    Duration::from_secs(u64::from(days) * 24 * 3600)
}

fn faults(order: &KeyOrder, caller: &Caller) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut wrong = |pointer: &str, code: &'static str, message: String| {
        faults.push(Fault::new(pointer, code, message));
    };
    if !(1..=LONGEST_NAME).contains(&order.name.chars().count()) {
        let message = format!("a name has 1 to {LONGEST_NAME} characters");
        wrong("/name", "name_length", message);
    }
    if order.scopes.is_empty() {
        let message = "a key without a scope opens nothing; name at least one of read, submit, admin, metrics";
        wrong("/scopes", "no_scope", message.to_string());
    }
    if order
        .days
        .is_some_and(|days| !(1..=LONGEST_DAYS).contains(&days))
    {
        let message =
            format!("1 to {LONGEST_DAYS} days; leave it out for a key that does not expire");
        wrong("/days", "out_of_range", message);
    }
    faults.extend(beyond(&order.scopes, order.max_priority, caller));
    faults
}

/// What a key would allow that its maker's own does not: asked of every key that is made, whatever for.
fn beyond(scopes: &BTreeSet<Scope>, max_priority: i32, caller: &Caller) -> Vec<Fault> {
    let most = caller.max_priority;
    let mut faults = Vec::new();
    // it is the one scope that reaches beyond the project
    if scopes.contains(&Scope::Metrics) && !caller.scopes.contains(&Scope::Metrics) {
        let message =
            "'metrics' can be given by who has it, or where the database is (trimtab key new)";
        faults.push(Fault::new("/scopes", "out_of_range", message));
    }
    if !(-HIGHEST_PRIORITY..=most).contains(&max_priority) {
        let message = format!(
            "between {} and {most}, that of your own key",
            -HIGHEST_PRIORITY
        );
        faults.push(Fault::new("/max_priority", "out_of_range", message));
    }
    faults
}

/// A secret is for who asked, and for no cache on the way.
fn shown_once((record, key): (KeyRecord, Key)) -> Response {
    let body = Json(MadeKey {
        secret: key.reveal().to_string(),
        key: KeyResource::of(record),
    });
    let no_store = [(header::CACHE_CONTROL, HeaderValue::from_static("no-store"))];
    (StatusCode::CREATED, no_store, body).into_response()
}

/// Revoke a key: from now on it opens nothing. Revoking it again changes nothing.
#[utoipa::path(delete, path = "/v1/keys/{id}", tag = "Keys", operation_id = "revokeKey",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "It is revoked.", body = KeyResource),
        (status = 404, description = "`unknown_key`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn revoke_key(service: Service, Id(text): Id) -> Result<Json<KeyResource>, Problem> {
    let id = key_id(&text)?;
    let revoked = service.store.revoke_key(id).await?;
    revoked
        .map(|key| Json(KeyResource::of(key)))
        .ok_or_else(|| unknown_key(&text))
}

/// How a key is replaced.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct Rotation {
    /// How long the old key stays good beside the new one.
    #[serde(default = "a_day")]
    #[schema(minimum = 0, maximum = 720)]
    overlap_hours: u32,
}

pub const fn a_day() -> u32 {
    24
}

/// Replace a key by a new one that may do the same, for as long from now; the old one expires after the overlap.
#[utoipa::path(post, path = "/v1/keys/{id}/rotate", tag = "Keys", operation_id = "rotateKey",
    params(("id" = Uuid, Path)),
    request_body = Rotation,
    responses(
        (status = 201, description = "The new key.", body = MadeKey),
        (status = 404, description = "`unknown_key`: there is none, or it is no longer valid.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`invalid_key`: the overlap is too long, or the key may do what yours may not.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn rotate_key(
    service: Service,
    NewId(new): NewId,
    Id(text): Id,
    JsonBody { value, .. }: JsonBody<Rotation>,
) -> Result<Response, Problem> {
    if value.overlap_hours > LONGEST_OVERLAP_HOURS {
        let message = format!("0 to {LONGEST_OVERLAP_HOURS} hours");
        return Err(Problem::at(Code::InvalidKey, "/overlap_hours", message));
    }
    let overlap = Duration::from_secs(u64::from(value.overlap_hours) * 3600);
    let id = key_id(&text)?;
    let old = service.store.key(id).await?;
    let old = old.ok_or_else(|| unknown_key(&text))?;
    let faults = beyond(&old.scopes, old.max_priority, &service.caller);
    if !faults.is_empty() {
        return Err(Problem::of_faults(Code::InvalidKey, faults));
    }
    let made = service.store.rotate_key(id, new, overlap).await?;
    made.map(shown_once).ok_or_else(|| unknown_key(&text))
}

fn key_id(text: &str) -> Result<Uuid, Problem> {
    Uuid::parse_str(text).map_err(|_| unknown_key(text))
}

fn unknown_key(id: &str) -> Problem {
    let id: String = id.chars().take(80).collect();
    let detail =
        format!("the project has no valid key '{id}'; name a key by its id, not by its secret");
    Problem::new(Code::UnknownKey, detail)
}
