//! Starter kits of implement questions: programs that read the states and write the answer, without the equations.

use std::fmt;
use std::str::FromStr;

use super::instances::task;
use crate::exercise::Implement;
use crate::files::EquationPart;
use crate::lesson::Lesson;

/// A language for which there is a starter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// Python 3, no packages.
    Python,
    /// MATLAB from R2016b, Octave from 7.
    Octave,
    /// Julia with the package JSON.
    Julia,
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Python, Self::Octave, Self::Julia];

    /// Name of the starter's file.
    pub fn file(self) -> &'static str {
        match self {
            Self::Python => "starter.py",
            Self::Octave => "starter.m",
            Self::Julia => "starter.jl",
        }
    }

    fn template(self) -> &'static str {
        match self {
            Self::Python => include_str!("../../starters/starter.py"),
            Self::Octave => include_str!("../../starters/starter.m"),
            Self::Julia => include_str!("../../starters/starter.jl"),
        }
    }

    /// An answer of zeros, to be replaced by the student.
    fn returns(self, task: &Implement) -> String {
        let entry = |part: EquationPart| {
            let key = part.key();
            let (rows, columns) = match part {
                EquationPart::Phi | EquationPart::Gamma => ("m", ""),
                EquationPart::Jacobian => ("m", "n"),
                EquationPart::Mass => ("n", "n"),
                EquationPart::Acceleration => ("n", ""),
            };
            match (self, columns) {
                (Self::Python, "") => format!("    answer[\"{key}\"] = [0.0] * {rows}"),
                (Self::Python, _) => {
                    format!("    answer[\"{key}\"] = [[0.0] * {columns} for _ in range({rows})]")
                }
                (Self::Octave, "") => format!("  answer.{key} = zeros({rows}, 1);"),
                (Self::Octave, _) => format!("  answer.{key} = zeros({rows}, {columns});"),
                (Self::Julia, "") => format!("    answer[\"{key}\"] = zeros({rows})"),
                (Self::Julia, _) => format!("    answer[\"{key}\"] = zeros({rows}, {columns})"),
            }
        };
        let head = match self {
            Self::Python => "    answer = {}",
            Self::Octave => "  answer = struct();",
            Self::Julia => "    answer = Dict{String,Any}()",
        };
        let lines = task.asks.iter().map(|part| entry(*part));
        std::iter::once(head.to_owned()).chain(lines).collect::<Vec<_>>().join("\n")
    }
}

impl fmt::Display for Language {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Python => "python",
            Self::Octave => "octave",
            Self::Julia => "julia",
        })
    }
}

/// There is no starter in this language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("there are starters in python, octave (the same as matlab) and julia")]
pub struct UnknownLanguage;

impl FromStr for Language {
    type Err = UnknownLanguage;

    fn from_str(word: &str) -> Result<Self, UnknownLanguage> {
        match word {
            "python" => Ok(Self::Python),
            "octave" | "matlab" => Ok(Self::Octave),
            "julia" => Ok(Self::Julia),
            _ => Err(UnknownLanguage),
        }
    }
}

impl Lesson {
    /// The starter of an implement question; `None` if the question is of another kind.
    pub fn starter(&self, question: &str, language: Language) -> Option<String> {
        let task = task(self, question)?;
        let text = language.template().replace("{{lesson}}", &self.slug).replace("{{question}}", question);
        Some(text.replace("{{returns}}", &language.returns(task)))
    }
}
