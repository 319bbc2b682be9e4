//! The memory of machine code, and calls into it: all that is unsafe.
#![expect(unsafe_code, reason = "machine code is called by its address")]

use std::sync::{Mutex, PoisonError};

use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::FunctionBuilderContext;
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Linkage, Module, default_libcall_names};

use super::emit;
use super::handed::{Handed, StepBlock};
use crate::model::program::Program;

type Entry = unsafe extern "C" fn(*const Handed);

/// Compiled steps; their memory goes with them.
pub(super) struct Code {
    entry: Entry,
    /// There until the end.
    module: Mutex<Option<JITModule>>,
}

impl std::fmt::Debug for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Code").finish_non_exhaustive()
    }
}

impl Code {
    /// Compiles the steps of a program; `None` where the machine is one that this is not made for.
    pub(super) fn compile(dynamics: &Program) -> Option<Self> {
        if !has_multiply_add() {
            return None;
        }
        let mut flags = settings::builder();
        for (name, value) in [
            ("opt_level", "none"),
            ("enable_verifier", "false"),
            ("is_pic", "false"),
            ("unwind_info", "false"),
            ("enable_probestack", "true"),
            ("probestack_strategy", "inline"),
        ] {
            flags.set(name, value).ok()?;
        }
        let isa = cranelift_native::builder().ok()?;
        let isa = isa.finish(settings::Flags::new(flags)).ok()?;
        let mut module = JITModule::new(JITBuilder::with_isa(isa, default_libcall_names()));
        let entry = define(&mut module, dynamics);
        // from here on the module's memory is freed whatever happens
        let module = Mutex::new(Some(module));
        let mut code = Self {
            entry: nothing,
            module,
        };
        // SAFETY: the address is that of a finished function which `emit` gave the signature of `Entry`; it stays
        // as long as the module, and that as long as `code`.
        code.entry = unsafe { std::mem::transmute::<*const u8, Entry>(entry?) };
        Some(code)
    }

    /// Takes the steps of a block of samples.
    ///
    /// The caller has made sure that the slices are as long as the code takes them to be: `registers` as those of the
    /// program, `stage_states`, `inputs` and `times` one block for each stage and each state, input or nothing more,
    /// `state` one number for each state, `lengths` at most a block.
    pub(super) fn run(&self, registers: &[f64], block: &mut StepBlock<'_>) {
        let stages = block.stages.as_ptr_range();
        let handed = Handed {
            registers: registers.as_ptr(),
            stages: stages.start,
            stages_end: stages.end,
            lengths: block.lengths.as_ptr(),
            lengths_size: size_of_val(block.lengths),
            inputs: block.inputs.as_flattened().as_ptr(),
            times: block.times.as_flattened().as_ptr(),
            stage_states: block.stage_states.as_flattened_mut().as_mut_ptr(),
            state: block.state.as_mut_ptr(),
        };
        // SAFETY: `entry` lives as long as `self`, and reads and writes nothing but what is handed over: the numbers
        // of the program's registers, of each stage and step, and of a block for each stage and each of what it has;
        // `NativeSteps::take`, the only caller, has checked these lengths. Addresses come from slices that are
        // borrowed during the call; what a model document says decides on numbers and never on addresses.
        unsafe { (self.entry)(&raw const handed) }
    }
}

impl Drop for Code {
    fn drop(&mut self) {
        let module = self
            .module
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(module) = module.take() {
            // SAFETY: `entry` is called by `run` alone, which borrows `self`: none runs, and none will.
            unsafe { module.free_memory() }
        }
    }
}

/// Stands for code until there is some.
extern "C" fn nothing(_: *const Handed) {}

fn define(module: &mut JITModule, dynamics: &Program) -> Option<*const u8> {
    let mut context = module.make_context();
    context.func.signature = emit::signature(module);
    let name = module.declare_function("steps", Linkage::Export, &context.func.signature);
    let name = name.ok()?;
    let mut memory = FunctionBuilderContext::new();
    emit::steps(
        dynamics,
        module.target_config(),
        &mut context.func,
        &mut memory,
    );
    let control = &mut ControlPlane::default();
    let defined = module.define_function_with_control_plane(name, &mut context, control);
    defined.ok()?;
    module.finalize_definitions().ok()?;
    Some(module.get_finalized_function(name))
}

/// Whether the machine rounds a multiply-add once, and passes numbers as `emit` expects.
fn has_multiply_add() -> bool {
    #[cfg(all(target_arch = "x86_64", unix))]
    return std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(all(target_arch = "x86_64", unix)))]
    return cfg!(all(target_arch = "aarch64", unix));
}
