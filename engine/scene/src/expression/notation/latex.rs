//! LaTeX as it is pasted into a field: commands become names and signs, groups become brackets.

/// Commands that only arrange or name a typeface.
const SILENT: &[&str] = &[
    "left",
    "right",
    "mathrm",
    "mathbf",
    "mathit",
    "text",
    "textrm",
    "rm",
    "operatorname",
    "vec",
    "boldsymbol",
    "displaystyle",
    "big",
    "Big",
    "bigl",
    "bigr",
    "mathsf",
    "textbf",
    "textit",
    "mathnormal",
    "SI",
    "qty",
    "unit",
    "si",
    "hat",
    "num",
];
/// Commands that are a sign.
const SIGNS: &[(&str, &str)] = &[
    ("cdot", "*"),
    ("times", "*"),
    ("ast", "*"),
    ("div", "/"),
    ("approx", "\u{2248}"),
    ("pm", "\u{b1}"),
    ("quad", " "),
    ("qquad", " "),
    ("varphi", " phi "),
    ("vartheta", " theta "),
    ("varepsilon", " epsilon "),
    ("degree", "°"),
    ("circ", "°"),
    ("langle", "<"),
    ("rangle", ">"),
];

/// LaTeX as plain text; what is not known keeps its name.
pub(super) fn plain(text: &str) -> String {
    let chars: Vec<char> = text.chars().filter(|c| *c != '$').collect();
    let mut reader = Reader { chars, at: 0 };
    let out = reader.until(None, 0);
    // 30^\circ
    out.replace("^(°)", "°").replace("^°", "°").replace("^ °", "°")
}

/// Deepest nesting of groups; deeper ones are left as they are.
const MAX_DEPTH: usize = 30;

struct Reader {
    chars: Vec<char>,
    at: usize,
}

impl Reader {
    fn next(&mut self) -> Option<char> {
        let c = self.chars.get(self.at).copied();
        self.at += usize::from(c.is_some());
        c
    }

    fn peek(&self) -> Option<char> {
        self.chars.get(self.at).copied()
    }

    /// Everything up to this closing character, which is taken, or up to the end.
    fn until(&mut self, close: Option<char>, depth: usize) -> String {
        let mut out = String::new();
        while let Some(c) = self.next() {
            if Some(c) == close {
                break;
            }
            match c {
                '\\' => out += &self.command(depth),
                '{' if depth < MAX_DEPTH => {
                    let inner = self.until(Some('}'), depth + 1);
                    // A subscript is part of the name; a typeface or a unit needs no brackets.
                    let bare = out.ends_with(['_', ' ']) || out.is_empty();
                    if bare && !inner.contains(['+', '-']) {
                        out += &inner;
                    } else {
                        out.extend(["(", &inner, ")"]);
                    }
                }
                '~' => out.push(' '),
                _ => out.push(c),
            }
        }
        out
    }

    /// The group `{…}` or the single sign that a command takes.
    fn argument(&mut self, depth: usize) -> String {
        while self.peek() == Some(' ') {
            self.at += 1;
        }
        match self.next() {
            Some('{') if depth < MAX_DEPTH => self.until(Some('}'), depth + 1),
            Some('\\') => self.command(depth + 1),
            Some(c) => c.to_string(),
            None => String::new(),
        }
    }

    fn command(&mut self, depth: usize) -> String {
        let start = self.at;
        while self.peek().is_some_and(|c| c.is_ascii_alphabetic()) {
            self.at += 1;
        }
        if self.at == start {
            return match self.next() {
                Some('\\') => ";".to_owned(),
                Some('%') => "%".to_owned(),
                Some('(' | ')' | '[' | ']') | None => String::new(),
                Some(_) => " ".to_owned(),
            };
        }
        let name: String = self.chars[start..self.at].iter().collect();
        match name.as_str() {
            "frac" | "dfrac" | "tfrac" | "cfrac" => {
                let above = self.argument(depth);
                let below = self.argument(depth);
                // What follows is another factor: \frac{1}{2}3 is no number with the digits of both.
                let times = if self.peek().is_some_and(|c| c.is_ascii_digit()) { "*" } else { "" };
                format!("(({above})/({below})){times}")
            }
            "sqrt" => {
                let third = self.peek() == Some('[') && self.chars.get(self.at + 1) == Some(&'3');
                if self.peek() == Some('[') {
                    self.next();
                    self.until(Some(']'), depth + 1);
                }
                format!("{}({})", if third { "cbrt" } else { "sqrt" }, self.argument(depth))
            }
            "begin" => {
                self.argument(depth);
                "[".to_owned()
            }
            "end" => {
                self.argument(depth);
                "]".to_owned()
            }
            name if SILENT.contains(&name) => " ".to_owned(),
            name => match SIGNS.iter().find(|(command, _)| *command == name) {
                Some((_, sign)) => (*sign).to_owned(),
                None => format!(" {name} "),
            },
        }
    }
}
