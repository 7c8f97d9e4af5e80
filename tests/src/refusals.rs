//! Catalogues of refusals: each variant of an error enum is met by a case, and its text is one that was read.

use crate::reviewed::{reviewed, settled};
use std::collections::BTreeSet;
use std::fmt::{Display, Write as _};

/// The variants of an error enum, from [`variants!`](crate::variants).
pub struct Variants<E> {
    /// Name of the enum.
    pub error: &'static str,
    /// Names of all of its variants.
    pub all: &'static [&'static str],
    /// The name of the variant that an error is.
    pub of: fn(&E) -> &'static str,
}

/// The variants of an error enum by their names. A variant that the list lacks does not compile.
///
/// `variants!(UrdfError: TooLong, Xml, Wrong, Unknown)`
#[macro_export]
macro_rules! variants {
    ($error:ident: $($variant:ident),+ $(,)?) => {
        $crate::refusals::Variants {
            error: stringify!($error),
            all: &[$(stringify!($variant)),+],
            of: |error| match error {
                $($error::$variant { .. } => stringify!($variant),)+
            },
        }
    };
}

/// The refusals of one error enum.
pub struct Refusals<E> {
    variants: Variants<E>,
    met: BTreeSet<&'static str>,
    text: String,
}

impl<E: Display> Refusals<E> {
    /// None yet.
    pub fn new(variants: Variants<E>) -> Self {
        Self { variants, met: BTreeSet::new(), text: String::new() }
    }

    /// One more: what was tried, the error, its stable code, its place in the scene, and what to try.
    pub fn meet(&mut self, tried: &str, error: &E, code: &str, pointer: Option<&str>, hint: &str) {
        let variant = (self.variants.of)(error);
        self.met.insert(variant);
        let _ = writeln!(self.text, "{}::{variant}: {tried}\n  {error} [{code}]", self.variants.error);
        if let Some(pointer) = pointer {
            let _ = writeln!(self.text, "  at {pointer}");
        }
        if !hint.is_empty() {
            let _ = writeln!(self.text, "  try: {hint}");
        }
        self.text.push('\n');
    }

    /// All texts.
    ///
    /// # Panics
    /// If a variant was met by no case.
    pub fn text(self) -> String {
        let missing: Vec<_> = self.variants.all.iter().filter(|name| !self.met.contains(*name)).collect();
        assert!(missing.is_empty(), "{}: no case meets {missing:?}; add one", self.variants.error);
        settled(&self.text)
    }
}

/// Holds the texts of several enums against those that are kept under that name.
pub fn all_reviewed(name: &str, texts: impl IntoIterator<Item = String>) {
    reviewed(name, texts.into_iter().collect::<String>().trim_end());
}
