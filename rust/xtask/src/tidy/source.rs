//! Rust sources without what is not code: comments, what strings hold, and tests.

use std::path::Path;

/// Returns true for a file with this extension.
pub(super) fn is_a(name: &str, extension: &str) -> bool {
    Path::new(name)
        .extension()
        .is_some_and(|own| own == extension)
}

/// The text with comments and the insides of strings and characters blanked; lines stay where they are.
pub(super) fn code_only(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut code = bytes.to_vec();
    let mut at = 0;
    while at < bytes.len() {
        let (inside, end) = match bytes[at] {
            b'/' if bytes[at..].starts_with(b"//") => (at, line_end(bytes, at)),
            b'/' if bytes[at..].starts_with(b"/*") => (at, comment_end(bytes, at)),
            b'r' if !follows_word(bytes, at) && raw_hashes(bytes, at).is_some() => {
                let hashes = raw_hashes(bytes, at).unwrap_or_default();
                let open = at + hashes + 2;
                (open, raw_end(bytes, open, hashes))
            }
            b'"' => (at + 1, string_end(bytes, at + 1)),
            b'\'' => match character_end(bytes, at) {
                Some(end) => (at + 1, end),
                None => (at + 1, at + 1),
            },
            _ => (at + 1, at + 1),
        };
        let end = end.min(bytes.len());
        for byte in code[inside.min(end)..end]
            .iter_mut()
            .filter(|byte| **byte != b'\n')
        {
            *byte = b' ';
        }
        // The closing quote is not looked at again.
        let closing = usize::from(inside > at && end > inside || bytes[at] == b'"');
        at = end + closing;
    }
    String::from_utf8_lossy(&code).into_owned()
}

fn follows_word(bytes: &[u8], at: usize) -> bool {
    at > 0
        && (bytes[at - 1].is_ascii_alphanumeric() && bytes[at - 1] != b'b' || bytes[at - 1] == b'_')
}

fn line_end(bytes: &[u8], at: usize) -> usize {
    bytes[at..]
        .iter()
        .position(|&byte| byte == b'\n')
        .map_or(bytes.len(), |length| at + length)
}

fn comment_end(bytes: &[u8], mut at: usize) -> usize {
    let mut depth = 0_usize;
    while at < bytes.len() {
        if bytes[at..].starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if bytes[at..].starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    at
}

/// Number of `#` of a raw string that starts with the `r` at this place.
fn raw_hashes(bytes: &[u8], at: usize) -> Option<usize> {
    let hashes = bytes[at + 1..]
        .iter()
        .take_while(|&&byte| byte == b'#')
        .count();
    (bytes.get(at + 1 + hashes) == Some(&b'"')).then_some(hashes)
}

fn raw_end(bytes: &[u8], open: usize, hashes: usize) -> usize {
    let mut close = vec![b'"'];
    close.resize(hashes + 1, b'#');
    bytes[open..]
        .windows(close.len())
        .position(|window| window == close)
        .map_or(bytes.len(), |length| open + length)
}

fn string_end(bytes: &[u8], mut at: usize) -> usize {
    while at < bytes.len() && bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    at
}

/// The closing quote of a character, or `None` for a lifetime.
fn character_end(bytes: &[u8], at: usize) -> Option<usize> {
    if bytes.get(at + 1) == Some(&b'\\') {
        let after = bytes.get(at + 3..)?;
        return after
            .iter()
            .position(|&byte| byte == b'\'')
            .map(|length| at + 3 + length);
    }
    // A character is up to four bytes long; a lifetime has no closing quote there.
    let first = std::str::from_utf8(&bytes[at + 1..bytes.len().min(at + 5)])
        .or_else(|error| std::str::from_utf8(&bytes[at + 1..at + 1 + error.valid_up_to()]))
        .ok()?;
    let end = at + 1 + first.chars().next()?.len_utf8();
    (bytes.get(end) == Some(&b'\'')).then_some(end)
}

/// Code without the items that are compiled for tests alone.
pub(super) fn without_tests(code: &str) -> String {
    let mut rest = code.as_bytes().to_vec();
    let mut from = 0;
    while let Some(found) = code[from..]
        .find("#[cfg(test)]")
        .map(|length| from + length)
    {
        let end = item_end(code.as_bytes(), found);
        for byte in rest[found..end].iter_mut().filter(|byte| **byte != b'\n') {
            *byte = b' ';
        }
        from = end;
    }
    String::from_utf8_lossy(&rest).into_owned()
}

/// The end of the item that an attribute belongs to: its closing brace, or a semicolon outside all brackets.
fn item_end(code: &[u8], from: usize) -> usize {
    let mut depth = 0_i32;
    for (offset, byte) in code[from..].iter().enumerate() {
        match byte {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => {
                depth -= 1;
                if depth == 0 && *byte == b'}' {
                    return from + offset + 1;
                }
            }
            b';' if depth == 0 => return from + offset + 1,
            _ => {}
        }
    }
    code.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_strings_are_blank_and_lines_stay() {
        let text = "let a = \"todo!()\"; // todo!()\n/* todo!() /* nested */\n */ let b = 'x';\nlet c = r#\"todo!(\"x\")\"#; run();\n";
        let code = code_only(text);
        assert!(!code.contains("todo"), "{code}");
        assert!(
            code.contains("let b =") && code.contains("run();"),
            "{code}"
        );
        assert_eq!(code.lines().count(), text.lines().count());
    }

    #[test]
    fn quotes_and_lifetimes_do_not_swallow_code() {
        for text in [
            "fn f<'a>(x: &'a str) -> &'a str { todo!() }",
            "let q = '\"'; todo!()",
            "let q = '\\''; todo!()",
            "let q = b'\\\\'; let s = \"a\\\"b\"; todo!()",
            "let s = \"\"; todo!()",
            "let p = '…'; todo!()",
            "let r = br\"x\\\"; todo!()",
        ] {
            assert!(
                code_only(text).contains("todo!()"),
                "{text}: {}",
                code_only(text)
            );
        }
    }

    #[test]
    fn tests_are_cut_out_and_nothing_else() {
        let code = "use a;\n#[cfg(test)]\nmod tests {\n fn f() { if x { println!() } }\n}\nfn g() { run() }\n#[cfg(test)]\nmod more;\nfn h() {}\n";
        let rest = without_tests(code);
        assert!(
            !rest.contains("println") && !rest.contains("more"),
            "{rest}"
        );
        assert!(
            rest.contains("fn g()") && rest.contains("fn h()") && rest.contains("use a;"),
            "{rest}"
        );
        assert_eq!(rest.lines().count(), code.lines().count());
    }
}
