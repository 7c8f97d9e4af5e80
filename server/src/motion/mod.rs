//! A run in numbers, small enough to be sent in one piece: for pictures that play where no session is live, in the page, in
//! other sites, and in a file.

mod shelf;

pub use shelf::{Shelf, unpacked};

use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Value, json};
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

use crate::problem::Problem;
use triad_engine::analysis::Wanted;
use triad_lab::film::turn;
use triad_session::picture::{Sample, SceneDescription, block, describe, frame_size, sample};

/// Frames by second of watching: as smooth as a page that draws evenly between them needs.
const RATE: f64 = 30.0;
/// The longest part of a run that is watched without a session, s.
const LONGEST: f64 = 5.0;
/// A run that is over sooner is watched in slow motion, s.
const SHORTEST: f64 = 2.0;
/// How long such a run is watched, s.
const SLOW: f64 = 4.0;
/// Bytes of numbers: with the player and its text a file stays below 300 kB.
const MOST_BYTES: usize = 150_000;
/// Fewer frames than these are no motion: where they do not fit either, reactions are left out.
const FEWEST: usize = 38;
/// Samples of a film that are held: more than fit into any motion. Beyond them every second one goes.
const MOST_SAMPLES: usize = 4096;
/// Integrator steps between two looks at the clock.
const PIECE: u64 = 64;

/// A recorded run.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(rename = "RecordedMotion")]
pub struct Motion {
    /// Title of the scene.
    pub title: String,
    /// What of the scene is drawn: bodies, joints, markers, gravity.
    #[schemars(with = "Scene")]
    pub scene: Value,
    /// End of what is recorded, s.
    pub until: f64,
    /// Simulated seconds by second at which it is watched well.
    pub speed: f64,
    /// Names of the bodies, in the scene's order.
    pub bodies: Vec<String>,
    /// The joints and drivers whose reactions are recorded.
    pub joints: Vec<MotionJoint>,
    /// Length of a force's arrow, m/N.
    pub force_scale: f64,
    /// Radius of a moment's circle, m/(N m).
    pub moment_scale: f64,
    /// The longest arrow, m.
    pub longest: f64,
    /// One block of the stream of numbers, as base64.
    pub track: String,
}

/// A joint of a recorded run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct MotionJoint {
    /// The joint or driver.
    pub joint: String,
    /// The body that its reaction acts on.
    pub on: String,
    /// The body at the other side.
    pub by: String,
}

/// A motion while it is recorded.
pub struct Film {
    scene: Value,
    description: SceneDescription,
    samples: Vec<Sample>,
    /// One of so many that are offered is taken.
    stride: usize,
    offered: usize,
    /// The last that was offered and not taken.
    last: Option<Sample>,
}

impl Film {
    /// Of a simulation of that scene, at its start.
    pub fn new(scene: &Scene, simulation: &Simulation) -> Self {
        Self {
            scene: drawn(scene),
            description: describe(scene, simulation),
            samples: Vec::new(),
            stride: 1,
            offered: 0,
            last: None,
        }
    }

    /// Whether there are forces to tell.
    pub fn tells_forces(&self) -> bool {
        !self.description.joints.is_empty()
    }

    /// Records the simulation as it stands.
    pub fn take(&mut self, simulation: &Simulation) {
        let sample = sample(simulation);
        let wanted = self.offered.is_multiple_of(self.stride);
        self.offered += 1;
        if !wanted {
            self.last = Some(sample);
            return;
        }
        self.last = None;
        self.samples.push(sample);
        if self.samples.len() > MOST_SAMPLES {
            let mut index = 0;
            self.samples.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.stride *= 2;
        }
    }

    /// The motion: every frame, or as many at equal distances as fit.
    pub fn develop(self) -> Motion {
        self.developed().0
    }

    /// The same, and how coarse it is: its frames, and the largest turn of a body from one to the next, rad.
    pub fn developed(mut self) -> (Motion, (usize, f64)) {
        self.samples.extend(self.last.take());
        let description = &self.description;
        let (bodies, all) = (description.bodies.len(), description.joints.len());
        let joints = if FEWEST * frame_size(bodies, all) > MOST_BYTES { 0 } else { all };
        let most = (MOST_BYTES / frame_size(bodies, joints)).max(2);
        let scale = description.scale.fitted(self.samples.iter(), description.size);
        let every = self.samples.len().div_ceil(most).max(1);
        let last = self.samples.len().saturating_sub(1);
        let mut index = 0;
        self.samples.retain(|_| {
            index += 1;
            (index - 1) % every == 0 || index - 1 == last
        });
        let until = self.samples.last().map_or(0.0, |sample| sample.time);
        let name = |body: Option<usize>| {
            let found = body.and_then(|body| description.bodies.get(body));
            found.map_or_else(|| "ground".to_owned(), |body| body.name.clone())
        };
        let told = description.joints.iter().take(joints);
        let turns =
            self.samples.windows(2).flat_map(|pair| {
                let seconds = pair[1].time - pair[0].time;
                pair[0].poses.iter().zip(&pair[1].poses).map(move |(a, b)| {
                    turn([a.axes, b.axes], [a.angular_velocity, b.angular_velocity], seconds)
                })
            });
        let turned = turns.fold(0.0, f64::max);
        let coarseness = (self.samples.len(), turned);
        let motion = Motion {
            title: description.title.clone(),
            until,
            speed: until / watched(until),
            bodies: description.bodies.iter().map(|body| body.name.clone()).collect(),
            joints: told
                .map(|joint| MotionJoint {
                    joint: joint.name.clone(),
                    on: name(joint.on),
                    by: name(joint.by),
                })
                .collect(),
            force_scale: scale.force,
            moment_scale: scale.moment,
            longest: scale.longest,
            track: STANDARD.encode(block(&self.samples, joints)),
            scene: self.scene,
        };
        (motion, coarseness)
    }
}

/// How long a run of that many simulated seconds is watched, s.
fn watched(until: f64) -> f64 {
    if until > 0.0 && until < SHORTEST { SLOW } else { until.max(f64::MIN_POSITIVE) }
}

/// What of a scene its picture is made of.
fn drawn(scene: &Scene) -> Value {
    let parts = |value: Result<Value, serde_json::Error>| value.unwrap_or_default();
    json!({
        "name": scene.name,
        "gravity": scene.gravity,
        "bodies": parts(serde_json::to_value(&scene.bodies)),
        "joints": parts(serde_json::to_value(&scene.joints)),
        "markers": parts(serde_json::to_value(&scene.markers)),
    })
}

/// The first seconds of a scene's run; nothing but its start if it cannot be run, or not within `time`.
///
/// Errors if the scene cannot stand at its start, or nobody wants it any more.
pub fn of(scene: &Scene, time: Duration, wanted: &Wanted) -> Result<Motion, Problem> {
    let began = Instant::now();
    let mut run = Simulation::new(scene)?;
    let mut film = Film::new(scene, &run);
    film.take(&run);
    let until = run.duration().min(LONGEST);
    let frames = (RATE * watched(until)).ceil();
    let mut index = 0.0;
    while index < frames {
        index += 1.0;
        let next = until * index / frames;
        loop {
            wanted.check()?;
            match run.advance_towards(next, PIECE) {
                Ok(true) => break,
                Ok(false) if began.elapsed() < time => {}
                // What was reached is a motion too.
                Ok(false) | Err(_) => return Ok(film.develop()),
            }
        }
        film.take(&run);
    }
    Ok(film.develop())
}

/// A scene at its start.
///
/// Errors if it cannot stand there.
pub fn picture(scene: &Scene) -> Result<Motion, Problem> {
    let run = Simulation::new(scene)?;
    let mut film = Film::new(scene, &run);
    film.take(&run);
    Ok(film.develop())
}

#[cfg(test)]
mod tests {
    use super::*;
    use triad_engine::scene::catalogue;

    fn numbers(motion: &Motion) -> (Vec<u32>, usize) {
        let bytes = STANDARD.decode(&motion.track).expect("base64");
        let head = bytes[..12].chunks(4);
        (head.map(|four| u32::from_le_bytes(four.try_into().expect("four"))).collect(), bytes.len())
    }

    #[test]
    fn a_motion_has_thirty_frames_a_second_of_watching_and_is_bounded() {
        let scene = catalogue::scene("spatial-slider-crank").expect("built in");
        let motion = of(&scene, Duration::from_mins(1), &Wanted::default()).expect("runs");
        assert_eq!((motion.until, motion.speed), (5.0, 1.0));
        assert_eq!(
            numbers(&motion).0.iter().map(|one| *one as usize).collect::<Vec<_>>(),
            [3, motion.joints.len(), 151]
        );
        let squeezer =
            of(&catalogue::scene("squeezer").expect("built in"), Duration::from_mins(1), &Wanted::default());
        let squeezer = squeezer.expect("runs");
        assert!((squeezer.until / squeezer.speed - SLOW).abs() < 1e-9, "watched in slow motion");
        let many = catalogue::scene("n-four-bar:20").expect("built in");
        let many = of(&many, Duration::from_mins(1), &Wanted::default()).expect("runs");
        let (head, bytes) = numbers(&many);
        assert!(bytes <= MOST_BYTES + 6000 && head[2] as usize >= FEWEST, "{head:?}: {bytes} bytes");
    }

    #[test]
    fn a_long_film_keeps_its_start_its_end_and_equal_distances() {
        let scene = catalogue::scene("simple-pendulum").expect("built in");
        let mut run = Simulation::new(&scene).expect("stands");
        let mut film = Film::new(&scene, &run);
        film.take(&run);
        let count = 3 * MOST_SAMPLES;
        for index in 1..=count {
            run.advance_to(index as f64 * 1e-4).expect("runs");
            film.take(&run);
        }
        assert!(film.samples.len() <= MOST_SAMPLES + 1, "{}", film.samples.len());
        let gaps = film.samples.windows(2).map(|pair| pair[1].time - pair[0].time);
        let (least, most) = gaps.fold((f64::MAX, 0.0_f64), |(a, b), gap| (a.min(gap), b.max(gap)));
        assert!(most - least < 1e-9, "{least} to {most}");
        let motion = film.develop();
        assert!((motion.until - count as f64 * 1e-4).abs() < 1e-9, "{}", motion.until);
    }

    #[test]
    fn what_cannot_go_on_shows_what_it_reached() {
        let scene = catalogue::scene("simple-pendulum").expect("built in");
        let wanted = Wanted::default();
        let motion = of(&scene, Duration::ZERO, &wanted).expect("stands");
        assert!(numbers(&motion).0[2] >= 1);
        assert_eq!(numbers(&picture(&scene).expect("stands")).0[2], 1);
        wanted.no_longer();
        let ended = of(&scene, Duration::from_mins(1), &wanted).map(|motion| motion.until);
        assert_eq!(ended.map_err(|problem| problem.code()), Err("no-longer-wanted"));
    }
}
