//! The names of modes, by what their states are and how much each takes part.
//!
//! The participation factor of a state in a mode is |l_k r_k|, with the left and the right eigenvector (Pérez-Arriaga,
//! Verghese and Schweppe, IEEE Trans. PAS-101, 1982): it does not depend on units, as lengths in an eigenvector do. What a
//! state is says its `quantity`, not its name.

use crate::estimate::report::mode::ModeName;
use crate::flight::{Motion, PhysicalQuantity};

/// A mode belongs to one of the two motions when so much of all participation does.
const BELONGS: f64 = 0.8;

/// How much the states of a mode take part in it, by what they are.
struct Participation<'a> {
    quantities: &'a [Option<PhysicalQuantity>],
    /// By state; they sum to one.
    shares: Vec<f64>,
}

impl Participation<'_> {
    fn of(&self, is: impl Fn(PhysicalQuantity) -> bool) -> f64 {
        let states = self.quantities.iter().zip(&self.shares);
        let of = states.filter(|(quantity, _)| quantity.is_some_and(&is));
        of.map(|(_, share)| share).sum()
    }

    fn any_of(&self, quantities: &[PhysicalQuantity]) -> f64 {
        self.of(|quantity| quantities.contains(&quantity))
    }

    fn has(&self, quantities: &[PhysicalQuantity]) -> bool {
        let mut all = self.quantities.iter().flatten();
        all.any(|quantity| quantities.contains(quantity))
    }
}

/// What a mode is called whose states take part with these shares; none where they leave it open.
pub(super) fn mode_name(
    quantities: &[Option<PhysicalQuantity>],
    shares: &[f64],
    oscillates: bool,
) -> Option<ModeName> {
    let sum: f64 = shares.iter().sum();
    let part = Participation {
        quantities,
        shares: shares.iter().map(|share| share / sum).collect(),
    };
    let of_motion = |motion| part.of(|quantity| quantity.motion() == Some(motion));
    if part.of(|quantity| quantity == PhysicalQuantity::Structural) >= BELONGS {
        return Some(ModeName::Structural);
    }
    if of_motion(Motion::Longitudinal) >= BELONGS {
        return longitudinal(&part, oscillates);
    }
    if of_motion(Motion::Lateral) >= BELONGS {
        return lateral(&part, oscillates);
    }
    None
}

/// The short period turns the aircraft about the flow, the phugoid exchanges speed and height. Two real modes in place of
/// one of them have no name that all agree on.
fn longitudinal(part: &Participation<'_>, oscillates: bool) -> Option<ModeName> {
    use PhysicalQuantity::{Airspeed, VelocityX};
    use PhysicalQuantity::{AngleOfAttack, PitchAngle, PitchRate, VelocityZ};
    let turning = part.any_of(&[AngleOfAttack, VelocityZ, PitchRate]);
    let along = part.any_of(&[Airspeed, VelocityX, PitchAngle]);
    match oscillates {
        true if turning > along => Some(ModeName::ShortPeriod),
        true => Some(ModeName::Phugoid),
        false => None,
    }
}

/// The Dutch roll needs sideslip that feeds back, the spiral bank.
fn lateral(part: &Participation<'_>, oscillates: bool) -> Option<ModeName> {
    use PhysicalQuantity::{
        AngleOfSideslip, HeadingAngle, RollAngle, RollRate, VelocityY, YawRate,
    };
    let slipping = [AngleOfSideslip, VelocityY];
    let weathercock = part.any_of(&slipping) + part.any_of(&[YawRate]);
    let rolling = part.any_of(&[RollRate]);
    let banking = part.any_of(&[RollAngle, HeadingAngle]);
    match oscillates {
        true if !part.has(&slipping) => None,
        true if weathercock > rolling + banking => Some(ModeName::DutchRoll),
        true => Some(ModeName::RollSpiral),
        false if rolling > banking && rolling > weathercock => Some(ModeName::Roll),
        false if part.has(&[RollAngle]) && rolling < banking => Some(ModeName::Spiral),
        false => None,
    }
}

/// Takes away names that two modes of one aircraft have: they tell neither from the other.
pub(super) fn only_once(names: &mut [Option<ModeName>]) {
    let before = names.to_vec();
    for name in names.iter_mut() {
        let same = before.iter().filter(|other| name == *other).count();
        let is_common = *name == Some(ModeName::Structural);
        if same > 1 && !is_common {
            *name = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use PhysicalQuantity::*;

    #[test]
    fn names_go_by_what_takes_part_and_not_by_units() {
        let longitudinal = [VelocityX, VelocityZ, PitchRate, PitchAngle].map(Some);
        let lateral = [VelocityY, RollRate, YawRate, RollAngle].map(Some);
        for (quantities, shares, oscillates, name) in [
            (
                longitudinal,
                [0.02, 0.5, 0.5, 0.02],
                true,
                Some(ModeName::ShortPeriod),
            ),
            (
                longitudinal,
                [0.5, 0.02, 0.02, 0.5],
                true,
                Some(ModeName::Phugoid),
            ),
            (longitudinal, [0.02, 0.5, 0.5, 0.02], false, None),
            (
                lateral,
                [0.5, 0.1, 0.5, 0.02],
                true,
                Some(ModeName::DutchRoll),
            ),
            (
                lateral,
                [0.05, 0.5, 0.05, 0.5],
                true,
                Some(ModeName::RollSpiral),
            ),
            (
                lateral,
                [0.05, 1.0, 0.05, 0.02],
                false,
                Some(ModeName::Roll),
            ),
            (
                lateral,
                [0.02, 0.02, 0.1, 0.9],
                false,
                Some(ModeName::Spiral),
            ),
        ] {
            assert_eq!(
                mode_name(&quantities, &shares, oscillates),
                name,
                "{shares:?}"
            );
        }
    }

    #[test]
    fn a_yaw_damper_without_sideslip_is_no_spiral() {
        let states = [RollRate, YawRate].map(Some);
        assert_eq!(mode_name(&states, &[0.9, 0.1], false), Some(ModeName::Roll));
        assert_eq!(mode_name(&states, &[0.1, 0.9], false), None);
        assert_eq!(mode_name(&states, &[0.5, 0.5], true), None);
    }

    #[test]
    fn both_motions_at_once_have_no_name() {
        let states = [AngleOfAttack, RollRate].map(Some);
        assert_eq!(mode_name(&states, &[0.5, 0.5], true), None);
        assert_eq!(mode_name(&[None, None], &[0.5, 0.5], true), None);
    }

    #[test]
    fn a_name_that_two_modes_have_tells_neither() {
        let mut names = [
            Some(ModeName::Roll),
            Some(ModeName::Roll),
            Some(ModeName::Spiral),
        ];
        only_once(&mut names);
        assert_eq!(names, [None, None, Some(ModeName::Spiral)]);
    }
}
