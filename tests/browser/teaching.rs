//! A person who has a target automaton in mind and teaches it by the page.

use automata::{Alphabet, Dfa, Word};
use fantoccini::Client;
use memrep::evidence::Comparison;
use memrep::oracle::{ScriptedTeacher, Target, Teacher, TeacherSettings};

use crate::driver::Browser;
use crate::page::{Page, fill, press};

/// More questions than any of these tasks needs: a test ends even if the
/// learner does not.
pub(crate) const MANY: usize = 150;

/// Someone who knows the target.
pub(crate) struct Person {
    target: Dfa,
    teacher: ScriptedTeacher,
}

impl Person {
    /// Someone who has the target of this name in mind.
    pub(crate) fn thinking_of(name: &str) -> Self {
        let target = Target::named(name).unwrap();
        Self {
            target: target.dfa().clone(),
            teacher: ScriptedTeacher::new(&target, TeacherSettings::default()),
        }
    }

    /// The symbols.
    pub(crate) fn alphabet(&self) -> &Alphabet {
        self.target.alphabet()
    }

    /// Whether the word is in the target.
    pub(crate) fn accepts(&self, word: &Word) -> bool {
        self.target.accepts(word)
    }

    /// The value of the button that answers the page's comparison or judgement.
    pub(crate) fn opinion(&mut self, page: &Page) -> &'static str {
        let first = page.word(0, self.alphabet());
        if page.kind == "membership" {
            assert_eq!(page.words.len(), 1);
            return if self.teacher.membership(&first) {
                "accept"
            } else {
                "reject"
            };
        }
        assert_eq!((page.kind.as_str(), page.words.len()), ("comparison", 2));
        let second = page.word(1, self.alphabet());
        match self.teacher.comparison(&first, &second) {
            Comparison::First => "first",
            Comparison::Second => "second",
            Comparison::Equal => "equal",
            Comparison::Incomparable => "incomparable",
        }
    }

    /// A word that the rule on show treats wrongly, as one types it, and whether
    /// it should be accepted.
    pub(crate) fn objection(&mut self, page: &Page) -> Option<(String, bool)> {
        let rule = page.rule(self.alphabet());
        let (word, label) = self.teacher.counterexample(&rule)?;
        let names: Vec<&str> = self.alphabet().spell(&word).collect();
        Some((names.join(" "), label))
    }

    /// Answers what the page asks with the mouse.
    pub(crate) async fn answer(&mut self, client: &Client, page: &Page) -> Page {
        if page.kind == "equivalence" {
            let Some((word, label)) = self.objection(page) else {
                return page.click(client, "button[value=correct]").await;
            };
            fill(client, "#word", &word).await;
            press(
                client,
                &format!("#counterexample input[name=label][value=\"{label}\"]"),
            )
            .await;
            return page.click(client, "#teach").await;
        }
        let said = self.opinion(page);
        page.click(client, &format!("button[name=answer][value={said}]"))
            .await
    }

    /// Answers until the page is of this kind.
    pub(crate) async fn answer_until(
        &mut self,
        client: &Client,
        mut page: Page,
        kind: &str,
    ) -> Page {
        for _ in 0..MANY {
            if page.kind == kind {
                return page;
            }
            page = self.answer(client, &page).await;
        }
        panic!("no page of the kind {kind} after {MANY} answers: {page:?}");
    }

    /// Takes the automaton home from the last page; it must be the target.
    pub(crate) async fn take_home(&self, browser: &Browser) {
        press(&browser.client, "#download-json").await;
        let text = browser.downloaded(".json").await;
        let learned = automata::format::json::read(&text).unwrap().dfa;
        assert!(
            learned.is_equivalent(&self.target).unwrap(),
            "another language was learned: {text}"
        );
    }
}

/// Opens the start page and begins the ready task of this name.
pub(crate) async fn begin(browser: &Browser, start: &str, task: &str) -> Page {
    browser.client.goto(start).await.unwrap();
    let page = Page::now(&browser.client).await;
    assert_eq!(page.kind, "start");
    page.click(&browser.client, &format!("button[data-task=\"{task}\"]"))
        .await
}
