//! Where in a JSON text the value of a path stands: readers that check values after
//! they were parsed have lost their places.

/// The byte at which the value of `path`, such as `delta[2][0]` or
/// `symbols[1].name`, begins in this JSON text; or else the innermost value around
/// it that is there.
///
/// The text is JSON already: of one that is not, some place is given.
pub fn locate(text: &str, path: &str) -> usize {
    let mut cursor = Cursor { text, at: 0 };
    cursor.skip_blank();
    let mut found = cursor.at;
    let parts = path.split(['.', '[']).filter(|part| !part.is_empty());
    for part in parts {
        let index = part.strip_suffix(']').and_then(|index| index.parse().ok());
        let there = match index {
            Some(index) => cursor.enter_array(index),
            None => cursor.enter_object(part),
        };
        if !there {
            break;
        }
        found = cursor.at;
    }
    found
}

/// The line of a byte, and its column in bytes, both from 1.
pub(super) fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = &text.as_bytes()[..byte.min(text.len())];
    let line = before.split(|byte| *byte == b'\n').count();
    let column = before
        .iter()
        .rev()
        .take_while(|byte| **byte != b'\n')
        .count()
        + 1;
    (line, column)
}

struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl Cursor<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn skips(&mut self, byte: u8) -> bool {
        let there = self.peek() == Some(byte);
        self.at += usize::from(there);
        there
    }

    fn skip_blank(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    /// Goes to the value under `key` of the object that begins here.
    fn enter_object(&mut self, key: &str) -> bool {
        if !self.skips(b'{') {
            return false;
        }
        loop {
            self.skip_blank();
            let start = self.at;
            if self.peek() != Some(b'"') {
                return false;
            }
            self.skip_string();
            let name = self.text.get(start..self.at).unwrap_or_default();
            let name: Option<String> = serde_json::from_str(name).ok();
            self.skip_blank();
            if !self.skips(b':') {
                return false;
            }
            self.skip_blank();
            if name.as_deref() == Some(key) {
                return true;
            }
            if !self.skip_item() {
                return false;
            }
        }
    }

    /// Goes to an item of the array that begins here.
    fn enter_array(&mut self, index: usize) -> bool {
        if !self.skips(b'[') {
            return false;
        }
        self.skip_blank();
        let is_empty = self.peek() == Some(b']');
        !is_empty && (0..index).all(|_| self.skip_item())
    }

    /// Goes behind this item and its comma; `false` if there is none.
    fn skip_item(&mut self) -> bool {
        let mut depth = 0_usize;
        while let Some(byte) = self.peek() {
            match byte {
                b'"' => {
                    self.skip_string();
                    continue;
                }
                b'[' | b'{' => depth += 1,
                b']' | b'}' if depth == 0 => return false,
                b']' | b'}' => depth -= 1,
                b',' if depth == 0 => {
                    self.at += 1;
                    self.skip_blank();
                    return true;
                }
                _ => {}
            }
            self.at += 1;
        }
        false
    }

    /// Goes behind the string that begins here.
    fn skip_string(&mut self) {
        self.at += 1;
        while let Some(byte) = self.peek() {
            self.at += 1;
            match byte {
                b'"' => return,
                b'\\' => self.at += 1,
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_path_leads_to_its_value() {
        let text =
            " {\"a\": [1, [2, \"]\\\"\"], {\"b.c\": 3}],\n \"\\u0062\" : {\"c\":[]}, \"d\": 4}";
        for (path, rest) in [
            ("", "{\"a\""),
            ("a", "[1"),
            ("a[0]", "1,"),
            ("a[1][0]", "2,"),
            ("a[1][1]", "\"]"),
            ("a[1][2]", "[2"),
            ("a[2]", "{\"b.c"),
            ("a[3]", "[1,"),
            ("b.c", "[]}"),
            ("b.c[0]", "[]}"),
            ("b.x", "{\"c\":"),
            ("d", "4}"),
            ("d[0].e", "4}"),
            ("nowhere", "{\"a\""),
        ] {
            let at = locate(text, path);
            assert!(text[at..].starts_with(rest), "{path}: {}", &text[at..]);
        }
        assert_eq!(place(text, locate(text, "d")), (2, 28));
    }

    #[test]
    fn what_is_no_json_has_some_place() {
        for text in [
            "",
            "{",
            "{\"a",
            "{\"a\\",
            "[1,",
            "{\"ä\\\":",
            "[\"",
            "{\"a\":[,,",
        ] {
            for path in ["a", "[3]", "a[0].b", "a[99999999999999999999]"] {
                assert!(locate(text, path) <= text.len(), "{text} {path}");
            }
        }
    }
}
