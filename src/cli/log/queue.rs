//! Lines on their way out, written by a thread of their own. Who logs never waits:
//! where the reader is slower than the log grows, lines are lost, and counted.

use std::collections::VecDeque;
use std::io::Write;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tracing::Level;

use super::line::{Format, Line, Value};

/// So many lines wait at most: some megabytes.
const MOST: usize = 10_000;

/// How long the end waits for lines that nobody reads.
const FAREWELL: Duration = Duration::from_millis(500);

/// Where lines wait.
pub(super) struct Queue {
    format: Format,
    waiting: Mutex<Waiting>,
    changed: Condvar,
}

#[derive(Default)]
struct Waiting {
    lines: VecDeque<String>,
    lost: u64,
    /// Whether lines are being written at this moment.
    busy: bool,
    ended: bool,
}

/// Writes lines until it is dropped.
pub(in crate::cli) struct Writer {
    queue: Arc<Queue>,
}

/// A queue of lines of this format, which are written to `out`.
pub(super) fn start(format: Format, mut out: impl Write + Send + 'static) -> (Arc<Queue>, Writer) {
    let queue = Arc::new(Queue {
        format,
        waiting: Mutex::default(),
        changed: Condvar::new(),
    });
    let from = Arc::clone(&queue);
    std::thread::spawn(move || {
        while let Some(text) = from.next() {
            // There is nobody left to tell that telling fails.
            let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
            from.written();
        }
    });
    let writer = Writer {
        queue: Arc::clone(&queue),
    };
    (queue, writer)
}

impl Queue {
    pub(super) fn push(&self, line: String) {
        let mut waiting = self.waiting();
        if waiting.lines.len() < MOST {
            waiting.lines.push_back(line);
            self.changed.notify_all();
        } else {
            waiting.lost += 1;
        }
    }

    /// What is to be written next, once there is something; none at the end.
    fn next(&self) -> Option<String> {
        let idle = |waiting: &mut Waiting| waiting.lines.is_empty() && !waiting.ended;
        let waiting = self.changed.wait_while(self.waiting(), idle);
        let mut waiting = waiting.unwrap_or_else(PoisonError::into_inner);
        if waiting.lines.is_empty() {
            return None;
        }
        waiting.busy = true;
        let mut text: String = waiting.lines.drain(..).collect();
        let lost = std::mem::take(&mut waiting.lost);
        if lost > 0 {
            text.push_str(&lost_line(self.format, lost));
        }
        Some(text)
    }

    fn written(&self) {
        self.waiting().busy = false;
        self.changed.notify_all();
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Says that lines were lost.
fn lost_line(format: Format, lost: u64) -> String {
    let mut line = Line::new(format, Level::WARN, module_path!());
    line.message(&Value::Text(
        "lines were lost: whoever reads the log is too slow".into(),
    ));
    line.field("lost", &Value::Plain(lost.to_string()));
    line.end()
}

impl Drop for Writer {
    fn drop(&mut self) {
        let mut waiting = self.queue.waiting();
        waiting.ended = true;
        self.queue.changed.notify_all();
        let unwritten = |waiting: &mut Waiting| !waiting.lines.is_empty() || waiting.busy;
        // What is not written by then is not read by anybody.
        drop(
            self.queue
                .changed
                .wait_timeout_while(waiting, FAREWELL, unwritten),
        );
    }
}

/// Keeps what is written, for tests.
#[cfg(test)]
#[derive(Clone, Default)]
pub(super) struct Kept(Arc<Mutex<Vec<u8>>>);

#[cfg(test)]
impl Kept {
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.0.lock().unwrap().clone()
    }
}

#[cfg(test)]
impl Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A reader who does not read until it is told to.
    struct Stuck(Arc<Mutex<()>>, Kept);

    impl Write for Stuck {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            let _free = self.0.lock().unwrap();
            self.1.write(bytes)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_who_does_not_read_holds_nobody_up_and_learns_what_was_lost() {
        let (gate, kept) = (Arc::new(Mutex::new(())), Kept::default());
        let closed = gate.lock().unwrap();
        let (queue, writer) = start(Format::Text, Stuck(Arc::clone(&gate), kept.clone()));
        // However many the writer had taken when it came to a stop, some are too many.
        for number in 0..2 * MOST + 500 {
            queue.push(format!("{number}\n"));
        }
        drop(closed);
        queue.push("last\n".to_owned());
        drop(writer);
        let text = String::from_utf8(kept.bytes()).unwrap();
        let lines = text.lines().count();
        assert!(lines > MOST && lines < 2 * MOST + 3, "{lines}");
        assert!(
            text.contains("lines were lost"),
            "{}",
            &text[text.len() - 300..]
        );
    }
}
