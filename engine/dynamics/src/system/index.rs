//! Places in the lists of a system, each of a type of its own: none can be taken for another.

macro_rules! index_types {
    ($($(#[$text:meta])* $name:ident;)*) => {$(
        $(#[$text])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);

        impl $name {
            /// The place as a number.
            #[inline]
            pub const fn index(self) -> usize {
                self.0
            }
        }
    )*};
}

index_types! {
    /// A feature: a point or a vector of a body or of the ground.
    FeatureId;
    /// A joint or driver with its rows: first the joints, then the drivers, each in the scene's order.
    ConstraintId;
    /// A row form.
    RowId;
    /// A joint's block of the twist Jacobian for one of its bodies.
    IncidenceId;
    /// A row of the solver: of A, S and λ.
    SolverRow;
    /// An equation as a student writes it: a row of Φ, ν, γ and Φ_q, those of rigid bodies first.
    EquationId;
}
