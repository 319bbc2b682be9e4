//! The declared model, fitted: what everything else is judged against, so it must be a minimum, and the lowest known.

use std::ops::ControlFlow;

use super::case::{Case, Values};
use super::fitted::Fitted;
use super::inconclusive::Inconclusive;
use super::report::Step;
use super::watch::{Stopped, Watcher, ask, tell};
use crate::estimate::{StartMethod, TimeHistory, estimate};

/// A fit that used up the job's budget of iterations goes on with this one.
const FURTHER_ITERATIONS: usize = 300;

/// A minimum that lies lower by this much of ln L is another one.
const LOWER: f64 = 1.0;

/// The declared model with its fit.
#[derive(Clone, Debug)]
pub(super) struct Declared {
    pub fitted: Fitted,
    /// Of the flights that were fitted.
    pub histories: Vec<TimeHistory>,
    /// What the reader should know of the fit.
    pub remarks: Vec<String>,
    /// How often a lower minimum was found.
    renewals: usize,
}

impl Declared {
    /// Fits the declared model as the job's options say, and goes on where their budget was used up.
    ///
    /// # Errors
    /// The model cannot be fitted, or `watcher` stopped it.
    pub(super) fn of(case: &Case, watcher: &mut Watcher<'_>) -> Result<Self, Inconclusive> {
        let mut declared = Self::from(case, &Values::new(), None, watcher)?;
        let first = &declared.fitted.estimate;
        if !first.outcome.is_minimum() {
            let (cost, reason) = (first.cost, first.reason.clone());
            let values = declared.fitted.values();
            // what fails from there leaves the first fit, with its remark
            if let Ok(further) = Self::from(case, &values, Some(FURTHER_ITERATIONS), watcher)
                && further.fitted.estimate.cost <= cost
            {
                declared = further;
            }
            let now = &declared.fitted.estimate;
            declared.remarks.push(if now.outcome.is_minimum() {
                format!(
                    "the fit of the declared model had not converged with the job's options ({reason}); it was taken on until it had"
                )
            } else {
                format!(
                    "the fit of the declared model did not converge ({}): what it is said to lack may be its own doing; give it better start values, or fix what the data cannot tell",
                    now.reason
                )
            });
        }
        let step = Step::Fitted {
            round: 0,
            cost: declared.fitted.estimate.cost,
            iterations: declared.fitted.estimate.iterations,
        };
        tell(watcher, &step)?;
        Ok(declared)
    }

    /// The declared model fitted anew from the values of a richer one, where that leads to a clearly lower cost: then
    /// the first fit had ended in a false minimum.
    pub(super) fn lower(
        &self,
        case: &Case,
        richer: &Fitted,
        watcher: &mut Watcher<'_>,
    ) -> Option<Self> {
        let before = self.fitted.estimate.cost;
        let mut values = richer.values();
        // what the declared model holds, it holds where it says, whatever the richer one freed
        let holds = |name: &String| case.document.parameters.get(name).is_some_and(|p| p.fixed);
        values.retain(|(name, _), _| !holds(name));
        let mut lower = Self::from(case, &values, Some(FURTHER_ITERATIONS), watcher).ok()?;
        let now = lower.fitted.estimate.cost;
        if now >= before - LOWER {
            return None;
        }
        lower.renewals = self.renewals + 1;
        lower.remarks.clone_from(&self.remarks);
        lower.remarks.push(format!(
            "the fit of the declared model had ended in a false minimum (-ln L {before:.1}); from other start values it reaches {now:.1}, and that is what the diagnosis starts from"
        ));
        Some(lower)
    }

    fn from(
        case: &Case,
        values: &Values,
        budget: Option<usize>,
        watcher: &mut Watcher<'_>,
    ) -> Result<Self, Inconclusive> {
        let mut problem = case.problem(&case.document, values)?;
        if let Some(iterations) = budget {
            problem.options.start = StartMethod::Document {};
            problem.options.max_iterations = problem.options.max_iterations.max(iterations);
        }
        let mut stopped = Ok(());
        let solution = estimate(&problem, &mut |_| {
            stopped = stopped.and(ask(watcher));
            match stopped {
                Ok(()) => ControlFlow::Continue(()),
                Err(Stopped) => ControlFlow::Break(()),
            }
        });
        stopped?;
        let solution = solution?;
        problem.options = case.options.clone();
        let fitted = Fitted::of(case.document.clone(), problem, &solution);
        Ok(Self {
            fitted,
            histories: solution.histories,
            remarks: Vec::new(),
            renewals: 0,
        })
    }

    pub(super) fn renewals(&self) -> usize {
        self.renewals
    }
}
