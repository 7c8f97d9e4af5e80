//! Joins questions and references.

use std::collections::BTreeMap;

use super::context::{BuildContext, BuildError, QuestionError, build_error, refuse};
use super::question::{Exercise, QuantityQuestion, Question, QuestionBody};
use super::{closed, diagram, explanation, named, pools, quantity, tasks};
use crate::answers::tolerance::ValueShape;
use crate::files::{ExerciseFile, QuestionFile, QuestionKind, ReferenceFile, earlier_value};

/// Joins questions and references.
pub(crate) fn build(
    file: ExerciseFile,
    mut references: BTreeMap<String, ReferenceFile>,
    context: &BuildContext,
) -> Result<Exercise, QuestionError> {
    let mut questions: Vec<Question> = Vec::new();
    for question in file.questions {
        let id = question.id.clone();
        let built = new_id(&question, &questions)
            .and_then(|()| reference_of(&id, &mut references))
            .and_then(|reference| build_question(question, reference, context));
        questions.push(built.map_err(|e| QuestionError {
            question: id,
            in_reference: e.in_reference,
            problem: e.problem,
            remedy: e.remedy,
        })?);
    }
    follows_earlier(&questions)?;
    pools::usable(&file.draw, &questions)?;
    if let Some(id) = references.keys().next() {
        return Err(QuestionError {
            question: id.clone(),
            in_reference: true,
            problem: "it has a reference but is not asked".to_owned(),
            remedy: "remove it from reference/answers.toml or ask it".to_owned(),
        });
    }
    Ok(Exercise { pass_mark: file.pass_mark, draw: file.draw, questions })
}

/// An id that can be used and is used once, and points that count.
fn new_id(question: &QuestionFile, earlier: &[Question]) -> Result<(), BuildError> {
    let id = &question.id;
    if id.is_empty() || !id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-') {
        return Err(build_error("its id is not made of small letters, digits and dashes", "rename it"));
    }
    if earlier.iter().any(|q| q.id == *id) {
        return Err(build_error("its id is used twice", "rename one of them"));
    }
    if !(question.points > 0.0 && question.points.is_finite()) {
        return Err(build_error("its points are not positive", "give it at least 1 point"));
    }
    Ok(())
}

fn reference_of(
    id: &str,
    references: &mut BTreeMap<String, ReferenceFile>,
) -> Result<ReferenceFile, BuildError> {
    references.remove(id).ok_or_else(|| {
        let remedy = format!("add [{id}] with value, error, provenance and source to reference/answers.toml");
        build_error("it has no reference", remedy)
    })
}

fn build_question(
    mut question: QuestionFile,
    mut reference: ReferenceFile,
    context: &BuildContext,
) -> Result<Question, BuildError> {
    named::put(&mut question, &mut reference, context.scene, context.parameters)?;
    let body = match question.kind {
        QuestionKind::Number => quantity::quantity(&question, &reference, ValueShape::Number, context),
        QuestionKind::Vector => quantity::quantity(&question, &reference, ValueShape::Vector, context),
        QuestionKind::Matrix => quantity::quantity(&question, &reference, ValueShape::Matrix, context),
        QuestionKind::Choice => closed::choice(&question, &reference),
        QuestionKind::Formula => closed::formula(&question, &reference),
        QuestionKind::Diagram => diagram::diagram(&question, &reference, context).map(QuestionBody::Diagram),
        QuestionKind::Implement => tasks::implement(&question, context),
        QuestionKind::Trajectory => tasks::trajectory(&question, context),
        QuestionKind::Model => tasks::model(&question, context),
        QuestionKind::Tuning => tasks::tuning(&question, &reference, context),
        QuestionKind::Explanation => explanation::explanation(&question, &reference),
    }?;
    foreign_tables(&question)?;
    let fill = |text: &String| context.parameters.fill(text);
    Ok(Question {
        kind: question.kind,
        prompt: fill(&question.prompt),
        points: question.points,
        pool: question.pool,
        hints: question.hints.iter().map(fill).collect(),
        right: fill(&question.right),
        id: question.id,
        body,
        provenance: reference.provenance,
        source: reference.source,
        measured: reference.measured,
    })
}

/// What is carried through comes from an earlier number.
fn follows_earlier(questions: &[Question]) -> Result<(), QuestionError> {
    for (at, question) in questions.iter().enumerate() {
        let QuestionBody::Quantity(QuantityQuestion { follows: Some(follows), .. }) = &question.body else {
            continue;
        };
        for earlier in follows.from.values() {
            let (id, component) = earlier_value(earlier);
            let fits = |q: &Question| match q.kind {
                QuestionKind::Number => *earlier == q.id,
                QuestionKind::Vector => id == q.id && component.is_some(),
                _ => false,
            };
            if !questions[..at].iter().any(fits) {
                return Err(QuestionError {
                    question: question.id.clone(),
                    in_reference: false,
                    problem: format!("it follows {earlier}, which is no earlier number"),
                    remedy: "name an earlier number by its id, or a component of an earlier vector as id.y"
                        .to_owned(),
                });
            }
        }
    }
    Ok(())
}

/// Tables of one kind of question do not belong to another.
fn foreign_tables(question: &QuestionFile) -> Result<(), BuildError> {
    use QuestionKind as Kind;
    let kind = question.kind;
    let name = format!("{kind:?}").to_lowercase();
    let quantity = matches!(kind, Kind::Number | Kind::Vector | Kind::Matrix);
    refuse(question.diagram.is_some() && kind != Kind::Diagram, "the table diagram", &name)?;
    refuse(question.implement.is_some() && kind != Kind::Implement, "the table implement", &name)?;
    refuse(question.trajectory.is_some() && kind != Kind::Trajectory, "the table trajectory", &name)?;
    refuse(question.model.is_some() && kind != Kind::Model, "the table model", &name)?;
    refuse(question.tuning.is_some() && kind != Kind::Tuning, "the table tuning", &name)?;
    refuse(question.explanation.is_some() && kind != Kind::Explanation, "the table explanation", &name)?;
    refuse(question.follows.is_some() && !quantity, "the table follows", &name)
}
