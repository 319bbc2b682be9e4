//! What was flown: by which aircraft, when, and how it was loaded.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::fault::{Fault, escape};
use super::{Dimension, Unit};

/// What is known of a flight beside its channels. All of it may be absent, and none of it changes what was recorded.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Flown {
    /// Its type.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "VFW 614 ATTAS")]
    pub aircraft: Option<String>,
    /// Its registration or tail number.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "D-ADAM")]
    pub registration: Option<String>,
    /// The flight, by its number or name.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "F0223")]
    pub flight: Option<String>,
    /// The test point of the flight.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "12a, elevator 3-2-1-1")]
    pub test_point: Option<String>,
    /// The day, as `2026-11-21`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "2026-11-21")]
    pub date: Option<String>,
    /// The configuration as a whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "cruise")]
    pub configuration: Option<String>,
    /// The landing gear.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "up")]
    pub gear: Option<String>,
    /// The flaps.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "1 deg")]
    pub flaps: Option<String>,
    /// The mass of the aircraft.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<Quantity>,
    /// The centre of gravity.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centre_of_gravity: Option<CentreOfGravity>,
    /// Moments of inertia.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia: Option<Inertia>,
    /// Other quantities by name, such as the fuel on board or the wing area.
    #[serde(
        deserialize_with = "crate::flight::flown::unique",
        skip_serializing_if = "IndexMap::is_empty"
    )]
    pub quantities: IndexMap<String, Quantity>,
    /// For people.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(example = "light turbulence in the second half")]
    pub notes: Option<String>,
    /// For people, to find recordings by.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schema(example = json!(["campaign 3"]))]
    pub tags: Vec<String>,
}

/// A number with its unit.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Quantity {
    /// In `unit`.
    #[schema(example = 17600.0)]
    pub value: f64,
    /// `-` for a pure number.
    #[schema(example = "kg")]
    pub unit: String,
}

/// Where the centre of gravity is, in the axes of whoever says so.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CentreOfGravity {
    /// Along the aircraft: a length, or a share of the chord.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x: Option<Quantity>,
    /// Across it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<Quantity>,
    /// Up or down.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z: Option<Quantity>,
}

/// Moments of inertia about the centre of gravity.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Inertia {
    /// In roll.
    #[serde(rename = "Ix", skip_serializing_if = "Option::is_none")]
    pub ix: Option<Quantity>,
    /// In pitch.
    #[serde(rename = "Iy", skip_serializing_if = "Option::is_none")]
    pub iy: Option<Quantity>,
    /// In yaw.
    #[serde(rename = "Iz", skip_serializing_if = "Option::is_none")]
    pub iz: Option<Quantity>,
    /// The product of inertia.
    #[serde(rename = "Ixz", skip_serializing_if = "Option::is_none")]
    pub ixz: Option<Quantity>,
}

/// Characters of a text, and of the notes.
const LONGEST_TEXT: usize = 200;
const LONGEST_NOTES: usize = 10_000;
const LONGEST_NAME: usize = 64;
const MOST_QUANTITIES: usize = 100;
const MOST_TAGS: usize = 20;
const LONGEST_TAG: usize = 64;

impl Flown {
    /// Whether nothing is said.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The quantities that are said, by their names: `mass`, `centre_of_gravity.x`, `inertia.Ix`, `quantities.fuel`.
    pub fn quantities(&self) -> impl Iterator<Item = (String, &Quantity)> {
        let centre = self.centre_of_gravity.iter().flat_map(|centre| {
            [("x", &centre.x), ("y", &centre.y), ("z", &centre.z)]
                .map(|(name, quantity)| (format!("centre_of_gravity.{name}"), quantity.as_ref()))
        });
        let inertia = self.inertia.iter().flat_map(|inertia| {
            let Inertia { ix, iy, iz, ixz } = inertia;
            [("Ix", ix), ("Iy", iy), ("Iz", iz), ("Ixz", ixz)]
                .map(|(name, quantity)| (format!("inertia.{name}"), quantity.as_ref()))
        });
        let others = self.quantities.iter();
        let others = others.map(|(name, quantity)| (format!("quantities.{name}"), Some(quantity)));
        let mass = std::iter::once(("mass".to_string(), self.mass.as_ref()));
        let all = mass.chain(centre).chain(inertia).chain(others);
        all.filter_map(|(name, quantity)| Some((name, quantity?)))
    }

    /// What is wrong with it, each with its pointer.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut refuse = |pointer: String, message: String| {
            faults.push(Fault::new(pointer, "bad_flown", message));
        };
        for (name, text, most) in self.texts() {
            if let Some(text) = text
                && !(1..=most).contains(&text.chars().count())
            {
                let message =
                    format!("a text of 1 to {most} characters stands here; null takes it away");
                refuse(format!("/{name}"), message);
            }
        }
        if let Some(date) = self.date.as_ref().filter(|date| !is_date(date)) {
            let message = format!("'{date}' is no date like 2026-11-21", date = short(date));
            refuse("/date".to_string(), message);
        }
        if self.quantities.len() > MOST_QUANTITIES {
            let message = format!("there are more than {MOST_QUANTITIES}");
            refuse("/quantities".to_string(), message);
        }
        for name in self.quantities.keys() {
            let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if !(1..=LONGEST_NAME).contains(&name.len()) || !name.chars().all(is_plain) {
                let message = format!("a name has 1 to {LONGEST_NAME} letters, digits and '_'");
                refuse(format!("/quantities/{}", escape(name)), message);
            }
        }
        for (name, quantity) in self.quantities().take(2 * MOST_QUANTITIES) {
            if let Err(why) = quantity.check(&name) {
                let path: Vec<String> = name.split('.').map(escape).collect();
                refuse(format!("/{}", path.join("/")), why);
            }
        }
        if self.tags.len() > MOST_TAGS {
            refuse(
                "/tags".to_string(),
                format!("there are more than {MOST_TAGS} tags"),
            );
        }
        for (number, tag) in self.tags.iter().enumerate().take(MOST_TAGS) {
            if !(1..=LONGEST_TAG).contains(&tag.chars().count())
                || self.tags[..number].contains(tag)
            {
                let message =
                    format!("a tag has 1 to {LONGEST_TAG} characters, and stands here once");
                refuse(format!("/tags/{number}"), message);
            }
        }
        faults
    }

    fn texts(&self) -> [(&'static str, Option<&String>, usize); 9] {
        [
            ("aircraft", self.aircraft.as_ref(), LONGEST_TEXT),
            ("registration", self.registration.as_ref(), LONGEST_TEXT),
            ("flight", self.flight.as_ref(), LONGEST_TEXT),
            ("test_point", self.test_point.as_ref(), LONGEST_TEXT),
            ("date", self.date.as_ref(), LONGEST_TEXT),
            ("configuration", self.configuration.as_ref(), LONGEST_TEXT),
            ("gear", self.gear.as_ref(), LONGEST_TEXT),
            ("flaps", self.flaps.as_ref(), LONGEST_TEXT),
            ("notes", self.notes.as_ref(), LONGEST_NOTES),
        ]
    }
}

impl Quantity {
    /// A number with its unit behind it: `17600 kg`, `17600[kg]`.
    ///
    /// # Errors
    /// It is none.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let end = text.find(['[', ' ']).unwrap_or(text.len());
        let (number, unit) = text.split_at(end);
        let unit = unit.trim();
        let unit = match unit.strip_prefix('[') {
            Some(unit) => unit.strip_suffix(']').unwrap_or(""),
            None => unit,
        };
        let value = number.parse::<f64>().ok().filter(|value| value.is_finite());
        match value {
            Some(value) if Unit::parse(unit).is_ok() && !unit.is_empty() => Ok(Self {
                value,
                unit: unit.to_string(),
            }),
            _ => Err(format!(
                "'{}' is no number with a unit, such as 17600[kg]",
                short(text)
            )),
        }
    }

    /// In SI, and what it measures; `None` where the unit is none.
    pub fn in_si(&self) -> Option<(f64, Dimension)> {
        let unit = Unit::parse(&self.unit).ok()?;
        Some((unit.to_si(self.value), unit.dimension))
    }

    /// # Errors
    /// Its unit is none, or not one of what its name says; or its size is none.
    fn check(&self, name: &str) -> Result<(), String> {
        let unit = Unit::parse(&self.unit).map_err(|error| error.to_string())?;
        let of_inertia = Dimension::KILOGRAM
            .times(Dimension::METRE)
            .times(Dimension::METRE);
        let (expected, is_right) = match name.split_once('.').map_or(name, |(group, _)| group) {
            "mass" => ("kg", unit.dimension == Dimension::KILOGRAM),
            "inertia" => ("kg*m^2", unit.dimension == of_inertia),
            "centre_of_gravity" => (
                "m, or % of the chord",
                unit.dimension == Dimension::METRE || unit.dimension.is_none(),
            ),
            _ => ("", true),
        };
        if !is_right {
            return Err(format!(
                "this is in {expected}, or another unit of the kind, and not in '{}'",
                short(&self.unit)
            ));
        }
        let is_above_zero =
            name == "mass" || (name.starts_with("inertia.") && name != "inertia.Ixz");
        match self.value.is_finite() && (self.value > 0.0 || !is_above_zero) {
            true => Ok(()),
            false => Err(format!("{} is not above 0", self.value)),
        }
    }
}

/// The beginning of a stranger's text.
fn short(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(40).collect()
}

/// A day of the calendar, as ISO 8601 has it.
fn is_date(text: &str) -> bool {
    let fields: Vec<&str> = text.split('-').collect();
    let [year, month, day] = fields[..] else {
        return false;
    };
    let is_number =
        |text: &str, length| text.len() == length && text.bytes().all(|byte| byte.is_ascii_digit());
    let (Ok(of_year), Ok(of_month), Ok(of_day)) = (
        year.parse::<u32>(),
        month.parse::<u32>(),
        day.parse::<u32>(),
    ) else {
        return false;
    };
    let is_leap = of_year % 4 == 0 && (of_year % 100 != 0 || of_year % 400 == 0);
    let length = match of_month {
        2 if is_leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => 0,
    };
    let is_written = is_number(year, 4) && is_number(month, 2) && is_number(day, 2);
    is_written && (1..=length).contains(&of_day)
}

/// Members of an object; one that stands there twice is refused.
fn unique<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<IndexMap<String, Quantity>, D::Error> {
    struct Members;

    impl<'de> serde::de::Visitor<'de> for Members {
        type Value = IndexMap<String, Quantity>;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            write!(f, "quantities by name")
        }

        fn visit_map<A: serde::de::MapAccess<'de>>(
            self,
            mut map: A,
        ) -> Result<Self::Value, A::Error> {
            let mut members = IndexMap::new();
            while let Some((name, quantity)) = map.next_entry::<String, Quantity>()? {
                if members.contains_key(&name) {
                    return Err(serde::de::Error::custom(format!(
                        "'{}' stands here twice",
                        short(&name)
                    )));
                }
                members.insert(name, quantity);
            }
            Ok(members)
        }
    }

    deserializer.deserialize_map(Members)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_have_their_places() {
        let flown: Flown = serde_json::from_value(serde_json::json!({
            "aircraft": "", "date": "2026-02-29", "mass": {"value": 3, "unit": "m"},
            "inertia": {"Ix": {"value": -1, "unit": "kg*m^2"}, "Ixz": {"value": -1, "unit": "kg m^2"}},
            "centre_of_gravity": {"x": {"value": 25, "unit": "%"}, "z": {"value": 1, "unit": "warp"}},
            "quantities": {"a b": {"value": 1, "unit": "-"}},
            "tags": ["one", "one"],
        }))
        .unwrap();
        let places: Vec<String> = flown
            .faults()
            .into_iter()
            .map(|fault| fault.pointer)
            .collect();
        let expected = [
            "/aircraft",
            "/date",
            "/quantities/a b",
            "/mass",
            "/centre_of_gravity/z",
            "/inertia/Ix",
            "/tags/1",
        ];
        assert_eq!(places, expected);
        assert!(Flown::default().faults().is_empty() && Flown::default().is_empty());
        assert!(is_date("2024-02-29") && !is_date("2026-2-9") && !is_date("2026-13-01"));
    }

    #[test]
    fn quantities_are_written_as_in_formulas() {
        let quantity = |text| Quantity::parse(text).map(|quantity| (quantity.value, quantity.unit));
        assert_eq!(quantity("17600[kg]"), Ok((17600.0, "kg".to_string())));
        assert_eq!(
            quantity(" -1.5e3 kg*m^2 "),
            Ok((-1500.0, "kg*m^2".to_string()))
        );
        for text in ["17600", "[kg]", "1[", "1 warp", "inf kg", ""] {
            assert!(quantity(text).is_err(), "{text}");
        }
    }
}
