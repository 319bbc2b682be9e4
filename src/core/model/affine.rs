//! State equations that are affine in states and inputs: f = A(θ) x + B(θ) u + c(θ).
//!
//! Found from the equations, not declared. For such a model one integration step is a constant matrix.

use super::graph::{Graph, Node, NodeId};
use super::operation::{Binary, Unary};
use super::program::{Program, Slots};

/// The coefficients of affine equations and their derivatives by the parameters; those that are zero for any
/// θ are left out.
#[derive(Clone, Debug)]
pub(crate) struct Affine {
    /// Depends on θ alone: result i is the coefficient `entries[i]`.
    pub(crate) program: Program,
    pub(crate) entries: Vec<Coefficient>,
}

/// Where a coefficient stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Coefficient {
    /// Index of the state whose equation it stands in.
    pub(crate) row: usize,
    pub(crate) factor: Factor,
    /// The parameter that the coefficient is differentiated by; none for the coefficient itself.
    pub(crate) parameter: Option<usize>,
}

/// What a coefficient is multiplied with.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Factor {
    /// A state, by index.
    State(usize),
    /// An input, by index.
    Input(usize),
    /// Nothing: the coefficient is a term of c.
    One,
}

/// Each coefficient is differentiated by each parameter, with a pass over all nodes: more passes and nodes than these
/// would take seconds, and the steps of so large a model gain little.
const MOST_VISITS: usize = 100_000_000;

impl Affine {
    /// `None` where some row is not affine, or depends on the time, or where there is too much to differentiate.
    pub(super) fn find(graph: &mut Graph, slots: Slots, rows: &[NodeId]) -> Option<Self> {
        if !are_affine(graph, slots, rows, Degree::Higher) {
            return None;
        }
        let states = (0..slots.states).map(|i| (Factor::State(i), slots.state(i)));
        let inputs = (0..slots.inputs).map(|i| (Factor::Input(i), slots.input(i)));
        let factors: Vec<(Factor, u32)> = states.chain(inputs).collect();
        let (mut entries, mut roots) = (Vec::new(), Vec::new());
        let mut put = |factor, parameter, nodes: Vec<Option<NodeId>>| {
            for (row, node) in nodes.into_iter().enumerate() {
                let Some(node) = node else { continue };
                entries.push(Coefficient {
                    row,
                    factor,
                    parameter,
                });
                roots.push(node);
            }
        };
        let mut columns: Vec<(Factor, Vec<Option<NodeId>>)> = Vec::new();
        for (factor, symbol) in factors {
            columns.push((factor, graph.derivatives(rows, symbol)));
        }
        let rest = graph.at_zero(rows, slots.parameter(0));
        columns.push((Factor::One, rest.into_iter().map(Some).collect()));
        if columns.len() * slots.parameters * graph.len() > MOST_VISITS {
            return None;
        }
        for (factor, nodes) in columns {
            let own: Vec<NodeId> = nodes.iter().flatten().copied().collect();
            for parameter in 0..slots.parameters {
                let mut derivatives = graph
                    .derivatives(&own, slots.parameter(parameter))
                    .into_iter();
                let by_row =
                    |node: &Option<NodeId>| node.and_then(|_| derivatives.next().flatten());
                put(factor, Some(parameter), nodes.iter().map(by_row).collect());
            }
            put(factor, None, nodes);
        }
        Some(Self {
            program: Program::compile(graph, slots, &roots),
            entries,
        })
    }
}

/// Whether rows are linear in states and inputs but for what is added to them: functions of θ, and the time itself.
pub(super) fn are_linear(graph: &Graph, slots: Slots, rows: &[NodeId]) -> bool {
    are_affine(graph, slots, rows, Degree::Affine)
}

/// How a node depends on states and inputs.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Degree {
    Constant,
    Affine,
    Higher,
}

/// Whether nodes are affine in states and inputs, with coefficients that only θ changes; `time` is what the time counts as.
fn are_affine(graph: &Graph, slots: Slots, rows: &[NodeId], time: Degree) -> bool {
    use Degree::{Affine, Constant, Higher};
    let last = rows.iter().max().map_or(0, |&row| row as usize + 1);
    let mut degrees: Vec<Degree> = Vec::with_capacity(last);
    let larger = |a: Degree, b: Degree| if a < b { b } else { a };
    for id in 0..last {
        let of = |operand: NodeId| degrees[operand as usize];
        let constant_if = |yes: bool| if yes { Constant } else { Higher };
        degrees.push(match graph.node(id as NodeId) {
            Node::Constant(_) => Constant,
            Node::Symbol(slot) if slot == slots.time() => time,
            Node::Symbol(slot) if slot < slots.time() => Affine,
            Node::Symbol(_) => Constant,
            Node::Unary(Unary::Negate, a) => of(a),
            Node::Unary(_, a) => constant_if(of(a) == Constant),
            Node::Binary(Binary::Add | Binary::Subtract, a, b) => larger(of(a), of(b)),
            Node::Binary(Binary::Multiply, a, b) if of(a) == Constant => of(b),
            Node::Binary(Binary::Multiply | Binary::Divide, a, b) if of(b) == Constant => of(a),
            Node::Binary(_, a, b) => constant_if(of(a) == Constant && of(b) == Constant),
            Node::Select(condition, a, b) if of(condition) == Constant => larger(of(a), of(b)),
            Node::Select(..) => Higher,
        });
    }
    rows.iter().all(|&row| degrees[row as usize] != Higher)
}
