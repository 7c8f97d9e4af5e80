//! Statements that ask for everybody's work, or for one person's.

/// What was handed in, as far as points follow from it: everybody's or one person's. The condition on the person stands alone in
/// each: where it may be left out at will, no database looks in the index by person, and reads the whole course for everybody who
/// asks.
macro_rules! handed {
    ($of:literal) => {
        concat!(
            "SELECT s.person, a.slug, s.id, s.n, s.received_at, COALESCE(v.counted, s.counted), v.earned, \
             v.possible, v.lesson_sha256 \
             FROM submission s JOIN assignment a ON a.id = s.assignment JOIN verdict v ON v.submission = s.id \
             WHERE a.course = $1 AND v.run = (SELECT MAX(run) FROM verdict w WHERE w.submission = s.id) AND ",
            $of,
            " AND (CAST($3 AS TEXT) IS NULL OR a.slug = $3)"
        )
    };
}

/// The same with answers and verdicts.
macro_rules! submissions {
    ($of:literal) => {
        concat!(
            "SELECT s.id, a.slug, s.student, s.answers, v.body FROM submission s \
             JOIN assignment a ON a.id = s.assignment JOIN verdict v ON v.submission = s.id \
             WHERE a.course = $1 AND v.run = (SELECT MAX(run) FROM verdict w WHERE w.submission = s.id) AND ",
            $of,
            " AND (CAST($3 AS TEXT) IS NULL OR a.slug = $3) ORDER BY s.n DESC LIMIT $4"
        )
    };
}

/// What was predicted, likewise.
macro_rules! predictions {
    ($of:literal) => {
        concat!(
            "SELECT q.person, p.name, q.slug, q.prediction, q.choice, q.why, q.given_at FROM prediction q \
             JOIN person p ON p.id = q.person WHERE q.course = $1 AND ",
            $of,
            " AND (CAST($3 AS TEXT) IS NULL OR q.slug = $3) ORDER BY q.n"
        )
    };
}
