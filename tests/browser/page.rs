//! A page as the person sees it, and what can be done with it.

use automata::{Alphabet, Dfa, Word};
use fantoccini::{Client, Locator};
use serde::Deserialize;
use serde_json::Value;

use crate::driver::wait;

/// What is on the page; read in one piece, so that no half of it belongs to the
/// page before.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct Page {
    /// Which kind of page: `comparison`, `membership`, `equivalence`, `done`…
    pub(crate) kind: String,
    /// The number of the question that it asks.
    pub(crate) question: Option<String>,
    /// The words on show, their symbols with spaces between.
    pub(crate) words: Vec<String>,
    /// The rule on show, in the form that the page's script reads.
    rule: Option<String>,
    /// When it was first looked at: later for each that comes after, also where no
    /// page is loaded.
    born: f64,
    ready: bool,
    waiting: bool,
}

const READ: &str = r#"
    const main = document.querySelector("main[data-kind]");
    if (!main) return null;
    return {
        kind: main.dataset.kind,
        question: main.dataset.question ?? null,
        words: [...main.querySelectorAll("ol[data-word]")].map((word) => word.dataset.word),
        rule: main.querySelector("[data-rule]")?.dataset.rule ?? null,
        born: main.born ??= performance.timeOrigin + performance.now(),
        ready: document.readyState === "complete",
        waiting: main.dataset.kind === "wait",
    };
"#;

/// A rule as the page's script reads it.
#[derive(Deserialize)]
struct Rule {
    start: usize,
    accepting: Vec<bool>,
    delta: Vec<Vec<usize>>,
}

impl Page {
    /// The page that is shown now, once it is there.
    pub(crate) async fn now(client: &Client) -> Self {
        Self::when(client, |_| true).await
    }

    /// The page that comes after this one.
    pub(crate) async fn next(&self, client: &Client) -> Self {
        Self::when(client, |page| page.born > self.born).await
    }

    async fn when(client: &Client, fits: impl Fn(&Self) -> bool) -> Self {
        wait("a page", async || {
            // Between two pages there is nothing to run a script in.
            let read = client.execute(READ, Vec::new()).await.ok()?;
            let page: Self = serde_json::from_value::<Option<Self>>(read).unwrap()?;
            (page.ready && !page.waiting && fits(&page)).then_some(page)
        })
        .await
    }

    /// The word at this place on the page.
    pub(crate) fn word(&self, place: usize, alphabet: &Alphabet) -> Word {
        let word = self.words.get(place);
        let word = word.unwrap_or_else(|| panic!("no word at {place}: {self:?}"));
        alphabet.word(word.split_whitespace()).unwrap()
    }

    /// The rule on show.
    pub(crate) fn rule(&self, alphabet: &Alphabet) -> Dfa {
        let rule: Rule = serde_json::from_str(self.rule.as_ref().unwrap()).unwrap();
        Dfa::new(alphabet.clone(), rule.start, rule.accepting, &rule.delta).unwrap()
    }

    /// What it asks, whatever the number under which it does.
    pub(crate) fn asks(&self) -> (&str, &[String]) {
        (&self.kind, &self.words)
    }

    /// Clicks what the selector finds first, and waits for the page to which
    /// that leads.
    pub(crate) async fn click(&self, client: &Client, selector: &str) -> Self {
        press(client, selector).await;
        self.next(client).await
    }
}

/// Clicks what the selector finds first.
pub(crate) async fn press(client: &Client, selector: &str) {
    let element = client.find(Locator::Css(selector)).await;
    let element = element.unwrap_or_else(|e| panic!("{selector}: {e}"));
    let clicked = element.click().await;
    clicked.unwrap_or_else(|e| panic!("{selector}: {e}"));
}

/// Empties a field and types `text` into it.
pub(crate) async fn fill(client: &Client, selector: &str, text: &str) {
    let field = client.find(Locator::Css(selector)).await;
    let field = field.unwrap_or_else(|e| panic!("{selector}: {e}"));
    field.clear().await.unwrap();
    field.send_keys(text).await.unwrap();
}

/// The text that a person reads in what the selector finds.
pub(crate) async fn texts(client: &Client, selector: &str) -> Vec<String> {
    // In one piece: what is found might be gone before it is read.
    let read = "return [...document.querySelectorAll(arguments[0])].map((one) => one.checkVisibility() ? one.innerText.trim() : '')";
    let texts = client.execute(read, vec![selector.into()]).await.unwrap();
    serde_json::from_value(texts).unwrap()
}

/// What a field holds now.
pub(crate) async fn typed(client: &Client, selector: &str) -> String {
    let field = client.find(Locator::Css(selector)).await.unwrap();
    field.prop("value").await.unwrap().unwrap_or_default()
}

/// The value of a script that takes no argument.
pub(crate) async fn script(client: &Client, body: &str) -> Value {
    client.execute(body, Vec::new()).await.unwrap()
}
