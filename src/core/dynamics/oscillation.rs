//! Oscillations of a model at the start of a maneuver, and which inputs move them.

use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::trim::equations::Equations;
use crate::flight::Faults;
use crate::model::Model;

/// A pair of complex eigenvalues λ of A.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Oscillation {
    /// |λ|, rad/s
    pub natural_frequency: f64,
    /// By input: |lᴴ b|/(|l| |b|) of the left eigenvector l and the input's column b, 0 where it does not move it.
    pub moved_by: Vec<f64>,
}

/// Those of the model linearised at its initial state and these inputs, fastest first. Parameters and inputs are in SI.
///
/// # Errors
/// The model with inputs as parameters is too large.
pub(crate) fn oscillations(
    model: &Model,
    parameters: &[f64],
    inputs: &[f64],
) -> Result<Vec<Oscillation>, Faults> {
    let equations = Equations::of(model)?;
    let mut z = equations.initial(parameters);
    z.truncate(equations.states);
    z.extend(inputs);
    let slopes = equations.at(&z, parameters).rates.by_unknown;
    let n = equations.states;
    let (a, b) = (
        slopes.columns(0, n).into_owned(),
        slopes.columns(n, inputs.len()),
    );
    if n == 0 || !slopes.iter().all(|slope| slope.is_finite()) {
        return Ok(Vec::new());
    }
    let Some(schur) = Schur::try_new(a.clone(), f64::EPSILON, 10_000) else {
        return Ok(Vec::new());
    };
    let eigenvalues = schur.complex_eigenvalues();
    let oscillates = |value: &&Complex<f64>| value.im > 1e-6 * value.norm();
    let mut all: Vec<Oscillation> = (eigenvalues.iter().filter(oscillates))
        .filter_map(|value| {
            let left = left_eigenvector(&a, *value)?;
            let share = |column: DVector<Complex<f64>>| match column.norm() {
                0.0 => 0.0,
                size => left.dotc(&column).norm() / size,
            };
            Some(Oscillation {
                natural_frequency: value.norm(),
                moved_by: (b.column_iter())
                    .map(|column| share(column.map(Complex::from)))
                    .collect(),
            })
        })
        .collect();
    all.sort_by(|a, b| b.natural_frequency.total_cmp(&a.natural_frequency));
    Ok(all)
}

/// Of length one: lᴴ A = λ lᴴ, the direction in which (A − λ)ᴴ is smallest.
fn left_eigenvector(a: &DMatrix<f64>, value: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let n = a.nrows();
    let identity = DMatrix::<Complex<f64>>::identity(n, n);
    let shifted = (a.map(Complex::from) - identity * value).adjoint();
    let svd = shifted.svd(false, true);
    let (smallest, _) = svd.singular_values.argmin();
    Some(svd.v_t?.row(smallest).adjoint())
}
