//! The shape of a JSON recording, and its schema.

use std::fmt;

use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, Visitor},
};
use utoipa::ToSchema;

/// A recorded maneuver as JSON.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({
    "time": {"unit": "s", "start": 0, "step": 0.04},
    "channels": {"alpha": {"unit": "deg", "values": [1.2, null, 1.4]}}
}))]
pub struct Recording {
    /// When samples were taken.
    pub(super) time: RecordedTime,
    /// By name; a name is an identifier that equations refer to.
    #[schema(value_type = IndexMap<String, RecordedChannel>)]
    pub(super) channels: Channels,
}

/// Either `values`, or `step` (with `start`, else 0) for even sampling.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordedTime {
    /// A unit of time.
    #[schema(example = "s")]
    pub(super) unit: String,
    /// One for each sample, increasing.
    #[schema(value_type = Option<Vec<Option<f64>>>)]
    pub(super) values: Option<Vec<Number>>,
    /// The first time of even sampling; absent: 0.
    pub(super) start: Option<f64>,
    /// From one sample to the next of even sampling.
    #[schema(example = 0.04)]
    pub(super) step: Option<f64>,
}

/// One channel.
#[derive(Debug, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RecordedChannel {
    /// Absent or `-`: a pure number.
    #[serde(default)]
    #[schema(example = "deg")]
    pub(super) unit: String,
    /// One for each sample, `null` where there is none.
    #[schema(value_type = Vec<Option<f64>>)]
    pub(super) values: Vec<Number>,
    /// Times of its own, where it was recorded at another rate. The recording then has the times of all, and this channel no
    /// value at those of the others.
    #[serde(default)]
    pub(super) time: Option<RecordedTime>,
}

/// Channels in the order of the document, a name that stands twice included.
#[derive(Debug)]
pub(super) struct Channels(pub(super) Vec<(String, RecordedChannel)>);

impl<'de> Deserialize<'de> for Channels {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Channels;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an object of channels by name")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Channels, A::Error> {
                let mut channels = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    channels.push(entry);
                }
                Ok(Channels(channels))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

/// A number, or NaN for `null`; half the memory of an `Option<f64>`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Number(pub(super) f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Option::<f64>::deserialize(deserializer)?;
        Ok(Self(value.unwrap_or(f64::NAN)))
    }
}

#[cfg(test)]
mod tests {
    use utoipa::PartialSchema;

    use super::*;

    #[test]
    fn the_schema_says_what_is_read() {
        let schema = |schema| serde_json::to_value::<utoipa::openapi::RefOr<_>>(schema).unwrap();
        let recording = schema(Recording::schema());
        assert_eq!(
            recording["required"],
            serde_json::json!(["time", "channels"])
        );
        assert_eq!(recording["additionalProperties"], false);
        let example = recording["example"].to_string();
        assert!(
            serde_json::from_str::<Recording>(&example).is_ok(),
            "{example}"
        );
        let time = schema(RecordedTime::schema());
        assert_eq!(time["required"], serde_json::json!(["unit"]));
        let channel = schema(RecordedChannel::schema());
        assert_eq!(channel["required"], serde_json::json!(["values"]));
        assert_eq!(
            channel["properties"]["values"]["items"]["type"],
            serde_json::json!(["number", "null"])
        );
    }
}
