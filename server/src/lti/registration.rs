//! What a platform has to be told of us, and we of it.

use serde::Serialize;
use serde_json::{Value, json};

use super::address::origin;
use super::services::{LINE_ITEM, PEOPLE, SCORE};
use crate::store::Platform;
use crate::store::hash::sha256;

/// What is said of a platform as it is registered.
#[derive(Debug, Clone)]
pub struct Registration {
    /// What it calls itself.
    pub issuer: String,
    /// What it calls us.
    pub client_id: String,
    /// Where its keys are.
    pub keys_url: String,
    /// Where a browser is sent to be known.
    pub login_url: String,
    /// Where we get tokens.
    pub token_url: String,
    /// For whom our proof towards that place is made, where it is not the place itself.
    pub audience: Option<String>,
    /// Other origins at which its services are.
    pub services: Vec<String>,
    /// Its deployments that may send people.
    pub deployments: Vec<String>,
}

impl Registration {
    /// The platform, with an id that follows from issuer and client.
    ///
    /// Errors with the first that is wrong, and why.
    pub fn check(self) -> Result<Platform, (&'static str, String)> {
        for (what, text) in [("--issuer", &self.issuer), ("--client-id", &self.client_id)] {
            if text.trim().is_empty() || text.chars().any(char::is_control) {
                return Err((what, "it is empty".to_owned()));
            }
        }
        let mut services = Vec::new();
        let addresses = [
            ("--jwks-url", &self.keys_url),
            ("--login-url", &self.login_url),
            ("--token-url", &self.token_url),
        ];
        let named = self.services.iter().map(|one| ("--service", one));
        for (what, text) in addresses.into_iter().chain(named) {
            let found = origin(text).ok_or_else(|| {
                (what, format!("\"{text}\" is no address with https:// (http:// only on this machine)"))
            })?;
            if !services.contains(&found) {
                services.push(found);
            }
        }
        if let Some(own) = origin(&self.issuer).filter(|own| !services.contains(own)) {
            services.push(own);
        }
        if self.deployments.is_empty() {
            return Err(("--deployment", "at least one is needed".to_owned()));
        }
        let id = sha256(&json!([self.issuer, self.client_id]).to_string());
        Ok(Platform {
            id: id.chars().take(16).collect(),
            audience: self.audience.unwrap_or_else(|| self.token_url.clone()),
            issuer: self.issuer,
            client_id: self.client_id,
            keys_url: self.keys_url,
            login_url: self.login_url,
            token_url: self.token_url,
            services,
            deployments: self.deployments,
        })
    }
}

/// Our own addresses: what the platform's settings ask for.
#[derive(Debug, Clone, Serialize)]
pub struct Tool {
    /// "Initiate login URL", "OpenID Connect initiation".
    pub login: String,
    /// "Redirection URI", "Launch URL".
    pub launch: String,
    /// "Tool URL", "Target link URI".
    pub target: String,
    /// "Content selection URL", "Deep linking".
    pub choice: String,
    /// "Public keyset URL".
    pub keys: String,
    /// All of it in the form that Canvas reads.
    pub configuration: String,
}

/// Where those who choose lessons are sent.
pub const CHOICE: &str = "/lti/choice";

impl Tool {
    /// The addresses of a server that is reached at `base`, without a slash at its end.
    pub fn at(base: &str) -> Self {
        let at = |path: &str| format!("{base}{path}");
        Self {
            login: at("/lti/login"),
            launch: at("/lti/launch"),
            target: at("/"),
            choice: at(CHOICE),
            keys: at("/lti/keys"),
            configuration: at("/lti/configuration"),
        }
    }

    /// What Canvas reads at `/lti/configuration`.
    pub fn configuration(&self, title: &str) -> Value {
        let placement = json!({
            "placement": "assignment_selection", "message_type": super::claims::CHOOSES, "target_link_uri": self.choice,
        });
        let link = json!({
            "placement": "link_selection", "message_type": super::claims::CHOOSES, "target_link_uri": self.choice,
        });
        json!({
            "title": title,
            "description": "Lessons and exercises in multibody dynamics",
            "oidc_initiation_url": self.login,
            "target_link_uri": self.target,
            "public_jwk_url": self.keys,
            "scopes": [LINE_ITEM, SCORE, PEOPLE],
            "extensions": [{
                "platform": "canvas.instructure.com",
                "privacy_level": "name_only",
                "settings": {"placements": [placement, link]},
            }],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::address::{is_service, safe};
    use super::*;

    fn registration() -> Registration {
        Registration {
            issuer: "https://lms.example".into(),
            client_id: "42".into(),
            keys_url: "https://lms.example/keys".into(),
            login_url: "https://lms.example/auth".into(),
            token_url: "https://sso.example/token".into(),
            audience: None,
            services: vec!["https://school.example/any/path".into()],
            deployments: vec!["1".into()],
        }
    }

    #[test]
    fn services_are_asked_where_they_were_registered() {
        let platform = registration().check().expect("a platform");
        assert_eq!(
            platform.services,
            ["https://lms.example", "https://sso.example", "https://school.example"]
        );
        assert_eq!(platform.audience, "https://sso.example/token");
        assert!(is_service(&platform, "https://school.example/api/lti/courses/1/line_items?page=2"));
        for other in [
            "https://school.example:8443/x",
            "http://lms.example/x",
            "https://lms.example@evil.example/x",
            "https://a:b@lms.example/x",
            "https://lms.example.evil.example/",
            "file:///etc/passwd",
            "",
        ] {
            assert!(!is_service(&platform, other), "{other}");
        }
    }

    #[test]
    fn what_is_registered_is_encrypted_or_of_this_machine() {
        for here in ["http://127.0.0.1:1/x", "http://[::1]:1/x", "http://localhost:1/x"] {
            assert!(safe(here).is_some(), "{here}");
        }
        let mut wrong = registration();
        wrong.keys_url = "http://lms.example/keys".into();
        assert_eq!(wrong.check().unwrap_err().0, "--jwks-url");
        let mut wrong = registration();
        wrong.deployments.clear();
        assert_eq!(wrong.check().unwrap_err().0, "--deployment");
        let mut wrong = registration();
        wrong.client_id = " ".into();
        assert_eq!(wrong.check().unwrap_err().0, "--client-id");
    }
}
