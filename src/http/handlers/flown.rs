//! `PATCH /v1/maneuvers/{id}`: what was flown, said of a recording at any time.

use axum::body::Body;
use axum::http::HeaderMap;
use axum::response::Response;
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value, json};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::maneuvers::{LONGEST_NAME, ManeuverResource, unknown_maneuver};
use crate::flight::{Fault, Flown};
use crate::http::answer::format::{Format, cacheable, check_if_match};
use crate::http::code::Code;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::Id;
use crate::http::request::{body, json};
use crate::http::service::{Server, Service};
use crate::job::JobSpec;
use crate::store::ManeuverRecord;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(update_maneuver))
}

const MERGE_PATCH: &str = "application/merge-patch+json";

/// What is to be changed of a maneuver; what is not named stays, and `null` takes away.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct ManeuverChange {
    /// For people; at most 200 characters.
    #[serde(default, deserialize_with = "named")]
    #[schema(value_type = Option<String>, example = "ATTAS elevator 3-2-1-1")]
    name: Option<Option<String>>,
    /// Members of what was flown; `null` takes all of them away.
    #[serde(default, deserialize_with = "named")]
    #[schema(value_type = Option<Flown>)]
    flown: Option<Option<Map<String, Value>>>,
}

/// A member that is named, be it `null`.
fn named<'de, T: Deserialize<'de>, D: Deserializer<'de>>(member: D) -> Result<Option<T>, D::Error> {
    T::deserialize(member).map(Some)
}

/// Say what was flown.
///
/// Aircraft, configuration, mass, centre of gravity, inertia, notes and tags of a recording, and its name. The body is a JSON
/// merge patch (RFC 7396): what it does not name stays, and `null` takes away. With `If-Match` it is changed only if it has this
/// `ETag` still. The recording itself, and so its id, does not change. Jobs that were submitted before keep what was said then.
#[utoipa::path(patch, path = "/v1/maneuvers/{id}", tag = "Maneuvers", operation_id = "updateManeuver",
    params(
        ("id" = String, Path),
        ("If-Match" = Option<String>, Header, description = "The `ETag` of the maneuver as it was read; `*` for any."),
    ),
    request_body(content(
        (ManeuverChange = "application/json", example = json!({"flown": {"registration": "D-ADAM", "mass": {"value": 17600.0, "unit": "kg"}, "flaps": null}})),
        (ManeuverChange = "application/merge-patch+json"),
    )),
    responses(
        (status = 200, description = "The maneuver as it is now.", body = ManeuverResource, headers(("ETag" = String, description = "Of the maneuver as it is now."))),
        (status = 404, description = "`unknown_maneuver`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 412, description = "`precondition_failed`: it was changed in the meantime.", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 415, description = "`unsupported_media_type`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`wrong_shape`, `invalid_flown`: `errors` lists the faults by JSON pointer.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn update_maneuver(
    service: Service,
    Id(id): Id,
    headers: HeaderMap,
    body: Body,
) -> Result<Response, Problem> {
    let media_type = body::media_type(&headers);
    if !["application/json", MERGE_PATCH].contains(&media_type.as_str()) {
        return Err(body::unsupported(
            &media_type,
            &["application/json", MERGE_PATCH],
        ));
    }
    let limit = service.config.max_json_body;
    let received = body::read(&headers, body, limit, "--max-json-body", &service.room).await?;
    let body::Received { bytes, room: _room } = received;
    let change: ManeuverChange = json::parse(&json::text(bytes)?)?;
    let now = service.store.maneuver(&id).await?;
    let now = now.ok_or_else(|| unknown_maneuver(&id))?;
    // what is wrong by itself waits for no other change, and no other change for it
    changed(&change, &headers, &now)?;
    let changed = service
        .store
        .change_maneuver(&id, |now| changed(&change, &headers, now))
        .await?;
    let record = changed.ok_or_else(|| unknown_maneuver(&id))??;
    let json = serde_json::to_vec(&ManeuverResource::of(record)?)?;
    Ok(cacheable(&HeaderMap::new(), Format::Json, json))
}

/// What is said once a change is in it: faults of its shape have their places in the change.
#[derive(Deserialize)]
struct Said {
    flown: Flown,
}

/// Name and what was flown, with a change in them.
fn changed(
    change: &ManeuverChange,
    headers: &HeaderMap,
    now: &ManeuverRecord,
) -> Result<(String, Flown), Problem> {
    let resource = ManeuverResource::of(now.clone())?;
    check_if_match(headers, &serde_json::to_vec(&resource)?)?;
    let name = match &change.name {
        Some(name) => name.clone().unwrap_or_default(),
        None => now.name.clone(),
    };
    if name.chars().count() > LONGEST_NAME {
        let message = format!("longer than {LONGEST_NAME} characters");
        return Err(Problem::at(Code::InvalidFlown, "/name", message));
    }
    let mut merged = json!({ "flown": now.flown });
    match &change.flown {
        Some(Some(change)) => merge_into(&mut merged["flown"], change),
        Some(None) => merged["flown"] = json!({}),
        None => {}
    }
    let Said { flown: merged } = json::parse(&merged.to_string())?;
    let merged = merged.without_empty_groups();
    let faults: Vec<Fault> = (merged.faults().into_iter())
        .map(|fault| fault.under("/flown"))
        .collect();
    match faults.is_empty() {
        true => Ok((name, merged)),
        false => Err(Problem::of_faults(Code::InvalidFlown, faults)),
    }
}

/// A JSON merge patch, RFC 7396.
fn merge(target: &mut Value, change: &Value) {
    match change {
        Value::Object(change) => merge_into(target, change),
        change => target.clone_from(change),
    }
}

fn merge_into(target: &mut Value, change: &Map<String, Value>) {
    if !target.is_object() {
        *target = Value::Object(Map::new());
    }
    let Value::Object(members) = target else {
        return;
    };
    for (name, value) in change {
        match value {
            Value::Null => {
                members.shift_remove(name);
            }
            value => merge(members.entry(name).or_insert(Value::Null), value),
        }
    }
}

/// A job whose constants refer to its recordings has with it what is said of these now; and its text.
pub(crate) async fn with_flown(
    service: &Service,
    mut spec: JobSpec,
    text: String,
) -> Result<(JobSpec, String), Problem> {
    if !spec.refers_to_recordings() {
        return Ok((spec, text));
    }
    let ids: Vec<&str> = spec.maneuvers.iter().map(|used| used.id.as_str()).collect();
    let said = service.store.flown(&ids).await?;
    for (used, said) in spec.maneuvers.iter_mut().zip(said) {
        used.flown = used.flown.take().or(said);
    }
    let text = serde_json::to_string(&spec)?;
    Ok((spec, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_merge_patch_is_applied_as_its_rfc_says() {
        // from the table of RFC 7396, appendix A
        for (target, change, expected) in [
            (json!({"a": "b"}), json!({"a": "c"}), json!({"a": "c"})),
            (
                json!({"a": "b"}),
                json!({"b": "c"}),
                json!({"a": "b", "b": "c"}),
            ),
            (json!({"a": "b"}), json!({"a": null}), json!({})),
            (json!({"a": ["b"]}), json!({"a": "c"}), json!({"a": "c"})),
            (
                json!({"a": {"b": "c"}}),
                json!({"a": {"b": "d", "c": null}}),
                json!({"a": {"b": "d"}}),
            ),
            (
                json!({"a": [{"b": "c"}]}),
                json!({"a": [1]}),
                json!({"a": [1]}),
            ),
            (
                json!({"e": null}),
                json!({"a": 1}),
                json!({"e": null, "a": 1}),
            ),
            (
                json!({}),
                json!({"a": {"bb": {"ccc": null}}}),
                json!({"a": {"bb": {}}}),
            ),
        ] {
            let mut merged = target;
            merge(&mut merged, &change);
            assert_eq!(merged, expected);
        }
    }
}
