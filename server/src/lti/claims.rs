//! What a platform says in a signed word, as LTI Core 1.3 and its services name it.

use serde::Deserialize;
use serde_json::{Map, Value};

/// The message of somebody who opens a link.
pub const OPENS: &str = "LtiResourceLinkRequest";
/// The message of somebody who chooses what to link.
pub const CHOOSES: &str = "LtiDeepLinkingRequest";

/// One or several.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub enum OneOrMany {
    /// One.
    One(String),
    /// Several.
    Many(Vec<String>),
}

impl OneOrMany {
    /// All of them.
    pub fn all(&self) -> &[String] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Many(many) => many,
        }
    }
}

/// The claims that we read; whether they are there is asked where they are needed.
#[derive(Debug, Clone, Deserialize)]
pub struct Claims {
    /// Who says it.
    pub iss: Option<String>,
    /// For whom.
    pub aud: Option<OneOrMany>,
    /// Who of those may use it.
    pub azp: Option<String>,
    /// About whom.
    pub sub: Option<String>,
    /// Until when, in seconds since 1970.
    pub exp: Option<f64>,
    /// Since when.
    pub iat: Option<f64>,
    /// Not before.
    pub nbf: Option<f64>,
    /// What it answers.
    pub nonce: Option<String>,
    /// The person's name.
    pub name: Option<String>,
    /// The first name.
    pub given_name: Option<String>,
    /// The last name.
    pub family_name: Option<String>,
    /// What kind of message it is.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/message_type")]
    pub message: Option<String>,
    /// Of which version.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/version")]
    pub version: Option<String>,
    /// Of which of its deployments.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/deployment_id")]
    pub deployment: Option<String>,
    /// What is to be opened.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/target_link_uri")]
    pub target: Option<String>,
    /// The link that was followed.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/resource_link")]
    pub link: Option<Link>,
    /// What the person is.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/roles", default)]
    pub roles: Vec<String>,
    /// The course.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/context")]
    pub context: Option<Course>,
    /// What we gave along when the link was chosen.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/custom", default)]
    pub custom: Map<String, Value>,
    /// Where scores go.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint")]
    pub scores: Option<Scores>,
    /// Where people are listed.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice")]
    pub people: Option<People>,
    /// How lessons are to be chosen.
    #[serde(rename = "https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings")]
    pub choosing: Option<Choosing>,
}

/// A link in a course.
#[derive(Debug, Clone, Deserialize)]
pub struct Link {
    /// What the platform calls it.
    pub id: String,
}

/// A course of the platform.
#[derive(Debug, Clone, Deserialize)]
pub struct Course {
    /// What the platform calls it.
    pub id: String,
    /// Its short title.
    pub label: Option<String>,
    /// Its title.
    pub title: Option<String>,
}

/// Assignment and Grade Services.
#[derive(Debug, Clone, Deserialize)]
pub struct Scores {
    /// What we may.
    #[serde(default)]
    pub scope: Vec<String>,
    /// All columns that are ours.
    pub lineitems: Option<String>,
    /// The column of this link.
    pub lineitem: Option<String>,
}

/// Names and Role Provisioning Services.
#[derive(Debug, Clone, Deserialize)]
pub struct People {
    /// Where they are listed.
    pub context_memberships_url: String,
}

/// How lessons are to be chosen.
#[derive(Debug, Clone, Deserialize)]
pub struct Choosing {
    /// Where the choice goes.
    pub deep_link_return_url: String,
    /// What may be chosen.
    pub accept_types: Vec<String>,
    /// Whether more than one.
    pub accept_multiple: Option<bool>,
    /// Whether with a column.
    pub accept_lineitem: Option<bool>,
    /// What is to be given back as it is.
    pub data: Option<String>,
}

impl Claims {
    /// The name by which others know the person, if the platform tells it.
    pub fn shown_name(&self) -> Option<String> {
        named(self.name.as_deref(), self.given_name.as_deref(), self.family_name.as_deref())
    }
}

/// A name from its parts, as it is shown.
pub fn named(whole: Option<&str>, given: Option<&str>, family: Option<&str>) -> Option<String> {
    let parts = format!("{} {}", given.unwrap_or_default(), family.unwrap_or_default());
    let shown = [whole.unwrap_or_default(), parts.as_str()].map(crate::store::names::shown);
    let name = shown.into_iter().find(|name| !name.is_empty())?;
    // Room for the number of a namesake.
    Some(name.chars().take(crate::store::names::LONGEST - 8).collect())
}

/// What somebody is called whose name is not told: the same each time.
pub fn nameless(platform: &str, subject: &str) -> String {
    let hash = crate::store::hash::sha256(&serde_json::json!([platform, subject]).to_string());
    format!("Participant {}", &hash[..6])
}
