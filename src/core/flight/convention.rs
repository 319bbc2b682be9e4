//! What a channel is, by the names that the field gives.

use super::{Dimension, PhysicalQuantity};

/// What a name says, if what it names is measured in a dimension that fits.
pub fn by_name(name: &str, dimension: Dimension) -> Option<PhysicalQuantity> {
    let found = by_letter(name, dimension)
        .or_else(|| by_word(&plain(name)))
        .or_else(|| by_word(&plain(before_suffix(name)?)))
        .or_else(|| deflection(name).filter(|_| dimension.is_none()))?;
    found.measures(dimension).then_some(found)
}

/// Whether a name says that a control surface or an engine is meant, in whatever unit.
pub(super) fn is_control(name: &str) -> bool {
    by_name(name, Dimension::NONE).is_some_and(PhysicalQuantity::is_control)
}

/// Lower case, without underscores and the number at the end.
fn plain(name: &str) -> String {
    let joined = name.replace('_', "").to_lowercase();
    joined
        .trim_end_matches(|c: char| c.is_ascii_digit())
        .to_string()
}

/// The word before the first underscore, unless what follows makes it something else.
fn before_suffix(name: &str) -> Option<&str> {
    const OTHERWISE: [&str; 16] = [
        "dot", "ddot", "rate", "bias", "eq", "ref", "trim", "error", "hat", "0", "cmd", "command",
        "target", "sp", "des", "desired",
    ];
    let (word, suffix) = name.split_once('_')?;
    (word.len() > 1 && !OTHERWISE.contains(&suffix)).then_some(word)
}

/// Single letters mean different things in upper and lower case, and in different units.
fn by_letter(name: &str, dimension: Dimension) -> Option<PhysicalQuantity> {
    use PhysicalQuantity::*;
    let letter = match name.split_once('_') {
        None => name,
        Some(("V" | "v", "tas" | "TAS")) => "V",
        // `V_true`, `q_true`, `p_m`: the letter is what is measured
        Some((letter, "true" | "m" | "meas" | "measured" | "tas" | "TAS" | "t" | "raw")) => letter,
        Some(_) => return None,
    };
    let candidates: &[PhysicalQuantity] = match letter {
        "V" => &[Airspeed],
        "u" | "U" => &[VelocityX],
        "v" => &[VelocityY],
        "w" | "W" => &[VelocityZ],
        "p" | "P" => &[RollRate],
        "q" | "Q" => &[PitchRate, DynamicPressure],
        "r" | "R" => &[YawRate],
        "M" => &[Mach],
        "h" | "H" => &[Altitude],
        "x" => &[PositionX],
        "y" => &[PositionY],
        "z" => &[PositionZ],
        _ => return None,
    };
    let mut candidates = candidates.iter().copied();
    candidates.find(|quantity| quantity.measures(dimension))
}

fn by_word(word: &str) -> Option<PhysicalQuantity> {
    use PhysicalQuantity::*;
    Some(match word {
        "alpha" | "alfa" | "alf" | "aoa" | "incidence" | "angleofattack" | "alpham" | "alphav"
        | "alphavane" | "alphatrue" => AngleOfAttack,
        "beta" | "aos" | "ssa" | "sideslip" | "angleofsideslip" | "sideslipangle" | "betam"
        | "betav" | "betavane" | "betatrue" => AngleOfSideslip,
        "alphadot" | "alfadot" | "aoadot" => AngleOfAttackRate,
        "betadot" | "aosdot" => AngleOfSideslipRate,
        "vtas" | "tas" | "va" | "vt" | "vtrue" | "airspeed" | "trueairspeed" | "vair" => Airspeed,
        "mach" | "ma" | "machnumber" => Mach,
        "qbar" | "qdyn" | "qinf" | "qc" | "dynamicpressure" | "pdyn" => DynamicPressure,
        "rho" | "density" | "airdensity" => AirDensity,
        "ub" | "ubody" => VelocityX,
        "vb" | "vbody" => VelocityY,
        "wb" | "wbody" => VelocityZ,
        "rollrate" | "wx" | "omegax" | "gyrox" | "pgyro" => RollRate,
        "pitchrate" | "wy" | "omegay" | "gyroy" | "qgyro" => PitchRate,
        "yawrate" | "wz" | "omegaz" | "gyroz" | "rgyro" => YawRate,
        "pdot" | "rollacceleration" => RollAcceleration,
        "qdot" | "pitchacceleration" => PitchAcceleration,
        "rdot" | "yawacceleration" => YawAcceleration,
        "ax" | "nx" | "axm" | "axcg" | "accx" | "accelx" | "axb" | "fx" => AccelerationX,
        "ay" | "ny" | "aym" | "aycg" | "accy" | "accely" | "ayb" | "fy" => AccelerationY,
        "az" | "nz" | "azm" | "azcg" | "accz" | "accelz" | "azb" | "fz" => AccelerationZ,
        "phi" | "roll" | "bank" | "rollangle" | "bankangle" => RollAngle,
        "theta" | "the" | "pitch" | "pitchangle" => PitchAngle,
        "psi" | "yaw" | "heading" | "headingangle" | "yawangle" => HeadingAngle,
        "xe" | "xn" | "north" | "positionx" | "posx" => PositionX,
        "ye" | "east" | "positiony" | "posy" => PositionY,
        "ze" | "down" | "positionz" | "posz" => PositionZ,
        "altitude" | "height" | "alt" | "hbaro" | "pressurealtitude" => Altitude,
        "elevator" | "elev" | "eta" | "deltae" | "dele" | "stab" | "stabilator" | "lonstick" => {
            Elevator
        }
        "aileron" | "ail" | "xi" | "deltaa" | "dela" | "latstick" => Aileron,
        "rudder" | "rud" | "zeta" | "deltar" | "delr" | "pedal" => Rudder,
        "canard" | "can" | "deltac" => Canard,
        "flap" | "flaps" | "deltaf" => Flap,
        "thrust" | "throttle" | "deltat" | "pla" | "rpm" => Thrust,
        "spoiler" | "slat" | "speedbrake" | "airbrake" | "trimtab" => Control,
        _ => return None,
    })
}

/// `de`, `da_right`, `dsp`, `delta_x`: a d before one or two letters, of something without a dimension.
fn deflection(name: &str) -> Option<PhysicalQuantity> {
    use PhysicalQuantity::*;
    let word = name.split('_').next().unwrap_or_default();
    let word = word.trim_end_matches(|c: char| c.is_ascii_digit());
    if word == "delta" || word.starts_with("delta") {
        return Some(Control);
    }
    let which = word.strip_prefix('d')?;
    let letters = which.chars().all(|c| c.is_ascii_lowercase());
    Some(match which {
        "e" | "el" | "er" => Elevator,
        "a" | "al" | "ar" => Aileron,
        "r" => Rudder,
        "c" => Canard,
        "f" | "fl" => Flap,
        _ if letters && (1..=2).contains(&which.len()) => Control,
        _ => return None,
    })
}

/// An aerodynamic coefficient: `CL`, `CD_wing`, `Cm`, `C_l`; upper and lower case differ.
pub fn coefficient(name: &str, dimension: Dimension) -> Option<PhysicalQuantity> {
    use PhysicalQuantity::*;
    let rest = name.strip_prefix('C')?;
    let rest = rest.strip_prefix('_').unwrap_or(rest);
    let mut letters = rest.chars();
    let axis = letters.next()?;
    if !matches!(letters.next(), None | Some('_')) || !dimension.is_none() {
        return None;
    }
    Some(match axis {
        'L' => LiftCoefficient,
        'D' => DragCoefficient,
        'Y' | 'y' => SideForceCoefficient,
        'X' | 'x' => ForceCoefficientX,
        'Z' | 'z' => ForceCoefficientZ,
        'l' => RollingMomentCoefficient,
        'm' | 'M' => PitchingMomentCoefficient,
        'n' => YawingMomentCoefficient,
        _ => Coefficient,
    })
}

/// Which way a wind blows, of a name such as `W_x`, `Wx`, `wind_x`.
pub fn wind(name: &str, dimension: Dimension) -> Option<PhysicalQuantity> {
    use PhysicalQuantity::{WindX, WindY, WindZ};
    let axis = match name.to_lowercase().replace('_', "").as_str() {
        "wx" | "windx" | "windn" | "windnorth" => WindX,
        "wy" | "windy" | "winde" | "windeast" => WindY,
        "wz" | "windz" | "windd" | "winddown" => WindZ,
        _ => return None,
    };
    axis.measures(dimension).then_some(axis)
}

/// The speed of the steady flight, of a parameter or constant such as `V_e`, `Vbar`, `U0`.
pub fn steady_speed(name: &str, dimension: Dimension) -> bool {
    const NAMES: [&str; 19] = [
        "V_e", "V_ref", "Vbar", "V_bar", "V_0", "V0", "V_trim", "Ve", "U_0", "U0", "V", "V_true",
        "Vt", "V_t", "TAS", "V_TAS", "tas", "airspeed", "Va",
    ];
    PhysicalQuantity::Airspeed.measures(dimension) && NAMES.contains(&name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::Unit;

    fn of(name: &str, unit: &str) -> Option<PhysicalQuantity> {
        by_name(name, Unit::parse(unit).unwrap().dimension)
    }

    #[test]
    fn usual_names_say_what_they_are() {
        use PhysicalQuantity::*;
        for (name, unit, quantity) in [
            ("AoA", "deg", AngleOfAttack),
            ("alpha_vane", "rad", AngleOfAttack),
            ("ssa", "deg", AngleOfSideslip),
            ("TAS", "kt", Airspeed),
            ("V", "m/s", Airspeed),
            ("v", "m/s", VelocityY),
            ("P", "deg/s", RollRate),
            ("pitchRate", "rad/s", PitchRate),
            ("gyro_z", "deg/s", YawRate),
            ("q", "Pa", DynamicPressure),
            ("q", "deg/s", PitchRate),
            ("az_cg", "m/s^2", AccelerationZ),
            ("nz", "-", AccelerationZ),
            ("stab", "deg", Elevator),
            ("da_right", "deg", Aileron),
            ("delta_e", "rad", Elevator),
            ("dsp", "rad", Control),
            ("qdot", "rad/s^2", PitchAcceleration),
            ("alpha_dot", "rad/s", AngleOfAttackRate),
        ] {
            assert_eq!(of(name, unit), Some(quantity), "{name} in {unit}");
        }
    }

    #[test]
    fn what_is_measured_otherwise_is_something_else() {
        for (name, unit) in [
            ("alpha_dot", "rad"),
            ("p", "Pa"),
            ("x", "rad"),
            ("de", "m"),
            ("drag", "N"),
            ("F", "N"),
            ("m", "kg"),
        ] {
            assert_eq!(of(name, unit), None, "{name} in {unit}");
        }
    }
}
