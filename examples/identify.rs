//! Finds every smallest automaton that agrees with a few answers, and then the
//! answers that cannot stand together.
//!
//! ```sh
//! cargo run --release --example identify
//! ```

use automata::Alphabet;
use memrep::evidence::{AnswerId, Budget, Comparison, Fact};
use memrep::identify::{EngineChoice, Failure, Identifier, Settings};

fn main() -> anyhow::Result<()> {
    let alphabet = Alphabet::new(["a", "b"])?;
    let word = |letters: &str| alphabet.word(letters.split_terminator(' '));
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 10,
    };
    let mut identifier = Identifier::new(alphabet.clone(), settings);

    let label = |letters: &str, accepted| -> anyhow::Result<_> {
        let atom = word(letters)?;
        Ok(Fact::Label { atom, accepted })
    };
    identifier.add(Some(AnswerId(1)), label("", true)?);
    identifier.add(Some(AnswerId(2)), label("a", false)?);
    identifier.add(Some(AnswerId(3)), label("a b", true)?);
    // "a a" is better than "a b": since "a b" is acceptable, so is "a a".
    let better = Fact::compared(word("a a")?, word("a b")?, Comparison::First);
    identifier.add(Some(AnswerId(4)), better);

    let sample = identifier.smallest(100, 0, &mut Budget::new(1_000_000));
    let sample = sample.map_err(|failure| anyhow::anyhow!("no automaton: {failure:?}"))?;
    println!(
        "{} smallest automata, of {} states each; all of them: {}",
        sample.automata.len(),
        sample.automata[0].size(),
        sample.complete
    );
    println!("the simplest, in DOT:\n");
    print!("{}", automata::format::dot::write(&sample.automata[0])?);

    identifier.add(Some(AnswerId(5)), label("a a", false)?);
    match identifier.smallest(1, 0, &mut Budget::new(1_000_000)) {
        Err(Failure::Contradiction(contradiction)) => {
            println!(
                "\nrejecting `a a` as well: answers {:?} cannot all stand",
                contradiction.answers
            );
        }
        other => anyhow::bail!("a contradiction was expected, not {other:?}"),
    }
    identifier.retract(AnswerId(4));
    let sample = identifier.smallest(1, 0, &mut Budget::new(1_000_000));
    let sample = sample.map_err(|failure| anyhow::anyhow!("no automaton: {failure:?}"))?;
    println!("without answer 4: {} states", sample.automata[0].size());
    Ok(())
}
