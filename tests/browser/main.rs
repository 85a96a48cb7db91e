//! A person at a real browser before the real server: teaches, errs, is
//! interrupted, and takes the automaton home.
//!
//! With `MEMREP_SCREENSHOTS=DIR` in the environment the pictures of the README
//! are written there.
#![cfg(feature = "server")]

mod axe;
mod cards;
mod check;
mod conflict;
mod driver;
mod drives;
mod hostile;
mod house;
mod page;
mod people;
mod pictures;
mod recordings;
mod robot;
mod stopwatch;
mod studio;
mod tabs;
mod teaching;
mod walks;

use driver::{Browser, Wishes, with};
use fantoccini::Locator;
use fantoccini::key::Key;
use house::House;
use page::{Page, fill, press, script, texts, typed};
use serde_json::Value;
use teaching::{MANY, Person, begin};

/// Teaches the task, while the server is killed after some answers.
async fn teach_through_a_crash(browser: &Browser, task: &str, before: usize) {
    let client = &browser.client;
    let mut house = House::build();
    let mut person = Person::thinking_of(task);
    let mut page = begin(browser, &house.at("/"), task).await;
    for _ in 0..before {
        page = person.answer(client, &page).await;
        assert_ne!(page.kind, "done", "the crash comes too late");
    }
    let session = client.current_url().await.unwrap().path().to_owned();
    let answered = texts(client, "#history-link").await;

    house.strike();
    client.goto(&house.at(&session)).await.unwrap();
    let again = Page::now(client).await;
    assert_eq!(again.asks(), page.asks());
    assert_eq!(again.question, page.question);
    assert_eq!(texts(client, "#history-link").await, answered);

    page = again;
    for _ in 0..MANY {
        if page.kind == "done" {
            person.take_home(browser).await;
            return;
        }
        page = person.answer(client, &page).await;
    }
    panic!("no rule after {MANY} questions: {page:?}");
}

#[tokio::test]
async fn tomita_5_is_taught_by_clicking_through_a_crash() {
    with(Wishes::default(), async |browser| {
        teach_through_a_crash(browser, "tomita:5", 10).await;
    })
    .await;
}

#[tokio::test]
async fn the_robot_is_taught_by_clicking_through_a_crash() {
    with(Wishes::default(), async |browser| {
        teach_through_a_crash(browser, "robot", 12).await;
    })
    .await;
}

/// A key without a letter, as a browser is sent it.
fn named(key: Key) -> String {
    char::from(key).to_string()
}

/// Presses a key wherever the focus is.
async fn strike_key(browser: &Browser, key: &str) {
    let focus = browser.client.active_element().await.unwrap();
    focus.send_keys(key).await.unwrap();
}

/// Goes on with the tabulator until the focus is on what the selector finds.
async fn tab_to(browser: &Browser, selector: &str) {
    let reached = format!("return document.activeElement.matches({selector:?})");
    for _ in 0..150 {
        if script(&browser.client, &reached).await == Value::Bool(true) {
            return;
        }
        strike_key(browser, &named(Key::Tab)).await;
    }
    panic!("{selector} cannot be reached with the tabulator");
}

#[tokio::test]
async fn taking_back_brings_the_same_question_again() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let mut person = Person::thinking_of("tomita:5");
        let first = begin(browser, &house.at("/"), "tomita:5").await;
        let second = person.answer(client, &first).await;
        let third = person.answer(client, &second).await;
        assert_ne!(third.asks(), second.asks());

        let back = third.click(client, "#undo").await;
        assert_eq!(back.asks(), second.asks());
        strike_key(browser, "u").await;
        let back = back.next(client).await;
        assert_eq!(back.asks(), first.asks());
        let none = client.find_all(Locator::Css("#undo")).await.unwrap();
        assert!(none.is_empty(), "nothing is left to take back");

        let again = person.answer(client, &back).await;
        assert_eq!(again.asks(), second.asks());
    })
    .await;
}

#[tokio::test]
async fn a_lie_is_found_shown_small_and_mended() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let mut person = Person::thinking_of("tomita:5");
        let mut page = begin(browser, &house.at("/"), "tomita:5").await;

        // The first comparison of an acceptable word with another is answered
        // the wrong way round, everything else truly.
        let lie = loop {
            if page.kind == "comparison" {
                let [a, b] = [0, 1].map(|i| person.accepts(&page.word(i, person.alphabet())));
                if a != b {
                    break page.question.clone().unwrap();
                }
            }
            page = person.answer(client, &page).await;
        };
        let truth = person.opinion(&page);
        let wrong = if truth == "first" { "second" } else { "first" };
        page = page
            .click(client, &format!("button[name=answer][value={wrong}]"))
            .await;
        let page = person.answer_until(client, page, "conflict").await;

        let cards = conflict::cards(client).await;
        assert!(!conflict::can_be_true(&cards), "{cards:?}");
        for leave_out in 0..cards.len() {
            let mut rest = cards.clone();
            rest.remove(leave_out);
            assert!(
                conflict::can_be_true(&rest),
                "not minimal: {cards:?} without number {leave_out}"
            );
        }
        assert!(cards.iter().any(|card| card.number == lie), "{cards:?}");

        let mend = format!("#answer-{lie} button[name=answer][value={truth}]");
        let page = page.click(client, &mend).await;
        assert_ne!(page.kind, "conflict");
        person.answer_until(client, page, "done").await;
        person.take_home(browser).await;
    })
    .await;
}

#[tokio::test]
async fn a_fault_in_an_own_task_is_told_where_it_is_and_loses_nothing() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        client.goto(&house.at("/")).await.unwrap();
        let mut page = Page::now(client).await;
        let title = "<script>document.title = 'taken'</script> \"tea\" & 'milk'";
        let markup = "<img src=x onerror=alert(1)>";
        for (symbols, examples, field, told) in [
            ("water tea", "+ water coffee", "#examples", "`coffee`"),
            ("water tea", "+ tea\nwater", "#examples", "line 2"),
            ("water water", "+ water", "#symbols", "`water`"),
            (markup, "+ water", "#symbols", "letters, digits"),
            (",", "+ water", "#symbols", "Name the things"),
        ] {
            fill(client, "#title", title).await;
            fill(client, "#symbols", symbols).await;
            fill(client, "#examples", examples).await;
            page = page.click(client, "#own-task button.primary").await;
            assert_eq!(page.kind, "start");
            let shown = texts(client, "#own-task [role=alert]").await.concat();
            let said = shown.to_lowercase();
            assert!(said.contains(&told.to_lowercase()), "{told}: {shown}");
            // The message stands at the field that it speaks of, for eyes and
            // for readers of screens.
            let described = format!(
                "const field = document.querySelector({field:?});
                 const alert = document.querySelector('#own-task [role=alert]');
                 const near = field.closest('p').contains(alert)
                     || field.closest('p').previousElementSibling === alert
                     || field.closest('p').nextElementSibling === alert;
                 const ids = (field.getAttribute('aria-describedby') ?? '').split(' ');
                 return near && ids.includes(alert.id)
                     && field.getAttribute('aria-invalid') === 'true';"
            );
            assert_eq!(
                script(client, &described).await,
                Value::Bool(true),
                "{shown} does not belong to {field}"
            );
            assert_eq!(typed(client, "#title").await, title);
            assert_eq!(typed(client, "#symbols").await, symbols);
            assert_eq!(typed(client, "#examples").await, examples);
            assert!(client.title().await.unwrap().ends_with("memrep"));
        }

        fill(client, "#symbols", "water tea").await;
        fill(client, "#examples", "+ tea water\n- tea").await;
        page = page.click(client, "#own-task button.primary").await;
        assert!(["comparison", "membership"].contains(&page.kind.as_str()));
        let shown = texts(client, ".bar-task").await.concat();
        assert_eq!(shown, title, "a title is text, whatever it looks like");
        press(client, "#history-link").await;
    })
    .await;
}
