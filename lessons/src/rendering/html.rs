//! Text inside HTML.

/// Text made safe for the content of HTML elements and for quoted attributes.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            other => out.push(other),
        }
    }
    out
}

/// The words of safe HTML, without its markup: for terminals and for pages that show none.
pub fn words(html: &str) -> String {
    let mut text = String::with_capacity(html.len());
    let mut inside_tag = false;
    // Paragraphs and items of a list end a word, other marks do not.
    for letter in html.replace("</p>", " ").replace("</li>", " ").replace("<br>", " ").chars() {
        match letter {
            '<' => inside_tag = true,
            '>' => inside_tag = false,
            _ if !inside_tag => text.push(letter),
            _ => {}
        }
    }
    let plain = text
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&#39;", "'")
        .replace("&amp;", "&");
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    #[test]
    fn markup_is_left_out_and_signs_are_kept() {
        assert_eq!(
            super::words("<p>g &lt; 10, so\n <em>T</em> &amp; mg.</p><p>No.</p>"),
            "g < 10, so T & mg. No."
        );
    }
}
