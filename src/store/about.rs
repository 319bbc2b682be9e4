//! What a job is about, in a line: its model and its maneuvers, as they were called when it was submitted. It is kept beside
//! the job, so that lists need not read specs.

use serde::{Deserialize, Serialize};
use sqlx::{AnyConnection, Row};

use super::StoreError;
use crate::estimate::Role;

/// The model and the maneuvers of a job.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct About {
    pub model: ModelOfJob,
    /// In the order of the spec.
    pub maneuvers: Vec<ManeuverOfJob>,
}

#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct ModelOfJob {
    pub name: String,
    /// A catalog name, or the id of a stored model; absent of one that only the job holds.
    pub id: Option<String>,
}

#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct ManeuverOfJob {
    pub id: String,
    /// The label in the spec; else the recording's name, or the beginning of its id, and the part in use.
    pub label: String,
    pub role: Role,
}

/// Names that stand in a title; of more, only how many there are.
const NAMED: usize = 2;

impl About {
    /// What to call a job that was given no name: its model and maneuvers.
    pub fn title(&self) -> String {
        let labels: Vec<&str> = (self.maneuvers.iter())
            .map(|maneuver| maneuver.label.as_str())
            .collect();
        let of_model = self.model.name.as_str();
        match labels.as_slice() {
            [] => of_model.to_string(),
            [some @ .., last] if some.len() < NAMED => {
                let first = some.iter().map(|label| format!("{label} and "));
                format!("{of_model}: {}{last}", first.collect::<String>())
            }
            all => {
                let (named, others) = all.split_at(NAMED);
                format!("{of_model}: {} and {} more", named.join(", "), others.len())
            }
        }
    }

    /// Of a job as it is kept. What an earlier version kept and this one cannot read leaves its place empty.
    pub(super) async fn of(
        connection: &mut AnyConnection,
        project: &str,
        spec: &str,
        model: &str,
    ) -> Result<Self, StoreError> {
        let spec: Spec = serde_json::from_str(spec).unwrap_or_default();
        let model: Named = serde_json::from_str(model).unwrap_or_default();
        let mut maneuvers = Vec::with_capacity(spec.maneuvers.len());
        for used in spec.maneuvers {
            let label = match &used.label {
                Some(label) => label.clone(),
                None => used.part_of(&recorded_name(&mut *connection, project, &used.id).await?),
            };
            maneuvers.push(ManeuverOfJob {
                id: used.id,
                label,
                role: used.role,
            });
        }
        let id = spec.model.as_str().map(ToString::to_string);
        Ok(Self {
            model: ModelOfJob {
                name: model.name,
                id,
            },
            maneuvers,
        })
    }
}

/// What is read of a spec.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Spec {
    model: serde_json::Value,
    maneuvers: Vec<Use>,
}

#[derive(Deserialize)]
struct Use {
    id: String,
    #[serde(default)]
    label: Option<String>,
    #[serde(default)]
    rows: Option<[usize; 2]>,
    #[serde(default)]
    seconds: Option<[f64; 2]>,
    #[serde(default)]
    role: Role,
}

impl Use {
    /// A recording's name, and the part of it that is used.
    fn part_of(&self, name: &str) -> String {
        match (self.seconds, self.rows) {
            (Some([from, to]), _) => format!("{name}, {from} to {to} s"),
            (None, Some([from, to])) => format!("{name}, rows {from} to {to}"),
            (None, None) => name.to_string(),
        }
    }
}

/// What is read of a model document.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Named {
    name: String,
}

async fn recorded_name(
    connection: &mut AnyConnection,
    project: &str,
    id: &str,
) -> Result<String, StoreError> {
    let row = sqlx::query("SELECT name FROM maneuvers WHERE project = $1 AND id = $2")
        .bind(project)
        .bind(id)
        .fetch_optional(connection)
        .await?;
    let name: String = match row {
        Some(row) => row.try_get("name")?,
        None => String::new(),
    };
    Ok(if name.is_empty() {
        id.chars().take(12).collect()
    } else {
        name
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(labels: &[&str]) -> About {
        let maneuvers = labels.iter().map(|label| ManeuverOfJob {
            id: String::new(),
            label: (*label).to_string(),
            role: Role::default(),
        });
        About {
            model: ModelOfJob {
                name: "short-period".into(),
                id: None,
            },
            maneuvers: maneuvers.collect(),
        }
    }

    #[test]
    fn a_job_is_called_by_its_model_and_maneuvers() {
        for (labels, title) in [
            (&[][..], "short-period"),
            (&["a"], "short-period: a"),
            (&["a", "b"], "short-period: a and b"),
            (&["a", "b", "c"], "short-period: a, b and 1 more"),
            (&["a", "b", "c", "d"], "short-period: a, b and 2 more"),
        ] {
            assert_eq!(about(labels).title(), title);
        }
    }
}
