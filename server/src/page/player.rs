//! A page that plays a recorded run by itself: the player, which is built with the page, and a motion in it.

use serde_json::json;

use super::asset;
use crate::motion::Motion;
use crate::problem::Problem;

/// The player's file, which the page fetches too.
const FILE: &str = "player.html";
/// Where it takes a motion: that of `web/src/player/played.ts`.
const PLACE: &str = r#"<script type="application/json" id="motion"></script>"#;

/// The page, as text; forces are drawn.
///
/// Errors if the player is not what it was built to be.
pub fn playing(motion: &Motion) -> Result<String, Problem> {
    let player = asset::find(FILE).and_then(asset::Asset::text);
    let Some((head, tail)) = player.and_then(|text| text.split_once(PLACE)) else {
        return Err(Problem::internal("the page was built without its player"));
    };
    let played = json!({ "motion": motion, "drawn": { "what": "all" } }).to_string();
    // No letter of the data may end the element that it stands in.
    let data = played.replace('<', "\\u003c");
    let open = PLACE.trim_end_matches("</script>");
    Ok(format!("{head}{open}{data}</script>{tail}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;
    use triad_engine::analysis::Wanted;
    use triad_engine::scene::catalogue;

    #[test]
    fn a_page_that_plays_is_whole_and_small_and_its_data_end_nothing() {
        let mut scene = catalogue::scene("squeezer").expect("built in");
        scene.title = "</script><script>alert(1)".into();
        let motion = crate::motion::of(&scene, Duration::from_mins(1), &Wanted::default()).expect("runs");
        let page = playing(&motion).expect("a page");
        assert!(page.len() < 300_000, "{} bytes", page.len());
        assert_eq!(page.matches("</script>").count(), 2, "one of the data, one of the player");
        assert!(page.ends_with("</html>\n") && !page.contains("alert(1)<"));
        let fetched =
            page.match_indices("http").filter(|(at, _)| !page[*at..].starts_with("http://www.w3.org"));
        assert_eq!(fetched.count(), 0, "nothing is fetched");
    }
}
