//! Equations as a graph in which equal sub-expressions are one node, and its exact derivatives.
//!
//! Nodes are numbered so that operands come before the operations on them.

use std::collections::HashMap;

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

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Unary {
    Negate,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Atan2,
    /// 1 where the left operand is less than the right one, else 0.
    Less,
    LessOrEqual,
}

/// The work that a document may cause: nodes of equations and their derivatives.
pub(super) const MOST_GRAPH_NODES: usize = 100_000;

#[derive(Default)]
pub(super) struct Graph {
    nodes: Vec<Node>,
    known: HashMap<Node, NodeId>,
}

impl Graph {
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id as usize]
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the bound on work is passed; the graph then is not to be used.
    pub fn is_too_large(&self) -> bool {
        self.nodes.len() > MOST_GRAPH_NODES
    }

    pub fn constant(&mut self, value: f64) -> NodeId {
        self.insert(Node::Constant(value.to_bits()))
    }

    pub fn symbol(&mut self, slot: u32) -> NodeId {
        self.insert(Node::Symbol(slot))
    }

    pub fn value(&self, id: NodeId) -> Option<f64> {
        match self.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub fn unary(&mut self, operation: Unary, a: NodeId) -> NodeId {
        if let Some(value) = self.value(a) {
            return self.constant(fold_unary(operation, value));
        }
        match (operation, self.node(a)) {
            (Unary::Negate, Node::Unary(Unary::Negate, inner)) => inner,
            _ => self.insert(Node::Unary(operation, a)),
        }
    }

    pub fn add(&mut self, a: NodeId, b: NodeId) -> NodeId {
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

    pub fn subtract(&mut self, a: NodeId, b: NodeId) -> NodeId {
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

    pub fn multiply(&mut self, a: NodeId, b: NodeId) -> NodeId {
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

    pub fn divide(&mut self, a: NodeId, b: NodeId) -> NodeId {
        match (self.value(a), self.value(b)) {
            (Some(x), Some(y)) => self.constant(x / y),
            (Some(0.0), None) => self.constant(0.0),
            (None, Some(1.0)) => a,
            _ => self.insert(Node::Binary(Binary::Divide, a, b)),
        }
    }

    /// Whole powers become products, so that they cost what they should and hold for negative bases.
    pub fn power(&mut self, a: NodeId, b: NodeId) -> NodeId {
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

    pub fn binary(&mut self, operation: Binary, a: NodeId, b: NodeId) -> NodeId {
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

    pub fn select(&mut self, condition: NodeId, yes: NodeId, no: NodeId) -> NodeId {
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

    /// d(roots)/d(symbol), exactly; `None` where a root does not depend on it.
    ///
    /// Forward accumulation over the graph as it stands when called.
    pub fn derivatives(&mut self, roots: &[NodeId], symbol: u32) -> Vec<Option<NodeId>> {
        let last = roots.iter().max().map_or(0, |&root| root as usize + 1);
        let mut tangent: Vec<Option<NodeId>> = vec![None; last];
        for id in 0..last {
            let derivative = match self.nodes[id] {
                Node::Constant(_) => None,
                Node::Symbol(slot) => (slot == symbol).then(|| self.constant(1.0)),
                Node::Unary(operation, a) => tangent[a as usize]
                    .and_then(|da| self.derive_unary(operation, id as NodeId, a, da)),
                Node::Binary(operation, a, b) => {
                    let (da, db) = (tangent[a as usize], tangent[b as usize]);
                    if da.is_none() && db.is_none() {
                        None
                    } else {
                        self.derive_binary(operation, id as NodeId, (a, da), (b, db))
                    }
                }
                Node::Select(condition, yes, no) => {
                    match (tangent[yes as usize], tangent[no as usize]) {
                        (None, None) => None,
                        (yes, no) => {
                            let zero = self.constant(0.0);
                            Some(self.select(condition, yes.unwrap_or(zero), no.unwrap_or(zero)))
                        }
                    }
                }
            };
            tangent[id] = derivative.filter(|&d| self.value(d) != Some(0.0));
            if self.is_too_large() {
                break;
            }
        }
        roots.iter().map(|&root| tangent[root as usize]).collect()
    }

    /// d f(a) = f'(a) da, with `whole` = f(a).
    fn derive_unary(
        &mut self,
        operation: Unary,
        whole: NodeId,
        a: NodeId,
        da: NodeId,
    ) -> Option<NodeId> {
        let one = self.constant(1.0);
        let slope = match operation {
            Unary::Negate => return Some(self.unary(Unary::Negate, da)),
            Unary::Sign => return None,
            Unary::Sin => self.unary(Unary::Cos, a),
            Unary::Cos => {
                let sine = self.unary(Unary::Sin, a);
                self.unary(Unary::Negate, sine)
            }
            Unary::Tan => {
                let square = self.multiply(whole, whole);
                self.add(one, square)
            }
            Unary::Tanh => {
                let square = self.multiply(whole, whole);
                self.subtract(one, square)
            }
            Unary::Exp => whole,
            Unary::Ln => return Some(self.divide(da, a)),
            Unary::Abs => self.unary(Unary::Sign, a),
            Unary::Sqrt => {
                let double = self.add(whole, whole);
                return Some(self.divide(da, double));
            }
            Unary::Atan => {
                let square = self.multiply(a, a);
                let below = self.add(one, square);
                return Some(self.divide(da, below));
            }
            Unary::Asin | Unary::Acos => {
                let square = self.multiply(a, a);
                let rest = self.subtract(one, square);
                let root = self.unary(Unary::Sqrt, rest);
                let quotient = self.divide(da, root);
                return Some(if operation == Unary::Asin {
                    quotient
                } else {
                    self.unary(Unary::Negate, quotient)
                });
            }
        };
        Some(self.multiply(slope, da))
    }

    fn derive_binary(
        &mut self,
        operation: Binary,
        whole: NodeId,
        (a, da): (NodeId, Option<NodeId>),
        (b, db): (NodeId, Option<NodeId>),
    ) -> Option<NodeId> {
        let zero = self.constant(0.0);
        Some(match operation {
            Binary::Add => self.add(da.unwrap_or(zero), db.unwrap_or(zero)),
            Binary::Subtract => self.subtract(da.unwrap_or(zero), db.unwrap_or(zero)),
            Binary::Multiply => {
                let left = self.multiply(da.unwrap_or(zero), b);
                let right = self.multiply(a, db.unwrap_or(zero));
                self.add(left, right)
            }
            // d(a/b) = (da - (a/b) db)/b
            Binary::Divide => {
                let share = self.multiply(whole, db.unwrap_or(zero));
                let above = self.subtract(da.unwrap_or(zero), share);
                self.divide(above, b)
            }
            // d(a^b) = b a^(b-1) da + a^b ln(a) db
            Binary::Power => {
                let one = self.constant(1.0);
                let mut sum = zero;
                if let Some(da) = da {
                    let less = self.subtract(b, one);
                    let lower = self.power(a, less);
                    let slope = self.multiply(b, lower);
                    sum = self.multiply(slope, da);
                }
                if let Some(db) = db {
                    let logarithm = self.unary(Unary::Ln, a);
                    let slope = self.multiply(whole, logarithm);
                    // 0^b stays 0 as b changes, where ln 0 is not a number
                    let slope = self.select(a, slope, zero);
                    let part = self.multiply(slope, db);
                    sum = self.add(sum, part);
                }
                sum
            }
            // d atan2(a, b) = (b da - a db)/(a² + b²)
            Binary::Atan2 => {
                let left = self.multiply(b, da.unwrap_or(zero));
                let right = self.multiply(a, db.unwrap_or(zero));
                let above = self.subtract(left, right);
                let (aa, bb) = (self.multiply(a, a), self.multiply(b, b));
                let below = self.add(aa, bb);
                self.divide(above, below)
            }
            Binary::Less | Binary::LessOrEqual => return None,
        })
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
        Unary::Sin => value.sin(),
        Unary::Cos => value.cos(),
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
