//! Reads the fields of objects from outside, JSON or TOML, and says by path what
//! is wrong with them.

use serde_json::{Map, Value};

/// Something that is wrong with what came from outside.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{message}", if path.is_empty() { String::new() } else { format!("{path}: ") })]
pub struct Malformed {
    /// Where: a JSON path such as `symbols[2].name`; empty for the whole.
    pub path: String,
    /// What is wrong, and what to do.
    pub message: String,
}

impl Malformed {
    /// This message about what stands at `path`.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            message: message.into(),
        }
    }

    /// The same, seen from the object that holds this one under `key`.
    #[must_use]
    pub fn under(self, key: &str) -> Self {
        let path = match self.path.as_str() {
            "" => key.to_owned(),
            path if path.starts_with('[') => format!("{key}{path}"),
            path => format!("{key}.{path}"),
        };
        Self { path, ..self }
    }
}

/// The faults found so far, where reading goes on after one.
#[derive(Debug, Default)]
pub(super) struct Faults(pub(super) Vec<Malformed>);

impl Faults {
    /// What was read; none, and the fault is kept, where it could not be.
    pub(super) fn keep<T>(&mut self, read: Result<T, Malformed>) -> Option<T> {
        read.map_err(|fault| self.0.push(fault)).ok()
    }
}

/// The fields of one object.
pub struct Fields<'a> {
    map: &'a Map<String, Value>,
    path: &'a str,
}

impl<'a> Fields<'a> {
    /// The fields of `value`, which stands at `path`.
    ///
    /// # Errors
    ///
    /// If it is not an object.
    pub fn of(value: &'a Value, path: &'a str) -> Result<Self, Malformed> {
        match value.as_object() {
            Some(map) => Ok(Self { map, path }),
            None => Err(Malformed::new(path, "give an object (in TOML a table)")),
        }
    }

    /// Checks that there are no other keys than these.
    ///
    /// # Errors
    ///
    /// Names the first unknown key and the known ones.
    pub fn only(&self, known: &[&str]) -> Result<(), Malformed> {
        self.unknown(known).next().map_or(Ok(()), Err)
    }

    /// The faults of all keys other than these.
    pub fn unknown(&self, known: &[&str]) -> impl Iterator<Item = Malformed> {
        let foreign = |key: &&String| !known.contains(&key.as_str());
        self.map.keys().filter(foreign).map(|key| {
            Malformed::new(
                self.path_of(key),
                match known {
                    [] => format!("`{key}` is an unknown key: there is nothing to give here"),
                    _ => format!(
                        "`{key}` is an unknown key: the known ones are {}",
                        known.join(", ")
                    ),
                },
            )
        })
    }

    /// The entries, by key.
    pub fn entries(&self) -> impl Iterator<Item = (&'a str, &'a Value)> {
        self.map.iter().map(|(key, value)| (key.as_str(), value))
    }

    /// What stands under `key`; `None` for nothing or `null`.
    pub fn get(&self, key: &str) -> Option<&'a Value> {
        self.map.get(key).filter(|value| !value.is_null())
    }

    /// The array under `key`, empty where there is none.
    ///
    /// # Errors
    ///
    /// If something else stands there.
    pub fn list(&self, key: &str) -> Result<&'a [Value], Malformed> {
        match self.get(key) {
            None => Ok(&[]),
            Some(value) => value
                .as_array()
                .map(Vec::as_slice)
                .ok_or_else(|| Malformed::new(self.path_of(key), "give an array")),
        }
    }

    /// The array under `key`; `hint` says what to do where there is none.
    ///
    /// # Errors
    ///
    /// If there is none, or something else stands there.
    pub fn required_list(&self, key: &str, hint: &str) -> Result<&'a [Value], Malformed> {
        if self.get(key).is_none() {
            return Err(Malformed::new(self.path_of(key), hint));
        }
        self.list(key)
    }

    /// The one-line text under `key`, trimmed; `None` if absent or blank.
    ///
    /// # Errors
    ///
    /// If it is no string, too long, or has control characters.
    pub fn text(&self, key: &str, most: usize) -> Result<Option<String>, Malformed> {
        self.string(key, most, |_| false)
    }

    /// The same for text that may have several lines.
    ///
    /// # Errors
    ///
    /// As for [`Fields::text`].
    pub fn long_text(&self, key: &str, most: usize) -> Result<Option<String>, Malformed> {
        self.string(key, most, |c| matches!(c, '\n' | '\r' | '\t'))
    }

    fn string(
        &self,
        key: &str,
        most: usize,
        allowed: impl Fn(char) -> bool,
    ) -> Result<Option<String>, Malformed> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => string(value, &self.path_of(key), most, allowed),
        }
    }

    /// The whole number under `key`, from `least` to `most`.
    ///
    /// # Errors
    ///
    /// If it is something else or outside these bounds.
    pub fn whole(&self, key: &str, least: usize, most: usize) -> Result<Option<usize>, Malformed> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let number = value.as_u64().and_then(|n| usize::try_from(n).ok());
        match number {
            Some(n) if (least..=most).contains(&n) => Ok(Some(n)),
            _ => Err(Malformed::new(
                self.path_of(key),
                format!("give a whole number between {least} and {most}"),
            )),
        }
    }

    /// The path of what stands under `key`.
    pub fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }
}

/// The one-line text that stands at this path, trimmed; `None` if it is blank.
///
/// # Errors
///
/// As for [`Fields::text`].
pub(super) fn line(value: &Value, path: &str, most: usize) -> Result<Option<String>, Malformed> {
    string(value, path, most, |_| false)
}

fn string(
    value: &Value,
    path: &str,
    most: usize,
    allowed: impl Fn(char) -> bool,
) -> Result<Option<String>, Malformed> {
    let Some(text) = value.as_str() else {
        return Err(Malformed::new(path, "give a string"));
    };
    let text = text.trim();
    let length = text.chars().count();
    if length > most {
        return Err(Malformed::new(
            path,
            format!("this has {length} characters: at most {most} are possible"),
        ));
    }
    if text.chars().any(|c| !allowed(c) && is_disruptive(c)) {
        return Err(Malformed::new(
            path,
            "this has a control character: leave it out",
        ));
    }
    Ok((!text.is_empty()).then(|| text.to_owned()))
}

/// Characters that would break a line or turn the direction of what follows.
pub(crate) fn is_disruptive(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{2028}' | '\u{2029}')
}
