//! What a quantity is, in the words of flight mechanics.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::Dimension;

/// What a quantity of a model, or a recorded channel, is. Axes are those of the body (x forward, y right, z down) for
/// velocities, rates and accelerations, and of the Earth for positions and winds.
#[derive(
    Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug, Serialize, Deserialize, ToSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum PhysicalQuantity {
    /// α, positive with the flow from below.
    AngleOfAttack,
    /// β, positive with the flow from the right.
    AngleOfSideslip,
    /// dα/dt
    AngleOfAttackRate,
    /// dβ/dt
    AngleOfSideslipRate,
    /// True airspeed.
    Airspeed,
    /// Mach number.
    Mach,
    /// q̄
    DynamicPressure,
    /// ρ
    AirDensity,
    /// Through the air, forward.
    VelocityX,
    /// Through the air, to the right.
    VelocityY,
    /// Through the air, down.
    VelocityZ,
    /// p
    RollRate,
    /// q
    PitchRate,
    /// r
    YawRate,
    /// dp/dt
    RollAcceleration,
    /// dq/dt
    PitchAcceleration,
    /// dr/dt
    YawAcceleration,
    /// A specific force, or a load factor.
    AccelerationX,
    /// As that along x.
    AccelerationY,
    /// As that along x.
    AccelerationZ,
    /// φ
    RollAngle,
    /// θ
    PitchAngle,
    /// ψ
    HeadingAngle,
    /// North.
    PositionX,
    /// East.
    PositionY,
    /// Down.
    PositionZ,
    /// Up.
    Altitude,
    /// Velocity of the air over ground, towards north.
    WindX,
    /// Towards east.
    WindY,
    /// Downwards.
    WindZ,
    /// A deflection, or the command of one.
    Elevator,
    /// A deflection, or the command of one.
    Aileron,
    /// A deflection, or the command of one.
    Rudder,
    /// A deflection, or the command of one.
    Canard,
    /// A deflection, or the command of one.
    Flap,
    /// A force, or a lever.
    Thrust,
    /// Any other control.
    Control,
    /// C_L
    LiftCoefficient,
    /// C_D
    DragCoefficient,
    /// C_Y
    SideForceCoefficient,
    /// C_X, forward.
    ForceCoefficientX,
    /// C_Z, down.
    ForceCoefficientZ,
    /// C_l
    RollingMomentCoefficient,
    /// C_m
    PitchingMomentCoefficient,
    /// C_n
    YawingMomentCoefficient,
    /// Any other aerodynamic coefficient.
    Coefficient,
    /// A state of an elastic mode of the structure.
    Structural,
    /// None of these.
    Other,
}

/// The instruments that record a quantity, or the part of the model that it belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub enum Family {
    /// Flow angles, speed, pressures, altitude.
    AirData,
    /// Velocities in body axes.
    Velocity,
    /// Rates.
    Gyro,
    /// Their derivatives.
    AngularAcceleration,
    /// Specific forces.
    Accelerometer,
    /// Attitude angles.
    Attitude,
    /// Positions over ground.
    Position,
    /// Winds.
    Wind,
    /// Controls.
    Control,
    /// Aerodynamic coefficients.
    Coefficient,
    /// Elastic states.
    Structural,
    /// All else.
    Other,
}

/// Which of the two motions of a symmetric aircraft a quantity belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Motion {
    /// In the plane of symmetry.
    Longitudinal,
    /// Out of it.
    Lateral,
}

impl PhysicalQuantity {
    /// As it is written in a document.
    pub fn name(self) -> String {
        let word = serde_json::to_value(self).ok();
        word.and_then(|word| word.as_str().map(ToString::to_string))
            .unwrap_or_default()
    }

    /// Who records it.
    pub fn family(self) -> Family {
        use PhysicalQuantity::*;
        match self {
            AngleOfAttack | AngleOfSideslip | AngleOfAttackRate | AngleOfSideslipRate
            | Airspeed | Mach | DynamicPressure | AirDensity | Altitude => Family::AirData,
            VelocityX | VelocityY | VelocityZ => Family::Velocity,
            RollRate | PitchRate | YawRate => Family::Gyro,
            RollAcceleration | PitchAcceleration | YawAcceleration => Family::AngularAcceleration,
            AccelerationX | AccelerationY | AccelerationZ => Family::Accelerometer,
            RollAngle | PitchAngle | HeadingAngle => Family::Attitude,
            PositionX | PositionY | PositionZ => Family::Position,
            WindX | WindY | WindZ => Family::Wind,
            Elevator | Aileron | Rudder | Canard | Flap | Thrust | Control => Family::Control,
            LiftCoefficient
            | DragCoefficient
            | SideForceCoefficient
            | ForceCoefficientX
            | ForceCoefficientZ
            | RollingMomentCoefficient
            | PitchingMomentCoefficient
            | YawingMomentCoefficient
            | Coefficient => Family::Coefficient,
            Structural => Family::Structural,
            Other => Family::Other,
        }
    }

    /// Angle of attack or of sideslip.
    pub fn is_flow_angle(self) -> bool {
        matches!(self, Self::AngleOfAttack | Self::AngleOfSideslip)
    }

    /// What the pilot or an engine moves.
    pub fn is_control(self) -> bool {
        self.family() == Family::Control
    }

    /// What a sensor records of the aircraft's motion.
    pub fn is_motion(self) -> bool {
        use Family::{
            Accelerometer, AirData, AngularAcceleration, Attitude, Gyro, Position, Velocity,
        };
        matches!(
            self.family(),
            AirData | Velocity | Gyro | AngularAcceleration | Accelerometer | Attitude | Position
        )
    }

    /// The motion that it belongs to; `None` of what may belong to either.
    pub fn motion(self) -> Option<Motion> {
        use PhysicalQuantity::*;
        match self {
            AngleOfSideslip
            | AngleOfSideslipRate
            | VelocityY
            | RollRate
            | YawRate
            | RollAcceleration
            | YawAcceleration
            | AccelerationY
            | RollAngle
            | HeadingAngle
            | Aileron
            | Rudder
            | SideForceCoefficient
            | RollingMomentCoefficient
            | YawingMomentCoefficient => Some(Motion::Lateral),
            AngleOfAttack
            | AngleOfAttackRate
            | Airspeed
            | Mach
            | DynamicPressure
            | AirDensity
            | VelocityX
            | VelocityZ
            | PitchRate
            | PitchAcceleration
            | AccelerationX
            | AccelerationZ
            | PitchAngle
            | Altitude
            | Elevator
            | Canard
            | Flap
            | Thrust
            | LiftCoefficient
            | DragCoefficient
            | ForceCoefficientX
            | ForceCoefficientZ
            | PitchingMomentCoefficient => Some(Motion::Longitudinal),
            PositionX | PositionY | PositionZ | WindX | WindY | WindZ | Control | Coefficient
            | Structural | Other => None,
        }
    }

    /// Whether it can be measured in a dimension.
    pub fn measures(self, dimension: Dimension) -> bool {
        let speed = Dimension::METRE.over(Dimension::SECOND);
        let per_second = Dimension::NONE.over(Dimension::SECOND);
        match self.family() {
            Family::AirData => match self {
                Self::Airspeed => dimension == speed,
                Self::AngleOfAttackRate | Self::AngleOfSideslipRate => dimension == per_second,
                Self::DynamicPressure => {
                    let area = Dimension::METRE.times(Dimension::METRE);
                    let newton = Dimension::KILOGRAM.times(speed).over(Dimension::SECOND);
                    dimension == newton.over(area)
                }
                Self::AirDensity => {
                    let volume = Dimension::METRE.to_power(3.0);
                    volume.is_some_and(|volume| dimension == Dimension::KILOGRAM.over(volume))
                }
                Self::Altitude => dimension == Dimension::METRE,
                _ => dimension.is_none(),
            },
            Family::Velocity | Family::Wind => dimension == speed,
            Family::Gyro => dimension == per_second,
            Family::AngularAcceleration => dimension == per_second.over(Dimension::SECOND),
            Family::Accelerometer => {
                dimension.is_none() || dimension == speed.over(Dimension::SECOND)
            }
            Family::Attitude | Family::Coefficient => dimension.is_none(),
            Family::Position => dimension == Dimension::METRE,
            Family::Control if self != Self::Thrust && self != Self::Control => dimension.is_none(),
            Family::Control | Family::Structural | Family::Other => true,
        }
    }
}
