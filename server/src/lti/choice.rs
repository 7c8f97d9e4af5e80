//! Lessons that a teacher chose in the platform, as the platform takes them (Deep Linking 2.0).

use serde_json::{Value, json};
use triad_lessons::Lesson;

use super::ticket::Choosing;
use super::{Lti, keys};
use crate::grades::possible;
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::{Platform, Store, identifier};

/// How long our answer is good, in seconds.
const ANSWER: i64 = 300;

impl Lti {
    /// The signed answer: links to the lessons, each with a column of its own where it can earn points.
    ///
    /// Errors if the gradebook fails.
    pub async fn chosen(
        &self,
        store: &Store,
        platform: &Platform,
        choosing: &Choosing,
        lessons: &[&Lesson],
        now: Moment,
    ) -> Result<String, Problem> {
        let items: Vec<Value> = lessons.iter().map(|lesson| self.item(lesson, choosing.columns)).collect();
        let seconds = now.0 / 1000;
        let mut said = json!({
            "iss": platform.client_id, "aud": [platform.issuer], "iat": seconds, "exp": seconds + ANSWER,
            "nonce": identifier(),
            "https://purl.imsglobal.org/spec/lti/claim/deployment_id": choosing.deployment,
            "https://purl.imsglobal.org/spec/lti/claim/message_type": "LtiDeepLinkingResponse",
            "https://purl.imsglobal.org/spec/lti/claim/version": "1.3.0",
            "https://purl.imsglobal.org/spec/lti-dl/claim/content_items": items,
        });
        if let Some(data) = &choosing.data {
            said["https://purl.imsglobal.org/spec/lti-dl/claim/data"] = json!(data);
        }
        keys::sign(store, &said).await
    }

    fn item(&self, lesson: &Lesson, columns: bool) -> Value {
        let mut item = json!({
            "type": "ltiResourceLink",
            "title": lesson.about.title,
            "url": self.url(&format!("/lessons/{}", lesson.slug)),
            "custom": {"lesson": lesson.slug},
        });
        if columns && possible(lesson) > 0.0 {
            item["lineItem"] = column(lesson);
        }
        item
    }
}

/// A column for a lesson's scores. By `resourceId` it is found again.
pub(super) fn column(lesson: &Lesson) -> Value {
    json!({
        "label": lesson.about.title, "scoreMaximum": possible(lesson), "resourceId": lesson.slug, "tag": "triad",
    })
}
