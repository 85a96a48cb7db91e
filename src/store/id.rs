//! The names of sessions and uploads, which nobody can guess.

use std::fmt;
use std::str::FromStr;

use sha2::{Digest as _, Sha256};

/// A name of 128 random bits, written as 32 hexadecimal digits.
macro_rules! random_name {
    ($(#[$about:meta])* $name:ident, $(#[$error:meta])* $none:ident) => {
        $(#[$about])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name([u8; 16]);

        #[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
        $(#[$error])*
        pub struct $none;

        impl $name {
            /// A new name from the operating system's generator.
            ///
            /// # Errors
            ///
            /// If the operating system has no randomness to give.
            pub fn random() -> Result<Self, getrandom::Error> {
                let mut bytes = [0; 16];
                getrandom::fill(&mut bytes)?;
                Ok(Self(bytes))
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
            }
        }

        impl fmt::Debug for $name {
            /// Only the beginning: whoever has the whole name has what it names.
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{:02x}{:02x}…", self.0[0], self.0[1])
            }
        }

        impl FromStr for $name {
            type Err = $none;

            fn from_str(text: &str) -> Result<Self, $none> {
                read(text).map(Self).ok_or($none)
            }
        }
    };
}

random_name!(
    /// The name of a session: 128 random bits, written as 32 hexadecimal digits.
    SessionId,
    /// A text that is no session's name.
    #[error("a session's name is 32 hexadecimal digits")]
    NoSessionId
);
random_name!(
    /// The name of an upload: 128 random bits, written as 32 hexadecimal digits.
    UploadId,
    /// A text that is no upload's name.
    #[error("an upload's name is 32 hexadecimal digits")]
    NoUploadId
);

random_name!(
    /// The key with which an invited person answers: 128 random bits, written as 32
    /// hexadecimal digits.
    InviteKey,
    /// A text that is no such key.
    #[error("an invitation's key is 32 hexadecimal digits")]
    NoInviteKey
);

impl InviteKey {
    /// What is kept of it: nobody who reads the database can answer with that. A
    /// key is as random as can be, so that a plain digest cannot be guessed back.
    pub fn digest(&self) -> String {
        digest(&self.0)
    }
}

/// The SHA-256 of a key, in hexadecimal digits.
pub(super) fn digest(key: &[u8]) -> String {
    use std::fmt::Write as _;
    let mut text = String::with_capacity(64);
    for byte in Sha256::digest(key) {
        // Writing to a string never fails.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

fn read(text: &str) -> Option<[u8; 16]> {
    let digits = |c: char| matches!(c, '0'..='9' | 'a'..='f');
    if text.len() != 32 || !text.chars().all(digits) {
        return None;
    }
    let mut bytes = [0; 16];
    for (i, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from_str_radix(&text[2 * i..2 * i + 2], 16).ok()?;
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back_and_are_not_shown_whole_in_logs() {
        let id = SessionId::random().unwrap();
        assert_eq!(id.to_string().parse(), Ok(id));
        assert_ne!(id, SessionId::random().unwrap());
        assert!(format!("{id:?}").len() < 10);
        for bad in [
            "",
            "0",
            "zz",
            &"g".repeat(32),
            &"A".repeat(32),
            &"ä".repeat(16),
        ] {
            assert_eq!(bad.parse::<SessionId>(), Err(NoSessionId));
        }
    }
}
