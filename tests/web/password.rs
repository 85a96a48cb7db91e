//! `memrep password` at a terminal: nothing of what is typed is shown, and the terminal
//! is as it was afterwards, however it ends.

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::path::Path;
use std::process::{Command, ExitStatus};

use memrep::store::{Sqlite, Store};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{LocalModes, tcgetattr};

/// What the program said while this was typed, and how it ended; a prompt is waited for
/// before each of them.
fn typed(folder: &Path, keys: &[&str]) -> (String, ExitStatus) {
    let near = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&near).unwrap();
    unlockpt(&near).unwrap();
    let name = ptsname(&near, Vec::new()).unwrap();
    let mut both = File::options();
    let both = both.read(true).write(true);
    let far = both.open(name.to_str().unwrap()).unwrap();
    let before = tcgetattr(&far).unwrap().local_modes;
    assert!(before.contains(LocalModes::ECHO));
    let mut child = Command::new(env!("CARGO_BIN_EXE_memrep"))
        .args(["password", "--database", "a.db"])
        .current_dir(folder)
        .stdin(far.try_clone().unwrap())
        .stdout(far.try_clone().unwrap())
        .stderr(far.try_clone().unwrap())
        .spawn()
        .unwrap();
    let mut terminal = File::from(near);
    let mut said = Vec::new();
    let mut piece = [0; 256];
    for (number, keys) in keys.iter().enumerate() {
        while said.windows(2).filter(|part| part == b": ").count() <= number {
            let read = terminal.read(&mut piece).unwrap();
            said.extend_from_slice(&piece[..read]);
        }
        terminal.write_all(keys.as_bytes()).unwrap();
    }
    let ended = child.wait().unwrap();
    assert_eq!(tcgetattr(&far).unwrap().local_modes, before, "as it was");
    // Without a last word there would be nothing to wait for.
    (&far).write_all(b"\x04").unwrap();
    while !said.ends_with(b"\x04") {
        let read = terminal.read(&mut piece).unwrap();
        said.extend_from_slice(&piece[..read]);
    }
    (String::from_utf8(said).unwrap(), ended)
}

#[test]
fn a_password_is_typed_twice_and_never_shown() {
    let folder = tempfile::tempdir().unwrap();
    let is_set = || {
        let store = Sqlite::open(&folder.path().join("a.db")).unwrap();
        store.visits().password().unwrap().is_some()
    };
    for (keys, says) in [
        (&["correct horse\n", "correct house\n"][..], "differ"),
        (&["short\n", "short\n"], "fewer than 8 characters"),
        (&["correct\x03"], "nothing was changed"),
        (&["\x04"], "nothing was changed"),
        (&["correct horse\n", "\x03"], "nothing was changed"),
    ] {
        let (said, ended) = typed(folder.path(), keys);
        assert!(!ended.success(), "{keys:?}: {said}");
        assert!(said.contains(says), "{keys:?}: {said}");
        assert!(!said.contains("correct"), "{keys:?}: {said}");
        assert!(!is_set(), "{keys:?}");
    }
    // Mended while typing, and both pasted at once.
    for keys in [
        &["correct horsö\x7fe\n", "false\x15correct horse\n"][..],
        &["correct horse\ncorrect horse\n"],
    ] {
        let (said, ended) = typed(folder.path(), keys);
        assert!(ended.success(), "{keys:?}: {said}");
        assert!(said.contains("is set"), "{keys:?}: {said}");
        assert!(!said.contains("correct"), "{keys:?}: {said}");
        assert!(is_set(), "{keys:?}");
    }
}
