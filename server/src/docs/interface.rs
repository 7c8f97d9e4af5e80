//! The description of the HTTP interface (OpenAPI) as a page: operations by subject, with what goes in and what comes out.

use std::fmt::Write as _;

use serde_json::Value;
use triad_lessons::rendering::html::escape;

use super::article::{Article, Section, place};

/// What one does to an address.
const METHODS: [&str; 5] = ["get", "post", "put", "patch", "delete"];
/// Members of a body that are listed; of larger ones the rest is in the description itself.
const MAX_MEMBERS: usize = 24;

/// The page.
pub(super) fn article(document: &Value) -> Article {
    let mut article = Article::default();
    let about = text(&document["info"]["description"]);
    let _ = write!(
        article.html,
        "<h1>HTTP interface</h1>\n<p>{}</p>\n<p>The page of the workbench uses nothing else. The same for programs: \
         <code>/api/openapi.json</code> of a running workbench, OpenAPI 3.1.</p>\n",
        escape(about)
    );
    article.sections.push(section("", "HTTP interface", 1, about));
    for tag in document["tags"].as_array().into_iter().flatten() {
        let (name, about) = (text(&tag["name"]), text(&tag["description"]));
        let id = place(name);
        let _ = write!(article.html, "<h2 id=\"{id}\">{}</h2>\n<p>{}</p>\n", capital(name), escape(about));
        article.sections.push(section(&id, &capital(name), 2, about));
        for (path, methods) in document["paths"].as_object().into_iter().flatten() {
            for method in METHODS {
                let operation = &methods[method];
                let first = operation["tags"].get(0).map_or("", text);
                if operation.is_object() && first == name {
                    write_operation(document, method, path, operation, &mut article);
                }
            }
        }
    }
    article
}

fn section(id: &str, heading: &str, level: usize, words: &str) -> Section {
    Section { id: id.to_owned(), heading: heading.to_owned(), level, words: words.to_owned() }
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

fn write_operation(document: &Value, method: &str, path: &str, operation: &Value, article: &mut Article) {
    let id = place(text(&operation["operationId"]));
    let heading = format!("{} {path}", method.to_uppercase());
    let (summary, about) = (text(&operation["summary"]), text(&operation["description"]));
    let out = &mut article.html;
    let _ = write!(
        out,
        "<h3 id=\"{id}\"><code><b>{}</b> {}</code></h3>\n<p>{}</p>\n",
        method.to_uppercase(),
        escape(path),
        escape(summary)
    );
    if !about.is_empty() {
        let _ = writeln!(out, "<p>{}</p>", escape(about));
    }
    let parameters = operation["parameters"].as_array().into_iter().flatten();
    let rows: Vec<[String; 3]> = parameters
        .map(|parameter| {
            let (name, place) = (text(&parameter["name"]), text(&parameter["in"]));
            let required = if parameter["required"] == Value::Bool(true) { "" } else { ", may be left out" };
            let kind = kind(&parameter["schema"]);
            [
                name.to_owned(),
                format!("{place}, {kind}{required}"),
                text(&parameter["description"]).to_owned(),
            ]
        })
        .collect();
    table("Parameters", &rows, out);
    if let Some(schema) = schema(document, &operation["requestBody"]["content"]) {
        table("Body", &members(document, schema), out);
    }
    for (status, answer) in operation["responses"].as_object().into_iter().flatten() {
        let _ = writeln!(
            out,
            "<p class=\"answer\"><b>{}</b> {}</p>",
            escape(status),
            escape(text(&answer["description"]))
        );
        // What every refusal looks like is told once, by the guide to errors.
        if status.starts_with('2')
            && let Some(schema) = schema(document, &answer["content"])
        {
            table("Answer", &members(document, schema), out);
        }
    }
    article.sections.push(section(&id, &heading, 3, &format!("{summary} {about}")));
}

/// The schema of a body in JSON.
fn schema<'a>(document: &'a Value, content: &'a Value) -> Option<&'a Value> {
    Some(resolved(document, content.get("application/json")?.get("schema")?))
}

/// A schema, or that which it refers to.
fn resolved<'a>(document: &'a Value, schema: &'a Value) -> &'a Value {
    let named = schema["$ref"].as_str().and_then(|name| name.strip_prefix('#'));
    named.and_then(|pointer| document.pointer(pointer)).unwrap_or(schema)
}

/// Name, kind and meaning of the members of an object, or of the objects of a list.
fn members(document: &Value, schema: &Value) -> Vec<[String; 3]> {
    let schema = if schema["type"] == "array" { resolved(document, &schema["items"]) } else { schema };
    let required: Vec<&str> = schema["required"].as_array().into_iter().flatten().map(text).collect();
    let members = schema["properties"].as_object().into_iter().flatten();
    members
        .take(MAX_MEMBERS)
        .map(|(name, member)| {
            let optional = if required.contains(&name.as_str()) { "" } else { ", may be missing" };
            let about = text(&member["description"]);
            let about =
                if about.is_empty() { text(&resolved(document, member)["description"]) } else { about };
            [name.clone(), format!("{}{optional}", kind(member)), about.to_owned()]
        })
        .collect()
}

/// The kind of a value, in a word or two.
fn kind(schema: &Value) -> String {
    if let Some(name) = schema["$ref"].as_str() {
        return name.rsplit('/').next().unwrap_or(name).to_owned();
    }
    match &schema["type"] {
        Value::String(kind) if kind == "array" => format!("list of {}", kind_of_items(schema)),
        Value::String(kind) => kind.clone(),
        Value::Array(kinds) => {
            kinds.iter().map(text).filter(|kind| *kind != "null").collect::<Vec<_>>().join(" or ")
        }
        _ => {
            let choices = ["oneOf", "anyOf"].into_iter().filter_map(|key| schema[key].as_array()).flatten();
            let mut kinds: Vec<String> =
                choices.filter(|choice| choice["type"] != "null").map(kind).collect();
            kinds.dedup();
            if kinds.is_empty() { "any".to_owned() } else { kinds.join(" or ") }
        }
    }
}

fn kind_of_items(schema: &Value) -> String {
    kind(&schema["items"])
}

fn table(caption: &str, rows: &[[String; 3]], out: &mut String) {
    if rows.is_empty() {
        return;
    }
    let _ = write!(
        out,
        "<div class=\"scroll\" tabindex=\"0\"><table><caption>{caption}</caption><thead><tr><th scope=\"col\">name</th>\
         <th scope=\"col\">kind</th><th scope=\"col\">meaning</th></tr></thead><tbody>"
    );
    for [name, kind, about] in rows {
        let _ = write!(
            out,
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>",
            escape(name),
            escape(kind),
            escape(about)
        );
    }
    out.push_str("</tbody></table></div>\n");
}
