//! Ten mechanisms as a page: each moves, by itself, in a picture that the engine makes when the page is made.

use std::fmt::Write as _;

use triad_engine::prelude::{EngineError, Simulation, catalogue};
use triad_lab::film::Film;
use triad_lessons::rendering::html::escape;

use super::article::{Article, Section};

/// What the page is called.
const TITLE: &str = "Ten mechanisms that move";
/// The longest part of a run that a picture shows, s.
const LONGEST: f64 = 6.0;
/// Pictures of a film: enough for a smooth motion, some 60 kB.
const PICTURES: u32 = 60;

/// Scenes with what to look at: those of the page's own gallery (`web/src/gallery/groups.ts`), in the same order.
const CHOSEN: [(&str, &str); 10] = [
    (
        "rssr",
        "Follow the ends of the coupler: one goes round a circle, the other swings to and fro, in two planes that meet.",
    ),
    (
        "bricard",
        "Counted by its rows it could not move: 60 rows for 60 coordinates. One of them depends on the others, so it does.",
    ),
    (
        "spatial-slider-crank",
        "Four kinds of joints in one loop. In the workbench, ask each for its reaction: all components are unique.",
    ),
    ("crank-rocker", "The crank turns evenly, the rocker does not: compare its way there with its way back."),
    (
        "governor",
        "Its springs are so stiff that ordinary methods take tiny steps; the engine notices and takes an implicit one.",
    ),
    (
        "spatial-double-pendulum",
        "No two swings are alike. Start it a little differently and see when the two runs part.",
    ),
    ("heavy-top", "Let go, it falls, turns aside and rises again: the path of its tip has cusps."),
    (
        "free-body-flip",
        "Nothing acts on it, and yet it turns over again and again: rotation about the middle axis is unstable.",
    ),
    ("squeezer", "Slowed down: it takes 0.05 s. A standard test of solvers, with three loops in one plane."),
    (
        "n-four-bar:N",
        "All links line up on the way: a singular position, where the motion could branch. The run names it and its time.",
    ),
];

/// The page, and its pictures: names of files and contents. `home` is the address of the workbench, where there is one.
pub(super) fn article(home: Option<&str>) -> (Article, Vec<(String, String)>) {
    let about = "Each is one of the built-in scenes, played by the engine for this page. Where you ask for less motion they stand still.";
    let mut article = Article {
        html: format!("<h1>{TITLE}</h1>\n<p>{about}</p>\n"),
        sections: vec![section("", TITLE, 1, about)],
    };
    let mut pictures = Vec::new();
    for (entry, look) in CHOSEN {
        // A family of scenes is shown by its second.
        let name = entry.replace(":N", ":2");
        let Ok([moving, still]) = drawn(&name) else { continue };
        let summary = catalogue::ENTRIES.iter().find(|own| own.name == entry).map_or("", |own| own.summary);
        // A memory stick takes no colons in names.
        let id = name.replace(':', "-");
        let heading = id.replace('-', " ");
        let files = [format!("gallery-{id}.svg"), format!("gallery-{id}-still.svg")];
        let _ = write!(
            article.html,
            "<h2 id=\"{id}\">{heading}</h2>\n<picture><source media=\"(prefers-reduced-motion: reduce)\" srcset=\"{still}\">\
             <img src=\"{moving}\" width=\"640\" height=\"400\" loading=\"lazy\" alt=\"{summary}\"></picture>\n<p>{summary}. \
             {look}</p>\n<p>{open}<code>triad run {name}</code></p>\n",
            summary = escape(summary),
            look = escape(look),
            moving = files[0],
            still = files[1],
            open = home.map_or_else(String::new, |home| opened(home, &name)),
        );
        article.sections.push(section(&id, &heading, 2, &format!("{summary} {look}")));
        pictures.extend(files.into_iter().zip([moving, still]));
    }
    (article, pictures)
}

/// A link that plays the scene in the workbench: at an address of its own, or in the page of a site without a server.
fn opened(home: &str, name: &str) -> String {
    let name = name.replace(':', "%3A");
    let address = if home.ends_with('/') {
        format!("{home}scenes/{name}")
    } else {
        format!("{home}?page=/scenes/{name}")
    };
    format!(
        "<a href=\"{address}\">Play it in the workbench</a>, change it, ask for its forces. In a terminal: "
    )
}

/// Its motion, and its start.
fn drawn(name: &str) -> Result<[String; 2], EngineError> {
    let scene = catalogue::scene(name)?;
    let mut run = Simulation::new(&scene)?;
    let mut film = Film::new(&scene, run.model());
    film.push(run.frame());
    let still = film.svg(false);
    let until = run.duration().min(LONGEST);
    for k in 1..=PICTURES {
        run.advance_to(until * f64::from(k) / f64::from(PICTURES))?;
        film.push(run.frame());
    }
    Ok([film.svg(true), still])
}

fn section(id: &str, heading: &str, level: usize, words: &str) -> Section {
    Section { id: id.to_owned(), heading: heading.to_owned(), level, words: words.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_mechanisms_move_and_lead_to_the_workbench() {
        let (article, pictures) = article(Some("../"));
        assert_eq!(article.sections.len(), 1 + CHOSEN.len());
        assert_eq!(pictures.len(), 2 * CHOSEN.len());
        for pair in pictures.chunks(2) {
            let [(name, moving), (_, still)] = pair else {
                panic!("a picture that moves and one that stands")
            };
            assert!(moving.contains("<animate") && !still.contains("<animate"), "{name}");
            assert!(moving.len() < 300_000, "{name}: {} bytes", moving.len());
        }
        assert!(article.html.contains("href=\"../scenes/n-four-bar%3A2\""));
        let (alone, _) = super::article(Some("../index.html"));
        assert!(alone.html.contains("href=\"../index.html?page=/scenes/rssr\""));
        assert!(!super::article(None).0.html.contains("workbench</a>"));
    }

    #[test]
    fn they_are_those_of_the_page() {
        let source = include_str!("../../../web/src/gallery/groups.ts");
        let list = source.split("const CHOSEN = [").nth(1).and_then(|rest| rest.split(']').next());
        let names: Vec<&str> = list.unwrap_or("").split('"').skip(1).step_by(2).collect();
        assert_eq!(names, CHOSEN.map(|(name, _)| name));
    }
}
