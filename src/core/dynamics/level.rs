//! Levels of flying qualities by the modes, after MIL-F-8785C, which MIL-STD-1797A took most of these numbers from.
//!
//! The numbers were checked against what others quote of the text of MIL-F-8785C (its tables IV, VI, VII and VIII, the
//! lines of figures 1 to 3, and 3.2.1.2): the text of MIL-STD-1797A itself was not to be had. The floors of ω and of n/α that
//! figures 1 and 3 draw besides are not applied.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::estimate::{Measure, Mode, ModeName};

/// What is flown (MIL-F-8785C, 1.4).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub enum FlightPhaseCategory {
    /// Rapid maneuvers, precision tracking, precise control of the flight path.
    A,
    /// Gradual maneuvers without precision tracking: climb, cruise, loiter, descent.
    B,
    /// Takeoff, approach, landing.
    C,
}

/// What kind of airplane it is (MIL-F-8785C, 1.3).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize, ToSchema)]
pub enum AirplaneClass {
    /// Small and light.
    I,
    /// Of medium weight, low to medium maneuverability, flown from land.
    II,
    /// As `II`, flown from carriers.
    #[serde(rename = "II-C")]
    IIC,
    /// Large and heavy, low to medium maneuverability.
    III,
    /// High maneuverability.
    IV,
}

/// One requirement and the level that is reached.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
pub struct Criterion {
    /// What is judged.
    #[schema(example = "Dutch roll: damping and frequency")]
    pub what: String,
    /// Where the requirement stands.
    #[schema(example = "MIL-F-8785C, 3.3.1.1, table VI")]
    pub source: String,
    /// The segment whose mode is judged; absent where modes are the same everywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segment: Option<String>,
    /// What level 1 asks for.
    #[schema(
        example = "damping ratio ≥ 0.19, damping ratio × frequency ≥ 0.35 rad/s, frequency ≥ 1 rad/s"
    )]
    pub level_1: String,
    /// 1, 2 or 3; `null`: none of them.
    pub level: Option<u8>,
    /// The best and the worst level within 2 standard errors, where these are known; `null`: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub levels_within_2_standard_errors: Option<[Option<u8>; 2]>,
}

/// A measure between two limits.
struct Limited {
    measure: Measure,
    /// By level from 1: the least and the greatest.
    limits: [(f64, f64); 3],
}

const ANY: f64 = f64::INFINITY;

impl Limited {
    /// The best level that a value reaches.
    fn level_of(&self, value: f64) -> Option<u8> {
        let within = |&(low, high): &(f64, f64)| (low..=high).contains(&value);
        let place = self.limits.iter().position(within)?;
        u8::try_from(place + 1).ok()
    }
}

/// What all of them reach: the worst.
fn level(all: &[Limited], of: impl Fn(&Limited) -> Option<u8>) -> Option<u8> {
    all.iter()
        .map(of)
        .try_fold(1, |worst, level| Some(worst.max(level?)))
}

/// The best and the worst level within 2 standard errors.
fn within_bounds(all: &[Limited]) -> Option<[Option<u8>; 2]> {
    // "none" is worse than 3
    let rank = |level: Option<u8>| level.unwrap_or(4);
    let known = |level: u8| (level < 4).then_some(level);
    let (mut best, mut worst) = (1, 1);
    for limited in all {
        const STEPS: i32 = 20;
        let error = limited.measure.standard_error?;
        let at = |k: i32| limited.measure.value + 2.0 * error * f64::from(k) / f64::from(STEPS);
        let ranks = (-STEPS..=STEPS).map(|k| rank(limited.level_of(at(k))));
        let (low, high) = ranks.fold((4, 1), |(low, high), r| (low.min(r), high.max(r)));
        (best, worst) = (best.max(low), worst.max(high));
    }
    Some([known(best), known(worst)])
}

/// The levels of all modes that have a requirement.
pub(super) fn of_modes(
    modes: &[Mode],
    category: FlightPhaseCategory,
    class: AirplaneClass,
) -> Vec<Criterion> {
    let of = |mode: &Mode| match mode.name? {
        ModeName::ShortPeriod => short_period(mode, category),
        ModeName::Phugoid => phugoid(mode),
        ModeName::DutchRoll => dutch_roll(mode, category, class),
        ModeName::Roll => roll(mode, category, class),
        ModeName::Spiral => spiral(mode, category),
        ModeName::RollSpiral => roll_spiral(mode, category),
        ModeName::Structural => None,
    };
    modes.iter().filter_map(of).collect()
}

fn criterion(
    segment: Option<&String>,
    (what, source): (&str, &str),
    level_1: String,
    all: &[Limited],
) -> Criterion {
    Criterion {
        what: what.to_string(),
        source: format!("MIL-F-8785C, {source}"),
        segment: segment.cloned(),
        level_1,
        level: level(all, |limited| limited.level_of(limited.measure.value)),
        levels_within_2_standard_errors: within_bounds(all),
    }
}

fn short_period(mode: &Mode, category: FlightPhaseCategory) -> Option<Criterion> {
    let limits = match category {
        FlightPhaseCategory::B => [(0.30, 2.0), (0.20, 2.0), (0.15, ANY)],
        FlightPhaseCategory::A | FlightPhaseCategory::C => [(0.35, 1.3), (0.25, 2.0), (0.15, ANY)],
    };
    let (low, high) = limits[0];
    let all = [Limited {
        measure: mode.damping_ratio?,
        limits,
    }];
    let title = ("short period: damping", "3.2.2.1.2, table IV");
    let asked = format!("damping ratio from {low} to {high}");
    Some(criterion(mode.segment.as_ref(), title, asked, &all))
}

/// ω²/(n/α), rad/s² per g.
pub(super) fn control_anticipation(measure: Measure, category: FlightPhaseCategory) -> Criterion {
    let limits = match category {
        FlightPhaseCategory::A => [(0.28, 3.6), (0.16, 10.0), (0.16, ANY)],
        FlightPhaseCategory::B => [(0.085, 3.6), (0.038, 10.0), (0.038, ANY)],
        FlightPhaseCategory::C => [(0.16, 3.6), (0.036, 10.0), (0.036, ANY)],
    };
    let (low, high) = limits[0];
    let title = (
        "short period: control anticipation parameter",
        "3.2.2.1.1, figures 1 to 3 (without their floors of ω and n/α)",
    );
    let asked = format!("from {low} to {high} rad/s² per g");
    criterion(None, title, asked, &[Limited { measure, limits }])
}

fn phugoid(mode: &Mode) -> Option<Criterion> {
    // level 3 is a time to double, 55 s: as a real part
    let growth = Measure {
        value: mode.real.value,
        ..mode.real
    };
    let level_3 = std::f64::consts::LN_2 / 55.0;
    let all = [
        Limited {
            measure: mode.damping_ratio?,
            limits: [(0.04, ANY), (0.0, ANY), (-ANY, ANY)],
        },
        Limited {
            measure: growth,
            limits: [(-ANY, level_3), (-ANY, level_3), (-ANY, level_3)],
        },
    ];
    let title = ("phugoid: damping", "3.2.1.2");
    Some(criterion(
        mode.segment.as_ref(),
        title,
        "damping ratio ≥ 0.04".to_string(),
        &all,
    ))
}

fn dutch_roll(
    mode: &Mode,
    category: FlightPhaseCategory,
    class: AirplaneClass,
) -> Option<Criterion> {
    use AirplaneClass::{I, IIC, IV};
    use FlightPhaseCategory::{A, B, C};
    let is_agile = matches!(class, I | IV);
    let (damping, product, frequency) = match category {
        A => (0.19, 0.35, if is_agile { 1.0 } else { 0.4 }),
        B => (0.08, 0.15, 0.4),
        C if is_agile || class == IIC => (0.08, 0.15, 1.0),
        C => (0.08, 0.10, 0.4),
    };
    let decay = Measure {
        value: -mode.real.value,
        ..mode.real
    };
    let limited = |measure, least: [f64; 3]| Limited {
        measure,
        limits: least.map(|least| (least, ANY)),
    };
    let all = [
        limited(mode.damping_ratio?, [damping, 0.02, 0.0]),
        limited(decay, [product, 0.05, 0.0]),
        limited(mode.natural_frequency?, [frequency, 0.4, 0.4]),
    ];
    let title = ("Dutch roll: damping and frequency", "3.3.1.1, table VI");
    let asked = format!(
        "damping ratio ≥ {damping}, damping ratio × frequency ≥ {product} rad/s, frequency ≥ {frequency} rad/s"
    );
    Some(criterion(mode.segment.as_ref(), title, asked, &all))
}

fn roll(mode: &Mode, category: FlightPhaseCategory, class: AirplaneClass) -> Option<Criterion> {
    use AirplaneClass::{I, IIC, IV};
    use FlightPhaseCategory::{A, C};
    let is_strict = match category {
        A => matches!(class, I | IV),
        C => matches!(class, I | IIC | IV),
        FlightPhaseCategory::B => false,
    };
    let most = if is_strict {
        [1.0, 1.4, 10.0]
    } else {
        [1.4, 3.0, 10.0]
    };
    // by the real part, so that a roll mode that grows reaches no level
    let decay = Measure {
        value: -mode.real.value,
        ..mode.real
    };
    let all = [Limited {
        measure: decay,
        limits: most.map(|time: f64| (time.recip(), ANY)),
    }];
    let title = ("roll mode: time constant", "3.3.1.2, table VII");
    let asked = format!("time constant ≤ {} s", most[0]);
    Some(criterion(mode.segment.as_ref(), title, asked, &all))
}

fn spiral(mode: &Mode, category: FlightPhaseCategory) -> Option<Criterion> {
    let least: [f64; 3] = match category {
        FlightPhaseCategory::B => [20.0, 8.0, 4.0],
        FlightPhaseCategory::A | FlightPhaseCategory::C => [12.0, 8.0, 4.0],
    };
    let all = [Limited {
        measure: mode.real,
        limits: least.map(|time| (-ANY, std::f64::consts::LN_2 / time)),
    }];
    let title = ("spiral: time to double", "3.3.1.3, table VIII");
    let asked = format!("time to double ≥ {} s, or it dies away", least[0]);
    Some(criterion(mode.segment.as_ref(), title, asked, &all))
}

fn roll_spiral(mode: &Mode, category: FlightPhaseCategory) -> Option<Criterion> {
    let decay = Measure {
        value: -mode.real.value,
        ..mode.real
    };
    let (least, asked) = match category {
        FlightPhaseCategory::A => ([ANY; 3], "none may be there".to_string()),
        FlightPhaseCategory::B | FlightPhaseCategory::C => (
            [0.5, 0.3, 0.15],
            "damping ratio × frequency ≥ 0.5 rad/s".to_string(),
        ),
    };
    let all = [Limited {
        measure: decay,
        limits: least.map(|least| (least, ANY)),
    }];
    let title = ("roll-spiral oscillation: damping", "3.3.1.4");
    Some(criterion(mode.segment.as_ref(), title, asked, &all))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(name: ModeName, real: f64, imaginary: f64, error: f64) -> Mode {
        let measure = |value: f64| Measure {
            value,
            standard_error: Some(error),
        };
        let frequency = real.hypot(imaginary);
        Mode {
            segment: None,
            name: Some(name),
            states: Vec::new(),
            real: measure(real),
            imaginary: measure(imaginary),
            natural_frequency: Some(measure(frequency)),
            damping_ratio: Some(measure(-real / frequency)),
            period: None,
            time_constant: None,
            time_to_half: None,
            time_to_double: None,
            remark: String::new(),
        }
    }

    fn levels(mode: Mode, category: FlightPhaseCategory, class: AirplaneClass) -> Option<u8> {
        of_modes(&[mode], category, class)[0].level
    }

    #[test]
    fn levels_are_those_of_the_tables() {
        use AirplaneClass::*;
        use FlightPhaseCategory::*;
        // the Navion's Dutch roll (Nelson, example 5.4): damping ratio 0.204, frequency 2.39 rad/s
        let navion = || mode(ModeName::DutchRoll, -0.487, 2.335, 0.0);
        assert_eq!(levels(navion(), A, I), Some(1));
        // a transport's: 0.05 and 0.9 rad/s
        let transport = || mode(ModeName::DutchRoll, -0.045, 0.9, 0.0);
        assert_eq!(levels(transport(), B, III), Some(3));
        let roll = |real| mode(ModeName::Roll, real, 0.0, 0.0);
        assert_eq!(levels(roll(-1.0 / 1.2), A, IV), Some(2));
        assert_eq!(levels(roll(-1.0 / 1.2), A, III), Some(1));
        assert_eq!(levels(roll(0.1), B, III), None);
        let spiral = |time: f64| mode(ModeName::Spiral, 2.0_f64.ln() / time, 0.0, 0.0);
        assert_eq!(levels(spiral(15.0), A, I), Some(1));
        assert_eq!(levels(spiral(15.0), B, I), Some(2));
        assert_eq!(levels(spiral(-15.0), B, I), Some(1));
        assert_eq!(levels(spiral(5.0), B, I), Some(3));
        assert_eq!(levels(spiral(2.0), B, I), None);
        let phugoid = |damping: f64| mode(ModeName::Phugoid, -damping, 1.0, 0.0);
        assert_eq!(levels(phugoid(0.05), C, II), Some(1));
        assert_eq!(levels(phugoid(0.02), C, II), Some(2));
        assert_eq!(levels(phugoid(-0.005), C, II), Some(3));
        assert_eq!(levels(phugoid(-0.1), C, II), None);
        assert_eq!(
            levels(mode(ModeName::RollSpiral, -0.6, 0.2, 0.0), A, II),
            None
        );
        assert_eq!(
            levels(mode(ModeName::RollSpiral, -0.6, 0.2, 0.0), B, II),
            Some(1)
        );
    }

    /// Damping 0.36 ± 0.02: level 1 or 2.
    #[test]
    fn errors_may_span_levels() {
        let mode = mode(ModeName::ShortPeriod, -0.36, 0.933, 0.02);
        let criterion = &of_modes(&[mode], FlightPhaseCategory::A, AirplaneClass::IV)[0];
        assert_eq!(criterion.level, Some(1));
        let within = criterion.levels_within_2_standard_errors;
        assert_eq!(within, Some([Some(1), Some(2)]));
    }
}
