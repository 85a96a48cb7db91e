//! A headless Chromium of its own for each test, driven by `chromedriver`.

use std::future::poll_fn;
use std::io::{BufRead, BufReader};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::{Path, PathBuf};
use std::pin::pin;
use std::process::{Child, Command, Stdio};
use std::task::Poll;
use std::time::{Duration, Instant};

use fantoccini::wd::Capabilities;
use fantoccini::{Client, ClientBuilder};
use hyper_util::client::legacy::connect::HttpConnector;
use serde_json::json;
use tempfile::TempDir;

/// How long anything may take that is waited for: far more than it needs, since
/// the machine may be busy with other tests.
pub(crate) const PATIENCE: Duration = Duration::from_secs(30);

/// How often a condition is looked at again.
const PERIOD: Duration = Duration::from_millis(15);

/// What tells a reader of a failed test what to do.
const REMEDY: &str =
    "run ./scripts/test, which says what the browser tests need (chromium and chromium-driver)";

/// The names that Chromium has on different systems.
const BROWSERS: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome-stable",
    "google-chrome",
];

/// How a browser differs from the usual one.
#[derive(Clone, Copy, Default)]
pub(crate) struct Wishes {
    /// No page may run a script.
    pub(crate) without_script: bool,
    /// Pages are shown in their dark colours.
    pub(crate) dark: bool,
    /// Motion is welcome.
    pub(crate) moving: bool,
    /// The width and height of a page in pixels, if they matter.
    pub(crate) size: Option<(u32, u32)>,
}

/// A running browser.
pub(crate) struct Browser {
    /// What commands it.
    pub(crate) client: Client,
    folder: TempDir,
    driver: Driver,
}

/// The `chromedriver` process; it ends with its value.
struct Driver(Child);

impl Drop for Driver {
    fn drop(&mut self) {
        // Already gone where it was waited for.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Browser {
    /// Starts one.
    pub(crate) async fn start(wishes: Wishes) -> Self {
        let (driver, address) = start_driver();
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("downloads")).unwrap();
        let capabilities = capabilities(folder.path(), wishes);
        let client = ClientBuilder::new(HttpConnector::new())
            .capabilities(capabilities)
            .connect(&address)
            .await
            .unwrap_or_else(|e| panic!("Chromium does not start: {e}; {REMEDY}"));
        Self {
            client,
            folder,
            driver,
        }
    }

    /// The file of this name that the page has given to the person, once it is
    /// there as a whole.
    pub(crate) async fn downloaded(&self, suffix: &str) -> String {
        let folder = self.folder.path().join("downloads");
        wait("the download", async || {
            let files = std::fs::read_dir(&folder).unwrap();
            let path = files
                .map(|entry| entry.unwrap().path())
                .find(|path| path.to_string_lossy().ends_with(suffix))?;
            // Chromium takes the name with an empty file, writes under another,
            // and renames that at the end.
            let text = std::fs::read_to_string(path).unwrap();
            (!text.is_empty()).then_some(text)
        })
        .await
    }

    /// Ends it.
    async fn stop(self) {
        // Nothing more is asked of it, and the processes end in any case.
        let _ = self.client.close().await;
        drop(self.driver);
    }
}

/// Runs `test` with a browser, which ends whatever becomes of the test: Chromium
/// would go on after a panic.
pub(crate) async fn with(wishes: Wishes, test: impl AsyncFnOnce(&Browser)) {
    let browser = Browser::start(wishes).await;
    let outcome = {
        let mut running = pin!(test(&browser));
        poll_fn(
            |context| match catch_unwind(AssertUnwindSafe(|| running.as_mut().poll(context))) {
                Ok(Poll::Pending) => Poll::Pending,
                Ok(Poll::Ready(())) => Poll::Ready(Ok(())),
                Err(panic) => Poll::Ready(Err(panic)),
            },
        )
        .await
    };
    if outcome.is_err() {
        let at = browser.client.current_url().await;
        let source = browser.client.source().await;
        eprintln!("The browser was at {at:?}:\n{}", source.unwrap_or_default());
    }
    browser.stop().await;
    if let Err(panic) = outcome {
        resume_unwind(panic);
    }
}

/// Waits until `look` finds something.
pub(crate) async fn wait<T>(what: &str, mut look: impl AsyncFnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = look().await {
            return found;
        }
        assert!(begun.elapsed() < PATIENCE, "waited in vain for {what}");
        tokio::time::sleep(PERIOD).await;
    }
}

/// `chromedriver` on a port that it chooses, and its address.
fn start_driver() -> (Driver, String) {
    let child = Command::new("chromedriver")
        .arg("--port=0")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap_or_else(|e| panic!("chromedriver cannot be started: {e}; {REMEDY}"));
    let mut driver = Driver(child);
    let mut lines = BufReader::new(driver.0.stdout.take().unwrap()).lines();
    let port = lines
        .by_ref()
        .map_while(Result::ok)
        .find_map(|line| {
            // An earlier line repeats the 0 of the command line.
            let port = line.trim_end_matches('.').rsplit_once("on port ")?.1;
            port.parse::<u16>().ok().filter(|port| *port != 0)
        })
        .unwrap_or_else(|| panic!("chromedriver did not say its port; {REMEDY}"));
    // A full pipe would stop it.
    std::thread::spawn(move || lines.for_each(drop));
    (driver, format!("http://127.0.0.1:{port}"))
}

/// What Chromium is told at its start.
fn capabilities(folder: &Path, wishes: Wishes) -> Capabilities {
    let (width, height) = wishes.size.unwrap_or((1280, 800));
    let mut arguments: Vec<String> = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-quic",
        "--disable-dev-shm-usage",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--disable-extensions",
        // A page that is kept alive for going back costs a process.
        "--disable-features=BackForwardCache,RenderDocument",
        "--no-first-run",
        "--hide-scrollbars",
        "--force-color-profile=srgb",
    ]
    .map(str::to_owned)
    .into();
    arguments.push(format!("--user-data-dir={}", folder.join("user").display()));
    arguments.push(format!("--window-size={width},{height}"));
    if !wishes.moving {
        arguments.push("--force-prefers-reduced-motion".to_owned());
    }
    if wishes.dark {
        arguments.push("--blink-settings=preferredColorScheme=0".to_owned());
    }
    let mut preferences = json!({
        "download.default_directory": folder.join("downloads"),
        "download.prompt_for_download": false,
    });
    if wishes.without_script {
        // 2 is "block" among the settings of content.
        preferences["profile.managed_default_content_settings.javascript"] = json!(2);
    }
    let options = json!({
        "goog:chromeOptions": {
            "binary": chromium(),
            "args": arguments,
            "prefs": preferences,
        },
    });
    options.as_object().unwrap().clone()
}

/// Where Chromium is.
fn chromium() -> PathBuf {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    BROWSERS
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .find(|file| file.is_file())
        .unwrap_or_else(|| panic!("there is no Chromium on the PATH; {REMEDY}"))
}
