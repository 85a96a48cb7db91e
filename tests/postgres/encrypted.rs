//! The way to a database on another machine: encrypted, and to nobody who only claims to
//! be it.

use std::path::Path;
use std::process::{Command, Stdio};

use super::cluster::Cluster;

/// Whether a database is reached over TCP, given whom the machine trusts; what was said.
fn reach(address: &str, trusted: &Path) -> (bool, String) {
    let mut memrep = Command::new(env!("CARGO_BIN_EXE_memrep"));
    let memrep = memrep
        .args(["password", "--remove", "--database", address])
        .env("SSL_CERT_FILE", trusted)
        .env_remove("SSL_CERT_DIR")
        .stdin(Stdio::null());
    let output = memrep.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.success(), said)
}

#[test]
fn a_database_is_spoken_to_encrypted_and_only_if_its_certificate_holds() {
    let mut cluster = Cluster::start();
    cluster.database("a");
    let authority = cluster.encrypt();
    let mut other = Cluster::start();
    let stranger = other.encrypt();
    let at = |host: &str, mode: &str| {
        let port = cluster.port();
        format!("postgres://memrep@{host}:{port}/a{mode}")
    };
    for mode in ["?sslmode=require", "?sslmode=verify-full"] {
        let (reached, said) = reach(&at("localhost", mode), &authority);
        assert!(reached, "{mode}: {said}");
    }
    let (reached, said) = reach(&at("localhost", "?sslmode=require"), &stranger);
    assert!(
        !reached && said.contains("invalid peer certificate"),
        "{said}"
    );
    // The certificate is for the name, not for the number.
    let (reached, said) = reach(&at("127.0.0.1", "?sslmode=require"), &authority);
    assert!(!reached && said.contains("certificate"), "{said}");
    // The database lets nobody in who speaks in the clear.
    let (reached, said) = reach(&at("localhost", "?sslmode=disable"), &authority);
    assert!(!reached && said.contains("no encryption"), "{said}");
}
