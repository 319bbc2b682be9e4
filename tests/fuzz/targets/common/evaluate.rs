//! One evaluation of everything that a model compiles to.

use trimtab_core::model::{Model, Program};

pub fn once(model: &Model) {
    for program in [
        &model.initial,
        &model.dynamics,
        &model.observation,
        &model.initial_jacobian.program,
        &model.dynamics_jacobian.program,
        &model.observation_jacobian.program,
    ] {
        run(model, program);
    }
}

fn run(model: &Model, program: &Program) {
    let mut workspace = program.workspace::<f64>();
    let parameters: Vec<f64> = (0..model.parameters.len())
        .map(|i| 0.5 + i as f64)
        .collect();
    program.set_parameters(&mut workspace, &parameters);
    program.states(&mut workspace).fill(0.25);
    program.inputs(&mut workspace).fill(-1.0);
    *program.time(&mut workspace) = 1.5;
    program.run(&mut workspace);
    let mut results = vec![0.0; program.len()];
    program.results(&workspace, &mut results);
}
