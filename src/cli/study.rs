//! `trimtab study`: derivative techniques compared on a problem, here and now.

use std::ops::ControlFlow;
use std::path::PathBuf;

use comfy_table::presets::UTF8_BORDERS_ONLY;
use comfy_table::{CellAlignment, Table};

use super::progress::Progress;
use super::request::Request;
use super::{Failure, figures};
use crate::dashboard::{cost_figure, error_figure};
use crate::estimate::Scaling;
use crate::estimate::study::DerivativeStudy;
use crate::job::{self, JobKind};
use crate::work::ThreadClock;

/// Estimates, and compares all derivative techniques on the same problem: errors, costs, iterations.
#[derive(clap::Args, Debug)]
pub(super) struct Study {
    #[command(flatten)]
    request: Request,
    /// Where to write gradient-error.svg and gradient-cost.svg.
    #[arg(long, value_name = "DIRECTORY")]
    figures: Option<PathBuf>,
    /// Print the study as JSON instead.
    #[arg(long)]
    json: bool,
}

impl Study {
    pub(super) fn run(&self) -> Result<(), Failure> {
        let maneuvers = self.request.recordings()?;
        let ids: Vec<String> = maneuvers.iter().map(|maneuver| maneuver.digest()).collect();
        let mut spec = self.request.spec(&ids)?;
        spec.kind = JobKind::DerivativeStudy;
        let plan = job::prepare(&spec, &self.request.document()?, &maneuvers)
            .map_err(|faults| Failure::faults("the job cannot start", &faults))?;
        let progress = Progress::new(spec.options.tolerance);
        let result = job::run_study(&plan, &ThreadClock::start(), &mut |told| {
            match told {
                job::Progress::Estimation(told) => progress.told(told),
                job::Progress::Finding(step) => progress.say(&step.finding),
                job::Progress::Underway => {}
            }
            ControlFlow::Continue(())
        })
        .map_err(|faults| Failure::faults("the job failed", &faults))?;
        progress.finish(&result.estimate.reason);
        let Some(study) = result.study else {
            return Err(Failure::new(result.estimate.reason));
        };
        if self.json {
            let text = serde_json::to_string_pretty(&study)
                .map_err(|error| Failure::new(error.to_string()))?;
            println!("{text}");
        } else {
            println!("{}", tables(&study));
        }
        if let Some(directory) = &self.figures {
            let pictures = [
                ("gradient-error.svg", error_figure(&study.error_curves)),
                ("gradient-cost.svg", cost_figure(&study.costs)),
            ];
            figures::write(
                directory,
                pictures.map(|(name, svg)| (name.to_string(), svg)),
            )?;
        }
        Ok(())
    }
}

/// Techniques, best steps and descents, for the terminal.
pub fn tables(study: &DerivativeStudy) -> String {
    let size = &study.size;
    let techniques = study.techniques.iter().map(|row| {
        vec![
            row.technique.clone(),
            row.gradient_error
                .map_or("reference".to_string(), |error| format!("{error:.1e}")),
            format!("{:.2e}", row.operations as f64),
            row.simulations.to_string(),
            format!("{:.3}", row.cpu_seconds * 1e3),
            format!("{:.3}", row.wall_seconds * 1e3),
            format!("{:.0}", row.bytes as f64 / 1e3),
            row.iterations.to_string(),
            row.outcome.clone(),
            format!("{:.1}", row.estimation_wall_seconds * 1e3),
        ]
    });
    let header = [
        "technique",
        "error",
        "operations",
        "sims",
        "CPU ms",
        "wall ms",
        "kB",
        "iterations",
        "outcome",
        "estimation ms",
    ];
    let curves = study.error_curves.iter().filter_map(|curve| {
        let (step, error) = curve.best()?;
        Some(vec![
            curve.technique.clone(),
            format!("{step:.0e}"),
            format!("{error:.1e}"),
        ])
    });
    let costs = study.costs.iter().map(|cost| {
        vec![
            cost.unknowns.to_string(),
            format!("{:.2e}", cost.direct_operations as f64),
            format!("{:.2e}", cost.adjoint_operations as f64),
            format!("{:.3}", cost.direct_wall_seconds * 1e3),
            format!("{:.3}", cost.adjoint_wall_seconds * 1e3),
        ]
    });
    let descents = study.descents.iter().map(|row| {
        let scaling = match row.scaling {
            None => "information, every step",
            Some(Scaling::Information) => "information",
            Some(Scaling::Sizes) => "sizes",
            Some(Scaling::None) => "none",
        };
        vec![
            row.optimiser.clone(),
            scaling.to_string(),
            row.iterations.to_string(),
            row.gradients.to_string(),
            format!("{:.1e}", row.cost_excess),
            if row.reached { "" } else { "not there" }.to_string(),
        ]
    });
    let formula = &study.formula;
    format!(
        "{} samples, {} states, {} outputs, {} unknowns, {} stages\n\n{}\n\nbest steps\n{}\n\n\
         one gradient by the number of free unknowns\n{}\n\
         by formula (Euler, full matrices): direct {:.3e}, reverse {:.3e} operations\n\n\
         to within 0.01 standard errors of the minimum\n{}",
        size.samples,
        size.states,
        size.outputs,
        size.unknowns,
        size.stages,
        table(&header, techniques),
        table(&["technique", "step", "error"], curves),
        table(
            &[
                "unknowns",
                "direct op.",
                "adjoint op.",
                "direct ms",
                "adjoint ms"
            ],
            costs
        ),
        (formula.direct_multiplications + formula.direct_additions) as f64,
        (formula.reverse_multiplications + formula.reverse_additions) as f64,
        table(
            &[
                "optimiser",
                "Hessian at start",
                "iterations",
                "gradients",
                "above minimum",
                ""
            ],
            descents
        ),
    )
}

fn table(header: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut table = Table::new();
    table
        .load_style(UTF8_BORDERS_ONLY)
        .set_header(header.to_vec())
        .add_rows(rows);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}
