//! From the instructions of a program to a function that takes steps.
//!
//! Three nested things: samples, stages, and the instructions of f, which stand in the code once. What a stage hands to
//! the next, the state at which it is evaluated and the sum of slopes, goes from block to block as numbers.

use std::collections::HashMap;
use std::mem::offset_of;

use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{
    AbiParam, Block, BlockArg, Function, InstBuilder, MemFlagsData, SigRef, Signature, StackSlot,
    StackSlotData, StackSlotKind, Type, Value, types,
};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::Module;

use super::functions;
use super::handed::Handed;
use crate::model::instruction::Instruction;
use crate::model::operation::Operation;
use crate::model::program::Program;
use crate::model::scalar::BLOCK;

const NUMBER: i32 = 8;
/// From a quantity to the next in the same stage.
const OVER_BLOCK: i32 = NUMBER * BLOCK as i32;
const POINTER: Type = types::I64;
const F: Type = types::F64;

/// Of a function that takes the address of [`Handed`].
pub(super) fn signature(module: &impl Module) -> Signature {
    let mut signature = module.make_signature();
    signature.params.push(AbiParam::new(POINTER));
    signature
}

/// Writes the function.
pub(super) fn steps(
    dynamics: &Program,
    target: TargetFrontendConfig,
    function: &mut Function,
    memory: &mut FunctionBuilderContext,
) {
    let mut builder = FunctionBuilder::new(function, memory);
    let numbers = (2 * functions::ANGLES) as u32;
    let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, NUMBER as u32 * numbers, 3);
    let mut emitter = Emitter {
        sines_and_cosines: builder.create_sized_stack_slot(slot),
        builder,
        dynamics,
        target,
        values: Vec::new(),
        signatures: HashMap::new(),
    };
    emitter.steps();
    emitter.builder.finalize(target);
}

/// Addresses of one stage at one sample.
#[derive(Clone, Copy)]
struct Places {
    registers: Value,
    inputs: Value,
    times: Value,
}

struct Emitter<'a> {
    builder: FunctionBuilder<'a>,
    dynamics: &'a Program,
    target: TargetFrontendConfig,
    /// By register: its number, once there is one.
    values: Vec<Option<Value>>,
    /// By whether an address goes in, and how many numbers go in and out.
    signatures: HashMap<(bool, usize, usize), SigRef>,
    /// Where sines stand, then cosines.
    sines_and_cosines: StackSlot,
}

impl Emitter<'_> {
    fn steps(&mut self) {
        let states = self.dynamics.slots().states;
        let entry = self.block(&[POINTER], 0);
        // byte offset of the sample, then the state there
        let sample = self.block(&[POINTER], states);
        // stage, its inputs, times and states, then the state to evaluate at and the sum of slopes
        let stage = self.block(&[POINTER; 4], 2 * states);
        let first_stage = self.builder.create_block();
        let next_stage = self.builder.create_block();
        let next_sample = self.builder.create_block();
        let end = self.builder.create_block();

        self.builder.switch_to_block(entry);
        let handed = self.builder.block_params(entry)[0];
        let mut field =
            |offset: usize| (self.builder.ins()).load(POINTER, flags(), handed, offset as i32);
        let registers = field(offset_of!(Handed, registers));
        let stages = field(offset_of!(Handed, stages));
        let stages_end = field(offset_of!(Handed, stages_end));
        let lengths = field(offset_of!(Handed, lengths));
        let lengths_size = field(offset_of!(Handed, lengths_size));
        let inputs = field(offset_of!(Handed, inputs));
        let times = field(offset_of!(Handed, times));
        let stage_states = field(offset_of!(Handed, stage_states));
        let state = field(offset_of!(Handed, state));
        let zero = self.builder.ins().iconst(POINTER, 0);
        let mut start = vec![zero];
        start.extend((0..states).map(|i| self.load(state, NUMBER * i as i32)));
        self.jump(sample, &start);

        self.builder.switch_to_block(sample);
        let parameters = self.builder.block_params(sample).to_vec();
        let (offset, now) = (parameters[0], &parameters[1..]);
        let more = (self.builder.ins()).icmp(IntCC::UnsignedLessThan, offset, lengths_size);
        (self.builder.ins()).brif(more, first_stage, &[], end, &[]);

        self.builder.switch_to_block(first_stage);
        let length = self.builder.ins().iadd(lengths, offset);
        let length = self.load(length, 0);
        let none = self.builder.ins().f64const(0.0);
        let mut to = vec![stages];
        to.extend([inputs, times, stage_states].map(|at| self.builder.ins().iadd(at, offset)));
        to.extend(now);
        to.resize(to.len() + states, none);
        self.jump(stage, &to);

        self.builder.switch_to_block(stage);
        let parameters = self.builder.block_params(stage).to_vec();
        let [stage_now, inputs, times, stage_states] = parameters[..4] else {
            return;
        };
        let (at, sum) = parameters[4..].split_at(states);
        for (i, &x) in at.iter().enumerate() {
            (self.builder.ins()).store(flags(), x, stage_states, OVER_BLOCK * i as i32);
        }
        let places = Places {
            registers,
            inputs,
            times,
        };
        let slopes = self.slopes(places, at);
        let weight = self.load(stage_now, 0);
        let weight = self.builder.ins().fmul(length, weight);
        let sum = self.plus(sum, weight, &slopes);
        let last = (self.builder.ins()).iadd_imm_s(stage_now, i64::from(2 * NUMBER));
        let more = (self.builder.ins()).icmp(IntCC::NotEqual, last, stages_end);
        (self.builder.ins()).brif(more, next_stage, &[], next_sample, &[]);

        self.builder.switch_to_block(next_stage);
        let advance = self.load(stage_now, NUMBER);
        let advance = self.builder.ins().fmul(length, advance);
        let count = self.dynamics.slots().inputs;
        let mut to = vec![last];
        for (place, count) in [(inputs, count), (times, 1), (stage_states, states)] {
            let size = i64::from(OVER_BLOCK) * count as i64;
            to.push(self.builder.ins().iadd_imm_s(place, size));
        }
        to.extend(self.plus(now, advance, &slopes));
        to.extend(&sum);
        self.jump(stage, &to);

        self.builder.switch_to_block(next_sample);
        let mut to = vec![(self.builder.ins()).iadd_imm_s(offset, i64::from(NUMBER))];
        to.extend((now.iter().zip(&sum)).map(|(&x, &sum)| self.builder.ins().fadd(x, sum)));
        self.jump(sample, &to);

        self.builder.switch_to_block(end);
        for (i, &x) in now.iter().enumerate() {
            (self.builder.ins()).store(flags(), x, state, NUMBER * i as i32);
        }
        self.builder.ins().return_(&[]);
        self.builder.seal_all_blocks();
    }

    /// f at a state.
    fn slopes(&mut self, places: Places, at: &[Value]) -> Vec<Value> {
        self.values = vec![None; self.dynamics.registers()];
        for (value, &x) in self.values.iter_mut().zip(at) {
            *value = Some(x);
        }
        let body = self.dynamics.body();
        let levels = trigonometric_levels(body, self.dynamics.registers());
        let level = |instruction: &Instruction| levels[instruction.target as usize];
        let last = body.iter().map(level).max().unwrap_or(0);
        for now in 0..=last {
            let of_now = body.iter().filter(|instruction| level(instruction) == now);
            let (trigonometric, others): (Vec<_>, Vec<_>) =
                of_now.partition(|i| is_trigonometric(i));
            self.sines_and_cosines(places, &trigonometric);
            for instruction in others {
                let value = self.one(places, instruction);
                self.values[instruction.target as usize] = Some(value);
            }
        }
        let results = self.dynamics.result_registers();
        (results.iter())
            .map(|&register| self.value(places, register))
            .collect()
    }

    /// Sines and cosines that do not wait for one another: of several angles for the price of one.
    fn sines_and_cosines(&mut self, places: Places, instructions: &[&Instruction]) {
        let mut angles: Vec<u32> = instructions.iter().map(|i| i.a).collect();
        angles.sort_unstable();
        angles.dedup();
        for angles in angles.chunks(functions::ANGLES) {
            let mut numbers: Vec<Value> = angles
                .iter()
                .map(|&angle| self.value(places, angle))
                .collect();
            // one that is there twice does no harm
            numbers.resize(functions::ANGLES, numbers[0]);
            let address = (self.builder.ins()).stack_addr(POINTER, self.sines_and_cosines, 0);
            self.call::<0>(functions::of_sines_and_cosines(), Some(address), &numbers);
            for instruction in instructions {
                let Some(place) = angles.iter().position(|&angle| angle == instruction.a) else {
                    continue;
                };
                let place = match instruction.operation {
                    Operation::Cos => functions::ANGLES + place,
                    _ => place,
                };
                let value = self.load(address, NUMBER * place as i32);
                self.values[instruction.target as usize] = Some(value);
            }
        }
    }

    /// The number in a register: a result of the body, or what stands there before it.
    fn value(&mut self, places: Places, register: u32) -> Value {
        if let Some(value) = self.values[register as usize] {
            return value;
        }
        let slots = self.dynamics.slots();
        let value = if register > slots.time() {
            self.load(places.registers, NUMBER * register as i32)
        } else if register == slots.time() {
            self.load(places.times, 0)
        } else {
            let input = register - slots.input(0);
            self.load(places.inputs, OVER_BLOCK * input as i32)
        };
        self.values[register as usize] = Some(value);
        value
    }

    fn one(&mut self, places: Places, instruction: &Instruction) -> Value {
        let operation = instruction.operation;
        let a = self.value(places, instruction.a);
        if let Some(function) = functions::of_one(operation) {
            return self.call::<1>(function, None, &[a])[0];
        }
        match operation {
            Operation::Negate => return self.builder.ins().fneg(a),
            Operation::Sqrt => return self.builder.ins().sqrt(a),
            Operation::Abs => return self.builder.ins().fabs(a),
            _ => {}
        }
        let b = self.value(places, instruction.b);
        if let Some(function) = functions::of_two(operation) {
            return self.call::<1>(function, None, &[a, b])[0];
        }
        match operation {
            Operation::Add => return self.builder.ins().fadd(a, b),
            Operation::Subtract => return self.builder.ins().fsub(a, b),
            Operation::Multiply => return self.builder.ins().fmul(a, b),
            Operation::Divide => return self.builder.ins().fdiv(a, b),
            Operation::Less => return self.truth(FloatCC::LessThan, a, b),
            Operation::LessOrEqual => return self.truth(FloatCC::LessThanOrEqual, a, b),
            _ => {}
        }
        let c = self.value(places, instruction.c);
        match operation {
            Operation::Select => {
                let none = self.builder.ins().f64const(0.0);
                let yes = self.builder.ins().fcmp(FloatCC::NotEqual, a, none);
                self.builder.ins().select(yes, b, c)
            }
            Operation::MultiplySubtract => {
                let a = self.builder.ins().fneg(a);
                self.builder.ins().fma(a, b, c)
            }
            // the only one left
            _ => self.builder.ins().fma(a, b, c),
        }
    }

    fn truth(&mut self, condition: FloatCC, a: Value, b: Value) -> Value {
        let holds = self.builder.ins().fcmp(condition, a, b);
        let (yes, no) = (1.0, 0.0);
        let yes = self.builder.ins().f64const(yes);
        let no = self.builder.ins().f64const(no);
        self.builder.ins().select(holds, yes, no)
    }

    /// from + factor * slopes, each operation rounded.
    fn plus(&mut self, from: &[Value], factor: Value, slopes: &[Value]) -> Vec<Value> {
        let one = |(&from, &slope): (&Value, &Value)| {
            let product = self.builder.ins().fmul(factor, slope);
            self.builder.ins().fadd(from, product)
        };
        from.iter().zip(slopes).map(one).collect()
    }

    fn call<const RESULTS: usize>(
        &mut self,
        function: usize,
        address: Option<Value>,
        numbers: &[Value],
    ) -> [Value; RESULTS] {
        let signature = *(self.signatures)
            .entry((address.is_some(), numbers.len(), RESULTS))
            .or_insert_with(|| {
                let mut signature = Signature::new(self.target.default_call_conv);
                let address = address.map(|_| AbiParam::new(POINTER));
                signature.params = address.into_iter().collect();
                (signature.params).extend(numbers.iter().map(|_| AbiParam::new(F)));
                signature.returns = vec![AbiParam::new(F); RESULTS];
                self.builder.import_signature(signature)
            });
        let function = self.builder.ins().iconst(POINTER, function as i64);
        let arguments: Vec<Value> = address.into_iter().chain(numbers.iter().copied()).collect();
        let call = (self.builder.ins()).call_indirect(signature, function, &arguments);
        let results = self.builder.inst_results(call);
        std::array::from_fn(|i| results[i])
    }

    fn load(&mut self, from: Value, offset: i32) -> Value {
        self.builder.ins().load(F, flags(), from, offset)
    }

    fn jump(&mut self, to: Block, values: &[Value]) {
        let values: Vec<BlockArg> = values.iter().map(|&value| value.into()).collect();
        self.builder.ins().jump(to, &values);
    }

    fn block(&mut self, integers: &[Type], numbers: usize) -> Block {
        let block = self.builder.create_block();
        for &integer in integers {
            self.builder.append_block_param(block, integer);
        }
        for _ in 0..numbers {
            self.builder.append_block_param(block, F);
        }
        block
    }
}

fn is_trigonometric(instruction: &Instruction) -> bool {
    matches!(instruction.operation, Operation::Sin | Operation::Cos)
}

/// By register: how many sines and cosines, one of the other, stand before what is in it.
fn trigonometric_levels(body: &[Instruction], registers: usize) -> Vec<usize> {
    let mut levels = vec![0; registers];
    for instruction in body {
        let operands = [instruction.a, instruction.b, instruction.c];
        let before = operands.map(|operand| levels[operand as usize]);
        let own = usize::from(is_trigonometric(instruction));
        levels[instruction.target as usize] = own + before.into_iter().max().unwrap_or(0);
    }
    levels
}

/// Of memory that is there and aligned.
fn flags() -> MemFlagsData {
    MemFlagsData::trusted()
}
