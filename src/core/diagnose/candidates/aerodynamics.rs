//! Equations that carry aerodynamics, and how the flow may follow the motion late.

use super::monomials::Monomial;
use super::subject::Subject;
use super::variables::Variable;
use crate::diagnose::effect::Effect;
use crate::flight::{Dimension, Family, Motion, PhysicalQuantity, Unit};
use crate::model::expression::{self, Expression};
use crate::model::{EditKind, Per};

/// An equation with aerodynamic derivatives in it.
pub(super) struct Law {
    pub target: String,
    pub equation: Expression,
    pub motion: Option<Motion>,
}

pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    let mut effects = unsteady(subject);
    effects.extend(separated(subject));
    effects
}

impl Subject<'_> {
    /// Named coefficients where the document has them, else the equations of states; and accelerations that outputs make
    /// of derivatives of their own.
    pub(super) fn aerodynamic(&self) -> Vec<Law> {
        let document = self.document;
        let law = |target: &str, text: &str, quantity: Option<PhysicalQuantity>| {
            let equation = expression::parse(text).ok()?;
            self.has_derivatives(&equation).then(|| Law {
                target: target.to_string(),
                equation,
                motion: quantity.and_then(PhysicalQuantity::motion),
            })
        };
        let family = |quantity: Option<PhysicalQuantity>| quantity.map(PhysicalQuantity::family);
        let definitions = || document.definitions.iter();
        let named: Vec<Law> = definitions()
            .filter(|(name, _)| family(self.quantities.get(name)) == Some(Family::Coefficient))
            .filter_map(|(name, x)| law(name, &x.equation, self.quantities.get(name)))
            .collect();
        let mut laws = if named.is_empty() {
            let states = document.states.iter().filter(|(name, _)| {
                let family = family(self.quantities.get(name));
                !matches!(
                    family,
                    Some(Family::Attitude | Family::Position | Family::Structural)
                ) && self.quantities.get(name) != Some(PhysicalQuantity::Altitude)
            });
            let states =
                states.filter_map(|(name, x)| law(name, &x.derivative, self.quantities.get(name)));
            let forces = definitions().filter(|(name, x)| match self.quantities.get(name) {
                Some(quantity) => !quantity.is_flow_angle() && !self.is_a_measurement(name),
                None => may_be_a_force(&x.unit),
            });
            let forces =
                forces.filter_map(|(name, x)| law(name, &x.equation, self.quantities.get(name)));
            states.chain(forces).collect()
        } else {
            named
        };
        let outputs = document.outputs.iter().filter(|(name, _)| {
            matches!(
                family(self.quantities.output(name)),
                Some(Family::Accelerometer | Family::AngularAcceleration | Family::Coefficient)
            ) && !document.states.contains_key(*name)
                && !document.definitions.contains_key(*name)
        });
        laws.extend(
            outputs.filter_map(|(name, x)| law(name, &x.equation, self.quantities.output(name))),
        );
        laws
    }

    /// A definition that is a recorded input less its errors.
    fn is_a_measurement(&self, name: &str) -> bool {
        let Some(quantity) = self.quantities.get(name) else {
            return false;
        };
        let mut same = self.quantities.all_of(quantity);
        same.any(|input| self.document.inputs.contains_key(input) && self.depends(name, input))
    }

    /// Whether a free parameter of the whole job multiplies something that varies. A length is a lever arm.
    fn has_derivatives(&self, equation: &Expression) -> bool {
        let document = self.document;
        let is_derivative = |name: &String| {
            let parameter = document.parameters.get(name);
            parameter.is_some_and(|parameter| {
                let unit = Unit::parse(&parameter.unit).map(|unit| unit.dimension);
                !parameter.fixed && parameter.per == Per::Job && unit != Ok(Dimension::METRE)
            })
        };
        let multiplies = |monomial: &Monomial| {
            monomial.powers.keys().any(is_derivative)
                && monomial.powers.keys().any(|name| self.varies(name))
        };
        let direct = Monomial::all_of(equation, &|_| None);
        direct.iter().any(multiplies)
    }
}

/// Whether a definition of which nothing else is known can be a force or a moment: a coefficient, or over mass or inertia.
/// An angle is none.
fn may_be_a_force(unit: &str) -> bool {
    let per_second = |dimension: Dimension| dimension.over(Dimension::SECOND);
    Unit::parse(unit).is_ok_and(|parsed| {
        let dimension = parsed.dimension;
        (dimension.is_none() && Unit::si_name(unit) != "rad")
            || dimension == per_second(per_second(Dimension::NONE))
            || dimension == per_second(per_second(Dimension::METRE))
    })
}

/// Flow angles, of the motion that an equation belongs to, whose history it may feel; near the hover, where there is no
/// such angle, the velocities and the controls, which the inflow of a rotor follows.
fn unsteady(subject: &Subject<'_>) -> Vec<Effect> {
    let variables = subject.variables();
    let has_angle = variables.iter().any(|v| v.quantity.is_flow_angle());
    let is_of_flow = |v: &Variable| match has_angle {
        true => v.quantity.is_flow_angle(),
        false => v.is_velocity() || v.is_control(),
    };
    let angles: Vec<_> = (variables.iter())
        .filter(|v| is_of_flow(v) && v.channel.is_none())
        .collect();
    let mut effects = Vec::new();
    for law in subject.aerodynamic() {
        if subject.document.outputs.contains_key(&law.target) && !subject.varies(&law.target) {
            continue;
        }
        for angle in &angles {
            let own = angle.quantity.motion();
            let fits = (law.motion).is_none_or(|motion| own.is_none_or(|own| own == motion));
            if fits
                && angle.name != law.target
                && !subject.closes_a_circle(&angle.name, &law.target)
            {
                effects.push(Effect::edit(
                    EditKind::UnsteadyAero,
                    law.target.as_str(),
                    Some(&angle.name),
                ));
            }
        }
    }
    effects
}

/// Separation of the flow, which lift, drag and moment feel together.
fn separated(subject: &Subject<'_>) -> Vec<Effect> {
    use PhysicalQuantity::{
        AngleOfAttack, DragCoefficient, LiftCoefficient, PitchingMomentCoefficient,
    };
    let variables = subject.variables();
    let angle = variables
        .iter()
        .find(|v| v.quantity == AngleOfAttack && v.channel.is_none());
    let named = |quantity| {
        let mut names = subject.quantities.all_of(quantity);
        names.find(|name| subject.document.definitions.contains_key(*name))
    };
    let (Some(angle), Some(lift)) = (angle, named(LiftCoefficient)) else {
        return Vec::new();
    };
    let (drag, moment) = (named(DragCoefficient), named(PitchingMomentCoefficient));
    let groups = [
        vec![Some(lift)],
        vec![Some(lift), moment],
        vec![Some(lift), drag],
        vec![Some(lift), drag, moment],
    ];
    let joined = groups.into_iter().filter_map(|group| {
        let names: Option<Vec<&str>> = group.into_iter().collect();
        names.map(|names| names.join("+"))
    });
    joined
        .map(|targets| Effect::edit(EditKind::StallHysteresis, targets, Some(&angle.name)))
        .collect()
}
