//! JSON has no word for a number out of range: it is written `null`, and read back as NaN. All numbers that are kept or sent
//! are read so: one that got out of range takes nothing else with it.

use std::hash::Hash;

use indexmap::IndexMap;
use serde::de::{Deserialize, DeserializeOwned, Deserializer};

/// For `#[serde(deserialize_with)]`: numbers, each of which may be `null`.
pub(crate) fn null_as_nan<'de, N: Nullable, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<N, D::Error> {
    N::Written::deserialize(deserializer).map(N::of)
}

/// A number or numbers, as they are written.
pub(crate) trait Nullable {
    type Written: DeserializeOwned;

    fn of(written: Self::Written) -> Self;
}

impl Nullable for f64 {
    type Written = Option<f64>;

    fn of(written: Self::Written) -> Self {
        written.unwrap_or(f64::NAN)
    }
}

impl<N: Nullable> Nullable for Vec<N> {
    type Written = Vec<N::Written>;

    fn of(written: Self::Written) -> Self {
        written.into_iter().map(N::of).collect()
    }
}

impl<N: Nullable> Nullable for Option<N> {
    type Written = Option<N::Written>;

    fn of(written: Self::Written) -> Self {
        written.map(N::of)
    }
}

impl<N: Nullable> Nullable for [N; 2] {
    type Written = [N::Written; 2];

    fn of(written: Self::Written) -> Self {
        written.map(N::of)
    }
}

impl<K: DeserializeOwned + Eq + Hash, N: Nullable> Nullable for IndexMap<K, N> {
    type Written = IndexMap<K, N::Written>;

    fn of(written: Self::Written) -> Self {
        written
            .into_iter()
            .map(|(key, n)| (key, N::of(n)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(serde::Serialize, serde::Deserialize)]
    struct Kept {
        #[serde(deserialize_with = "null_as_nan")]
        number: f64,
        #[serde(deserialize_with = "null_as_nan")]
        rows: Vec<Vec<f64>>,
        #[serde(default, deserialize_with = "null_as_nan")]
        range: Option<[f64; 2]>,
        #[serde(deserialize_with = "null_as_nan")]
        named: IndexMap<String, f64>,
    }

    #[test]
    fn what_is_out_of_range_is_read_back_and_the_rest_with_it() {
        let kept = Kept {
            number: f64::INFINITY,
            rows: vec![vec![1.0, f64::NAN], vec![f64::NEG_INFINITY]],
            range: Some([0.5, f64::INFINITY]),
            named: [("a".to_string(), f64::INFINITY), ("b".to_string(), 2.0)].into(),
        };
        let text = serde_json::to_string(&kept).unwrap();
        let read: Kept = serde_json::from_str(&text).unwrap();
        assert!(read.number.is_nan() && read.named["a"].is_nan());
        assert_eq!((read.rows[0][0], read.named["b"]), (1.0, 2.0));
        assert!(read.rows[0][1].is_nan() && read.rows[1][0].is_nan());
        let [from, to] = read.range.unwrap();
        assert!(from == 0.5 && to.is_nan());
        let none = r#"{"number": 1, "rows": [], "named": {}}"#;
        assert_eq!(serde_json::from_str::<Kept>(none).unwrap().range, None);
    }
}
