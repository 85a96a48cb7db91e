//! The passive experiment: how long finding a smallest consistent automaton
//! takes on random samples, beside `dfa-identify` from `PyPI`.
//!
//! Both run as processes of their own and are charged their whole CPU time, the
//! start of an interpreter included: this is what a user waits for on an idle
//! machine. CPU time ends the rival's run, and work ends ours.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;

use automata::{Alphabet, Dfa, Item, Sample, Symbol, Word};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wait4::Wait4;

use crate::oracle::minimal;

/// What `dfa-identify` is run as: `python -c THIS sample.abb SECONDS`. It prints
/// the number of states of what it found, without a sink that it left out, and
/// ends itself after so much CPU time.
pub const DFA_IDENTIFY: &str = "\
import resource, sys
resource.setrlimit(resource.RLIMIT_CPU, (int(sys.argv[2]),) * 2)
from dfa_identify import find_dfa
accepted, rejected = [], []
with open(sys.argv[1]) as lines:
    next(lines)
    for line in lines:
        label, _, *word = line.split()
        (accepted if label == '1' else rejected).append(tuple(word))
print(len(find_dfa(accepted, rejected).states()))
";

/// A random target and `words` distinct words labelled by it.
///
/// The target is drawn evenly from all tables with `states` states over `0`, `1`
/// and drawn again until it is minimal; a word's length is even in
/// `0..=⌈2·log₂ states + 5⌉`, its symbols are even, and repeated words are drawn
/// again. The samples of one target with fewer words are beginnings of those
/// with more.
///
/// # Panics
///
/// If `states` is 0, or there are not so many words of these lengths.
pub fn random_sample(states: usize, words: usize, seed: u64) -> (Dfa, Sample) {
    let alphabet = Alphabet::new(["0", "1"]).expect("two names are an alphabet");
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let target = random_target(&alphabet, states, &mut random);
    assert!(
        words <= most_words(states),
        "there are fewer than {words} words for {states} states"
    );
    let longest = longest(states);
    let mut seen = BTreeSet::new();
    let mut sample = Sample::new(alphabet);
    while seen.len() < words {
        let length = random.random_range(0..=longest);
        let symbols = (0..length).map(|_| Symbol::new(usize::from(random.random::<bool>())));
        let word: Word = symbols.collect();
        if seen.insert(word.clone()) {
            let accepted = target.accepts(&word);
            sample.push(Item::Label { word, accepted });
        }
    }
    (target, sample)
}

/// The length of the longest words that are drawn for a target of this size.
fn longest(states: usize) -> u32 {
    // ⌈2·log₂ n⌉ is the least power of two that n² does not exceed.
    (states * states).next_power_of_two().ilog2() + 5
}

/// How many words there are to draw from, for a target of this size.
pub fn most_words(states: usize) -> usize {
    (1 << (longest(states) + 1)) - 1
}

/// A minimal automaton of this size, evenly drawn.
fn random_target(alphabet: &Alphabet, states: usize, random: &mut ChaCha8Rng) -> Dfa {
    let top = u32::try_from(states).expect("a target has few states");
    minimal(alphabet, states, || {
        let rows = (0..states)
            .map(|_| {
                let next = |_| random.random_range(0..top) as usize;
                (0..alphabet.len()).map(next).collect()
            })
            .collect();
        (rows, (0..states).map(|_| random.random()).collect())
    })
}

/// What a process came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It ended well.
    Done {
        /// Its CPU time, user and system.
        cpu: Duration,
        /// The largest memory it held, in bytes.
        memory: u64,
        /// What it printed.
        output: String,
    },
    /// It ended without an automaton.
    Failed {
        /// What it printed.
        output: String,
        /// The last line of its complaint.
        complaint: String,
    },
    /// It was stopped at the limit.
    Stopped,
}

/// Runs a command until it ends or uses up its own limit, or stops it after
/// `patience` of wall time.
///
/// # Errors
///
/// If it cannot be started at all.
pub fn measure(mut command: Command, patience: Duration) -> std::io::Result<Outcome> {
    use std::io::Read as _;

    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let read = |mut pipe: Box<dyn std::io::Read + Send>| {
        std::thread::spawn(move || {
            let mut bytes = Vec::new();
            // A pipe that breaks has said what it had to say.
            let _ = pipe.read_to_end(&mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        })
    };
    let output = child.stdout.take().map(|pipe| read(Box::new(pipe)));
    let errors = child.stderr.take().map(|pipe| read(Box::new(pipe)));
    let (ended, watch) = mpsc::channel::<()>();
    let process = rustix::process::Pid::from_child(&child);
    let watchdog = std::thread::spawn(move || {
        let stop = watch.recv_timeout(patience) == Err(mpsc::RecvTimeoutError::Timeout);
        if stop {
            // It may just have ended by itself, which is as good.
            let _ = rustix::process::kill_process(process, rustix::process::Signal::KILL);
        }
        stop
    });
    let used = child.wait4()?;
    drop(ended);
    let stopped = watchdog.join().unwrap_or(false);
    let text = |reader: Option<std::thread::JoinHandle<String>>| {
        reader
            .and_then(|reader| reader.join().ok())
            .unwrap_or_default()
    };
    let (output, errors) = (text(output), text(errors));
    // Only a limit of the system's ends either of them by a signal.
    Ok(if stopped || used.status.code().is_none() {
        Outcome::Stopped
    } else if used.status.success() {
        Outcome::Done {
            cpu: used.rusage.utime + used.rusage.stime,
            memory: used.rusage.maxrss,
            output,
        }
    } else {
        let complaint = errors.lines().last().unwrap_or_default().trim();
        Outcome::Failed {
            output,
            complaint: complaint.to_owned(),
        }
    })
}

/// `memrep identify` on a sample's file, by this very program, for so many units
/// of work.
///
/// # Errors
///
/// If the program does not know where it is.
pub fn ours(sample: &Path, budget: u64) -> std::io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command
        .args(["identify", "--format", "json", "--budget"])
        .arg(budget.to_string())
        .arg(sample);
    Ok(command)
}

/// `dfa-identify` on a sample's file, by the Python that has it installed, for so
/// much CPU time.
pub fn dfa_identify(python: &Path, sample: &Path, limit: Duration) -> Command {
    let mut command = Command::new(python);
    command
        .args(["-c", DFA_IDENTIFY])
        .arg(sample)
        .arg(limit.as_secs().to_string());
    command
}
