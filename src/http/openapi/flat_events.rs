//! Events as generators of clients can use them: a union of flat objects, told apart by `type`.
//!
//! The derived schemas follow the types: an event is its number and time, and then one of several bodies, of which some are
//! of several kinds themselves. Here each kind of event becomes one object that has all that can stand in it.

use indexmap::IndexMap;
use serde_json::Value;
use utoipa::openapi::schema::{Components, OneOfBuilder};
use utoipa::openapi::{
    Discriminator, Object, ObjectBuilder, OpenApi, Ref, RefOr, Schema, schema::Type,
};

const TAG: &str = "type";

/// Replaces `Event` and `EventBody` by the union and an object of each kind.
pub(super) fn flatten(document: &mut OpenApi) {
    let components = document.components.get_or_insert_default();
    let (Some(body), Some(event)) = (
        components.schemas.get("EventBody").cloned(),
        components.schemas.get("Event").cloned(),
    ) else {
        return;
    };
    let RefOr::T(Schema::OneOf(body)) = body else {
        return;
    };
    let common = own_fields(&event);
    let mut union = OneOfBuilder::new().description(described(&event));
    let mut discriminator = Discriminator::new(TAG);
    for kind in &body.items {
        let mut fields = common.clone();
        fields.add(&Fields::of(kind, components), true);
        let Some(word) = fields.word() else { continue };
        let name = format!("{}Event", in_camel_case(&word));
        let reference = Ref::from_schema_name(&name);
        discriminator
            .mapping
            .insert(word, reference.ref_location.clone());
        union = union.item(reference);
        let object = fields.into_object(described(kind));
        components
            .schemas
            .insert(name, Schema::Object(object).into());
    }
    let union = union.discriminator(Some(discriminator)).build();
    let schemas = &mut components.schemas;
    schemas.insert("Event".to_string(), Schema::OneOf(union).into());
    schemas.remove("EventBody");
}

/// What an event has whatever its kind: the fields that stand beside the body.
fn own_fields(event: &RefOr<Schema>) -> Fields {
    let mut fields = Fields::default();
    if let RefOr::T(Schema::AllOf(all)) = event {
        for item in &all.items {
            if let RefOr::T(Schema::Object(object)) = item {
                fields.add(&Fields::of_object(object), true);
            }
        }
    }
    fields
}

/// The properties of an object to be, and which of them are always there.
#[derive(Clone, Default)]
struct Fields {
    properties: IndexMap<String, RefOr<Schema>>,
    required: Vec<String>,
}

impl Fields {
    fn of_object(object: &Object) -> Self {
        Self {
            properties: object.properties.clone().into_iter().collect(),
            required: object.required.clone(),
        }
    }

    fn of(schema: &RefOr<Schema>, components: &Components) -> Self {
        match schema {
            RefOr::Ref(reference) => {
                let name = reference.ref_location.rsplit('/').next();
                let named = name.and_then(|name| components.schemas.get(name));
                named.map_or_else(Self::default, |schema| Self::of(schema, components))
            }
            RefOr::T(Schema::Object(object)) => Self::of_object(object),
            RefOr::T(Schema::AllOf(all)) => {
                let mut fields = Self::default();
                for item in &all.items {
                    fields.add(&Self::of(item, components), true);
                }
                fields
            }
            RefOr::T(Schema::OneOf(one)) => {
                let mut kinds = one.items.iter().map(|item| Self::of(item, components));
                let mut fields = kinds.next().unwrap_or_default();
                for kind in kinds {
                    fields.add(&kind, false);
                }
                fields
            }
            RefOr::T(_) => Self::default(),
        }
    }

    /// Takes in those of another: both are there, or else one of the two.
    fn add(&mut self, other: &Self, both: bool) {
        for (name, property) in &other.properties {
            match self.properties.get_mut(name) {
                Some(known) => widen(known, property),
                None => {
                    self.properties.insert(name.clone(), property.clone());
                }
            }
        }
        if both {
            self.required.extend(other.required.iter().cloned());
        } else {
            self.required.retain(|name| other.required.contains(name));
        }
    }

    /// The word by which the kind is told.
    fn word(&self) -> Option<String> {
        match self.properties.get(TAG)? {
            RefOr::T(Schema::Object(tag)) => {
                let word = tag.enum_values.as_ref()?.first()?;
                word.as_str().map(str::to_string)
            }
            _ => None,
        }
    }

    fn into_object(self, description: Option<String>) -> Object {
        let mut object = ObjectBuilder::new()
            .schema_type(Type::Object)
            .description(description);
        for (name, property) in self.properties {
            object = object.property(name, property);
        }
        for name in self.required {
            object = object.required(name);
        }
        object.build()
    }
}

/// A property that two kinds have: where it is a word, it may be that of either.
fn widen(known: &mut RefOr<Schema>, other: &RefOr<Schema>) {
    if let (RefOr::T(Schema::Object(known)), RefOr::T(Schema::Object(other))) = (known, other)
        && let (Some(words), Some(more)) = (&mut known.enum_values, &other.enum_values)
    {
        let new: Vec<Value> = more
            .iter()
            .filter(|word| !words.contains(word))
            .cloned()
            .collect();
        words.extend(new);
    }
}

fn described(schema: &RefOr<Schema>) -> Option<String> {
    match schema {
        RefOr::T(Schema::Object(object)) => object.description.clone(),
        RefOr::T(Schema::AllOf(all)) => all.description.clone(),
        RefOr::T(Schema::OneOf(one)) => one.description.clone(),
        _ => None,
    }
}

fn in_camel_case(word: &str) -> String {
    let capital = |part: &str| {
        let (first, rest) = part.split_at(part.len().min(1));
        first.to_uppercase() + rest
    };
    word.split('_').map(capital).collect()
}
