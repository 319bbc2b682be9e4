//! What a Kalman filter begins with: noise, intensities, and the covariance of states and parameters.

use super::flow::along;
use super::options::TrackingOptions;
use super::setup::Setup;
use crate::flight::{Fault, escape};

/// What a filter begins with.
pub(super) struct Begin<'s> {
    pub setup: &'s Setup,
    pub options: &'s TrackingOptions,
    /// Free parameters, by place in the model.
    pub tracked: &'s [usize],
}

impl Begin<'_> {
    /// Refuses sizes of what the model does not have.
    pub(super) fn check_names(&self, faults: &mut Vec<Fault>) {
        let model = &self.setup.model;
        let states = || model.states.iter().map(|state| state.name.as_str());
        let tracked = || {
            self.tracked
                .iter()
                .map(|&i| model.parameters[i].name.as_str())
        };
        let outputs: Vec<&str> = model
            .outputs
            .iter()
            .map(|output| output.name.as_str())
            .collect();
        let options = self.options;
        let all = [
            ("noise", &options.noise, "outputs", outputs),
            (
                "process_noise",
                &options.process_noise,
                "states",
                states().collect(),
            ),
            (
                "drift",
                &options.drift,
                "free parameters",
                tracked().collect(),
            ),
            (
                "uncertainty",
                &options.uncertainty,
                "free parameters and states",
                tracked().chain(states()).collect(),
            ),
        ];
        for (field, sizes, what, known) in all {
            for name in sizes.keys().filter(|name| !known.contains(&name.as_str())) {
                let message = format!("{name} is none of the {what}: {}", known.join(", "));
                faults.push(Fault::new(
                    format!("/{field}/{}", escape(name)),
                    "unknown_symbol",
                    message,
                ));
            }
        }
    }

    pub(super) fn noise(&self, faults: &mut Vec<Fault>) -> Vec<f64> {
        let outputs = self.setup.model.outputs.iter();
        outputs
            .map(|output| match self.options.noise.get(&output.name) {
                Some(sd) => (sd * output.unit.scale).powi(2),
                None => {
                    let name = &output.name;
                    let message = format!("ekf needs the standard deviation of the noise of {name}, in the unit of the model's output");
                    faults.push(Fault::new(format!("/noise/{}", escape(name)), "missing_value", message));
                    f64::NAN
                }
            })
            .collect()
    }

    /// By state, then parameter: squared, SI.
    pub(super) fn intensities(&self) -> Vec<f64> {
        let model = &self.setup.model;
        let squared =
            |size: Option<&f64>, scale: f64| (size.copied().unwrap_or(0.0) * scale).powi(2);
        let states = model.states.iter();
        let states = states.map(|state| {
            squared(
                self.options.process_noise.get(&state.name),
                state.unit.scale,
            )
        });
        let parameters = self.tracked.iter().map(|&i| &model.parameters[i]);
        let parameters = parameters.map(|p| squared(self.options.drift.get(&p.name), p.unit.scale));
        states.chain(parameters).collect()
    }

    /// By tracked parameter: the standard deviation of its start, SI.
    pub(super) fn uncertainties(&self, faults: &mut Vec<Fault>) -> Vec<f64> {
        let model = &self.setup.model;
        let all = self.tracked.iter().map(|&i| {
            let info = &model.parameters[i];
            let own = self.options.uncertainty.get(&info.name).copied();
            let own = own.or(info.document.prior.map(|prior| prior.sd));
            let size = own.map_or(self.setup.start[i].abs(), |own| own * info.unit.scale);
            if own.is_none() && size == 0.0 {
                let name = &info.name;
                let message = format!("{name} starts from 0, so that nothing says how far off that may be; say its standard deviation");
                faults.push(Fault::new(format!("/uncertainty/{}", escape(name)), "missing_value", message));
            }
            size
        });
        all.collect()
    }

    /// P of the initial states, which are functions of θ, and of θ.
    pub(super) fn covariance(
        &self,
        column: &[Option<usize>],
        width: usize,
        sizes: &[f64],
    ) -> Vec<f64> {
        let model = &self.setup.model;
        let n = model.states.len();
        // J = ∂(x0; θ)/∂θ, row by row
        let mut slopes = vec![0.0; width * width];
        (n..width).for_each(|i| slopes[i * width + i] = 1.0);
        let jacobian = &model.initial_jacobian;
        let mut workspace = jacobian.program.workspace();
        jacobian
            .program
            .set_parameters(&mut workspace, &self.setup.start);
        jacobian.program.run(&mut workspace);
        along(
            jacobian,
            &workspace,
            column,
            width,
            &[],
            &mut slopes[..n * width],
        );
        let mut covariance = vec![0.0; width * width];
        for i in 0..width {
            for j in 0..width {
                let both = slopes[i * width + n..(i + 1) * width]
                    .iter()
                    .zip(&slopes[j * width + n..(j + 1) * width]);
                let sum = both.zip(sizes).map(|((a, b), size)| a * b * size * size);
                covariance[i * width + j] = sum.sum();
            }
        }
        for (i, state) in model.states.iter().enumerate() {
            let own = self.options.uncertainty.get(&state.name);
            covariance[i * (width + 1)] += own.map_or(0.0, |own| (own * state.unit.scale).powi(2));
        }
        covariance
    }
}
