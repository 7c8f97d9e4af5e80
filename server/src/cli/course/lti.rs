//! `triad lti`: the learning platform of a class.

use axum::http::StatusCode;
use clap::{Args, Subcommand};
use serde_json::json;

use super::grades::existing;
use super::records::{Database, run, said};
use crate::cli::terminal::{Outcome, print_json, print_line};
use crate::lti::address::safe;
use crate::lti::registration::{Registration, Tool};
use crate::lti::{keys, refusal::Refusal};
use crate::problem::Problem;
use crate::store::{CLASS, Context, Platform, Store};

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum Lti {
    /// Print our own addresses: what the platform's settings ask for.
    Tool {
        /// Where the class finds the server, as https://triad.example.org.
        #[arg(long, value_name = "URL", env = "TRIAD_URL")]
        url: String,
    },
    /// Register a platform, or change one of the same issuer and client.
    Add(Box<Add>),
    /// List the platforms that are registered, their courses, and whether they answer.
    List {
        #[command(flatten)]
        of: Database,
    },
    /// Take a registration back. Who came from there stays in the class, and is the same person if it is registered again.
    Remove {
        #[command(flatten)]
        which: Which,
    },
    /// Let the people of another course of the platform into the class. The first course links itself, as somebody who teaches
    /// it opens a lesson.
    Link {
        #[command(flatten)]
        which: Which,
        /// What the platform calls the course: its context id.
        course: String,
    },
    /// Let the people of a course of the platform in no longer.
    Unlink {
        #[command(flatten)]
        which: Which,
        /// What the platform calls the course: its context id, as `triad lti list` shows it.
        course: String,
    },
    /// Sign with a new key from now on; the keys of before stay published.
    RenewKey {
        #[command(flatten)]
        of: Database,
    },
}

/// A platform that is registered.
#[derive(Debug, Args)]
pub(in crate::cli) struct Which {
    /// What it is called here: the name that `triad lti list` shows.
    platform: String,
    #[command(flatten)]
    of: Database,
}

#[derive(Debug, Args)]
pub(in crate::cli) struct Add {
    /// What the platform calls itself: platform id, issuer.
    #[arg(long, value_name = "URL")]
    issuer: String,
    /// What it calls us.
    #[arg(long, value_name = "ID")]
    client_id: String,
    /// Its public key set.
    #[arg(long, value_name = "URL")]
    jwks_url: String,
    /// Its authentication request address.
    #[arg(long, value_name = "URL")]
    login_url: String,
    /// Its access token address.
    #[arg(long, value_name = "URL")]
    token_url: String,
    /// A deployment of the tool that may send people; may be given more than once.
    #[arg(long, value_name = "ID", required = true)]
    deployment: Vec<String>,
    /// Another origin at which the platform has scores and rosters, as https://school.instructure.com; may be given more than
    /// once.
    #[arg(long, value_name = "URL")]
    service: Vec<String>,
    /// For whom our proof is made where tokens are given, if it is not their address itself.
    #[arg(long, value_name = "TEXT")]
    audience: Option<String>,
    /// Where the class finds the server, to print what the platform's settings ask for.
    #[arg(long, value_name = "URL", env = "TRIAD_URL")]
    url: Option<String>,
    #[command(flatten)]
    of: Database,
}

/// Does what is asked.
pub(in crate::cli) fn lti(command: Lti, json: bool) -> Result<Outcome, Problem> {
    run(async {
        match command {
            Lti::Tool { url } => tell(&tool(&url)?, json),
            Lti::Add(options) => return add(*options, json).await,
            Lti::List { of } => return list(&open(&of).await?, json).await,
            Lti::Remove { which } => {
                let (store, platform) = found(&which).await?;
                store.remove_platform(CLASS, &platform.id).await?;
                return Ok(said(&format!("{} is registered no longer", platform.issuer), json));
            }
            Lti::Link { which, course } => {
                let (store, platform) = found(&which).await?;
                let context = Context {
                    title: course.clone(),
                    id: course,
                    line_items: String::new(),
                    members: String::new(),
                };
                store.link_context(CLASS, &platform.id, &context).await?;
                return Ok(said(&format!("people of the course {} come into the class", context.id), json));
            }
            Lti::Unlink { which, course } => {
                let (store, platform) = found(&which).await?;
                store.unlink_context(CLASS, &platform.id, &course).await?;
                return Ok(said(&format!("people of the course {course} come no longer"), json));
            }
            Lti::RenewKey { of } => {
                let name = keys::renew(&open(&of).await?).await?;
                return Ok(said(&format!("the key {name} signs from now on"), json));
            }
        }
        Ok(Outcome::Done)
    })
}

fn tool(url: &str) -> Result<Tool, Problem> {
    let safe = safe(url).ok_or_else(|| Refusal::NotServed(url.to_owned()))?;
    Ok(Tool::at(safe.as_str().trim_end_matches('/')))
}

fn tell(tool: &Tool, json: bool) {
    if json {
        return print_json(tool);
    }
    for (what, address) in [
        ("Tool URL, target link", &tool.target),
        ("Initiate login, OIDC initiation", &tool.login),
        ("Redirection, launch", &tool.launch),
        ("Content selection, deep linking", &tool.choice),
        ("Public key set", &tool.keys),
        ("All of it, for Canvas", &tool.configuration),
    ] {
        print_line(&format!("{what:<32} {address}"));
    }
}

/// The gradebook of a class.
async fn open(of: &Database) -> Result<Store, Problem> {
    let store = Store::at(existing(&of.database)?).await?;
    if store.course(CLASS).await.is_err() {
        return Err(Problem::new(
            StatusCode::NOT_FOUND,
            "no-class",
            format!("{} has no class yet", of.database),
            "start `triad serve --class` once: it makes the class",
        ));
    }
    Ok(store)
}

async fn add(options: Add, json: bool) -> Result<Outcome, Problem> {
    let Add { issuer, client_id, jwks_url, login_url, token_url, deployment, service, audience, url, of } =
        options;
    let tool = url.as_deref().map(tool).transpose()?;
    let registration = Registration {
        issuer,
        client_id,
        keys_url: jwks_url,
        login_url,
        token_url,
        audience,
        services: service,
        deployments: deployment,
    };
    let platform = registration.check().map_err(|(option, why)| {
        let wrong = format!("{option}: {why}");
        let hint = "copy it from the platform's settings of the tool: triad lti add --help";
        Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid-registration", wrong, hint)
    })?;
    let store = open(&of).await?;
    store.add_platform(CLASS, &platform).await?;
    if json {
        print_json(&json!({"platform": platform, "tool": tool}));
        return Ok(Outcome::Done);
    }
    print_line(&format!("{} is registered as {}", platform.issuer, platform.id));
    match &tool {
        Some(tool) => tell(tool, json),
        None => print_line("What the platform's settings ask for: triad lti tool --url https://…"),
    }
    Ok(Outcome::Done)
}

async fn list(store: &Store, json: bool) -> Result<Outcome, Problem> {
    let platforms = store.platforms(CLASS).await?;
    let mut all = Vec::new();
    for platform in platforms {
        let (contexts, pause) = (store.contexts(&platform.id).await?, store.pause_of(&platform.id).await?);
        if !json {
            print_line(&format!("{}  {}  client {}", platform.id, platform.issuer, platform.client_id));
            print_line(&format!("  deployments  {}", platform.deployments.join(", ")));
            print_line(&format!("  asked at     {}", platform.services.join(", ")));
            for context in &contexts {
                print_line(&format!("  course       {}  {}", context.id, context.title));
            }
            if !pause.problem.is_empty() {
                print_line(&format!("  problem      {}", pause.problem));
            }
        }
        all.push(json!({"platform": platform, "courses": contexts, "problem": pause.problem}));
    }
    if json {
        print_json(&all);
    } else if all.is_empty() {
        print_line("No platform is registered: triad lti add --help");
    }
    Ok(Outcome::Done)
}

/// The gradebook and the platform of that name.
async fn found(which: &Which) -> Result<(Store, Platform), Problem> {
    let store = open(&which.of).await?;
    let all = store.platforms(CLASS).await?;
    let known: Vec<String> = all.iter().map(|one| one.id.clone()).collect();
    match all.into_iter().find(|one| one.id == which.platform) {
        Some(platform) => Ok((store, platform)),
        None => Err(Problem::new(
            StatusCode::NOT_FOUND,
            "unknown-platform",
            format!("no platform is registered as {}", which.platform),
            if known.is_empty() {
                "none is: triad lti add --help".to_owned()
            } else {
                crate::problem::suggest(&which.platform, known.iter().map(String::as_str))
            },
        )),
    }
}
