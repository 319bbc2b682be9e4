//! The two-step method in one command: reconstruct the flight path, then estimate from the corrected recordings.

use std::ops::ControlFlow;
use std::sync::Arc;

use indexmap::IndexMap;

use super::document::document;
use super::pairs::{once, pair};
use super::progress::ProgressLine;
use super::request::Request;
use super::{Failure, notes, table};
use crate::estimate::{Options, Role};
use crate::job::{self, JobKind, JobSpec, ManeuverUse, ModelSource, Plan};

#[derive(clap::Args, Debug)]
pub(super) struct TwoStep {
    /// First reconstruct the flight path with this model (a catalog model such as flight-path-reconstruction, or a document), then
    /// fit to the recordings that it has corrected. The errors of the first step are not in the bounds of the second.
    #[arg(long, value_name = "MODEL", conflicts_with_all = ["validate", "last"])]
    reconstruct: Option<String>,
    /// How a channel of the reconstruction is made from recorded ones; --channel is that of the second step then.
    #[arg(
        long = "reconstruct-channel",
        value_name = "NAME=FORMULA",
        requires = "reconstruct"
    )]
    reconstruct_channels: Vec<String>,
}

impl TwoStep {
    /// The job of the second step, where there are two; tables of the first are printed unless they are `hidden`.
    pub(super) fn plan(&self, request: &Request, hidden: bool) -> Result<Option<Plan>, Failure> {
        let Some(name) = &self.reconstruct else {
            return Ok(None);
        };
        let recordings = request.recordings()?;
        let ids: Vec<String> = recordings.iter().map(|one| one.digest()).collect();
        let asked = request.spec(&ids)?;
        let document =
            document(name, None).map_err(|why| Failure::new(format!("--reconstruct: {why}")))?;
        let source = ModelSource::Document(Box::new(document.clone()));
        let first = JobSpec {
            channels: self.channels()?,
            options: Options {
                tolerance: asked.options.tolerance,
                max_iterations: asked.options.max_iterations,
                ..Options::default()
            },
            ..JobSpec::new(JobKind::Estimate, source, asked.maneuvers.clone())
        };
        let plan = job::prepare(&first, &document, &recordings)
            .map_err(|faults| Failure::faults("the reconstruction cannot start", &faults))?;
        let progress = ProgressLine::new(request.tolerance);
        let result = job::run(&plan, &mut |told| {
            progress.told(told);
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the reconstruction failed", &faults))?;
        progress.finish(&result.estimate.reason);
        match hidden {
            true => notes::say(&result.estimate.findings),
            false => println!(
                "reconstruction\n{}\n",
                table::result(&result.estimate, None)
            ),
        }
        let corrected = job::corrected(&plan, &result.estimate, &recordings)
            .map_err(|why| Failure::new(format!("--reconstruct {name}: {why}")))?;
        let uses = corrected.iter().map(|made| ManeuverUse {
            label: Some(made.segment.clone()),
            ..ManeuverUse::new(made.maneuver.digest(), Role::Estimation)
        });
        let second = JobSpec {
            maneuvers: uses.collect(),
            ..asked
        };
        let recordings: Vec<Arc<_>> = (corrected.into_iter())
            .map(|made| Arc::new(made.maneuver))
            .collect();
        job::prepare(&second, &request.document()?, &recordings)
            .map(Some)
            .map_err(|faults| {
                Failure::faults(
                    "the job cannot start from the corrected recordings",
                    &faults,
                )
            })
    }

    fn channels(&self) -> Result<IndexMap<String, String>, Failure> {
        let mut channels = IndexMap::new();
        for text in &self.reconstruct_channels {
            let (name, formula) = pair(text, "--reconstruct-channel")?;
            let before = channels.insert(name.to_string(), formula.to_string());
            once("--reconstruct-channel", name, before.is_some())?;
        }
        Ok(channels)
    }
}
