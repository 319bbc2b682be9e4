//! What flies: the motion as it is, and what an airframe has to tell of it.

use crate::inputs::Command;

/// Surfaces that a pilot moves; the fourth is one that most models do not know.
pub(crate) const SURFACES: usize = 5;
pub(crate) const ELEVATOR: usize = 0;
pub(crate) const AILERON: usize = 1;
pub(crate) const RUDDER: usize = 2;
pub(crate) const FLAP: usize = 3;
pub(crate) const THRUST: usize = 4;

/// Everything that happens at one moment, SI, x forward, y right, z down.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Motion {
    pub time: f64,
    pub speed: f64,
    /// The speed that the flight began with.
    pub steady_speed: f64,
    pub alpha: f64,
    pub beta: f64,
    pub alphadot: f64,
    pub p: f64,
    pub q: f64,
    pub r: f64,
    pub pdot: f64,
    pub qdot: f64,
    pub rdot: f64,
    pub phi: f64,
    pub theta: f64,
    pub psi: f64,
    pub north: f64,
    pub east: f64,
    pub height: f64,
    /// Specific forces at the centre of gravity.
    pub ax: f64,
    pub ay: f64,
    pub az: f64,
    /// Heave or another quantity that one airframe alone has.
    pub own: f64,
    /// What the pilot commands and the recorder sees.
    pub command: [f64; SURFACES],
    /// What the surface does.
    pub surface: [f64; SURFACES],
}

/// What a sensor can measure.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Quantity {
    Speed,
    Alpha,
    Beta,
    P,
    Q,
    R,
    Phi,
    Theta,
    Psi,
    North,
    East,
    Height,
    Ax,
    Ay,
    Az,
    Command(usize),
}

impl Motion {
    pub(crate) fn of(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Speed => self.speed,
            Quantity::Alpha => self.alpha,
            Quantity::Beta => self.beta,
            Quantity::P => self.p,
            Quantity::Q => self.q,
            Quantity::R => self.r,
            Quantity::Phi => self.phi,
            Quantity::Theta => self.theta,
            Quantity::Psi => self.psi,
            Quantity::North => self.north,
            Quantity::East => self.east,
            Quantity::Height => self.height,
            Quantity::Ax => self.ax,
            Quantity::Ay => self.ay,
            Quantity::Az => self.az,
            Quantity::Command(surface) => self.command[surface],
        }
    }

    pub(crate) fn elevator(&self) -> f64 {
        self.surface[ELEVATOR]
    }
    pub(crate) fn aileron(&self) -> f64 {
        self.surface[AILERON]
    }
    pub(crate) fn rudder(&self) -> f64 {
        self.surface[RUDDER]
    }
    pub(crate) fn flap(&self) -> f64 {
        self.surface[FLAP]
    }
}

/// An equation that a force can be missing from. Which unit it has is the airframe's matter: an acceleration in a
/// linear model, a coefficient in others.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Slot {
    Drag,
    Side,
    Lift,
    Roll,
    Pitch,
    Yaw,
}

/// By slot: what is added to an equation.
pub(crate) type Added = [f64; 6];

/// The air that the aircraft flies through.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Air {
    /// Rates of the angles by which a gust turns the flow, rad/s.
    pub alpha_rate: f64,
    pub beta_rate: f64,
    /// North, east, down, and its rate of change.
    pub wind: [f64; 3],
    pub wind_rate: [f64; 3],
}

/// What is given along the flight and has no equation in a linear airframe: the motion in the other plane.
#[derive(Clone)]
pub(crate) struct Scene {
    pub speed: Command,
    pub alpha: Command,
    pub beta: Command,
    pub p: Command,
    pub q: Command,
    pub r: Command,
    pub height: Command,
    /// Speed over the one that a linear airframe's derivatives hold at: stiffness and control follow its square,
    /// damping itself. 1 where they are constants.
    pub speed_ratio: Command,
}

impl Scene {
    /// The motion before an airframe fills in its own.
    pub(crate) fn at(&self, time: f64) -> Motion {
        Motion {
            time,
            speed: (self.speed)(time),
            steady_speed: (self.speed)(0.0),
            alpha: (self.alpha)(time),
            beta: (self.beta)(time),
            p: (self.p)(time),
            q: (self.q)(time),
            r: (self.r)(time),
            height: (self.height)(time),
            ..Motion::default()
        }
    }
}

/// What the aircraft flies in, at one moment.
pub(crate) struct Around<'s> {
    pub scene: &'s Scene,
    pub air: Air,
}

/// A place that trimming may change.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Trim {
    State(usize),
    Surface(usize),
}

/// Equations of motion, written out for the judge alone.
pub(crate) trait Airframe: Sync + Send {
    /// Where it flies steadily, or nearly so.
    fn start(&self) -> Vec<f64>;
    /// Fills in dx/dt and all of the motion but for commands and surfaces, which are there already.
    fn rates(
        &self,
        x: &[f64],
        around: &Around<'_>,
        added: &Added,
        motion: &mut Motion,
        dx: &mut [f64],
    );
    /// What is changed, and which rate it brings to zero, before the flight begins.
    fn trim(&self) -> Vec<(Trim, usize)> {
        Vec::new()
    }
}
