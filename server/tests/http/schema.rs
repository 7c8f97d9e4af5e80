//! Whether a JSON value is what the interface's description says: the keywords of JSON Schema that it uses.

use serde_json::{Map, Value};

/// What contradicts a schema of the description, with the place in the value; nothing if it fits.
pub fn contradictions(document: &Value, schema: &Value, value: &Value) -> Vec<String> {
    let mut found = Vec::new();
    Check { document }.value(schema, value, "", &mut found);
    found
}

struct Check<'a> {
    document: &'a Value,
}

impl Check<'_> {
    fn value(&self, schema: &Value, value: &Value, place: &str, found: &mut Vec<String>) {
        let Some(schema) = schema.as_object() else {
            assert_eq!(schema, &Value::Bool(true), "a schema at {place}");
            return;
        };
        let mut refuse = |what: String| found.push(format!("{place}: {what}: {value}"));
        for (keyword, said) in schema {
            match keyword.as_str() {
                "type" if !of_type(said, value) => refuse(format!("is no {said}")),
                "const" if said != value => refuse(format!("is not {said}")),
                "enum" if !said.as_array().is_some_and(|all| all.contains(value)) => {
                    refuse(format!("is none of {said}"));
                }
                "minimum" if value.as_f64().zip(said.as_f64()).is_some_and(|(v, least)| v < least) => {
                    refuse(format!("is below {said}"));
                }
                "minItems" if value.as_array().map(|list| list.len() as u64) < said.as_u64() => {
                    refuse(format!("has less than {said} items"));
                }
                "maxItems" if value.as_array().map(|list| list.len() as u64) > said.as_u64() => {
                    refuse(format!("has more than {said} items"));
                }
                "oneOf" | "anyOf" => {
                    let fits =
                        said.as_array().into_iter().flatten().filter(|one| self.fits(one, value)).count();
                    if fits == 0 || (keyword == "oneOf" && fits > 1) {
                        refuse(format!("fits {fits} of {said}"));
                    }
                }
                _ => {}
            }
        }
        if let Some(address) = schema.get("$ref").and_then(Value::as_str) {
            let target = self.document.pointer(&address[1..]).expect("a schema that exists");
            self.value(target, value, place, found);
        }
        for all in schema.get("allOf").and_then(Value::as_array).into_iter().flatten() {
            self.value(all, value, place, found);
        }
        match value {
            Value::Object(members) => self.object(schema, members, place, found),
            Value::Array(items) => {
                let first = schema.get("prefixItems").and_then(Value::as_array).into_iter().flatten();
                let rest = std::iter::repeat(schema.get("items").unwrap_or(&Value::Bool(true)));
                for (index, (item, one)) in items.iter().zip(first.chain(rest)).enumerate() {
                    self.value(one, item, &format!("{place}/{index}"), found);
                }
            }
            _ => {}
        }
    }

    fn object(
        &self,
        schema: &Map<String, Value>,
        value: &Map<String, Value>,
        place: &str,
        found: &mut Vec<String>,
    ) {
        let named = schema.get("properties").and_then(Value::as_object);
        for required in schema.get("required").and_then(Value::as_array).into_iter().flatten() {
            if required.as_str().is_some_and(|name| !value.contains_key(name)) {
                found.push(format!("{place} has no {required}"));
            }
        }
        for (name, member) in value {
            let place = format!("{place}/{name}");
            match named.and_then(|all| all.get(name)).or(schema.get("additionalProperties")) {
                Some(Value::Bool(false)) => found.push(format!("{place} is not described")),
                Some(one) => self.value(one, member, &place, found),
                // A member that no schema mentions would be missing in the types of the page.
                None if named.is_some() && !schema.contains_key("oneOf") && !schema.contains_key("allOf") => {
                    found.push(format!("{place} is not described"));
                }
                None => {}
            }
        }
    }

    fn fits(&self, schema: &Value, value: &Value) -> bool {
        let mut found = Vec::new();
        self.value(schema, value, "", &mut found);
        found.is_empty()
    }
}

fn of_type(said: &Value, value: &Value) -> bool {
    let is = |kind: &Value| match kind.as_str().unwrap_or_default() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("a type {other}"),
    };
    said.as_array().map_or_else(|| is(said), |kinds| kinds.iter().any(is))
}
