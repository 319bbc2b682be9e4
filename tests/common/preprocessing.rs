//! Recordings made from others, as the published cases say: columns by formulas, smoothed and differentiated.

use indexmap::IndexMap;
use trimtab_core::flight::Dimension;
use trimtab_core::model::{ChannelFormula, Recorded};

/// Columns of numbers without units, evenly sampled.
pub(crate) struct Table {
    pub step: f64,
    time: Vec<f64>,
    columns: IndexMap<String, Vec<f64>>,
}

impl Recorded for Table {
    fn time(&self) -> &[f64] {
        &self.time
    }
    fn channel(&self, name: &str) -> Option<(&[f64], Dimension)> {
        let column = self.columns.get(name)?;
        Some((column, Dimension::NONE))
    }
    fn names(&self) -> Vec<String> {
        self.columns.keys().cloned().collect()
    }
}

impl Table {
    /// The numbers of some rows (from 1, both included) of a CSV file, under their names without units.
    pub(crate) fn read(csv: &str, [first, last]: [usize; 2], step: f64) -> Self {
        let mut lines = csv.lines();
        let names = lines.next().expect("a header").split(',');
        let mut columns: IndexMap<String, Vec<f64>> = names
            .map(|name| {
                (
                    name.split('[').next().unwrap().trim().to_string(),
                    Vec::new(),
                )
            })
            .collect();
        for line in lines.skip(first - 1).take(last + 1 - first) {
            for (column, cell) in columns.values_mut().zip(line.split(',')) {
                column.push(cell.trim().parse().expect("a number"));
            }
        }
        let count = columns[0].len();
        Self {
            step,
            time: (0..count).map(|k| k as f64 * step).collect(),
            columns,
        }
    }

    pub(crate) fn set(&mut self, name: &str, column: Vec<f64>) {
        self.columns.insert(name.to_string(), column);
    }

    pub(crate) fn len(&self) -> usize {
        self.time.len()
    }

    /// A formula in which `smooth15(...)` and `diff8(...)` may stand.
    pub(crate) fn evaluate(&mut self, formula: &str) -> Vec<f64> {
        let mut text = formula.to_string();
        while let Some((begin, filter)) = (text.find("smooth15(").map(|at| (at, 8)).into_iter())
            .chain(text.find("diff8(").map(|at| (at, 5)))
            .min()
        {
            let (inner, end) = argument(&text, begin + filter);
            let values = self.evaluate(&inner);
            let filtered = match filter {
                8 => smooth15(&values),
                _ => diff8(&values, self.step),
            };
            let name = format!("made_{}", self.columns.len());
            text.replace_range(begin..end, &name);
            self.columns.insert(name, filtered);
        }
        let formula = ChannelFormula::parse(&text).expect("a formula");
        formula.samples(self).expect("columns that are there")
    }

    /// As CSV with the columns `(name, unit)` and the time.
    pub(crate) fn to_csv(&self, columns: &[(String, String)]) -> String {
        let mut csv = "t[s]".to_string();
        for (name, unit) in columns {
            csv.push_str(&format!(",{name}[{unit}]"));
        }
        for (k, time) in self.time.iter().enumerate() {
            csv.push_str(&format!("\n{time:?}"));
            for (name, _) in columns {
                csv.push_str(&format!(",{:?}", self.columns[name][k]));
            }
        }
        csv.push('\n');
        csv
    }
}

/// What stands between the bracket at `open` and the one that closes it, and the place behind that.
pub(crate) fn argument(text: &str, open: usize) -> (String, usize) {
    let mut depth = 0;
    for (at, character) in text[open..].char_indices() {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return (text[open + 1..open + at].to_string(), open + at + 1);
        }
    }
    panic!("an open bracket in {text}")
}

/// Spencer's 15-point filter; 5 points near the ends, nothing at the outermost three.
fn smooth15(x: &[f64]) -> Vec<f64> {
    let n = x.len();
    let sum = |k: usize, weights: &[f64], below: f64| {
        let sides = weights.iter().enumerate().skip(1);
        let sides: f64 = sides.map(|(m, w)| w * (x[k - m] + x[k + m])).sum();
        (weights[0] * x[k] + sides) / below
    };
    let value = |k: usize| match k.min(n - 1 - k) {
        0..=2 => x[k],
        3..=7 => sum(k, &[34.0, 24.0, 7.0], 96.0),
        _ => sum(k, &[74.0, 67.0, 46.0, 21.0, 3.0, -5.0, -6.0, -3.0], 320.0),
    };
    (0..n).map(value).collect()
}

/// Central differences of eighth order; of fourth near the ends, whose last two samples repeat the next one.
fn diff8(x: &[f64], step: f64) -> Vec<f64> {
    const FAR: [f64; 8] = [
        0.88888888887637,
        -0.31111111109862,
        0.11313131312500,
        -0.03535353535135,
        0.00870240870185,
        -0.00155400155390,
        0.00017760017759,
        -0.00000971250971,
    ];
    const NEAR: [f64; 2] = [0.66666666666667, -0.08333333333333];
    let n = x.len();
    let value = |k: usize| {
        let k = k.clamp(2, n - 3);
        let weights = if k < 9 || k > n - 10 {
            &NEAR[..]
        } else {
            &FAR[..]
        };
        let terms = weights.iter().enumerate();
        terms
            .map(|(m, c)| c * (x[k + m + 1] - x[k - m - 1]))
            .sum::<f64>()
            / step
    };
    (0..n).map(value).collect()
}
