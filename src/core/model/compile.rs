//! From document to model: names resolved, units checked, equations and their derivatives compiled.
//!
//! All faults of a document are found in one go, as far as one does not hide another.

use std::sync::Arc;

use super::affine::{Affine, are_linear};
use super::document::{ModelDocument, Per, Start};
use super::equations::Equations;
use super::expression::{self, BinaryOperator, Expression, Function, Kind};
use super::graph::{Graph, MOST_GRAPH_NODES, NodeId};
use super::jacobian::Jacobian;
use super::names::{Meaning, Names};
use super::operation::{Binary, Unary};
use super::paths::{Compiled, PathElement, Paths};
use super::program::{Program, Slots};
use super::quantities;
use super::{Model, ParameterInfo, Quantity, limits};
use crate::flight::{Fault, Faults, Unit, escape};

impl Model {
    /// Compiles a document.
    ///
    /// # Errors
    /// Every fault with its place: syntax, unknown names, cycles, units that do not agree, bounds.
    pub fn compile(document: &ModelDocument) -> Result<Self, Faults> {
        let mut faults = limits::check(document);
        if !faults.is_empty() {
            return Err(faults.into());
        }
        if document.outputs.is_empty() {
            let message = "a model needs at least one output to compare with a recording";
            faults.push(Fault::new("/outputs", "no_outputs", message));
        }
        let names = Names::collect(document, &mut faults);
        quantities::check(document, &mut faults);
        let equations = Equations::read(document, &names, &mut faults);
        let parameters = parameters(document, &mut faults);
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let slots = Slots {
            states: document.states.len(),
            // behind the inputs themselves come the ρ of the elements of their paths
            inputs: document.inputs.len() + equations.input_paths.len(),
            parameters: parameters.len(),
        };
        let mut graph = Graph::default();
        let mut builder = Builder {
            names: &names,
            slots,
            graph: &mut graph,
            definitions: Vec::new(),
            inputs: Vec::new(),
        };
        let roots = builder.build(document, &equations)?;
        let model = Self {
            initial: Program::compile(&graph, slots, &roots.initial),
            dynamics: Program::compile(&graph, slots, &roots.dynamics),
            observation: Program::compile(&graph, slots, &roots.observation),
            initial_jacobian: Jacobian::derive(&mut graph, slots, &roots.initial),
            dynamics_jacobian: Jacobian::derive(&mut graph, slots, &roots.dynamics),
            observation_jacobian: Jacobian::derive(&mut graph, slots, &roots.observation),
            paths: Paths::compile(&mut graph, slots, &roots.input_paths, &roots.output_paths),
            affine_dynamics: Affine::find(&mut graph, slots, &roots.dynamics),
            linear: [&roots.dynamics, &roots.observation]
                .iter()
                .all(|rows| are_linear(&graph, slots, rows)),
            inputs: quantities(
                document
                    .inputs
                    .iter()
                    .map(|(name, input)| (name, &input.unit)),
            ),
            states: quantities(
                document
                    .states
                    .iter()
                    .map(|(name, state)| (name, &state.unit)),
            ),
            outputs: quantities(
                document
                    .outputs
                    .iter()
                    .map(|(name, output)| (name, &output.unit)),
            ),
            parameters,
            native: Arc::default(),
            document: document.clone(),
        };
        if graph.is_too_large() {
            Err(too_large().into())
        } else {
            Ok(model)
        }
    }
}

fn too_large() -> Fault {
    let message = format!(
        "equations and their derivatives need more than {MOST_GRAPH_NODES} operations; simplify them"
    );
    Fault::new("", "model_too_large", message)
}

fn parameters(document: &ModelDocument, faults: &mut Vec<Fault>) -> Vec<ParameterInfo> {
    let info = |(name, parameter): (&String, &super::Parameter)| {
        let pointer = format!("/parameters/{}", escape(name));
        let unit = Unit::parse(&parameter.unit).unwrap_or(Unit::NONE);
        let numbers = [
            parameter.lower,
            parameter.upper,
            match parameter.start {
                Start::Value(value) => Some(value),
                Start::FromData(_) => None,
            },
        ];
        if numbers
            .into_iter()
            .flatten()
            .any(|number| !unit.to_si(number).is_finite())
        {
            faults.push(Fault::new(
                &pointer,
                "not_finite",
                "start and bounds must be finite numbers",
            ));
        }
        if !parameter.only_in.is_empty() && parameter.per == Per::Job {
            let message =
                "only_in is of a parameter that each maneuver has; give it per = \"maneuver\"";
            faults.push(Fault::new(&pointer, "bad_only_in", message));
        }
        if let (Some(lower), Some(upper)) = (parameter.lower, parameter.upper)
            && lower >= upper
        {
            let message = format!("lower bound {lower} is not below upper bound {upper}");
            faults.push(Fault::new(&pointer, "bad_bounds", message));
        } else if let Start::Value(start) = parameter.start
            && (parameter.lower.is_some_and(|lower| start < lower)
                || parameter.upper.is_some_and(|upper| start > upper))
        {
            let message = format!("start {start} is outside the bounds");
            faults.push(Fault::new(
                format!("{pointer}/start"),
                "bad_bounds",
                message,
            ));
        }
        if let Some(prior) = parameter.prior.map(|prior| prior.in_si(&unit))
            && !(prior.mean.is_finite() && prior.sd > 0.0 && prior.sd.powi(-2).is_normal())
        {
            faults.push(Fault::new(
                format!("{pointer}/prior"),
                "bad_prior",
                "a prior needs a finite \"mean\" and a standard deviation \"sd\" above 0",
            ));
        }
        if let Start::FromData(text) = &parameter.start
            && let Err(error) = expression::parse(text)
        {
            faults.push(Fault::new(
                format!("{pointer}/start"),
                "syntax_error",
                error.to_string(),
            ));
        }
        ParameterInfo {
            name: name.clone(),
            unit,
            document: parameter.clone(),
        }
    };
    document.parameters.iter().map(info).collect()
}

fn quantities<'a>(list: impl Iterator<Item = (&'a String, &'a String)>) -> Vec<Quantity> {
    let quantity = |(name, unit): (&String, &String)| Quantity {
        name: name.clone(),
        unit: Unit::parse(unit).unwrap_or(Unit::NONE),
        si: Unit::si_name(unit),
    };
    list.map(quantity).collect()
}

struct Roots {
    initial: Vec<NodeId>,
    dynamics: Vec<NodeId>,
    observation: Vec<NodeId>,
    input_paths: Vec<Compiled>,
    output_paths: Vec<Compiled>,
}

/// Turns trees into nodes of the graph.
struct Builder<'a> {
    names: &'a Names<'a>,
    slots: Slots,
    graph: &'a mut Graph,
    definitions: Vec<Visit>,
    /// What equations see of each input.
    inputs: Vec<NodeId>,
}

/// Whether a definition was visited already, on the way through those that need others.
#[derive(Clone, Copy)]
enum Visit {
    No,
    Underway,
    Done(NodeId),
}

impl Builder<'_> {
    fn build(
        &mut self,
        document: &ModelDocument,
        equations: &Equations,
    ) -> Result<Roots, Vec<Fault>> {
        let mut sizes = |list: &[(PathElement, Expression)]| -> Vec<Compiled> {
            list.iter()
                .map(|(element, size)| (*element, self.node(size)))
                .collect()
        };
        let input_paths = sizes(&equations.input_paths);
        let output_paths = sizes(&equations.output_paths);
        self.inputs = (0..document.inputs.len())
            .map(|i| self.graph.symbol(self.slots.input(i)))
            .collect();
        for (place, &(element, size)) in input_paths.iter().enumerate() {
            let slot = self.slots.input(self.inputs.len() + place);
            let slope = self.graph.symbol(slot);
            let change = self.graph.multiply(slope, size);
            let input = &mut self.inputs[element.signal];
            *input = self.graph.add(*input, change);
        }
        self.definitions = vec![Visit::No; equations.definitions.len()];
        for i in 0..equations.definitions.len() {
            let mut path = Vec::new();
            self.definition(i, equations, &mut path).map_err(|cycle| {
                let name = |&i: &usize| {
                    document
                        .definitions
                        .get_index(i)
                        .map_or("?", |(name, _)| name.as_str())
                };
                let first = cycle.first().map_or("?", name);
                let message = format!(
                    "the definition depends on itself: {}; break the cycle",
                    cycle.iter().map(name).collect::<Vec<_>>().join(" -> ")
                );
                vec![Fault::new(
                    format!("/definitions/{}/equation", escape(first)),
                    "cyclic_definition",
                    message,
                )]
            })?;
        }
        let mut all =
            |list: &[Expression]| -> Vec<NodeId> { list.iter().map(|e| self.node(e)).collect() };
        let roots = Roots {
            initial: all(&equations.initial),
            dynamics: all(&equations.dynamics),
            observation: all(&equations.observation),
            input_paths,
            output_paths,
        };
        if self.graph.is_too_large() {
            Err(vec![too_large()])
        } else {
            Ok(roots)
        }
    }

    /// Builds definition `i` and those it needs; the error is the circle, by index.
    fn definition(
        &mut self,
        i: usize,
        equations: &Equations,
        path: &mut Vec<usize>,
    ) -> Result<(), Vec<usize>> {
        match self.definitions[i] {
            Visit::Done(_) => return Ok(()),
            Visit::Underway => {
                let start = path.iter().position(|&at| at == i).unwrap_or(0);
                return Err(path[start..].iter().copied().chain([i]).collect());
            }
            Visit::No => {}
        }
        self.definitions[i] = Visit::Underway;
        path.push(i);
        for (name, _) in equations.definitions[i].names() {
            if let Some(Meaning::Definition(needed)) = self.names.meaning(name) {
                self.definition(needed, equations, path)?;
            }
        }
        path.pop();
        let node = self.node(&equations.definitions[i]);
        self.definitions[i] = Visit::Done(node);
        Ok(())
    }

    fn node(&mut self, expression: &Expression) -> NodeId {
        match &expression.kind {
            Kind::Number(value) => self.graph.constant(*value),
            Kind::Name(name) => self.named(name),
            Kind::Negate(inner) => {
                let inner = self.node(inner);
                self.graph.unary(Unary::Negate, inner)
            }
            Kind::Binary(operator, left, right) => {
                let (a, b) = (self.node(left), self.node(right));
                match operator {
                    BinaryOperator::Add => self.graph.add(a, b),
                    BinaryOperator::Subtract => self.graph.subtract(a, b),
                    BinaryOperator::Multiply => self.graph.multiply(a, b),
                    BinaryOperator::Divide => self.graph.divide(a, b),
                    BinaryOperator::Power => self.graph.power(a, b),
                    BinaryOperator::Less => self.graph.binary(Binary::Less, a, b),
                    BinaryOperator::LessOrEqual => self.graph.binary(Binary::LessOrEqual, a, b),
                    BinaryOperator::Greater => self.graph.binary(Binary::Less, b, a),
                    BinaryOperator::GreaterOrEqual => self.graph.binary(Binary::LessOrEqual, b, a),
                }
            }
            Kind::Call(function, arguments) => {
                let nodes: Vec<NodeId> = arguments
                    .iter()
                    .map(|argument| self.node(argument))
                    .collect();
                self.call(*function, &nodes)
            }
        }
    }

    fn call(&mut self, function: Function, arguments: &[NodeId]) -> NodeId {
        let unary = match function {
            Function::Sin => Unary::Sin,
            Function::Cos => Unary::Cos,
            Function::Tan => Unary::Tan,
            Function::Asin => Unary::Asin,
            Function::Acos => Unary::Acos,
            Function::Atan => Unary::Atan,
            Function::Tanh => Unary::Tanh,
            Function::Exp => Unary::Exp,
            Function::Ln => Unary::Ln,
            Function::Sqrt => Unary::Sqrt,
            Function::Abs => Unary::Abs,
            Function::Sign => Unary::Sign,
            Function::Atan2 => return self.graph.binary(Binary::Atan2, arguments[0], arguments[1]),
            Function::Min | Function::Max => {
                let (a, b) = (arguments[0], arguments[1]);
                let less = self.graph.binary(Binary::Less, a, b);
                return match function {
                    Function::Min => self.graph.select(less, a, b),
                    _ => self.graph.select(less, b, a),
                };
            }
            Function::If => return self.graph.select(arguments[0], arguments[1], arguments[2]),
            // of recordings: refused by `read_equation`
            _ => return self.graph.constant(f64::NAN),
        };
        self.graph.unary(unary, arguments[0])
    }

    fn named(&mut self, name: &str) -> NodeId {
        let slots = self.slots;
        match self.names.meaning(name) {
            Some(Meaning::Constant(value)) => self.graph.constant(value),
            // in the size of an element, which may not depend on inputs, there are none yet: refused by `Equations::read`
            Some(Meaning::Input(i)) => match self.inputs.get(i) {
                Some(&node) => node,
                None => self.graph.constant(f64::NAN),
            },
            Some(Meaning::Parameter(i)) => self.graph.symbol(slots.parameter(i)),
            Some(Meaning::State(i)) => self.graph.symbol(slots.state(i)),
            Some(Meaning::Time) => self.graph.symbol(slots.time()),
            Some(Meaning::Definition(i)) => match self.definitions[i] {
                Visit::Done(node) => node,
                // definitions are built before what uses them
                Visit::No | Visit::Underway => self.graph.constant(f64::NAN),
            },
            // refused by `read_equation`
            None => self.graph.constant(f64::NAN),
        }
    }
}
