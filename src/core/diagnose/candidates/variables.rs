//! Quantities that aerodynamic terms are made of: of each, one name, from where terms take it, and from what it differs.

use super::monomials::Monomial;
use super::recorded::Movement;
use super::subject::Subject;
use crate::flight::{Family, Motion, PhysicalQuantity};
use crate::model::expression::{self, BinaryOperator, Expression, Kind};
use crate::model::{Input, Reference};

/// Something that a term may hold.
#[derive(Clone)]
pub(super) struct Variable {
    pub name: String,
    pub quantity: PhysicalQuantity,
    /// What the model is told of a recorded channel that it does not use yet.
    pub channel: Option<Input>,
    pub movement: Option<Movement>,
}

impl Variable {
    pub(super) fn is_control(&self) -> bool {
        self.quantity.is_control()
    }

    pub(super) fn is_rate(&self) -> bool {
        self.quantity.family() == Family::Gyro
    }

    pub(super) fn is_speed(&self) -> bool {
        matches!(
            self.quantity,
            PhysicalQuantity::Airspeed | PhysicalQuantity::Mach
        )
    }

    /// A component of the velocity through the air.
    pub(super) fn is_velocity(&self) -> bool {
        use PhysicalQuantity::{VelocityX, VelocityY, VelocityZ};
        matches!(self.quantity, VelocityX | VelocityY | VelocityZ)
    }

    pub(super) fn is_flow_rate(&self) -> bool {
        use PhysicalQuantity::{AngleOfAttackRate, AngleOfSideslipRate};
        matches!(self.quantity, AngleOfAttackRate | AngleOfSideslipRate)
    }

    /// Whether the motion that it belongs to is symmetric: it changes sign with the side.
    pub(super) fn is_odd(&self) -> bool {
        self.quantity.motion() == Some(Motion::Lateral)
    }
}

impl Subject<'_> {
    /// Flow angles, rates, speed and controls that move in the data.
    pub(super) fn variables(&self) -> Vec<Variable> {
        use PhysicalQuantity::{
            Airspeed, AngleOfAttack, AngleOfSideslip, Mach, PitchRate, RollRate, YawRate,
        };
        let single = [AngleOfAttack, AngleOfSideslip, RollRate, PitchRate, YawRate];
        let mut variables: Vec<Variable> = single
            .into_iter()
            .filter_map(|quantity| self.variable(quantity))
            .collect();
        // where both are recorded the one is hardly told from the other
        variables.extend(self.variable(Airspeed).or_else(|| self.variable(Mach)));
        variables.extend(self.velocities(&variables));
        variables.extend(self.flow_rates());
        let inputs = self.document.inputs.keys();
        let controls = inputs.filter_map(|name| {
            let quantity = self.quantities.get(name).filter(|q| q.is_control())?;
            Some(self.of_model(name, quantity))
        });
        variables.extend(controls);
        let recorded = self
            .channels
            .iter()
            .filter(|channel| channel.quantity.is_control());
        variables.extend(recorded.map(|channel| Variable {
            name: channel.name.clone(),
            quantity: channel.quantity,
            channel: Some(channel.input.clone()),
            movement: Some(channel.movement),
        }));
        variables.retain(|variable| {
            (variable.movement).is_none_or(|movement| movement.moves(variable.quantity))
        });
        variables
    }

    /// Of components of the velocity, what no angle or speed among `others` says: near the hover there are none.
    fn velocities(&self, others: &[Variable]) -> Vec<Variable> {
        use PhysicalQuantity::{AngleOfAttack, AngleOfSideslip, VelocityX, VelocityY, VelocityZ};
        let has = |quantity: PhysicalQuantity| others.iter().any(|v| v.quantity == quantity);
        let wanted = [
            (VelocityX, !others.iter().any(Variable::is_speed)),
            (VelocityY, !has(AngleOfSideslip)),
            (VelocityZ, !has(AngleOfAttack)),
        ];
        let states = wanted.into_iter().filter(|(_, is_wanted)| *is_wanted);
        states
            .filter_map(|(quantity, _)| self.variable(quantity))
            .collect()
    }

    /// Rates of the flow angles: quantities of their own, or the derivatives of states.
    fn flow_rates(&self) -> Vec<Variable> {
        use PhysicalQuantity::{
            AngleOfAttack, AngleOfAttackRate, AngleOfSideslip, AngleOfSideslipRate,
        };
        let rate = |(angle, rate): (PhysicalQuantity, PhysicalQuantity)| {
            let is_state = |name: &&str| self.document.states.contains_key(*name);
            let state = || self.quantities.all_of(angle).find(is_state);
            let derivative = || {
                Some(Variable {
                    name: format!("{}dot", state()?),
                    quantity: rate,
                    channel: None,
                    movement: None,
                })
            };
            self.variable(rate).or_else(derivative)
        };
        let both = [
            (AngleOfAttack, AngleOfAttackRate),
            (AngleOfSideslip, AngleOfSideslipRate),
        ];
        both.into_iter().filter_map(rate).collect()
    }

    /// The model's own state, else definition, else input; else a recorded channel.
    fn variable(&self, quantity: PhysicalQuantity) -> Option<Variable> {
        let document = self.document;
        let of = |is: &dyn Fn(&str) -> bool| {
            let mut names = self.quantities.all_of(quantity);
            names
                .find(|name| is(name))
                .map(|name| self.of_model(name, quantity))
        };
        let recorded = || {
            let mut channels = self.channels.iter();
            let channel = channels.find(|channel| channel.quantity == quantity)?;
            Some(Variable {
                name: channel.name.clone(),
                quantity,
                channel: Some(channel.input.clone()),
                movement: Some(channel.movement),
            })
        };
        of(&|name| document.states.contains_key(name))
            .or_else(|| of(&|name| document.definitions.contains_key(name)))
            .or_else(|| of(&|name| document.inputs.contains_key(name)))
            .or_else(recorded)
    }

    fn of_model(&self, name: &str, quantity: PhysicalQuantity) -> Variable {
        Variable {
            name: name.to_string(),
            quantity,
            channel: None,
            movement: self.movement(name),
        }
    }

    /// From what differences of a variable are taken in a term of an equation: what the model itself takes it from; else,
    /// of what is not zero in steady symmetric flight, the mean over the fit.
    pub(super) fn reference(
        &self,
        variable: &Variable,
        equation: &Expression,
    ) -> Option<Reference> {
        let document = self.document;
        let others = (document.states.values().map(|state| &state.derivative))
            .chain(document.definitions.values().map(|x| &x.equation))
            .chain(document.outputs.values().map(|x| &x.equation));
        let others: Vec<Expression> = others
            .filter_map(|text| expression::parse(text).ok())
            .collect();
        let mut equations = std::iter::once(equation).chain(&others);
        if let Some(found) = equations.find_map(|e| self.taken_off(e, &variable.name)) {
            return Some(Reference::Expression(found));
        }
        if variable.is_odd() || variable.is_rate() {
            return None;
        }
        let middle = variable.movement?.middle;
        let unit = self.unit(variable)?;
        Some(Reference::Value(rounded(unit.from_si(middle))))
    }

    fn unit(&self, variable: &Variable) -> Option<crate::flight::Unit> {
        let document = self.document;
        let name = &variable.name;
        let text = (variable.channel.as_ref().map(|input| &input.unit))
            .or_else(|| document.inputs.get(name).map(|x| &x.unit))
            .or_else(|| document.states.get(name).map(|x| &x.unit))
            .or_else(|| document.definitions.get(name).map(|x| &x.unit))?;
        crate::flight::Unit::parse(text).ok()
    }

    /// What an equation takes off a name: a parameter or constant, or an expression in them.
    fn taken_off(&self, expression: &Expression, name: &str) -> Option<String> {
        let is = |part: &Expression| matches!(&part.kind, Kind::Name(found) if found == name);
        match &expression.kind {
            Kind::Binary(BinaryOperator::Subtract, left, right)
                if is(left) && self.is_held(right) =>
            {
                Some(right.to_string())
            }
            Kind::Binary(_, left, right) => self
                .taken_off(left, name)
                .or_else(|| self.taken_off(right, name)),
            Kind::Negate(inner) => self.taken_off(inner, name),
            Kind::Call(_, arguments) => arguments.iter().find_map(|a| self.taken_off(a, name)),
            Kind::Number(_) | Kind::Name(_) => None,
        }
    }

    /// The products of what varies that an equation holds with a derivative. Definitions that are no quantity of their own
    /// are written out.
    pub(super) fn products(&self, equation: &Expression) -> Vec<Monomial> {
        let document = self.document;
        let written_out = |name: &str| {
            let definition = document.definitions.get(name)?;
            let own = self.quantities.get(name).is_some();
            (!own)
                .then(|| expression::parse(&definition.equation).ok())
                .flatten()
        };
        let derivative = |monomial: &Monomial| {
            let is = |name: &String| document.parameters.contains_key(name);
            monomial.powers.keys().any(is)
        };
        let mut all = Monomial::all_of(equation, &written_out);
        all.retain(derivative);
        for monomial in &mut all {
            monomial.powers.retain(|name, _| self.varies(name));
        }
        all
    }
}

/// To four digits: what a difference is taken from need not be exact.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
