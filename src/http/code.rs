//! The one table of codes: what can be wrong with a request as a whole. What is wrong *inside* a
//! recording, a model or a job is said by the faults of those rooms, under `errors`.

use axum::http::StatusCode;

macro_rules! codes {
    ($($(#[doc = $meaning:literal])+ $variant:ident $name:literal $status:ident $title:literal;)+) => {
        /// A stable word for what is wrong with a request.
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        pub enum Code {
            $($(#[doc = $meaning])+ $variant,)+
        }

        impl Code {
            pub const ALL: &'static [Self] = &[$(Self::$variant,)+];

            /// As it stands in `code`. It never changes its meaning.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            pub fn status(self) -> StatusCode {
                match self { $(Self::$variant => StatusCode::$status,)+ }
            }

            pub fn title(self) -> &'static str {
                match self { $(Self::$variant => $title,)+ }
            }

            /// What it means and what to do, for the documentation.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => concat!($($meaning),+).trim_ascii(),)+ }
            }
        }
    };
}

codes! {
    /// The body is not one of several files, or says something of a file that is not in it.
    InvalidMultipart "invalid_multipart" BAD_REQUEST "The body is not one of several files";
    /// The body is not JSON. `detail` names line and column.
    InvalidJson "invalid_json" BAD_REQUEST "The body is not JSON";
    /// The body is not TOML. `detail` names line and column.
    InvalidToml "invalid_toml" BAD_REQUEST "The body is not TOML";
    /// The body can be read, but is not what is expected here. Each entry of `errors` points to a place.
    WrongShape "wrong_shape" UNPROCESSABLE_ENTITY "The body has another shape";
    /// A query parameter is unknown, or has a value that cannot be read.
    InvalidQuery "invalid_query" BAD_REQUEST "The query cannot be read";
    /// A request header has a value that cannot be read.
    InvalidHeader "invalid_header" BAD_REQUEST "A header cannot be read";
    /// The cursor is none that this list has answered with. Begin the list anew without one.
    InvalidCursor "invalid_cursor" BAD_REQUEST "The cursor cannot be read";
    /// The path cannot be decoded as UTF-8.
    InvalidPath "invalid_path" BAD_REQUEST "The path cannot be read";
    /// The body ended before its announced length.
    IncompleteBody "incomplete_body" BAD_REQUEST "The body is incomplete";
    /// A browser sent the request on behalf of a page of another origin.
    CrossOrigin "cross_origin" FORBIDDEN "Not for pages of other origins";
    /// The request needs a key: send it as `Authorization: Bearer KEY`, or as the password of basic authentication.
    KeyNeeded "key_needed" UNAUTHORIZED "A key is needed";
    /// The key is good, but not for this: `detail` names the scope that is missing.
    ScopeMissing "scope_missing" FORBIDDEN "The key is not for this";
    /// While there are no keys, the service answers only to requests that name this machine in `Host`.
    UnknownHost "unknown_host" FORBIDDEN "Not under this name";
    /// There is nothing at this path.
    UnknownRoute "unknown_route" NOT_FOUND "There is no such route";
    /// There is no maneuver of this id.
    UnknownManeuver "unknown_maneuver" NOT_FOUND "There is no such maneuver";
    /// There is no model of this id or catalog name.
    UnknownModel "unknown_model" NOT_FOUND "There is no such model";
    /// There is no job of this id.
    UnknownJob "unknown_job" NOT_FOUND "There is no such job";
    /// The project has no key of this id that is good.
    UnknownKey "unknown_key" NOT_FOUND "There is no such key";
    /// The project has no webhook of this id.
    UnknownWebhook "unknown_webhook" NOT_FOUND "There is no such webhook";
    /// There is no mapping of this name, or none of the project's own.
    UnknownMapping "unknown_mapping" NOT_FOUND "There is no such mapping";
    /// There is no problem of this code.
    UnknownCode "unknown_code" NOT_FOUND "There is no such code";
    /// The job ended without a result: `detail` says how it ended.
    NoResult "no_result" NOT_FOUND "The job has no result";
    /// The result has no trajectory: `detail` says why.
    NoTrajectory "no_trajectory" CONFLICT "There is no trajectory";
    /// The estimated model cannot be linearised: `detail` says why.
    NoLinearSystem "no_linear_system" CONFLICT "There is no linear system";
    /// The estimated model has no aerodynamics for JSBSim: `detail` says why.
    NoAerodynamics "no_aerodynamics" CONFLICT "There are no aerodynamics";
    /// The path is right, the method is not. The header `Allow` lists those that are.
    MethodNotAllowed "method_not_allowed" METHOD_NOT_ALLOWED "The method is not allowed here";
    /// None of the media types in `Accept` is offered here.
    NotAcceptable "not_acceptable" NOT_ACCEPTABLE "Not available as this media type";
    /// The body stopped coming in.
    BodyTimeout "body_timeout" REQUEST_TIMEOUT "The body came in too slowly";
    /// The job is not over yet. Follow its events, and ask again when it is.
    NotFinished "not_finished" CONFLICT "The job is not finished";
    /// The job is over: there is nothing to cancel.
    AlreadyOver "already_over" CONFLICT "The job is already over";
    /// The project has as many webhooks as it may. Delete one first.
    TooManyWebhooks "too_many_webhooks" CONFLICT "There are too many webhooks";
    /// It is no longer as the `ETag` in `If-Match` says: somebody changed it. Get it anew, and change what is there now.
    PreconditionFailed "precondition_failed" PRECONDITION_FAILED "It was changed in the meantime";
    /// Something else goes by this name. Take another.
    NameTaken "name_taken" CONFLICT "The name is taken";
    /// There are no keys yet. The first is made where the database is, with `trimtab key new`.
    NoKeyYet "no_key_yet" CONFLICT "There is no key yet";
    /// Jobs use the maneuver, and could not be run again without it.
    InUse "in_use" CONFLICT "It is in use";
    /// Models of the catalog come with the program. Only stored models can be deleted.
    OfCatalog "of_catalog" CONFLICT "It is a model of the catalog";
    /// A request with this `Idempotency-Key` is still in hand. Send it again after `Retry-After` seconds.
    KeyInHand "idempotency_key_in_hand" CONFLICT "The request is being worked on";
    /// The `Idempotency-Key` was used for another request within the last 24 hours.
    KeyReused "idempotency_key_reused" UNPROCESSABLE_ENTITY "The key was used for another request";
    /// The key asks more often than it may. Ask again after `Retry-After` seconds.
    TooManyRequests "too_many_requests" TOO_MANY_REQUESTS "Too many requests";
    /// More jobs wait than may: `detail` names the limit and the use. Submit again after `Retry-After` seconds.
    QueueFull "queue_full" TOO_MANY_REQUESTS "The queue is full";
    /// The project keeps as much as it may: `detail` names the limit and the use. Delete what is no longer needed.
    QuotaExceeded "quota_exceeded" PAYLOAD_TOO_LARGE "The project is full";
    /// The body is longer than the limit that `detail` names.
    BodyTooLarge "body_too_large" PAYLOAD_TOO_LARGE "The body is too large";
    /// The `Content-Type` is none of those that `detail` lists.
    UnsupportedMediaType "unsupported_media_type" UNSUPPORTED_MEDIA_TYPE "The media type is not supported";
    /// The recording cannot be a maneuver. `errors` lists all faults, each with its place.
    InvalidManeuver "invalid_maneuver" UNPROCESSABLE_ENTITY "The recording has faults";
    /// What was flown cannot be said like this. `errors` lists all faults, each with its place.
    InvalidFlown "invalid_flown" UNPROCESSABLE_ENTITY "What was flown has faults";
    /// The model document has faults. `errors` lists all of them, each with its place.
    InvalidModel "invalid_model" UNPROCESSABLE_ENTITY "The model has faults";
    /// The job cannot be started. `errors` lists all faults, each with its place in the spec.
    InvalidJob "invalid_job" UNPROCESSABLE_ENTITY "The job has faults";
    /// The prediction cannot be made. `errors` lists all faults, each with its place.
    InvalidPrediction "invalid_prediction" UNPROCESSABLE_ENTITY "The prediction has faults";
    /// The scenario cannot be flown. `detail` says which part of it and why.
    InvalidScenario "invalid_scenario" UNPROCESSABLE_ENTITY "The scenario has a fault";
    /// The trim cannot be looked for. `errors` lists all faults, each with its place.
    InvalidTrim "invalid_trim" UNPROCESSABLE_ENTITY "The trim has faults";
    /// The maneuvers cannot be designed. `errors` lists all faults, each with its place.
    InvalidDesign "invalid_design" UNPROCESSABLE_ENTITY "The design has faults";
    /// The key cannot be made like this. `errors` lists all faults, each with its place.
    InvalidKey "invalid_key" UNPROCESSABLE_ENTITY "The key cannot be made like this";
    /// The webhook cannot be made like this: `errors` tells the place.
    InvalidWebhook "invalid_webhook" UNPROCESSABLE_ENTITY "The webhook cannot be made like this";
    /// The mapping has a fault. `errors` tells the place.
    InvalidMapping "invalid_mapping" UNPROCESSABLE_ENTITY "The mapping has faults";
    /// The aircraft's constants have faults. `errors` lists all of them.
    InvalidAircraft "invalid_aircraft" UNPROCESSABLE_ENTITY "The aircraft's constants have faults";
    /// The frequency responses cannot be worked out. Each entry of `errors` says why and points into the request.
    InvalidResponse "invalid_response" UNPROCESSABLE_ENTITY "The frequency responses cannot be worked out";
    /// The service failed: a defect of ours. Report it with the `request_id`.
    Internal "internal" INTERNAL_SERVER_ERROR "The service failed";
    /// The service holds as much of what is being sent to it, or as many connections, as it may. Send it again after
    /// `Retry-After` seconds.
    Busy "busy" SERVICE_UNAVAILABLE "The service is busy";
    /// The database does not answer in time. Nothing was lost that was accepted; try again.
    StoreUnavailable "store_unavailable" SERVICE_UNAVAILABLE "The store does not answer";
    /// The database's disk is full. Nothing was lost that was accepted; make room, and try again.
    StoreFull "store_full" INSUFFICIENT_STORAGE "The store is full";
}

impl Code {
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|code| code.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_distinct_and_say_what_they_mean() {
        for (number, code) in Code::ALL.iter().enumerate() {
            assert_eq!(Code::find(code.name()), Some(*code));
            assert!(
                Code::ALL[..number]
                    .iter()
                    .all(|other| other.name() != code.name())
            );
            assert!(code.status().is_client_error() || code.status().is_server_error());
            assert!(code.meaning().ends_with('.'), "{}", code.meaning());
        }
    }
}
