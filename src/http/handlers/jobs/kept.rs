//! What was kept of a finished job, from which its plan is made once more.

use std::sync::Arc;

use uuid::Uuid;

use super::results;
use super::submit::load;
use crate::estimate::Estimate;
use crate::flight::Maneuver;
use crate::http::code::Code;
use crate::http::problem::Problem;
use crate::http::request::query::unknown_job;
use crate::http::service::Service;
use crate::job::{self, JobSpec, NoTrajectory, Plan};
use crate::model::ModelDocument;
use crate::store::Part;

/// All that was kept of a finished job.
pub(crate) struct Kept {
    pub(crate) spec: JobSpec,
    declared: ModelDocument,
    pub(crate) estimated: ModelDocument,
    pub(crate) estimate: Estimate,
    pub(crate) maneuvers: Vec<Arc<Maneuver>>,
}

impl Kept {
    pub(crate) async fn of(service: &Service, id: Uuid) -> Result<Self, Problem> {
        let estimate = results::part(service, id, Part::Estimate).await?;
        let estimated = results::part(service, id, Part::Model).await?;
        let submitted = service.store.submitted(id).await?;
        let submitted = submitted.ok_or_else(|| unknown_job(id))?;
        let spec: JobSpec = serde_json::from_str(&submitted.spec)?;
        let maneuvers = load(service, &spec).await?;
        Ok(Self {
            declared: serde_json::from_str(&submitted.model)?,
            estimated: serde_json::from_str(&estimated)?,
            estimate: serde_json::from_str(&estimate)?,
            maneuvers: maneuvers
                .map_err(|faults| Problem::of_faults(Code::NoTrajectory, faults))?,
            spec,
        })
    }

    pub(super) fn plan(&self) -> Result<Plan, Problem> {
        job::plan_again(&self.spec, &self.declared, &self.maneuvers, &self.estimated).map_err(none)
    }

    /// The plan, if it is that of the estimate.
    pub(crate) fn plan_of_estimate(&self) -> Result<Plan, Problem> {
        let plan = self.plan()?;
        job::check_parameters(&plan, &self.estimate).map_err(none)?;
        Ok(plan)
    }
}

pub(super) fn none(why: NoTrajectory) -> Problem {
    Problem::new(Code::NoTrajectory, why.to_string())
}
