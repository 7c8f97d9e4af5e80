use proptest::prelude::*;

use super::*;

/// A day, in milliseconds.
const DAY: i64 = 86_400_000;

fn policy() -> impl Strategy<Value = Policy> {
    let steps = prop::collection::vec((1..5_i64, 0.0..=1.0), 0..4);
    let falling = prop::collection::vec(0.0..=1.0, 0..4);
    let dates = (prop::option::of(0..5_i64), prop::option::of(5..20_i64), prop::option::of(40..50_i64));
    (dates, steps, falling, prop::option::of(1..5_u32)).prop_map(
        |((opens, due, closes), steps, mut falling, most)| {
            falling.sort_by(|a: &f64, b| b.total_cmp(a));
            let mut shares: Vec<f64> = steps.iter().map(|step| step.1).collect();
            shares.sort_by(|a, b| b.total_cmp(a));
            let mut at = due.unwrap_or_default();
            let late = steps.iter().zip(shares).map(|((days, _), share)| {
                at += days;
                LateStep { until: Moment(at * DAY), share }
            });
            let late = if due.is_some() { late.collect() } else { Vec::new() };
            let day = |day: Option<i64>| day.map(|day| Moment(day * DAY));
            let (opens, due, closes) = (day(opens), day(due), day(closes));
            Policy { opens, due, late, closes, most_attempts: most, falling, ..Policy::default() }
        },
    )
}

fn handed() -> impl Strategy<Value = Vec<Handed>> {
    let one = (0..50 * DAY, any::<bool>(), 0.0..12.0);
    prop::collection::vec(one, 0..8).prop_map(|all| {
        let one = |(n, (at, judged, earned))| Handed {
            id: format!("{n}"),
            n,
            at: Moment(at),
            judged,
            earned,
            pass: None,
        };
        (0..).zip(all).map(one).collect()
    })
}

fn extension(until: Option<i64>, attempts: u32) -> Extension {
    let until = until.map(Moment);
    Extension { until, attempts, reason: "ill".into(), by: "T".into(), at: Moment(0) }
}

fn case<'a>(policy: &'a Policy, handed: &'a [Handed], extension: Option<&'a Extension>) -> Case<'a> {
    Case { policy, released: None, extension, handed, decided: &[], pass: 6.0 }
}

const END: Moment = Moment(100 * DAY);

proptest! {
    #[test]
    fn the_order_in_which_things_are_known_does_not_matter(
        policy in policy(), (handed, mixed) in handed().prop_flat_map(|h| (Just(h.clone()), Just(h).prop_shuffle())),
        now in 0..60 * DAY,
    ) {
        prop_assert!(policy.check().is_ok(), "{policy:?}");
        let now = Moment(now);
        prop_assert_eq!(standing(&case(&policy, &handed, None), now), standing(&case(&policy, &mixed, None), now));
    }

    #[test]
    fn more_time_and_more_attempts_never_lower(
        policy in policy(), handed in handed(), now in 0..60 * DAY,
        until in prop::option::of(0..50 * DAY), longer in 0..20 * DAY, attempts in 0..3_u32,
    ) {
        let now = Moment(now);
        let (some, more) = (extension(until, attempts), extension(until.map(|u| u + longer), attempts + 1));
        let none = standing(&case(&policy, &handed, None), now);
        let some = standing(&case(&policy, &handed, Some(&some)), now);
        let more = standing(&case(&policy, &handed, Some(&more)), now);
        prop_assert!(none.score.points <= some.score.points && some.score.points <= more.score.points, "{none:?} {some:?} {more:?}");
        prop_assert!(none.turn.worth <= some.turn.worth && some.turn.worth <= more.turn.worth);
        prop_assert!(none.turn.closes <= some.turn.closes || none.turn.closes.is_none());
    }

    #[test]
    fn handing_in_again_never_lowers_and_nothing_counts_more_than_it_earned(
        policy in policy(), handed in handed(), until in prop::option::of(0..50 * DAY),
    ) {
        let extension = extension(until, 0);
        let mut sorted = handed;
        sorted.sort_by_key(|one| (one.at, one.n));
        let mut before = 0.0;
        for k in 0..=sorted.len() {
            let now = standing(&case(&policy, &sorted[..k], Some(&extension)), END);
            prop_assert!(now.score.points >= before && now.score.points <= now.score.earned, "{now:?}");
            prop_assert_eq!(now.score.credits.len(), usize::try_from(now.turn.attempts).unwrap_or_default());
            before = now.score.points;
        }
    }

    #[test]
    fn as_time_goes_on_points_stay_and_the_worth_of_an_attempt_falls(
        policy in policy(), handed in handed(), a in 0..60 * DAY, b in 0..60 * DAY,
    ) {
        let (a, b) = (Moment(a.min(b)), Moment(a.max(b)));
        let (then, later) = (standing(&case(&policy, &handed, None), a), standing(&case(&policy, &handed, None), b));
        prop_assert!(then.score.points <= later.score.points && then.turn.worth >= later.turn.worth);
        prop_assert!(!then.turn.revealed.points || later.turn.revealed.points);
    }

    #[test]
    fn what_is_admitted_is_worth_what_was_said(policy in policy(), handed in handed(), now in 0..60 * DAY) {
        let now = Moment(now);
        let before: Vec<Handed> = handed.into_iter().filter(|one| one.at <= now).collect();
        let made: Vec<Moment> = before.iter().filter(|one| one.judged).map(|one| one.at).collect();
        let said = standing(&case(&policy, &before, None), now);
        let admitted = admit(&policy, None, &made, true, now);
        prop_assert_eq!(admitted.is_ok(), !matches!(said.turn.phase, Phase::NotOpen | Phase::Closed) && said.turn.attempts_left != Some(0));
        if admitted.is_ok() {
            let mut with = before;
            with.push(Handed { id: "new".into(), n: i64::MAX, at: now, judged: true, earned: 10.0, pass: None });
            let credits = standing(&case(&policy, &with, None), now).score.credits;
            let new = credits.iter().find(|one| one.id == "new").map(|one| one.points);
            prop_assert_eq!(new, Some(10.0 * said.turn.worth));
        }
    }
}

fn at(day: i64) -> Moment {
    Moment(day * DAY)
}

fn earned(day: i64, earned: f64) -> Handed {
    Handed { id: format!("{day}"), n: day, at: at(day), judged: true, earned, pass: None }
}

#[test]
fn lateness_and_attempts_multiply_and_the_best_counts() {
    let policy = Policy {
        due: Some(at(10)),
        late: vec![LateStep { until: at(12), share: 0.8 }, LateStep { until: at(14), share: 0.5 }],
        falling: vec![1.0, 0.9],
        ..Policy::default()
    };
    let handed = [earned(9, 5.0), earned(11, 10.0), earned(13, 10.0), earned(15, 10.0)];
    let of = |n: usize| standing(&case(&policy, &handed[..n], None), END);
    assert_eq!(
        (of(1).score.points, of(2).score.points, of(4).score.points),
        (5.0, 10.0 * (0.8 * 0.9), 10.0 * (0.8 * 0.9))
    );
    assert!(of(2).score.late && !of(1).score.late && of(2).score.passed && !of(1).score.passed);
    let ill = extension(Some(11 * DAY), 0);
    let moved = standing(&case(&policy, &handed, Some(&ill)), at(12));
    assert_eq!((moved.score.points, moved.turn.due, moved.turn.phase), (9.0, Some(at(11)), Phase::Late));
}

#[test]
fn decisions_count_from_when_they_are_made_until_they_are_taken_back() {
    let policy = Policy::default();
    let handed = [earned(1, 5.0)];
    let decide = |day, points| Decided { points, reason: "why".into(), by: "T".into(), at: at(day) };
    let decided = [decide(4, None), decide(2, Some(3.0)), decide(3, Some(9.0))];
    let on =
        |day| standing(&Case { decided: &decided, ..case(&policy, &handed, None) }, at(day)).score.points;
    assert_eq!((on(1), on(2), on(3), on(4)), (5.0, 3.0, 9.0, 5.0));
}

#[test]
fn what_is_held_back_is_told_when_it_is_due() {
    let reveal = Reveal { points: When::AfterDue, messages: When::WhenReleased, reference: When::Never };
    let policy = Policy { due: Some(at(10)), reveal, ..Policy::default() };
    let ill = extension(Some(12 * DAY), 0);
    let of = |extension, released, day| {
        standing(&Case { released, ..case(&policy, &[], extension) }, at(day)).turn.revealed
    };
    assert!(!of(None, None, 10).points && of(None, None, 11).points && !of(Some(&ill), None, 11).points);
    assert!(!of(None, None, 99).messages && of(None, Some(at(20)), 20).messages);
    assert!(!of(None, Some(at(5)), 6).messages, "a remark tells what is right");
    assert!(!of(None, Some(at(20)), 99).reference);
}

#[test]
fn waiting_between_attempts() {
    let policy = Policy { cooldown_minutes: 10, most_attempts: Some(2), ..Policy::default() };
    let soon = admit(&policy, None, &[Moment(0)], true, Moment(599_999));
    assert_eq!(soon, Err(Refusal::TooSoon(Moment(600_000))));
    assert_eq!(admit(&policy, None, &[Moment(0)], false, Moment(1)), Ok(()));
    assert_eq!(admit(&policy, None, &[Moment(0)], true, Moment(600_000)), Ok(()));
    assert_eq!(admit(&policy, None, &[Moment(0); 2], true, END), Err(Refusal::AttemptsUsed(2)));
}

#[test]
fn contradictions_are_named_with_their_place() {
    let place = |policy: Policy| policy.check().err().map(|error| error.place);
    let late = |share| LateStep { until: at(11), share };
    let due = Policy { due: Some(at(10)), ..Policy::default() };
    assert_eq!(place(due.clone()), None);
    assert_eq!(place(Policy { opens: Some(at(11)), ..due.clone() }).as_deref(), Some("/due"));
    assert_eq!(place(Policy { closes: Some(at(9)), ..due.clone() }).as_deref(), Some("/closes"));
    assert_eq!(place(Policy { late: vec![late(1.5)], ..due.clone() }).as_deref(), Some("/late"));
    assert_eq!(place(Policy { late: vec![late(0.5), late(0.6)], ..due.clone() }).as_deref(), Some("/late"));
    assert_eq!(place(Policy { falling: vec![f64::NAN], ..due }).as_deref(), Some("/falling"));
    assert_eq!(place(Policy { late: vec![late(0.5)], ..Policy::default() }).as_deref(), Some("/late"));
    let reveal = Reveal { points: When::AfterDue, ..Reveal::default() };
    assert_eq!(place(Policy { reveal, ..Policy::default() }).as_deref(), Some("/reveal"));
    assert_eq!(
        place(Policy { most_attempts: Some(0), ..Policy::default() }).as_deref(),
        Some("/most_attempts")
    );
}
