//! The progress of a job in the terminal: a bar that is full when the steps have become small enough.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::diagnose::Step;
use crate::estimate::{self, Iteration};

/// Steps of this many standard errors count as the beginning of the way.
const LONGEST_STEP: f64 = 100.0;
/// Resolution of the bar.
const LENGTH: u64 = 1000;

/// Shows iterations as they come; where output is no terminal, one line each.
pub(super) struct ProgressLine {
    bar: ProgressBar,
    tolerance: f64,
}

impl ProgressLine {
    /// `tolerance` is the length of step, in standard errors, at which the solver stops.
    pub(super) fn new(tolerance: f64) -> Self {
        let bar = ProgressBar::with_draw_target(Some(LENGTH), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{bar:30} {msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { bar, tolerance }
    }

    pub(super) fn say(&self, text: &str) {
        self.line(text);
        self.bar.set_message(text.to_string());
    }

    /// What an estimation tells on its way.
    pub(super) fn told(&self, told: estimate::Progress<'_>) {
        match told {
            estimate::Progress::Start(report) => self.say(&report.text),
            estimate::Progress::Iteration(iteration) => self.iteration(iteration),
            estimate::Progress::Step(step) => self.say(&step.finding),
        }
    }

    pub(super) fn iteration(&self, iteration: &Iteration) {
        let text = format!(
            "iteration {:2}   -ln L {:.4}   step {:.1e} standard errors",
            iteration.number, iteration.cost, iteration.step
        );
        self.line(&text);
        self.bar.set_message(text);
        if iteration.step > 0.0 {
            let way = (LONGEST_STEP / iteration.step).ln() / (LONGEST_STEP / self.tolerance).ln();
            let position = (way.clamp(0.0, 1.0) * LENGTH as f64) as u64;
            // progress is not taken back: a long step now and then is part of the way
            self.bar.set_position(position.max(self.bar.position()));
        }
    }

    /// A step of a diagnosis.
    pub(super) fn diagnosis(&self, step: &Step) {
        match step {
            Step::Fitted { cost, iterations, .. } => {
                self.say(&format!("declared model fitted: -ln L {cost:.4}, {iterations} iterations"));
            }
            Step::Screened { round, candidates, visible, .. } => self.say(&format!(
                "round {round}: {candidates} candidates screened, {visible} of them can be seen in these data"
            )),
            Step::Tried { name, likelihood_ratio, .. } => {
                self.bar.set_message(format!("tried {name}: likelihood ratio {likelihood_ratio:.1}"));
            }
            Step::Refused { name, sentence, .. } => self.say(&format!("refused {name}: {sentence}")),
            Step::Accepted { name, likelihood_ratio, sentence, .. } => {
                self.say(&format!("accepted {name} (likelihood ratio {likelihood_ratio:.1}): {sentence}"));
            }
        }
    }

    pub(super) fn finish(&self, text: &str) {
        self.line(text);
        self.bar.set_position(LENGTH);
        self.bar.finish_with_message(text.to_string());
    }

    fn line(&self, text: &str) {
        if self.bar.is_hidden() {
            eprintln!("{text}");
        }
    }
}
