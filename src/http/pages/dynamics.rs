//! `/jobs/{id}/dynamics`: linear system, frequency responses and flying qualities of a job.

use axum::Router;
use axum::response::Html;
use axum::routing::get;
use serde::Deserialize;

use super::job;
use crate::dashboard::{DynamicsView, dynamics_page};
use crate::dynamics::{
    AirplaneClass, FlightPhaseCategory, FlyingQualityQuestion, FrequencyQuestion, FrequencyUnit,
    NoLinearSystem, flying_qualities, frequency_responses, linear_system,
};
use crate::http::handlers::jobs::dynamics::none;
use crate::http::handlers::jobs::kept::Kept;
use crate::http::problem::Problem;
use crate::http::request::query::{JobId, Parameters};
use crate::http::service::{Server, Service};

pub(super) fn router() -> Router<Server> {
    Router::new().route("/jobs/{id}/dynamics", get(get_dynamics_page))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DynamicsQuery {
    segment: Option<String>,
    #[serde(default)]
    unit: FrequencyUnit,
    category: Option<FlightPhaseCategory>,
    class: Option<AirplaneClass>,
    airspeed: Option<f64>,
}

async fn get_dynamics_page(
    service: Service,
    JobId(id): JobId,
    Parameters(query): Parameters<DynamicsQuery>,
) -> Result<Html<String>, Problem> {
    let kept = Kept::of(&service, id).await?;
    let view = job::view(&service, id).await?;
    let make = move || {
        let plan = kept.plan_of_estimate()?;
        let (problem, estimate) = (&plan.problem, &kept.estimate);
        let question = FrequencyQuestion {
            segment: query.segment.clone(),
            unit: query.unit,
            ..FrequencyQuestion::default()
        };
        // a model without inputs has modes all the same
        let responses = match frequency_responses(problem, estimate, &question) {
            Err(NoLinearSystem::NoInputs) => Vec::new(),
            other => other.map_err(none)?,
        };
        let qualities = FlyingQualityQuestion {
            segment: query.segment.clone(),
            category: query.category,
            class: query.class,
            airspeed: query.airspeed.filter(|airspeed| *airspeed > 0.0),
            band: [None; 2],
        };
        let view = DynamicsView {
            id: view.id.clone(),
            title: view.title.clone(),
            system: linear_system(problem, estimate, query.segment.as_deref()).map_err(none)?,
            responses,
            qualities: flying_qualities(problem, estimate, &qualities).map_err(none)?,
        };
        Ok(Html(dynamics_page(&view)))
    };
    service.compute.run(make).await?
}
