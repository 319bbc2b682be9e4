//! Channels under each other's name: where it is worth a trial, and where that begins.

use super::case::Values;
use super::effect::{Effect, EffectKind};
use super::fitted::Fitted;
use super::share_left::share_left;
use super::stack::Layout;
use crate::flight::Unit;
use crate::model::{EditKind, Edited, Parameter, Start};

/// Of a channel that is under its own name, a model that fits leaves less than this share of the variance.
const FITS: f64 = 0.2;

/// Exchanged, or not: what lies between them is something else.
const WHOLE: f64 = 0.1;

/// Why two channels are hardly exchanged: both are explained as they stand.
pub(super) fn is_refuted(effect: &Effect, base: &Fitted) -> Option<String> {
    if effect.kind != EffectKind::Edit(EditKind::SwappedChannels) {
        return None;
    }
    let largest = (effect.target.split('+'))
        .filter_map(|name| unexplained(base, name))
        .fold(0.0, f64::max);
    (largest < FITS).then(|| {
        format!(
            "both are explained as they are recorded: {:.1} % of their variance is left at most",
            100.0 * largest
        )
    })
}

/// The share of an output's variance that a fit leaves.
fn unexplained(base: &Fitted, output: &str) -> Option<f64> {
    let problem = &base.problem;
    let place = (problem.model.outputs.iter()).position(|found| found.name == output)?;
    let layout = Layout::of(problem);
    let residuals = layout.of_output(&base.residual, place);
    let measured = problem
        .segments
        .iter()
        .map(|segment| &*segment.measured[place]);
    share_left(measured.zip(residuals))
}

/// What was fitted to exchanged channels is no place to begin at: the declared start is, the channels exchanged.
pub(super) fn start(edited: &Edited) -> Values {
    let added = |name: &str| edited.added.iter().any(|added| added.name == name);
    let of = |(name, parameter): (&String, &Parameter)| {
        let unit = Unit::parse(&parameter.unit).ok()?;
        match parameter.start {
            _ if parameter.fixed => None,
            _ if added(name) => Some(((name.clone(), None), 1.0)),
            Start::Value(value) => Some(((name.clone(), None), unit.to_si(value))),
            Start::FromData(_) => None,
        }
    };
    let declared = edited.document.parameters.iter().filter_map(of);
    declared.collect()
}

/// Whether what was exchanged is, in whole.
pub(super) fn is_whole(share: f64) -> bool {
    (share - 1.0).abs() < WHOLE
}
