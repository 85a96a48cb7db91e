//! The cookies in which browsers keep the keys of visits.

use axum::http::header::COOKIE;
use axum::http::{HeaderMap, HeaderValue};

use crate::store::VisitKey;

/// The name of the owner's cookie, with which those of invited people begin.
const NAME: &str = "memrep";
/// Browsers take a cookie of such a name only over TLS, for this host alone.
const HOST_ONLY: &str = "__Host-";
/// More cookies than this are not looked at.
const MOST: usize = 64;

/// Whose cookie, and how the request came.
#[derive(Clone, Copy)]
pub(crate) struct Cookie<'a> {
    /// An invited person's place; none for the owner.
    pub(crate) place: Option<&'a str>,
    /// Whether the browser is at an address with TLS.
    pub(crate) is_secure: bool,
}

impl Cookie<'_> {
    fn name(&self) -> String {
        let prefix = if self.is_secure { HOST_ONLY } else { "" };
        match self.place {
            None => format!("{prefix}{NAME}"),
            Some(place) => format!("{prefix}{NAME}-{place}"),
        }
    }

    /// The key that the request brings in it.
    pub(crate) fn read(&self, headers: &HeaderMap) -> Option<VisitKey> {
        let name = self.name();
        let mut found = pairs(headers).filter(|(key, _)| *key == name);
        found.find_map(|(_, value)| value.parse().ok())
    }

    /// The header that has the browser keep the key for so many seconds.
    pub(crate) fn keep(&self, key: &VisitKey, seconds: u64) -> Option<HeaderValue> {
        self.header(&key.to_string(), seconds)
    }

    /// The header that has the browser forget it.
    pub(crate) fn forget(&self) -> Option<HeaderValue> {
        self.header("", 0)
    }

    fn header(&self, value: &str, seconds: u64) -> Option<HeaderValue> {
        // Strict would not send it where somebody comes by a link.
        let mut text = format!(
            "{}={value}; Path=/; Max-Age={seconds}; HttpOnly; SameSite=Lax",
            self.name()
        );
        if self.is_secure {
            text.push_str("; Secure");
        }
        let mut header = HeaderValue::from_str(&text).ok()?;
        header.set_sensitive(true);
        Some(header)
    }
}

/// The keys of all invited people in this browser.
pub(crate) fn invited(headers: &HeaderMap, is_secure: bool) -> Vec<VisitKey> {
    let any = Cookie {
        place: Some(""),
        is_secure,
    };
    let prefix = any.name();
    pairs(headers)
        .filter(|(name, _)| name.starts_with(&prefix))
        .filter_map(|(_, value)| value.parse().ok())
        .collect()
}

fn pairs(headers: &HeaderMap) -> impl Iterator<Item = (&str, &str)> {
    headers
        .get_all(COOKIE)
        .iter()
        .filter_map(|header| header.to_str().ok())
        .flat_map(|header| header.split(';'))
        .filter_map(|pair| pair.trim().split_once('='))
        .take(MOST)
}
