//! Effects that later ones made needless are taken out again.

use super::case::{Case, Values};
use super::colour::Colour;
use super::fitted::Fitted;
use super::found::{Accepted, Found};
use super::stack::Layout;
use crate::model::{Added, AddedRole, EditError, ModelDocument};

/// Takes out again what later effects made needless.
pub(super) fn remove(case: &Case, declared: &Fitted, base: &mut Fitted, found: &mut Found) {
    let mut at = 0;
    while found.accepted.len() > 1 && at < found.accepted.len() {
        if let Some((without, cost)) = removal(case, declared, base, &found.accepted, at)
            && cost < found.accepted[at].evidence.threshold
            && let Ok(fitted) = Fitted::trial(case, without.document, &without.values)
        {
            *base = fitted;
            let removed = found.accepted.remove(at);
            for (accepted, added) in found.accepted.iter_mut().zip(without.added) {
                accepted.added = added;
            }
            found.needless(removed, cost);
            at = 0;
        } else {
            at += 1;
        }
    }
}

/// The model without one of the effects, and the likelihood ratio that this costs; `None` where it cannot be told.
fn removal(
    case: &Case,
    declared: &Fitted,
    base: &Fitted,
    accepted: &[Accepted],
    at: usize,
) -> Option<(Without, f64)> {
    if accepted[at].effect.edits.is_empty() {
        return None;
    }
    let without = Without::new(&declared.document, base.values(), accepted, at).ok()?;
    let cost = cost_of_removal(case, base, without.document.clone(), &without.values)?;
    Some((without, cost))
}

/// A model without one of its effects.
struct Without {
    document: ModelDocument,
    /// Values of the model with the effect, under the names that parameters have without it.
    values: Values,
    /// The parameters that each of the others adds now.
    added: Vec<Vec<Added>>,
}

impl Without {
    /// Applies all effects but one to the declared model. Edits choose names that nothing has yet, so that a parameter
    /// may be called differently where an effect before it is left out.
    fn new(
        declared: &ModelDocument,
        values: Values,
        accepted: &[Accepted],
        at: usize,
    ) -> Result<Self, EditError> {
        let mut document = declared.clone();
        let mut added = Vec::new();
        let others = accepted.iter().enumerate().filter(|(i, _)| *i != at);
        let mut names: Vec<(&str, String)> = Vec::new();
        for (_, other) in others {
            let edited = other.effect.apply(&document)?;
            // what is read off the recording is shared by effects, and added by the first of them
            let own = |added: &&Added| added.role != AddedRole::Reference;
            let now = edited.added.iter().filter(own);
            let pairs = other.added.iter().filter(own).zip(now);
            names.extend(pairs.map(|(before, now)| (&*before.name, now.name.clone())));
            document = edited.document;
            added.push(edited.added);
        }
        let gone = |name: &str| accepted[at].added.iter().any(|added| added.name == name);
        let values = (values.into_iter())
            .filter(|((name, _), _)| !gone(name))
            .map(|((name, segment), value)| {
                let now = names.iter().find(|(before, _)| *before == name);
                ((now.map_or(name, |(_, now)| now.clone()), segment), value)
            })
            .collect();
        Ok(Self {
            document,
            values,
            added,
        })
    }
}

/// The likelihood ratio that removing an effect costs.
fn cost_of_removal(
    case: &Case,
    with: &Fitted,
    without: ModelDocument,
    start: &Values,
) -> Option<f64> {
    let layout = Layout::of(&with.problem);
    let fitted = Fitted::trial(case, without, start).ok()?;
    let orders = Colour::of_best_order(&layout, &fitted.residual).orders();
    Some(2.0 * (with.ln_likelihood(&orders) - fitted.ln_likelihood(&orders)))
}

#[cfg(test)]
mod tests {
    use super::super::effect::Effect;
    use super::super::flight::Flight;
    use super::super::report::{Evidence, Member};
    use super::*;
    use crate::diagnose::knowledge::Knowledge;
    use crate::estimate::{Options, Role};
    use crate::model::{EditKind, Model, catalog};
    use crate::simulate::{Scenario, ScenarioEffect, Steps};

    /// An elevator maneuver of an aircraft whose pitching moment has a term alpha q.
    fn case() -> Case {
        let mut scenario: Scenario =
            toml::from_str(include_str!("../../../data/elevator.toml")).expect("a scenario");
        let truth = ScenarioEffect::parse("missing_term:q:alpha*q=-30").expect("an effect");
        scenario.effects.push(truth);
        let document = catalog::find("short-period").expect("a model");
        let model = Model::compile(&document).expect("a model");
        let maneuver = scenario.fly(&model).expect("a maneuver");
        let channels = maneuver.channels().iter();
        let flight = Flight {
            label: "elevator".to_string(),
            role: Role::Estimation,
            time: maneuver.time().to_vec(),
            steps: Steps::Even(scenario.step),
            channels: channels
                .map(|(name, channel)| {
                    let recorded = (channel.values.clone(), channel.unit.dimension);
                    (name.clone(), recorded)
                })
                .collect(),
        };
        Case {
            document,
            flights: vec![flight],
            options: Options::default(),
            candidates: Vec::new(),
            knowledge: Knowledge::default(),
            consumed: Vec::new(),
        }
    }

    fn accepted(effect: &Effect, added: Vec<Added>, fitted: &Fitted, threshold: f64) -> Accepted {
        Accepted {
            group: vec![Member {
                effect: effect.clone(),
                weight: 1.0,
            }],
            effect: effect.clone(),
            added,
            fitted: fitted.clone(),
            evidence: Evidence {
                likelihood_ratio: 0.0,
                threshold,
                score: None,
                visible_fraction: None,
                smallest_seen: None,
                held_out: None,
                held_out_by_output: Vec::new(),
            },
        }
    }

    /// Both terms are called after their equation: without the first, the second has the first one's name.
    #[test]
    fn what_is_left_is_told_by_its_own_size() {
        let case = case();
        let declared = Fitted::trial(&case, case.document.clone(), &Values::new()).expect("a fit");
        let term = |term| Effect::edit(EditKind::MissingTerm, "q", Some(term));
        let (square, product) = (term("alpha^2"), term("alpha*q"));
        let one = square.apply(&case.document).expect("a model");
        let two = product.apply(&one.document).expect("a model");
        let mut base = Fitted::trial(&case, two.document, &declared.values()).expect("a fit");
        let size = |base: &Fitted, added: &[Added]| {
            let sizes = base.sizes(added);
            assert_eq!(sizes.len(), 1, "{added:?}");
            (sizes[0].value, sizes[0].standard_error_si().expect("one"))
        };
        let ((before, error), (other, _)) = (size(&base, &two.added), size(&base, &one.added));
        assert!((before - other).abs() > 10.0 * error, "{before}, {other}");

        let mut found = Found::default();
        // whatever the first takes off, it is needless; the second never is
        found
            .accepted
            .push(accepted(&square, one.added, &base, f64::INFINITY));
        found
            .accepted
            .push(accepted(&product, two.added, &base, f64::NEG_INFINITY));
        remove(&case, &declared, &mut base, &mut found);

        let [left] = found.accepted.as_slice() else {
            panic!("{} effects are left", found.accepted.len());
        };
        assert_eq!(left.effect, product);
        let (after, _) = size(&base, &left.added);
        assert!(
            (after - before).abs() < 3.0 * error,
            "{before}, {after} ± {error}"
        );
        let equation = &base.document.states["q"].derivative;
        let name = &left.added[0].name;
        assert!(
            equation.contains(&format!("{name}*(alpha*q)")),
            "{equation}"
        );
    }
}
