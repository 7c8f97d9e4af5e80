//! The samples of one run, kept, so that forces can be drawn in another way; whoever shows them takes those that are new.
//!
//! Samples are taken at the scene's own output times. Where they become too many the older ones are thinned.

use triad_engine::run::Simulation;

use super::description::SceneDescription;
use super::sample::{Sample, sample};
use crate::drawing::{Arrows, Camera};

/// Samples from which the scale of forces can be taken.
const SAMPLES_FOR_SCALE: usize = 32;

/// The samples of one run, and how they are wanted drawn.
#[derive(Debug)]
pub struct Samples {
    description: SceneDescription,
    arrows: Arrows,
    camera: Camera,
    kept: Vec<Sample>,
    /// The place of each kept sample among all that were taken since the start: 1, 2, …, with gaps where they were thinned.
    places: Vec<u64>,
    /// Bytes of the samples, and how many there may be.
    bytes: usize,
    limit: usize,
    /// Samples taken since the start, kept or not.
    recorded: u64,
    /// Counts the starts: those of another epoch have nothing to do with these.
    epoch: u64,
    /// The scale of forces was taken from the samples.
    fitted: bool,
}

impl Samples {
    /// None yet; about `limit` bytes of them are kept at most.
    pub(crate) fn new(description: SceneDescription, limit: usize) -> Self {
        Self {
            description,
            arrows: Arrows::default(),
            camera: Camera::default(),
            kept: Vec::new(),
            places: Vec::new(),
            bytes: 0,
            limit,
            recorded: 0,
            epoch: 0,
            fitted: false,
        }
    }

    /// Records the simulation at its present time, unless that is recorded already; returns whether it was not.
    pub(crate) fn record(&mut self, simulation: &Simulation) -> bool {
        if self.kept.last().is_some_and(|last| simulation.time() <= last.time) {
            return false;
        }
        let sample = sample(simulation);
        self.bytes += sample.size();
        self.kept.push(sample);
        self.recorded += 1;
        self.places.push(self.recorded);
        if self.bytes > self.limit {
            self.thin();
        }
        if !self.fitted && self.kept.len() >= SAMPLES_FOR_SCALE {
            self.fit(false);
        }
        true
    }

    /// Of the older half about every second sample goes, so that the others lie evenly over the time since the start.
    fn thin(&mut self) {
        let half = self.kept.len() / 2;
        let (first, middle) = (self.kept[0].time, self.kept[half].time);
        // The slack keeps rounding from dropping two of three.
        let apart = (middle - first) / (half / 2).max(1) as f64 * (1.0 - 1e-6);
        let mut last = f64::NEG_INFINITY;
        let of_older = self.kept[..half].iter().map(|sample| {
            let stays = sample.time - last >= apart;
            if stays {
                last = sample.time;
            }
            stays
        });
        let stays: Vec<bool> = of_older.chain(std::iter::repeat_n(true, self.kept.len() - half)).collect();
        let mut of_sample = stays.iter();
        self.kept.retain(|_| of_sample.next() == Some(&true));
        let mut of_place = stays.iter();
        self.places.retain(|_| of_place.next() == Some(&true));
        // A list grows by doubling: what it has ahead goes too.
        self.kept.shrink_to_fit();
        self.bytes = self.kept.iter().map(Sample::size).sum();
    }

    /// Draws forces in another way, at all times.
    pub(crate) fn draw(&mut self, arrows: Arrows) {
        self.arrows = arrows;
    }

    /// Looks at the mechanism from another side.
    pub(crate) fn look_from(&mut self, camera: Camera) {
        self.camera = camera;
    }

    /// Takes the scale of forces from the samples, unless it would hardly change and is not `wanted`.
    pub(crate) fn fit(&mut self, wanted: bool) {
        let scale = self.description.scale.fitted(self.kept.iter(), self.description.size);
        self.fitted = true;
        if wanted || !scale.is_near(self.description.scale) {
            self.description.scale = scale;
        }
    }

    /// Follows a simulation that goes on with other numbers: the samples go on too, unless what they show looks
    /// different from now on. The scale of forces stays.
    pub(crate) fn follow(&mut self, mut description: SceneDescription) {
        description.scale = self.description.scale;
        if description.bodies != self.description.bodies || description.joints != self.description.joints {
            self.restart_with(description);
        }
    }

    /// Begins anew with a changed scene. Its forces are to be compared with those before: they keep their
    /// scale until the samples say otherwise.
    pub(crate) fn restart_with(&mut self, description: SceneDescription) {
        let scale = if self.fitted { self.description.scale } else { description.scale };
        self.description = SceneDescription { scale, ..description };
        self.fitted = false;
        self.restart();
    }

    /// Begins anew from nothing.
    pub(crate) fn restart(&mut self) {
        (self.kept, self.places) = (Vec::new(), Vec::new());
        self.bytes = 0;
        self.recorded = 0;
        self.epoch += 1;
    }

    /// Samples taken since the start, kept or not: also the place of the newest one.
    pub fn recorded(&self) -> u64 {
        self.recorded
    }

    /// Counts the starts: samples of another epoch have nothing to do with these.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Those that were taken after so many, oldest first.
    pub fn after(&self, taken: u64) -> &[Sample] {
        &self.kept[self.places.partition_point(|place| *place <= taken)..]
    }

    /// Those among the first so many that are kept.
    pub fn among_first(&self, taken: u64) -> &[Sample] {
        &self.kept[..self.places.partition_point(|place| *place <= taken)]
    }

    /// What stays the same from sample to sample, with the scale of forces.
    pub fn description(&self) -> &SceneDescription {
        &self.description
    }

    /// Bytes of those that are kept.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// How forces are drawn.
    pub fn arrows(&self) -> &Arrows {
        &self.arrows
    }

    /// From where the mechanism is looked at.
    pub fn camera(&self) -> Camera {
        self.camera
    }
}

#[cfg(test)]
mod tests {
    use triad_engine::catalogue;

    use super::super::description::describe;
    use super::*;

    #[test]
    fn whoever_takes_the_new_ones_misses_none_and_gets_none_twice_where_the_old_are_thinned() {
        let scene = catalogue::scene("simple-pendulum").expect("a scene");
        let mut run = Simulation::new(&scene).expect("runs");
        let mut samples = Samples::new(describe(&scene, &run), 40 * sample(&run).size());
        let (mut taken, mut times) = (0, Vec::new());
        for k in 0..200 {
            run.advance_to(1e-3 * f64::from(k)).expect("runs");
            assert!(samples.record(&run));
            assert!(!samples.record(&run), "an instant is recorded once");
            if k % 7 == 0 {
                times.extend(samples.after(taken).iter().map(|sample| sample.time));
                taken = samples.recorded();
                assert!(samples.after(taken).is_empty());
            }
        }
        assert_eq!(times.len(), 197, "up to the last time that was taken");
        assert!(times.is_sorted());
        assert!(samples.kept.len() <= 41 && samples.recorded() == 200);
        assert_eq!(samples.among_first(taken).len() + samples.after(taken).len(), samples.kept.len());
        assert_eq!(samples.kept[0].time, 0.0, "the start stays");
        let gap = samples.kept.windows(2).map(|pair| pair[1].time - pair[0].time).fold(0.0, f64::max);
        assert!(gap < 0.05, "what is kept reaches back to the start, {gap} s apart");
        samples.restart();
        assert_eq!((samples.epoch(), samples.recorded(), samples.after(0).len()), (1, 0, 0));
    }
}
