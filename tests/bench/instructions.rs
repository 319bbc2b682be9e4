//! Does one piece of work a number of times, for `tests/instructions` to count its instructions.
//!
//! `cargo bench --bench instructions -- PROBLEM WORK TIMES`, where WORK is `equations` (the normal equations at the
//! start values) or `solve` (the whole estimation).

mod simulated;

use std::ops::ControlFlow;

use trimtab_core::estimate::{Evaluator, NormalEquations};
use trimtab_core::job;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, work, times, ..] = arguments.as_slice() else {
        println!("for tests/instructions: PROBLEM equations|solve TIMES");
        return;
    };
    let times: usize = times.parse().expect("how many times");
    let plan = simulated::plan(name, None);
    let theta = plan.problem.unknowns.start();
    let mut evaluator = Evaluator::new(&plan.problem);
    // before the work, so that no count has the compiler in it
    plan.problem.model.make_native();
    for _ in 0..times {
        match work.as_str() {
            "equations" => {
                let equations = NormalEquations::at(&mut evaluator, &theta);
                assert!(equations.is_ok_and(|equations| equations.det_r() > 0.0));
            }
            "solve" => {
                let result = job::run(&plan, &mut |_| ControlFlow::Continue(()));
                assert!(result.is_ok_and(|result| result.estimate.outcome.is_minimum()));
            }
            _ => panic!("no such work: {work}"),
        }
    }
}
