//! A body in space on which nothing acts but its weight, and that nothing joins to others: Euler's equations — eq. (11.14).

use super::components::{Components, ZERO, directors, turned};
use crate::dynamics::series::lanes::{difference_whole, plus_whole, rows_of_lanes, times_whole};
use crate::dynamics::series::recurrence::{for_folded, real};
use crate::system::System;
use crate::system::body::RigidBody;
use nalgebra::Vector3;
use pulp::Simd;

/// Its constants, and its rotation in its own frame.
#[derive(Clone, Debug)]
pub struct Alone {
    /// Half the acceleration of its centre of mass.
    fall: Components,
    /// (J_v − J_w)/J_u and the like.
    gyration: Components,
    /// What the components of its weight, one and two places on, do to the rate of rotation.
    torque: [Components; 2],
    /// Its weight, component by component.
    weight: [Components; 3],
    orders: Vec<Order>,
}

/// Coefficients of one order.
#[derive(Clone, Copy, Debug)]
struct Order {
    /// ρ of the axes of the world, and the same one place on.
    axes: [[Components; 2]; 3],
    /// The rate of rotation ω, and the same one and two places on.
    omega: [Components; 3],
}

const NOTHING: Order = Order { axes: [[ZERO; 2]; 3], omega: [ZERO; 3] };

impl Alone {
    pub fn empty() -> Self {
        Self { fall: ZERO, gyration: ZERO, torque: [ZERO; 2], weight: [ZERO; 3], orders: Vec::new() }
    }

    pub fn of(system: &System, body: &RigidBody) -> Self {
        let wide = |x: Vector3<f64>| [x[0], x[1], x[2], 0.0];
        let on = |x: Vector3<f64>| Vector3::new(x[1], x[2], x[0]);
        let (force, center) = (system.model.gravity * body.mass, body.center());
        // J_u = Ī_v + Ī_w.
        let inertia = Vector3::repeat(body.ibar.sum()) - body.ibar;
        let gyration = (on(inertia) - on(on(inertia))).component_div(&inertia);
        let torque = [-on(on(center)), on(center)].map(|arm| wide(arm.component_div(&inertia)));
        Self {
            fall: wide(force * (0.5 * body.free_inverse_mass())),
            gyration: wide(gyration),
            torque,
            weight: [0, 1, 2].map(|j| [force[j]; 4]),
            orders: Vec::new(),
        }
    }

    /// Q_(n+2) from all coefficients before it: order 0 begins anew, from Q_0 and Q_1.
    #[inline(always)]
    pub fn expand<S: Simd>(&mut self, simd: S, q: &[[Components; 4]], n: usize) -> [Components; 4] {
        if n == 0 {
            self.begin(simd, q);
        }
        self.advance(simd, n + 1);
        let [x, y, z] = self.orders[n + 2].axes.map(|[axis, _]| axis);
        let [u, v, w, _] = rows_of_lanes(simd, [x, y, z, ZERO]);
        [if n == 0 { self.fall } else { ZERO }, u, v, w]
    }

    /// Orders 0 and 1 of ρ, which are given, and of ω: twice ω is the sum of all ρ̇ × ρ.
    #[inline(always)]
    fn begin<S: Simd>(&mut self, simd: S, q: &[[Components; 4]]) {
        if self.orders.len() < q.len() {
            self.orders.resize(q.len(), NOTHING);
        }
        for (order, q) in self.orders.iter_mut().zip(&q[..2]) {
            let &[u, v, w] = directors(q);
            let [x, y, z, _] = rows_of_lanes(simd, [u, v, w, ZERO]);
            order.axes = [x, y, z].map(|axis| [axis, turned(axis)]);
        }
        let (mut ahead, mut behind) = (ZERO, ZERO);
        for j in 0..3 {
            let ([axis, next], [rate, next_rate]) = (self.orders[0].axes[j], self.orders[1].axes[j]);
            ahead = plus_whole(simd, &rate, &next, &ahead);
            behind = plus_whole(simd, &next_rate, &axis, &behind);
        }
        let twice = turned(difference_whole(simd, &ahead, &behind));
        self.orders[0].omega = all_places(times_whole(simd, &[0.5; 4], &twice));
        let given = self.orders[1].axes;
        self.advance(simd, 0);
        self.orders[1].axes = given;
    }

    /// Order k + 1 from those before it: ρ̇ = ρ × ω, and J ω̇ = J ω × ω + c × G.
    #[inline(always)]
    fn advance<S: Simd>(&mut self, simd: S, k: usize) {
        let mut sums = Sums { ahead: [ZERO; 3], behind: [ZERO; 3], gyration: ZERO };
        let half = k.div_ceil(2);
        if k.is_multiple_of(2) {
            sums.add(simd, &self.orders[half], &self.orders[half]);
        }
        let (heads, tails) = (&self.orders[..half], &self.orders[k + 1 - half..=k]);
        for_folded!(heads, tails, a, b => {
            sums.add(simd, a, b);
            sums.add(simd, b, a);
        });
        let by = [1.0 / real(k + 1); 4];
        let mut next = NOTHING;
        let mut weight = ZERO;
        for j in 0..3 {
            let across = difference_whole(simd, &sums.ahead[j], &sums.behind[j]);
            let axis = turned(times_whole(simd, &by, &across));
            next.axes[j] = [axis, turned(axis)];
            weight = plus_whole(simd, &self.weight[j], &self.orders[k].axes[j][0], &weight);
        }
        let weight = [turned(weight), turned(turned(weight))];
        let torque = times_whole(simd, &self.torque[0], &weight[0]);
        let torque = plus_whole(simd, &self.torque[1], &weight[1], &torque);
        let rate = plus_whole(simd, &self.gyration, &sums.gyration, &torque);
        next.omega = all_places(times_whole(simd, &by, &rate));
        self.orders[k + 1] = next;
    }
}

/// A vector, and it one and two places on.
#[inline(always)]
fn all_places(x: Components) -> [Components; 3] {
    [x, turned(x), turned(turned(x))]
}

/// Sums of products, apart from each other so that none waits for another.
struct Sums {
    ahead: [Components; 3],
    behind: [Components; 3],
    gyration: Components,
}

impl Sums {
    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, a: &Order, b: &Order) {
        let [omega, next, after] = &b.omega;
        for (j, [axis, next_axis]) in a.axes.iter().enumerate() {
            self.ahead[j] = plus_whole(simd, axis, next, &self.ahead[j]);
            self.behind[j] = plus_whole(simd, next_axis, omega, &self.behind[j]);
        }
        self.gyration = plus_whole(simd, &a.omega[1], after, &self.gyration);
    }
}
