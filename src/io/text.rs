//! Splits text files into lines and tokens, and makes error messages with line numbers.

use crate::error::{Error, ErrorKind, Result};
use std::str::FromStr;

/// The lines of a file. They end in LF, CR LF or CR alone, as the first one does.
#[derive(Clone, Debug)]
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    /// Start of the next line.
    position: usize,
    /// Number of the line last returned, from 1.
    number: usize,
    terminator: u8,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let byte_order_mark: &[u8] = b"\xef\xbb\xbf";
        let position = if bytes.starts_with(byte_order_mark) {
            byte_order_mark.len()
        } else {
            0
        };
        let first_break = bytes.iter().position(|&b| b == b'\n' || b == b'\r');
        let terminator = match first_break {
            Some(k) if bytes[k] == b'\r' && bytes.get(k + 1) != Some(&b'\n') => b'\r',
            _ => b'\n',
        };
        Self {
            bytes,
            position,
            number: 0,
            terminator,
        }
    }

    /// The next line without its terminator, blank or not.
    pub(super) fn next_line(&mut self) -> Option<&'a [u8]> {
        let rest = self
            .bytes
            .get(self.position..)
            .filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&b| b == self.terminator);
        self.position += length.map_or(rest.len(), |length| length + 1);
        self.number += 1;
        let line = &rest[..length.unwrap_or(rest.len())];
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// The next line that is not blank. If `comment_mark` is given, comments are removed first.
    pub(super) fn next_filled(&mut self, comment_mark: Option<u8>) -> Option<&'a [u8]> {
        loop {
            let line = self.next_line()?;
            let end = line
                .iter()
                .position(|&b| Some(b) == comment_mark)
                .unwrap_or(line.len());
            if !line[..end].trim_ascii().is_empty() {
                return Some(&line[..end]);
            }
        }
    }

    /// Offset of the first byte that is not part of a line returned so far.
    pub(super) fn position(&self) -> usize {
        self.position
    }

    /// The bytes after the lines returned so far.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.position..]
    }

    /// Skips `count` bytes that are not lines.
    pub(super) fn skip(&mut self, count: usize) {
        self.position = self.bytes.len().min(self.position + count);
    }

    /// Number of the line last returned, from 1.
    pub(super) fn number(&self) -> usize {
        self.number
    }

    /// A parse error in the line that was returned last.
    pub(super) fn error(&self, message: impl AsRef<str>) -> Error {
        line_error(self.number, message)
    }

    /// A parse error for a file that ends too early.
    pub(super) fn end_error(&self, message: impl AsRef<str>) -> Error {
        parse_error(format!(
            "the file ends after line {}: {}",
            self.number,
            message.as_ref()
        ))
    }

    /// Reads the next of `tokens` as a number.
    pub(super) fn number_from<'t, T: FromStr>(
        &self,
        tokens: &mut impl Iterator<Item = &'t [u8]>,
        what: &str,
    ) -> Result<T> {
        match tokens.next() {
            None => Err(self.error(format!("{what} is missing"))),
            Some(token) => parse_number(token)
                .ok_or_else(|| self.error(format!("{what} cannot be {}", quoted(token)))),
        }
    }

    /// Reads the next three of `tokens` as a position.
    pub(super) fn position_from<'t>(
        &self,
        tokens: &mut impl Iterator<Item = &'t [u8]>,
    ) -> Result<[f64; 3]> {
        let mut point = [0.0; 3];
        for (coordinate, name) in point.iter_mut().zip(["x", "y", "z"]) {
            *coordinate = self.number_from(tokens, name)?;
        }
        Ok(point)
    }
}

pub(super) fn parse_error(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Parse, message)
}

pub(super) fn line_error(number: usize, message: impl AsRef<str>) -> Error {
    parse_error(format!("line {number}: {}", message.as_ref()))
}

/// The tokens of a line: runs of bytes without white space.
pub(super) fn tokens(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace)
        .filter(|token| !token.is_empty())
}

pub(super) fn parse_number<T: FromStr>(token: &[u8]) -> Option<T> {
    std::str::from_utf8(token).ok()?.parse().ok()
}

/// A token for an error message: printable and short.
pub(super) fn quoted(token: &[u8]) -> String {
    const LONGEST: usize = 40;
    let start = &token[..token.len().min(LONGEST)];
    let dots = if start.len() < token.len() { "..." } else { "" };
    format!("\"{}{dots}\"", start.escape_ascii())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_lines(bytes: &[u8]) -> Vec<&[u8]> {
        let mut lines = Lines::new(bytes);
        std::iter::from_fn(|| lines.next_line()).collect()
    }

    #[test]
    fn lines_end_in_any_of_the_three_ways() {
        for text in [
            "a\n\nb c",
            "a\r\n\r\nb c\r\n",
            "a\r\rb c\r",
            "\u{feff}a\n\nb c\n",
        ] {
            assert_eq!(
                all_lines(text.as_bytes()),
                [b"a".as_slice(), b"", b"b c"],
                "{text:?}"
            );
        }
        assert!(all_lines(b"").is_empty());
        assert_eq!(all_lines(b"\n"), [b""]);
    }

    #[test]
    fn filled_lines_are_numbered_as_an_editor_numbers_them() {
        let mut lines = Lines::new(b"\n# x\n a # y\n\t\nb");
        assert_eq!(lines.next_filled(Some(b'#')), Some(b" a ".as_slice()));
        assert_eq!(lines.number(), 3);
        assert_eq!(lines.next_filled(Some(b'#')), Some(b"b".as_slice()));
        assert_eq!(lines.number(), 5);
        assert_eq!(lines.next_filled(None), None);
        assert!(lines.rest().is_empty());
    }

    #[test]
    fn numbers_are_parsed_whole_or_not_at_all() {
        assert_eq!(parse_number::<f64>(b"-1.5e3"), Some(-1500.0));
        assert!(parse_number::<f64>(b"nan").unwrap().is_nan());
        for token in [b"".as_slice(), b"1,5", b"0x10", b"1.0f", b"\xff"] {
            assert_eq!(parse_number::<f64>(token), None, "{token:?}");
        }
        assert_eq!(parse_number::<u8>(b"256"), None);
    }
}
