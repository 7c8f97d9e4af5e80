//! What a student's earlier submissions decide: how often each question was tried, whether its answer is open, and which
//! points count. All of it follows from what is kept, so it can be computed again at any time.

use std::collections::BTreeMap;

use crate::answers::Answer;
use crate::exercise::{Question, QuestionBody};
use crate::files::OpensFile;
use crate::grading::same::same;
use crate::lesson::Lesson;
use crate::verdict::reference::reference;
use crate::verdict::{Mark, QuestionStanding, Verdict};

/// A submission and what was said about it.
#[derive(Debug, Clone, Copy)]
pub struct Attempt<'a> {
    /// The answers by the question's id.
    pub answers: &'a BTreeMap<String, Answer>,
    /// The verdict.
    pub verdict: &'a Verdict,
}

/// Where a student stands with each question of a lesson after these submissions, the oldest first.
///
/// An answer counts as an attempt if it could be read and says something else than all before: empty and repeated
/// submissions are none. Once a question is open ([`OpensFile`]) nothing changes its points.
pub fn standing(lesson: &Lesson, attempts: &[Attempt]) -> Vec<QuestionStanding> {
    lesson.exercise.questions.iter().map(|question| of_question(question, lesson.opens, attempts)).collect()
}

fn of_question(question: &Question, opens: OpensFile, attempts: &[Attempt]) -> QuestionStanding {
    let most = most_attempts(question, opens);
    let mut tried: Vec<&Answer> = Vec::new();
    let mut found = QuestionStanding { left: most, ..QuestionStanding::default() };
    for attempt in attempts.iter().filter(|attempt| attempt.verdict.gradable) {
        let given = attempt.verdict.questions.iter().find(|q| q.id == question.id);
        let (Some(given), Some(answer)) = (given, attempt.answers.get(&question.id)) else { continue };
        if found.open || !matches!(given.verdict, Mark::Right | Mark::Wrong | Mark::Kept) {
            continue;
        }
        found.best = found.best.max(given.earned);
        if !tried.iter().any(|before| same(question, before, answer)) {
            tried.push(answer);
        }
        found.attempts = tried.len();
        found.left = most.map(|most| most.saturating_sub(tried.len()));
        // What was told stays told, and what was not was not, whatever is set since.
        found.open = given.standing.map_or_else(
            || opens.right && given.verdict == Mark::Right || found.left == Some(0),
            |then| then.open,
        );
    }
    found
}

/// Different answers after which a question opens.
fn most_attempts(question: &Question, opens: OpensFile) -> Option<usize> {
    let most = match &question.body {
        // When one option is left it is known.
        QuestionBody::Choice { options, .. } => opens.choices.map(|n| n.min(options.len().saturating_sub(1))),
        // There is no right one.
        QuestionBody::Explanation(_) => None,
        _ => opens.attempts,
    };
    most.map(|most| most.max(1))
}

/// Puts what the earlier submissions decide into the verdict of one more: the points of questions that were open before it
/// stay as they were, and each question tells where the student stands now.
pub fn settle(
    lesson: &Lesson,
    earlier: &[Attempt],
    answers: &BTreeMap<String, Answer>,
    verdict: &mut Verdict,
) {
    // A verdict is on the questions that were dealt: not all of those that the lesson has.
    let ids: Vec<&str> = lesson.exercise.questions.iter().map(|question| question.id.as_str()).collect();
    let place = |id: &str| ids.iter().position(|other| *other == id);
    let before = standing(lesson, earlier);
    for question in &mut verdict.questions {
        if let Some(before) = place(&question.id).map(|at| before[at]).filter(|before| before.open) {
            question.earned = before.best;
        }
    }
    verdict.sum(lesson.exercise.pass_mark);
    let now = {
        let last = Attempt { answers, verdict };
        standing(lesson, &earlier.iter().copied().chain([last]).collect::<Vec<_>>())
    };
    for question in &mut verdict.questions {
        question.standing = place(&question.id).map(|at| now[at]);
    }
}

/// Adds the right answers of the questions that are open to a verdict that is settled and can be graded.
pub fn open(lesson: &Lesson, verdict: &mut Verdict) {
    if !verdict.gradable {
        return;
    }
    for question in verdict.questions.iter_mut().filter(|q| q.standing.is_some_and(|s| s.open)) {
        question.reference_html = lesson.question(&question.id).and_then(reference);
    }
}

/// The right answer to a question and its source, as safe HTML: for whoever may be told it.
pub fn right_answer(lesson: &Lesson, question: &str) -> Option<String> {
    lesson.question(question).and_then(reference)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::TypedValue;
    use crate::{Course, Submission, grade, reference_submission};

    /// A student who hands in again and again.
    struct Student {
        lesson: Lesson,
        kept: Vec<(Submission, Verdict)>,
    }

    impl Student {
        fn new(opens: OpensFile) -> Self {
            let lesson = Course::embedded().unwrap().lesson("spherical-joint").unwrap().clone();
            Self { lesson: Lesson { opens, ..lesson }, kept: Vec::new() }
        }

        fn hand_in(&mut self, submission: Submission) -> Verdict {
            let earlier: Vec<Attempt> =
                self.kept.iter().map(|(s, verdict)| Attempt { answers: &s.answers, verdict }).collect();
            let mut verdict = grade(&self.lesson, &submission).unwrap();
            settle(&self.lesson, &earlier, &submission.answers, &mut verdict);
            open(&self.lesson, &mut verdict);
            self.kept.push((submission, verdict.clone()));
            verdict
        }

        fn pull(&mut self, text: &str) -> crate::QuestionVerdict {
            let verdict = self.hand_in(answering([("pull", number(text))]));
            verdict.questions.into_iter().find(|q| q.id == "pull").unwrap()
        }
    }

    fn number(text: &str) -> Answer {
        Answer { value: Some(TypedValue::Text(text.to_owned())), ..Answer::default() }
    }

    fn answering<const N: usize>(answers: [(&str, Answer); N]) -> Submission {
        let answers = answers.into_iter().map(|(id, answer)| (id.to_owned(), answer)).collect();
        Submission { answers, ..Submission::default() }
    }

    const THREE: OpensFile = OpensFile { right: true, attempts: Some(3), choices: Some(2) };

    #[test]
    fn empty_and_repeated_submissions_open_nothing() {
        let mut student = Student::new(THREE);
        for _ in 0..10 {
            let verdict = student.hand_in(Submission::default());
            assert!(verdict.questions.iter().all(|q| q.reference_html.is_none()));
        }
        for same in ["19.62", "19.620 N", "=19.62", "2*9.81", "0.01962 kN"] {
            let pull = student.pull(same);
            assert_eq!((pull.standing.unwrap().attempts, pull.reference_html), (1, None), "{same}");
        }
        let unreadable = student.pull("12,,3");
        assert_eq!((unreadable.verdict, unreadable.standing.unwrap().attempts), (Mark::Invalid, 1));
    }

    #[test]
    fn a_question_opens_alone_and_its_points_stay() {
        let mut student = Student::new(THREE);
        assert_eq!(student.pull("19.62").standing.unwrap().left, Some(2));
        assert_eq!(student.pull("9.81").reference_html, None);
        let third = student.hand_in(answering([("pull", number("4.00")), ("speed", number("3.13"))]));
        let opened: Vec<&str> =
            third.questions.iter().filter(|q| q.reference_html.is_some()).map(|q| q.id.as_str()).collect();
        assert_eq!(opened, ["pull"]);
        // 2 kg at 60 degrees: m g / cos(phi).
        assert!(
            third
                .questions
                .iter()
                .any(|q| q.reference_html.as_ref().is_some_and(|h| h.starts_with("<p>39.24 N</p>")))
        );
        // Copied back it is right, and earns nothing.
        let copied = student.pull("39.24");
        assert_eq!((copied.verdict, copied.earned, copied.standing.unwrap().attempts), (Mark::Right, 0.0, 3));
        let whole = student.hand_in(reference_submission(&student.lesson));
        assert_eq!(whole.earned, whole.possible - 2.0);
    }

    #[test]
    fn a_right_answer_opens_its_question_and_keeps_its_points() {
        let mut student = Student::new(THREE);
        let right = student.pull("39.24");
        assert!(right.standing.unwrap().open && right.earned == 2.0 && right.reference_html.is_some());
        assert_eq!(student.pull("1.00").earned, 2.0);
        let mut never = Student::new(OpensFile::default());
        assert_eq!(never.pull("39.24").reference_html, None);
    }

    /// A teacher sets otherwise when answers open.
    #[test]
    fn what_was_told_then_decides_whatever_is_set_since() {
        let told = |student: &mut Student| {
            ["19.62", "9.81", "4.00"].map(|wrong| student.pull(wrong).reference_html.is_some())
        };
        let mut honest = Student::new(OpensFile::default());
        assert_eq!(told(&mut honest), [false; 3]);
        honest.lesson.opens = THREE;
        assert_eq!(honest.pull("39.24").earned, 2.0, "nothing was told");
        let mut knows = Student::new(THREE);
        assert_eq!(told(&mut knows), [false, false, true]);
        knows.lesson.opens = OpensFile::default();
        assert_eq!(knows.pull("39.24").earned, 0.0, "it was told");
    }

    #[test]
    fn a_choice_opens_before_one_option_is_left() {
        let mut student = Student::new(OpensFile { choices: Some(6), ..THREE });
        let choose = |id: &str| Answer { choice: Some(id.to_owned()), ..Answer::default() };
        let mut choice = |id| {
            let verdict = student.hand_in(answering([("moment", choose(id))]));
            verdict.questions.into_iter().find(|q| q.id == "moment").unwrap()
        };
        assert_eq!(choice("a").standing.unwrap().left, Some(1));
        assert_eq!(choice("A)").standing.unwrap().left, Some(1));
        assert!(choice("c").standing.unwrap().open);
        assert_eq!((choice("b").verdict, choice("b").earned), (Mark::Right, 0.0));
    }

    #[test]
    fn an_opened_lesson_is_not_passed_by_copying() {
        let mut student = Student::new(THREE);
        let wrong = |k: usize| {
            let mut submission = reference_submission(&student.lesson);
            for (id, answer) in &mut submission.answers {
                let one = format!("1{k}.00");
                *answer = match id.as_str() {
                    "moment" => Answer { choice: Some(["a", "c", "a"][k].to_owned()), ..Answer::default() },
                    "multipliers" => Answer {
                        value: Some(TypedValue::List(vec![TypedValue::Text(one); 3])),
                        ..Answer::default()
                    },
                    "degrees-of-freedom" => number(&format!("1{k}")),
                    _ => number(&one),
                };
            }
            submission
        };
        let tries: Vec<Submission> = (0..3).map(wrong).collect();
        let last = tries.into_iter().map(|t| student.hand_in(t)).last().unwrap();
        assert!(last.questions.iter().all(|q| q.reference_html.is_some()));
        let copied = student.hand_in(reference_submission(&student.lesson));
        assert!(copied.earned == 0.0 && !copied.passed);
    }
}
