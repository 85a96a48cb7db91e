//! An address under which people reach the server: `https://teach.example.org`.

use std::fmt;
use std::str::FromStr;

/// Scheme, host and port, as a browser writes them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    is_secure: bool,
    /// With the port, if it is not the scheme's own.
    host: String,
}

/// A text that is no origin.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no origin: write scheme and host, as in https://teach.example.org, and no path")]
pub struct NoOrigin(String);

impl Origin {
    /// Whether it is reached over TLS.
    pub fn is_secure(&self) -> bool {
        self.is_secure
    }

    /// Whether a `Host` header means it.
    pub(crate) fn is_meant_by(&self, host: &str) -> bool {
        let own = if self.is_secure { ":443" } else { ":80" };
        host.strip_suffix(own)
            .unwrap_or(host)
            .eq_ignore_ascii_case(&self.host)
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scheme = if self.is_secure { "https" } else { "http" };
        write!(f, "{scheme}://{}", self.host)
    }
}

impl FromStr for Origin {
    type Err = NoOrigin;

    fn from_str(text: &str) -> Result<Self, NoOrigin> {
        let none = || NoOrigin(text.to_owned());
        let (scheme, host) = text.split_once("://").ok_or_else(none)?;
        let (is_secure, own) = match scheme {
            "https" => (true, ":443"),
            "http" => (false, ":80"),
            _ => return Err(none()),
        };
        let host = host.strip_suffix('/').unwrap_or(host);
        let host = host.strip_suffix(own).unwrap_or(host).to_ascii_lowercase();
        let plain =
            |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-' | b':' | b'[' | b']');
        let port = host.rsplit_once(':').map(|(_, port)| port);
        let port_fits = port.is_none_or(|port| host.ends_with(']') || port.parse::<u16>().is_ok());
        if host.is_empty() || host.starts_with(':') || !host.bytes().all(plain) || !port_fits {
            return Err(none());
        }
        Ok(Self { is_secure, host })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_origin_is_a_scheme_and_a_host() {
        for (text, shown) in [
            ("https://Teach.example.org/", "https://teach.example.org"),
            ("https://teach.example.org:443", "https://teach.example.org"),
            ("http://10.0.0.7:8080", "http://10.0.0.7:8080"),
            ("https://[::1]", "https://[::1]"),
        ] {
            assert_eq!(text.parse::<Origin>().unwrap().to_string(), shown);
        }
        for bad in [
            "",
            "teach.example.org",
            "ftp://a",
            "https://",
            "https://a/b",
            "https://a b",
            "https://a@b",
            "https://:80",
            "https://a:x",
            "https://a?b",
            "https://a,b",
        ] {
            assert!(bad.parse::<Origin>().is_err(), "{bad}");
        }
    }

    #[test]
    fn only_its_own_host_means_it() {
        let origin: Origin = "https://teach.example.org".parse().unwrap();
        for own in ["teach.example.org", "TEACH.example.org:443"] {
            assert!(origin.is_meant_by(own), "{own}");
        }
        for other in [
            "",
            "example.org",
            "teach.example.org:80",
            "teach.example.org.evil",
        ] {
            assert!(!origin.is_meant_by(other), "{other}");
        }
    }
}
