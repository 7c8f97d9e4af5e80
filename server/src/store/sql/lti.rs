//! Tables and statements about learning platforms; see `store/lti`.

/// What format 6 adds: platforms, who came from them, and the scores that they are told.
pub(in crate::store) const ADDED_6: &[&str] = &[
    "CREATE TABLE lti_key (kid TEXT PRIMARY KEY NOT NULL, private_key TEXT NOT NULL, created_at BIGINT NOT NULL)",
    // `services`, `deployments`: lists as JSON. Until `paused_until` nothing is asked of it, after `failures` in a row.
    "CREATE TABLE lti_platform (id TEXT PRIMARY KEY NOT NULL, course TEXT NOT NULL REFERENCES course(id), \
     issuer TEXT NOT NULL, client_id TEXT NOT NULL, keys_url TEXT NOT NULL, login_url TEXT NOT NULL, \
     token_url TEXT NOT NULL, audience TEXT NOT NULL, services TEXT NOT NULL, deployments TEXT NOT NULL, \
     created_at BIGINT NOT NULL, paused_until BIGINT NOT NULL, failures BIGINT NOT NULL, problem TEXT NOT NULL, \
     UNIQUE (issuer, client_id))",
    "CREATE TABLE lti_nonce (platform TEXT NOT NULL, nonce TEXT NOT NULL, ends_at BIGINT NOT NULL, \
     PRIMARY KEY (platform, nonce))",
    // The platform's courses whose people come into ours.
    "CREATE TABLE lti_context (platform TEXT NOT NULL, context TEXT NOT NULL, title TEXT NOT NULL, \
     line_items TEXT NOT NULL, members TEXT NOT NULL, linked_at BIGINT NOT NULL, PRIMARY KEY (platform, context))",
    // Where the scores of a lesson go; `url` is empty where the platform has no column yet.
    "CREATE TABLE lti_column (platform TEXT NOT NULL, context TEXT NOT NULL, slug TEXT NOT NULL, url TEXT NOT NULL, \
     PRIMARY KEY (platform, context, slug, url))",
    // `role`: what the platform last called them.
    "CREATE TABLE lti_person (platform TEXT NOT NULL, context TEXT NOT NULL, subject TEXT NOT NULL, \
     person TEXT NOT NULL REFERENCES person(id), role TEXT NOT NULL, PRIMARY KEY (platform, context, subject))",
    "CREATE INDEX lti_person_by_person ON lti_person (person)",
    // What a column is to be told of a person, and what it was told last, each as one number; `stamp` is the time that was told
    // with it.
    "CREATE TABLE lti_score (platform TEXT NOT NULL, url TEXT NOT NULL, person TEXT NOT NULL REFERENCES person(id), \
     context TEXT NOT NULL, slug TEXT NOT NULL, wanted DOUBLE PRECISION NOT NULL, sent DOUBLE PRECISION, \
     sent_at BIGINT, stamp BIGINT NOT NULL, tries BIGINT NOT NULL, not_before BIGINT NOT NULL, \
     lease_until BIGINT NOT NULL, problem TEXT NOT NULL, PRIMARY KEY (platform, url, person))",
];

statements! {
    ADD_KEY = "INSERT INTO lti_key (kid, private_key, created_at) VALUES ($1, $2, $3)";
    KEYS = "SELECT kid, private_key FROM lti_key ORDER BY created_at DESC, kid";

    ADD_PLATFORM = "INSERT INTO lti_platform (id, course, issuer, client_id, keys_url, login_url, token_url, audience, \
        services, deployments, created_at, paused_until, failures, problem) \
        VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, 0, 0, '') ON CONFLICT (id) DO UPDATE SET keys_url = $5, \
        login_url = $6, token_url = $7, audience = $8, services = $9, deployments = $10, paused_until = 0, failures = 0, \
        problem = ''";
    PLATFORMS = "SELECT id, issuer, client_id, keys_url, login_url, token_url, audience, services, deployments \
        FROM lti_platform WHERE course = $1 ORDER BY created_at, id";
    REMOVE_PLATFORM = "DELETE FROM lti_platform WHERE id = $1";
    REMOVE_CONTEXTS = "DELETE FROM lti_context WHERE platform = $1";
    REMOVE_COLUMNS = "DELETE FROM lti_column WHERE platform = $1";
    REMOVE_SCORES = "DELETE FROM lti_score WHERE platform = $1";
    REMOVE_NONCES = "DELETE FROM lti_nonce WHERE platform = $1";
    SET_PAUSE = "UPDATE lti_platform SET paused_until = $2, failures = failures + 1, problem = $3 WHERE id = $1";
    END_PAUSE = "UPDATE lti_platform SET paused_until = 0, failures = 0, problem = '' WHERE id = $1 AND failures > 0";
    PAUSE = "SELECT paused_until, failures, problem FROM lti_platform WHERE id = $1";

    // People come in one after the other: who comes twice at once is one person, and of two of a name one is the second.
    HOLD_COURSE = "UPDATE course SET events = events WHERE id = $1";
    ADD_NONCE = "INSERT INTO lti_nonce (platform, nonce, ends_at) VALUES ($1, $2, $3) ON CONFLICT (platform, nonce) DO NOTHING";
    FORGET_NONCES = "DELETE FROM lti_nonce WHERE ends_at < $1";

    CONTEXTS = "SELECT context, title, line_items, members FROM lti_context WHERE platform = $1 ORDER BY linked_at, context";
    SET_CONTEXT = "INSERT INTO lti_context (platform, context, title, line_items, members, linked_at) \
        VALUES ($1, $2, $3, $4, $5, $6) ON CONFLICT (platform, context) DO UPDATE SET title = $3, \
        line_items = CASE WHEN $4 = '' THEN lti_context.line_items ELSE $4 END, \
        members = CASE WHEN $5 = '' THEN lti_context.members ELSE $5 END";
    REMOVE_CONTEXT = "DELETE FROM lti_context WHERE platform = $1 AND context = $2";
    REMOVE_COLUMNS_OF = "DELETE FROM lti_column WHERE platform = $1 AND context = $2";
    REMOVE_SCORES_OF = "DELETE FROM lti_score WHERE platform = $1 AND context = $2";

    ADD_COLUMN = "INSERT INTO lti_column (platform, context, slug, url) VALUES ($1, $2, $3, $4) \
        ON CONFLICT (platform, context, slug, url) DO NOTHING";
    COLUMNS_OF_LESSON = "SELECT url FROM lti_column WHERE platform = $1 AND context = $2 AND slug = $3";
    COLUMNS = "SELECT context, slug, url FROM lti_column WHERE platform = $1 ORDER BY context, slug, url";
    REMOVE_COLUMN = "DELETE FROM lti_column WHERE platform = $1 AND context = $2 AND slug = $3 AND url = $4";
    REMOVE_SCORES_AT = "DELETE FROM lti_score WHERE platform = $1 AND url = $2";

    PERSON_OF_SUBJECT = "SELECT person FROM lti_person WHERE platform = $1 AND subject = $2 ORDER BY context LIMIT 1";
    ROLE_OF_SUBJECT = "SELECT role FROM lti_person WHERE platform = $1 AND context = $2 AND subject = $3";
    SET_PERSON = "INSERT INTO lti_person (platform, context, subject, person, role) VALUES ($1, $2, $3, $4, $5) \
        ON CONFLICT (platform, context, subject) DO UPDATE SET person = $4, role = $5";
    PEOPLE_OF_CONTEXT = "SELECT l.subject, l.person FROM lti_person l JOIN membership m ON m.person = l.person \
        WHERE l.platform = $1 AND l.context = $2 AND m.course = $3 AND m.role = 'student' ORDER BY l.person";
    MEMBER = "SELECT p.id, p.name, m.role, m.seed, m.joined_at FROM membership m JOIN person p ON p.id = m.person \
        WHERE m.course = $1 AND m.person = $2";
    SUBJECT_OF = "SELECT subject FROM lti_person WHERE platform = $1 AND context = $2 AND person = $3";
    FORGET_SUBJECT = "DELETE FROM lti_person WHERE person = $1";
    FORGET_SCORES = "DELETE FROM lti_score WHERE person = $1";
    SUBJECTS = "SELECT platform, subject FROM lti_person WHERE person = $1 ORDER BY platform, context";

    // What is not what was told last is due.
    WANT = "INSERT INTO lti_score (platform, url, person, context, slug, wanted, stamp, tries, not_before, lease_until, \
        problem) VALUES ($1, $2, $3, $4, $5, $6, 0, 0, 0, 0, '') ON CONFLICT (platform, url, person) DO UPDATE SET \
        wanted = $6, tries = 0, not_before = 0, problem = '' WHERE lti_score.wanted <> $6";
    HOLD = "UPDATE lti_score SET wanted = sent, lease_until = 0 WHERE platform = $1 AND url = $2 AND person = $3 \
        AND sent IS NOT NULL";
    HOLD_FIRST = "DELETE FROM lti_score WHERE platform = $1 AND url = $2 AND person = $3 AND sent IS NULL";
    // One that is due, for whoever asks; the time that is told with it grows by each claim.
    CLAIM = "UPDATE lti_score SET lease_until = $3, stamp = CASE WHEN stamp >= $2 THEN stamp + 1 ELSE $2 END \
        WHERE lease_until <= $2 AND platform = $1 AND (url, person) IN (SELECT url, person FROM lti_score \
        WHERE platform = $1 AND (sent IS NULL OR sent <> wanted) AND not_before <= $2 AND lease_until <= $2 AND tries < $4 \
        ORDER BY tries, not_before, person, url LIMIT 1) RETURNING url, person, context, slug, stamp, tries";
    TOLD = "UPDATE lti_score SET sent = $4, wanted = $4, sent_at = $5, tries = 0, not_before = 0, problem = '', \
        lease_until = 0 WHERE platform = $1 AND url = $2 AND person = $3";
    FAILED = "UPDATE lti_score SET tries = tries + 1, not_before = $4, problem = $5, lease_until = 0 \
        WHERE platform = $1 AND url = $2 AND person = $3";
    GIVE_BACK = "UPDATE lti_score SET lease_until = 0 WHERE platform = $1 AND url = $2 AND person = $3";
    AGAIN = "UPDATE lti_score SET tries = 0, not_before = 0 WHERE platform = $1 AND (sent IS NULL OR sent <> wanted)";
    PLACES = "SELECT c.context, c.slug, c.url, COUNT(s.person), \
        CAST(COALESCE(SUM(CASE WHEN s.sent = s.wanted THEN 1 ELSE 0 END), 0) AS BIGINT), \
        CAST(COALESCE(SUM(CASE WHEN s.tries >= $2 THEN 1 ELSE 0 END), 0) AS BIGINT), \
        COALESCE(MAX(s.problem), ''), MAX(s.sent_at) FROM lti_column c \
        LEFT JOIN lti_score s ON s.platform = c.platform AND s.url = c.url \
        WHERE c.platform = $1 GROUP BY c.context, c.slug, c.url ORDER BY c.context, c.slug, c.url";
}
