//! Bodies in a plane on which nothing acts but their weight, and that nothing joins to others — eq. (11.15).

use super::pair::{Pair, cross};
use crate::dynamics::series::lanes::{Lane, plus, times};
use crate::dynamics::series::recurrence::{for_folded, real};

/// Their rotation, order by order.
#[derive(Clone, Debug)]
pub struct AloneInPlane<const L: usize> {
    /// What the weight does to the director, over the moment of inertia.
    torque: Pair<L>,
    orders: Vec<Order<L>>,
}

/// Coefficients of one order: of z, and of the rate of rotation ω.
#[derive(Clone, Copy, Debug)]
struct Order<const L: usize> {
    z: Pair<L>,
    omega: Lane<L>,
}

impl<const L: usize> AloneInPlane<L> {
    pub fn empty() -> Self {
        Self { torque: [[0.0; L]; 2], orders: Vec::new() }
    }

    pub fn set_torque(&mut self, lane: usize, torque: [f64; 2]) {
        for (own, torque) in self.torque.iter_mut().zip(torque) {
            own[lane] = torque;
        }
    }

    /// Coefficient n + 2 of z from those before it: order 0 begins anew, from the first two.
    #[inline(always)]
    pub fn expand(&mut self, q: &[[Pair<L>; 2]], n: usize) -> Pair<L> {
        if n == 0 {
            self.begin(q);
        }
        self.advance(n + 1);
        self.orders[n + 2].z
    }

    #[inline(always)]
    fn begin(&mut self, q: &[[Pair<L>; 2]]) {
        if self.orders.len() < q.len() {
            self.orders.resize(q.len(), Order { z: [[0.0; L]; 2], omega: [0.0; L] });
        }
        let [z, rate] = [q[0][1], q[1][1]];
        self.orders[0] = Order { z, omega: cross(&z, &rate) };
        self.advance(0);
        self.orders[1].z = rate;
    }

    /// Order k + 1 from those before it: ż = ω J z, and I ω̇ = z × f.
    #[inline(always)]
    fn advance(&mut self, k: usize) {
        let mut sums = [[0.0; L]; 2];
        let half = k.div_ceil(2);
        if k.is_multiple_of(2) {
            let Order { z, omega } = &self.orders[half];
            sums = [times(omega, &z[0]), times(omega, &z[1])];
        }
        let (heads, tails) = (&self.orders[..half], &self.orders[k + 1 - half..=k]);
        for_folded!(heads, tails, a, b => {
            for c in 0..2 {
                sums[c] = plus(&a.omega, &b.z[c], &plus(&b.omega, &a.z[c], &sums[c]));
            }
        });
        let by = [1.0 / real(k + 1); L];
        let [across, along] = [[-by[0]; L], by];
        let omega = times(&by, &cross(&self.orders[k].z, &self.torque));
        self.orders[k + 1] = Order { z: [times(&across, &sums[1]), times(&along, &sums[0])], omega };
    }
}
