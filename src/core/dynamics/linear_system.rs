//! A, B, C, D with their standard errors, as a report.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::linearisation::{Linearisation, Numbers};
use super::no_linear_system::NoLinearSystem;
use super::signal::Signal;
use super::transfer_function::{TransferFunction, transfer_functions};
use crate::estimate::{Estimate, Measure, Mode, Problem};
use crate::flight::PhysicalQuantity;
use crate::model::Element;

/// A model linearised at the start of a segment, SI: dx/dt = A x + B u, y = C x + D u, about x0 and u0.
///
/// An input acts `delay` later than it is recorded, behind a first-order `lag`, and an output is recorded so. Standard errors
/// are those that the covariance of the parameters carries over.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct LinearSystem {
    /// The segment at whose start it holds.
    #[schema(example = "elevator")]
    pub segment: String,
    /// Whether the model is linear, and the system the same at all states and inputs of all segments.
    pub is_everywhere: bool,
    /// x
    pub states: Vec<LinearState>,
    /// u
    pub inputs: Vec<LinearSignal>,
    /// y
    pub outputs: Vec<LinearSignal>,
    /// ∂f/∂x, rows by states.
    pub a: MatrixEstimate,
    /// ∂f/∂u, rows by states, columns by inputs.
    pub b: MatrixEstimate,
    /// ∂g/∂x, rows by outputs, columns by states.
    pub c: MatrixEstimate,
    /// ∂g/∂u, rows by outputs, columns by inputs.
    pub d: MatrixEstimate,
    /// Modes of the motion, fastest first; none of reconstruction models.
    pub modes: Vec<Mode>,
    /// From each input to each output that depends on it.
    pub transfer_functions: Vec<TransferFunction>,
    /// What the reader should know, mostly nothing.
    pub remarks: Vec<String>,
}

/// A state of a linear system.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct LinearState {
    /// As equations write it.
    #[schema(example = "alpha")]
    pub name: String,
    /// SI
    #[schema(example = "rad")]
    pub unit: String,
    /// Which quantity it is, where that is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quantity: Option<PhysicalQuantity>,
    /// x0
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub value: f64,
    /// dx/dt at x0 and u0, in the unit per second: zero in a trim.
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub rate: f64,
}

/// An input or output of a linear system.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct LinearSignal {
    /// As equations write it.
    #[schema(example = "de")]
    pub name: String,
    /// SI
    #[schema(example = "rad")]
    pub unit: String,
    /// Which quantity it is, where that is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quantity: Option<PhysicalQuantity>,
    /// u0; absent of an output.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Time constant of its first-order lag, s; below zero it leads. Absent where it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lag: Option<Measure>,
    /// s; absent where it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub delay: Option<Measure>,
}

/// A matrix with the standard errors of its entries.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct MatrixEstimate {
    /// By rows.
    #[schema(example = json!([[-0.74, 0.97], [-3.41, -0.93]]))]
    #[serde(deserialize_with = "crate::flight::null_as_nan")]
    pub values: Vec<Vec<f64>>,
    /// By rows; zero where nothing that was estimated is behind an entry, `null` where a parameter behind it has no standard
    /// error.
    pub standard_errors: Vec<Vec<Option<f64>>>,
}

/// One of A, B, C, D with the names of its rows and columns.
pub struct NamedMatrix<'s> {
    /// `A`, `B`, `C` or `D`.
    pub name: &'static str,
    /// Its entries.
    pub matrix: &'s MatrixEstimate,
    /// States of A and B, outputs of C and D.
    pub rows: Vec<&'s str>,
    /// States of A and C, inputs of B and D.
    pub columns: Vec<&'s str>,
}

impl NamedMatrix<'_> {
    /// A row for a table: entries by their errors. Without one, what is nothing to rounding beside the largest of the row
    /// is 0.
    pub fn cells(&self, row: usize) -> Vec<String> {
        let values = &self.matrix.values[row];
        let largest = values
            .iter()
            .fold(0.0, |size: f64, value| size.max(value.abs()));
        let both = values.iter().zip(&self.matrix.standard_errors[row]);
        let measures = both.map(|(&value, &standard_error)| Measure {
            value,
            standard_error,
        });
        measures.map(|measure| measure.beside(largest)).collect()
    }
}

impl LinearSystem {
    /// A, B, C, D, in this order.
    pub fn matrices(&self) -> [NamedMatrix<'_>; 4] {
        let states = || -> Vec<&str> { self.states.iter().map(|s| s.name.as_str()).collect() };
        let inputs = || signal_names(&self.inputs);
        let outputs = || signal_names(&self.outputs);
        [
            ("A", &self.a, states(), states()),
            ("B", &self.b, states(), inputs()),
            ("C", &self.c, outputs(), states()),
            ("D", &self.d, outputs(), inputs()),
        ]
        .map(|(name, matrix, rows, columns)| NamedMatrix {
            name,
            matrix,
            rows,
            columns,
        })
    }
}

fn signal_names(signals: &[LinearSignal]) -> Vec<&str> {
    signals.iter().map(|signal| signal.name.as_str()).collect()
}

/// The linear system of an estimate at the start of the segment of this label, or of the first.
///
/// # Errors
/// There is no such segment, or a derivative is not finite.
pub fn linear_system(
    problem: &Problem,
    estimate: &Estimate,
    segment: Option<&str>,
) -> Result<LinearSystem, NoLinearSystem> {
    let linear = Linearisation::at(problem, estimate, segment)?;
    let (n, m, p) = (linear.states(), linear.inputs.len(), linear.outputs.len());
    let block = |rows, columns| matrix_estimate(&linear, rows, columns);
    let of_segment = |mode: &&Mode| mode.segment.as_ref().is_none_or(|of| *of == linear.segment);
    Ok(LinearSystem {
        segment: linear.segment.clone(),
        is_everywhere: linear.is_everywhere,
        states: states(&linear),
        inputs: (linear.inputs.iter().zip(&linear.input_values))
            .map(|(signal, &value)| linear_signal(&linear, signal, Some(value)))
            .collect(),
        outputs: (linear.outputs.iter())
            .map(|signal| linear_signal(&linear, signal, None))
            .collect(),
        a: block(0..n, 0..n),
        b: block(0..n, n..n + m),
        c: block(n..n + p, 0..n),
        d: block(n..n + p, n..n + m),
        modes: (estimate.modes.iter().filter(of_segment).cloned()).collect(),
        transfer_functions: transfer_functions(&linear),
        remarks: remarks(&linear),
    })
}

fn states(linear: &Linearisation<'_>) -> Vec<LinearState> {
    let numbers = linear.at.state.iter().zip(&linear.at.rates);
    (linear.problem.model.states.iter().zip(numbers))
        .map(|(state, (&value, &rate))| LinearState {
            name: state.name.clone(),
            unit: state.si.clone(),
            quantity: linear.quantities.get(&state.name),
            value,
            rate,
        })
        .collect()
}

fn linear_signal(linear: &Linearisation<'_>, signal: &Signal, value: Option<f64>) -> LinearSignal {
    let size = |element| {
        let place = signal.place_of(element)?;
        Some(Measure {
            value: linear.at.paths[place],
            standard_error: linear.standard_error(|by| by.paths[place]),
        })
    };
    LinearSignal {
        name: signal.name.clone(),
        unit: signal.unit.clone(),
        quantity: signal.quantity,
        value,
        lag: size(Element::Lag),
        delay: size(Element::Delay),
    }
}

fn matrix_estimate(
    linear: &Linearisation<'_>,
    rows: std::ops::Range<usize>,
    columns: std::ops::Range<usize>,
) -> MatrixEstimate {
    let entry = |numbers: &Numbers, i: usize, j: usize| numbers.matrix[(i, j)];
    MatrixEstimate {
        values: (rows.clone())
            .map(|i| columns.clone().map(|j| entry(&linear.at, i, j)).collect())
            .collect(),
        standard_errors: rows
            .map(|i| {
                let error = |j| linear.standard_error(|by| entry(by, i, j));
                columns.clone().map(error).collect()
            })
            .collect(),
    }
}

fn remarks(linear: &Linearisation<'_>) -> Vec<String> {
    let mut remarks = Vec::new();
    let signals = linear.inputs.iter().chain(&linear.outputs);
    let nonlinear: Vec<&str> = signals
        .filter(|signal| signal.is_nonlinear())
        .map(|signal| signal.name.as_str())
        .collect();
    if !nonlinear.is_empty() {
        remarks.push(format!(
            "play and rate limits are left out, as no linear system has them: {}",
            nonlinear.join(", ")
        ));
    }
    if linear.is_kinematic {
        remarks.push(
            "the motion is recorded and not computed from forces: poles and responses say nothing of the aircraft"
                .to_string(),
        );
    }
    remarks
}
