//! Passwords in what is told: they are left out.

use clap::error::ContextValue;

/// What an error says, without the passwords in what was given; nothing where there are
/// none.
pub(in crate::cli) fn without_passwords(error: &clap::Error) -> Option<String> {
    let given = error.context().filter_map(|(_, value)| match value {
        ContextValue::String(text) => Some((text, masked(text))),
        _ => None,
    });
    let mut told = None;
    for (text, masked) in given.filter(|(text, masked)| *text != masked) {
        let so_far = told.unwrap_or_else(|| error.to_string());
        told = Some(so_far.replace(text, &masked));
    }
    told
}

/// The text without the passwords in it: those of addresses such as
/// `postgres://user:password@host/name`, also where they are not quite written so, and
/// of `password=…`.
pub(in crate::cli) fn masked(text: &str) -> String {
    const HIDDEN: &str = "***";
    let mut shown = text.to_owned();
    let start = after_scheme(text);
    let rest = &text[start..];
    let (from, end) = match rest.rfind('@') {
        // A password may have any character in it, even those that end it elsewhere.
        Some(end) => (rest[..end].find(':'), end),
        // Before a host that was forgotten; or it is a port.
        None if start > 0 => {
            let end = rest.find(['/', '?']).unwrap_or(rest.len());
            let is_secret = |colon: &usize| {
                let port = &rest[colon + 1..end];
                !port.ends_with(']') && !port.bytes().all(|digit| digit.is_ascii_digit())
            };
            (rest[..end].rfind(':').filter(is_secret), end)
        }
        None => (None, 0),
    };
    if let Some(colon) = from {
        shown.replace_range(start + colon + 1..start + end, HIDDEN);
    }
    let mut from = 0;
    while let Some(found) = shown[from..].to_ascii_lowercase().find("password=") {
        let start = from + found + "password=".len();
        let rest = &shown[start..];
        let end = match rest.strip_prefix('\'') {
            Some(quoted) => quoted.find('\'').map(|end| end + 2),
            None => rest.find(|c: char| c == '&' || c.is_whitespace()),
        };
        shown.replace_range(start..start + end.unwrap_or(rest.len()), HIDDEN);
        from = start + HIDDEN.len();
    }
    shown
}

/// Where an address goes on after its scheme, which may have been mistyped.
fn after_scheme(text: &str) -> usize {
    if let Some(scheme) = text.find("://") {
        return scheme + "://".len();
    }
    let mut known = ["postgresql", "postgres"].into_iter();
    let rest = known.find_map(|scheme| text.strip_prefix(scheme));
    let rest = rest.filter(|rest| rest.starts_with([':', '/']));
    rest.map_or(0, |rest| {
        text.len() - rest.trim_start_matches([':', '/']).len()
    })
}
