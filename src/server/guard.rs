//! What keeps other sites out: headers, the origin of requests, the host they
//! were meant for.

use axum::extract::{Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, HeaderName, HeaderValue, REFERRER_POLICY,
    STRICT_TRANSPORT_SECURITY, X_CONTENT_TYPE_OPTIONS, X_FRAME_OPTIONS,
};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use percent_encoding::percent_decode_str;

use super::AppState;
use super::error::{ApiError, PageError, WebError};

const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; media-src 'self'; connect-src 'self'; form-action 'self'; frame-ancestors 'none'; base-uri 'none'";

/// What a page may ask of the machine: nothing.
const PERMISSIONS: &str = "camera=(), microphone=(), geolocation=(), display-capture=(), payment=(), usb=(), serial=(), bluetooth=(), midi=(), accelerometer=(), gyroscope=(), magnetometer=(), browsing-topics=()";

const HEADERS: [(HeaderName, &str); 6] = [
    (HeaderName::from_static("permissions-policy"), PERMISSIONS),
    (X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (REFERRER_POLICY, "no-referrer"),
    (X_FRAME_OPTIONS, "DENY"),
    (
        HeaderName::from_static("cross-origin-opener-policy"),
        "same-origin",
    ),
    (
        HeaderName::from_static("cross-origin-resource-policy"),
        "same-origin",
    ),
];

/// For a year: whoever says that there is TLS means it.
const ONLY_TLS: HeaderValue = HeaderValue::from_static("max-age=31536000");

/// Adds the security headers to every response, and forbids keeping those that
/// do not say otherwise.
pub(crate) async fn headers(State(app): State<AppState>, request: Request, next: Next) -> Response {
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    if app.door.has_tls() {
        headers.insert(STRICT_TRANSPORT_SECURITY, ONLY_TLS);
    }
    // What was uploaded has one of its own, which allows less.
    headers
        .entry(CONTENT_SECURITY_POLICY)
        .or_insert(HeaderValue::from_static(POLICY));
    headers
        .entry(CACHE_CONTROL)
        .or_insert(HeaderValue::from_static("no-store"));
    response
}

/// Refuses requests that were meant for another host.
///
/// A page of another site can point its own name at this machine and then read
/// what is served here. It cannot make the browser send a number or
/// `localhost` as the host's name, nor the name that the owner gave.
pub(crate) async fn host(State(app): State<AppState>, request: Request, next: Next) -> Response {
    let own = match request.headers().get(HOST) {
        None => true,
        Some(host) => host.to_str().is_ok_and(|host| app.door.answers_to(host)),
    };
    if own {
        next.run(request).await
    } else {
        refuse(request.uri().path(), WebError::Foreign)
    }
}

/// Refuses addresses that are no text once they are decoded: nothing is there.
pub(crate) async fn text(request: Request, next: Next) -> Response {
    let path = request.uri().path();
    match percent_decode_str(path).decode_utf8() {
        Ok(_) => next.run(request).await,
        Err(_) => refuse(path, WebError::NoPage),
    }
}

/// Whether this names the machine itself, or no machine by name.
pub(crate) fn is_own(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|b| b.is_ascii_digit()) => name,
        _ => host,
    };
    let bare = name
        .strip_prefix('[')
        .and_then(|n| n.strip_suffix(']'))
        .unwrap_or(name);
    name.eq_ignore_ascii_case("localhost")
        || name.to_ascii_lowercase().ends_with(".localhost")
        || bare.parse::<std::net::IpAddr>().is_ok()
}

/// Whether scripts ask there.
pub(crate) fn is_api(path: &str) -> bool {
    path == "/api" || path.starts_with("/api/")
}

/// The error in the form that fits the address.
pub(crate) fn refuse(path: &str, error: WebError) -> Response {
    if is_api(path) {
        ApiError(error).into_response()
    } else {
        PageError(error).into_response()
    }
}

#[cfg(test)]
mod tests {
    use super::is_own;

    #[test]
    fn only_numbers_and_localhost_are_own_hosts() {
        for own in [
            "localhost",
            "localhost:8080",
            "LOCALHOST:1",
            "127.0.0.1:8080",
            "[::1]:8080",
            "[::1]",
            "a.localhost:3",
        ] {
            assert!(is_own(own), "{own}");
        }
        for other in [
            "evil.example",
            "evil.example:8080",
            "localhost.evil.example",
            "",
            ":80",
            "127.0.0.1.evil.example",
        ] {
            assert!(!is_own(other), "{other}");
        }
    }
}
