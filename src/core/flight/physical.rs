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
    AngleOfAttack,
    AngleOfSideslip,
    Airspeed,
    Mach,
    DynamicPressure,
    AirDensity,
    VelocityX,
    VelocityY,
    VelocityZ,
    RollRate,
    PitchRate,
    YawRate,
    RollAcceleration,
    PitchAcceleration,
    YawAcceleration,
    /// A specific force, or a load factor.
    AccelerationX,
    AccelerationY,
    AccelerationZ,
    RollAngle,
    PitchAngle,
    HeadingAngle,
    PositionX,
    PositionY,
    PositionZ,
    Altitude,
    WindX,
    WindY,
    WindZ,
    Elevator,
    Aileron,
    Rudder,
    Canard,
    Flap,
    Thrust,
    /// Any other control.
    Control,
    LiftCoefficient,
    DragCoefficient,
    SideForceCoefficient,
    ForceCoefficientX,
    ForceCoefficientZ,
    RollingMomentCoefficient,
    PitchingMomentCoefficient,
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
    AirData,
    Velocity,
    Gyro,
    AngularAcceleration,
    Accelerometer,
    Attitude,
    Position,
    Wind,
    Control,
    Coefficient,
    Structural,
    Other,
}

/// Which of the two motions of a symmetric aircraft a quantity belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Motion {
    Longitudinal,
    Lateral,
}

impl PhysicalQuantity {
    /// As it is written in a document.
    pub fn name(self) -> String {
        let word = serde_json::to_value(self).ok();
        word.and_then(|word| word.as_str().map(ToString::to_string))
            .unwrap_or_default()
    }

    pub fn family(self) -> Family {
        use PhysicalQuantity::*;
        match self {
            AngleOfAttack | AngleOfSideslip | Airspeed | Mach | DynamicPressure | AirDensity
            | Altitude => Family::AirData,
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

    pub fn is_flow_angle(self) -> bool {
        matches!(self, Self::AngleOfAttack | Self::AngleOfSideslip)
    }

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

    /// `None` of what may belong to either.
    pub fn motion(self) -> Option<Motion> {
        use PhysicalQuantity::*;
        match self {
            AngleOfSideslip
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
