//! Accelerations and multipliers by exact elimination of the rigid-body rows — THEORY section 7.
//!
//! The augmented system M q̈ + Φ_qᵀ λ = g, Φ_q q̈ = γ splits body by body: the rigid-body rows leave the twist
//! ξ = (ṙ, ω) free, so that only the rows of joints remain, A ξ̇ = γ', with the 6 × 6 inertia diag(m I, I_g) of each
//! body. Their multipliers come from S λ = …, S = A diag(m I, I_g)⁻¹ Aᵀ, which is block-sparse. This is exact for any
//! directors, orthonormal or not, and for full and reduced bodies alike.

use crate::angle::AngleState;
use crate::lift::Lift;
use crate::load::Forces;
use crate::model::BodyRef;
use crate::motion::Jet;
use crate::row::{Difference, FeatureId, Form, Target, across};
use crate::scene::Coordinates;
use crate::sparse::{BlockCholesky, Slot};
use crate::system::{NO_INCIDENCE, Row, System};
use nalgebra::{Matrix3, Vector3};

/// Regularization of S where rows are redundant, relative to its diagonal.
///
/// Large enough that rounding in a nearly singular S stays harmless through singular positions (with 1e-11 the step
/// control stalls there at tolerances of 1e-12), small enough that two refinements remove its effect elsewhere.
pub const REGULARIZATION: f64 = 1e-9;
/// A relative pivot below this calls for the regularization.
const NEAR_SINGULAR: f64 = 1e-9;
/// Refinement steps where the factor is that of a regularized or lent system.
const REFINEMENTS: usize = 3;

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Counters {
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// Factorizations of S.
    pub factorizations: u64,
    /// Back-solves with its factor.
    pub solves: u64,
}

/// What is known of a body at one state.
#[derive(Clone, Debug, Default)]
pub struct BodyState {
    /// Position Q.
    pub q: Lift,
    /// Velocity Q̇.
    pub q_dot: Lift,
    /// Particular acceleration Q̈ᵖ that satisfies the rigid-body rows.
    pub particular: Lift,
    /// Generalized applied force G.
    pub force: Lift,
    /// Resultant force and moment (F, T) about the centre of mass, inertial part of Q̈ᵖ included.
    pub wrench: [Vector3<f64>; 2],
    /// Inverse of the inertia used by the factorization.
    pub inverse: Matrix3<f64>,
    /// Solution ξ̇ = (v̇, ω̇).
    pub twist: [Vector3<f64>; 2],
    /// ω̇ for which lent inertia has been returned so far.
    returned: Vector3<f64>,
}

/// What is known of a feature at one state.
#[derive(Clone, Copy, Debug, Default)]
struct FeatureState {
    /// Position of the point, or the vector.
    value: Vector3<f64>,
    /// C^s Q: from the centre of mass to the point, or the vector.
    arm: Vector3<f64>,
    /// Rate of change of `value`.
    rate: Vector3<f64>,
    /// C Q̈ᵖ.
    particular: Vector3<f64>,
}

/// A scalar function of features at one state.
#[derive(Clone, Copy, Debug, Default)]
struct ScalarState {
    value: f64,
    rate: f64,
    /// Its second derivative along Q̈ᵖ.
    particular: f64,
    /// The part of its second derivative that is quadratic in the velocities.
    curvature: f64,
}

/// A product A_p D⁻¹ A_qᵀ that is added to a block of S.
#[derive(Clone, Copy, Debug)]
struct Contribution {
    slot: Slot,
    left: usize,
    right: usize,
}

/// Everything that changes with the state.
#[derive(Clone, Debug)]
pub struct Elimination {
    /// Bodies at the current state.
    pub bodies: Vec<BodyState>,
    features: Vec<FeatureState>,
    /// Angles at the current state.
    pub angles: Vec<AngleState>,
    angle_axes: Vec<FeatureId>,
    /// Prescribed vectors and numbers at the current time.
    curves: Vec<Jet<Vector3<f64>>>,
    targets: Vec<Jet<f64>>,
    time: f64,
    forces: Forces,
    /// For each row of form `CommonVector`, the two directions across the vector.
    transverse: Vec<[Vector3<f64>; 2]>,
    /// A and A D⁻¹, block by block.
    a: Vec<f64>,
    b: Vec<f64>,
    factor: BlockCholesky,
    contributions: Vec<Contribution>,
    /// γ' of the solver rows.
    gamma: Vec<f64>,
    /// Multipliers of the solver rows.
    lambda: Vec<f64>,
    residual: Vec<f64>,
    /// Whether S is known to be singular (redundant rows): always regularized.
    redundant: bool,
    /// Whether the current factor is that of a regularized S.
    regularized: bool,
    lends: bool,
    /// Smallest relative pivot of the current factor.
    pub smallest_pivot: f64,
    /// Work done so far.
    pub counters: Counters,
}

impl Elimination {
    /// Allocates for a system.
    pub fn new(system: &System) -> Self {
        let sizes: Vec<usize> = system.groups.iter().map(|g| g.solver.len()).collect();
        let edges = system.touching.iter().flat_map(|incidences| {
            incidences.iter().enumerate().flat_map(move |(k, &p)| {
                incidences[k + 1..]
                    .iter()
                    .map(move |&q| (system.incidences[p].group, system.incidences[q].group))
            })
        });
        let factor = BlockCholesky::new(&sizes, edges);
        let mut contributions = Vec::new();
        for incidences in &system.touching {
            for (k, &p) in incidences.iter().enumerate() {
                for &q in &incidences[k..] {
                    let slot = factor.slot(system.incidences[p].group, system.incidences[q].group);
                    let (left, right) = if slot.transposed { (q, p) } else { (p, q) };
                    contributions.push(Contribution { slot, left, right });
                }
            }
        }
        let mut features = vec![FeatureState::default(); system.features.len()];
        for (state, feature) in features.iter_mut().zip(&system.features) {
            if feature.is_fixed() {
                state.value = feature.local;
            }
        }
        let rows = system.solver_rows;
        let mut elimination = Self {
            bodies: vec![BodyState::default(); system.bodies.len()],
            forces: Forces::new(system.bodies.len(), &system.features),
            features,
            angles: vec![AngleState::default(); system.angles.len()],
            angle_axes: system.angles.iter().map(|a| a.axis).collect(),
            curves: vec![[Vector3::zeros(); 3]; system.curves.len()],
            targets: vec![[0.0; 3]; system.targets.len()],
            time: 0.0,
            transverse: vec![[Vector3::zeros(); 2]; system.rows.len()],
            a: vec![0.0; system.block_numbers],
            b: vec![0.0; system.block_numbers],
            factor,
            contributions,
            gamma: vec![0.0; rows],
            lambda: vec![0.0; rows],
            residual: vec![0.0; rows],
            redundant: false,
            regularized: false,
            lends: system.lends_inertia(),
            smallest_pivot: f64::INFINITY,
            counters: Counters::default(),
        };
        elimination.set_time(system, 0.0);
        elimination
    }

    /// Takes over the time t, s, on which drivers and loads depend.
    pub fn set_time(&mut self, system: &System, t: f64) {
        self.time = t;
        for (jet, curve) in self.curves.iter_mut().zip(&system.curves) {
            *jet = curve.at(t);
        }
        for (jet, target) in self.targets.iter_mut().zip(&system.targets) {
            *jet = target.at(t);
        }
    }

    /// The time on which drivers and loads depend, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Counts whole turns of angles from the current positions on.
    pub fn keep_turns(&mut self) {
        for angle in &mut self.angles {
            angle.reference = angle.value;
        }
    }

    /// Forgets whole turns.
    pub fn forget_turns(&mut self) {
        for angle in &mut self.angles {
            angle.reference = 0.0;
        }
    }

    /// The feature that is the axis of an angle.
    pub fn angle_axis(&self, angle: usize) -> FeatureId {
        self.angle_axes[angle]
    }

    /// Says that S is singular at every state, so that the regularization is not tried for first.
    pub fn set_redundant(&mut self, redundant: bool) {
        self.redundant = redundant;
    }

    /// Whether S is regularized at every state.
    pub fn is_redundant(&self) -> bool {
        self.redundant
    }

    /// Takes over the positions q.
    pub fn place(&mut self, system: &System, q: &[f64]) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.q = body.layout.position(q);
        }
        for (state, feature) in self.features[..system.moving].iter_mut().zip(&system.features) {
            if let BodyRef::Moving(body) = feature.body {
                let q = &self.bodies[body].q;
                state.arm = q.arm(&feature.local);
                state.value = if feature.point { q.r + state.arm } else { state.arm };
            }
        }
        for place in system.moving..system.changing {
            let feature = &system.features[place];
            let Some(curve) = feature.curve else { continue };
            let local = self.curves[curve][0];
            let state = &mut self.features[place];
            match feature.body {
                BodyRef::Ground => state.value = local,
                BodyRef::Moving(body) => {
                    let q = &self.bodies[body].q;
                    state.arm = q.arm(&local);
                    state.value = if feature.point { q.r + state.arm } else { state.arm };
                }
            }
        }
        for (state, angle) in self.angles.iter_mut().zip(&system.angles) {
            state.place(angle.features().map(|f| self.features[f].value));
        }
    }

    /// Takes over the velocities q̇; positions must be in place.
    pub fn set_velocity(&mut self, system: &System, q_dot: &[f64]) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.q_dot = body.layout.velocity(&state.q, q_dot);
        }
        for (state, feature) in self.features[..system.moving].iter_mut().zip(&system.features) {
            if let BodyRef::Moving(body) = feature.body {
                let q_dot = &self.bodies[body].q_dot;
                let arm = q_dot.arm(&feature.local);
                state.rate = if feature.point { q_dot.r + arm } else { arm };
            }
        }
        for place in system.moving..system.changing {
            let feature = &system.features[place];
            let Some(curve) = feature.curve else { continue };
            let [local, local_rate, _] = self.curves[curve];
            self.features[place].rate = match feature.body {
                BodyRef::Ground => local_rate,
                BodyRef::Moving(body) => {
                    let BodyState { q, q_dot, .. } = &self.bodies[body];
                    let turning = q_dot.arm(&local) + q.arm(&local_rate);
                    if feature.point { q_dot.r + turning } else { turning }
                }
            };
        }
        for (state, angle) in self.angles.iter_mut().zip(&system.angles) {
            let features = angle.features();
            state.set_velocity(
                features.map(|f| self.features[f].value),
                features.map(|f| self.features[f].rate),
            );
        }
    }

    /// Builds A, S and its factor at the current positions.
    pub fn linearize(&mut self, system: &System) {
        self.fill_blocks(system);
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.inverse = inverse_inertia(&state.q, &body.ibar, body.lent);
        }
        self.scale_blocks(system);
        self.regularized = self.redundant;
        let epsilon = if self.redundant { REGULARIZATION } else { 0.0 };
        self.assemble(system);
        let mut pivots = self.factor.factor(epsilon, 0.0, |_, _| {});
        self.counters.factorizations += 1;
        if !self.redundant && pivots.smallest < NEAR_SINGULAR {
            self.regularized = true;
            self.assemble(system);
            pivots = self.factor.factor(REGULARIZATION, 0.0, |_, _| {});
            self.counters.factorizations += 1;
        }
        self.smallest_pivot = pivots.smallest;
    }

    /// Relative pivots of S at the current positions, with dependent rows dropped: (solver row, pivot).
    pub fn pivots(&mut self, system: &System, skip: f64) -> Vec<(usize, f64)> {
        self.linearize(system);
        self.assemble(system);
        let mut pivots = Vec::with_capacity(system.solver_rows);
        self.factor.factor(0.0, skip, |row, pivot| pivots.push((row, pivot)));
        pivots
    }

    fn fill_blocks(&mut self, system: &System) {
        self.a.fill(0.0);
        for (index, row) in system.rows.iter().enumerate() {
            match row.form {
                Form::Coincidence { a, b } => {
                    for k in 0..3 {
                        let g = Vector3::ith(k, 1.0);
                        self.add_gradient(system, row, k, 0, a, &g);
                        self.add_gradient(system, row, k, 1, b, &-g);
                    }
                }
                Form::CommonVector { a, b } => {
                    self.transverse[index] = across(&self.features[a].value.normalize());
                    for k in 0..2 {
                        let t = self.transverse[index][k];
                        self.add_gradient(system, row, k, 0, a, &t);
                        self.add_gradient(system, row, k, 1, b, &-t);
                    }
                }
                Form::Product { a, b, .. } => {
                    let (x, y) = (self.difference(a, |f| f.value), self.difference(b, |f| f.value));
                    let mut place = 0;
                    for (difference, g) in [(a, y), (b, x)] {
                        self.add_gradient(system, row, 0, place, difference.plus, &g);
                        place += 1;
                        if let Some(minus) = difference.minus {
                            self.add_gradient(system, row, 0, place, minus, &-g);
                            place += 1;
                        }
                    }
                }
                Form::Relation { angles, slide, .. } => {
                    let mut place = 0;
                    for (angle, factor) in angles.into_iter().flatten() {
                        let gradient = self.angles[angle].gradient;
                        for (feature, g) in system.angles[angle].features().into_iter().zip(gradient) {
                            self.add_gradient(system, row, 0, place, feature, &(g * factor));
                            place += 1;
                        }
                    }
                    if let Some((a, b, factor)) = slide {
                        let (x, y) = (self.difference(a, |f| f.value), self.difference(b, |f| f.value));
                        for (difference, g) in [(a, y * factor), (b, x * factor)] {
                            self.add_gradient(system, row, 0, place, difference.plus, &g);
                            place += 1;
                            if let Some(minus) = difference.minus {
                                self.add_gradient(system, row, 0, place, minus, &-g);
                                place += 1;
                            }
                        }
                    }
                }
            }
        }
    }

    /// Adds the row gᵀ C of one feature, in twist form (g, arm × g) — eq. (7.4).
    fn add_gradient(
        &mut self,
        system: &System,
        row: &Row,
        k: usize,
        place: usize,
        feature: usize,
        g: &Vector3<f64>,
    ) {
        let incidence = row.incidence[place];
        if incidence == NO_INCIDENCE {
            return;
        }
        let at = system.incidences[incidence].offset + 6 * (row.local + k);
        let moment = self.features[feature].arm.cross(g);
        let block = &mut self.a[at..at + 6];
        if system.features[feature].point {
            for c in 0..3 {
                block[c] += g[c];
            }
        }
        for c in 0..3 {
            block[3 + c] += moment[c];
        }
    }

    /// A prescribed number and its derivatives at the current time.
    pub fn target(&self, target: Target) -> Jet<f64> {
        match target {
            Target::Constant(c) => [c, 0.0, 0.0],
            Target::Driven(curve) => self.targets[curve],
        }
    }

    /// a · b and what its derivatives are made of.
    fn product(&self, a: Difference, b: Difference) -> ScalarState {
        let (x, y) = (self.difference(a, |f| f.value), self.difference(b, |f| f.value));
        let (xr, yr) = (self.difference(a, |f| f.rate), self.difference(b, |f| f.rate));
        let (xp, yp) = (self.difference(a, |f| f.particular), self.difference(b, |f| f.particular));
        ScalarState {
            value: x.dot(&y),
            rate: x.dot(&yr) + xr.dot(&y),
            particular: x.dot(&yp) + xp.dot(&y),
            curvature: 2.0 * xr.dot(&yr),
        }
    }

    /// The left side of a relation between angles and a displacement.
    fn relation(&self, system: &System, form: &Form) -> ScalarState {
        let mut sum = ScalarState::default();
        let Form::Relation { angles, slide, constant } = *form else { return sum };
        sum.value = -constant;
        for (angle, factor) in angles.into_iter().flatten() {
            let state = &self.angles[angle];
            let features = system.angles[angle].features();
            let particular: f64 =
                features.iter().zip(&state.gradient).map(|(&f, g)| g.dot(&self.features[f].particular)).sum();
            sum.value += factor * state.value;
            sum.rate += factor * state.rate;
            sum.particular += factor * particular;
            sum.curvature += factor * state.curvature;
        }
        if let Some((a, b, factor)) = slide {
            let product = self.product(a, b);
            sum.value += factor * product.value;
            sum.rate += factor * product.rate;
            sum.particular += factor * product.particular;
            sum.curvature += factor * product.curvature;
        }
        sum
    }

    fn difference(&self, difference: Difference, of: impl Fn(&FeatureState) -> Vector3<f64>) -> Vector3<f64> {
        difference.of(|feature| of(&self.features[feature]))
    }

    /// Position of a feature's point, or its vector.
    pub fn feature_value(&self, feature: FeatureId) -> Vector3<f64> {
        self.features[feature].value
    }

    /// Rate of change of [`Self::feature_value`].
    pub fn feature_rate(&self, feature: FeatureId) -> Vector3<f64> {
        self.features[feature].rate
    }

    /// Local coordinates of a feature at the current time.
    pub fn feature_local(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system.features[feature];
        feature.curve.map_or(feature.local, |curve| self.curves[curve][0])
    }

    /// The part of a feature's rate that its prescribed motion makes.
    pub fn driven_rate(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system.features[feature];
        let Some(curve) = feature.curve else { return Vector3::zeros() };
        let rate = self.curves[curve][1];
        match feature.body {
            BodyRef::Ground => rate,
            BodyRef::Moving(body) => self.bodies[body].q.arm(&rate),
        }
    }

    /// The part of a feature's second derivative that its prescribed motion makes.
    pub fn driven_acceleration(&self, system: &System, feature: FeatureId) -> Vector3<f64> {
        let feature = &system.features[feature];
        let Some(curve) = feature.curve else { return Vector3::zeros() };
        let [_, rate, acceleration] = self.curves[curve];
        match feature.body {
            BodyRef::Ground => acceleration,
            BodyRef::Moving(body) => {
                let BodyState { q, q_dot, .. } = &self.bodies[body];
                q.arm(&acceleration) + q_dot.arm(&rate) * 2.0
            }
        }
    }

    /// Value, rate and curvature of a relation.
    pub fn relation_terms(&self, system: &System, form: &Form) -> (f64, f64, f64) {
        let relation = self.relation(system, form);
        (relation.value, relation.rate, relation.curvature)
    }

    fn scale_blocks(&mut self, system: &System) {
        for incidence in &system.incidences {
            let inverse = &self.bodies[incidence.body].inverse;
            let inverse_mass = 1.0 / system.bodies[incidence.body].mass;
            let range = incidence.offset..incidence.offset + 6 * incidence.rows;
            for (a, b) in self.a[range.clone()].chunks_exact(6).zip(self.b[range].chunks_exact_mut(6)) {
                let moment = inverse * Vector3::new(a[3], a[4], a[5]);
                for c in 0..3 {
                    b[c] = a[c] * inverse_mass;
                    b[3 + c] = moment[c];
                }
            }
        }
    }

    fn assemble(&mut self, system: &System) {
        self.factor.clear();
        let values = self.factor.values_mut();
        for contribution in &self.contributions {
            let (left, right) =
                (&system.incidences[contribution.left], &system.incidences[contribution.right]);
            let a = &self.a[left.offset..left.offset + 6 * left.rows];
            let b = &self.b[right.offset..right.offset + 6 * right.rows];
            let target = &mut values[contribution.slot.offset..];
            for (a, out) in a.chunks_exact(6).zip(target.chunks_exact_mut(right.rows)) {
                for (b, out) in b.chunks_exact(6).zip(out) {
                    *out += a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                }
            }
        }
    }

    /// Sets the particular accelerations and the wrenches from the right-hand sides Γ of the rigid-body rows.
    ///
    /// `gamma(q, q̇)` returns the symmetric matrix of those rows of a body: units on the diagonal, right angles off it.
    fn set_particular(
        &mut self,
        system: &System,
        velocity_terms: bool,
        gamma: impl Fn(&Lift, &Lift) -> Matrix3<f64>,
    ) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            let g = gamma(&state.q, &state.q_dot);
            let particular = particular_directors(
                body.coordinates,
                &state.q,
                &g,
                |w, a| {
                    if velocity_terms {
                        *w += 2.0 * a.e[0].cross(&a.e[1]);
                    }
                },
                &state.q_dot,
            );
            state.particular = Lift { r: Vector3::zeros(), e: particular };
            let mut moment = Vector3::zeros();
            for k in 0..3 {
                let p = state.force.e[k] - particular[k] * body.ibar[k];
                moment += state.q.e[k].cross(&p);
            }
            state.wrench = [state.force.r, moment];
        }
        for (state, feature) in self.features[..system.moving].iter_mut().zip(&system.features) {
            if let BodyRef::Moving(body) = feature.body {
                state.particular = self.bodies[body].particular.arm(&feature.local);
            }
        }
        for place in system.moving..system.changing {
            let feature = &system.features[place];
            let Some(curve) = feature.curve else { continue };
            let [local, local_rate, local_acceleration] = self.curves[curve];
            let mut particular = Vector3::zeros();
            if let BodyRef::Moving(body) = feature.body {
                let BodyState { q, q_dot, particular: p, .. } = &self.bodies[body];
                particular += p.arm(&local);
                if velocity_terms {
                    particular += q_dot.arm(&local_rate) * 2.0 + q.arm(&local_acceleration);
                }
            } else if velocity_terms {
                particular = local_acceleration;
            }
            self.features[place].particular = particular;
        }
    }

    /// Writes γ' = γ − Φ_Q Q̈ᵖ of the solver rows, γ of a product's velocity terms included if asked for, and of
    /// each equation whatever `shift(Φ, Φ̇)` adds.
    fn set_gamma(&mut self, system: &System, velocity_terms: bool, shift: impl Fn(f64, f64) -> f64) {
        for (index, row) in system.rows.iter().enumerate() {
            match row.form {
                Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                    let (a, b) = (&self.features[a], &self.features[b]);
                    let value = a.value - b.value;
                    let rate = a.rate - b.rate;
                    let gamma =
                        Vector3::from_fn(|k, _| shift(value[k], rate[k])) - (a.particular - b.particular);
                    if matches!(row.form, Form::Coincidence { .. }) {
                        self.gamma[row.solver..row.solver + 3].copy_from_slice(gamma.as_slice());
                    } else {
                        for k in 0..2 {
                            self.gamma[row.solver + k] = self.transverse[index][k].dot(&gamma);
                        }
                    }
                }
                Form::Product { a, b, target } => {
                    let [c, c_rate, c_acceleration] = self.target(target);
                    let product = self.product(a, b);
                    let mut gamma = shift(product.value - c, product.rate - c_rate) - product.particular;
                    if velocity_terms {
                        gamma += c_acceleration - product.curvature;
                    }
                    self.gamma[row.solver] = gamma;
                }
                Form::Relation { .. } => {
                    let relation = self.relation(system, &row.form);
                    let mut gamma = shift(relation.value, relation.rate) - relation.particular;
                    if velocity_terms {
                        gamma -= relation.curvature;
                    }
                    self.gamma[row.solver] = gamma;
                }
            }
        }
    }

    /// Solves for ξ̇ and λ with the wrenches and γ' in place.
    fn solve(&mut self, system: &System) {
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            state.twist = [state.wrench[0] / body.mass, state.inverse * state.wrench[1]];
            state.returned = Vector3::zeros();
        }
        // λ = S⁻¹ (A ξ₀ − γ'), ξ = ξ₀ − D⁻¹ Aᵀ λ.
        self.row_residual(system);
        self.factor.solve(&mut self.residual);
        self.counters.solves += 1;
        self.lambda.copy_from_slice(&self.residual);
        self.apply_multipliers(system);
        if self.regularized || self.lends {
            for _ in 0..REFINEMENTS {
                self.return_lent(system);
                self.row_residual(system);
                self.factor.solve(&mut self.residual);
                self.counters.solves += 1;
                for (lambda, correction) in self.lambda.iter_mut().zip(&self.residual) {
                    *lambda += correction;
                }
                self.apply_multipliers(system);
            }
        }
    }

    /// residual ← A ξ − γ'.
    fn row_residual(&mut self, system: &System) {
        for (residual, gamma) in self.residual.iter_mut().zip(&self.gamma) {
            *residual = -gamma;
        }
        for incidence in &system.incidences {
            let [v, w] = self.bodies[incidence.body].twist;
            let first = system.groups[incidence.group].solver.start;
            let block = &self.a[incidence.offset..incidence.offset + 6 * incidence.rows];
            for (a, residual) in block.chunks_exact(6).zip(&mut self.residual[first..]) {
                *residual +=
                    a[0] * v[0] + a[1] * v[1] + a[2] * v[2] + a[3] * w[0] + a[4] * w[1] + a[5] * w[2];
            }
        }
    }

    /// ξ ← ξ − D⁻¹ Aᵀ (residual as multipliers).
    fn apply_multipliers(&mut self, system: &System) {
        for incidence in &system.incidences {
            let [v, w] = &mut self.bodies[incidence.body].twist;
            let first = system.groups[incidence.group].solver.start;
            let block = &self.b[incidence.offset..incidence.offset + 6 * incidence.rows];
            for (b, lambda) in block.chunks_exact(6).zip(&self.residual[first..]) {
                for c in 0..3 {
                    v[c] -= b[c] * lambda;
                    w[c] -= b[3 + c] * lambda;
                }
            }
        }
    }

    /// One proximal step for bodies whose inertia was lent: D_δ ξ_(k+1) = D_δ ξ_k + δ (ω̇_k − ω̇_(k−1)).
    fn return_lent(&mut self, system: &System) {
        if !self.lends {
            return;
        }
        for (state, body) in self.bodies.iter_mut().zip(&system.bodies) {
            if body.lent > 0.0 {
                let current = state.twist[1];
                state.twist[1] += state.inverse * ((current - state.returned) * body.lent);
                state.returned = current;
            }
        }
    }

    /// Q̈ (or a correction of Q) of a body from the solution.
    pub fn lifted_solution(&self, body: usize) -> Lift {
        let state = &self.bodies[body];
        let e = [0, 1, 2].map(|k| state.particular.e[k] + state.twist[1].cross(&state.q.e[k]));
        Lift { r: state.twist[0], e }
    }

    /// Accelerations at (q, q̇): writes q̈, keeps λ. α and β are those of Baumgarte's stabilization, or zero.
    pub fn accelerate(
        &mut self,
        system: &System,
        q: &[f64],
        q_dot: &[f64],
        baumgarte: (f64, f64),
        out: &mut [f64],
    ) {
        self.place(system, q);
        self.set_velocity(system, q_dot);
        self.linearize(system);
        self.set_forces(system);
        let (damping, stiffness) = (2.0 * baumgarte.0, baumgarte.1 * baumgarte.1);
        let correction = move |value: f64, rate: f64| -damping * rate - stiffness * value;
        self.set_particular(system, true, |q, q_dot| {
            gram(|k, l| {
                let value = q.e[k].dot(&q.e[l]) - if k == l { 1.0 } else { 0.0 };
                let rate = q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k]);
                -2.0 * q_dot.e[k].dot(&q_dot.e[l]) + correction(value, rate)
            })
        });
        self.set_gamma(system, true, correction);
        self.solve(system);
        self.counters.evaluations += 1;
        for (index, body) in system.bodies.iter().enumerate() {
            body.layout.store(&self.lifted_solution(index), out);
        }
    }

    /// Weight of each body and all loads; time, positions and velocities must be in place.
    pub fn set_forces(&mut self, system: &System) {
        let mut forces = std::mem::take(&mut self.forces);
        for (lift, body) in forces.lifts.iter_mut().zip(&system.bodies) {
            *lift = Lift { r: system.model.gravity * body.mass, e: [Vector3::zeros(); 3] };
        }
        for load in &system.loads {
            load.apply(self, self.time, &mut forces);
        }
        for (state, lift) in self.bodies.iter_mut().zip(&forces.lifts) {
            state.force = *lift;
        }
        self.forces = forces;
    }

    fn clear_forces(&mut self) {
        for state in &mut self.bodies {
            state.force = Lift::default();
        }
    }

    /// One mass-orthogonal Newton step of the positions q towards Φ = 0, with the factor at hand. Returns the size
    /// of the step.
    pub fn correct_positions(&mut self, system: &System, q: &mut [f64]) -> f64 {
        self.clear_forces();
        self.set_particular(system, false, |q, _| {
            gram(|k, l| if k == l { 1.0 } else { 0.0 } - q.e[k].dot(&q.e[l]))
        });
        self.set_gamma(system, false, |value, _| -value);
        self.apply_correction(system, q)
    }

    /// One mass-orthogonal Newton step of the velocities q̇ towards Φ̇ = 0, with the factor at hand.
    pub fn correct_velocities(&mut self, system: &System, q_dot: &mut [f64]) -> f64 {
        self.clear_forces();
        self.set_particular(system, false, |q, q_dot| {
            gram(|k, l| -(q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k])))
        });
        self.set_gamma(system, false, |_, rate| -rate);
        self.apply_correction(system, q_dot)
    }

    fn apply_correction(&mut self, system: &System, target: &mut [f64]) -> f64 {
        self.solve(system);
        let mut largest: f64 = 0.0;
        for (index, body) in system.bodies.iter().enumerate() {
            let solution = self.lifted_solution(index);
            body.layout.own_numbers(&solution, |column, dx| {
                target[column] += dx;
                largest = largest.max(dx.abs());
            });
        }
        largest
    }

    /// Multipliers of the equations of a joint's row, as written: those of a common vector are μ₁ t₁ + μ₂ t₂.
    pub fn multipliers(&self, index: usize, row: &Row) -> Vec<f64> {
        match row.form {
            Form::Coincidence { .. } => self.lambda[row.solver..row.solver + 3].to_vec(),
            Form::CommonVector { .. } => {
                let [t1, t2] = self.transverse[index];
                let sum = t1 * self.lambda[row.solver] + t2 * self.lambda[row.solver + 1];
                sum.as_slice().to_vec()
            }
            Form::Product { .. } | Form::Relation { .. } => vec![self.lambda[row.solver]],
        }
    }

    /// The rows A_b of an incidence, six numbers each: translation, then rotation.
    pub fn rows_on(&self, system: &System, incidence: usize) -> &[f64] {
        let incidence = &system.incidences[incidence];
        &self.a[incidence.offset..incidence.offset + 6 * incidence.rows]
    }

    /// Multipliers of the solver rows.
    pub fn solver_multipliers(&self) -> &[f64] {
        &self.lambda
    }

    /// Force and moment about the centre of mass, −A_bᵀ λ, of a joint on a body.
    pub fn wrench_on(&self, system: &System, incidence: usize) -> [Vector3<f64>; 2] {
        let incidence = &system.incidences[incidence];
        let lambda = &self.lambda[system.groups[incidence.group].solver.clone()];
        let mut wrench = [Vector3::zeros(); 2];
        for (a, lambda) in self.a[incidence.offset..].chunks_exact(6).zip(lambda) {
            wrench[0] -= Vector3::new(a[0], a[1], a[2]) * *lambda;
            wrench[1] -= Vector3::new(a[3], a[4], a[5]) * *lambda;
        }
        wrench
    }

    /// The joint whose rows are violated most, and by how much; positions must be in place.
    pub fn worst_group(&self, system: &System) -> (usize, f64) {
        let mut worst = (0, 0.0);
        for (index, group) in system.groups.iter().enumerate() {
            for row in &system.rows[group.forms.clone()] {
                let violation = self.row_violation(system, &row.form).0;
                if violation > worst.1 {
                    worst = (index, violation);
                }
            }
        }
        worst
    }

    /// Largest |Φ| and |Φ̇| of one row form.
    fn row_violation(&self, system: &System, form: &Form) -> (f64, f64) {
        match *form {
            Form::Coincidence { a, b } | Form::CommonVector { a, b } => {
                let (a, b) = (&self.features[a], &self.features[b]);
                ((a.value - b.value).amax(), (a.rate - b.rate).amax())
            }
            Form::Product { a, b, target } => {
                let product = self.product(a, b);
                let [c, c_rate, _] = self.target(target);
                ((product.value - c).abs(), (product.rate - c_rate).abs())
            }
            Form::Relation { .. } => {
                let relation = self.relation(system, form);
                (relation.value.abs(), relation.rate.abs())
            }
        }
    }

    /// Largest |Φ| and |Φ̇| over all rows, rigid-body rows included; positions and velocities must be in place.
    pub fn violation(&self, system: &System) -> (f64, f64) {
        let (mut position, mut velocity) = (0.0f64, 0.0f64);
        for state in &self.bodies {
            let (q, q_dot) = (&state.q, &state.q_dot);
            for k in 0..3 {
                for l in 0..=k {
                    let unit = if k == l { 1.0 } else { 0.0 };
                    position = position.max((q.e[k].dot(&q.e[l]) - unit).abs());
                    velocity = velocity.max((q.e[k].dot(&q_dot.e[l]) + q.e[l].dot(&q_dot.e[k])).abs());
                }
            }
        }
        for row in &system.rows {
            let (value, rate) = self.row_violation(system, &row.form);
            position = position.max(value);
            velocity = velocity.max(rate);
        }
        (position, velocity)
    }

    /// Kinetic plus potential energy, springs included, J; positions and velocities must be in place.
    pub fn energy(&self, system: &System) -> f64 {
        let gravity = system.model.gravity;
        let springs: f64 = system.loads.iter().map(|load| load.potential(self)).sum();
        let bodies: f64 = self
            .bodies
            .iter()
            .zip(&system.bodies)
            .map(|(state, body)| {
                let turning: f64 = (0..3).map(|k| body.ibar[k] * state.q_dot.e[k].norm_squared()).sum();
                0.5 * (body.mass * state.q_dot.r.norm_squared() + turning)
                    - body.mass * gravity.dot(&state.q.r)
            })
            .sum();
        bodies + springs
    }
}

/// Symmetric 3 × 3 matrix of entries (k, l), k ≥ l.
fn gram(entry: impl Fn(usize, usize) -> f64) -> Matrix3<f64> {
    let (a, b, c) = (entry(1, 0), entry(2, 0), entry(2, 1));
    Matrix3::new(entry(0, 0), a, b, a, entry(1, 1), c, b, c, entry(2, 2))
}

/// ë_l = ½ Σ_k Γ_kl eᵏ with the dual basis eᵏ of the directors — eq. (7.1). For a reduced body only u and v have
/// rows, and ẅ follows from w = u × v; `extra` adds its velocity term.
fn particular_directors(
    coordinates: Coordinates,
    q: &Lift,
    gamma: &Matrix3<f64>,
    extra: impl Fn(&mut Vector3<f64>, &Lift),
    q_dot: &Lift,
) -> [Vector3<f64>; 3] {
    let [u, v, w] = q.e;
    let dual = [v.cross(&w), w.cross(&u), u.cross(&v)];
    let half = 0.5 / u.dot(&dual[0]);
    match coordinates {
        Coordinates::Full => [0, 1, 2]
            .map(|l| (dual[0] * gamma[(0, l)] + dual[1] * gamma[(1, l)] + dual[2] * gamma[(2, l)]) * half),
        Coordinates::Reduced => {
            let [a, b] = [0, 1].map(|l| (dual[0] * gamma[(0, l)] + dual[1] * gamma[(1, l)]) * half);
            let mut c = a.cross(&v) + u.cross(&b);
            extra(&mut c, q_dot);
            [a, b, c]
        }
    }
}

/// Inverse of I_g = Σ Ī_k (|e_k|² I − e_k e_kᵀ), with `lent` added to its diagonal.
fn inverse_inertia(q: &Lift, ibar: &Vector3<f64>, lent: f64) -> Matrix3<f64> {
    let mut inertia = Matrix3::from_diagonal_element(lent);
    for k in 0..3 {
        let e = q.e[k];
        let trace = ibar[k] * e.norm_squared();
        inertia += Matrix3::from_diagonal_element(trace) - e * e.transpose() * ibar[k];
    }
    let [a, b, c] = [0, 1, 2].map(|k| inertia.column(k).into_owned());
    let (bc, ca, ab) = (b.cross(&c), c.cross(&a), a.cross(&b));
    let scale = 1.0 / a.dot(&bc);
    // Rows of the inverse of a matrix with columns a, b, c; it is symmetric.
    Matrix3::from_columns(&[bc * scale, ca * scale, ab * scale])
}
