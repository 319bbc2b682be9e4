//! Integration steps as machine code.
//!
//! States follow one another, so that samples cannot be stepped side by side: an interpreter pays its jump for each
//! single number. The step of a model that has taken many steps is therefore compiled, to the same operations in the
//! same order: the numbers are those of the interpreter to the last bit. Where there is no compiler for the machine,
//! or it has no multiply-add, or the equations are very many, the interpreter goes on.

mod code;
mod emit;
mod functions;
mod handed;

pub(crate) use handed::StepBlock;

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::program::{Program, Workspace};
use super::scalar::BLOCK;
use code::Code;

/// Instructions that the interpreter has done when compilation begins, and how many more for each in the body. It has
/// then taken about as long as compilation will: what is run once or twice does not pay for it.
const INTERPRETED_BEFORE: usize = 100_000;
const INTERPRETED_BEFORE_EACH: usize = 2_500;
/// Larger bodies are left to the interpreter. The compiler takes some 7 µs for an instruction up to here, and more and
/// more for each beyond.
const MOST_INSTRUCTIONS: usize = 500;

/// What the steps of one model have cost so far, and their machine code once there is some.
#[derive(Debug, Default)]
pub(crate) struct Native {
    interpreted: AtomicUsize,
    /// `None` inside where the machine or the model does not allow for it.
    steps: OnceLock<Option<NativeSteps>>,
}

impl Native {
    /// The machine code of steps, if by now there is any. `steps` of so many stages are about to be taken: where the
    /// sum of what was asked for warrants it, this call compiles. Others meanwhile go on without.
    pub(crate) fn steps(
        &self,
        dynamics: &Program,
        steps: usize,
        stages: usize,
    ) -> Option<&NativeSteps> {
        if let Some(steps) = self.steps.get() {
            return steps.as_ref();
        }
        let body = dynamics.operations();
        let (more, bound) = (
            steps * stages * body,
            INTERPRETED_BEFORE + INTERPRETED_BEFORE_EACH * body,
        );
        let before = self.interpreted.fetch_add(more, Ordering::Relaxed);
        let crosses = before < bound && before + more >= bound;
        if crosses { self.now(dynamics) } else { None }
    }

    /// As [`Self::steps`], whatever was asked for.
    pub(crate) fn now(&self, dynamics: &Program) -> Option<&NativeSteps> {
        let compile = || NativeSteps::compile(dynamics);
        self.steps.get_or_init(compile).as_ref()
    }
}

/// Steps of any explicit method in which each stage builds on the one before it.
#[derive(Debug)]
pub(crate) struct NativeSteps {
    code: Code,
    registers: usize,
    states: usize,
    inputs: usize,
}

impl NativeSteps {
    fn compile(dynamics: &Program) -> Option<Self> {
        if dynamics.operations() > MOST_INSTRUCTIONS {
            return None;
        }
        Some(Self {
            code: Code::compile(dynamics)?,
            registers: dynamics.registers(),
            states: dynamics.slots().states,
            inputs: dynamics.slots().inputs,
        })
    }

    /// Takes steps. θ stands in `workspace`, which is one of the program that this was compiled from.
    pub(crate) fn take(&self, workspace: &Workspace<f64>, block: &mut StepBlock<'_>) {
        let stages = block.stages.len();
        assert!(stages > 0 && block.lengths.len() <= BLOCK);
        assert_eq!(workspace.registers().len(), self.registers);
        assert_eq!(block.inputs.len(), stages * self.inputs);
        assert_eq!(block.times.len(), stages);
        assert_eq!(block.stage_states.len(), stages * self.states);
        assert_eq!(block.state.len(), self.states);
        self.code.run(workspace.registers(), block);
    }
}
