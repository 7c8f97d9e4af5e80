//! From an author's Markdown and SVG to HTML that is safe to put into a page.

pub mod figure;
pub mod html;
pub mod markdown;
