//! The second step of a launch: the platform's signed word, and who comes in by it.

use std::fmt::Write;

use axum::Form;
use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use triad_lessons::Lesson;

use super::login::{cookie_name, given};
use super::{lti, page};
use crate::api::class::sign_in;
use crate::api::guard::Peer;
use crate::app::App;
use crate::grades::possible;
use crate::lti::claims::{CHOOSES, Claims, OPENS, nameless};
use crate::lti::refusal::{Refusal, shortened};
use crate::lti::registration::CHOICE;
use crate::lti::roles::role;
use crate::lti::services::{LINE_ITEM, SCORE};
use crate::lti::ticket::{self, Begun, Choosing};
use crate::lti::{Lti, address, verify};
use crate::policy::Moment;
use crate::problem::Problem;
use crate::store::hash::sha256;
use crate::store::{Admission, Arrival, CLASS, Context, LIFE, Platform, Role};

/// What comes with the platform's answer.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Launch {
    id_token: Option<String>,
    state: Option<String>,
    error: Option<String>,
    error_description: Option<String>,
}

pub(super) async fn launch(
    State(app): State<App>,
    Peer(address): Peer,
    headers: HeaderMap,
    Form(launch): Form<Launch>,
) -> Response {
    let answer = async {
        app.access.check_tries(address)?;
        let lti = lti(&app)?;
        let begun = begun(lti, &launch, &headers)?;
        let platforms = app.store.platforms(CLASS).await?;
        let platform = platforms.into_iter().find(|one| one.id == begun.platform).ok_or(Refusal::State)?;
        let claims = word(lti, &platform, &launch, &begun).await?;
        match claims.message.as_deref().ok_or(Refusal::Missing("what it sends (message_type)"))? {
            OPENS if begun.browser.is_empty() => Err(Refusal::Browser.into()),
            OPENS => opened(&app, lti, &platform, &claims, &begun).await,
            CHOOSES => offered(&app, lti, &platform, &claims).await,
            other => Err(Problem::from(Refusal::Message(shortened(other)))),
        }
    };
    answer.await.unwrap_or_else(|problem| page::refused(problem, &headers, ""))
}

/// The launch that this answers, in the browser in which it was begun.
fn begun(lti: &Lti, launch: &Launch, headers: &HeaderMap) -> Result<Begun, Refusal> {
    let state = launch.state.as_deref().ok_or(Refusal::State)?;
    if state.len() > verify::LONGEST {
        return Err(Refusal::TooLong(verify::LONGEST));
    }
    let begun: Begun = ticket::read(lti.secret(), state, Moment::now()).ok_or(Refusal::State)?;
    if begun.browser.is_empty() {
        return Ok(begun);
    }
    let name = cookie_name(lti, &begun.nonce);
    let lists = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut pairs = lists.flat_map(|list| list.split(';')).filter_map(|pair| pair.trim().split_once('='));
    let is_same = pairs.any(|(key, value)| key == name && sha256(value) == begun.browser);
    if is_same { Ok(begun) } else { Err(Refusal::Browser) }
}

/// What the platform says, proved to be its own and of now.
async fn word(lti: &Lti, platform: &Platform, launch: &Launch, begun: &Begun) -> Result<Claims, Refusal> {
    if let Some(error) = &launch.error {
        let said = launch.error_description.as_deref().unwrap_or_default();
        return Err(Refusal::Reported(shortened(&format!("{error} {said}"))));
    }
    let token = launch.id_token.as_deref().ok_or(Refusal::Missing("who comes (id_token)"))?;
    let name = verify::key_name(token)?;
    let now = Moment::now();
    let keys = lti.keys_of(platform, Some(&name), now).await?;
    let claims = verify::signed(token, &name, &keys)?;
    verify::meant(&claims, platform, &begun.nonce, now)?;
    Ok(claims)
}

/// Somebody opens a lesson: they are in, and their browser goes there.
async fn opened(
    app: &App,
    lti: &Lti,
    platform: &Platform,
    claims: &Claims,
    begun: &Begun,
) -> Result<Response, Problem> {
    let link = claims.link.as_ref().filter(|link| !link.id.is_empty());
    link.ok_or(Refusal::Missing("which link was followed (resource_link)"))?;
    let target =
        claims.target.as_deref().ok_or(Refusal::Missing("what is to be opened (target_link_uri)"))?;
    let (path, lesson) = wanted(app, lti, target, claims)?;
    let mut arrival = arrival(platform, claims)?;
    arrival.column = lesson.and_then(|lesson| Some((lesson.slug.clone(), column(claims)?)));
    let member = match app.store.arrive(CLASS, &arrival).await? {
        Admission::In(member) => member,
        refused => return Err(admission(refused).into()),
    };
    let token = app.store.begin_session(&member.id).await?;
    let mut answer = (StatusCode::SEE_OTHER, [(header::CACHE_CONTROL, "no-store")]).into_response();
    let location = HeaderValue::from_str(&lti.url(&path)).map_err(Problem::internal)?;
    answer.headers_mut().insert(header::LOCATION, location);
    answer.headers_mut().append(header::SET_COOKIE, sign_in::cookie(app, &token, LIFE / 1000)?);
    answer.headers_mut().append(header::SET_COOKIE, given(lti, &begun.nonce, "", 0)?);
    Ok(answer)
}

fn admission(refused: Admission) -> Refusal {
    match refused {
        Admission::Used | Admission::In(_) => Refusal::Used,
        Admission::NotLinked => Refusal::NotLinked,
        Admission::OtherCourse(title) => Refusal::OtherCourse(title),
    }
}

/// The path that is to be opened, and the lesson if it is one: by the address, else by what we gave along with the link.
fn wanted<'a>(
    app: &'a App,
    lti: &Lti,
    target: &str,
    claims: &Claims,
) -> Result<(String, Option<&'a Lesson>), Problem> {
    let path = lti.own_path(target)?;
    let given = claims.custom.get("lesson").and_then(serde_json::Value::as_str);
    let Some(slug) = path.strip_prefix("/lessons/").or(given.filter(|slug| !slug.is_empty())) else {
        return if path == "/" { Ok((path, None)) } else { Err(Refusal::Target(shortened(target)).into()) };
    };
    let lesson = app.course.lessons().iter().find(|lesson| lesson.slug == slug);
    let lesson = lesson.ok_or_else(|| Refusal::Lesson(shortened(slug)))?;
    Ok((format!("/lessons/{}", lesson.slug), Some(lesson)))
}

/// Where the scores of the link go; empty where a column is still to be found or made.
fn column(claims: &Claims) -> Option<String> {
    let scores = claims.scores.as_ref().filter(|scores| scores.scope.iter().any(|one| one == SCORE))?;
    let may_make = scores.lineitems.is_some() && scores.scope.iter().any(|one| one == LINE_ITEM);
    scores.lineitem.clone().or_else(|| may_make.then(String::new))
}

fn arrival(platform: &Platform, claims: &Claims) -> Result<Arrival, Refusal> {
    let course = claims.context.as_ref().filter(|course| !course.id.is_empty());
    let course = course.ok_or(Refusal::Missing("from which course somebody comes (context)"))?;
    let title = [&course.title, &course.label].into_iter().flatten().find(|text| !text.is_empty());
    let scores = claims.scores.as_ref().filter(|scores| scores.scope.iter().any(|one| one == LINE_ITEM));
    let subject = claims.sub.clone().ok_or(Refusal::Missing("who comes (sub)"))?;
    Ok(Arrival {
        platform: platform.id.clone(),
        nonce: (claims.nonce.clone().unwrap_or_default(), word_ends(claims)),
        context: Context {
            id: course.id.clone(),
            title: shortened(title.unwrap_or(&course.id)),
            line_items: scores.and_then(|scores| scores.lineitems.clone()).unwrap_or_default(),
            members: claims
                .people
                .as_ref()
                .map(|one| one.context_memberships_url.clone())
                .unwrap_or_default(),
        },
        name: claims.shown_name().unwrap_or_else(|| nameless(&platform.id, &subject)),
        role: role(&claims.roles),
        subject,
        column: None,
    })
}

/// Until when a word could be used again, in milliseconds since 1970: not longer than the ticket that it answers.
fn word_ends(claims: &Claims) -> i64 {
    let now = Moment::now().0;
    #[allow(clippy::cast_possible_truncation, reason = "a time too far away is the latest one")]
    let ends = (claims.exp.unwrap_or_default() * 1000.0) as i64;
    ends.saturating_add(120_000).clamp(now, now.saturating_add(2 * ticket::LAUNCH))
}

/// Somebody who teaches chooses lessons: the list of them.
async fn offered(app: &App, lti: &Lti, platform: &Platform, claims: &Claims) -> Result<Response, Problem> {
    let choosing = claims.choosing.as_ref().ok_or(Refusal::Missing("how lessons are chosen (settings)"))?;
    if !choosing.accept_types.iter().any(|one| one == "ltiResourceLink") {
        return Err(Refusal::Content.into());
    }
    if address::safe(&choosing.deep_link_return_url).is_none() {
        return Err(Refusal::Target(shortened(&choosing.deep_link_return_url)).into());
    }
    let arrival = arrival(platform, claims)?;
    if arrival.role < Role::Instructor {
        return Err(Refusal::NotTeacher.into());
    }
    if let Some(refused) = app.store.take_word(CLASS, &arrival).await? {
        return Err(admission(refused).into());
    }
    let begun = Choosing {
        platform: platform.id.clone(),
        deployment: claims.deployment.clone().unwrap_or_default(),
        return_url: choosing.deep_link_return_url.clone(),
        several: choosing.accept_multiple.unwrap_or(false),
        columns: choosing.accept_lineitem.unwrap_or(true),
        data: choosing.data.clone(),
    };
    let ticket = ticket::write(lti.secret(), &begun, Moment::now())
        .ok_or_else(|| Problem::internal("a ticket could not be written"))?;
    let kind = if begun.several { "checkbox" } else { "radio" };
    let mut list = String::new();
    for lesson in app.course.lessons() {
        let (slug, title) = (page::escaped(&lesson.slug), page::escaped(&lesson.about.title));
        let _ = write!(
            list,
            "<li><label><input type=\"{kind}\" name=\"lesson\" value=\"{slug}\"> <span>{:02} {title} \
             <span class=\"muted\">{} points</span></span></label></li>",
            lesson.number,
            possible(lesson)
        );
    }
    let body = format!(
        "<p>Each lesson that you choose becomes a link in your course{}.</p><form method=\"post\" action=\"{}\">\
         <input type=\"hidden\" name=\"ticket\" value=\"{}\"><ul>{list}</ul><p><button>Add to the course</button></p></form>",
        if begun.columns { ", with a column for its scores" } else { "" },
        page::escaped(&lti.url(CHOICE)),
        page::escaped(&ticket)
    );
    Ok(page::page(StatusCode::OK, "Choose lessons", &body))
}

/// The lessons that were chosen go to the platform, signed.
pub(super) async fn choose(
    State(app): State<App>,
    headers: HeaderMap,
    Form(fields): Form<Vec<(String, String)>>,
) -> Response {
    let answer = async {
        let lti = lti(&app)?;
        let ticket = fields.iter().find(|(name, _)| name == "ticket").map(|(_, value)| value.as_str());
        let choosing = ticket.and_then(|text| ticket::read::<Choosing>(lti.secret(), text, Moment::now()));
        let choosing = choosing.ok_or(Refusal::State)?;
        let platforms = app.store.platforms(CLASS).await?;
        let platform = platforms.into_iter().find(|one| one.id == choosing.platform).ok_or(Refusal::State)?;
        let chosen = |slug: &str| fields.iter().any(|(name, value)| name == "lesson" && value == slug);
        let lessons = app.course.lessons().iter().filter(|lesson| chosen(&lesson.slug));
        let lessons: Vec<&Lesson> = lessons.take(if choosing.several { usize::MAX } else { 1 }).collect();
        let token = lti.chosen(&app.store, &platform, &choosing, &lessons, Moment::now()).await?;
        let fields = [("JWT", token.as_str())];
        Ok::<_, Problem>(page::sent_on("Back to your course", &choosing.return_url, &fields, "Continue"))
    };
    answer.await.unwrap_or_else(|problem| page::refused(problem, &headers, ""))
}
