//! The symbols of a task as people see them: a word, a colour and a letter each.

use automata::{Alphabet, AlphabetError, Symbol};
use serde::Serialize;
use serde_json::Value;

use super::MAX_SYMBOLS;
use super::reader::{self, Faults, Fields, Malformed};

/// The most characters of a name.
const LONGEST_NAME: usize = 60;

/// A symbol as people see it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SymbolText {
    /// The name in words, automata and the API: `[A-Za-z_0-9]+`.
    pub name: String,
    /// The human word for it; the name where there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub word: Option<String>,
    /// The colour of its tiles and chips.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour: Option<Colour>,
    /// The letter on its tiles, and in the map of a grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub letter: Option<char>,
}

impl SymbolText {
    /// The symbol of this name, and nothing else.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// What people read.
    pub fn text(&self) -> &str {
        self.word.as_deref().unwrap_or(&self.name)
    }

    /// What stands for it in the map of a grid: its letter, or else a name of one
    /// character.
    pub fn mark(&self) -> Option<char> {
        let mut name = self.name.chars();
        let only = name.next().filter(|_| name.next().is_none());
        self.letter.or(only)
    }
}

/// A colour, as `#rrggbb` in lower case.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Colour(String);

/// Names of colours and what CSS means by them.
const COLOURS: [(&str, &str); 24] = [
    ("black", "#000000"),
    ("blue", "#0000ff"),
    ("brown", "#a52a2a"),
    ("coral", "#ff7f50"),
    ("crimson", "#dc143c"),
    ("cyan", "#00ffff"),
    ("gold", "#ffd700"),
    ("gray", "#808080"),
    ("green", "#008000"),
    ("indigo", "#4b0082"),
    ("lime", "#00ff00"),
    ("magenta", "#ff00ff"),
    ("navy", "#000080"),
    ("olive", "#808000"),
    ("orange", "#ffa500"),
    ("pink", "#ffc0cb"),
    ("purple", "#800080"),
    ("red", "#ff0000"),
    ("sienna", "#a0522d"),
    ("silver", "#c0c0c0"),
    ("skyblue", "#87ceeb"),
    ("teal", "#008080"),
    ("white", "#ffffff"),
    ("yellow", "#ffff00"),
];

impl Colour {
    /// The colour of this text: `#rrggbb`, or one of a few names.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.to_ascii_lowercase();
        if let Some(digits) = text.strip_prefix('#') {
            let is_hex = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
            return is_hex.then_some(Self(text));
        }
        let named = COLOURS.iter().find(|(name, _)| *name == text);
        named.map(|(_, hex)| Self((*hex).to_owned()))
    }

    /// As `#rrggbb`.
    pub fn hex(&self) -> &str {
        &self.0
    }
}

/// What stands for each symbol in the map of a grid.
pub(super) fn marks(symbols: &[SymbolText]) -> impl Iterator<Item = (char, Symbol)> {
    let numbered = symbols.iter().enumerate();
    numbered.filter_map(|(i, symbol)| Some((symbol.mark()?, Symbol::new(i))))
}

/// The alphabet under `symbols`, and the colours under `colours`.
///
/// None, and at least one fault is kept, if they make no alphabet.
pub(super) fn read(
    fields: &Fields<'_>,
    faults: &mut Faults,
) -> Option<(Vec<SymbolText>, Alphabet)> {
    let list = faults.keep(fields.required_list(
        "symbols",
        "give the names of the symbols, as in `[\"a\", \"b\"]`",
    ))?;
    let read = (list.iter().enumerate())
        .filter_map(|(i, symbol)| read_symbol(symbol, &format!("symbols[{i}]"), faults));
    let mut symbols: Vec<SymbolText> = read.collect();
    if symbols.len() < list.len() {
        return None;
    }
    let alphabet = faults.keep(alphabet(&symbols))?;
    read_colours(fields, &mut symbols, faults);
    for (place, symbol) in symbols.iter().enumerate() {
        let same = |other: &SymbolText| other.letter.is_some() && other.letter == symbol.letter;
        if let Some(first) = symbols[..place].iter().position(same) {
            faults.0.push(Malformed::new(
                format!("symbols[{place}].letter"),
                format!(
                    "`{}` is also the letter of `{}`: give every symbol its own",
                    symbol.letter.unwrap_or_default(),
                    symbols[first].name
                ),
            ));
        }
    }
    Some((symbols, alphabet))
}

fn read_symbol(value: &Value, path: &str, faults: &mut Faults) -> Option<SymbolText> {
    if value.is_string() {
        // A log has it as the name of an object, and is to be read again.
        let name = faults.keep(reader::line(value, path, LONGEST_NAME))?;
        return Some(SymbolText::named(name.unwrap_or_default()));
    }
    let fields = faults.keep(Fields::of(value, path).map_err(|_| {
        Malformed::new(
            path,
            "give a symbol as its name, or as `{\"name\": \"b\", \"word\": \"water\"}`",
        )
    }))?;
    faults
        .0
        .extend(fields.unknown(&["name", "word", "colour", "letter"]));
    let Some(name) = faults.keep(fields.text("name", LONGEST_NAME))? else {
        faults.0.push(Malformed::new(
            path,
            "this symbol has no `name`: give it one",
        ));
        return None;
    };
    let colour = faults.keep(fields.text("colour", 60)).flatten();
    let colour = colour.and_then(|text| faults.keep(read_colour(&text, &fields.path_of("colour"))));
    Some(SymbolText {
        name,
        word: faults.keep(fields.text("word", 60)).flatten(),
        colour,
        letter: faults.keep(read_letter(&fields)).flatten(),
    })
}

fn read_colour(text: &str, path: &str) -> Result<Colour, Malformed> {
    Colour::parse(text).ok_or_else(|| {
        let names: Vec<&str> = COLOURS.iter().map(|(name, _)| *name).collect();
        Malformed::new(
            path,
            format!(
                "`{text}` is no colour that is known here: write it as `#rrggbb`, or name one of {}",
                names.join(", ")
            ),
        )
    })
}

fn read_letter(fields: &Fields<'_>) -> Result<Option<char>, Malformed> {
    let Some(text) = fields.text("letter", 60)? else {
        return Ok(None);
    };
    let mut chars = text.chars();
    match (chars.next(), chars.next()) {
        (Some(letter), None) => Ok(Some(letter)),
        _ => Err(Malformed::new(
            fields.path_of("letter"),
            format!("`{text}` is more than a letter: give one character"),
        )),
    }
}

/// Colours by symbol, for those who like them in one place.
fn read_colours(fields: &Fields<'_>, symbols: &mut [SymbolText], faults: &mut Faults) {
    let Some(table) = fields.get("colours") else {
        return;
    };
    let Some(colours) = faults.keep(Fields::of(table, "colours")) else {
        return;
    };
    for (name, _) in colours.entries() {
        let path = colours.path_of(name);
        let Some(symbol) = symbols.iter_mut().find(|symbol| symbol.name == name) else {
            faults.0.push(Malformed::new(
                path,
                format!("this colour has no symbol: there is no `{name}` among `symbols`, add it or leave the colour out"),
            ));
            continue;
        };
        let Some(Some(text)) = faults.keep(colours.text(name, 60)) else {
            continue;
        };
        if symbol.colour.is_some() {
            faults.0.push(Malformed::new(
                path,
                format!("`{name}` has a colour among `symbols` already: keep one of the two"),
            ));
        } else {
            symbol.colour = faults.keep(read_colour(&text, &path));
        }
    }
}

/// The alphabet of these symbols' names.
pub(super) fn alphabet(symbols: &[SymbolText]) -> Result<Alphabet, Malformed> {
    if symbols.len() > MAX_SYMBOLS {
        return Err(Malformed::new(
            "symbols",
            format!(
                "there are {} symbols: at most {MAX_SYMBOLS} can be taught",
                symbols.len()
            ),
        ));
    }
    Alphabet::new(symbols.iter().map(|symbol| symbol.name.as_str())).map_err(|error| {
        let path = match &error {
            AlphabetError::BadName { position, .. } => format!("symbols[{position}]"),
            AlphabetError::Duplicate { second, .. } => format!("symbols[{second}]"),
            AlphabetError::Empty | AlphabetError::TooLarge(_) => "symbols".to_owned(),
        };
        Malformed::new(path, error.to_string())
    })
}
