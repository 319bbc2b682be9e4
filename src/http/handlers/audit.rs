//! `/v1/audit`: who did what cannot be undone, or lets somebody in.

use axum::Json;
use serde::Serialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;
use uuid::Uuid;

use crate::http::problem::{Problem, ProblemDocument};
use crate::http::request::query::{PageQuery, Parameters, bad_cursor, page_limit};
use crate::http::service::{Server, Service};
use crate::store::AuditRecord;

pub(crate) fn router() -> OpenApiRouter<Server> {
    OpenApiRouter::new().routes(routes!(list_audit))
}

/// Something that was done.
#[derive(Serialize, ToSchema)]
struct AuditLine {
    /// Of this line; later ones sort behind earlier ones.
    id: Uuid,
    /// When it was done, RFC 3339.
    #[schema(example = "2026-11-21T12:00:00.123Z")]
    at: String,
    /// The key that did it, by its id; `null`: who has the database at hand, or needs no key.
    key: Option<String>,
    /// `job.deleted`, `maneuver.deleted`, `mapping.deleted`, `expired`, `key.made`, `key.rotated`, `key.revoked`,
    /// `webhook.added`, `webhook.rotated` or `webhook.deleted`.
    #[schema(example = "key.made")]
    deed: String,
    /// What it was done to: an id or a name, never a secret.
    subject: String,
}

impl AuditLine {
    fn of(line: AuditRecord) -> Self {
        Self {
            id: line.id,
            at: line.at,
            key: line.key,
            deed: line.deed,
            subject: line.subject,
        }
    }
}

/// A page of the audit.
#[derive(Serialize, ToSchema)]
struct AuditPage {
    /// Newest first.
    lines: Vec<AuditLine>,
    /// Where the next page begins; `null`: this is the last.
    next_cursor: Option<String>,
}

/// Who deleted what, and who made, replaced and revoked keys and webhooks; newest first. It is kept for ever.
#[utoipa::path(get, path = "/v1/audit", tag = "Operations", operation_id = "listAudit",
    params(PageQuery),
    responses(
        (status = 200, description = "A page of it.", body = AuditPage),
        (status = 400, description = "`invalid_cursor`, `invalid_query`", body = ProblemDocument, content_type = "application/problem+json"),
    ))]
async fn list_audit(
    service: Service,
    Parameters(query): Parameters<PageQuery>,
) -> Result<Json<AuditPage>, Problem> {
    let limit = page_limit(query.limit)?;
    let page = service.store.audit(query.cursor.as_deref(), limit).await?;
    let page = page.map_err(bad_cursor)?;
    Ok(Json(AuditPage {
        lines: page.entries.into_iter().map(AuditLine::of).collect(),
        next_cursor: page.next_cursor,
    }))
}
