//! The question's card as a person uses it: it plays, listens to keys while it has the
//! focus, and lets the last answers be withdrawn.

use fantoccini::Client;
use serde_json::{Value, json};

use crate::driver::{Browser, Wishes, wait, with};
use crate::house::House;
use crate::page::{Page, press, script, texts};
use crate::teaching::begin;

/// What the player of the card says.
const PLAYER: &str = r##"
    const card = document.querySelector("#answer-form");
    const slider = card.querySelector(".scrubber");
    return {
        step: Number(slider.value),
        last: Number(slider.max),
        plays: card.querySelector(".play-button").textContent.includes("Pause"),
        at: card.querySelector(".scene .token").getAttribute("transform"),
        speed: card.querySelector("[data-speed][aria-pressed=true]").dataset.speed,
        marked: card.querySelector(".parts-mark") !== null,
    };
"##;

async fn player(client: &Client) -> Value {
    script(client, PLAYER).await
}

async fn strike(client: &Client, key: &str) {
    let focus = client.active_element().await.unwrap();
    focus.send_keys(key).await.unwrap();
}

/// Answers the robot's questions until one compares two walks.
async fn compared(browser: &Browser, house: &House) -> Page {
    let client = &browser.client;
    let mut page = begin(browser, &house.at("/"), "robot-recharge").await;
    while page.kind != "comparison" {
        page = page.click(client, "button[value=accept]").await;
    }
    page
}

#[tokio::test]
async fn a_card_plays_both_walks_in_step() {
    let wishes = Wishes {
        moving: true,
        ..Wishes::default()
    };
    with(wishes, async |browser| {
        let client = &browser.client;
        let house = House::build();
        compared(browser, &house).await;
        // It begins by itself, and the space bar stops it.
        wait("the first steps", async || {
            (player(client).await["step"].as_u64() > Some(0)).then_some(())
        })
        .await;
        strike(client, "r").await;
        strike(client, " ").await;
        let stopped = player(client).await;
        assert_eq!(stopped["plays"], json!(false));
        assert!(stopped["step"].as_u64() < stopped["last"].as_u64());
        press(client, "[data-speed=\"2\"]").await;
        assert_eq!(player(client).await["speed"], json!("2"));
        strike(client, " ").await;
        wait("the end", async || {
            let now = player(client).await;
            (now["step"] == now["last"] && now["plays"] == json!(false)).then_some(())
        })
        .await;
        // The chosen speed stays with the next question.
        let page = Page::now(client).await;
        page.click(client, "#skip").await;
        assert_eq!(player(client).await["speed"], json!("2"));
    })
    .await;
}

#[tokio::test]
async fn nothing_moves_by_itself_where_motion_is_unwelcome() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        compared(browser, &house).await;
        let shown = player(client).await;
        assert_eq!(shown["step"], shown["last"], "the whole way is there");
        assert_eq!(shown["plays"], json!(false));
        let slider = client.find(fantoccini::Locator::Css(".scrubber")).await;
        // The arrow moves the scrubber, and answers nothing.
        let before = Page::now(client).await;
        slider.unwrap().send_keys("\u{e012}").await.unwrap();
        let stepped = player(client).await;
        assert_eq!(
            stepped["step"].as_u64().unwrap() + 1,
            shown["step"].as_u64().unwrap()
        );
        assert_eq!(Page::now(client).await.question, before.question);
    })
    .await;
}

#[tokio::test]
async fn keys_answer_only_while_the_card_has_the_focus() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let page = compared(browser, &house).await;
        let told = async || texts(client, "[data-keys-state]").await.concat();
        assert!(told().await.starts_with("Keys answer"), "{}", told().await);
        script(
            client,
            "document.querySelector('#history-link').focus({focusVisible: false})",
        )
        .await;
        assert!(told().await.starts_with("Keys rest"), "{}", told().await);
        strike(client, "s").await;
        strike(client, "\u{e012}").await;
        press(client, "[data-keys-state] button").await;
        assert_eq!(Page::now(client).await.question, page.question);
        // Backspace does nothing on the card.
        strike(client, "\u{e003}").await;
        assert_eq!(Page::now(client).await.question, page.question);
        strike(client, "\u{e012}").await;
        let next = page.next(client).await;
        assert_ne!(next.question, page.question);
        assert!(told().await.starts_with("Keys answer"));
    })
    .await;
}

#[tokio::test]
async fn an_answer_among_the_last_ten_is_withdrawn_in_place() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let mut page = compared(browser, &house).await;
        let first = page.question.clone().unwrap();
        for _ in 0..2 {
            page = page.click(client, "#answer-form .pad button").await;
        }
        let address = client.current_url().await.unwrap();
        let loaded = script(client, "return performance.timeOrigin").await;
        let rows = texts(client, ".recent li").await.len();
        page.click(client, &format!("#recent-{first} button")).await;
        assert_eq!(texts(client, ".recent li").await.len() + 1, rows);
        assert!(texts(client, &format!("#recent-{first}")).await.is_empty());
        // No page was loaded for it, and the address is the same.
        assert_eq!(client.current_url().await.unwrap(), address);
        assert_eq!(
            script(client, "return performance.timeOrigin").await,
            loaded
        );
    })
    .await;
}

/// Whether a page is no wider than its window, its answers lie in it, and the
/// recent answers are shown.
const LOOK: &str = r#"
    const inside = (element) => element.getBoundingClientRect().bottom <= innerHeight + 1;
    return [
        document.documentElement.scrollWidth <= Math.max(innerWidth, 360),
        [...document.querySelectorAll(".pad button")].every(inside),
        document.querySelector(".recent").open,
    ];
"#;

#[tokio::test]
async fn a_phone_shows_all_without_a_sideways_scroll() {
    let wishes = Wishes {
        size: Some((360, 740)),
        ..Wishes::default()
    };
    with(wishes, async |browser| {
        let client = &browser.client;
        let house = House::build();
        let page = compared(browser, &house).await;
        let page = page.click(client, "#answer-form .pad button").await;
        assert_ne!(page.kind, "conflict");
        let look = script(client, LOOK).await;
        // A window of a browser may be wider than a phone.
        let narrow = script(client, "return innerWidth <= 640").await;
        assert_eq!(narrow, json!(true));
        assert_eq!(look, json!([true, true, false]));
    })
    .await;
}

#[tokio::test]
async fn a_broken_connection_loses_no_answer() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let page = compared(browser, &house).await;
        script(
            client,
            "window.kept = fetch; window.fetch = () => Promise.reject(new TypeError());",
        )
        .await;
        press(client, "#answer-form .left").await;
        let told = wait("the trouble", async || {
            texts(client, "#trouble").await.pop()
        })
        .await;
        assert!(told.contains("could not be sent"), "{told}");
        assert_eq!(Page::now(client).await.question, page.question);
        script(client, "window.fetch = window.kept;").await;
        let next = page.click(client, "#trouble button").await;
        assert_ne!(next.question, page.question);
        assert!(texts(client, ".recent strong").await[0].starts_with("A is better"));
    })
    .await;
}
