//! One session in two windows of one browser: they never show two truths.

use serde_json::json;

use crate::driver::{Wishes, wait, with};
use crate::house::House;
use crate::page::{Page, press, script, texts};
use crate::teaching::begin;

#[tokio::test]
async fn an_answer_in_one_window_shows_in_the_other() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let first = begin(browser, &house.at("/"), "robot-recharge").await;
        let address = client.current_url().await.unwrap();
        let one = client.window().await.unwrap();
        script(client, "window.kept = true").await;

        let other = client.new_window(false).await.unwrap().handle;
        client.switch_to_window(other.clone()).await.unwrap();
        client.goto(address.as_str()).await.unwrap();
        let page = Page::now(client).await;
        assert_eq!(page.question, first.question);
        let second = page.click(client, "#answer-form .pad button").await;
        assert_ne!(second.question, first.question);

        // The first window follows, without a load.
        client.switch_to_window(one.clone()).await.unwrap();
        let shown = wait("the next question", async || {
            let page = Page::now(client).await;
            (page.question == second.question).then_some(page)
        })
        .await;
        assert_eq!(shown.words, second.words);
        assert_eq!(script(client, "return window.kept").await, json!(true));
        assert_eq!(
            texts(client, "#history-link").await,
            ["1 answered".to_owned()]
        );

        // What is taken back here is taken back there.
        press(client, "#undo").await;
        shown.next(client).await;
        client.switch_to_window(other).await.unwrap();
        wait("the first question", async || {
            let page = Page::now(client).await;
            (page.asks() == first.asks()).then_some(())
        })
        .await;
    })
    .await;
}

#[tokio::test]
async fn an_answer_to_a_question_that_is_closed_elsewhere_counts_for_nothing() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let first = begin(browser, &house.at("/"), "robot-recharge").await;
        // Without news the window stays at its question.
        script(
            client,
            "document.querySelector('header.bar').removeAttribute('data-live');
             document.dispatchEvent(new Event('visibilitychange'));",
        )
        .await;
        let address = client.current_url().await.unwrap();
        let one = client.window().await.unwrap();
        let other = client.new_window(false).await.unwrap().handle;
        client.switch_to_window(other).await.unwrap();
        client.goto(address.as_str()).await.unwrap();
        let page = Page::now(client).await;
        let second = page.click(client, "#answer-form .pad button").await;

        client.switch_to_window(one).await.unwrap();
        let stale = Page::now(client).await;
        assert_eq!(stale.question, first.question);
        let after = stale
            .click(client, "#answer-form .pad button:last-of-type")
            .await;
        assert_eq!(after.question, second.question, "the open one is shown");
        let told = texts(client, ".notice").await.concat();
        assert!(told.contains("closed"), "{told}");
    })
    .await;
}
