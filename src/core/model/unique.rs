//! Tables that may not name a thing twice. JSON readers keep the last of two equal keys, silently; a flight-test
//! engineer who wrote both wants to know.

use std::fmt;
use std::marker::PhantomData;

use indexmap::IndexMap;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};

/// For `#[serde(deserialize_with)]`: refuses a key that stands twice.
pub(crate) fn unique<'de, T, D>(deserializer: D) -> Result<IndexMap<String, T>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    struct Table<T>(PhantomData<T>);

    impl<'de, T: Deserialize<'de>> Visitor<'de> for Table<T> {
        type Value = IndexMap<String, T>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("an object of named entries")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Self::Value, A::Error> {
            let mut table = IndexMap::new();
            while let Some((name, value)) = entries.next_entry::<String, T>()? {
                if table.contains_key(&name) {
                    let name: String = name.chars().take(64).collect();
                    return Err(A::Error::custom(format!("'{name}' is defined twice")));
                }
                table.insert(name, value);
            }
            Ok(table)
        }
    }

    deserializer.deserialize_map(Table(PhantomData))
}
