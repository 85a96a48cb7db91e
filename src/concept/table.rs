//! Finite classes as text: a table of comma-separated values, an atom a row and a
//! concept a column.

use std::collections::BTreeMap;

use super::{ConceptClass as _, FiniteAtom, FiniteClass, FiniteClassError, FiniteConcept};

/// A finite class with the names of its atoms and concepts.
///
/// ```text
/// behaviour,always,polite,never
/// size,1,2,1
/// greets,1,1,0
/// interrupts,1,0,0
/// ```
///
/// The first line names the concepts; its first field says what the atoms are. A
/// line `size`, if there is one, comes second and gives every concept its size
/// (all have size 1 otherwise). Every other line is an atom, simplest first, with
/// `1` under the concepts that contain it and `0` under the others. Fields may be
/// quoted; empty lines and those that begin with `#` say nothing.
#[derive(Clone, Debug)]
pub struct FiniteTable {
    atoms: Vec<String>,
    concepts: Vec<String>,
    class: FiniteClass,
}

/// Why a text is no table.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: {message}")]
pub struct TableError {
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// What is wrong there, and what to do.
    pub message: String,
}

/// A field and where it begins.
struct Field {
    line: usize,
    column: usize,
    text: String,
}

impl Field {
    fn error(&self, message: impl Into<String>) -> TableError {
        TableError {
            line: self.line,
            column: self.column,
            message: message.into(),
        }
    }
}

impl FiniteTable {
    /// Reads a table.
    ///
    /// # Errors
    ///
    /// With the place of what is wrong.
    pub fn read(text: &str) -> Result<Self, TableError> {
        let mut rows = Vec::new();
        for (index, line) in text.lines().enumerate() {
            if !line.trim().is_empty() && !line.starts_with('#') {
                rows.push(fields(index + 1, line)?);
            }
        }
        let mut rows = rows.into_iter().peekable();
        let header = rows.next().ok_or_else(|| TableError {
            line: 1,
            column: 1,
            message: "the table is empty: give a line with the names of the concepts".to_owned(),
        })?;
        if header.len() < 2 {
            return Err(header[0].error(
                "there is no concept: give the names of the concepts after the first comma",
            ));
        }
        let concepts = names(&header[1..], "concept")?;
        let row = |fields: &[Field]| {
            if fields.len() == header.len() {
                return Ok(());
            }
            let at = fields
                .get(header.len())
                .unwrap_or(&fields[fields.len() - 1]);
            Err(at.error(format!(
                "this line has {} fields and the first has {}: give one for every concept",
                fields.len(),
                header.len()
            )))
        };
        let mut sizes = vec![1; concepts.len()];
        if let Some(fields) = rows.next_if(|fields| fields[0].text == "size") {
            row(&fields)?;
            for (size, field) in sizes.iter_mut().zip(&fields[1..]) {
                let read = field.text.parse().ok().filter(|size| *size > 0);
                *size = read.ok_or_else(|| {
                    field.error(format!(
                        "`{}` is no size: give a whole number from 1",
                        field.text
                    ))
                })?;
            }
        }
        let mut atoms = Vec::new();
        let mut columns = vec![Vec::new(); concepts.len()];
        for fields in rows {
            row(&fields)?;
            for (column, field) in columns.iter_mut().zip(&fields[1..]) {
                column.push(match field.text.as_str() {
                    "1" => true,
                    "0" => false,
                    other => {
                        return Err(field.error(format!(
                            "`{other}` is no entry: give 1 where the concept contains it, and 0 where it does not"
                        )));
                    }
                });
            }
            atoms.extend(fields.into_iter().next());
        }
        let atoms = names(&atoms, "behaviour")?;
        let class = FiniteClass::new(atoms.len(), sizes.into_iter().zip(columns));
        let class = class.map_err(|error| match error {
            FiniteClassError::Duplicate { first, second } => header[second + 1].error(format!(
                "`{}` and `{}` contain the same: leave one of them out",
                concepts[first], concepts[second]
            )),
            other => header[0].error(other.to_string()),
        })?;
        Ok(Self {
            atoms,
            concepts,
            class,
        })
    }

    /// The class; nothing is known of its concepts yet.
    pub fn class(&self) -> &FiniteClass {
        &self.class
    }

    /// What the atoms are called, in their order.
    pub fn atoms(&self) -> impl ExactSizeIterator<Item = &str> {
        self.atoms.iter().map(String::as_str)
    }

    /// Whether the concept contains the atom.
    ///
    /// # Panics
    ///
    /// If one of them belongs to a larger class.
    pub fn accepts(&self, concept: FiniteConcept, atom: FiniteAtom) -> bool {
        self.class.contains(&concept, &atom)
    }

    /// What an atom of the class is called.
    ///
    /// # Panics
    ///
    /// If it belongs to a larger class.
    pub fn atom(&self, atom: FiniteAtom) -> &str {
        &self.atoms[atom.0 as usize]
    }

    /// What a concept of the class is called.
    ///
    /// # Panics
    ///
    /// If it belongs to a larger class.
    pub fn concept(&self, concept: FiniteConcept) -> &str {
        &self.concepts[concept.0 as usize]
    }

    /// The concept of this name.
    pub fn named(&self, name: &str) -> Option<FiniteConcept> {
        let place = self.concepts.iter().position(|concept| concept == name)?;
        Some(FiniteConcept(place as u32))
    }
}

/// The texts of these fields, which are different names.
fn names(fields: &[Field], of: &str) -> Result<Vec<String>, TableError> {
    let mut seen = BTreeMap::new();
    for field in fields {
        if field.text.is_empty() {
            return Err(field.error(format!("this {of} has no name: give it one")));
        }
        if let Some(line) = seen.insert(&field.text, field.line) {
            return Err(field.error(format!(
                "`{}` is the name of another {of} too, in line {line}: give each its own",
                field.text
            )));
        }
    }
    Ok(fields.iter().map(|field| field.text.clone()).collect())
}

/// The fields of a line.
fn fields(number: usize, line: &str) -> Result<Vec<Field>, TableError> {
    let characters: Vec<char> = line.chars().collect();
    let mut fields = Vec::new();
    let mut at = 0;
    loop {
        let error = |column: usize, message: &str| TableError {
            line: number,
            column: column + 1,
            message: message.to_owned(),
        };
        while characters.get(at).is_some_and(|c| *c == ' ' || *c == '\t') {
            at += 1;
        }
        let start = at;
        let mut text = String::new();
        if characters.get(at) == Some(&'"') {
            at += 1;
            loop {
                match (characters.get(at), characters.get(at + 1)) {
                    (Some('"'), Some('"')) => {
                        text.push('"');
                        at += 2;
                    }
                    (Some('"'), _) => break,
                    (Some(&other), _) => {
                        text.push(other);
                        at += 1;
                    }
                    (None, _) => {
                        return Err(error(start, "this quote is never closed: add a `\"`"));
                    }
                }
            }
            at += 1;
            while characters.get(at).is_some_and(|c| c.is_whitespace()) {
                at += 1;
            }
            if characters.get(at).is_some_and(|c| *c != ',') {
                return Err(error(
                    at,
                    "after a quoted field comes a comma: write a `\"` inside as `\"\"`",
                ));
            }
        } else {
            while characters.get(at).is_some_and(|c| *c != ',') {
                text.push(characters[at]);
                at += 1;
            }
            text.truncate(text.trim_end().len());
        }
        fields.push(Field {
            line: number,
            column: start + 1,
            text,
        });
        if at >= characters.len() {
            return Ok(fields);
        }
        at += 1;
    }
}
