//! No page breaks a rule of accessibility that axe-core knows; `MEMREP_AXE` names its
//! file, which `scripts/test` fetches.

use fantoccini::Client;
use serde_json::Value;

use crate::conflict;
use crate::driver::{Browser, Wishes, with};
use crate::house::House;
use crate::page::{Page, fill, press};
use crate::studio::open;
use crate::teaching::{MANY, Person, begin};

const RUN: &str = r#"
    const done = arguments[arguments.length - 1];
    // What is touched is 24 pixels wide and high, which is not asked by default.
    const rules = {"target-size": {enabled: true}};
    axe.run({rules}).then(({violations, passes}) => done({
        passed: passes.length,
        violations: violations.map(({id, nodes}) =>
            `${id}: ${nodes.slice(0, 4).map((node) => `${node.target} ${node.failureSummary}`).join("; ")}`),
    }), (error) => done({passed: 0, violations: [String(error)]}));
"#;

/// The rules, as a script.
fn rules() -> String {
    let fetched = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/target/test-axe/4.14.1/axe.min.js"
    );
    let path = std::env::var("MEMREP_AXE").unwrap_or_else(|_| fetched.to_owned());
    std::fs::read_to_string(&path)
        .unwrap_or_else(|e| panic!("{path}: {e}; run ./scripts/test, which fetches axe-core"))
}

/// The page that is shown breaks no rule.
async fn holds(client: &Client, rules: &str, page: &str) {
    // As a function body it would keep its names to itself.
    let whole = format!("{rules}; window.axe = window.axe ?? axe;");
    client.execute(&whole, Vec::new()).await.unwrap();
    let found: Value = client.execute_async(RUN, Vec::new()).await.unwrap();
    let none = found["violations"].as_array().is_some_and(Vec::is_empty);
    assert!(none, "{page}: {found:#}");
    assert!(found["passed"].as_u64() > Some(5), "{page}: {found}");
}

/// All kinds of pages.
async fn all_hold(wishes: Wishes) {
    let rules = rules();
    with(wishes, async |browser| {
        let client = &browser.client;
        let house = House::build();
        client.goto(&house.at("/")).await.unwrap();
        holds(client, &rules, "start").await;
        press(client, ".uploads summary").await;
        fill(client, "#symbols", "water water").await;
        press(client, "#own-task button.primary").await;
        Page::now(client).await;
        holds(client, &rules, "start with a fault").await;
        client.goto(&house.at("/nothing")).await.unwrap();
        holds(client, &rules, "error").await;
        for task in ["robot-recharge", "car", "four-buttons"] {
            let page = begin(browser, &house.at("/"), task).await;
            holds(client, &rules, task).await;
            let session = client.current_url().await.unwrap().path().to_owned();
            page.click(client, "#answer-form .pad button").await;
            holds(client, &rules, &format!("{task}, answered")).await;
            for part in ["history", "practice", "why", "people"] {
                client
                    .goto(&house.at(&format!("{session}/{part}")))
                    .await
                    .unwrap();
                holds(client, &rules, &format!("{task} {part}")).await;
            }
        }
        studio_holds(client, &house, &rules).await;
        rule_holds(browser, &house, &rules).await;
    })
    .await;
}

/// The studio: empty, with a map to paint, with a fault, and the recordings after it.
async fn studio_holds(client: &Client, house: &House, rules: &str) {
    let robot = include_str!("../../examples/tasks/robot-recharge.toml");
    let recorded = "name = \"runs\"\ntitle = \"Runs\"\n[world]\nkind = \"pool\"\n\
        [[symbols]]\nname = \"water\"\n[[symbols]]\nname = \"dryer\"\n";
    client.goto(&house.at("/studio")).await.unwrap();
    holds(client, rules, "studio").await;
    let page = Page::now(client).await;
    let page = page
        .click(client, ".studio-actions button[value=check]")
        .await;
    holds(client, rules, "studio with faults").await;
    open(client, robot).await;
    page.next(client).await;
    holds(client, rules, "studio with a map").await;
    open(client, recorded).await;
    let page = Page::now(client).await;
    let page = page
        .click(client, ".studio-actions button[value=begin]")
        .await;
    assert_eq!(page.kind, "recordings");
    holds(client, rules, "recordings").await;
}

/// The pages of a rule: the check, a contradiction, the result.
async fn rule_holds(browser: &Browser, house: &House, rules: &str) {
    let client = &browser.client;
    let mut person = Person::thinking_of("tomita:1");
    let page = begin(browser, &house.at("/"), "tomita:1").await;
    let page = person.answer_until(client, page, "equivalence").await;
    holds(client, rules, "equivalence").await;
    person.answer_until(client, page, "done").await;
    holds(client, rules, "done").await;
    let mut person = Person::thinking_of("tomita:5");
    let mut page = begin(browser, &house.at("/"), "tomita:5").await;
    let mut lied = false;
    for _ in 0..MANY {
        if page.kind == "conflict" {
            assert!(!conflict::cards(client).await.is_empty());
            holds(client, rules, "conflict").await;
            return;
        }
        let differ = page.kind == "comparison"
            && person.accepts(&page.word(0, person.alphabet()))
                != person.accepts(&page.word(1, person.alphabet()));
        page = if differ && !lied {
            lied = true;
            let wrong = if person.opinion(&page) == "first" {
                "second"
            } else {
                "first"
            };
            page.click(client, &format!("button[name=answer][value={wrong}]"))
                .await
        } else {
            person.answer(client, &page).await
        };
    }
    panic!("a lie led to no contradiction: {page:?}");
}

const WIDE: (u32, u32) = (1280, 960);
const PHONE: (u32, u32) = (360, 740);

/// In a window of this size.
fn wishes(size: (u32, u32), dark: bool) -> Wishes {
    Wishes {
        size: Some(size),
        dark,
        ..Wishes::default()
    }
}

#[tokio::test]
async fn no_page_breaks_a_rule_of_accessibility() {
    all_hold(wishes(WIDE, false)).await;
}

#[tokio::test]
async fn no_page_breaks_a_rule_of_accessibility_in_the_dark() {
    all_hold(wishes(WIDE, true)).await;
}

#[tokio::test]
async fn no_page_breaks_a_rule_of_accessibility_on_a_phone() {
    all_hold(wishes(PHONE, false)).await;
}

#[tokio::test]
async fn no_page_breaks_a_rule_of_accessibility_on_a_phone_in_the_dark() {
    all_hold(wishes(PHONE, true)).await;
}
