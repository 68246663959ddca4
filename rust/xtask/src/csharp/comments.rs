//! Texts of the class reference as documentation comments of C#.

use super::names::pascal;
use super::reference::Reference;

/// Names that a text may refer to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scope<'a> {
    pub(super) reference: &'a Reference,
    /// The class that the text is about.
    pub(super) class: &'a str,
}

/// A comment's lines without their slashes: the first paragraph as the summary, the others as remarks.
pub(super) fn lines(text: &str, scope: Scope<'_>) -> Vec<String> {
    let text = converted(text, scope);
    let mut paragraphs = text
        .split("\n\n")
        .map(str::trim)
        .filter(|part| !part.is_empty());
    let Some(first) = paragraphs.next() else {
        return Vec::new();
    };
    let mut lines = vec![format!("<summary>{first}</summary>")];
    let rest: Vec<&str> = paragraphs.collect();
    match rest.as_slice() {
        [] => {}
        [one] => lines.push(format!("<remarks>{one}</remarks>")),
        several => {
            lines.push("<remarks>".into());
            lines.extend(several.iter().map(|one| format!("<para>{one}</para>")));
            lines.push("</remarks>".into());
        }
    }
    lines
        .iter()
        .flat_map(|line| line.lines())
        .map(|line| line.trim_end().to_owned())
        .collect()
}

/// The editor's markup as XML; paragraphs are parted by an empty line.
fn converted(text: &str, scope: Scope<'_>) -> String {
    let mut out = String::new();
    let mut left = text;
    while let Some(at) = left.find('[') {
        out.push_str(&escaped(&left[..at]));
        left = &left[at..];
        let Some(end) = left.find(']') else {
            break;
        };
        let (tag, after) = (&left[1..end], &left[end + 1..]);
        let inside = |close: &str| after.split_once(close);
        if tag == "br" {
            out.push('\n');
            left = after;
        } else if tag == "code"
            && let Some((code, rest)) = inside("[/code]")
        {
            out.push_str(&code_span(code, scope));
            left = rest;
        } else if tag.starts_with("codeblock")
            && let Some((code, rest)) = inside("[/codeblock]")
        {
            // An empty line would end the paragraph.
            let code = escaped(code).replace("\n\n", "\n");
            out.extend(["<code>\n", code.trim_matches('\n'), "\n</code>"]);
            left = rest;
        } else if let Some(address) = tag.strip_prefix("url=")
            && let Some((words, rest)) = inside("[/url]")
        {
            let (address, words) = (escaped(address), escaped(words));
            out.extend(["<see href=\"", &address, "\">", &words, "</see>"]);
            left = rest;
        } else if ["b", "/b", "i", "/i"].contains(&tag) {
            out.extend(["<", tag, ">"]);
            left = after;
        } else {
            out.push('[');
            left = &left[1..];
        }
    }
    out + &escaped(left)
}

/// A name that is known as a link, anything else as code.
fn code_span(code: &str, scope: Scope<'_>) -> String {
    let name = code.split('(').next().unwrap_or(code);
    let link = match name.split_once('.') {
        Some((class, member)) => {
            target(scope.reference, class, member).map(|member| format!("{class}.{member}"))
        }
        None if scope.reference.class(name).is_some() => Some(name.to_owned()),
        None => target(scope.reference, scope.class, name),
    };
    match link {
        Some(link) => format!("<see cref=\"{link}\"/>"),
        None => format!("<c>{}</c>", escaped(code)),
    }
}

/// The member of a class, as C# names it.
fn target(reference: &Reference, class: &str, member: &str) -> Option<String> {
    let found = reference.class(class)?;
    let named = [
        found.property_names(),
        found.method_names(),
        found.signal_names(),
    ]
    .concat()
    .contains(&member);
    named.then(|| pascal(member))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
