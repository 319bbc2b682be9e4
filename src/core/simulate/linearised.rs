//! The results of a program over a block of samples, evaluated side by side.

use super::aligned::Aligned;
use super::trajectory::Trajectory;
use crate::model::{BLOCK, LANES, Lanes, Program, Workspace};

/// Results of one program, by stage of the integration scheme and sample of the block.
pub(super) struct Linearised<'m> {
    program: &'m Program,
    workspace: Workspace<Lanes>,
    results: usize,
    /// Results that change from sample to sample; the others are filled in once for each θ.
    varying: Vec<usize>,
    /// By stage, then result: values over the block.
    values: Aligned<[f64; BLOCK]>,
}

impl<'m> Linearised<'m> {
    pub(super) fn new(program: &'m Program, stages: usize) -> Self {
        let results = program.len();
        Self {
            program,
            workspace: program.workspace(),
            results,
            varying: (0..results).filter(|&i| program.varies(i)).collect(),
            values: Aligned::zeros(stages * results),
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        let lanes: Vec<Lanes> = parameters
            .iter()
            .map(|&value| Lanes([value; LANES]))
            .collect();
        self.program.set_parameters(&mut self.workspace, &lanes);
        for i in (0..self.results).filter(|&i| !self.program.varies(i)) {
            let constant = self.program.result(&self.workspace, i).0[0];
            self.values
                .iter_mut()
                .skip(i)
                .step_by(self.results)
                .for_each(|values| values.fill(constant));
        }
    }

    /// Evaluates the `len` samples of a block at one stage.
    pub(super) fn evaluate(&mut self, stage: usize, len: usize, trajectory: &Trajectory<'_>) {
        if self.varying.is_empty() {
            return;
        }
        for group in (0..len).step_by(LANES) {
            trajectory.place(stage, group, self.program, &mut self.workspace);
            self.program.run(&mut self.workspace);
            for &i in &self.varying {
                let result = self.program.result(&self.workspace, i);
                self.values[stage * self.results + i][group..group + LANES]
                    .copy_from_slice(&result.0);
            }
        }
    }

    /// How many results there are.
    pub(super) fn results(&self) -> usize {
        self.results
    }

    #[inline(always)]
    pub(super) fn value(&self, stage: usize, result: usize, k: usize) -> f64 {
        self.values[stage * self.results + result][k]
    }

    /// A result over the block.
    pub(super) fn over_block(&self, stage: usize, result: usize) -> &[f64; BLOCK] {
        &self.values[stage * self.results + result]
    }

    /// All results over the block, one after the other.
    pub(super) fn all_over_block(&self, stage: usize) -> &[[f64; BLOCK]] {
        &self.values[stage * self.results..(stage + 1) * self.results]
    }

    /// Whether a result changes from sample to sample.
    pub(super) fn varies(&self, result: usize) -> bool {
        self.program.varies(result)
    }
}
