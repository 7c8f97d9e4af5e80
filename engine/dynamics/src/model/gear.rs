//! The wheels of a gear.

use super::BodyRef;

/// Which side of each of two hinges is the wheel of a gear that couples them: one that moves and is not of both hinges, as a carrier
/// is, rather body j. They are never the same body.
pub(super) fn wheels(hinges: [[BodyRef; 2]; 2]) -> [usize; 2] {
    let wheel = |hinge: usize| {
        let (own, other) = (hinges[hinge], hinges[1 - hinge]);
        let moves = |side: &usize| own[*side] != BodyRef::Ground;
        let alone = |side: &usize| moves(side) && !other.contains(&own[*side]);
        [1, 0].into_iter().find(alone).or_else(|| [1, 0].into_iter().find(moves)).unwrap_or(1)
    };
    let [a, b] = [0, 1].map(wheel);
    if hinges[0][a] == hinges[1][b] { [1 - a, b] } else { [a, b] }
}
