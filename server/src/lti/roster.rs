//! The people of a course of the platform, taken over before they have come.

use axum::http::{HeaderMap, header};
use serde::Deserialize;

use super::Lti;
use super::claims::{named, nameless};
use super::roles::role;
use super::services::{Asked, PEOPLE, Unserved};
use crate::policy::Moment;
use crate::store::{Context, Platform, Role, Store};

/// Most pages of a roster: platforms send fifty people or more on each.
const PAGES: usize = 200;
/// Media type of a roster.
const MEDIA: &str = "application/vnd.ims.lti-nrps.v2.membershipcontainer+json";

#[derive(Deserialize)]
struct Page {
    #[serde(default)]
    members: Vec<Listed>,
}

#[derive(Deserialize)]
struct Listed {
    user_id: String,
    #[serde(default)]
    roles: Vec<String>,
    status: Option<String>,
    name: Option<String>,
    given_name: Option<String>,
    family_name: Option<String>,
}

impl Lti {
    /// Those who are active in a course of the platform: what it calls them, name and role.
    ///
    /// Errors if it does not list them.
    pub async fn roster(
        &self,
        store: &Store,
        platform: &Platform,
        context: &Context,
        now: Moment,
    ) -> Result<Vec<(String, String, Role)>, Unserved> {
        let mut people = Vec::new();
        let mut next = Some(context.members.clone());
        for _ in 0..PAGES {
            let Some(url) = next else { return Ok(people) };
            let asked = Asked { scope: PEOPLE, url: &url, media: MEDIA, body: None };
            let answer = self.ask(store, platform, asked, now).await?;
            if !answer.status.is_success() {
                return Err(Unserved::Ours(format!(
                    "the platform does not list its people: it answers {}",
                    answer.status.as_u16()
                )));
            }
            let page: Page = serde_json::from_slice(&answer.body)
                .map_err(|_| Unserved::Ours("the platform's list of people cannot be read".to_owned()))?;
            let active =
                page.members.into_iter().filter(|one| one.status.as_deref().is_none_or(|is| is == "Active"));
            people.extend(active.filter(|one| !one.user_id.is_empty()).map(|one| {
                let name = named(one.name.as_deref(), one.given_name.as_deref(), one.family_name.as_deref());
                let name = name.unwrap_or_else(|| nameless(&platform.id, &one.user_id));
                (one.user_id, name, role(&one.roles))
            }));
            next = following(&answer.headers);
        }
        Err(Unserved::Ours(format!("the platform's list of people has more than {PAGES} pages")))
    }
}

/// The page after this one (RFC 8288).
fn following(headers: &HeaderMap) -> Option<String> {
    let links = headers.get_all(header::LINK).iter().filter_map(|value| value.to_str().ok());
    // An address may hold a comma, but not the bracket before it.
    let links = links.flat_map(|list| list.split('<').skip(1)).filter_map(|link| link.split_once('>'));
    let mut next = links.filter(|(_, rest)| {
        let this = rest.split(',').next().unwrap_or_default().replace(['"', ' '], "");
        this.split(';').any(|parameter| parameter.eq_ignore_ascii_case("rel=next"))
    });
    next.next().map(|(url, _)| url.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::HeaderValue;

    #[test]
    fn the_next_page_is_found_among_other_links() {
        let of = |text: &'static str| {
            let mut headers = HeaderMap::new();
            headers.insert(header::LINK, HeaderValue::from_static(text));
            following(&headers)
        };
        let found =
            of("<https://a.example/x?p=1,2>; rel=\"differences\", <https://a.example/x?p=2>; rel=\"next\"");
        assert_eq!(found.as_deref(), Some("https://a.example/x?p=2"));
        assert_eq!(of("<https://a.example/1>;rel=next").as_deref(), Some("https://a.example/1"));
        assert_eq!(of("<https://a.example/1>; rel=\"first\""), None);
        assert_eq!(following(&HeaderMap::new()), None);
    }
}
