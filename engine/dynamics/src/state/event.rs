//! The number of an event at one state.

use super::{Stage, State};
use crate::model::BodyRef;
use crate::system::event::{EventFeature, EventFunction, EventMeasure};
use nalgebra::Vector3;

impl EventFeature {
    /// Position and velocity of the point.
    fn point(&self, at: &State) -> [Vector3<f64>; 2] {
        at.point(self.body, &self.local)
    }

    /// The vector and its rate.
    fn vector(&self, at: &State) -> [Vector3<f64>; 2] {
        match self.body {
            BodyRef::Ground => [self.local, Vector3::zeros()],
            BodyRef::Moving(body) => {
                let body = &at.bodies[body];
                [body.q.arm(&self.local), body.q_dot.arm(&self.local)]
            }
        }
    }
}

impl EventFunction {
    /// EventMeasure less value, and its rate.
    pub fn evaluate(&self, at: &State) -> [f64; 2] {
        at.require(Stage::Velocities);
        let between = |[i, j]: &[EventFeature; 2]| {
            let ([a, a_rate], [b, b_rate]) = (i.point(at), j.point(at));
            [b - a, b_rate - a_rate]
        };
        let [number, rate] = match &self.measure {
            EventMeasure::Coordinate { point, direction } => point.point(at).map(|x| x.dot(direction)),
            EventMeasure::Distance(pair) => {
                let [d, d_rate] = between(pair);
                let length = d.norm();
                [length, if length > 0.0 { d.dot(&d_rate) / length } else { d_rate.norm() }]
            }
            EventMeasure::Angle(k) => [at.angles[*k].value, at.angles[*k].rate],
            EventMeasure::Slide { axis, points } => {
                let ([d, d_rate], [s, s_rate]) = (between(points), axis.vector(at));
                [s.dot(&d), s.dot(&d_rate) + s_rate.dot(&d)]
            }
        };
        [number - self.value, rate]
    }
}
