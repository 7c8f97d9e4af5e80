//! The coefficients of the method of conjugate residuals, and when it ends.

/// Most steps: in exact arithmetic there are as many as rotations without inertia that differ.
const MOST_STEPS: usize = 100;
/// Part of all that makes moments below which the residual is rounding.
const ROUNDING: f64 = 4e-15;
/// Part of the residual before that a step leaves at least where it has met nothing but rounding, which nothing holds.
const STALLED: f64 = 0.98;
/// Part of a residual, or of a direction, below which what inertia makes of it may be rounding, which is that of I_g beside δ: nothing holds
/// the bodies along it.
const HELD: f64 = 1e-6;
/// The same for the residual where the iteration ends.
const FREE: f64 = 1e-3;

/// Conjugate residuals: where nothing holds the bodies the iteration stays where it began. Products and squares are sums of δ a · b over the
/// bodies.
#[derive(Clone, Copy, Debug)]
pub struct ConjugateResiduals {
    steps: usize,
    /// Square of the residual.
    square: f64,
    /// Product of the residual and of what the bodies' inertia makes of it.
    product: f64,
    /// Whether a step has left nearly the whole residual, and whether nothing holds the bodies along it.
    stalls: bool,
    free: bool,
}

impl ConjugateResiduals {
    pub fn begin() -> Self {
        Self { steps: 0, square: f64::INFINITY, product: 0.0, stalls: false, free: false }
    }

    /// Whether it goes on, from the squares of the residual, and of what all that makes moments would make.
    pub fn goes_on(&mut self, square: f64, scale: f64) -> bool {
        self.stalls = square >= STALLED * STALLED * self.square;
        self.square = square;
        self.steps += 1;
        self.free = false;
        // False for NaN as well.
        square > ROUNDING * ROUNDING * scale && self.steps <= MOST_STEPS
    }

    /// β, the part of the last direction that is added to the residual for the next one, from the product of the residual and of what the
    /// bodies' inertia makes of it. `None` where nothing holds the bodies, or only rounding is left of what does.
    pub fn beta(&mut self, product: f64) -> Option<f64> {
        let beta = if self.steps > 1 { product / self.product } else { 0.0 };
        self.product = product;
        self.free = product <= FREE * self.square;
        (product > HELD * self.square && !self.stalls).then_some(beta)
    }

    /// α, the length of a step along a direction, from its own square and that of what inertia makes of it. `None` where nothing holds the
    /// bodies.
    pub fn alpha(&self, square: f64, made: f64) -> Option<f64> {
        (made > HELD * HELD * square).then(|| self.product / made)
    }

    /// Whether it has ended where nothing holds the bodies along the residual.
    pub fn is_free(&self) -> bool {
        self.free
    }
}
