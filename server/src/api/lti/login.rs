//! The first step of a launch: the platform says that somebody is coming, and we ask it who.

use axum::Form;
use axum::extract::{Query, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use url::Url;

use super::{lti, page};
use crate::app::App;
use crate::lti::refusal::{Refusal, shortened};
use crate::lti::registration::CHOICE;
use crate::lti::ticket::{self, Begun, LAUNCH};
use crate::lti::{Lti, platform};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::hash::sha256;
use crate::store::{identifier, secret};

/// Longest hint of a platform, in bytes: it is handed back in an address.
const LONGEST: usize = 8 << 10;

/// What the platform sends (Security Framework 5.1.1.1, LTI Core 4.1).
#[derive(Debug, Clone, Default, Deserialize)]
#[allow(clippy::struct_field_names, reason = "words of the standard")]
pub(super) struct Login {
    iss: Option<String>,
    login_hint: Option<String>,
    target_link_uri: Option<String>,
    lti_message_hint: Option<String>,
    client_id: Option<String>,
    lti_deployment_id: Option<String>,
}

pub(super) async fn by_address(
    State(app): State<App>,
    headers: HeaderMap,
    Query(login): Query<Login>,
) -> Response {
    begin(&app, &headers, &login).await.unwrap_or_else(|problem| page::refused(problem, &headers, ""))
}

pub(super) async fn by_form(
    State(app): State<App>,
    headers: HeaderMap,
    Form(login): Form<Login>,
) -> Response {
    begin(&app, &headers, &login).await.unwrap_or_else(|problem| page::refused(problem, &headers, ""))
}

async fn begin(app: &App, headers: &HeaderMap, login: &Login) -> Result<Response, Problem> {
    let lti = lti(app)?;
    let required = |value: &Option<String>, what| {
        value.clone().filter(|text| !text.is_empty()).ok_or(Refusal::Missing(what))
    };
    let issuer = required(&login.iss, "who it is (iss)")?;
    let hint = required(&login.login_hint, "who is coming (login_hint)")?;
    let target = required(&login.target_link_uri, "what is to be opened (target_link_uri)")?;
    let sizes = [&hint, login.lti_message_hint.as_ref().unwrap_or(&hint), &target];
    if sizes.iter().any(|text| text.len() > LONGEST) {
        return Err(Refusal::TooLong(LONGEST).into());
    }
    let platform = platform(&app.store, &issuer, login.client_id.as_deref()).await??;
    if let Some(deployment) = login.lti_deployment_id.as_ref().filter(|id| !platform.deployments.contains(id))
    {
        return Err(Refusal::Deployment(shortened(deployment)).into());
    }
    let chooses = lti.own_path(&target)? == CHOICE;
    let is_framed = is_framed(headers);
    if is_framed && !chooses {
        return Ok(in_a_window(lti, login));
    }
    let browser = if is_framed { String::new() } else { secret() };
    let begun = Begun {
        platform: platform.id.clone(),
        nonce: identifier(),
        browser: if is_framed { String::new() } else { sha256(&browser) },
    };
    let state = ticket::write(lti.secret(), &begun, Moment::now())
        .ok_or_else(|| Problem::internal("a ticket could not be written"))?;
    let mut to = Url::parse(&platform.login_url).map_err(Problem::internal)?;
    {
        let mut query = to.query_pairs_mut();
        for (name, value) in [
            ("scope", "openid"),
            ("response_type", "id_token"),
            ("response_mode", "form_post"),
            ("prompt", "none"),
            ("client_id", &platform.client_id),
            ("redirect_uri", &lti.url("/lti/launch")),
            ("login_hint", &hint),
            ("state", &state),
            ("nonce", &begun.nonce),
        ] {
            query.append_pair(name, value);
        }
        if let Some(hint) = &login.lti_message_hint {
            query.append_pair("lti_message_hint", hint);
        }
    }
    let mut answer = (StatusCode::FOUND, [(header::CACHE_CONTROL, "no-store")]).into_response();
    let location = HeaderValue::from_str(to.as_str()).map_err(Problem::internal)?;
    answer.headers_mut().insert(header::LOCATION, location);
    if !browser.is_empty() {
        let set = given(lti, &begun.nonce, &browser, LAUNCH / 1000)?;
        answer.headers_mut().append(header::SET_COOKIE, set);
    }
    Ok(answer)
}

/// The cookie by which the browser is known again that began a launch. The platform's answer comes from the platform's page:
/// browsers send with it what is marked for that alone.
pub(super) fn given(lti: &Lti, nonce: &str, value: &str, seconds: i64) -> Result<HeaderValue, Problem> {
    let name = cookie_name(lti, nonce);
    HeaderValue::from_str(&format!(
        "{name}={value}; Max-Age={seconds}; Path=/; HttpOnly; SameSite=None; Secure"
    ))
    .map_err(Problem::internal)
}

/// Several launches may be under way in one browser.
pub(super) fn cookie_name(lti: &Lti, nonce: &str) -> String {
    let prefix = lti.cookie_prefix();
    format!("{prefix}triad-lti-{}", nonce.get(..8).unwrap_or_default())
}

/// Whether what is answered is shown in a frame of another page.
pub(super) fn is_framed(headers: &HeaderMap) -> bool {
    let wanted = headers.get("sec-fetch-dest").and_then(|value| value.to_str().ok());
    wanted.is_some_and(|wanted| matches!(wanted, "iframe" | "frame" | "embed" | "object"))
}

/// In a frame of the platform browsers keep nothing of ours: the launch begins anew in a window of its own.
fn in_a_window(lti: &Lti, login: &Login) -> Response {
    let fields = [
        ("iss", &login.iss),
        ("login_hint", &login.login_hint),
        ("target_link_uri", &login.target_link_uri),
        ("lti_message_hint", &login.lti_message_hint),
        ("client_id", &login.client_id),
        ("lti_deployment_id", &login.lti_deployment_id),
    ];
    let fields: Vec<(&str, &str)> =
        fields.iter().filter_map(|(name, value)| Some((*name, value.as_deref()?))).collect();
    let form = page::form(&lti.url("/lti/login"), " target=\"_blank\"", &fields, "Open the lesson");
    let body = format!("<p>Your course opens this lesson in a window of its own.</p>{form}");
    page::page(StatusCode::OK, "Triad", &body)
}
