//! The truth: equations of motion and all that acts on them, integrated at a tenth of the time between samples.

use std::sync::Arc;

use crate::inputs::Command;
use crate::motion::{Added, Airframe, Around, Motion, SURFACES, Scene, Trim};
use crate::plant::Plant;

/// Integration steps between samples.
pub(crate) const FINER: usize = 10;

/// One maneuver to be flown.
#[derive(Clone)]
pub(crate) struct Sortie {
    pub label: String,
    /// Of the fit, or of the prediction.
    pub fitted: bool,
    /// s
    pub duration: f64,
    pub commands: [Command; SURFACES],
    pub scene: Scene,
}

/// What the surfaces do: twice as finely as the integration steps.
struct Deflections {
    command: Vec<[f64; SURFACES]>,
    surface: Vec<[f64; SURFACES]>,
}

impl Deflections {
    fn new(
        sortie: &Sortie,
        plant: &Plant,
        trimmed: &[f64; SURFACES],
        step: f64,
        count: usize,
    ) -> Self {
        let half = 0.5 * step;
        let series: Vec<Vec<f64>> = (0..SURFACES)
            .map(|i| {
                (0..2 * count + 1)
                    .map(|k| trimmed[i] + (sortie.commands[i])(k as f64 * half))
                    .collect()
            })
            .collect();
        let mut moved = series.clone();
        for (surface, change) in &plant.surfaces {
            moved[*surface] = change(&moved[*surface], half);
        }
        let across = |of: &[Vec<f64>]| {
            (0..2 * count + 1)
                .map(|k| std::array::from_fn(|i| of[i][k]))
                .collect()
        };
        Self {
            command: across(&series),
            surface: across(&moved),
        }
    }
}

struct Flight<'f> {
    frame: &'f dyn Airframe,
    scene: &'f Scene,
    plant: &'f Plant,
    states: usize,
}

impl Flight<'_> {
    /// dx/dt of the airframe and of what the forces remember, and the motion.
    fn rates(
        &self,
        time: f64,
        x: &[f64],
        command: [f64; SURFACES],
        surface: [f64; SURFACES],
    ) -> (Vec<f64>, Motion) {
        let around = Around {
            scene: self.scene,
            air: self.plant.air_at(time),
        };
        let mut motion = Motion {
            command,
            surface,
            ..self.scene.at(time)
        };
        let mut dx = vec![0.0; x.len()];
        let (own, memory) = x.split_at(self.states);
        let mut added: Added = [0.0; 6];
        // what a force sees of accelerations is what they are without it
        self.frame
            .rates(own, &around, &added, &mut motion, &mut dx[..self.states]);
        if self.plant.forces.is_empty() {
            return (dx, motion);
        }
        let mut at = 0;
        for force in &self.plant.forces {
            let to = at + force.states();
            let rates = &mut dx[self.states + at..self.states + to];
            force.act(&motion, &memory[at..to], rates, &mut added);
            at = to;
        }
        self.frame
            .rates(own, &around, &added, &mut motion, &mut dx[..self.states]);
        (dx, motion)
    }

    /// The steady start with everything that acts, and the deflections that hold it.
    fn trimmed(&self) -> (Vec<f64>, [f64; SURFACES]) {
        let mut x = self.frame.start();
        let mut command = [0.0; SURFACES];
        let places = self.frame.trim();
        let still = |x: &[f64], command: &[f64; SURFACES]| {
            let surface = |i: usize| {
                let changes = self
                    .plant
                    .surfaces
                    .iter()
                    .filter(|(surface, _)| *surface == i);
                changes.fold(command[i], |u, (_, change)| change(&[u, u], 1e-3)[0])
            };
            let surface = std::array::from_fn(surface);
            let around = Around {
                scene: self.scene,
                air: Default::default(),
            };
            let mut motion = Motion {
                command: *command,
                surface,
                ..self.scene.at(0.0)
            };
            let mut dx = vec![0.0; x.len()];
            let mut added: Added = [0.0; 6];
            self.frame.rates(x, &around, &added, &mut motion, &mut dx);
            let mut memory = Vec::new();
            for force in &self.plant.forces {
                let own = force.start(&motion);
                force.act(&motion, &own, &mut vec![0.0; own.len()], &mut added);
                memory.extend(own);
            }
            self.frame.rates(x, &around, &added, &mut motion, &mut dx);
            (dx, memory)
        };
        let shift =
            |x: &mut Vec<f64>, command: &mut [f64; SURFACES], place: Trim, by: f64| match place {
                Trim::State(i) => x[i] += by,
                Trim::Surface(i) => command[i] += by,
            };
        for _ in 0..12 {
            let (now, _) = still(&x, &command);
            let n = places.len();
            let mut jacobian = vec![vec![0.0; n + 1]; n];
            for (column, (place, _)) in places.iter().enumerate() {
                let (mut moved, mut moved_command) = (x.clone(), command);
                shift(&mut moved, &mut moved_command, *place, 1e-5);
                let (then, _) = still(&moved, &moved_command);
                for (row, (_, equation)) in places.iter().enumerate() {
                    jacobian[row][column] = (then[*equation] - now[*equation]) / 1e-5;
                }
            }
            for (row, (_, equation)) in places.iter().enumerate() {
                jacobian[row][n] = -now[*equation];
            }
            for ((place, _), by) in places.iter().zip(solve(jacobian)) {
                shift(&mut x, &mut command, *place, by);
            }
        }
        let (_, memory) = still(&x, &command);
        x.extend(memory);
        (x, command)
    }
}

/// Gauss elimination with pivots; rows hold the right-hand side last.
fn solve(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for column in 0..n {
        let best =
            (column..n).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()));
        rows.swap(column, best.unwrap_or(column));
        let pivot = rows[column].clone();
        for row in (0..n).filter(|row| *row != column) {
            let factor = rows[row][column] / pivot[column];
            rows[row]
                .iter_mut()
                .zip(&pivot)
                .for_each(|(to, from)| *to -= factor * from);
        }
    }
    (0..n).map(|i| rows[i][n] / rows[i][i]).collect()
}

/// A scene in which the speed falls by a share from start to end, and the derivatives with it.
fn slowed(scene: &Scene, share: f64, duration: f64) -> Scene {
    let ratio = move |t: f64| 1.0 - share * (t / duration).clamp(0.0, 1.0);
    let speed = scene.speed.clone();
    let steady = speed(0.0);
    Scene {
        speed: Arc::new(move |t| speed(t) - steady * (1.0 - ratio(t))),
        speed_ratio: Arc::new(ratio),
        ..scene.clone()
    }
}

/// Flies a sortie: the motion at every integration step; `None` where it does not stay in the air.
pub(crate) fn fly(
    frame: &dyn Airframe,
    sortie: &Sortie,
    plant: &Plant,
    sample: f64,
) -> Option<Vec<Motion>> {
    let step = sample / FINER as f64;
    let count = (sortie.duration / sample).round() as usize * FINER;
    let states = frame.start().len();
    let slowed = plant
        .slows_by
        .map(|share| slowed(&sortie.scene, share, sortie.duration));
    let scene = slowed.as_ref().unwrap_or(&sortie.scene);
    let flight = Flight {
        frame,
        scene,
        plant,
        states,
    };
    let (mut x, trimmed) = flight.trimmed();
    for (state, by) in &plant.displaced {
        x[*state] += by;
    }
    let deflections = Deflections::new(sortie, plant, &trimmed, step, count);
    let rates = |half: usize, x: &[f64]| {
        let (command, surface) = (deflections.command[half], deflections.surface[half]);
        flight.rates(half as f64 * 0.5 * step, x, command, surface)
    };
    let moved = |x: &[f64], dx: &[f64], by: f64| -> Vec<f64> {
        x.iter().zip(dx).map(|(x, d)| x + by * d).collect()
    };
    let mut motions = Vec::with_capacity(count + 1);
    for k in 0..=count {
        let (a, motion) = rates(2 * k, &x);
        if x.iter().any(|v| !v.is_finite() || v.abs() > 1e7) {
            return None;
        }
        motions.push(motion);
        if k == count {
            break;
        }
        let (b, _) = rates(2 * k + 1, &moved(&x, &a, 0.5 * step));
        let (c, _) = rates(2 * k + 1, &moved(&x, &b, 0.5 * step));
        let (d, _) = rates(2 * k + 2, &moved(&x, &c, step));
        for i in 0..x.len() {
            x[i] += step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
    }
    Some(motions)
}
