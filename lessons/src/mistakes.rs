//! Mistakes that any question knows by itself: their stable codes, and what is said about each. The words say what to look
//! at, and never what is right.

/// A usual mistake.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Mistake {
    /// Stable name, kept with the verdict.
    pub code: &'static str,
    /// What to look at.
    pub words: &'static str,
}

macro_rules! mistakes {
    ($($name:ident $code:literal $words:literal)*) => {
        $(pub(crate) const $name: &Mistake = &Mistake { code: $code, words: $words };)*
        /// Every one, for the test that their codes are unique.
        #[cfg(test)]
        pub(crate) const ALL: &[&Mistake] = &[$($name),*];
    };
}

mistakes! {
    // Of a number, seen from the right answer alone.
    ZERO "zero"
        "Zero would mean that nothing acts, moves or is left. Which force, motion or term does not vanish here?"
    NEARLY "nearly"
        "Very close, but outside what counts as right: carry more digits through the calculation and round at the end."
    FACTOR_TWO "factor-two"
        "A factor of 2 stands between your answer and the right one. Look for a ½, a diameter in the place of a radius, a whole length for half of it, something counted once that is there twice."
    FACTOR_PI "factor-pi"
        "A π or 2π stands between your answer and the right one: turns and radians, or a circumference."
    ANGLE_UNIT "angle-unit"
        "Degrees and radians are mixed up: sine, cosine and angular velocities want radians."
    ROOT_TWO "factor-root-two"
        "A √2 stands between your answer and the right one: a diagonal for a side, or a square and a root that do not belong together."
    SMALL_FACTOR "factor-small"
        "The answer is off by a plain factor. Go through the numbers in front: halves, thirds, and how often each part occurs."
    UPSIDE_DOWN "upside-down"
        "Something is upside down: what grows when this quantity grows, and does your formula do the same?"
    PERIOD "period"
        "Period, frequency and angular velocity are mixed up: a turn is 2π radians, and a period is the time of one turn."
    POWER "power"
        "A square or a square root is missing somewhere, or one too many: compare the units of both sides."
    MASS_AND_WEIGHT "mass-and-weight"
        "Mass and weight are mixed up: see where g belongs, and where it does not."
    OTHER_GRAVITY "other-gravity"
        "Nearly: you seem to have taken another g than the one that is stated."
    GIVEN_NUMBER "given-number"
        "This is one of the given numbers as it stands. What has to be done with it?"
    GIVEN_FACTOR "given-factor"
        "One of the given numbers is a factor too many, or one is missing: compare the units of both sides."
    PART_RESULT "part-result"
        "This is a step on the way, and a right one: go on from here."
    // Of vectors and matrices.
    COMPONENT_SIGN "component-sign"
        "The sizes of the components are right, a sign is not: look at the directions of the axes."
    COMPONENT_ORDER "component-order"
        "The sizes of the components are right, but they stand in other places: which axis is which?"
    COMPONENT_MISSING "component-missing"
        "A component is left out: it is zero here, and should not be."
    ONE_COMPONENT "one-component"
        "Part of it is right, one component is not: do that one again."
    LENGTH "length"
        "The direction is right, the size is not."
    LINE "line"
        "It lies along the right line, but neither the sense nor the size is right."
    OTHER_DIRECTION "other-direction"
        "It points in quite another direction: draw the axes and the vector before you calculate."
    OTHER_ROTATION "other-rotation"
        "This is a rotation, but another one: about which axis, by which angle, and which way round?"
    TRANSPOSED "transposed"
        "Rows and columns are exchanged: this is the transposed matrix."
    IDENTITY "identity"
        "This is the identity: nothing has happened yet. What has turned or moved by then?"
    ENTRY_SIGN "entry-sign"
        "The entries stand in the right places, a sign is not right."
    ENTRY_ORDER "entry-order"
        "The entries are the right ones in other rows or columns: about which axis does it turn, and which vector stands where?"
    // Of the way to a number, seen from the expression of the reference.
    SINE_COSINE "sine-cosine"
        "Is it the sine, the cosine or the tangent? Draw the triangle and look at very small angles."
    FUNCTION_MISSING "function-missing"
        "A function is left out: a sine, a root or a logarithm belongs where only its argument stands."
    TERM_MISSING "term-missing"
        "A part is left out: go through everything that contributes, one by one."
    TERM_SIGN "term-sign"
        "The parts are there, the sign of one of them is not right: which of them work against each other?"
    PART_TWICE "part-factor-two"
        "In one part a factor of 2 is missing, or one too many: is there a ½, or something that is there twice?"
    INERTIA "moment-of-inertia"
        "Look at the moment of inertia: about which axis, and through which point?"
    FACTOR_MISSING "factor-missing"
        "A factor or a divisor is missing: compare the units, and look at what each given number does."
    OTHER_NUMBER "other-number"
        "Two of the numbers are taken for each other: see which one belongs where."
    OFF_BY_ONE "off-by-one"
        "One too many or one too few: what is counted twice, or not at all?"
    COUNT "count"
        "Something is left out, or counted more than once: list everything that belongs here, each with its number."
    NO_WHOLE_NUMBER "no-whole-number"
        "This can only be a whole number."
    // Of a formula.
    CONSTANT_FACTOR "constant-factor"
        "The symbols are right, a number in front is not."
    CONSTANT_TERM "constant-term"
        "The part with the symbols is right, a number that is added is not."
    SYMBOL_POWER "symbol-power"
        "A symbol stands with another power than it should: compare the units of both sides."
    SYMBOLS_MISSING "symbols-missing"
        "The answer depends on more of the symbols than yours does."
    // Of the model, seen by running a wrong one.
    OTHER_SIDE "other-side"
        "This is the force or moment on the other body: who exerts it on whom?"
    OTHER_FRAME "other-frame"
        "These are the components in another frame: along the axes of the body, or of the ground?"
    NO_GRAVITY "no-gravity"
        "This is what would happen without weight."
    GRAVITY_UP "gravity-up"
        "Here the weight acts upwards: look at the axis and the sign of g."
    AT_REST "at-rest"
        "This is the answer for a mechanism at rest: what does the motion add?"
    AT_START "at-start"
        "This is the value at the start: which moment is asked for?"
    OTHER_MOMENT "other-moment"
        "This belongs to another moment: which time is asked for?"
    OTHER_POINT "other-point"
        "This belongs to another point of the body: which one is asked for?"
    OTHER_BODY "other-body"
        "This belongs to another body."
    OTHER_JOINT "other-joint"
        "This belongs to another joint."
    OTHER_QUANTITY "other-quantity"
        "This is another quantity of the same thing: look again at what is asked for, position or velocity, force or moment."
    OTHER_COMPONENT "other-component"
        "This is another component, or the size of the whole vector: look again at which one is asked for."
    // Of a table of a motion.
    MIRROR_IMAGE "mirror-image"
        "One column is the mirror image of what it should be: look at the direction of its axis and at the start."
    SWAPPED_COLUMNS "swapped-columns"
        "The columns stand in each other's places, or the axes are turned: which one is which?"
    TABLE_UNITS "table-units"
        "The numbers are in another unit: metres, centimetres or millimetres, radians or degrees?"
    TIME_COLUMN "time-column"
        "The motion is right, but runs at another pace: look at the time column and at the step of the program."
    VELOCITIES "velocities"
        "These are the rates of what is asked for: velocities in the place of positions."
    MOTIONLESS "motionless"
        "Nothing moves in this table: is every step written after it was made?"
    OTHER_ORIGIN "other-origin"
        "The motion is right, but counts from another point: where is the origin?"
    TABLE_SCALE "table-scale"
        "The motion is right, but all its lengths are multiplied: look at the length that you took, and at the origin."
    SMALL_ANGLES "small-angles"
        "This is the harmonic motion of small angles; these angles are not small."
    GROWING "growing-swings"
        "The swings grow with time, so energy is made: look at the integrator and at its step. Explicit Euler does so."
    DYING "dying-swings"
        "The swings shrink with time, so energy is lost: look at the integrator and at its step. Implicit Euler does so."
    OTHER_COUNT "other-count"
        "This is another count of the same scene: coordinates, rows, independent rows and degrees of freedom are four different numbers."
}

#[cfg(test)]
mod tests {
    use super::ALL;
    use std::collections::BTreeSet;

    #[test]
    fn codes_are_unique_and_words_are_sentences() {
        let codes: BTreeSet<&str> = ALL.iter().map(|m| m.code).collect();
        assert_eq!(codes.len(), ALL.len());
        for mistake in ALL {
            assert!(mistake.code.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{}", mistake.code);
            assert!(
                mistake.words.ends_with(['.', '?']) && !mistake.words.contains(['<', '&']),
                "{}",
                mistake.words
            );
        }
    }
}
