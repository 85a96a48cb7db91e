//! The robot's whole task as its guidelines put it, from the start page to the file with
//! the automaton: by mouse, by keyboard alone, without script, on a phone.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use automata::Dfa;
use fantoccini::key::Key;
use fantoccini::{Client, Locator};
use memrep::oracle::{SituatedTeacher, Target, Teacher, TeacherSettings};
use memrep::task::TaskFile;
use serde_json::{Value, json};

use crate::driver::{Browser, Wishes, with};
use crate::house::House;
use crate::page::{Page, fill, press, script, typed};
use crate::teaching::{MANY, begin};
use crate::{named, strike_key, tab_to};

/// What is pressed from the start page to the file at most.
const MOST: usize = 30;

/// Someone who has read the guidelines.
pub(crate) struct Reader {
    target: Dfa,
    teacher: SituatedTeacher,
}

impl Reader {
    pub(crate) fn new() -> Self {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tasks/robot-recharge.toml");
        let file = TaskFile::open(&file).unwrap();
        let situation = file.universe.situation().unwrap();
        let (world, open) = (Arc::clone(&situation.world), situation.prior.open().clone());
        let target = Target::named("robot").unwrap();
        Self {
            target: target.dfa().clone(),
            teacher: SituatedTeacher::new(world, open, &target, TeacherSettings::default()),
        }
    }

    /// Of two walks an acceptable one is better than one that is not, and others are
    /// equally good or bad.
    pub(crate) fn opinion(&self, page: &Page) -> &'static str {
        let accepts = |place: usize| {
            self.target
                .accepts(&page.word(place, self.target.alphabet()))
        };
        match (page.kind.as_str(), page.words.len()) {
            ("membership", 1) if accepts(0) => "accept",
            ("membership", 1) => "reject",
            ("comparison", 2) => match (accepts(0), accepts(1)) {
                (true, false) => "first",
                (false, true) => "second",
                _ => "equal",
            },
            _ => panic!("{page:?} asks nothing"),
        }
    }

    /// What the rule on show treats wrongly, symbol by symbol, and what it should say.
    pub(crate) fn objection(&mut self, page: &Page) -> Option<(Vec<String>, bool)> {
        let alphabet = self.target.alphabet();
        let (word, label) = self.teacher.counterexample(&page.rule(alphabet))?;
        let names = alphabet.spell(&word).map(str::to_owned).collect();
        Some((names, label))
    }

    /// The file is there, and is the automaton.
    pub(crate) async fn has_it(&self, browser: &Browser) {
        let text = browser.downloaded(".json").await;
        let learned = automata::format::json::read(&text).unwrap().dfa;
        assert!(learned.is_equivalent(&self.target).unwrap(), "{text}");
    }

    /// Teaches by mouse from this question on, thinking so long about each; how often
    /// something was pressed.
    pub(crate) async fn teach(&mut self, client: &Client, page: Page, think: Duration) -> usize {
        let mut page = page;
        let mut clicks = 0;
        for _ in 0..MANY {
            tokio::time::sleep(think).await;
            let objection = match page.kind.as_str() {
                "done" => return clicks,
                "equivalence" => Some(self.objection(&page)),
                _ => None,
            };
            clicks += 1;
            page = match objection {
                None => {
                    let said = self.opinion(&page);
                    let button = format!("button[name=answer][value={said}]");
                    page.click(client, &button).await
                }
                Some(None) => {
                    press(client, "#looked").await;
                    clicks += 1;
                    page.click(client, ".agree button[value=correct]").await
                }
                Some(Some((names, label))) => {
                    for name in &names {
                        let chip = format!("#chip-buttons [data-append=\"{name}\"]");
                        press(client, &chip).await;
                    }
                    clicks += names.len();
                    // What it should say is chosen by what was pressed.
                    let chosen = format!("input[name=label][value=\"{label}\"]:checked");
                    let chosen = client.find(Locator::Css(&chosen)).await;
                    chosen.expect("the other label is chosen");
                    page.click(client, "#teach").await
                }
            };
        }
        panic!("no rule after {MANY} questions: {page:?}");
    }
}

/// All of the task by mouse, counted.
async fn by_mouse(wishes: Wishes) {
    with(wishes, async |browser| {
        let client = &browser.client;
        let house = House::build();
        let mut reader = Reader::new();
        let page = begin(browser, &house.at("/"), "robot-recharge").await;
        let clicks = 1 + reader.teach(client, page, Duration::ZERO).await;
        press(client, "#download-json").await;
        reader.has_it(browser).await;
        let clicks = clicks + 1;
        println!("{clicks} clicks");
        assert!(clicks <= MOST, "{clicks} clicks");
        let wide = "return document.documentElement.scrollWidth > innerWidth";
        assert_eq!(script(client, wide).await, json!(false));
    })
    .await;
}

#[tokio::test]
async fn the_robot_takes_at_most_thirty_clicks() {
    by_mouse(Wishes::default()).await;
}

#[tokio::test]
async fn the_robot_is_taught_on_a_phone() {
    by_mouse(Wishes {
        size: Some((360, 740)),
        ..Wishes::default()
    })
    .await;
}

#[tokio::test]
async fn the_robot_is_taught_without_script() {
    let wishes = Wishes {
        without_script: true,
        ..Wishes::default()
    };
    with(wishes, async |browser| {
        let client = &browser.client;
        let house = House::build();
        let mut reader = Reader::new();
        let mut page = begin(browser, &house.at("/"), "robot-recharge").await;
        let keys = client.find(Locator::Css("#keys-button")).await.unwrap();
        assert!(!keys.is_displayed().await.unwrap(), "a script has run");
        for _ in 0..MANY {
            if page.kind == "done" {
                press(client, "#download-json").await;
                reader.has_it(browser).await;
                return;
            }
            let selector = if page.kind != "equivalence" {
                format!("button[name=answer][value={}]", reader.opinion(&page))
            } else if let Some((names, label)) = reader.objection(&page) {
                fill(client, "#word", &names.join(" ")).await;
                let label = format!("#counterexample input[name=label][value=\"{label}\"]");
                press(client, &label).await;
                "#teach".to_owned()
            } else {
                press(client, "#looked").await;
                ".agree button[value=correct]".to_owned()
            };
            page = page.click(client, &selector).await;
        }
        panic!("no rule after {MANY} questions");
    })
    .await;
}

/// The key that a button shows, and what presses it.
async fn shown_key(client: &Client, answer: &str) -> String {
    let shown = format!("return document.querySelector('button[value={answer}] kbd').textContent");
    match script(client, &shown).await.as_str().unwrap() {
        "←" => named(Key::Left),
        "→" => named(Key::Right),
        "↑" => named(Key::Up),
        "↓" => named(Key::Down),
        letter => letter.to_lowercase(),
    }
}

#[tokio::test]
async fn the_robot_is_taught_by_keyboard_alone() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let mut reader = Reader::new();
        client.goto(&house.at("/")).await.unwrap();
        let start = Page::now(client).await;
        let enter = named(Key::Enter);
        tab_to(browser, "button[data-task=\"robot-recharge\"]").await;
        strike_key(browser, &enter).await;
        let mut page = start.next(client).await;
        let mut played = false;
        for _ in 0..MANY {
            match page.kind.as_str() {
                "done" => {
                    tab_to(browser, "#download-json").await;
                    strike_key(browser, &enter).await;
                    reader.has_it(browser).await;
                    assert!(played);
                    return;
                }
                "equivalence" => match reader.objection(&page) {
                    None => {
                        tab_to(browser, "#looked").await;
                        strike_key(browser, " ").await;
                        // The button stands before what it is about.
                        let back = Key::Shift + &named(Key::Tab);
                        strike_key(browser, &back).await;
                        let focused = "return document.activeElement.value";
                        assert_eq!(script(client, focused).await, json!("correct"));
                        strike_key(browser, &enter).await;
                    }
                    Some((names, _)) => {
                        tab_to(browser, "#word").await;
                        strike_key(browser, &names.join(" ")).await;
                        assert_eq!(typed(client, "#word").await, names.join(" "));
                        strike_key(browser, &enter).await;
                    }
                },
                _ => {
                    if !played {
                        played = true;
                        plays_by_key(browser).await;
                    }
                    let key = shown_key(client, reader.opinion(&page)).await;
                    strike_key(browser, &key).await;
                }
            }
            page = page.next(client).await;
        }
        panic!("no rule after {MANY} questions");
    })
    .await;
}

/// The walks are played and stopped from the keyboard.
async fn plays_by_key(browser: &Browser) {
    let told = "return document.querySelector('.play-button').getAttribute('aria-pressed')";
    for pressed in ["true", "false"] {
        strike_key(browser, " ").await;
        assert_eq!(
            script(&browser.client, told).await,
            Value::from(pressed),
            "the space bar plays and stops"
        );
    }
}
