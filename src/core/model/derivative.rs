//! Exact derivatives of the equations in a graph, as more nodes of the graph.

use super::graph::{Graph, Node, NodeId};
use super::operation::{Binary, Unary};

impl Graph {
    /// d(roots)/d(symbol), exactly; `None` where a root does not depend on it.
    ///
    /// Forward accumulation over the graph as it stands when called.
    pub(super) fn derivatives(&mut self, roots: &[NodeId], symbol: u32) -> Vec<Option<NodeId>> {
        let last = roots.iter().max().map_or(0, |&root| root as usize + 1);
        let mut tangent: Vec<Option<NodeId>> = vec![None; last];
        for id in 0..last {
            let derivative = match self.node(id as NodeId) {
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
}
