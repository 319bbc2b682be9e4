//! The results of a program at the samples of a block, evaluated [`LANES`] at a time.

use crate::model::{LANES, Lanes, Program, Workspace};

/// Samples in a block of the adjoint, and steps between two of its checkpoints.
pub(super) const SPAN: usize = 4 * LANES;

pub(super) struct SideBySide<'m> {
    program: &'m Program,
    workspace: Workspace<Lanes>,
    /// Results that change from sample to sample; the others are filled in once for each θ.
    varying: Vec<usize>,
    /// By stage, then result: values over the block.
    values: Vec<[f64; SPAN]>,
}

impl<'m> SideBySide<'m> {
    pub(super) fn new(program: &'m Program, stages: usize) -> Self {
        Self {
            program,
            workspace: program.workspace(),
            varying: (0..program.len()).filter(|&i| program.varies(i)).collect(),
            values: vec![[0.0; SPAN]; stages * program.len()],
        }
    }

    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        let lanes: Vec<Lanes> = parameters
            .iter()
            .map(|&value| Lanes([value; LANES]))
            .collect();
        self.program.set_parameters(&mut self.workspace, &lanes);
        for i in (0..self.program.len()).filter(|&i| !self.program.varies(i)) {
            let constant = self.program.result(&self.workspace, i).0[0];
            let of_all_stages = self.values.iter_mut().skip(i).step_by(self.program.len());
            of_all_stages.for_each(|values| values.fill(constant));
        }
    }

    /// Evaluates the samples of the block from `group` on; `set` puts states, inputs and time in place.
    pub(super) fn evaluate(
        &mut self,
        stage: usize,
        group: usize,
        set: &impl Fn(&Program, &mut Workspace<Lanes>),
    ) {
        if self.varying.is_empty() {
            return;
        }
        set(self.program, &mut self.workspace);
        self.program.run(&mut self.workspace);
        for &i in &self.varying {
            let result = self.program.result(&self.workspace, i);
            let values = &mut self.values[stage * self.program.len() + i];
            values[group..group + LANES].copy_from_slice(&result.0);
        }
    }

    /// Whether a result changes from sample to sample.
    pub(super) fn varies(&self, result: usize) -> bool {
        self.program.varies(result)
    }

    /// A result over the block.
    pub(super) fn result(&self, stage: usize, result: usize) -> &[f64; SPAN] {
        &self.values[stage * self.program.len() + result]
    }

    /// Bytes of the values.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.values.as_slice())
    }
}
