//! Cuts DOT text into tokens, each with its place, as they are asked for: all of them
//! together would take many times as much memory as the text.

use crate::format::ReadError;

/// A place in the text, both numbers from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) line: usize,
    pub(super) column: usize,
}

impl Place {
    /// An error here.
    pub(super) fn error(self, message: impl Into<String>) -> ReadError {
        ReadError::at(self.line, self.column, message)
    }
}

/// A token of DOT.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Token {
    /// A bare name or number, or a quoted string without its quotes.
    Name { text: String, quoted: bool },
    /// `->`.
    Arrow,
    /// One of `{ } [ ] ; , = :`.
    Mark(char),
    /// The end of the text.
    End,
}

impl Token {
    /// As messages name it.
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Name { text, quoted: true } => format!("\"{text}\""),
            Self::Name { text, .. } => format!("`{text}`"),
            Self::Arrow => "`->`".to_owned(),
            Self::Mark(mark) => format!("`{mark}`"),
            Self::End => "the end of the file".to_owned(),
        }
    }
}

/// The tokens of a text, one after the other; the last one, [`Token::End`], again and
/// again.
pub(super) struct Tokens<'a>(Cursor<'a>);

impl<'a> Tokens<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        Self(Cursor::new(text))
    }

    pub(super) fn next(&mut self) -> Result<(Token, Place), ReadError> {
        self.0.skip_blank()?;
        let place = self.0.place;
        Ok((self.0.token()?, place))
    }
}

struct Cursor<'a> {
    rest: std::iter::Peekable<std::str::Chars<'a>>,
    place: Place,
}

impl<'a> Cursor<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            rest: text.chars().peekable(),
            place: Place { line: 1, column: 1 },
        }
    }

    fn peek(&mut self) -> Option<char> {
        self.rest.peek().copied()
    }

    fn advance(&mut self) -> Option<char> {
        let next = self.rest.next()?;
        if next == '\n' {
            self.place.line += 1;
            self.place.column = 1;
        } else {
            self.place.column += 1;
        }
        Some(next)
    }

    fn skip_line(&mut self) {
        while self.peek().is_some_and(|c| c != '\n') {
            self.advance();
        }
    }

    /// Skips white space and comments: `// …`, `/* … */`, and lines that begin
    /// with `#`.
    fn skip_blank(&mut self) -> Result<(), ReadError> {
        loop {
            let place = self.place;
            match self.peek() {
                Some(c) if c.is_whitespace() => {
                    self.advance();
                }
                Some('#') if place.column == 1 => self.skip_line(),
                Some('/') => {
                    self.advance();
                    match self.advance() {
                        Some('/') => self.skip_line(),
                        Some('*') => self.skip_block(place)?,
                        _ => {
                            return Err(place.error("expected a comment, `// …` or `/* … */`"));
                        }
                    }
                }
                _ => return Ok(()),
            }
        }
    }

    fn skip_block(&mut self, start: Place) -> Result<(), ReadError> {
        let mut star = false;
        while let Some(c) = self.advance() {
            if star && c == '/' {
                return Ok(());
            }
            star = c == '*';
        }
        Err(start.error("this comment does not end: close it with `*/`"))
    }

    fn token(&mut self) -> Result<Token, ReadError> {
        let place = self.place;
        let Some(c) = self.peek() else {
            return Ok(Token::End);
        };
        match c {
            '{' | '}' | '[' | ']' | ';' | ',' | '=' | ':' => {
                self.advance();
                Ok(Token::Mark(c))
            }
            '"' => self.quoted(place),
            '-' => {
                self.advance();
                match self.peek() {
                    Some('>') => {
                        self.advance();
                        Ok(Token::Arrow)
                    }
                    Some('-') => Err(place
                        .error("expected `->`, found `--`: an automaton's edges have a direction")),
                    _ => Ok(self.name(String::from('-'))),
                }
            }
            '<' => {
                Err(place
                    .error("expected a name or a string, found HTML: write the label as \"text\""))
            }
            c if is_name(c) => Ok(self.name(String::new())),
            c => Err(place.error(format!("expected a name, a string or a mark, found `{c}`"))),
        }
    }

    fn name(&mut self, mut text: String) -> Token {
        while let Some(c) = self.peek().filter(|&c| is_name(c)) {
            text.push(c);
            self.advance();
        }
        Token::Name {
            text,
            quoted: false,
        }
    }

    fn quoted(&mut self, start: Place) -> Result<Token, ReadError> {
        self.advance();
        let mut text = String::new();
        while let Some(c) = self.advance() {
            match c {
                '"' => return Ok(Token::Name { text, quoted: true }),
                // DOT knows one escape, of the quote; the others belong to the
                // drawing and stay as they are.
                '\\' if self.peek() == Some('"') => {
                    text.push('"');
                    self.advance();
                }
                c => text.push(c),
            }
        }
        Err(start.error("this string does not end: close it with `\"`"))
    }
}

/// Whether a bare name or number may hold this character.
fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.' || !c.is_ascii() && !c.is_whitespace()
}
