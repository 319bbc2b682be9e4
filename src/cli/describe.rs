//! `trimtab maneuver describe`: what was flown, as a merge patch.

use clap::Args;
use serde_json::{Value, json};

use super::Failure;
use super::server::ServerOption;
use crate::flight::Quantity;

#[derive(Args)]
pub(super) struct Describe {
    /// The id of the recording.
    pub(super) id: String,
    #[command(flatten)]
    pub(super) server: ServerOption,
    /// Another name of the recording.
    #[arg(long)]
    name: Option<String>,
    /// The type of the aircraft.
    #[arg(long)]
    aircraft: Option<String>,
    /// Its registration or tail number.
    #[arg(long)]
    registration: Option<String>,
    /// The flight, by its number or name.
    #[arg(long)]
    flight: Option<String>,
    /// The test point of the flight.
    #[arg(long)]
    test_point: Option<String>,
    /// The day, as 2026-11-21.
    #[arg(long)]
    date: Option<String>,
    /// The configuration as a whole.
    #[arg(long)]
    configuration: Option<String>,
    /// The landing gear.
    #[arg(long)]
    gear: Option<String>,
    /// The flaps.
    #[arg(long)]
    flaps: Option<String>,
    /// For people.
    #[arg(long)]
    notes: Option<String>,
    /// A tag; may be given several times, and takes the place of those before.
    #[arg(long = "tag", value_name = "TAG")]
    tags: Vec<String>,
    /// A quantity with its unit: "mass=17600[kg]", "cg.x=3.1[m]", "Iy=1.5e6[kg*m^2]", or by a name of your own; may be given
    /// several times.
    #[arg(long = "set", value_name = "NAME=NUMBER[UNIT]")]
    quantities: Vec<String>,
    /// What is to be taken away, by the name of its option or quantity; may be given several times.
    #[arg(long, value_name = "NAME")]
    clear: Vec<String>,
}

impl Describe {
    /// The merge patch.
    pub(super) fn change(&self) -> Result<Value, Failure> {
        let mut wishes = Wishes::default();
        let texts = [
            ("name", &self.name),
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
        for (name, text) in texts {
            if let Some(text) = text {
                wishes.say(member(name), json!(text))?;
            }
        }
        if !self.tags.is_empty() {
            wishes.say(member("tags"), json!(self.tags))?;
        }
        for text in &self.quantities {
            let (path, quantity) = set(text)?;
            wishes.say(path, json!(quantity))?;
        }
        for name in &self.clear {
            wishes.clear(name)?;
        }
        match wishes.0.is_empty() {
            false => Ok(wishes.patch()),
            true => Err(Failure::new(
                "nothing is said of the recording; say it, as --aircraft or --set mass=17600[kg]",
            )),
        }
    }
}

/// What is to be changed, by its place in the merge patch.
#[derive(Default)]
struct Wishes(Vec<(Vec<String>, Value)>);

impl Wishes {
    /// # Errors
    /// Something else is said of it already, or of a part of it: one of the two would be lost.
    fn say(&mut self, path: Vec<String>, value: Value) -> Result<(), Failure> {
        let is_of_one = |other: &[String]| other.starts_with(&path) || path.starts_with(other);
        let mut others = self.0.iter().filter(|(other, _)| is_of_one(other));
        match others.find(|(other, said)| *other != path || *said != value) {
            None => {}
            Some((other, _)) if *other == path => {
                let name = path[path.len() - 1].clone();
                let message = format!("'{name}' is said twice; leave one of the two out");
                return Err(Failure::new(message));
            }
            Some(_) => {
                return Err(Failure::new(
                    "--clear quantities takes all of them away: say others by a command of their own, or clear by their names those that are to go",
                ));
            }
        }
        self.0.push((path, value));
        Ok(())
    }

    /// Takes something away; of a group what is not said.
    ///
    /// # Errors
    /// It is said, too.
    fn clear(&mut self, name: &str) -> Result<(), Failure> {
        let path = member(name);
        let members: &[&str] = match path.last().map(String::as_str) {
            Some("centre_of_gravity") => &["x", "y", "z"],
            Some("inertia") => &["Ix", "Iy", "Iz", "Ixz"],
            _ => return self.say(path, Value::Null),
        };
        for name in members {
            let of_member = [path.as_slice(), &[name.to_string()]].concat();
            if self.0.iter().all(|(said, _)| *said != of_member) {
                self.say(of_member, Value::Null)?;
            }
        }
        Ok(())
    }

    fn patch(self) -> Value {
        let mut patch = json!({});
        for (path, value) in self.0 {
            let mut place = &mut patch;
            for name in &path {
                place = &mut place[name.as_str()];
            }
            *place = value;
        }
        patch
    }
}

/// Name and quantity of `NAME=NUMBER[UNIT]`.
fn set(text: &str) -> Result<(Vec<String>, Quantity), Failure> {
    let (name, quantity) = (text.split_once('='))
        .ok_or_else(|| Failure::new(format!("--set '{text}': write it like mass=17600[kg]")))?;
    let quantity =
        Quantity::parse(quantity).map_err(|why| Failure::new(format!("--set '{text}': {why}")))?;
    let path = member(name.trim());
    let is_quantity = path.len() == 3 || path.last().is_some_and(|name| name == "mass");
    match is_quantity {
        true => Ok((path, quantity)),
        false => Err(Failure::new(format!(
            "--set '{text}': '{}' is no quantity; write one like mass=17600[kg], cg.x=3.1[m] or quantities.NAME=1200[kg]",
            name.trim()
        ))),
    }
}

/// Where a quantity or a text stands.
fn member(name: &str) -> Vec<String> {
    let name = name.replace('-', "_");
    let path: Vec<&str> = match name.as_str() {
        "name" => vec!["name"],
        "Ix" | "Iy" | "Iz" | "Ixz" => vec!["flown", "inertia", &name],
        "cg" => vec!["flown", "centre_of_gravity"],
        "tag" => vec!["flown", "tags"],
        "aircraft" | "registration" | "flight" | "test_point" | "date" | "configuration"
        | "gear" | "flaps" | "notes" | "tags" | "mass" | "inertia" | "centre_of_gravity"
        | "quantities" => vec!["flown", &name],
        _ => match name.split_once('.') {
            Some(("cg" | "centre_of_gravity", axis)) => vec!["flown", "centre_of_gravity", axis],
            Some(("inertia", of)) => vec!["flown", "inertia", of],
            Some(("quantities", other)) => vec!["flown", "quantities", other],
            _ => vec!["flown", "quantities", &name],
        },
    };
    path.into_iter().map(str::to_string).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The patch of a command, or what is told where there is none.
    fn patch(options: &[&str]) -> Result<Value, String> {
        #[derive(clap::Parser)]
        struct Command {
            #[command(flatten)]
            describe: Describe,
        }
        let all = ["describe", "ID"].iter().chain(options);
        let command = <Command as clap::Parser>::try_parse_from(all).unwrap();
        command.describe.change().map_err(|why| why.to_string())
    }

    #[test]
    fn names_lead_to_their_places() {
        let kilograms = json!({"value": 1.0, "unit": "kg"});
        let options =
            ["mass", "cg.x", "Iy", "fuel", "cg.z"].map(|name| format!("--set={name}=1[kg]"));
        let expected = json!({"flown": {
            "mass": kilograms, "centre_of_gravity": {"x": kilograms, "z": kilograms}, "inertia": {"Iy": kilograms},
            "quantities": {"fuel": kilograms},
        }});
        assert_eq!(patch(&options.each_ref().map(String::as_str)), Ok(expected));
    }

    #[test]
    fn wishes_given_together_are_all_kept_or_refused() {
        let metre = json!({"value": 1.0, "unit": "m"});
        let cleared = json!({"flown": {
            "centre_of_gravity": {"x": metre, "y": null, "z": null}, "notes": null, "tags": null, "quantities": {"fuel": null},
        }});
        for options in [
            [
                "--clear=centre_of_gravity.y",
                "--clear=cg.z",
                "--set=cg.x=1[m]",
            ],
            [
                "--set=cg.x=1[m]",
                "--clear=cg.y",
                "--clear=centre-of-gravity.z",
            ],
            [
                "--clear=centre_of_gravity",
                "--set=cg.x=1[m]",
                "--clear=cg.y",
            ],
        ] {
            let others = ["--clear=notes", "--clear=tag", "--clear=fuel"];
            assert_eq!(
                patch(&[&options[..], &others].concat()),
                Ok(cleared.clone())
            );
        }
        let all = json!({"name": null, "flown": {
            "inertia": {"Ix": null, "Iy": null, "Iz": null, "Ixz": null}, "quantities": null,
        }});
        let options = [
            "--clear=name",
            "--clear=inertia",
            "--clear=Ix",
            "--clear=quantities",
        ];
        assert_eq!(patch(&options), Ok(all));
        for (options, expected) in [
            (["--clear=mass", "--set=mass=1[kg]"], "'mass' is said twice"),
            (
                ["--set=fuel=1[kg]", "--set=fuel=2[kg]"],
                "'fuel' is said twice",
            ),
            (["--notes=a", "--clear=notes"], "'notes' is said twice"),
            (
                ["--clear=quantities", "--set=fuel=1[kg]"],
                "by a command of their own",
            ),
            (["--set=aircraft=1[kg]", "--gear=up"], "is no quantity"),
            (["--set=cg=1[m]", "--gear=up"], "is no quantity"),
        ] {
            let told = patch(&options).unwrap_err();
            assert!(told.contains(expected), "{options:?}: {told}");
        }
        assert!(patch(&[]).unwrap_err().contains("nothing is said"));
    }
}
