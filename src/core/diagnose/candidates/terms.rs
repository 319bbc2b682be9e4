//! Terms that an aerodynamic equation may lack.

use std::collections::BTreeMap;

use indexmap::IndexMap;

use super::aerodynamics::Law;
use super::monomials::Monomial;
use super::subject::Subject;
use super::variables::Variable;
use crate::diagnose::effect::Effect;
use crate::flight::{Motion, PhysicalQuantity};
use crate::model::{Edit, EditKind};

/// A product, as it is written and as it is compared with what an equation holds.
struct Product<'v> {
    text: String,
    variables: Vec<&'v Variable>,
    /// `None` of what no equation holds as a product, such as x |x|.
    monomial: Option<Monomial>,
    /// Changes sign with the side.
    is_odd: bool,
}

pub(super) fn candidates(subject: &Subject<'_>) -> Vec<Effect> {
    let variables = subject.variables();
    let products = products(&variables);
    let mut effects = Vec::new();
    for law in subject.aerodynamic() {
        let present = subject.products(&law.equation);
        let holds = |product: &Product<'_>| {
            product
                .monomial
                .as_ref()
                .is_some_and(|monomial| present.contains(monomial))
        };
        let fits = |product: &&Product<'_>| {
            let closes_a_circle = |v: &&Variable| subject.closes_a_circle(&v.name, &law.target);
            product.belongs_to(law.motion)
                && !holds(product)
                && !product.variables.iter().any(closes_a_circle)
        };
        effects.extend(
            products
                .iter()
                .filter(fits)
                .filter_map(|product| subject.term(&law, product)),
        );
    }
    effects.extend(subject.scaling());
    effects
}

impl Subject<'_> {
    fn term(&self, law: &Law, product: &Product<'_>) -> Option<Effect> {
        let mut about = IndexMap::new();
        for variable in &product.variables {
            if let Some(reference) = self.reference(variable, &law.equation) {
                about.insert(variable.name.clone(), reference);
            }
        }
        let channels: IndexMap<_, _> = (product.variables.iter())
            .filter_map(|v| Some((v.name.clone(), v.channel.clone()?)))
            .collect();
        let kind = match product.variables.as_slice() {
            [one] if one.channel.is_some() && one.is_control() && product.text == one.name => {
                EditKind::UnrecordedInput
            }
            _ => EditKind::MissingTerm,
        };
        let edit = Edit {
            about,
            channels,
            ..Edit::new(kind, law.target.as_str()).with_term(product.text.as_str())
        };
        edit.apply(self.document).ok()?;
        Some(Effect::of(edit))
    }

    /// Derivatives that scale with the dynamic pressure, where the speed changes.
    fn scaling(&self) -> Option<Effect> {
        let variables = self.variables();
        variables
            .iter()
            .find(|v| v.quantity == PhysicalQuantity::Airspeed)?;
        let edit = Edit {
            channels: self.channel_inputs(),
            ..Edit::new(EditKind::MissingTerm, "all").with_term("qbar")
        };
        self.fit(edit)
    }
}

impl<'v> Product<'v> {
    fn power(variable: &'v Variable, power: u32) -> Self {
        let name = &variable.name;
        Self {
            text: match power {
                1 => name.clone(),
                _ => format!("{name}^{power}"),
            },
            variables: vec![variable],
            monomial: Some(Monomial {
                powers: BTreeMap::from([(name.clone(), power)]),
                opaque: false,
            }),
            is_odd: variable.is_odd() && power % 2 == 1,
        }
    }

    /// x |x|
    fn signed_square(variable: &'v Variable) -> Self {
        let name = &variable.name;
        Self {
            text: format!("{name}*abs({name})"),
            variables: vec![variable],
            monomial: None,
            is_odd: variable.is_odd(),
        }
    }

    fn pair(a: &'v Variable, b: &'v Variable) -> Self {
        Self {
            text: format!("{}*{}", a.name, b.name),
            variables: vec![a, b],
            monomial: Some(Monomial {
                powers: BTreeMap::from([(a.name.clone(), 1), (b.name.clone(), 1)]),
                opaque: false,
            }),
            is_odd: a.is_odd() != b.is_odd(),
        }
    }

    /// Whether an equation of a motion may hold it. A single variable of the other motion is a coupling, which there may
    /// be (a slipstream yaws with the speed); a product must change sign with the side as the equation does.
    fn belongs_to(&self, motion: Option<Motion>) -> bool {
        let Some(motion) = motion else { return true };
        if self.variables.iter().any(|v| v.quantity.motion().is_none()) {
            return true;
        }
        match self.variables.as_slice() {
            [one] if one.is_flow_rate() => one.quantity.motion() == Some(motion),
            [one] if self.text == one.name => true,
            _ => self.is_odd == (motion == Motion::Lateral),
        }
    }
}

fn products(variables: &[Variable]) -> Vec<Product<'_>> {
    let mut all: Vec<Product<'_>> = variables.iter().map(|v| Product::power(v, 1)).collect();
    let deflects = |v: &Variable| v.is_control() && v.quantity != PhysicalQuantity::Thrust;
    for v in variables {
        let is_angle = v.quantity.is_flow_angle();
        if is_angle || v.is_velocity() {
            all.push(Product::power(v, 2));
        }
        if is_angle {
            all.push(Product::power(v, 3));
        }
        if v.is_rate() || deflects(v) || is_angle || v.is_velocity() {
            all.push(Product::signed_square(v));
        }
    }
    let moves = |v: &Variable| v.quantity.is_flow_angle() || v.is_rate();
    for (i, a) in variables.iter().enumerate() {
        for b in &variables[i + 1..] {
            let flows = |v: &Variable| v.quantity.is_flow_angle() || v.is_velocity();
            let (one, other) = (flows(a), flows(b));
            let both = (moves(a) && moves(b)) || (a.is_velocity() && b.is_velocity());
            if both || (one && deflects(b)) || (other && deflects(a)) {
                all.push(Product::pair(a, b));
            }
        }
    }
    if let Some(speed) = variables.iter().find(|v| v.is_speed()) {
        let scaled = (variables.iter()).filter(|v| v.quantity.is_flow_angle() || deflects(v));
        all.extend(scaled.map(|v| Product::pair(speed, v)));
    }
    all
}
