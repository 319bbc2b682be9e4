//! A linear system as a MAT file of version 4, which MATLAB, Octave and scipy read: matrices one after the other, each with a
//! header of five numbers (MAT-File Format, The MathWorks, appendix on version 4).

use super::linear_system::{LinearSignal, LinearSystem, MatrixEstimate};
use crate::estimate::Measure;

/// The file: `A`, `B`, `C`, `D`, each with `_standard_error` (NaN where there is none), `x0`, `u0`, `input_lag`, `input_delay`,
/// `output_lag`, `output_delay` (s, 0 for none), and the names `states`, `inputs`, `outputs`, a row each.
pub fn linear_system_as_mat(system: &LinearSystem) -> Vec<u8> {
    let mut file = Vec::new();
    let (n, m, p) = (
        system.states.len(),
        system.inputs.len(),
        system.outputs.len(),
    );
    for (name, matrix, size) in [
        ("A", &system.a, (n, n)),
        ("B", &system.b, (n, m)),
        ("C", &system.c, (p, n)),
        ("D", &system.d, (p, m)),
    ] {
        estimated(&mut file, name, matrix, size);
    }
    let column = |values: Vec<f64>| ((values.len(), 1), values);
    let sizes = |signals: &[LinearSignal], of: fn(&LinearSignal) -> Option<Measure>| {
        column(
            signals
                .iter()
                .map(|s| of(s).map_or(0.0, |size| size.value))
                .collect(),
        )
    };
    for (name, (size, values)) in [
        (
            "x0",
            column(system.states.iter().map(|state| state.value).collect()),
        ),
        (
            "u0",
            column(
                system
                    .inputs
                    .iter()
                    .filter_map(|input| input.value)
                    .collect(),
            ),
        ),
        ("input_lag", sizes(&system.inputs, |signal| signal.lag)),
        ("input_delay", sizes(&system.inputs, |signal| signal.delay)),
        ("output_lag", sizes(&system.outputs, |signal| signal.lag)),
        (
            "output_delay",
            sizes(&system.outputs, |signal| signal.delay),
        ),
    ] {
        matrix(&mut file, name, NUMBERS, size, &values);
    }
    let states: Vec<&str> = system
        .states
        .iter()
        .map(|state| state.name.as_str())
        .collect();
    text(&mut file, "states", &states);
    for (name, signals) in [("inputs", &system.inputs), ("outputs", &system.outputs)] {
        let names: Vec<&str> = signals.iter().map(|signal| signal.name.as_str()).collect();
        text(&mut file, name, &names);
    }
    file
}

/// Little-endian doubles: numbers, and characters.
const NUMBERS: u32 = 0;
const TEXT: u32 = 1;

fn estimated(file: &mut Vec<u8>, name: &str, of: &MatrixEstimate, size: (usize, usize)) {
    let by_columns = |entry: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        let places = (0..size.1).flat_map(|j| (0..size.0).map(move |i| (i, j)));
        places.map(|(i, j)| entry(i, j)).collect()
    };
    matrix(
        file,
        name,
        NUMBERS,
        size,
        &by_columns(&|i, j| of.values[i][j]),
    );
    let errors = by_columns(&|i, j| of.standard_errors[i][j].unwrap_or(f64::NAN));
    matrix(
        file,
        &format!("{name}_standard_error"),
        NUMBERS,
        size,
        &errors,
    );
}

/// Names of like length, filled with blanks, as rows.
fn text(file: &mut Vec<u8>, name: &str, rows: &[&str]) {
    let rows: Vec<Vec<char>> = rows.iter().map(|row| row.chars().collect()).collect();
    let width = rows.iter().map(Vec::len).max().unwrap_or_default();
    let at = |i: usize, j: usize| rows[i].get(j).copied().unwrap_or(' ');
    let places = (0..width).flat_map(|j| (0..rows.len()).map(move |i| (i, j)));
    let values: Vec<f64> = places
        .map(|(i, j)| f64::from(u32::from(at(i, j))))
        .collect();
    matrix(file, name, TEXT, (rows.len(), width), &values);
}

fn matrix(file: &mut Vec<u8>, name: &str, kind: u32, size: (usize, usize), by_columns: &[f64]) {
    let word = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
    let head = [kind, word(size.0), word(size.1), 0, word(name.len() + 1)];
    head.iter().for_each(|word| file.extend(word.to_le_bytes()));
    file.extend(name.as_bytes());
    file.push(0);
    by_columns
        .iter()
        .for_each(|value| file.extend(value.to_le_bytes()));
}
