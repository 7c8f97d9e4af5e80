//! The folder of a question for PrairieLearn: what is asked is shown there, `tests/` goes into the grader's container.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use clap::Args;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use triad_lessons::Lesson;
use triad_lessons::lesson::QuestionView;
use triad_lessons::rendering::html::escape;

use super::program::NAME;
use crate::cli::output::{make_folder, unwritable, write as write_file};
use crate::problem::Problem;

/// Seconds that grading may take there; the slowest lesson of the course takes a few.
const TIMEOUT: u32 = 120;
/// Chooses a variant and hands its texts to the page.
const SERVER: &str = include_str!("server.py");
/// The question's page.
const PAGE: &str = include_str!("question.html");

#[derive(Debug, Args)]
pub(in crate::cli) struct PrairieLearn {
    /// How many sets of numbers there are; 20 if it is not given, or 1 where everybody's numbers are the same.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    variants: Option<u16>,
    /// The image to grade in: any of Linux will do.
    #[arg(long, default_value = "alpine:3", value_name = "IMAGE")]
    pub(super) image: String,
    /// The topic of the question, one of those of the course.
    #[arg(long, default_value = "Dynamics", value_name = "NAME")]
    topic: String,
}

/// Writes the folder; tells how many variants it has.
pub(super) fn write(
    lesson: &Lesson,
    program: &[u8],
    options: &PrairieLearn,
    out: &Path,
) -> Result<usize, Problem> {
    let count = options.variants.map_or(if lesson.has_variants() { 20 } else { 1 }, usize::from);
    // With one variant the numbers are those that everybody sees without a name.
    let seeds =
        if count == 1 { vec![String::new()] } else { (1..=count).map(|k| format!("variant {k}")).collect() };
    let variants = seeds.iter().map(|seed| variant(lesson, seed)).collect::<Result<Vec<_>, Problem>>()?;
    let text = |value: &Value| serde_json::to_string_pretty(value).map_err(Problem::internal);
    make_folder(out)?;
    write_file(&out.join("info.json"), text(&info(lesson, options, count))?)?;
    write_file(&out.join("question.html"), PAGE)?;
    write_file(&out.join("server.py"), SERVER)?;
    write_file(&out.join("variants.json"), text(&json!(variants))?)?;
    write_file(&out.join("tests/lesson.json"), lesson.bundle())?;
    write_file(&out.join("tests").join(NAME), program)?;
    executable(&out.join("tests").join(NAME))?;
    Ok(count)
}

/// A question's `info.json`. Its name among all questions follows from the lesson's: it is the same in each export.
fn info(lesson: &Lesson, options: &PrairieLearn, variants: usize) -> Value {
    let mut id = [0; 16];
    id.copy_from_slice(&Sha256::digest(format!("triad lesson {}", lesson.slug))[..16]);
    json!({
        "uuid": uuid::Builder::from_random_bytes(id).into_uuid().to_string(),
        "title": lesson.about.title,
        "topic": options.topic,
        "tags": ["triad"],
        "type": "v3",
        "singleVariant": variants == 1,
        "gradingMethod": "External",
        "externalGradingOptions": {
            "enabled": true,
            "image": options.image,
            "entrypoint": format!("/grade/tests/{NAME} prairielearn"),
            "timeout": TIMEOUT,
        },
    })
}

/// What a student sees with the numbers of a seed.
fn variant(lesson: &Lesson, seed: &str) -> Result<Value, Problem> {
    let lesson = lesson.of_seed(seed)?;
    let view = lesson.public_view().exercise;
    let questions: String = (1..).zip(&view.questions).map(|(number, one)| question(number, one)).collect();
    let blank = serde_json::to_string_pretty(&lesson.blank_answers()).map_err(Problem::internal)?;
    Ok(json!({
        "seed": seed,
        "questions": format!("{}{questions}", with_dollars(&view.conventions_html)),
        "blank": blank,
    }))
}

fn question(number: usize, question: &QuestionView) -> String {
    let mut html = format!(
        "<section><h4>{number}. <code>{}</code> <small>({} points)</small></h4>{}",
        question.id,
        question.points,
        with_dollars(&question.prompt_html)
    );
    if let Some(options) = &question.options {
        html.push_str("<ul>");
        for option in options {
            let _ =
                write!(html, "<li><code>{}</code> {}</li>", escape(&option.id), with_dollars(&option.html));
        }
        html.push_str("</ul>");
    }
    let _ = write!(html, "<p><small>{}</small></p></section>", escape(&question.rule));
    html
}

/// Formulas as PrairieLearn's pages set them, between dollars.
fn with_dollars(html: &str) -> String {
    let inline = html.replace("<span class=\"math inline\">", "$").replace("</span>", "$");
    let mut parts = inline.split("<div class=\"math display\"");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (_, formula) = part.split_once('>').unwrap_or(("", part));
        text.push_str("$$");
        text.push_str(&formula.replacen("</div>", "$$", 1));
    }
    text
}

#[cfg(unix)]
fn executable(file: &Path) -> Result<(), Problem> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(file, fs::Permissions::from_mode(0o755)).map_err(|error| unwritable(file, &error))
}

#[cfg(not(unix))]
fn executable(_: &Path) -> Result<(), Problem> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::with_dollars;

    #[test]
    fn formulas_stand_between_dollars() {
        let html = "<p>Let <span class=\"math inline\">a&lt;b</span>.</p><div class=\"math display\" id=\"eq-1\">c</div><p>d</p>";
        assert_eq!(with_dollars(html), "<p>Let $a&lt;b$.</p>$$c$$<p>d</p>");
    }
}
