//! Reads which paths of its own crate a Rust source uses.

use super::Name;

/// Splits Rust source into words, `::` and single other characters. Comments are left out, a text or a
/// character becomes `"`, a lifetime loses its apostrophe.
pub(crate) fn tokens(source: &str) -> Vec<&str> {
    let bytes = source.as_bytes();
    let is_word = |b: u8| b.is_ascii_alphanumeric() || b == b'_' || b >= 0x80;
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &source[at..];
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("/*") {
            at += block_comment(rest);
        } else if let Some(length) = text(rest) {
            found.push("\"");
            at += length;
        } else if bytes[at] == b'\'' {
            at += 1; // A lifetime; its name is read as a word.
        } else if is_word(bytes[at]) {
            let length = rest.bytes().take_while(|&b| is_word(b)).count();
            found.push(&rest[..length]);
            at += length;
        } else {
            let length = if rest.starts_with("::") { 2 } else { 1 };
            if !bytes[at].is_ascii_whitespace() {
                found.push(&rest[..length]);
            }
            at += length;
        }
    }
    found
}

/// Length of the comment, which may contain others, that `rest` begins with.
fn block_comment(rest: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        match &rest.as_bytes()[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// Length of the text or character that `rest` begins with.
fn text(rest: &str) -> Option<usize> {
    let prefix = ["br", "cr", "b", "c", "r", ""].into_iter().find(|prefix| {
        rest.strip_prefix(prefix)
            .is_some_and(|r| r.starts_with(['"', '\'', '#']))
    })?;
    let body = &rest[prefix.len()..];
    if prefix.ends_with('r') {
        let hashes = body.bytes().take_while(|&b| b == b'#').count();
        let end = format!("\"{}", "#".repeat(hashes));
        let inside = body[hashes..].strip_prefix('"')?; // Otherwise a raw identifier.
        let length = inside.find(&end).map_or(inside.len(), |i| i + end.len());
        return Some(prefix.len() + hashes + 1 + length);
    }
    let quote = body.chars().next().filter(|&c| c != '#')?;
    if quote == '\'' {
        // A character has one sign, escaped or not; anything else is a lifetime.
        let mut inside = body.chars().skip(1);
        let first = inside.next()?;
        if first != '\\' && inside.next() != Some('\'') {
            return None;
        }
    }
    let mut escaped = false;
    for (i, c) in body.char_indices().skip(1) {
        if c == quote && !escaped {
            return Some(prefix.len() + i + 1);
        }
        escaped = c == '\\' && !escaped;
    }
    Some(rest.len())
}

/// What one file uses.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Uses {
    /// Absolute paths without `crate`, each with the module that uses it.
    pub(crate) paths: Vec<(Name, Name)>,
    /// Modules in other files that only tests see.
    pub(crate) test_modules: Vec<Name>,
}

struct Reader<'a> {
    tokens: Vec<&'a str>,
    at: usize,
    /// The module of the file.
    file: Name,
    /// The modules in other files that the file declares.
    children: Vec<&'a str>,
    /// The module that the reader is in.
    module: Name,
    uses: Uses,
}

/// Collects what `source`, the file of `module`, uses outside of tests.
pub(crate) fn uses(module: &[String], source: &str) -> Uses {
    let tokens = tokens(source);
    let children = tokens.windows(3).filter(|w| w[0] == "mod" && w[2] == ";");
    let mut reader = Reader {
        children: children.map(|w| w[1]).collect(),
        tokens,
        at: 0,
        file: module.to_vec(),
        module: module.to_vec(),
        uses: Uses::default(),
    };
    reader.read();
    reader.uses
}

impl<'a> Reader<'a> {
    fn peek(&self, ahead: usize) -> &'a str {
        self.tokens.get(self.at + ahead).copied().unwrap_or("")
    }

    fn read(&mut self) {
        let mut depth = 0;
        // Depths at which inline modules end.
        let mut modules = Vec::new();
        while self.at < self.tokens.len() {
            match self.peek(0) {
                "#" if self.peek(1) == "[" => self.attribute(),
                "mod" if self.peek(2) == "{" => {
                    self.module.push(self.peek(1).to_owned());
                    modules.push(depth);
                    depth += 1;
                    self.at += 3;
                }
                "{" => {
                    depth += 1;
                    self.at += 1;
                }
                "}" => {
                    depth -= 1;
                    if modules.last() == Some(&depth) {
                        modules.pop();
                        self.module.pop();
                    }
                    self.at += 1;
                }
                // `use<'a>` is a bound.
                "use" if self.peek(1) != "<" => {
                    self.at += 1;
                    self.use_tree(&mut Vec::new());
                }
                "crate" | "self" | "super" if self.peek(1) == "::" => {
                    let path = self.path();
                    self.record(&path);
                }
                // What follows `::` belongs to the path before it.
                "::" => self.at += 2,
                word if self.peek(1) == "::" && self.is_child(word) => {
                    let path = self.path();
                    self.record(&path);
                }
                _ => self.at += 1,
            }
        }
    }

    fn is_child(&self, word: &str) -> bool {
        self.module == self.file && self.children.contains(&word)
    }

    /// Passes an attribute and, where it is `cfg(test)`, the item that it stands at.
    fn attribute(&mut self) {
        self.at += 1;
        let content = self.group();
        if content != ["[", "cfg", "(", "test", ")", "]"] {
            return;
        }
        while self.peek(0) == "#" {
            self.at += 1;
            self.group();
        }
        let mut start = self.at;
        if self.tokens.get(start) == Some(&"pub") {
            start += 1;
            if self.tokens.get(start) == Some(&"(") {
                start += self.tokens[start..]
                    .iter()
                    .position(|&t| t == ")")
                    .map_or(0, |i| i + 1);
            }
        }
        let keyword = self.tokens.get(start).copied().unwrap_or("");
        const ITEMS: [&str; 10] = [
            "mod", "fn", "use", "impl", "const", "static", "struct", "enum", "trait", "type",
        ];
        // Statements and fields are not passed: what they name counts.
        if !ITEMS.contains(&keyword) {
            return;
        }
        if keyword == "mod" && self.tokens.get(start + 2) == Some(&";") {
            let mut module = self.module.clone();
            module.push(self.tokens[start + 1].to_owned());
            self.uses.test_modules.push(module);
        }
        while self.at < self.tokens.len() && !["{", ";"].contains(&self.peek(0)) {
            if ["(", "["].contains(&self.peek(0)) {
                self.group();
            } else {
                self.at += 1;
            }
        }
        if self.peek(0) == "{" {
            self.group();
        }
    }

    /// Passes the bracketed group that begins here; returns it with its brackets.
    fn group(&mut self) -> &[&'a str] {
        let start = self.at;
        let mut depth = 0;
        while self.at < self.tokens.len() {
            match self.peek(0) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                break;
            }
        }
        &self.tokens[start..self.at]
    }

    /// Reads words with `::` between them.
    fn path(&mut self) -> Name {
        let mut path = Vec::new();
        loop {
            path.push(self.peek(0).to_owned());
            self.at += 1;
            let is_word = |t: &str| t.starts_with(|c: char| c.is_alphanumeric() || c == '_');
            if self.peek(0) != "::" || !is_word(self.peek(1)) {
                return path;
            }
            self.at += 1;
        }
    }

    /// Reads what follows `use` up to the end of the tree; `prefix` is the path that leads there.
    fn use_tree(&mut self, prefix: &mut Name) {
        let length = prefix.len();
        loop {
            match self.peek(0) {
                "{" => {
                    self.at += 1;
                    while !["}", ""].contains(&self.peek(0)) {
                        if self.peek(0) == "," {
                            self.at += 1;
                        } else {
                            self.use_tree(prefix);
                        }
                    }
                    self.at += 1;
                    break;
                }
                "::" => self.at += 1,
                "," | "}" | ";" | "" => {
                    self.record(prefix);
                    break;
                }
                "as" => self.at += 2,
                word => {
                    prefix.push(word.to_owned());
                    self.at += 1;
                }
            }
        }
        prefix.truncate(length);
    }

    /// Enters a path that begins in this crate: at its root, in this module, or in one that this file declares.
    fn record(&mut self, path: &[String]) {
        let mut absolute = self.module.clone();
        let mut rest = path;
        match path.first().map(String::as_str) {
            Some("crate") => {
                absolute.clear();
                rest = &path[1..];
            }
            Some("self" | "super") => {}
            Some(child) if self.is_child(child) => {}
            _ => return,
        }
        while let Some((first, others)) = rest.split_first() {
            match first.as_str() {
                "super" => {
                    absolute.pop();
                }
                "self" => {}
                word => absolute.push(word.to_owned()),
            }
            rest = others;
        }
        self.uses.paths.push((self.module.clone(), absolute));
    }
}
