//! What was flown: by which aircraft, when, and how it was loaded.

mod derived;
mod quantity;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use super::fault::{Fault, escape};
pub use derived::DerivedFrom;
pub use quantity::Quantity;
use quantity::short;

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
    /// Of a recording that a job made of another: which job, and of what. It is written with the recording.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub derived_from: Option<DerivedFrom>,
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

    /// The texts that are said, by their names, the notes last: `aircraft`, `registration`, `flight`, `test_point`, `date`,
    /// `configuration`, `gear`, `flaps`, `notes`.
    pub fn texts(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let all = [
            ("aircraft", &self.aircraft),
            ("registration", &self.registration),
            ("flight", &self.flight),
            ("test_point", &self.test_point),
            ("date", &self.date),
            ("configuration", &self.configuration),
            ("gear", &self.gear),
            ("flaps", &self.flaps),
            ("notes", &self.notes),
        ];
        all.into_iter()
            .filter_map(|(name, text)| Some((name, text.as_deref()?)))
    }

    /// The same without groups in which nothing is said.
    #[must_use]
    pub fn without_empty_groups(mut self) -> Self {
        let nothing = CentreOfGravity::default();
        self.centre_of_gravity = self.centre_of_gravity.filter(|of| *of != nothing);
        let nothing = Inertia::default();
        self.inertia = self.inertia.filter(|of| *of != nothing);
        self
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
        for (name, text) in self.texts() {
            let most = if name == "notes" {
                LONGEST_NOTES
            } else {
                LONGEST_TEXT
            };
            if !(1..=most).contains(&text.chars().count()) {
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
        for name in self.quantities.keys().take(MOST_QUANTITIES) {
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
        if let Some(DerivedFrom {
            job,
            maneuver,
            segment,
        }) = &self.derived_from
        {
            let parts = [("job", job), ("maneuver", maneuver), ("segment", segment)];
            for (name, text) in parts {
                if !(1..=LONGEST_TEXT).contains(&text.chars().count()) {
                    let message = format!("a text of 1 to {LONGEST_TEXT} characters stands here");
                    refuse(format!("/derived_from/{name}"), message);
                }
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

    fn quantity(unit: &str) -> Quantity {
        Quantity {
            value: 1.0,
            unit: unit.to_string(),
        }
    }

    #[test]
    fn every_text_is_told_by_the_name_that_it_has_in_json() {
        let names = [
            "aircraft",
            "registration",
            "flight",
            "test_point",
            "date",
            "configuration",
            "gear",
            "flaps",
            "notes",
        ];
        let said = names.map(|name| (name.to_string(), format!("my {name}").into()));
        let said = serde_json::Value::Object(said.into_iter().collect());
        let flown: Flown = serde_json::from_value(said).unwrap();
        let expected = names.map(|name| (name, format!("my {name}")));
        let told = flown.texts().map(|(name, text)| (name, text.to_string()));
        assert_eq!(told.collect::<Vec<_>>(), expected);
    }

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
        // as many as there may be are told of, however many there are
        let many = (0..50_000).map(|number| (format!("{number} "), quantity("m")));
        let many = Flown {
            quantities: many.collect(),
            mass: Some(quantity(&"kg*m/m".repeat(20_000))),
            ..Flown::default()
        };
        let faults = many.faults();
        assert!(faults.len() < 2 * MOST_QUANTITIES + 10, "{}", faults.len());
        let length: usize = faults.iter().map(|fault| fault.message.len()).sum();
        assert!(length < 100_000, "{length}");
        assert!(faults.iter().any(|fault| fault.pointer == "/mass"));
        assert!(Flown::default().faults().is_empty() && Flown::default().is_empty());
        assert!(is_date("2024-02-29") && !is_date("2026-2-9") && !is_date("2026-13-01"));
    }
}
