//! The right answers in words, shown where they are open.

use crate::answers::diagram::Arrow;
use crate::answers::tolerance::ValueShape;
use crate::exercise::cut::in_words;
use crate::exercise::{QuantityQuestion, Question, QuestionBody};
use crate::rendering::html::escape;
use crate::rendering::markdown::render_short;
use crate::text::plain;

/// The right answer with its source. Work (programs, tables, scenes, settings) has no single right answer.
pub(crate) fn reference(question: &Question) -> Option<String> {
    let answer = match &question.body {
        QuestionBody::Quantity(q) => format!("<p>{}</p>", escape(&written(q))),
        QuestionBody::Choice { options, right } => {
            render_short(&options.iter().find(|o| o.id == *right)?.text)
        }
        QuestionBody::Formula(f) => format!("<p><code>{}</code></p>", escape(&f.reference_text)),
        QuestionBody::Diagram(d) => {
            let line = |arrow: &Arrow| format!("<li>{}</li>", escape(&in_words(arrow, None)));
            format!("<ul>{}</ul>", d.reference.iter().map(line).collect::<String>())
        }
        QuestionBody::Explanation(e) => render_short(&e.example),
        QuestionBody::Implement(_)
        | QuestionBody::Trajectory(_)
        | QuestionBody::Model(_)
        | QuestionBody::Tuning(_) => return None,
    };
    let why = render_short(&question.right);
    Some(format!("{answer}{why}<p>Source: {}</p>", escape(&question.source)))
}

fn written(q: &QuantityQuestion) -> String {
    let list = |values: &[f64]| {
        let values: Vec<String> = values.iter().map(|x| plain(*x)).collect();
        format!("({})", values.join(", "))
    };
    let value = match q.shape {
        ValueShape::Number => q.reference.first().map(|x| plain(*x)).unwrap_or_default(),
        ValueShape::Vector => list(&q.reference),
        ValueShape::Matrix => {
            let rows: Vec<String> = q.reference.chunks(q.size[1].max(1)).map(list).collect();
            format!("rows {}", rows.join(", "))
        }
    };
    format!("{value} {}", q.unit.text()).trim_end().to_owned()
}
