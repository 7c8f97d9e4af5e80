//! The schemas of the interface's description, derived from the types that are read and sent.
//!
//! A JSON Schema of 2020-12 is a schema of OpenAPI 3.1, so that one derive, the one that describes scenes and lessons,
//! serves here too.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};
use utoipa::openapi::OpenApi;

/// Where schemas stand in the description.
const PLACE: &str = "#/components/schemas/";

/// The address of the schema of every refusal.
pub(super) const PROBLEM: &str = "#/components/schemas/Problem";

/// The address of a type's schema.
pub(super) fn of<T: JsonSchema>() -> String {
    format!("{PLACE}{}", T::schema_name())
}

/// The schemas of all types that the interface reads and sends.
pub(super) struct Schemas {
    requests: SchemaGenerator,
    answers: SchemaGenerator,
}

impl Schemas {
    /// None yet.
    pub(super) fn new() -> Self {
        let settings = SchemaSettings::draft2020_12().with(|settings| {
            settings.definitions_path = PLACE.into();
            settings.meta_schema = None;
        });
        Self {
            requests: settings.clone().for_deserialize().into_generator(),
            answers: settings.for_serialize().into_generator(),
        }
    }

    /// Adds a type that is read.
    pub(super) fn request<T: JsonSchema>(&mut self) {
        self.requests.subschema_for::<T>();
    }

    /// Adds a type that is sent.
    pub(super) fn answer<T: JsonSchema>(&mut self) {
        self.answers.subschema_for::<T>();
    }

    /// The description of the interface with these schemas.
    ///
    /// A type that is both read and sent is described as it is read: what may be left out is optional.
    pub(super) fn complete(mut self, routes: OpenApi) -> Value {
        let mut document = serde_json::to_value(routes).unwrap_or_default();
        let mut schemas: Map<String, Value> = self.answers.take_definitions(true);
        schemas.extend(self.requests.take_definitions(true));
        for operation in operations(&mut document) {
            require_body(operation, &schemas);
            allow_refusals(operation);
            name_refusals(operation);
        }
        document["components"]["schemas"] = schemas.into();
        document
    }
}

fn operations(document: &mut Value) -> impl Iterator<Item = &mut Value> {
    let paths = document["paths"].as_object_mut().into_iter().flat_map(Map::values_mut);
    paths.filter_map(Value::as_object_mut).flat_map(Map::values_mut)
}

/// A request's body may be left out where everything in it may.
fn require_body(operation: &mut Value, schemas: &Map<String, Value>) {
    if let Some(body) = operation.get_mut("requestBody") {
        let address = body["content"]["application/json"]["schema"]["$ref"].as_str().unwrap_or_default();
        let schema = address.strip_prefix(PLACE).and_then(|name| schemas.get(name));
        let some_required = schema.is_some_and(|schema| schema["required"].is_array());
        body["required"] = some_required.into();
    }
}

/// Any request may be refused, for what is wrong with it, for who asks, or because the server is full: the statuses that an
/// operation names are those that have a meaning of their own there.
fn allow_refusals(operation: &mut Value) {
    if let Some(answers) = operation["responses"].as_object_mut() {
        let refused = "Refused: `code` says why, `hint` what to do";
        let content = json!({"application/json": {"schema": {"$ref": PROBLEM}}});
        answers.insert("default".to_owned(), json!({"description": refused, "content": content}));
    }
}

/// Refusals have a media type of their own (RFC 9457).
fn name_refusals(operation: &mut Value) {
    let answers = operation["responses"].as_object_mut().into_iter().flatten();
    for (_, answer) in answers.filter(|(status, _)| !status.starts_with('2')) {
        if let Some(content) = answer.get_mut("content").and_then(Value::as_object_mut)
            && let Some(schema) = content.remove("application/json")
        {
            content.insert("application/problem+json".to_owned(), schema);
        }
    }
}
