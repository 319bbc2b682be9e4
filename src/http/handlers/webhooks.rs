//! `/v1/webhooks`: who is told of the end of the project's jobs.

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

use crate::http::code::Code;
use crate::http::middleware::once::NewId;
use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::json::JsonBody;
use crate::http::request::query::Id;
use crate::http::service::{Server, Service};
use crate::store::{DeliveryRecord, Webhook};
use crate::webhook::new_secret;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new()
        .routes(routes!(list_webhooks, add_webhook))
        .routes(routes!(delete_webhook))
        .routes(routes!(rotate_webhook))
        .routes(routes!(test_webhook))
        .routes(routes!(list_deliveries))
}

const MOST_WEBHOOKS: usize = 20;
const LONGEST_URL: usize = 2000;

/// After a rotation both secrets sign for so long.
const OVERLAP: Duration = Duration::from_secs(24 * 3600);

/// How many deliveries are shown.
const SHOWN: usize = 100;

/// How a job may end.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, ToSchema)]
#[schema(as = Ending)]
enum EndEvent {
    #[serde(rename = "job.succeeded")]
    Succeeded,
    #[serde(rename = "job.failed")]
    Failed,
    #[serde(rename = "job.cancelled")]
    Cancelled,
}

impl EndEvent {
    fn all() -> BTreeSet<Self> {
        [Self::Succeeded, Self::Failed, Self::Cancelled].into()
    }

    fn name(self) -> &'static str {
        match self {
            Self::Succeeded => "job.succeeded",
            Self::Failed => "job.failed",
            Self::Cancelled => "job.cancelled",
        }
    }
}

/// A webhook, without its secret.
#[derive(Serialize, ToSchema)]
#[schema(as = Webhook)]
struct WebhookResource {
    /// Under which it is rotated, tested and deleted.
    id: Uuid,
    /// Where messages are sent.
    #[schema(example = "https://lab.example/hooks/trimtab")]
    url: String,
    /// What is told.
    #[schema(value_type = Vec<EndEvent>)]
    events: Vec<String>,
    /// When it was added, RFC 3339.
    created: String,
    /// Since when the receiver is told nothing: it answered 410.
    disabled: Option<String>,
}

impl WebhookResource {
    fn of(webhook: Webhook) -> Self {
        Self {
            id: webhook.id,
            url: webhook.url,
            events: webhook.events,
            created: webhook.created,
            disabled: webhook.disabled,
        }
    }
}

/// The webhooks of a project.
#[derive(Serialize, ToSchema)]
struct WebhookList {
    /// Newest first.
    webhooks: Vec<WebhookResource>,
}

/// A secret, shown this once.
#[derive(Serialize, ToSchema)]
struct WithSecret {
    /// What signs the messages: by it the receiver knows that they are Trimtab's. Absent where a request is answered again
    /// (`Idempotency-Key`).
    #[schema(required = false, example = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw")]
    secret: String,
    #[serde(flatten)]
    webhook: WebhookResource,
}

/// A webhook that is wanted.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
struct WebhookOrder {
    /// Where messages are sent. By https and to no address of the service's own machine or network, unless the operator
    /// allowed the host by name (`--webhook-allow`).
    #[schema(
        min_length = 1,
        max_length = 2000,
        example = "https://lab.example/hooks/trimtab"
    )]
    url: String,
    /// What to tell; absent: every end.
    #[serde(default = "EndEvent::all")]
    #[schema(min_items = 1)]
    events: BTreeSet<EndEvent>,
}

/// List the project's webhooks, newest first.
#[utoipa::path(get, path = "/v1/webhooks", tag = "Webhooks", operation_id = "listWebhooks",
    responses((status = 200, description = "All of them, without secrets.", body = WebhookList)))]
async fn list_webhooks(service: Service) -> Result<Json<WebhookList>, Problem> {
    let webhooks = service.store.webhooks().await?;
    let webhooks = webhooks.into_iter().map(WebhookResource::of).collect();
    Ok(Json(WebhookList { webhooks }))
}

/// Be told of the end of jobs.
///
/// By Standard Webhooks, version 1: `POST` with `{"type": "job.succeeded", "timestamp": ..., "data": {"job": ...}}` and the
/// headers `webhook-id`, `webhook-timestamp` and `webhook-signature` (`v1,` and the HMAC-SHA256 of `id.timestamp.body`).
/// Answer with any 2xx within 15 s. What is not is tried again after 5 s, 5 min, 30 min, 2 h, 5 h, 10 h and 14 h; 410 ends the
/// webhook. Redirects are not followed. A message may come twice, under the same `webhook-id`.
#[utoipa::path(post, path = "/v1/webhooks", tag = "Webhooks", operation_id = "addWebhook",
    request_body = WebhookOrder,
    responses(
        (status = 201, description = "It is there.", body = WithSecret),
        (status = 409, description = "`too_many_webhooks`", body = ProblemDocument, content_type = "application/problem+json"),
        (status = 422, description = "`invalid_webhook`: the URL may not be sent to, or there is nothing to tell.", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn add_webhook(
    service: Service,
    NewId(id): NewId,
    JsonBody { value: order, .. }: JsonBody<WebhookOrder>,
) -> Result<Response, Problem> {
    if order.url.len() > LONGEST_URL {
        let message = format!("longer than {LONGEST_URL} characters");
        return Err(Problem::at(Code::InvalidWebhook, "/url", message));
    }
    let refuse = |why: String| Problem::at(Code::InvalidWebhook, "/url", why);
    let checked = service.config.webhooks.check(&order.url);
    checked.map_err(|refused| refuse(refused.to_string()))?;
    if order.events.is_empty() {
        let message = "name at least one, or leave it out for all";
        return Err(Problem::at(Code::InvalidWebhook, "/events", message));
    }
    let webhooks = service.store.webhooks().await?;
    if webhooks.iter().filter(|webhook| webhook.id != id).count() >= MOST_WEBHOOKS {
        let detail = format!("a project has at most {MOST_WEBHOOKS} webhooks; delete one first");
        return Err(Problem::new(Code::TooManyWebhooks, detail));
    }
    let secret = secret()?;
    let events: Vec<String> = order.events.iter().map(|end| end.name().into()).collect();
    let webhook = service.store.add_webhook(id, &order.url, &events, &secret);
    let webhook = webhook.await?;
    Ok(shown_once(secret, webhook))
}

fn secret() -> Result<String, Problem> {
    new_secret().map_err(|error| {
        tracing::error!(%error, "no random numbers");
        Problem::internal()
    })
}

fn shown_once(secret: String, webhook: Webhook) -> Response {
    let body = Json(WithSecret {
        secret,
        webhook: WebhookResource::of(webhook),
    });
    let no_store = [(header::CACHE_CONTROL, HeaderValue::from_static("no-store"))];
    (StatusCode::CREATED, no_store, body).into_response()
}

/// Forget a webhook, and what it was still to be told.
#[utoipa::path(delete, path = "/v1/webhooks/{id}", tag = "Webhooks", operation_id = "deleteWebhook",
    params(("id" = Uuid, Path)),
    responses(
        (status = 204, description = "It is gone."),
        (status = 404, description = "`unknown_webhook`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn delete_webhook(service: Service, Id(text): Id) -> Result<StatusCode, Problem> {
    if service.store.delete_webhook(webhook_id(&text)?).await? {
        Ok(StatusCode::NO_CONTENT)
    } else {
        Err(unknown_webhook(&text))
    }
}

/// Sign with a new secret; the former one signs, too, for a day. A webhook that was disabled is told again.
#[utoipa::path(post, path = "/v1/webhooks/{id}/rotate", tag = "Webhooks", operation_id = "rotateWebhook",
    params(("id" = Uuid, Path)),
    responses(
        (status = 201, description = "The new secret.", body = WithSecret),
        (status = 404, description = "`unknown_webhook`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn rotate_webhook(service: Service, Id(text): Id) -> Result<Response, Problem> {
    let (id, secret) = (webhook_id(&text)?, secret()?);
    let changed = service.store.rotate_webhook(id, &secret, OVERLAP).await?;
    let webhook = if changed {
        service.store.webhook(id).await?
    } else {
        None
    };
    let webhook = webhook.ok_or_else(|| unknown_webhook(&text))?;
    Ok(shown_once(secret, webhook))
}

/// Send a message of the type `webhook.test`, to try the receiver; `deliveries` shows what came of it.
#[utoipa::path(post, path = "/v1/webhooks/{id}/test", tag = "Webhooks", operation_id = "testWebhook",
    params(("id" = Uuid, Path)),
    responses(
        (status = 202, description = "It will be sent."),
        (status = 404, description = "`unknown_webhook`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn test_webhook(service: Service, Id(text): Id) -> Result<StatusCode, Problem> {
    let id = webhook_id(&text)?;
    find(&service, id, &text).await?;
    service.store.try_webhook(id).await?;
    Ok(StatusCode::ACCEPTED)
}

/// One message, and what came of it.
#[derive(Serialize, ToSchema)]
struct DeliveryResource {
    /// The header `webhook-id`.
    id: Uuid,
    /// What is told: `job.succeeded`, `job.failed`, `job.cancelled`, or `webhook.test`.
    #[serde(rename = "type")]
    #[schema(example = "job.succeeded")]
    event: String,
    /// Empty, if it was only a test.
    job: String,
    /// When it was first due, RFC 3339.
    created: String,
    /// How often it was sent.
    attempts: u32,
    /// When it will be sent again.
    next_attempt: Option<String>,
    /// When it arrived.
    delivered: Option<String>,
    /// What was answered last.
    status: Option<u16>,
    /// Why it has not arrived.
    fault: Option<String>,
}

impl DeliveryResource {
    fn of(delivery: DeliveryRecord) -> Self {
        Self {
            id: delivery.id,
            event: delivery.event,
            job: delivery.job,
            created: delivery.created,
            attempts: delivery.attempts,
            next_attempt: delivery.next,
            delivered: delivery.done,
            status: delivery.status,
            fault: delivery.fault,
        }
    }
}

/// What was sent to a webhook last.
#[derive(Serialize, ToSchema)]
struct DeliveryList {
    /// Newest first, at most 100.
    deliveries: Vec<DeliveryResource>,
}

/// What was sent to a webhook last, newest first, at most 100.
#[utoipa::path(get, path = "/v1/webhooks/{id}/deliveries", tag = "Webhooks", operation_id = "listDeliveries",
    params(("id" = Uuid, Path)),
    responses(
        (status = 200, description = "The messages.", body = DeliveryList),
        (status = 404, description = "`unknown_webhook`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn list_deliveries(service: Service, Id(text): Id) -> Result<Json<DeliveryList>, Problem> {
    let id = webhook_id(&text)?;
    find(&service, id, &text).await?;
    let deliveries = service.store.deliveries(id, SHOWN).await?;
    let deliveries = deliveries.into_iter().map(DeliveryResource::of).collect();
    Ok(Json(DeliveryList { deliveries }))
}

async fn find(service: &Service, id: Uuid, text: &str) -> Result<Webhook, Problem> {
    let webhook = service.store.webhook(id).await?;
    webhook.ok_or_else(|| unknown_webhook(text))
}

fn webhook_id(text: &str) -> Result<Uuid, Problem> {
    Uuid::parse_str(text).map_err(|_| unknown_webhook(text))
}

fn unknown_webhook(id: &str) -> Problem {
    let id: String = id.chars().take(80).collect();
    Problem::new(Code::UnknownWebhook, format!("there is no webhook '{id}'"))
}
