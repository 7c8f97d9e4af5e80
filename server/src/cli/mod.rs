//! The command line: everything that the page does can be done here too.

mod choice;
mod clock;
mod config;
mod course;
mod export;
mod grader;
mod interrupt;
mod logging;
mod measure;
mod oidc;
mod output;
mod scene;
mod serve;
mod stops;
mod table;
mod terminal;

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};

use triad_engine::analysis::ModesAbout;

use crate::problem::Problem;
use course::lesson::LessonCommand;
use course::{grade, grades, graph, lesson, lti, preview, records, regrade};
use export::Export;
use logging::Log;
use measure::{bench, paper, stress, sweep};
use scene::options::Run;
use scene::source::Source;
use scene::{analyses, check, import, run};
use serve::Serve;
use terminal::Outcome;

/// Ends of `--help`: what a newcomer does first.
const EXAMPLES: &str = "\
Examples:
  triad                                        open the workbench at http://127.0.0.1:8080
  triad run simple-pendulum                    run a built-in scene and see how far it can be trusted
  triad run n-four-bar:2 --until 5 --out a.csv write positions, velocities and reactions
  triad check my-scene.json                    count bodies, rows and degrees of freedom
  triad lesson list                            the lessons of the course

Exit codes:
  0  done
  1  done, and the answer is no: the run stopped early, the exercise is not passed, the course has faults
  2  the command line was not understood
  3  the input was refused: a scene, a lesson or a submission
  4  the machine refused: a file, a port or a database";

/// A teaching workbench for multibody dynamics.
///
/// Without a command it serves the workbench at `http://127.0.0.1:8080`: lessons with live mechanisms and graded
/// exercises.
#[derive(Debug, Parser)]
#[command(name = "triad", version, after_help = EXAMPLES, arg_required_else_help = false)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    /// For machines: print JSON only.
    #[arg(long, global = true)]
    json: bool,
    /// The folder of a course, instead of the one that is built in.
    #[arg(long, global = true, value_name = "DIR", env = "TRIAD_COURSE")]
    course: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Serve the workbench: page, HTTP API and live streams on one port.
    #[command(after_help = "Examples:\n  triad serve --port 9000\n  \
        triad serve --class --host 0.0.0.0 --database /srv/triad/grades.db   (for a class on one network)")]
    Serve(Box<Serve>),
    /// Tell each setting of `triad serve`, as a file of settings, and where it comes from; passwords are hidden.
    ///
    /// The command line goes before the environment, that before the file that --config names, and the file before the default.
    #[command(
        after_help = "Examples:\n  triad config > triad.toml\n  triad config --config triad.toml --port 9000"
    )]
    Config(Box<Serve>),
    /// Run a scene; tells energy drift, constraint violation, work and events.
    ///
    /// Events are moments that the scene asks for under "events": when a coordinate of a point, a distance, a joint's
    /// angle or its slide passes a value. An event with "stop": true ends the run. For example
    /// {"name": "lowest", "of": {"type": "coordinate", "body": "bob", "direction": [0, 1, 0]}, "value": -0.5}
    #[command(after_help = "Examples:\n  triad run simple-pendulum\n  \
        triad run n-four-bar:2 --until 5 --every 0.01 --out positions.csv\n  \
        triad run my-scene.json --outputs joints,drivers,loads,reactions:pin --out forces.csv\n  \
        triad run my-scene.json --rrd run.rrd      (then: rerun run.rrd)\n  \
        triad run free-body --json | jq .summary.energy_drift")]
    Run(Run),
    /// Count what a scene amounts to: bodies, coordinates, rows, rank, degrees of freedom, redundant rows.
    #[command(after_help = "Example:\n  triad check n-four-bar:3")]
    Check(Source),
    /// Tell the reactions of joints and drivers at a time, and which of their components are unique.
    #[command(after_help = "Examples:\n  triad reactions n-four-bar:2 --at 0.3\n  \
        triad reactions spatial-slider-crank --on i --about center-of-mass --in body")]
    Reactions {
        #[command(flatten)]
        source: Source,
        /// The time in seconds.
        #[arg(long, default_value_t = 0.0, value_name = "S", allow_negative_numbers = true)]
        at: f64,
        #[command(flatten)]
        words: analyses::Words,
    },
    /// Find the position of rest near the start.
    #[command(after_help = "Example:\n  triad equilibrium simple-pendulum")]
    Equilibrium(Source),
    /// Frequencies and shapes of small vibrations about the equilibrium.
    #[command(after_help = "Examples:\n  triad modes spatial-double-pendulum\n  \
        triad modes n-four-bar:2 --at-start\n  triad modes my-driven-scene.json --steady")]
    Modes {
        #[command(flatten)]
        source: Source,
        /// About the start, at rest, instead of the equilibrium.
        #[arg(long)]
        at_start: bool,
        /// About the steady motion near the start, drivers at their speed, instead of a position at rest.
        #[arg(long, conflicts_with = "at_start")]
        steady: bool,
    },
    /// Follow the drivers of a scene: positions, velocities, accelerations, and the forces that drive it.
    ///
    /// The scene needs a driver for each degree of freedom.
    #[command(after_help = "Example:\n  triad kinematics my-driven-scene.json --in joint --json")]
    Kinematics {
        #[command(flatten)]
        source: Source,
        #[command(flatten)]
        words: analyses::Words,
    },
    /// Close the joints of a roughly placed scene.
    #[command(after_help = "Example:\n  triad assemble my-scene.json --keep crank")]
    Assemble {
        #[command(flatten)]
        source: Source,
        /// A body that stays where it is; may be given more than once.
        #[arg(long, value_name = "BODY")]
        keep: Vec<String>,
    },
    /// Run the paper's own examples with its own settings, and compare.
    ///
    /// Prints its Table 1 and Fig. 12 beside ours, and what our measurement says of its claim that reduced bodies win
    /// in large models. Exits with 1 if a count that must be equal is not.
    #[command(
        after_help = "Examples:\n  triad paper\n  triad paper --bodies 5\n  triad paper --svg fig12.svg"
    )]
    Paper(paper::Paper),
    /// Make a scene of a robot described in URDF, and tell what could not be carried over.
    #[command(after_help = "Examples:\n  triad import arm.urdf --out arm.json\n  \
        triad import gripper.urdf --with loops.json --out gripper.json\n\nA side-car closes loops and says how to \
        start:\n  {\"positions\": {\"shoulder\": 0.5},\n   \"joints\": [{\"name\": \"closing\", \"type\": \
        \"spherical\", \"body_i\": \"rod\", \"body_j\": \"ground\",\n               \"point_i\": [0, 0, 1], \
        \"point_j\": [1, 0, 0]}]}\nBodies are links of the URDF, points and axes are given in their frames.")]
    Import(import::Import),
    /// List the built-in scenes, or print one of them: the quickest start of a scene of your own.
    #[command(after_help = "Examples:\n  triad scenes\n  triad scenes n-four-bar:2 > my-scene.json\n  \
        triad run my-scene.json")]
    Scenes {
        /// The scene to print as JSON; without it the list of all.
        name: Option<String>,
        /// List them, as without a name.
        #[arg(long, conflicts_with = "name")]
        list: bool,
        /// Print how a scene is written, with an example, instead.
        #[arg(long, conflicts_with_all = ["name", "list"])]
        guide: bool,
    },
    /// Grade a submission as the workbench would; nothing is kept.
    #[command(
        after_help = "Example:\n  triad grade simple-pendulum answers.json\n\nA submission looks like\n  \
        {\"student\": \"ada\", \"answers\": {\"tension\": {\"value\": \"29.4\", \"unit\": \"N\"}}}"
    )]
    Grade {
        /// The lesson's slug; see `triad lesson list`.
        lesson: String,
        /// The file with the answers.
        submission: PathBuf,
    },
    /// What everybody has reached, from the gradebook: as a table, as CSV for Canvas or Moodle, or checked for damage.
    #[command(after_help = "Examples:\n  triad grades\n  triad grades --csv > grades.csv\n  \
        triad grades --csv --for canvas --database /srv/triad/grades.db\n  triad grades --check")]
    Grades(grades::Grades),
    /// Grade what waits in a gradebook that servers share, beside them or on another machine.
    ///
    /// A server answers at once what it can grade in 0.3 s; the rest waits in the database, and each grader takes the next, of
    /// whom has fewest before them. What a grader had when it ended is taken over by another. What has ended its grader three
    /// times is put aside, without using an attempt.
    #[command(after_help = "Examples:\n  triad grader --database postgres://triad@db.example.org/grades\n  \
        triad grader --look --database postgres://triad@db.example.org/grades")]
    Grader(grader::Options),
    /// Rebuild every verdict of a gradebook: with the same lesson, seed and answers each must come out byte for byte.
    ///
    /// Or look at what the lesson as it is now makes of what was handed in, for each student; apply it, and take it back.
    #[command(after_help = "Examples:\n  triad regrade --check --database /srv/triad/grades.db\n  \
        triad regrade --lesson screw\n  \
        triad regrade --lesson screw --apply better --reason \"the reference had the wrong sign\"")]
    Regrade(regrade::Regrade),
    /// Copy the whole gradebook into a new file while the server runs, and look at every record of the copy.
    ///
    /// The copy is the gradebook as of one moment: people, submissions, verdicts, decisions, and the log with its chain of
    /// hashes, which is followed to its end before the copy counts. It is readable by you alone, as it holds names and
    /// grades. Copying the file by other means misses what stands in its -wal.
    #[command(after_help = "Examples:\n  triad backup monday.db\n  \
        triad backup \"/backup/triad-$(date +%F).db\" --database /srv/triad/grades.db      (each night, by cron)\n\n\
        Nothing is overwritten. To bring it back: triad restore monday.db")]
    Backup(records::Backup),
    /// Make a gradebook of a backup, after looking at every record of it.
    ///
    /// Nothing is overwritten: stop the server, move the gradebook that is there away with its -wal and -shm, restore, start
    /// the server. A server that still runs finds that its file was moved, and keeps nothing in it.
    #[command(
        after_help = "Example:\n  mv triad.db broken.db\n  triad restore monday.db\n  triad serve --class"
    )]
    Restore(records::Restore),
    /// A class as one file, from one gradebook to another; and one person's data.
    #[command(subcommand)]
    Class(records::Class),
    /// The learning platform of a class: Moodle, Canvas, Open edX and others that speak LTI 1.3.
    ///
    /// Its people come in from their course there, choose lessons, and find their scores in its grade book.
    #[command(
        subcommand,
        after_help = "Example:\n  triad lti tool --url https://triad.example.org     (what the platform's settings ask for)\n  \
        triad lti add --issuer https://moodle.example.org --client-id 9kVQ… --deployment 3 \\\n    \
        --jwks-url https://moodle.example.org/mod/lti/certs.php \\\n    \
        --login-url https://moodle.example.org/mod/lti/auth.php \\\n    \
        --token-url https://moodle.example.org/mod/lti/token.php\n  \
        triad serve --class --url https://triad.example.org"
    )]
    Lti(lti::Lti),
    /// The lessons of the course.
    #[command(subcommand)]
    Lesson(LessonCommand),
    /// Measure run time against error: integrators, treatments, kinds of bodies, tolerances.
    ///
    /// Of the built-in scenes, or of your own. The error of a scene of your own is the largest distance from a run of the
    /// same scene at the tightest tolerance, and not less than what that run may be off itself. A method that cannot run it is
    /// left out. Times hold the estimate of the error that a run carries along, unless the scene has "error_estimate": false.
    #[command(
        after_help = "Examples:\n  triad bench --quick            (then open reports/bench.html, or /bench in the \
        workbench)\n  triad bench my-scene.json --tolerances 1e-4,1e-8\n  triad bench --scenes chain --integrators taylor,dop853 --coordinates full,reduced,shared\n  \
        triad bench --quick --integrators dop853 --treatment projection \
        --treatment '{\"kind\": \"baumgarte\", \"alpha\": 5, \"beta\": 5}'"
    )]
    Bench(bench::Bench),
    /// Run a scene many times with varied numbers, in parallel: grids and random samples (Monte Carlo).
    ///
    /// Each run tells its chosen outputs at its end. The results do not depend on the number of threads. A run that
    /// cannot start or go on is listed and ends nothing else; Ctrl-C keeps what is done.
    #[command(
        after_help = "Examples:\n  triad sweep simple-pendulum --vary /gravity/1=-9.81:-1.62:20 --outputs joints\n  \
        triad sweep simple-pendulum --vary /bodies/0/mass=normal:1:0.1 --samples 1000 --out runs.csv\n  \
        triad sweep my-scene.json --vary stiffness=50:200:31 --outputs energy,loads:spring --svg energy.svg"
    )]
    Sweep(sweep::Options),
    /// Try to break the engine: singular positions, redundancy, extreme scales, random mechanisms, each judged.
    #[command(after_help = "Examples:\n  triad stress --quick\n  triad stress --case four-bar\n  \
        triad stress --case random --seeds 500 --from 1000\n  triad stress --compare --html report.html\n  triad stress --treatments --svg treatments.svg")]
    Stress(stress::Stress),
    /// Write for other programs: the documentation as files, a lesson for the autograder of another system.
    #[command(subcommand)]
    Export(Export),
    /// Print a JSON Schema, for editors: of a scene, or of an author's file.
    #[command(
        after_help = "Examples:\n  triad schema > scene.schema.json\n  triad schema exercise > exercise.schema.json"
    )]
    Schema {
        /// Of what: scene, course, lesson, exercise, reference (reference/answers.toml) or wrong (wrong/*.toml).
        #[arg(default_value = "scene")]
        of: String,
    },
}

/// Runs the command that the program was called with.
pub fn main() -> ExitCode {
    let words: Vec<OsString> = std::env::args_os().collect();
    let json = words.iter().any(|word| word == "--json");
    let ended = understood(words).and_then(dispatch);
    if let Some(why) = terminal::lost() {
        terminal::tell(&format!("{} what was printed is not complete: {why}", terminal::error_label()));
        return ExitCode::from(4);
    }
    match ended {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::No) => ExitCode::from(1),
        Err(problem) => {
            if json {
                terminal::print_json(&problem.document());
            } else {
                terminal::tell(&format!("{} {problem}", terminal::error_label()));
            }
            ExitCode::from(if machine_refused(&problem) { 4 } else { 3 })
        }
    }
}

/// What the program was called with, and the settings of a file.
struct Understood {
    arguments: Arguments,
    matches: ArgMatches,
    settings: config::Settings,
}

/// Reads the command line; without a command it is `serve`. A file of settings is read first, and takes the place of defaults.
///
/// Errors if the file cannot be read or has a mistake. What clap does not understand ends the program.
fn understood(mut words: Vec<OsString>) -> Result<Understood, Problem> {
    let command = Arguments::command();
    if command.clone().get_matches_from(&words).subcommand_name().is_none() {
        words.push("serve".into());
    }
    let first = command.clone().get_matches_from(&words);
    let taker = first.subcommand().filter(|(name, _)| config::takes(name));
    let named = taker.and_then(|(_, given)| given.get_one::<PathBuf>("config"));
    let settings = named.map_or_else(|| Ok(config::Settings::new()), |file| config::read(file, &command))?;
    let matches = config::with(command, &settings).get_matches_from(&words);
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    Ok(Understood { arguments, matches, settings })
}

fn dispatch(Understood { arguments, matches, settings }: Understood) -> Result<Outcome, Problem> {
    let Arguments { command, json, course: folder } = arguments;
    let course = || lesson::course(folder.as_deref());
    // `understood` has put one there.
    let Some(command) = command else { return Ok(Outcome::No) };
    logging::start(match &command {
        Command::Serve(options) => options.log,
        Command::Grader(options) => options.log,
        _ => Log::Faults,
    });
    match command {
        Command::Serve(options) => serve::serve(&options, course()?),
        Command::Config(_) => Ok(match matches.subcommand() {
            Some((_, given)) => config::tell(&Arguments::command(), given, &settings, json),
            None => Outcome::No,
        }),
        Command::Run(options) => run::run(&options, json),
        Command::Check(source) => check::check(&source, json),
        Command::Reactions { source, at, words } => analyses::reactions(&source, at, &words, json),
        Command::Equilibrium(source) => analyses::equilibrium(&source, json),
        Command::Modes { source, at_start, steady } => {
            let about = match (at_start, steady) {
                (true, _) => ModesAbout::Start,
                (_, true) => ModesAbout::Steady,
                _ => ModesAbout::Equilibrium,
            };
            analyses::modes(&source, about, json)
        }
        Command::Kinematics { source, words } => analyses::kinematics(&source, &words, json),
        Command::Assemble { source, keep } => analyses::assemble(&source, &keep, json),
        Command::Paper(options) => paper::paper(&options, json),
        Command::Import(options) => import::import(&options, json),
        Command::Scenes { name: Some(name), .. } => check::show(&name),
        Command::Scenes { name: None, guide: true, .. } => Ok(check::guide(json)),
        Command::Scenes { name: None, .. } => Ok(check::list(json)),
        Command::Grade { lesson, submission } => grade::grade(&course()?, &lesson, &submission, json),
        Command::Grades(options) => grades::grades(&options, &course()?, json),
        Command::Grader(options) => grader::grader(&options, json),
        Command::Backup(options) => records::backup(&options, json),
        Command::Restore(options) => records::restore(&options, json),
        Command::Class(options) => records::class(options, json),
        Command::Lti(command) => lti::lti(command, json),
        Command::Regrade(options) => regrade::regrade(&options, &course()?, json),
        Command::Lesson(LessonCommand::List) => Ok(lesson::list(&course()?, json)),
        Command::Lesson(LessonCommand::Graph { dot }) => Ok(graph::graph(&course()?, dot, json)),
        Command::Lesson(LessonCommand::Check { lesson }) => {
            lesson::check(&course()?, lesson.as_deref(), json)
        }
        Command::Lesson(LessonCommand::New { slug, into }) => lesson::new(&slug, &into, json),
        Command::Lesson(LessonCommand::Preview { lesson, port }) => {
            preview::preview(folder.as_deref(), &lesson, port)
        }
        Command::Lesson(LessonCommand::Starter(options)) => lesson::starter(&course()?, &options, json),
        Command::Bench(options) => bench::bench(options, json),
        Command::Sweep(options) => sweep::run(&options, json),
        Command::Stress(options) => stress::stress(&options, json),
        Command::Export(what) => export::export(&what, course, json),
        Command::Schema { of } => lesson::schema(&of),
    }
}

/// Whether a problem lies in the machine rather than in what was given.
fn machine_refused(problem: &Problem) -> bool {
    problem.status().is_server_error() || matches!(problem.code(), "unreadable-file" | "no-such-file")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent_and_serves_by_default() {
        Arguments::command().debug_assert();
        assert!(Arguments::parse_from(["triad"]).command.is_none());
        let parsed = Arguments::parse_from(["triad", "run", "free-body", "--until", "1", "--json"]);
        assert!(parsed.json);
        let Some(Command::Serve(serve)) = Arguments::parse_from(["triad", "serve"]).command else {
            panic!("serve is a command");
        };
        assert_eq!((serve.port, serve.max_sessions, serve.class), (8080, 64, false));
    }
}
