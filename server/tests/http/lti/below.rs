//! A class that stands at a path below another site's name: login, launch, choice, scores and roster, by addresses with that path.

use axum::http::header;
use serde_json::json;
use triad::lti::{Lti, scores};
use triad::policy::Moment;

use super::choices::{choose, field, offer, said};
use super::{LESSON, begun, school_below};
use crate::Reply;

const BASE: &str = "/school/triad";
const HOME: &str = "https://triad.test/school/triad";

fn sets(reply: &Reply) -> Vec<&str> {
    reply.headers.get_all(header::SET_COOKIE).iter().map(|set| set.to_str().expect("text")).collect()
}

#[tokio::test]
async fn people_come_in_and_their_scores_are_told() {
    let school = school_below(BASE).await;
    let reply = school.login(&[], &[]).await;
    let to = reply.headers[header::LOCATION].to_str().expect("text");
    assert!(to.contains("redirect_uri=https%3A%2F%2Ftriad.test%2Fschool%2Ftriad%2Flti%2Flaunch"), "{to}");
    // What is sent back to a path is of no host as a whole.
    let set = sets(&reply).concat();
    assert!(set.starts_with("__Secure-triad-lti-") && set.contains("; Path=/school/triad;"), "{set}");
    // In a frame the launch begins anew, at our own address.
    let framed = school.login(&[], &[("sec-fetch-dest", "iframe")]).await;
    let page = String::from_utf8_lossy(&framed.bytes).into_owned();
    assert!(page.contains(&format!("action=\"{HOME}/lti/login\"")), "{page}");

    let arrived = school.open("prof", "Instructor").await;
    assert_eq!(arrived.headers[header::LOCATION], format!("{HOME}/lessons/{LESSON}"));
    assert!(sets(&arrived).iter().all(|set| set.contains("; Path=/school/triad;")), "{:?}", sets(&arrived));
    // The platform has the address of another part of the site.
    for target in ["https://triad.test/lessons/screw", "https://triad.test/school/triads/lessons/screw"] {
        school.login(&[("target_link_uri", target)], &[]).await.problem(403, "lti-target");
    }

    let (ada, _) = school.enter("ada", "Learner").await;
    let body = json!({"answers": {"tension-bottom": {"value": "1.5", "unit": "N"}}});
    let path = format!("{BASE}/api/v1/lessons/{LESSON}/submissions");
    assert_eq!(school.class.ask("POST", &path, &ada, Some(body)).await.status, 201);
    let app = &school.class.app;
    scores::plan(&app.store, &app.course, Moment::now().after(60_000)).await.expect("planned");
    let lti: &Lti = app.lti.as_deref().expect("reached");
    let clock = || Moment::now().after(60_000);
    assert_eq!(scores::deliver(lti, &app.store, &app.course, &clock).await.expect("delivered"), 1);
    let seen = school.platform.seen.lock().expect("whole");
    assert_eq!((seen.made.len(), &seen.scores[0].1["userId"]), (1, &json!("ada")));
    assert_eq!(seen.made[0]["resourceId"], LESSON);
}

#[tokio::test]
async fn lessons_are_chosen_by_their_addresses_there() {
    let school = school_below(BASE).await;
    let target = format!("{HOME}/lti/choice");
    let begun = begun(&school.login(&[("target_link_uri", &target)], &[("sec-fetch-dest", "iframe")]).await);
    let list = offer(&school, &begun, "Instructor", |_| {}).await;
    let page = String::from_utf8_lossy(&list.bytes).into_owned();
    assert!(page.contains(&format!("action=\"{HOME}/lti/choice\"")), "{page}");
    let ticket = field(&list, "ticket");
    let back = choose(&school, &[("ticket", &ticket), ("lesson", "screw")]).await;
    let items =
        said(&school, &back).await["https://purl.imsglobal.org/spec/lti-dl/claim/content_items"].clone();
    assert_eq!(items[0]["url"], format!("{HOME}/lessons/screw"));
}
