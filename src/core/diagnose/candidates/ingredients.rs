//! What terms are made from, for who proposes terms that are in no catalogue.

use indexmap::IndexMap;

use super::subject::Subject;
use super::variables::Variable;
use crate::diagnose::case::{Case, compile};
use crate::diagnose::effect::Effect;
use crate::flight::Unit;
use crate::model::expression::{self, Expression};
use crate::model::{Edit, EditKind, ModelDocument, Reference};

pub(in crate::diagnose) struct Ingredients<'c> {
    subject: Subject<'c>,
    variables: Vec<Variable>,
}

/// A term in the making.
pub(in crate::diagnose) struct Draft<'d> {
    /// A state, a named coefficient or an output.
    pub target: &'d str,
    pub text: &'d str,
    /// What varies in it, with its mean over the fit, SI.
    pub names: &'d [(String, f64)],
    /// From where its first name is taken, SI; absent: from where the model takes it, else from its mean.
    pub from: Option<f64>,
}

impl<'c> Ingredients<'c> {
    pub(in crate::diagnose) fn new(case: &'c Case, document: &'c ModelDocument) -> Self {
        let subject = Subject::new(case, document);
        Self {
            variables: subject.variables(),
            subject,
        }
    }

    /// Equations that carry aerodynamics: states, named coefficients and outputs.
    pub(in crate::diagnose) fn aerodynamic(&self) -> Vec<String> {
        let laws = self.subject.aerodynamic().into_iter();
        laws.map(|law| law.target).collect()
    }

    /// Names of flow angles, rates, speed and controls, in the model or recorded beside it.
    pub(in crate::diagnose) fn variables(&self) -> Vec<String> {
        self.variables.iter().map(|v| v.name.clone()).collect()
    }

    /// Whether an equation has a name in it already.
    pub(in crate::diagnose) fn holds(&self, target: &str, name: &str) -> bool {
        let names = self.equation(target);
        names.is_some_and(|equation| equation.names().iter().any(|(found, _)| *found == name))
    }

    /// The term as an effect that the model takes.
    pub(in crate::diagnose) fn term(&self, draft: &Draft<'_>) -> Option<Effect> {
        let mut about = IndexMap::new();
        let mut channels = IndexMap::new();
        for (at, (name, mean)) in draft.names.iter().enumerate() {
            let own = self
                .variables
                .iter()
                .find(|variable| variable.name == *name);
            let channel = own.and_then(|variable| variable.channel.clone());
            let reference = match draft.from.filter(|_| at == 0) {
                Some(from) => self.in_its_unit(name, from),
                None => self.reference(draft.target, name, *mean),
            };
            about.extend(reference.map(|reference| (name.clone(), reference)));
            channels.extend(channel.map(|channel| (name.clone(), channel)));
        }
        let is_channel = channels.contains_key(draft.text);
        let kind = match draft.names {
            [(one, _)] if is_channel && one == draft.text => EditKind::UnrecordedInput,
            _ => EditKind::MissingTerm,
        };
        let edit = Edit {
            about,
            channels,
            ..Edit::new(kind, draft.target).with_term(draft.text)
        };
        self.taken(edit)
    }

    /// The history of a quantity in an equation.
    pub(in crate::diagnose) fn lagged(&self, target: &str, name: &str) -> Option<Effect> {
        self.taken(Edit::new(EditKind::UnsteadyAero, target).with_term(name))
    }

    fn taken(&self, edit: Edit) -> Option<Effect> {
        let effect = self.subject.fit(edit)?;
        let edited = effect.apply(self.subject.document).ok()?;
        compile(&edited.document).ok().map(|_| effect)
    }

    fn reference(&self, target: &str, name: &str, mean: f64) -> Option<Reference> {
        let variable = self
            .variables
            .iter()
            .find(|variable| variable.name == *name);
        match (variable, self.equation(target)) {
            (Some(variable), Some(equation)) => self.subject.reference(variable, &equation),
            _ => self.in_its_unit(name, mean),
        }
    }

    fn in_its_unit(&self, name: &str, value: f64) -> Option<Reference> {
        let document = self.subject.document;
        let of_model = (document.inputs.get(name).map(|x| &x.unit))
            .or_else(|| document.states.get(name).map(|x| &x.unit))
            .or_else(|| document.definitions.get(name).map(|x| &x.unit));
        let mut channels = self.subject.channels.iter();
        let recorded = || channels.find(|c| c.name == name).map(|c| &c.input.unit);
        let unit = Unit::parse(of_model.or_else(recorded)?).ok()?;
        let rounded = format!("{:.2e}", unit.from_si(value));
        rounded.parse().ok().map(Reference::Value)
    }

    fn equation(&self, target: &str) -> Option<Expression> {
        let document = self.subject.document;
        let text = (document.definitions.get(target).map(|x| &x.equation))
            .or_else(|| document.states.get(target).map(|x| &x.derivative))
            .or_else(|| document.outputs.get(target).map(|x| &x.equation))?;
        expression::parse(text).ok()
    }
}
