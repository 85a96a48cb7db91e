//! The owner's password: what it must be, and how it is kept and checked.

use argon2::password_hash::{PasswordHash, PasswordHasher as _, PasswordVerifier as _, SaltString};
use argon2::{Algorithm, Argon2, Params, Version};

/// The fewest characters that a password may have.
pub(super) const SHORTEST: usize = 8;
/// The most.
pub(super) const LONGEST: usize = 256;

/// Why a password will not do, or could not be kept.
#[derive(Debug, thiserror::Error)]
pub enum BadPassword {
    /// It is easily guessed.
    #[error(
        "the password has fewer than {SHORTEST} characters: take a longer one, best 15 or more"
    )]
    Short,
    /// It is no password.
    #[error("the password has more than {LONGEST} characters: take a shorter one")]
    Long,
    /// The operating system gives no randomness, or there is no memory for the hash.
    #[error("the password could not be hashed: {0}")]
    Unhashed(String),
}

/// Argon2id with 19 MiB and two passes, the least that is advised; each sign-in is
/// paid for with that.
fn argon() -> Result<Argon2<'static>, BadPassword> {
    let params = Params::new(19 * 1024, 2, 1, None).map_err(unhashed)?;
    Ok(Argon2::new(Algorithm::Argon2id, Version::V0x13, params))
}

// By value, as `map_err` gives it.
#[allow(clippy::needless_pass_by_value)]
fn unhashed(cause: impl ToString) -> BadPassword {
    BadPassword::Unhashed(cause.to_string())
}

/// What is kept of a password.
///
/// # Errors
///
/// If the password will not do, or cannot be hashed.
pub fn hash(password: &str) -> Result<String, BadPassword> {
    let length = password.chars().count();
    if length < SHORTEST {
        return Err(BadPassword::Short);
    }
    if length > LONGEST {
        return Err(BadPassword::Long);
    }
    let mut salt = [0; 16];
    getrandom::fill(&mut salt).map_err(unhashed)?;
    let salt = SaltString::encode_b64(&salt).map_err(unhashed)?;
    let hash = argon()?.hash_password(password.as_bytes(), &salt);
    Ok(hash.map_err(unhashed)?.to_string())
}

/// Whether this is the password of which that was kept. Compares in constant time.
pub(crate) fn is_right(password: &str, kept: &str) -> bool {
    if password.chars().count() > LONGEST {
        return false;
    }
    let (Ok(argon), Ok(kept)) = (argon(), PasswordHash::new(kept)) else {
        return false;
    };
    argon.verify_password(password.as_bytes(), &kept).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_password_is_kept_as_a_slow_hash_with_a_salt_of_its_own() {
        let kept = hash("correct horse battery").unwrap();
        assert!(
            kept.starts_with("$argon2id$v=19$m=19456,t=2,p=1$"),
            "{kept}"
        );
        assert_ne!(kept, hash("correct horse battery").unwrap());
        assert!(is_right("correct horse battery", &kept));
        for wrong in ["", "correct horse batterz", "correct horse battery "] {
            assert!(!is_right(wrong, &kept), "{wrong}");
        }
        assert!(!is_right("correct horse battery", "no hash"));
    }

    #[test]
    fn passwords_that_are_short_or_no_passwords_are_refused() {
        assert!(matches!(hash("1234567"), Err(BadPassword::Short)));
        assert!(matches!(hash(&"ä".repeat(257)), Err(BadPassword::Long)));
        assert!(hash(&"ä".repeat(256)).is_ok());
    }
}
