//! Units that a form offers, with how values in them are shown.

use maud::{Markup, html};

use crate::flight::{Unit, shown_in};

/// Those that recordings have; a form takes others, too.
const UNITS: [&str; 60] = [
    "-", "%", "deg", "rad", "mrad", "rev", "deg/s", "rad/s", "mrad/s", "rpm", "deg/s^2", "rad/s^2",
    "1/s", "Hz", "m", "km", "cm", "mm", "ft", "in", "nmi", "m/s", "km/h", "kt", "mph", "ft/s",
    "fpm", "m/s^2", "ft/s^2", "g", "N", "daN", "kN", "kgf", "lbf", "N*m", "lbf*ft", "Pa", "hPa",
    "kPa", "bar", "psi", "psf", "inHg", "K", "degC", "degF", "degR", "kg", "lb", "slug", "kg/s",
    "kg/m^3", "W", "kW", "hp", "s", "ms", "us", "V",
];

/// The list for inputs with `list="units"`. Scripts find in it how a value is shown to people: times `data-scale`, and
/// `data-offset` more, in `data-shown`.
pub(super) fn unit_list() -> Markup {
    html! {
        datalist id="units" {
            @for text in UNITS {
                @if let Ok(unit) = Unit::parse(text) {
                    @let shown = shown_in(&Unit::si_name(text));
                    option value=(text) data-scale=(unit.scale * shown.scale) data-offset=(unit.offset * shown.scale) data-shown=(shown.unit) {}
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_known() {
        for text in UNITS {
            assert!(Unit::parse(text).is_ok(), "{text}");
        }
        let list = unit_list().into_string();
        assert!(list.contains(r#"value="deg" data-scale="1""#), "{list}");
        assert!(list.contains(r#"data-shown="deg/s""#) && !list.contains(r#"data-shown="rad"#));
    }
}
