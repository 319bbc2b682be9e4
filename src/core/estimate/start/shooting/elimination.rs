//! The step of multiple shooting: node states are eliminated one after the other, so that the cost of a step grows
//! with the number of intervals as that of a simulation does, and an unstable model's growth is never multiplied up
//! over more than one of them.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::beginning::Beginning;
use super::intervals::{Nodes, Piece};
use crate::stop;

/// How a state of node j follows from those of node j + 1 and θ: ds_j = constant − factor [ds_(j+1), dθ].
struct Eliminated {
    constant: DVector<f64>,
    factor: DMatrix<f64>,
}

/// The normal equations of θ alone, and the way back to the nodes.
pub(super) struct Reduced {
    pub information: DMatrix<f64>,
    pub descent: DVector<f64>,
    /// By segment and node.
    nodes: Vec<Vec<Eliminated>>,
}

/// Eliminates all nodes. `weights` are those of a jump's squares, by state; `damping` is relative to the diagonal.
/// `None` where a node is not determined.
pub(super) fn eliminate(
    beginnings: &[Beginning],
    pieces: &[Vec<Piece>],
    nodes: &Nodes,
    weights: &DVector<f64>,
    damping: f64,
) -> Option<Reduced> {
    let states = weights.len();
    let unknowns = beginnings.first()?.slopes.ncols();
    let weight = DMatrix::from_diagonal(weights);
    let mut reduced = Reduced {
        information: DMatrix::zeros(unknowns, unknowns),
        descent: DVector::zeros(unknowns),
        nodes: Vec::new(),
    };
    for ((beginning, pieces), own) in beginnings.iter().zip(pieces).zip(nodes) {
        // what is known of [s_j, θ] from everything before interval j
        let mut jacobian = DMatrix::zeros(states, states + unknowns);
        jacobian
            .view_mut((0, 0), (states, states))
            .fill_diagonal(-1.0);
        jacobian
            .view_mut((0, states), (states, unknowns))
            .copy_from(&beginning.slopes);
        let mut information = jacobian.tr_mul(&(&weight * &jacobian));
        let mut descent = -jacobian.tr_mul(&weights.component_mul(&beginning.jump));
        let mut eliminated = Vec::new();
        for (j, piece) in pieces.iter().enumerate() {
            stop::check();
            information += &piece.information;
            descent += &piece.descent;
            if let Some(next) = own.get(j + 1) {
                let jump = &piece.end - next;
                // [s_j, s_(j+1), θ]
                let mut jacobian = DMatrix::zeros(states, 2 * states + unknowns);
                jacobian
                    .view_mut((0, 0), (states, states))
                    .copy_from(&piece.slopes.columns(0, states));
                jacobian
                    .view_mut((0, states), (states, states))
                    .fill_diagonal(-1.0);
                jacobian
                    .view_mut((0, 2 * states), (states, unknowns))
                    .copy_from(&piece.slopes.columns(states, unknowns));
                let wide = information.insert_columns(states, states, 0.0);
                let wide = wide.insert_rows(states, states, 0.0);
                information = wide + jacobian.tr_mul(&(&weight * &jacobian));
                let descends = jacobian.tr_mul(&weights.component_mul(&jump));
                descent = descent.insert_rows(states, states, 0.0) - descends;
            }
            let (node, left, rest) = split(information, descent, states, damping)?;
            eliminated.push(node);
            (information, descent) = (left, rest);
        }
        reduced.information += information;
        reduced.descent += descent;
        reduced.nodes.push(eliminated);
    }
    Some(reduced)
}

/// Eliminates the first `states` unknowns.
fn split(
    information: DMatrix<f64>,
    descent: DVector<f64>,
    states: usize,
    damping: f64,
) -> Option<(Eliminated, DMatrix<f64>, DVector<f64>)> {
    let rest = information.ncols() - states;
    let mut own = information.view((0, 0), (states, states)).into_owned();
    for i in 0..states {
        own[(i, i)] *= 1.0 + damping;
    }
    let across = information.view((0, states), (states, rest)).into_owned();
    let own: Cholesky<f64, Dyn> = own.cholesky()?;
    let node = Eliminated {
        constant: own.solve(&descent.rows(0, states).into_owned()),
        factor: own.solve(&across),
    };
    let left = information.view((states, states), (rest, rest)) - across.tr_mul(&node.factor);
    let right = descent.rows(states, rest) - across.tr_mul(&node.constant);
    Some((node, left, right))
}

impl Reduced {
    /// The nodes' steps for a step of θ.
    pub(super) fn nodes(&self, step: &DVector<f64>) -> Nodes {
        let of_segment = |nodes: &Vec<Eliminated>| {
            let mut steps: Vec<DVector<f64>> = Vec::new();
            for node in nodes.iter().rev() {
                let known = match steps.last() {
                    Some(next) => {
                        let mut known = DVector::zeros(next.len() + step.len());
                        known.rows_mut(0, next.len()).copy_from(next);
                        known.rows_mut(next.len(), step.len()).copy_from(step);
                        known
                    }
                    None => step.clone(),
                };
                steps.push(&node.constant - &node.factor * known);
            }
            steps.reverse();
            steps
        };
        self.nodes.iter().map(of_segment).collect()
    }
}
