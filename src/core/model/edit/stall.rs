//! Stall: separation of the flow with hysteresis, after Kirchhoff, Goman and Khrabrov.

use super::dynamics::angle;
use super::edited::AddedRole;
use super::error::EditError;
use super::sheet::{Sheet, dimension, unknown};
use super::text::replace_name;
use crate::flight::{Dimension, PhysicalQuantity};

/// What a separation of the whole flow may add to a pitching moment coefficient: a lift coefficient of about 1 that
/// moves by less than a third of the chord.
const MOMENT: (f64, f64) = (-0.3, 0.3);

/// What it may add to a drag coefficient: not less than nothing.
const DRAG: (f64, f64) = (0.0, 1.0);

/// τ1 Ẋ = ½ (1 - tanh a1 (α - τ2 α̇ - α*)) - X; in a lift α becomes ((1 + √X)/2)² α, to a moment or a drag C (1 - X) is
/// added.
///
/// A moment is a pitching moment coefficient or the equation of a rate, a drag a drag coefficient; all other targets are
/// lifts, and must read α. α̇ is a definition or input that is this rate, or the derivative of the state α; without these,
/// τ2 is left out.
pub(super) fn hysteresis(sheet: &mut Sheet) -> Result<(), EditError> {
    let (angle, unit) = angle(sheet)?;
    let targets: Vec<&str> = sheet.edit.target.split('+').map(str::trim).collect();
    let separation = sheet.free("X");
    let name = sheet.name(&format!("{angle}_stall"))?;
    let words = format!("{angle} at which half the flow has separated");
    // at the upper bound none has, whatever the angle that is flown: the separation is 1 to the last bit
    sheet.add(
        &name,
        AddedRole::Limit,
        unknown("deg", 15.0, Some((5.0, 90.0)), words),
    );
    let steepness = sheet.free(&format!("{angle}_stall_steepness"));
    let words = "steepness of the separation, a1".to_string();
    sheet.add(
        &steepness,
        AddedRole::Steepness,
        unknown("-", 20.0, Some((5.0, 80.0)), words),
    );
    let time = sheet.free(&format!("{angle}_stall_time"));
    let words = "time constant of the separation, tau1".to_string();
    sheet.add(
        &time,
        AddedRole::TimeConstant,
        unknown("s", 0.2, Some((0.01, 2.0)), words),
    );
    let quantities = sheet.quantities();
    let rate = sheet.varying(&quantities, PhysicalQuantity::AngleOfAttackRate);
    for target in targets {
        let is_rate = (sheet.document.states.get(target))
            .is_some_and(|state| dimension(&state.unit) == Dimension::NONE.over(Dimension::SECOND));
        let share = match quantities.get(target) {
            Some(PhysicalQuantity::PitchingMomentCoefficient) => Some(Some(MOMENT)),
            Some(PhysicalQuantity::DragCoefficient) => Some(Some(DRAG)),
            _ if is_rate => Some(None),
            _ => None,
        };
        if let Some(range) = share {
            let (_, measures) = sheet.law(target)?;
            let share = sheet.free(&format!("{target}_{separation}"));
            let words = format!("effect on {target} of the separation of the flow");
            sheet.add(
                &share,
                AddedRole::Size,
                unknown(measures.to_string(), 0.0, range, words),
            );
            let (equation, _) = sheet.law(target)?;
            *equation = format!("{equation} + {share}*(1 - {separation})");
        } else {
            // the square root must stay a number that can be derived
            let attached = format!("(((1 + sqrt(max({separation}, 0.0001)))/2)^2*{angle})");
            let (equation, _) = sheet.law(target)?;
            let changed = replace_name(equation, angle, &attached);
            if changed == *equation {
                let message = format!("the equation of '{target}' does not read '{angle}'");
                return Err(sheet.unfit(message));
            }
            *equation = changed;
        }
    }
    let initial = sheet.at_start(angle, &unit, angle);
    let initial = format!("0.5*(1 - tanh({steepness}*({initial} - {name})))");
    // the rate of a state is explicit in the states, of which the separation is one: it closes no circle
    let state = sheet.document.states.get(angle);
    let late = match rate.or_else(|| state.map(|state| format!("({})", state.derivative))) {
        None => String::new(),
        Some(rate) => {
            let memory = sheet.free(&format!("{angle}_stall_delay"));
            let words = "delay of the stall in pitching up, tau2".to_string();
            sheet.add(
                &memory,
                AddedRole::Delay,
                unknown("s", 0.0, Some((-0.2, 2.0)), words),
            );
            format!(" - {memory}*{rate}")
        }
    };
    let derivative =
        format!("(0.5*(1 - tanh({steepness}*({angle}{late} - {name}))) - {separation})/{time}");
    let words = "point of separation: 1 attached, 0 separated".to_string();
    sheet.add_state(&separation, "-", initial, derivative, words);
    Ok(())
}
