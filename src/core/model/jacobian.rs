//! Exact Jacobians of compiled equations, structurally zero entries left out.

use super::graph::{Graph, NodeId};
use super::program::{Program, Slots, Workspace};

/// ∂h/∂x and ∂h/∂θ of some equations h(x, u, t, θ): where entries are, and one program for them all.
#[derive(Clone, Debug)]
pub struct Jacobian {
    /// Results of `program`: first the entries by state, then those by parameter.
    pub program: Program,
    /// (row, state) of each entry of ∂h/∂x.
    pub by_state: Vec<(usize, usize)>,
    /// (row, parameter) of each entry of ∂h/∂θ.
    pub by_parameter: Vec<(usize, usize)>,
}

impl Jacobian {
    pub(super) fn derive(graph: &mut Graph, slots: Slots, rows: &[NodeId]) -> Self {
        let mut roots = Vec::new();
        let mut entries = |graph: &mut Graph, columns: usize, symbol: &dyn Fn(usize) -> u32| {
            let mut places = Vec::new();
            for column in 0..columns {
                for (row, entry) in graph
                    .derivatives(rows, symbol(column))
                    .into_iter()
                    .enumerate()
                {
                    if let Some(node) = entry {
                        places.push((row, column));
                        roots.push(node);
                    }
                }
            }
            places
        };
        let by_state = entries(graph, slots.states, &|i| slots.state(i));
        let by_parameter = entries(graph, slots.parameters, &|i| slots.parameter(i));
        Self {
            program: Program::compile(graph, slots, &roots),
            by_state,
            by_parameter,
        }
    }
    /// to += ∂h/∂x from, where `program` was run `at`: slopes `from` of states are rows of `width`.
    pub(crate) fn add_by_state(
        &self,
        at: &Workspace<f64>,
        width: usize,
        from: &[f64],
        to: &mut [f64],
    ) {
        for (entry, &(row, state)) in self.by_state.iter().enumerate() {
            let factor = self.program.result(at, entry);
            let from = &from[state * width..(state + 1) * width];
            for (to, from) in to[row * width..(row + 1) * width].iter_mut().zip(from) {
                *to += factor * from;
            }
        }
    }

    /// to += ∂h/∂θ: `column` is that of each parameter in rows of `width`, if it has one.
    pub(crate) fn add_by_parameter(
        &self,
        at: &Workspace<f64>,
        column: &[Option<usize>],
        width: usize,
        to: &mut [f64],
    ) {
        let first = self.by_state.len();
        for (entry, &(row, parameter)) in self.by_parameter.iter().enumerate() {
            if let Some(column) = column[parameter] {
                to[row * width + column] += self.program.result(at, first + entry);
            }
        }
    }
}
