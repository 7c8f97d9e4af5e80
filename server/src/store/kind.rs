//! Words in which the databases differ.

use sqlx::AnyConnection;

/// Which database answers on a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Sqlite,
    Postgres,
}

impl Kind {
    pub(super) fn of(connection: &AnyConnection) -> Self {
        if connection.backend_name() == "PostgreSQL" { Self::Postgres } else { Self::Sqlite }
    }

    /// Begins a transaction that writes, and waits for others there and not at the first change.
    pub(super) fn begin(self) -> &'static str {
        match self {
            Self::Sqlite => "BEGIN IMMEDIATE",
            // There the first statement holds what the others may not change meanwhile.
            Self::Postgres => "BEGIN",
        }
    }

    /// Begins to read everything as of one moment.
    pub(super) fn snapshot(self) -> &'static str {
        match self {
            Self::Sqlite => "BEGIN",
            Self::Postgres => "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY",
        }
    }

    /// Names and types of the columns of the table `$1`.
    pub(super) fn columns(self) -> &'static str {
        match self {
            Self::Sqlite => "SELECT name, type FROM pragma_table_info($1)",
            Self::Postgres => {
                "SELECT CAST(column_name AS TEXT), UPPER(CAST(data_type AS TEXT)) FROM information_schema.columns \
                 WHERE table_schema = current_schema() AND table_name = $1"
            }
        }
    }

    /// A statement that makes tables, columns or triggers, in this database's words. Ours are SQLite's.
    pub(super) fn making(self, text: &str) -> String {
        match self {
            Self::Postgres if text.starts_with("CREATE TRIGGER") => text
                .replace("BEGIN SELECT RAISE(ABORT, ", "FOR EACH ROW EXECUTE FUNCTION triad_refuse(")
                .replace("); END", ")"),
            // Sorted and compared as bytes, whatever the language of the server.
            Self::Postgres if text.starts_with("CREATE TABLE") || text.starts_with("ALTER TABLE") => {
                text.replace(" TEXT", " TEXT COLLATE \"C\"")
            }
            Self::Sqlite | Self::Postgres => text.to_owned(),
        }
    }
}
