//! Files of automata and samples: what is read is written and read back equal, and
//! what is not says where it is wrong.

use automata::format::{ReadError, abbadingo as abb, dot as wiki, dot_people, hoa, json, jsonl};
use automata::{Alphabet, Dfa};

use super::{check_place, text};

fn check_fault(text: &str, error: &ReadError) {
    let shown = error.to_string();
    let (line, column) = (error.line(), error.column());
    check_place(text, line.unwrap_or(0), column.unwrap_or(0), &shown);
}

/// Every writer takes it, or says why not; what can be read back is equal.
fn check_written(dfa: &Dfa) {
    let document = json::Document::from(dfa.clone());
    assert_eq!(json::read(&json::write(&document)).as_ref(), Ok(&document));
    if let Ok(written) = wiki::write(dfa) {
        assert_eq!(wiki::read(&written).as_ref(), Ok(dfa));
    }
    let _ = (hoa::write(dfa), dot_people::write(dfa));
}

pub(crate) fn automaton(data: &[u8]) {
    let text = text(data);
    match json::read(text) {
        Ok(document) => {
            assert_eq!(json::read(&json::write(&document)).as_ref(), Ok(&document));
            let smallest = document.dfa.minimise();
            assert!(smallest.size() <= document.dfa.size());
            assert_eq!(smallest.is_equivalent(&document.dfa), Ok(true));
            check_written(&smallest);
        }
        Err(error) => check_fault(text, &error),
    }
}

pub(crate) fn dot(data: &[u8]) {
    let text = text(data);
    match wiki::read(text) {
        Ok(dfa) => check_written(&dfa),
        Err(error) => check_fault(text, &error),
    }
}

pub(crate) fn abbadingo(data: &[u8]) {
    let text = text(data);
    match abb::read(text) {
        Ok(sample) => {
            let written = abb::write(&sample).expect("what was read has no preferences");
            assert_eq!(abb::read(&written).as_ref(), Ok(&sample));
            assert_eq!(jsonl::read(&jsonl::write(&sample)).as_ref(), Ok(&sample));
        }
        Err(error) => check_fault(text, &error),
    }
}

pub(crate) fn sample(data: &[u8]) {
    let text = text(data);
    match jsonl::read(text) {
        Ok(sample) => {
            assert_eq!(jsonl::read(&jsonl::write(&sample)).as_ref(), Ok(&sample));
            assert_eq!(
                jsonl::read_over(text, sample.alphabet()).as_ref(),
                Ok(&sample)
            );
            let _ = abb::write(&sample);
        }
        Err(error) => check_fault(text, &error),
    }
    let letters = Alphabet::new(["a", "b"]).expect("two letters are an alphabet");
    if let Err(error) = jsonl::read_over(text, &letters) {
        check_fault(text, &error);
    }
}
