//! The table of rights: for every operation of the interface, who may.

use axum::http::StatusCode;

use crate::problem::Problem;
use crate::store::{Member, Role};

/// What an operation asks of who calls it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Right {
    /// Nothing. It tells no secret, or takes one itself: a join code, words, a room's code or key.
    Anyone,
    /// The long random name of a live session, which only who began it knows.
    Key,
    /// To be of the class in this role, or one that may more. At home all who come are students, and there are no classes.
    Role(Role),
}

use Right::{Anyone, Key};
const STUDENT: Right = Right::Role(Role::Student);
const GRADER: Right = Right::Role(Role::Grader);
const INSTRUCTOR: Right = Right::Role(Role::Instructor);
const OWNER: Right = Right::Role(Role::Owner);

/// Method, address and right of every operation. What does not stand here nobody may.
pub const RIGHTS: &[(&str, &str, Right)] = &[
    ("GET", "/api/v1/health", Anyone),
    // Who one is, and coming in.
    ("GET", "/api/v1/me", Anyone),
    ("POST", "/api/v1/setup", Anyone),
    ("POST", "/api/v1/join", Anyone),
    ("POST", "/api/v1/return", Anyone),
    ("POST", "/api/v1/sign-out", Anyone),
    // The account of an institution: for those who teach.
    ("POST", "/api/v1/me/account", GRADER),
    ("DELETE", "/api/v1/me/account", GRADER),
    // The class.
    ("GET", "/api/v1/course", GRADER),
    ("PUT", "/api/v1/course", INSTRUCTOR),
    ("GET", "/api/v1/assignments", GRADER),
    ("PUT", "/api/v1/assignments/{slug}", INSTRUCTOR),
    ("PUT", "/api/v1/assignments/{slug}/release", INSTRUCTOR),
    ("PUT", "/api/v1/assignments/{slug}/extensions/{person}", INSTRUCTOR),
    ("DELETE", "/api/v1/assignments/{slug}/extensions/{person}", INSTRUCTOR),
    ("POST", "/api/v1/assignments/{slug}/preview", GRADER),
    ("GET", "/api/v1/assignments/{slug}/questions", GRADER),
    ("GET", "/api/v1/assignments/{slug}/questions.csv", GRADER),
    ("GET", "/api/v1/assignments/{slug}/questions/{id}", GRADER),
    ("GET", "/api/v1/assignments/{slug}/questions/{id}/answers.csv", GRADER),
    ("GET", "/api/v1/assignments/{slug}/words", GRADER),
    ("POST", "/api/v1/assignments/{slug}/regrades", INSTRUCTOR),
    ("GET", "/api/v1/assignments/{slug}/regrades", INSTRUCTOR),
    ("GET", "/api/v1/regrades", GRADER),
    ("GET", "/api/v1/regrades/{id}/submissions/{submission}", INSTRUCTOR),
    ("POST", "/api/v1/regrades/{id}/apply", INSTRUCTOR),
    ("POST", "/api/v1/regrades/{id}/undo", INSTRUCTOR),
    ("GET", "/api/v1/people", GRADER),
    ("PUT", "/api/v1/people/{person}/role", OWNER),
    ("POST", "/api/v1/people/{person}/words", INSTRUCTOR),
    ("POST", "/api/v1/invitations", OWNER),
    ("GET", "/api/v1/standings", GRADER),
    ("GET", "/api/v1/standings.csv", GRADER),
    ("GET", "/api/v1/standings.jsonl", GRADER),
    ("POST", "/api/v1/standings/canvas", GRADER),
    ("GET", "/api/v1/glance", GRADER),
    ("GET", "/api/v1/people/{person}/submissions", GRADER),
    ("POST", "/api/v1/people/{person}/decisions", GRADER),
    // The learning platform.
    ("GET", "/api/v1/lti", INSTRUCTOR),
    ("POST", "/api/v1/lti/roster", INSTRUCTOR),
    ("POST", "/api/v1/lti/scores", INSTRUCTOR),
    // What leaves the gradebook.
    ("GET", "/api/v1/course/export", OWNER),
    ("GET", "/api/v1/me/data", STUDENT),
    ("POST", "/api/v1/people/{person}/erase", OWNER),
    ("POST", "/api/v1/people/{person}/comments", GRADER),
    ("GET", "/api/v1/people/{person}/record", GRADER),
    // What is one's own.
    ("GET", "/api/v1/record", STUDENT),
    ("POST", "/api/v1/record/requests", STUDENT),
    ("GET", "/api/v1/submissions/{id}/verdicts", STUDENT),
    ("GET", "/api/v1/submissions/{id}/files/{question}", STUDENT),
    // Lessons are read by all; the numbers are those of who asks.
    ("GET", "/api/v1/lessons", Anyone),
    ("GET", "/api/v1/notions", Anyone),
    ("GET", "/api/v1/lessons/{slug}", Anyone),
    ("GET", "/api/v1/lessons/{slug}/questions/{id}/hints/{k}", Anyone),
    ("POST", "/api/v1/lessons/{slug}/questions/{id}/reading", Anyone),
    ("GET", "/api/v1/lessons/{slug}/questions/{id}/states", Anyone),
    ("GET", "/api/v1/lessons/{slug}/questions/{id}/starters/{language}", Anyone),
    ("POST", "/api/v1/lessons/{slug}/predictions", STUDENT),
    ("GET", "/api/v1/lessons/{slug}/predictions", STUDENT),
    ("GET", "/api/v1/lessons/{slug}/predictions/counts", GRADER),
    ("POST", "/api/v1/lessons/{slug}/submissions", STUDENT),
    ("GET", "/api/v1/submissions", STUDENT),
    ("GET", "/api/v1/submissions/{id}", STUDENT),
    // What computes belongs to the class.
    ("POST", "/api/v1/lessons/{slug}/questions/{id}/table", STUDENT),
    ("GET", "/api/v1/scenes", Anyone),
    ("GET", "/api/v1/scenes/{name}", Anyone),
    // Computed once for all who look, of few bodies: they play in other sites too, where nobody is signed in.
    ("GET", "/api/v1/scenes/{name}/motion", Anyone),
    ("GET", "/api/v1/lessons/{slug}/motion", Anyone),
    ("GET", "/api/v1/pictures", Anyone),
    ("GET", "/api/v1/schema/scene", Anyone),
    ("POST", "/api/v1/check", STUDENT),
    ("POST", "/api/v1/import/urdf", STUDENT),
    ("POST", "/api/v1/analyses/assembly", STUDENT),
    ("POST", "/api/v1/analyses/kinematics", STUDENT),
    ("POST", "/api/v1/analyses/equilibrium", STUDENT),
    ("POST", "/api/v1/analyses/modes", STUDENT),
    ("POST", "/api/v1/analyses/table", STUDENT),
    ("POST", "/api/v1/sessions", STUDENT),
    ("GET", "/api/v1/sessions/{id}", Key),
    ("DELETE", "/api/v1/sessions/{id}", Key),
    ("GET", "/api/v1/sessions/{id}/scene", Key),
    ("GET", "/api/v1/sessions/{id}/stream", Key),
    ("GET", "/api/v1/sessions/{id}/jacobian", Key),
    ("GET", "/api/v1/sessions/{id}/augmented", Key),
    ("GET", "/api/v1/sessions/{id}/schur", Key),
    ("GET", "/api/v1/sessions/{id}/reactions", Key),
    ("GET", "/api/v1/sessions/{id}/multipliers", Key),
    ("POST", "/api/v1/sessions/{id}/step", Key),
    ("POST", "/api/v1/sessions/{id}/play", Key),
    ("POST", "/api/v1/sessions/{id}/pause", Key),
    ("POST", "/api/v1/sessions/{id}/reset", Key),
    ("POST", "/api/v1/sessions/{id}/parameters", Key),
    ("PUT", "/api/v1/sessions/{id}/drawing", Key),
    ("PUT", "/api/v1/sessions/{id}/camera", Key),
    ("PUT", "/api/v1/sessions/{id}/pull", Key),
    ("DELETE", "/api/v1/sessions/{id}/pull", Key),
    // A lecture is followed with its code; who opened it has its key.
    ("POST", "/api/v1/rooms", GRADER),
    ("GET", "/api/v1/rooms/{code}", Anyone),
    ("DELETE", "/api/v1/rooms/{code}", Anyone),
    ("PUT", "/api/v1/rooms/{code}/view", Anyone),
    ("GET", "/api/v1/rooms/{code}/desk", Anyone),
    ("PUT", "/api/v1/rooms/{code}/question", Anyone),
    ("DELETE", "/api/v1/rooms/{code}/question", Anyone),
    ("POST", "/api/v1/rooms/{code}/reveal", Anyone),
    ("POST", "/api/v1/rooms/{code}/second-vote", Anyone),
    ("POST", "/api/v1/rooms/{code}/answers", Anyone),
    ("POST", "/api/v1/rooms/{code}/remarks", Anyone),
    ("PUT", "/api/v1/rooms/{code}/remarks/{number}", Anyone),
    ("DELETE", "/api/v1/rooms/{code}/remarks/{number}", Anyone),
    ("DELETE", "/api/v1/rooms/{code}/hands", Anyone),
    ("GET", "/api/v1/rooms/{code}/stream", Anyone),
    ("GET", "/api/v1/rooms/{code}/scene", Anyone),
    ("GET", "/api/v1/rooms/{code}/jacobian", Anyone),
    ("GET", "/api/v1/rooms/{code}/augmented", Anyone),
    ("GET", "/api/v1/rooms/{code}/schur", Anyone),
    ("GET", "/api/v1/rooms/{code}/multipliers", Anyone),
    ("GET", "/api/v1/rooms/{code}/reactions", Anyone),
];

/// Errors if who asks may not do this in a class.
pub fn check(method: &str, address: &str, member: Option<&Member>) -> Result<(), Problem> {
    // Looking at a head is looking.
    let method = if method == "HEAD" { "GET" } else { method };
    let listed = RIGHTS.iter().find(|(listed, at, _)| *listed == method && *at == address);
    let needed = match listed {
        Some((.., Anyone | Key)) => return Ok(()),
        Some((.., Right::Role(role))) => *role,
        None => Role::Owner,
    };
    match member {
        None => Err(Problem::new(
            StatusCode::UNAUTHORIZED,
            "sign-in-needed",
            "this belongs to the class, and nobody is signed in here",
            "join with the code of your class, or come back with your four words: /join",
        )),
        Some(member) if listed.is_none() || member.role < needed => Err(Problem::new(
            StatusCode::FORBIDDEN,
            "not-yours",
            format!("a {} may not do this", member.role.name()),
            format!("it takes the role of {} in this class: ask somebody who has it", needed.name()),
        )),
        Some(_) => Ok(()),
    }
}

/// What those who grade do in a class and everybody does at home.
const AT_HOME: [&str; 2] = ["/api/v1/rooms", "/api/v1/lessons/{slug}/predictions/counts"];

/// Errors if an operation is about classes, at home.
pub fn check_home(method: &str, address: &str) -> Result<(), Problem> {
    let listed = RIGHTS.iter().find(|(listed, at, _)| *listed == method && *at == address);
    let is_of_class = matches!(listed, Some((.., Right::Role(role))) if *role > Role::Student);
    let at_home = AT_HOME.contains(&address);
    let takes_account =
        ["/api/v1/setup", "/api/v1/join", "/api/v1/return", "/api/v1/sign-out", "/api/v1/me/data"];
    if !takes_account.contains(&address) && (!is_of_class || at_home) {
        return Ok(());
    }
    Err(no_class())
}

/// The answer to what exists in classes alone, at home.
pub fn no_class() -> Problem {
    Problem::new(
        StatusCode::NOT_FOUND,
        "no-class",
        "this server runs without accounts: its grades are for yourself",
        "for a class start it with `triad serve --class`",
    )
}
