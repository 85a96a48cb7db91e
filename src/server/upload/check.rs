//! Whether the files of an upload are what they are called, and what the recordings
//! name.

use std::collections::HashSet;

use super::spool::Spooled;
use super::{MEDIA, RECORDINGS};
use crate::session::Malformed;
use crate::world::pool::{Media, Pool};

/// The endings that are shown, with the type of the content, and as what it is
/// served.
const KINDS: [(&str, &[&str], &str); 8] = [
    ("png", &["image/png"], "image/png"),
    ("apng", &["image/png", "image/apng"], "image/apng"),
    ("jpg", &["image/jpeg"], "image/jpeg"),
    ("jpeg", &["image/jpeg"], "image/jpeg"),
    ("webp", &["image/webp"], "image/webp"),
    ("gif", &["image/gif"], "image/gif"),
    ("mp4", &["video/mp4", "video/x-m4v"], "video/mp4"),
    ("webm", &["video/webm"], "video/webm"),
];

/// The media type of a file, by its name and by how it begins: both must say the
/// same.
pub(super) fn kind(name: &str, head: &[u8]) -> Result<&'static str, Malformed> {
    let file = name.rsplit('/').next().unwrap_or(name);
    let ending = file.rsplit_once('.').map_or("", |(_, ending)| ending);
    let known = KINDS
        .iter()
        .find(|(known, ..)| ending.eq_ignore_ascii_case(known));
    let Some((ending, contents, served)) = known else {
        let endings: Vec<&str> = KINDS.iter().map(|(ending, ..)| *ending).collect();
        let message = format!(
            "`{name}` is no picture or film that a browser shows: send files that end in .{}",
            endings.join(", .")
        );
        return Err(Malformed::new(MEDIA, message));
    };
    let found = infer::get(head).map(|found| found.mime_type());
    if found.is_some_and(|found| contents.contains(&found)) {
        return Ok(served);
    }
    let found = match found {
        _ if head.is_empty() => "and is empty".to_owned(),
        Some(found) => format!("and its content is `{found}`"),
        None => "and its content is something else".to_owned(),
    };
    let message = format!("`{name}` is called .{ending} {found}: send a real .{ending} file");
    Err(Malformed::new(MEDIA, message))
}

/// Checks that every file that recordings name has come, and no other.
pub(super) fn all_are_here(
    pool: &Pool,
    sent: &HashSet<String>,
    in_order: &[Spooled],
) -> Result<(), Malformed> {
    let mut named = HashSet::new();
    for recording in pool.recordings() {
        let media = recording.media.iter();
        for (field, path) in media.flat_map(Media::named) {
            if !sent.contains(path) {
                let message = format!(
                    "line {}, `{field}`: `{path}` was not sent{}: send a file of exactly this path",
                    recording.line,
                    similar(path, in_order)
                );
                return Err(Malformed::new(RECORDINGS, message));
            }
            named.insert(path);
        }
    }
    match in_order.iter().find(|file| !named.contains(&*file.name)) {
        None => Ok(()),
        Some(file) => {
            let message = format!(
                "`{}` is named by no recording: leave it out, or name it in the recordings",
                file.name
            );
            Err(Malformed::new(MEDIA, message))
        }
    }
}

/// A file of the same name elsewhere, as a browser sends it for a folder.
fn similar(path: &str, sent: &[Spooled]) -> String {
    let last = |path: &str| path.rsplit('/').next().map(str::to_owned);
    let found = sent.iter().find(|file| last(&file.name) == last(path));
    found.map_or_else(String::new, |file| format!(", and `{}` was", file.name))
}

#[cfg(test)]
mod tests {
    use super::kind;

    #[test]
    fn files_are_what_they_are_called() {
        const PNG: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
        const WEBM: &[u8] = b"\x1a\x45\xdf\xa3\x9f\x42\x86\x81\x01\x42\xf7\x81\x01\x42\xf2\x81\x04\x42\xf3\x81\x08\x42\x82\x84webm";
        const MP4: &[u8] = b"\0\0\0\x20ftypisom\0\0\x02\0isomiso2avc1mp41";
        for (name, head, served) in [
            ("a/b.PNG", PNG, "image/png"),
            ("a.apng", PNG, "image/apng"),
            ("a.gif", b"GIF89a", "image/gif"),
            ("a.jpeg", b"\xff\xd8\xff\xe0\0\x10JFIF", "image/jpeg"),
            ("a.webp", b"RIFF\x24\0\0\0WEBPVP8 ", "image/webp"),
            ("a.webm", WEBM, "video/webm"),
            ("a.mp4", MP4, "video/mp4"),
        ] {
            assert_eq!(kind(name, head), Ok(served), "{name}");
        }
        for (name, head, part) in [
            ("a.gif", PNG, "its content is `image/png`"),
            ("a.png", &b"<svg>"[..], "something else"),
            ("a.png", &b""[..], "is empty"),
            ("a.svg", PNG, "no picture or film"),
            ("png", PNG, "no picture or film"),
            ("a.webm", MP4, "its content is `video/mp4`"),
        ] {
            let fault = kind(name, head).unwrap_err();
            assert_eq!(fault.path, "media");
            assert!(fault.message.contains(part), "{fault}");
            assert!(fault.message.contains(name), "{fault}");
        }
    }
}
