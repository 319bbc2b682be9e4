//! What machine code is handed.

use crate::model::scalar::BLOCK;

/// Steps to take, no more than a block has samples, and where the states go.
pub(crate) struct StepBlock<'a> {
    /// By stage: its weight, and how far the next one goes, as shares of the step.
    pub stages: &'a [[f64; 2]],
    /// Length of each step, s: at most as many as there are samples in a block.
    pub lengths: &'a [f64],
    /// By stage, then input: values over the block.
    pub inputs: &'a [[f64; BLOCK]],
    /// By stage: times over the block.
    pub times: &'a [[f64; BLOCK]],
    /// By stage, then state: values over the block, to be filled in.
    pub stage_states: &'a mut [[f64; BLOCK]],
    /// At the first sample; afterwards behind the last step.
    pub state: &'a mut [f64],
}

/// What compiled code is handed, by address.
#[repr(C)]
pub(super) struct Handed {
    pub registers: *const f64,
    pub stages: *const [f64; 2],
    pub stages_end: *const [f64; 2],
    pub lengths: *const f64,
    /// How many, times the size of a number.
    pub lengths_size: usize,
    pub inputs: *const f64,
    pub times: *const f64,
    pub stage_states: *mut f64,
    pub state: *mut f64,
}
