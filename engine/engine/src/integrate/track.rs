//! The motion within a step, and states beside it: what the search for singular configurations asks of a method.

/// A state that can be put anywhere on the path of the last step, and moved from there onto the constraints. Its numbers are
/// positions, then as many velocities.
pub trait Track {
    /// How many numbers there are.
    fn numbers(&self) -> usize;

    /// Length of the mechanism, m.
    fn length(&self) -> f64;

    /// Takes the state at time t of the last step, or a little before or after it.
    fn place(&mut self, t: f64);

    /// The same on one smooth curve over the whole step.
    fn place_smoothly(&mut self, t: f64) {
        self.place(t);
    }

    /// Writes the numbers of the state.
    fn read(&mut self, out: &mut [f64]);

    /// Takes over numbers as the state at time t.
    fn write(&mut self, t: f64, numbers: &[f64]);

    /// Moves the state onto the constraints. Returns how far a number was moved, if that was possible.
    fn project(&mut self) -> Option<f64>;

    /// Largest |Φ| of the state relative to the size of its row.
    fn open(&mut self) -> f64;

    /// Pivot products of the joints at the state.
    fn pivot_products(&mut self) -> &[f64];

    /// Those at four times of the last step, joint by joint, where they can be found at once; the state stays as it is.
    fn pivot_products_at(&mut self, _times: [f64; 4]) -> Option<&[[f64; 4]]> {
        None
    }

    /// Which joints take part where rows of `joints`, with their weights, nearly depend on others, at the last pivot products: raises
    /// the share of each to at most one.
    fn raise_shares(&mut self, joints: &[(usize, f64)], shares: &mut [f64]);
}
