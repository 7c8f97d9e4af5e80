//! Every statement, in the words that SQLite and PostgreSQL share: parameters `$1`, text, `BIGINT` and `DOUBLE PRECISION`
//! columns, times in milliseconds since 1970, JSON as text, no comparison as a result.

/// The tables; the formats before are brought to them by `schema.rs`.
pub(super) const TABLES: &[&str] = &[
    "CREATE TABLE person (id TEXT PRIMARY KEY NOT NULL, name TEXT NOT NULL, created_at BIGINT NOT NULL)",
    // `events` and `chain` are the number and the hash of the last event; who changes them holds the course.
    "CREATE TABLE course (id TEXT PRIMARY KEY NOT NULL, title TEXT NOT NULL, join_code TEXT NOT NULL, join_open BIGINT \
     NOT NULL, secret TEXT NOT NULL, created_at BIGINT NOT NULL, events BIGINT NOT NULL, chain TEXT NOT NULL)",
    "CREATE TABLE membership (course TEXT NOT NULL REFERENCES course(id), person TEXT NOT NULL REFERENCES person(id), \
     role TEXT NOT NULL, name_key TEXT NOT NULL, seed TEXT NOT NULL, joined_at BIGINT NOT NULL, \
     PRIMARY KEY (course, person), UNIQUE (course, name_key))",
    "CREATE TABLE identity (kind TEXT NOT NULL, subject TEXT NOT NULL, person TEXT NOT NULL REFERENCES person(id), \
     secret TEXT NOT NULL, PRIMARY KEY (kind, subject))",
    "CREATE TABLE session (token_sha256 TEXT PRIMARY KEY NOT NULL, person TEXT NOT NULL REFERENCES person(id), \
     created_at BIGINT NOT NULL, seen_at BIGINT NOT NULL, ends_at BIGINT NOT NULL)",
    "CREATE TABLE invitation (token_sha256 TEXT PRIMARY KEY NOT NULL, course TEXT NOT NULL REFERENCES course(id), \
     role TEXT NOT NULL, ends_at BIGINT NOT NULL)",
    "CREATE TABLE lesson_version (sha256 TEXT PRIMARY KEY NOT NULL, slug TEXT NOT NULL, bundle TEXT NOT NULL, \
     added_at BIGINT NOT NULL)",
    "CREATE TABLE assignment (id TEXT PRIMARY KEY NOT NULL, course TEXT NOT NULL REFERENCES course(id), slug TEXT NOT NULL, \
     most_attempts BIGINT, UNIQUE (course, slug))",
    "CREATE TABLE submission (id TEXT PRIMARY KEY NOT NULL, assignment TEXT NOT NULL REFERENCES assignment(id), \
     person TEXT NOT NULL REFERENCES person(id), n BIGINT NOT NULL, received_at BIGINT NOT NULL, student TEXT NOT NULL, \
     answers TEXT NOT NULL, request_key TEXT, counted BIGINT NOT NULL, \
     UNIQUE (assignment, person, request_key))",
    "CREATE INDEX submission_by_person ON submission (person, assignment, n)",
    "CREATE INDEX submission_by_assignment ON submission (assignment, n)",
    "CREATE TABLE verdict (submission TEXT NOT NULL REFERENCES submission(id), run BIGINT NOT NULL, body TEXT NOT NULL, \
     lesson_sha256 TEXT NOT NULL, build TEXT NOT NULL, seed TEXT NOT NULL, \
     parameters TEXT NOT NULL, earned DOUBLE PRECISION NOT NULL, possible DOUBLE PRECISION NOT NULL, \
     passed BIGINT NOT NULL, made_at BIGINT NOT NULL, PRIMARY KEY (submission, run))",
    "CREATE TABLE decision (id TEXT PRIMARY KEY NOT NULL, course TEXT NOT NULL REFERENCES course(id), n BIGINT NOT NULL, \
     kind TEXT NOT NULL, person TEXT NOT NULL REFERENCES person(id), assignment TEXT NOT NULL REFERENCES assignment(id), \
     amount DOUBLE PRECISION, reason TEXT NOT NULL, decided_by TEXT NOT NULL REFERENCES person(id), \
     decided_at BIGINT NOT NULL)",
    "CREATE INDEX decision_by_course ON decision (course, n)",
    "CREATE TABLE event (course TEXT NOT NULL REFERENCES course(id), n BIGINT NOT NULL, at BIGINT NOT NULL, \
     actor TEXT NOT NULL, what TEXT NOT NULL, subject TEXT NOT NULL, detail TEXT NOT NULL, sha256 TEXT NOT NULL, \
     PRIMARY KEY (course, n))",
];

/// What format 3 adds to the tables of format 2.
pub(super) const ADDED: &[&str] = &[
    "ALTER TABLE assignment ADD COLUMN policy TEXT NOT NULL DEFAULT '{}'",
    "UPDATE assignment SET policy = '{\"most_attempts\":' || CAST(most_attempts AS TEXT) || '}' \
     WHERE most_attempts IS NOT NULL",
    "ALTER TABLE assignment DROP COLUMN most_attempts",
    "ALTER TABLE assignment ADD COLUMN released_at BIGINT",
    // Its place in the log where it is not the submission's, and whether the submission counts as an attempt by it.
    "ALTER TABLE verdict ADD COLUMN n BIGINT NOT NULL DEFAULT 0",
    "ALTER TABLE verdict ADD COLUMN counted BIGINT",
    "CREATE TABLE extension (assignment TEXT NOT NULL REFERENCES assignment(id), person TEXT NOT NULL REFERENCES person(id), \
     until BIGINT, attempts BIGINT NOT NULL, reason TEXT NOT NULL, given_by TEXT NOT NULL REFERENCES person(id), \
     given_at BIGINT NOT NULL, PRIMARY KEY (assignment, person))",
    "CREATE TABLE regrade (id TEXT PRIMARY KEY NOT NULL, course TEXT NOT NULL REFERENCES course(id), n BIGINT NOT NULL, \
     assignment TEXT NOT NULL REFERENCES assignment(id), choice TEXT NOT NULL, reason TEXT NOT NULL, \
     lesson_sha256 TEXT NOT NULL, made_by TEXT NOT NULL REFERENCES person(id), made_at BIGINT NOT NULL, \
     verdicts BIGINT NOT NULL, undone_by TEXT REFERENCES person(id), undone_at BIGINT)",
    "CREATE TABLE regraded (regrade TEXT NOT NULL REFERENCES regrade(id), person TEXT NOT NULL REFERENCES person(id), \
     before_points DOUBLE PRECISION NOT NULL, after_points DOUBLE PRECISION NOT NULL, PRIMARY KEY (regrade, person))",
];

/// What format 4 adds: predictions, as records.
pub(super) const ADDED_4: &[&str] = &[
    "CREATE TABLE prediction (course TEXT NOT NULL REFERENCES course(id), person TEXT NOT NULL REFERENCES person(id), \
     slug TEXT NOT NULL, prediction TEXT NOT NULL, choice TEXT, why TEXT NOT NULL, n BIGINT NOT NULL, \
     given_at BIGINT NOT NULL, PRIMARY KEY (course, person, slug, prediction))",
    "CREATE TRIGGER prediction_is_immutable BEFORE UPDATE ON prediction \
     BEGIN SELECT RAISE(ABORT, 'predictions are immutable'); END",
    "CREATE TRIGGER prediction_is_kept BEFORE DELETE ON prediction \
     BEGIN SELECT RAISE(ABORT, 'predictions are kept'); END",
];

/// What format 5 adds: what was accepted and is not graded yet. Of those that wait, whoever has fewest before them comes first.
pub(super) const ADDED_5: &[&str] = &[
    "CREATE TABLE grading (id TEXT PRIMARY KEY NOT NULL, course TEXT NOT NULL REFERENCES course(id), \
     assignment TEXT NOT NULL REFERENCES assignment(id), person TEXT NOT NULL REFERENCES person(id), n BIGINT NOT NULL, \
     received_at BIGINT NOT NULL, student TEXT NOT NULL, body TEXT NOT NULL, request_key TEXT, seed TEXT, \
     lesson_sha256 TEXT NOT NULL REFERENCES lesson_version(sha256), fair BIGINT NOT NULL, state TEXT NOT NULL, \
     not_before BIGINT NOT NULL, starts BIGINT NOT NULL, fence BIGINT NOT NULL, lease_until BIGINT NOT NULL, \
     worker TEXT NOT NULL, error TEXT NOT NULL, UNIQUE (assignment, person, request_key))",
    "CREATE INDEX grading_by_turn ON grading (fair, n)",
    "CREATE INDEX grading_by_person ON grading (person, assignment, n)",
];

/// What format 7 adds: what is judged again when nothing else waits. It holds no answers, and names the program that is to judge.
pub(super) const ADDED_7: &[&str] = &[
    "CREATE TABLE judging (submission TEXT NOT NULL REFERENCES submission(id), \
     lesson_sha256 TEXT NOT NULL REFERENCES lesson_version(sha256), build TEXT NOT NULL, asked_at BIGINT NOT NULL, \
     starts BIGINT NOT NULL, lease_until BIGINT NOT NULL, outcome TEXT, PRIMARY KEY (submission, lesson_sha256, build))",
    "CREATE INDEX judging_by_turn ON judging (build, asked_at, submission)",
];

/// What format 8 adds: the servers that share the gradebook, and with which request something came that waits.
pub(super) const ADDED_8: &[&str] = &[
    "ALTER TABLE grading ADD COLUMN request TEXT NOT NULL DEFAULT ''",
    "CREATE TABLE node (name TEXT PRIMARY KEY NOT NULL, address TEXT NOT NULL, seen_at BIGINT NOT NULL)",
];

/// What format 9 adds: the question that a decision is about, where it is not about a whole lesson.
pub(super) const ADDED_9: &[&str] = &["ALTER TABLE decision ADD COLUMN question TEXT"];

/// What format 10 adds: names of lecture rooms, whose each is, and in which server it was opened last.
pub(super) const ADDED_10: &[&str] =
    &["CREATE TABLE room (name TEXT PRIMARY KEY NOT NULL, owner TEXT NOT NULL, node TEXT NOT NULL, \
     opened_at BIGINT NOT NULL)"];

#[macro_use]
mod of_person;

/// What is a record is added to and never changed. In SQLite's words: `database.rs` says them in PostgreSQL's.
pub(super) const RECORDS: &[&str] = &[
    "CREATE TRIGGER submission_is_immutable BEFORE UPDATE ON submission \
     BEGIN SELECT RAISE(ABORT, 'submissions are immutable'); END",
    "CREATE TRIGGER submission_is_kept BEFORE DELETE ON submission \
     BEGIN SELECT RAISE(ABORT, 'submissions are kept'); END",
    "CREATE TRIGGER verdict_is_immutable BEFORE UPDATE ON verdict \
     BEGIN SELECT RAISE(ABORT, 'verdicts are immutable'); END",
    "CREATE TRIGGER verdict_is_kept BEFORE DELETE ON verdict BEGIN SELECT RAISE(ABORT, 'verdicts are kept'); END",
    "CREATE TRIGGER decision_is_immutable BEFORE UPDATE ON decision \
     BEGIN SELECT RAISE(ABORT, 'decisions are immutable'); END",
    "CREATE TRIGGER decision_is_kept BEFORE DELETE ON decision BEGIN SELECT RAISE(ABORT, 'decisions are kept'); END",
    "CREATE TRIGGER event_is_immutable BEFORE UPDATE ON event BEGIN SELECT RAISE(ABORT, 'events are immutable'); END",
    "CREATE TRIGGER event_is_kept BEFORE DELETE ON event BEGIN SELECT RAISE(ABORT, 'events are kept'); END",
    "CREATE TRIGGER lesson_is_immutable BEFORE UPDATE ON lesson_version \
     BEGIN SELECT RAISE(ABORT, 'lessons are immutable'); END",
    "CREATE TRIGGER seed_is_immutable BEFORE UPDATE OF seed ON membership \
     BEGIN SELECT RAISE(ABORT, 'seeds are immutable'); END",
];

/// Claims the next grading: `id = (SELECT …)` and not `IN`, which may be evaluated more than once.
macro_rules! claim {
    ($lock:literal) => {
        concat!(
            "UPDATE grading SET state = 'running', fence = fence + 1, starts = starts + 1, lease_until = $3, worker = $4 \
             WHERE id = (SELECT g.id FROM grading g WHERE g.starts < $2 AND (g.state = 'queued' AND g.not_before <= $1 \
             OR g.state = 'running' AND g.lease_until < $1) AND NOT EXISTS (SELECT 1 FROM grading e \
             WHERE e.person = g.person AND e.assignment = g.assignment AND e.n < g.n AND e.state <> 'dead') \
             ORDER BY g.fair, g.n LIMIT 1",
            $lock,
            ") RETURNING id, fence, starts, course, (SELECT slug FROM assignment a WHERE a.id = assignment), person, student, \
             body, lesson_sha256, request_key, seed, worker, received_at, request"
        )
    };
}

/// Claims what is to be judged again, several at a time: found once, whatever the plan.
macro_rules! claim_judgings {
    ($lock:literal) => {
        concat!(
            "WITH next AS MATERIALIZED (SELECT j.submission, j.lesson_sha256 FROM judging j WHERE j.build = $1 \
             AND j.outcome IS NULL AND j.starts < $3 AND j.lease_until < $2 ORDER BY j.asked_at, j.submission LIMIT $5",
            $lock,
            ") UPDATE judging SET starts = starts + 1, lease_until = $4 WHERE build = $1 AND outcome IS NULL \
             AND (submission, lesson_sha256) IN (SELECT n.submission, n.lesson_sha256 FROM next n) \
             RETURNING submission, lesson_sha256, starts, \
             (SELECT s.answers FROM submission s WHERE s.id = judging.submission), \
             (SELECT v.seed FROM verdict v WHERE v.submission = judging.submission AND v.run = 0)"
        )
    };
}

/// The same where many claim at once.
pub(super) const CLAIM_JUDGINGS_OF_MANY: &str = claim_judgings!(" FOR UPDATE OF j SKIP LOCKED");

/// The claim where many claim at once: what another is about to claim is passed over.
pub(super) const CLAIM_OF_MANY: &str = claim!(" FOR UPDATE OF g SKIP LOCKED");

/// All statements with their names, for the test that prepares them.
macro_rules! statements {
    ($($name:ident = $text:expr;)*) => {
        $(pub(in crate::store) const $name: &str = $text;)*
        #[cfg(test)]
        pub(in crate::store) const ALL: &[(&str, &str)] = &[$((stringify!($name), $text)),*];
    };
}

pub(in crate::store) mod lti;

statements! {
    ADD_COURSE = "INSERT INTO course (id, title, join_code, join_open, secret, created_at, events, chain) \
        VALUES ($1, $2, $3, $4, $5, $6, 0, '') ON CONFLICT (id) DO NOTHING";
    // The first statement of everything that is logged: it holds the course until the end of the transaction.
    NEXT_EVENT = "UPDATE course SET events = events + 1 WHERE id = $1 RETURNING events, chain";
    // For what looks before it is logged.
    HOLD_COURSE = "UPDATE course SET events = events WHERE id = $1";
    SET_CHAIN = "UPDATE course SET chain = $2 WHERE id = $1";
    ADD_EVENT = "INSERT INTO event (course, n, at, actor, what, subject, detail, sha256) \
        VALUES ($1, $2, $3, $4, $5, $6, $7, $8)";
    EVENTS = "SELECT n, at, actor, what, subject, detail, sha256 FROM event WHERE course = $1 ORDER BY n";
    END_OF_CHAIN = "SELECT events, chain FROM course WHERE id = $1";
    COURSES = "SELECT id FROM course ORDER BY id";
    REMOVE_COURSE = "DELETE FROM course WHERE id = $1";
    HASH_OF_EVENT = "SELECT sha256 FROM event WHERE course = $1 AND n = $2";
    EVENTS_OF = "SELECT at, actor, what FROM event WHERE course = $1 AND (actor = $2 OR subject = $2) ORDER BY n";
    SIZES = "SELECT (SELECT COUNT(*) FROM submission), (SELECT COUNT(*) FROM event)";

    MEMBER_BY_NAME = "SELECT person FROM membership WHERE course = $1 AND name_key = $2";
    ADD_PERSON = "INSERT INTO person (id, name, created_at) VALUES ($1, $2, $3)";
    ADD_MEMBER = "INSERT INTO membership (course, person, role, name_key, seed, joined_at) VALUES ($1, $2, $3, $4, $5, $6)";

    ADD_LESSON = "INSERT INTO lesson_version (sha256, slug, bundle, added_at) VALUES ($1, $2, $3, $4) \
        ON CONFLICT (sha256) DO NOTHING";
    LESSON = "SELECT bundle FROM lesson_version WHERE sha256 = $1";
    LESSON_BUNDLES = "SELECT sha256, slug, bundle FROM lesson_version ORDER BY sha256";
    LESSON_VERSIONS = "SELECT bundle FROM lesson_version WHERE slug = $1 ORDER BY added_at, sha256";
    ADD_ASSIGNMENT = "INSERT INTO assignment (id, course, slug) VALUES ($1, $2, $3) ON CONFLICT (course, slug) DO NOTHING";
    ASSIGNMENT = "SELECT id, slug, policy, released_at FROM assignment WHERE course = $1 AND slug = $2";
    ASSIGNMENTS = "SELECT id, slug, policy, released_at FROM assignment WHERE course = $1 ORDER BY slug";
    SET_POLICY = "UPDATE assignment SET policy = $2 WHERE id = $1";
    SET_RELEASED = "UPDATE assignment SET released_at = $2 WHERE id = $1";
    EXTENSION = "SELECT until, attempts, reason, given_by, given_at FROM extension WHERE assignment = $1 AND person = $2";
    EXTENSIONS = "SELECT e.person, a.slug, e.until, e.attempts, e.reason, p.name, e.given_at FROM extension e \
        JOIN assignment a ON a.id = e.assignment JOIN person p ON p.id = e.given_by WHERE a.course = $1 \
        AND (CAST($2 AS TEXT) IS NULL OR e.person = $2) AND (CAST($3 AS TEXT) IS NULL OR a.slug = $3)";
    EXTENSION_ROWS = "SELECT a.slug, e.person, e.until, e.attempts, e.reason, e.given_by, e.given_at FROM extension e \
        JOIN assignment a ON a.id = e.assignment WHERE a.course = $1";
    ADD_EXTENSION = "INSERT INTO extension (assignment, person, until, attempts, reason, given_by, given_at) \
        VALUES ($1, $2, $3, $4, $5, $6, $7)";
    REMOVE_EXTENSION = "DELETE FROM extension WHERE assignment = $1 AND person = $2";

    ATTEMPTS = "SELECT s.received_at FROM submission s JOIN verdict v ON v.submission = s.id \
        WHERE s.assignment = $1 AND s.person = $2 AND v.run = (SELECT MAX(run) FROM verdict w WHERE w.submission = s.id) \
        AND COALESCE(v.counted, s.counted) = 1";
    BY_KEY = "SELECT id, n FROM submission WHERE assignment = $1 AND person = $2 AND request_key = $3";
    ATTEMPTS_UNTIL = "SELECT COUNT(*) FROM submission WHERE assignment = $1 AND person = $2 AND counted = 1 AND n <= $3";
    ADD_SUBMISSION = "INSERT INTO submission (id, assignment, person, n, received_at, student, answers, request_key, \
        counted) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9)";
    ADD_VERDICT = "INSERT INTO verdict (submission, run, body, lesson_sha256, build, seed, parameters, earned, \
        possible, passed, made_at, n, counted) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13)";
    VERDICT_IN_FORCE = "SELECT * FROM verdict WHERE submission = $1 ORDER BY run DESC LIMIT 1";
    VERDICT_OF_RUN = "SELECT * FROM verdict WHERE submission = $1 AND run = $2";
    SUBMISSION = "SELECT * FROM submission WHERE id = $1";
    // The last that was handed in or judged again.
    LAST_SUBMISSION = "SELECT COALESCE(MAX(CASE WHEN v.n > s.n THEN v.n ELSE s.n END), 0) FROM submission s \
        JOIN verdict v ON v.submission = s.id JOIN assignment a ON a.id = s.assignment \
        WHERE a.course = $1 AND a.slug = $2 AND s.person = $3";
    KEPT_OF_PERSON = "SELECT COUNT(*), COALESCE(SUM(OCTET_LENGTH(answers)), 0) FROM submission WHERE person = $1";
    LATEST_VERDICT = "SELECT body FROM verdict WHERE submission = $1 ORDER BY run DESC LIMIT 1";
    SUBMISSIONS = submissions!("CAST($2 AS TEXT) IS NULL");
    SUBMISSIONS_OF = submissions!("s.person = $2");
    REBUILDABLE = "SELECT s.id, s.person, a.slug, s.answers, v.body, v.lesson_sha256, v.seed, v.build, s.received_at \
        FROM verdict v JOIN submission s ON s.id = v.submission JOIN assignment a ON a.id = s.assignment \
        WHERE a.course = $1 AND (CAST($2 AS TEXT) IS NULL OR a.slug = $2) \
        ORDER BY CASE WHEN v.run = 0 THEN s.n ELSE v.n END";
    IN_FORCE = "SELECT s.id, a.slug, s.student, s.answers, v.body, s.person FROM submission s \
        JOIN assignment a ON a.id = s.assignment JOIN verdict v ON v.submission = s.id \
        WHERE a.course = $1 AND s.id = $2 ORDER BY v.run DESC LIMIT 1";
    EVENT_UNTIL = "SELECT n FROM event WHERE course = $1 AND at <= $2 ORDER BY n DESC LIMIT 1";
    RECENT = "SELECT s.id, s.person, a.slug, CAST('' AS TEXT), v.body, v.lesson_sha256, v.seed, v.build, s.received_at \
        FROM assignment a JOIN submission s ON s.assignment = a.id JOIN verdict v ON v.submission = s.id \
        WHERE a.course = $1 AND s.n > $2 AND v.run = (SELECT MAX(run) FROM verdict w WHERE w.submission = s.id) ORDER BY s.n";
    // Whether what stands there is what was written.
    RECORDED = "SELECT s.* FROM submission s JOIN assignment a ON a.id = s.assignment WHERE a.course = $1 ORDER BY s.n";
    VERDICTS = "SELECT v.* FROM verdict v JOIN submission s ON s.id = v.submission \
        JOIN assignment a ON a.id = s.assignment WHERE a.course = $1 ORDER BY s.n, v.run";

    COURSE = "SELECT title, join_code, join_open, secret FROM course WHERE id = $1";
    SET_COURSE = "UPDATE course SET title = $2, join_code = $3, join_open = $4 WHERE id = $1";
    OWNERS = "SELECT COUNT(*) FROM membership WHERE course = $1 AND role = 'owner'";
    ADD_INVITATION = "INSERT INTO invitation (token_sha256, course, role, ends_at) VALUES ($1, $2, $3, $4)";
    // One statement: of two who follow it at once only one finds it.
    USE_INVITATION = "DELETE FROM invitation WHERE token_sha256 = $1 AND ends_at > $2 RETURNING course, role";
    ADD_IDENTITY = "INSERT INTO identity (kind, subject, person, secret) VALUES ($1, $2, $3, $4)";
    REMOVE_IDENTITIES = "DELETE FROM identity WHERE person = $1";
    // The account that somebody has at their institution; see `identities.rs`.
    ACCOUNT = "SELECT i.person FROM identity i JOIN membership m ON m.person = i.person \
        WHERE m.course = $1 AND i.kind = 'account' AND i.subject = $2";
    ACCOUNTS_OF = "SELECT COUNT(*) FROM identity WHERE kind = 'account' AND person = $1";
    REMOVE_ACCOUNT = "DELETE FROM identity WHERE kind = 'account' AND person = $1";
    PHRASE = "SELECT i.person, i.secret FROM identity i JOIN membership m ON m.person = i.person \
        WHERE i.kind = 'phrase' AND m.course = $1 AND m.name_key = $2";
    LINK = "SELECT person FROM identity WHERE kind = 'link' AND subject = $1";
    ADD_SESSION = "INSERT INTO session (token_sha256, person, created_at, seen_at, ends_at) VALUES ($1, $2, $3, $4, $5)";
    SESSION = "SELECT p.id, p.name, m.role, m.seed, m.joined_at, s.seen_at FROM session s JOIN person p ON p.id = s.person \
        JOIN membership m ON m.person = p.id WHERE s.token_sha256 = $1 AND m.course = $2 AND s.ends_at > $3 \
        AND s.seen_at > $4";
    SEE_SESSION = "UPDATE session SET seen_at = $2 WHERE token_sha256 = $1";
    END_SESSION = "DELETE FROM session WHERE token_sha256 = $1";
    REMOVE_SESSIONS = "DELETE FROM session WHERE person = $1";
    PEOPLE = "SELECT p.id, p.name, m.role, m.seed, m.joined_at FROM membership m JOIN person p ON p.id = m.person \
        WHERE m.course = $1 ORDER BY m.name_key";
    MEMBER = "SELECT person FROM membership WHERE course = $1 AND person = $2";
    SET_ROLE = "UPDATE membership SET role = $3 WHERE course = $1 AND person = $2";

    // Erasing a person; see `copies/person.rs`.
    OTHER_OWNERS = "SELECT COUNT(*) FROM membership WHERE course = $1 AND role = 'owner' AND person <> $2";
    RENAME_PERSON = "UPDATE person SET name = $2 WHERE id = $1";
    SET_NAME_KEY = "UPDATE membership SET name_key = $3, role = 'student' WHERE course = $1 AND person = $2";
    UNSEED = "UPDATE membership SET seed = '' WHERE course = $1 AND person = $2";
    UNNAME_SUBMISSIONS = "UPDATE submission SET student = '', request_key = NULL WHERE person = $1";
    EMPTY_SUBMISSIONS = "UPDATE submission SET answers = '{}' WHERE person = $1";
    VERDICTS_OF = "SELECT v.submission, v.run, v.body, v.seed FROM verdict v JOIN submission s ON s.id = v.submission \
        WHERE s.person = $1";
    REPLACE_VERDICT = "UPDATE verdict SET body = $3, seed = $4 WHERE submission = $1 AND run = $2";

    HANDED = handed!("CAST($2 AS TEXT) IS NULL");
    HANDED_OF = handed!("s.person = $2");
    HANDED_BY = "SELECT a.slug, COUNT(DISTINCT s.person) FROM submission s JOIN assignment a ON a.id = s.assignment \
        WHERE a.course = $1 GROUP BY a.slug";
    ADD_DECISION = "INSERT INTO decision (id, course, n, kind, person, assignment, question, amount, reason, decided_by, decided_at) \
        VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11)";
    ADD_PREDICTION = "INSERT INTO prediction (course, person, slug, prediction, choice, why, n, given_at) \
        VALUES ($1, $2, $3, $4, $5, $6, $7, $8)";
    PREDICTED = "SELECT COUNT(*) FROM prediction WHERE course = $1 AND person = $2 AND slug = $3 AND prediction = $4";
    PREDICTIONS = predictions!("CAST($2 AS TEXT) IS NULL");
    PREDICTIONS_OF = predictions!("q.person = $2");
    EMPTY_PREDICTIONS = "UPDATE prediction SET why = '' WHERE person = $1";
    PREDICTION_ROWS = "SELECT * FROM prediction WHERE course = $1 ORDER BY n";
    DECISIONS = "SELECT d.person, a.slug, d.kind, d.question, d.amount, d.reason, p.name, d.decided_at FROM decision d \
        JOIN assignment a ON a.id = d.assignment JOIN person p ON p.id = d.decided_by WHERE d.course = $1 \
        AND (CAST($2 AS TEXT) IS NULL OR d.person = $2) AND (CAST($3 AS TEXT) IS NULL OR a.slug = $3) ORDER BY d.n";
    // Remarks and requests decide nothing.
    LAST_DECISION = "SELECT COALESCE(MAX(d.n), 0) FROM decision d JOIN assignment a ON a.id = d.assignment \
        WHERE a.course = $1 AND a.slug = $2 AND d.kind IN ('points', 'mark')";
    DECISION_ROWS = "SELECT d.n, d.person, a.slug, d.kind, d.question, d.amount, d.reason, d.decided_by, d.decided_at \
        FROM decision d JOIN assignment a ON a.id = d.assignment WHERE d.course = $1 ORDER BY d.n";

    // Of the answers of whoever was erased nothing is judged again.
    VERDICT_COUNT = "SELECT COUNT(*) FROM verdict v JOIN submission s ON s.id = v.submission WHERE s.assignment = $1 \
        AND s.person NOT IN (SELECT e.subject FROM event e WHERE e.course = $2 AND e.what = 'erased')";
    ERASED_PEOPLE = "SELECT DISTINCT subject FROM event WHERE course = $1 AND what = 'erased'";
    ADD_REGRADE = "INSERT INTO regrade (id, course, n, assignment, choice, reason, lesson_sha256, made_by, made_at, \
        verdicts) VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10)";
    ADD_REGRADED = "INSERT INTO regraded (regrade, person, before_points, after_points) VALUES ($1, $2, $3, $4)";
    REGRADES = "SELECT r.id, a.slug, r.choice, r.reason, p.name, r.made_at, r.undone_at FROM regrade r \
        JOIN assignment a ON a.id = r.assignment JOIN person p ON p.id = r.made_by WHERE r.course = $1 ORDER BY r.n DESC";
    REGRADED = "SELECT d.regrade, d.person, d.before_points, d.after_points FROM regraded d \
        JOIN regrade r ON r.id = d.regrade WHERE r.course = $1 AND (CAST($2 AS TEXT) IS NULL OR d.person = $2)";
    // The last regrade in force of the same lesson.
    LAST_REGRADE = "SELECT r.n, r.verdicts, (SELECT o.id FROM regrade o WHERE o.assignment = r.assignment AND o.undone_at IS NULL \
        ORDER BY o.n DESC LIMIT 1) FROM regrade r WHERE r.course = $1 AND r.id = $2 AND r.undone_at IS NULL";
    // The verdicts of a regrade are the entries of the log that follow its own.
    VERDICTS_OF_REGRADE = "SELECT v.submission, v.run FROM verdict v JOIN submission s ON s.id = v.submission \
        JOIN assignment a ON a.id = s.assignment WHERE a.course = $1 AND v.run > 0 AND v.n > $2 AND v.n <= $2 + $3 \
        ORDER BY v.n";
    SET_UNDONE = "UPDATE regrade SET undone_by = $2, undone_at = $3 WHERE id = $1";
    VERDICTS_GIVEN = "SELECT s.person, a.slug, v.run, v.made_at, v.body FROM verdict v JOIN submission s ON s.id = v.submission \
        JOIN assignment a ON a.id = s.assignment WHERE a.course = $1 AND s.id = $2 ORDER BY v.run";

    // The queue; see `queue.rs`. A person's gradings of one lesson follow each other: each knows of those before.
    OPEN_GRADINGS = "SELECT COUNT(*) FROM grading WHERE state <> 'dead'";
    GRADINGS = "SELECT COALESCE(SUM(CASE WHEN state <> 'dead' THEN 1 ELSE 0 END), 0), \
        COALESCE(SUM(CASE WHEN state = 'dead' THEN 1 ELSE 0 END), 0) FROM grading";
    NEXT_GRADING = "SELECT COALESCE(MAX(n), 0) + 1, COALESCE(SUM(CASE WHEN person = $2 AND state <> 'dead' THEN 1 ELSE 0 END), 0) \
        FROM grading WHERE course = $1";
    OPEN_OF = "SELECT received_at FROM grading WHERE assignment = $1 AND person = $2 AND state <> 'dead'";
    GRADING_BY_KEY = "SELECT id FROM grading WHERE assignment = $1 AND person = $2 AND request_key = $3";
    ADD_GRADING = "INSERT INTO grading (id, course, assignment, person, n, received_at, student, body, request_key, seed, \
        lesson_sha256, fair, request, state, not_before, starts, fence, lease_until, worker, error) \
        VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, 'queued', 0, 0, 0, 0, '', '')";
    CLAIM = claim!("");
    RENEW = "UPDATE grading SET lease_until = $3 WHERE id = $1 AND fence = $2 AND state = 'running'";
    CLOSE = "DELETE FROM grading WHERE id = $1 AND fence = $2 AND state = 'running'";
    GIVE_BACK = "UPDATE grading SET state = $3, not_before = $4, error = $5, starts = $6 \
        WHERE id = $1 AND fence = $2 AND state = 'running'";
    PUT_ASIDE = "UPDATE grading SET state = 'dead', error = 'its graders ended' \
        WHERE state = 'running' AND lease_until < $1 AND starts >= $2";
    GRADE_AGAIN = "UPDATE grading SET state = 'queued', not_before = 0, starts = 0 WHERE state = 'dead'";
    PLACE = "SELECT g.person, g.state, (SELECT COUNT(*) FROM grading e WHERE e.state <> 'dead' \
        AND (e.fair < g.fair OR e.fair = g.fair AND e.n < g.n)) FROM grading g WHERE g.id = $1";
    REMOVE_GRADINGS = "DELETE FROM grading WHERE person = $1";
    STUDENTS_WAIT = "SELECT COUNT(*) FROM grading WHERE state = 'queued' AND not_before <= $1 AND starts < $2";

    // Servers; see `nodes.rs`.
    TAKE_NODE = "INSERT INTO node (name, address, seen_at) VALUES ($1, $2, $3) ON CONFLICT (name) DO UPDATE SET \
        address = $2, seen_at = $3 WHERE node.address = $2 OR node.seen_at < $4";
    NODE = "SELECT address, seen_at FROM node WHERE name = $1";
    LEAVE_NODE = "UPDATE node SET seen_at = 0 WHERE name = $1 AND address = $2";
    FORGET_NODES = "DELETE FROM node WHERE seen_at > 0 AND seen_at < $1";

    // Names of lecture rooms; see `rooms.rs`.
    TAKE_ROOM = "INSERT INTO room (name, owner, node, opened_at) VALUES ($1, $2, $3, $4) ON CONFLICT (name) DO UPDATE SET \
        node = $3, opened_at = $4 WHERE room.owner = $2";
    ROOM = "SELECT node FROM room WHERE name = $1";
    OTHER_ROOMS = "SELECT COUNT(*), COALESCE(SUM(CASE WHEN owner = $1 THEN 1 ELSE 0 END), 0) FROM room WHERE name <> $2";
    FORGET_ROOMS = "DELETE FROM room WHERE opened_at < $1";
    REMOVE_ROOMS = "DELETE FROM room WHERE owner = $1";

    // What is judged again; see `judging.rs`.
    ADD_JUDGING = "INSERT INTO judging (submission, lesson_sha256, build, asked_at, starts, lease_until) \
        VALUES ($1, $2, $3, $4, 0, 0) ON CONFLICT (submission, lesson_sha256, build) DO UPDATE SET asked_at = $4, \
        starts = CASE WHEN judging.outcome IS NULL THEN 0 ELSE judging.starts END";
    OPEN_JUDGINGS = "SELECT COUNT(*) FROM judging WHERE build = $1 AND outcome IS NULL AND starts < $2";
    CLAIM_JUDGINGS = claim_judgings!("");
    KEEP_JUDGING = "UPDATE judging SET outcome = $4 WHERE submission = $1 AND lesson_sha256 = $2 AND build = $3 \
        AND outcome IS NULL";
    LEAVE_JUDGING = "UPDATE judging SET starts = starts - 1, lease_until = 0 WHERE submission = $1 AND lesson_sha256 = $2 \
        AND build = $3 AND outcome IS NULL AND starts = $4";
    JUDGINGS_OPEN = "SELECT COUNT(*) FROM judging WHERE lesson_sha256 = $1 AND build = $2 AND outcome IS NULL \
        AND (starts < $3 OR lease_until >= $4)";
    JUDGED = "SELECT submission, outcome FROM judging WHERE lesson_sha256 = $1 AND build = $2 \
        AND (outcome IS NOT NULL OR starts >= $3 AND lease_until < $4)";
    FORGET_JUDGED = "DELETE FROM judging WHERE asked_at < $1";
    REMOVE_JUDGINGS = "DELETE FROM judging WHERE submission IN (SELECT id FROM submission WHERE person = $1)";
}
