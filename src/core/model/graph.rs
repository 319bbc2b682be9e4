//! Equations as a graph in which equal sub-expressions are one node, and its exact derivatives.
//!
//! Nodes are numbered so that operands come before the operations on them.

use std::collections::HashMap;

use super::operation::{Binary, Unary};

/// A node of the graph.
pub(super) type NodeId = u32;

/// What a node is; operands are nodes with smaller numbers.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Node {
    /// A number, by its bits.
    Constant(u64),
    /// A state, input, the time or a parameter, by its slot.
    Symbol(u32),
    Unary(Unary, NodeId),
    Binary(Binary, NodeId, NodeId),
    /// The second operand where the first is not zero, else the third.
    Select(NodeId, NodeId, NodeId),
}

/// The work that a document may cause: nodes of equations and their derivatives.
pub(super) const MOST_GRAPH_NODES: usize = 100_000;

#[derive(Default)]
pub(super) struct Graph {
    nodes: Vec<Node>,
    known: HashMap<Node, NodeId>,
}

impl Graph {
    pub(super) fn node(&self, id: NodeId) -> Node {
        self.nodes[id as usize]
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the bound on work is passed; the graph then is not to be used.
    pub(super) fn is_too_large(&self) -> bool {
        self.nodes.len() > MOST_GRAPH_NODES
    }

    pub(super) fn constant(&mut self, value: f64) -> NodeId {
        self.insert(Node::Constant(value.to_bits()))
    }

    pub(super) fn symbol(&mut self, slot: u32) -> NodeId {
        self.insert(Node::Symbol(slot))
    }

    pub(super) fn value(&self, id: NodeId) -> Option<f64> {
        match self.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub(super) fn unary(&mut self, operation: Unary, a: NodeId) -> NodeId {
        if let Some(value) = self.value(a) {
            return self.constant(fold_unary(operation, value));
        }
        match (operation, self.node(a)) {
            (Unary::Negate, Node::Unary(Unary::Negate, inner)) => inner,
            _ => self.insert(Node::Unary(operation, a)),
        }
    }

    pub(super) fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => self.constant(x + y),
            (Some(0.0), None) => b,
            (None, Some(0.0)) => a,
            _ => match (self.node(a), self.node(b)) {
                (_, Node::Unary(Unary::Negate, inner)) => self.subtract(a, inner),
                (Node::Unary(Unary::Negate, inner), _) => self.subtract(b, inner),
                _ => self.insert(Node::Binary(Binary::Add, a.min(b), a.max(b))),
            },
        }
    }

    pub(super) fn subtract(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => self.constant(x - y),
            (None, Some(0.0)) => a,
            (Some(0.0), None) => self.unary(Unary::Negate, b),
            _ if a == b => self.constant(0.0),
            _ => match self.node(b) {
                Node::Unary(Unary::Negate, inner) => self.add(a, inner),
                _ => self.insert(Node::Binary(Binary::Subtract, a, b)),
            },
        }
    }

    pub(super) fn multiply(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => self.constant(x * y),
            (Some(0.0), _) | (_, Some(0.0)) => self.constant(0.0),
            (Some(1.0), _) => b,
            (_, Some(1.0)) => a,
            (Some(-1.0), _) => self.unary(Unary::Negate, b),
            (_, Some(-1.0)) => self.unary(Unary::Negate, a),
            _ => match (self.node(a), self.node(b)) {
                (Node::Unary(Unary::Negate, inner), _) => {
                    let product = self.multiply(inner, b);
                    self.unary(Unary::Negate, product)
                }
                (_, Node::Unary(Unary::Negate, inner)) => {
                    let product = self.multiply(a, inner);
                    self.unary(Unary::Negate, product)
                }
                _ => self.insert(Node::Binary(Binary::Multiply, a.min(b), a.max(b))),
            },
        }
    }

    pub(super) fn divide(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => self.constant(x / y),
            (Some(0.0), None) => self.constant(0.0),
            (None, Some(1.0)) => a,
            _ => self.insert(Node::Binary(Binary::Divide, a, b)),
        }
    }

    /// Whole powers become products, so that they cost what they should and hold for negative bases.
    pub(super) fn power(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => self.constant(x.powf(y)),
            (None, Some(exponent)) if exponent == exponent.trunc() && exponent.abs() <= 64.0 => {
                let product = self.whole_power(a, exponent.abs() as u32);
                let one = self.constant(1.0);
                if exponent < 0.0 {
                    self.divide(one, product)
                } else {
                    product
                }
            }
            (None, Some(0.5)) => self.unary(Unary::Sqrt, a),
            _ => self.insert(Node::Binary(Binary::Power, a, b)),
        }
    }

    fn whole_power(&mut self, a: NodeId, exponent: u32) -> NodeId {
        match exponent {
            0 => self.constant(1.0),
            1 => a,
            _ => {
                let half = self.whole_power(a, exponent / 2);
                let square = self.multiply(half, half);
                if exponent.is_multiple_of(2) {
                    square
                } else {
                    self.multiply(square, a)
                }
            }
        }
    }

    pub(super) fn binary(&mut self, operation: Binary, a: NodeId, b: NodeId) -> NodeId {
        match operation {
            Binary::Add => self.add(a, b),
            Binary::Subtract => self.subtract(a, b),
            Binary::Multiply => self.multiply(a, b),
            Binary::Divide => self.divide(a, b),
            Binary::Power => self.power(a, b),
            Binary::Atan2 | Binary::Less | Binary::LessOrEqual => {
                match (self.value(a), self.value(b)) {
                    (Some(x), Some(y)) => self.constant(match operation {
                        Binary::Atan2 => x.atan2(y),
                        Binary::Less => f64::from(u8::from(x < y)),
                        _ => f64::from(u8::from(x <= y)),
                    }),
                    _ => self.insert(Node::Binary(operation, a, b)),
                }
            }
        }
    }

    pub(super) fn select(&mut self, condition: NodeId, yes: NodeId, no: NodeId) -> NodeId {
        match self.value(condition) {
            Some(value) => {
                if value != 0.0 {
                    yes
                } else {
                    no
                }
            }
            None if yes == no => yes,
            None => self.insert(Node::Select(condition, yes, no)),
        }
    }

    /// The roots with everything at zero that stands before the symbol of slot `first`: states, inputs and time.
    pub(super) fn at_zero(&mut self, roots: &[NodeId], first: u32) -> Vec<NodeId> {
        let last = roots.iter().max().map_or(0, |&root| root as usize + 1);
        let mut image: Vec<NodeId> = Vec::with_capacity(last);
        for id in 0..last {
            let of = |operand: NodeId| image[operand as usize];
            let to = match self.nodes[id] {
                Node::Symbol(slot) if slot < first => self.constant(0.0),
                Node::Symbol(_) | Node::Constant(_) => id as NodeId,
                Node::Unary(operation, a) => {
                    let a = of(a);
                    self.unary(operation, a)
                }
                Node::Binary(operation, a, b) => {
                    let (a, b) = (of(a), of(b));
                    self.binary(operation, a, b)
                }
                Node::Select(condition, yes, no) => {
                    let (condition, yes, no) = (of(condition), of(yes), of(no));
                    self.select(condition, yes, no)
                }
            };
            image.push(to);
        }
        roots.iter().map(|&root| image[root as usize]).collect()
    }

    fn insert(&mut self, node: Node) -> NodeId {
        if let Some(&id) = self.known.get(&node) {
            return id;
        }
        let id = self.nodes.len() as NodeId;
        self.nodes.push(node);
        self.known.insert(node, id);
        id
    }
}

fn fold_unary(operation: Unary, value: f64) -> f64 {
    use super::scalar::Scalar;
    match operation {
        Unary::Negate => -value,
        Unary::Sin => Scalar::sin(value),
        Unary::Cos => Scalar::cos(value),
        Unary::Tan => value.tan(),
        Unary::Asin => value.asin(),
        Unary::Acos => value.acos(),
        Unary::Atan => value.atan(),
        Unary::Tanh => value.tanh(),
        Unary::Exp => value.exp(),
        Unary::Ln => value.ln(),
        Unary::Sqrt => value.sqrt(),
        Unary::Abs => value.abs(),
        Unary::Sign => Scalar::sign(value),
    }
}
