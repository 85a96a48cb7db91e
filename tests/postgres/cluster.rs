//! A real database server of our own, gone with the test.

use std::fs;
use std::io::Write as _;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A cluster that listens on a socket in its own folder, and nowhere else unless told.
pub(crate) struct Cluster {
    folder: tempfile::TempDir,
    /// The port of 127.0.0.1 on which it speaks encrypted, if it does.
    port: Option<u16>,
    /// Whether it waits for the disk.
    is_synced: bool,
}

impl Cluster {
    pub(crate) fn start() -> Self {
        Self::begin(false)
    }

    /// One that waits for the disk, as outside of tests.
    pub(crate) fn start_synced() -> Self {
        Self::begin(true)
    }

    fn begin(is_synced: bool) -> Self {
        let folder = tempfile::tempdir().unwrap();
        // The database server refuses to run as root, and its user must get here.
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        let cluster = Self {
            folder,
            port: None,
            is_synced,
        };
        fs::create_dir(cluster.home()).unwrap();
        if is_root() {
            run(Command::new("chown").arg("postgres").arg(cluster.home()));
        }
        let mut init = cluster.program("initdb");
        init.args(["--no-sync", "--auth=trust", "--username=memrep"])
            .args(["--encoding=UTF8", "--locale=C", "--pgdata"])
            .arg(cluster.data());
        run(&mut init);
        cluster.control(&["start"]);
        cluster
    }

    /// Starts it anew, so that it is on `localhost` too, for those alone who encrypt.
    /// The file has the certificate of whoever vouches for it.
    pub(crate) fn encrypt(&mut self) -> PathBuf {
        let authority = self.certify();
        let settings = self.data().join("postgresql.conf");
        let mut settings = fs::OpenOptions::new().append(true).open(settings).unwrap();
        writeln!(settings, "ssl = on").unwrap();
        let allowed = "local all all trust\nhostssl all all 127.0.0.1/32 trust\n";
        fs::write(self.data().join("pg_hba.conf"), allowed).unwrap();
        let free = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        self.port = Some(free.local_addr().unwrap().port());
        drop(free);
        self.control(&["restart", "--mode=fast"]);
        authority
    }

    /// A certificate for `localhost`, and the one that vouches for it.
    fn certify(&self) -> PathBuf {
        let folder = self.folder.path();
        let openssl = |arguments: &str| {
            let mut command = Command::new("openssl");
            run(command.args(arguments.split(' ')).current_dir(folder));
        };
        openssl(
            "req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 \
             -keyout authority.key -out authority.pem -subj /CN=authority",
        );
        openssl(
            "req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes \
             -keyout server.key -out server.csr -subj /CN=localhost",
        );
        fs::write(folder.join("names"), "subjectAltName = DNS:localhost\n").unwrap();
        openssl(
            "x509 -req -days 2 -in server.csr -CA authority.pem -CAkey authority.key \
             -CAcreateserial -extfile names -out server.crt",
        );
        for name in ["server.key", "server.crt"] {
            let within = self.data().join(name);
            fs::copy(folder.join(name), &within).unwrap();
            fs::set_permissions(&within, fs::Permissions::from_mode(0o600)).unwrap();
            if is_root() {
                run(Command::new("chown").arg("postgres").arg(&within));
            }
        }
        folder.join("authority.pem")
    }

    /// The port at which it speaks encrypted.
    pub(crate) fn port(&self) -> u16 {
        self.port.expect("it was told to encrypt")
    }

    fn home(&self) -> PathBuf {
        self.folder.path().join("home")
    }

    fn data(&self) -> PathBuf {
        self.home().join("data")
    }

    /// A program of the database's, as its user.
    fn program(&self, name: &str) -> Command {
        let path = binaries().join(name);
        let mut command = if is_root() {
            let mut command = Command::new("runuser");
            command.args(["-u", "postgres", "--"]).arg(path);
            command
        } else {
            Command::new(path)
        };
        command.current_dir(self.home());
        command
    }

    /// Starts or stops it, and waits until that is done.
    pub(crate) fn control(&self, action: &[&str]) {
        let home = self.home();
        let listen = match self.port {
            Some(port) => format!("-c listen_addresses=127.0.0.1 -p {port}"),
            None => "-c listen_addresses=''".to_owned(),
        };
        let sync = if self.is_synced { "on" } else { "off" };
        let options = format!("-k {} {listen} -c fsync={sync}", home.display());
        let mut control = self.program("pg_ctl");
        control
            .args(action)
            .args(["--wait", "--silent", "--pgdata"])
            .arg(self.data())
            .args(["--log", "log", "--options", &options]);
        run(&mut control);
    }

    /// The address of a new database.
    pub(crate) fn database(&self, name: &str) -> String {
        let mut create = self.program("createdb");
        create
            .args(["--username=memrep", "--host"])
            .arg(self.home())
            .arg(name);
        run(&mut create);
        let socket = self.home().display().to_string().replace('/', "%2F");
        format!("postgres://memrep@{socket}/{name}")
    }

    /// What a statement finds.
    pub(crate) fn ask(&self, database: &str, sql: &str) -> String {
        let mut psql = self.program("psql");
        psql.args(["--username=memrep", "--no-psqlrc", "-qAt", "--host"])
            .arg(self.home())
            .args(["--dbname", database, "--command", sql]);
        let output = psql.output().unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        let mut stop = self.program("pg_ctl");
        stop.args(["stop", "--mode=immediate", "--silent", "--pgdata"])
            .arg(self.data());
        // Stopped already where a test was about that.
        let _ = stop.stderr(Stdio::null()).status();
    }
}

fn is_root() -> bool {
    let id = Command::new("id").arg("-u").output().unwrap();
    id.stdout.starts_with(b"0\n")
}

/// Where the programs are: on the PATH, or where Debian has them.
fn binaries() -> PathBuf {
    let on_path = std::env::var_os("PATH").unwrap_or_default();
    let debian = fs::read_dir("/usr/lib/postgresql").into_iter().flatten();
    let debian = debian.flatten().map(|version| version.path().join("bin"));
    let folders = debian.chain(std::env::split_paths(&on_path));
    let has_all = |folder: &PathBuf| {
        ["initdb", "pg_ctl", "createdb", "psql"]
            .iter()
            .all(|name| folder.join(name).exists())
    };
    let mut found = folders.filter(has_all);
    found
        .next()
        .expect("these tests need PostgreSQL: apt-get install postgresql, or ./scripts/test")
}

fn run(command: &mut Command) {
    // A server that is started here must not hold on to the test's own output.
    let log = Path::new("/dev/null");
    let quiet = || Stdio::from(fs::OpenOptions::new().write(true).open(log).unwrap());
    let status = command.stdout(quiet()).stderr(quiet()).status().unwrap();
    assert!(status.success(), "{command:?}: {status}");
}
