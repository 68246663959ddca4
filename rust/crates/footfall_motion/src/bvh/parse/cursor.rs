//! Place in the text of a BVH file, and the words there.

use crate::bvh::BvhError;
use glam::Vec3;

/// A place in the text.
pub(super) struct Cursor<'a> {
    pub(super) text: &'a str,
    pub(super) at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Skips blanks, line ends and lines that start with `#`.
    pub(super) fn skip_space(&mut self) {
        loop {
            let trimmed = self
                .rest()
                .trim_start_matches(|c: char| c.is_whitespace() || c == '\0');
            self.at = self.text.len() - trimmed.len();
            if !trimmed.starts_with('#') {
                return;
            }
            self.at += trimmed.find(['\n', '\r']).unwrap_or(trimmed.len());
        }
    }

    /// Skips blanks within the line.
    pub(super) fn skip_blanks(&mut self) {
        let trimmed = self
            .rest()
            .trim_start_matches(|c: char| c.is_whitespace() && c != '\n' && c != '\r');
        self.at = self.text.len() - trimmed.len();
    }

    /// The word at the cursor: up to a blank, a colon or a brace; a brace or a colon is a word by itself.
    pub(super) fn peek_word(&self) -> &'a str {
        let rest = self.rest();
        if rest.starts_with(['{', '}', ':']) {
            return &rest[..1];
        }
        let end = rest
            .find(|c: char| c.is_whitespace() || matches!(c, '{' | '}' | ':'))
            .unwrap_or(rest.len());
        &rest[..end]
    }

    pub(super) fn error_at(&self, at: usize, expected: impl Into<String>) -> BvhError {
        let before = &self.text[..at];
        let line = before.matches('\n').count() + 1;
        let column = before[before.rfind('\n').map_or(0, |n| n + 1)..]
            .chars()
            .count()
            + 1;
        let rest = &self.text[at..];
        let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
        let found = if rest.trim().is_empty() {
            "the end of the file".to_owned()
        } else if end == 0 {
            "the end of the line".to_owned()
        } else {
            let mut word: String = rest[..end].chars().take(40).collect();
            if word.len() < end {
                word.push('…');
            }
            format!("\"{word}\"")
        };
        BvhError::Syntax {
            line,
            column,
            expected: expected.into(),
            found,
        }
    }

    pub(super) fn error(&self, expected: impl Into<String>) -> BvhError {
        self.error_at(self.at, expected)
    }

    pub(super) fn take_keyword(&mut self, keyword: &str) -> bool {
        self.skip_space();
        let found = self.peek_word().eq_ignore_ascii_case(keyword);
        if found {
            self.at += keyword.len();
        }
        found
    }

    pub(super) fn keyword(&mut self, keyword: &str) -> Result<(), BvhError> {
        if self.take_keyword(keyword) {
            Ok(())
        } else {
            Err(self.error(format!("\"{keyword}\"")))
        }
    }

    /// The rest of the line up to a brace, without blanks around it.
    pub(super) fn rest_of_line(&mut self) -> &'a str {
        let rest = self.rest();
        let end = rest.find(['\n', '\r', '{', '}']).unwrap_or(rest.len());
        self.at += end;
        rest[..end].trim()
    }

    pub(super) fn finite(&mut self, expected: &str) -> Result<f64, BvhError> {
        let word = self.peek_word();
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.at += word.len();
                Ok(value)
            }
            _ => Err(self.error(expected)),
        }
    }

    pub(super) fn vector(&mut self) -> Result<Vec3, BvhError> {
        let mut values = [0.0_f32; 3];
        for value in &mut values {
            self.skip_space();
            let start = self.at;
            *value = self.finite("three finite numbers after OFFSET")? as f32;
            if !value.is_finite() {
                return Err(self.error_at(start, "a number that fits single precision"));
            }
        }
        Ok(Vec3::from_array(values))
    }
}
