//! A run as a picture that moves: an SVG that plays by itself, in a page, a README or a notebook.
//!
//! The mechanism is drawn from one side: across its plane where it moves in one, otherwise from above and aside. The picture
//! holds numbers alone, no program, and follows the reader's choice of a light or a dark page.

mod drawn;
mod view;

use drawn::Drawn;
use std::fmt::Write as _;
use triad_engine::model::{BodyRef, Model};
use triad_engine::run::Frame;
use triad_engine::scene::Scene;
use triad_engine::state::BodyFrame;
use triad_plot::escaped;
use view::View;

/// Width and height of the picture, px.
const SIZE: [f64; 2] = [640.0, 400.0];
/// Free space around the motion, px.
const MARGIN: f64 = 36.0;
/// Pictures of one film: enough for a smooth motion of some seconds.
const MAX_PICTURES: usize = 150;
/// Points of all pictures together: about 12 bytes each, so that a film of a large mechanism stays below a megabyte.
const MAX_POINTS: usize = 60_000;
/// Times of pictures that differ by more than this part of the film from equally spaced ones are told.
const UNEVEN: f64 = 0.01;
/// Shortest and longest time that a film takes, s.
const PLAYS: [f64; 2] = [1.0, 20.0];
/// Colours of bodies, that stay apart for colour-blind eyes too (Okabe and Ito).
const COLOURS: [&str; 6] = ["#0072b2", "#e69f00", "#009e73", "#56b4e9", "#cc79a7", "#d55e00"];

/// Frames of a run on their way to a picture.
///
/// ```
/// use triad_engine::prelude::*;
/// use triad_lab::film::Film;
///
/// let scene = catalogue::scene("crank-rocker")?;
/// let mut run = Simulation::new(&scene)?;
/// let mut film = Film::new(&scene, run.model());
/// for k in 0..=20 {
///     run.advance_to(0.05 * f64::from(k))?;
///     film.push(run.frame());
/// }
/// let svg = film.svg(true);
/// assert!(svg.contains("<animate") && !film.svg(false).contains("<animate"));
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Film {
    title: String,
    bodies: Vec<Drawn>,
    /// Points of joints on the ground, m.
    ground: Vec<[f64; 3]>,
    y_is_up: bool,
    frames: Vec<Frame>,
}

impl Film {
    /// Of a scene and the model that was made of it, still without a frame.
    pub fn new(scene: &Scene, model: &Model) -> Self {
        let bodies = (0..model.bodies.len()).map(|body| Drawn::new(scene, model, body)).collect();
        let sides = model.joints.iter().flat_map(|joint| joint.bodies.iter().zip(&joint.points));
        let ground =
            sides.filter(|(body, _)| **body == BodyRef::Ground).map(|(_, point)| (*point).into()).collect();
        let title = if scene.title.is_empty() { &scene.name } else { &scene.title };
        let y_is_up = model.gravity.y.abs() > model.gravity.z.abs();
        Self { title: title.clone(), bodies, ground, y_is_up, frames: Vec::new() }
    }

    /// Takes a frame of the run; frames come in the order of time.
    pub fn push(&mut self, frame: Frame) {
        self.frames.push(frame);
    }

    /// The film, or its last frame alone, as SVG.
    pub fn svg(&self, moving: bool) -> String {
        let shown = if moving { self.shown() } else { self.frames.iter().rev().take(1).collect() };
        let all = self.frames.iter().flat_map(|frame| self.points(frame)).chain(self.ground.iter().copied());
        let view = View::around(all, self.y_is_up, SIZE, MARGIN);
        let [begin, end] =
            [self.frames.first(), self.frames.last()].map(|frame| frame.map_or(0.0, |f| f.time));
        let clock = Clock {
            plays: (end - begin).clamp(PLAYS[0], PLAYS[1]),
            moving: shown.len() > 1,
            times: key_times(&shown),
        };
        let title = escaped(&self.title);
        let [width, height] = SIZE;
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
             {height}\" role=\"img\" aria-label=\"{title}, from {begin} s to {end} s\" font-family=\"system-ui, \
             sans-serif\" font-size=\"13\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n{STYLE}\
             <rect class=\"paper\" width=\"{width}\" height=\"{height}\" rx=\"10\"/>\n"
        );
        let _ = writeln!(out, "<text class=\"ink\" x=\"16\" y=\"24\">{title}</text>");
        self.traces(&view, &mut out);
        self.ground(&view, &mut out);
        for (index, body) in self.bodies.iter().enumerate() {
            let frames: Vec<&BodyFrame> = shown.iter().filter_map(|frame| frame.bodies.get(index)).collect();
            body.write(&frames, &view, COLOURS[index % COLOURS.len()], &clock, &mut out);
        }
        clock.write([begin, end], &mut out);
        out.push_str("</svg>\n");
        out
    }

    /// The frames that are shown: all, or so many, equally far apart, that the file does not become too large.
    fn shown(&self) -> Vec<&Frame> {
        let points: usize = self.bodies.iter().map(Drawn::count).sum();
        let most = (MAX_POINTS / points.max(1)).clamp(2, MAX_PICTURES);
        let count = self.frames.len();
        if count <= most {
            return self.frames.iter().collect();
        }
        // The nearest ones.
        (0..most).map(|k| &self.frames[(k * (count - 1) + (most - 1) / 2) / (most - 1)]).collect()
    }

    /// Pictures that the film has, and the largest turn of a body from one to the next, rad: between them its points move along
    /// straight lines.
    pub fn coarseness(&self) -> (usize, f64) {
        let shown = self.shown();
        let turns = shown.windows(2).flat_map(|pair| {
            let seconds = pair[1].time - pair[0].time;
            let axes = |body: &BodyFrame| [body.u, body.v, body.w];
            pair[0].bodies.iter().zip(&pair[1].bodies).map(move |(a, b)| {
                turn([axes(a), axes(b)], [a.angular_velocity, b.angular_velocity], seconds)
            })
        });
        (shown.len(), turns.fold(0.0, f64::max))
    }

    /// Where everything that is drawn is in a frame.
    fn points(&self, frame: &Frame) -> Vec<[f64; 3]> {
        let bodies = self.bodies.iter().zip(&frame.bodies).flat_map(|(drawn, at)| drawn.points(at));
        bodies.chain(frame.markers.iter().map(|marker| marker.position)).collect()
    }

    /// The paths of markers; without any, that of the last body's centre of mass.
    fn traces(&self, view: &View, out: &mut String) {
        let markers = self.frames.first().map_or(0, |frame| frame.markers.len());
        let of = |frame: &Frame, index: usize| match frame.markers.get(index) {
            Some(marker) => Some(marker.position),
            None => frame.bodies.last().map(|body| body.position),
        };
        for index in 0..markers.max(1) {
            let points: Vec<String> = self
                .frames
                .iter()
                .filter_map(|frame| of(frame, index))
                .map(|point| {
                    let [x, y] = view.place(point);
                    format!("{x:.1},{y:.1}")
                })
                .collect();
            let _ = writeln!(out, "<polyline class=\"trace\" points=\"{}\"/>", points.join(" "));
        }
    }

    /// A wedge under each joint of the ground.
    fn ground(&self, view: &View, out: &mut String) {
        for &point in &self.ground {
            let [x, y] = view.place(point);
            let _ = writeln!(out, "<path class=\"ground\" d=\"M{x:.1} {y:.1}l-9 14h18z\"/>");
        }
    }
}

/// By how much a body turns from one moment to another, rad: what its axes tell, and no less than what its angular velocities tell,
/// which know of whole turns.
pub fn turn([a, b]: [[[f64; 3]; 3]; 2], rates: [[f64; 3]; 2], seconds: f64) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|m| a[m] * b[m]).sum::<f64>();
    let along: f64 = (0..3).map(|k| dot(a[k], b[k])).sum();
    let rate = 0.5 * rates.iter().map(|rate| dot(*rate, *rate).sqrt()).sum::<f64>();
    libm::acos((0.5 * (along - 1.0)).clamp(-1.0, 1.0)).max(rate * seconds)
}

/// When pictures are shown, as parts of the film, if they are not equally far apart: the last interval of a run may be shorter.
fn key_times(shown: &[&Frame]) -> Option<String> {
    let [first, .., last] = shown else { return None };
    let parts: Vec<f64> =
        shown.iter().map(|frame| (frame.time - first.time) / (last.time - first.time)).collect();
    let even = |(k, part): (usize, &f64)| (part - k as f64 / (parts.len() - 1) as f64).abs() <= UNEVEN;
    let uneven = !parts.iter().enumerate().all(even);
    uneven.then(|| parts.iter().map(|part| format!("{part:.4}")).collect::<Vec<_>>().join(";"))
}

/// Colours for both kinds of page.
const STYLE: &str = "<style>.paper{fill:#fff}.ink{fill:#1d2733}.trace{stroke:#8a97a5;stroke-width:1.2}\
                     .ground{fill:#c9d1d9;stroke:#66727f}.pin{stroke:#1d2733}.bar{fill:#8a97a5}\
                     @media(prefers-color-scheme:dark){.paper{fill:#10161d}.ink{fill:#dbe3ea}.trace{stroke:#6b7885}\
                     .ground{fill:#3a4550;stroke:#93a0ac}.pin{stroke:#eef3f7}}</style>\n";

/// How long a film plays, s, whether it moves at all, and when its pictures are shown.
struct Clock {
    plays: f64,
    moving: bool,
    times: Option<String>,
}

impl Clock {
    /// What an attribute takes one after the other, at equal distances or at the times of the pictures.
    fn animate(&self, attribute: &str, values: &[String], times: Option<&str>, out: &mut String) {
        if self.moving && values.windows(2).any(|pair| pair[0] != pair[1]) {
            let times = times.map_or_else(String::new, |times| format!(" keyTimes=\"{times}\""));
            let _ = write!(
                out,
                "<animate attributeName=\"{attribute}\" dur=\"{:.2}s\" repeatCount=\"indefinite\"{times} values=\"{}\"/>",
                self.plays,
                values.join(";")
            );
        }
    }

    /// A bar that grows with time, and where it begins and ends.
    fn write(&self, [begin, end]: [f64; 2], out: &mut String) {
        let [width, height] = SIZE;
        if !self.moving {
            let _ = writeln!(out, "<text class=\"ink\" x=\"16\" y=\"{}\">t = {end} s</text>", height - 14.0);
            return;
        }
        let (from, long, y) = (60.0, width - 120.0, height - 18.0);
        let _ = writeln!(
            out,
            "<text class=\"ink\" x=\"16\" y=\"{}\">{begin} s</text><text class=\"ink\" x=\"{}\" y=\"{}\" \
             text-anchor=\"end\">{end} s</text>",
            y + 4.0,
            width - 16.0,
            y + 4.0
        );
        let _ = write!(
            out,
            "<rect class=\"bar\" x=\"{from}\" y=\"{}\" height=\"3\" rx=\"1.5\" width=\"0\">",
            y - 1.5
        );
        self.animate("width", &["0".to_owned(), format!("{long}")], None, out);
        out.push_str("</rect>\n");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use triad_engine::catalogue;
    use triad_engine::run::Simulation;

    fn film(name: &str, frames: u32) -> Film {
        let scene = catalogue::scene(name).unwrap();
        let mut run = Simulation::new(&scene).unwrap();
        let mut film = Film::new(&scene, run.model());
        for k in 0..frames {
            run.advance_to(0.01 * f64::from(k)).unwrap();
            film.push(run.frame());
        }
        film
    }

    /// The values of all coordinates that a film shows.
    fn coordinates(svg: &str) -> Vec<f64> {
        let paths = svg.split(" d=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
        let moved =
            svg.split("attributeName=\"d\"").skip(1).map(|rest| rest.split("values=\"").nth(1).unwrap());
        let moved = moved.map(|rest| rest.split('"').next().unwrap());
        let absolute = |text: &str| -> Vec<f64> {
            let parts =
                text.split(['M', 'L']).skip(1).map(|part| part.split(['l', 'h', ';']).next().unwrap());
            parts.flat_map(|part| part.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()).collect()
        };
        paths.chain(moved).flat_map(absolute).collect()
    }

    #[test]
    fn everything_stays_on_the_paper_at_all_times() {
        for name in ["n-four-bar:2", "bricard", "spatial-slider-crank", "free-body", "car-axis"] {
            let svg = film(name, 60).svg(true);
            let found = coordinates(&svg);
            assert!(found.len() > 200, "{name}: {}", found.len());
            assert!(found.iter().all(|x| (0.0..=SIZE[0]).contains(x)), "{name}: {found:?}");
            roxmltree::Document::parse(&svg).unwrap();
        }
    }

    #[test]
    fn a_plane_mechanism_is_seen_across_its_plane() {
        let film = film("simple-pendulum", 40);
        let view = View::around(film.frames.iter().flat_map(|f| film.points(f)), true, SIZE, MARGIN);
        let long = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
        let bars: Vec<f64> = film
            .frames
            .iter()
            .map(|frame| long(view.place([0.0; 3]), view.place(frame.bodies[0].position)))
            .collect();
        assert!(
            bars.iter().all(|bar| (bar - bars[0]).abs() < 1e-6 * bars[0]),
            "its length does not change: {bars:?}"
        );
    }

    const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    #[test]
    fn pictures_are_shown_at_their_times_and_a_film_knows_how_coarse_it_is() {
        let scene = catalogue::scene("simple-pendulum").unwrap();
        let mut run = Simulation::new(&scene).unwrap();
        let mut film = Film::new(&scene, run.model());
        for time in [0.0, 0.5, 1.0, 1.1] {
            run.advance_to(time).unwrap();
            film.push(run.frame());
        }
        assert!(film.svg(true).contains("keyTimes=\"0.0000;0.4545;0.9091;1.0000\""));
        let (pictures, turned) = film.coarseness();
        assert!(pictures == 4 && turned > 1.0 && turned < 2.5, "{turned}");
        let even = self::film("simple-pendulum", 151);
        assert!(turn([AXES; 2], [[0.0, 0.0, 60.0]; 2], 0.1) == 6.0, "nearly a whole turn is no small one");
        assert!(!even.svg(true).contains("keyTimes") && even.coarseness().1 < 0.1);
    }

    #[test]
    fn large_mechanisms_and_long_runs_stay_small() {
        let svg = film("n-four-bar:40", 300).svg(true);
        assert!(svg.len() < 1_000_000, "{}", svg.len());
        assert!(svg.matches("<animate").count() > 100);
    }
}
