//! A person checks a rule: follows behaviours through it, looks at samples, draws a
//! counterexample by mouse and by keys, and teaches the same once more.

use fantoccini::Client;
use fantoccini::Locator;
use fantoccini::key::Key;
use serde_json::Value;

use crate::driver::{Wishes, with};
use crate::house::House;
use crate::page::{Page, fill, press, script, texts, typed};

/// Water is one move to the right of the start, recharge four moves away.
const TASK: &str = r#"{
    "title": "A small room",
    "symbols": [{"name": "B", "word": "water"}, {"name": "Y", "word": "recharge"}],
    "world": {"kind": "grid", "map": ["SB.", ".#.", "..Y"], "steps": 8},
    "examples": [{"word": ["Y"], "label": true}, {"word": ["B"], "label": false}]
}"#;

/// Answers as one who wants to end at a recharge, until a rule is on show.
async fn to_the_rule(client: &Client, house: &House) -> Page {
    client.goto(&house.at("/")).await.unwrap();
    let made = format!(
        "const [done] = arguments;
         fetch('/api/v1/sessions', {{method: 'POST', headers: {{'content-type': 'application/json'}},
             body: JSON.stringify({{task: {TASK}}})}})
             .then((reply) => reply.json()).then(({{id}}) => done(id));"
    );
    let id = client.execute_async(&made, Vec::new()).await.unwrap();
    let at = format!("/sessions/{}", id.as_str().unwrap());
    client.goto(&house.at(&at)).await.unwrap();
    let mut page = Page::now(client).await;
    for _ in 0..100 {
        let ends: Vec<bool> = page.words.iter().map(|word| word.ends_with('Y')).collect();
        let answer = match (page.kind.as_str(), ends.first(), ends.get(1)) {
            ("equivalence", ..) => return page,
            ("membership", Some(true), _) => "accept",
            ("membership", ..) => "reject",
            (_, Some(true), Some(false)) => "first",
            (_, Some(false), Some(true)) => "second",
            _ => "incomparable",
        };
        page = page
            .click(client, &format!("button[name=answer][value={answer}]"))
            .await;
    }
    panic!("no rule: {page:?}");
}

async fn lit(client: &Client) -> Value {
    script(
        client,
        "return [...document.querySelectorAll('.automaton .state.lit')].map((s) => s.dataset.state)",
    )
    .await
}

#[tokio::test]
async fn a_rule_is_followed_and_refuted_on_the_grid() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let page = to_the_rule(client, &house).await;

        // The drawing follows symbol by symbol, and step by step.
        press(client, "#trace-chips [data-append=B]").await;
        press(client, "#trace-chips [data-append=Y]").await;
        assert_eq!(typed(client, "#trace").await, "B Y");
        let end = lit(client).await;
        assert_eq!(end.as_array().unwrap().len(), 1);
        assert_eq!(texts(client, "#trace-way li").await.len(), 3);
        press(client, "[data-step='-1']").await;
        press(client, "[data-step='-1']").await;
        assert_eq!(lit(client).await, serde_json::json!(["0"]));
        assert_eq!(texts(client, "#trace-way [aria-current]").await.len(), 1);
        fill(client, "#trace", "B coffee").await;
        assert!(texts(client, "#trace-verdict").await[0].contains("is not one of the names"));

        // By mouse: to the right, onto the water; not through the wall.
        let click = |row: usize, column: usize| {
            format!(
                "const scene = document.querySelector('#walk svg.scene');
                 const at = new DOMPoint({column} * 32 + 16, {row} * 32 + 16)
                     .matrixTransform(scene.getScreenCTM());
                 scene.dispatchEvent(new MouseEvent('click',
                     {{bubbles: true, clientX: at.x, clientY: at.y}}));"
            )
        };
        script(client, &click(0, 1)).await;
        assert_eq!(typed(client, "#word").await, "B");
        assert_eq!(typed(client, "#trace").await, "B");
        script(client, &click(1, 1)).await;
        assert!(texts(client, "#walk-now").await[0].contains("wall"));
        script(client, &click(2, 2)).await;
        assert!(texts(client, "#walk-now").await[0].contains("neighbouring"));

        // By keys: on to the recharge, one back, and on again.
        let field = client.find(Locator::Css("#walk-field")).await.unwrap();
        let keys = [Key::Right, Key::Down, Key::Down].map(char::from);
        field.send_keys(&String::from_iter(keys)).await.unwrap();
        assert_eq!(typed(client, "#word").await, "B Y");
        press(client, "#walk-back").await;
        assert_eq!(typed(client, "#word").await, "B");
        let field = client.find(Locator::Css("#walk-field")).await.unwrap();
        field
            .send_keys(&char::from(Key::Down).to_string())
            .await
            .unwrap();
        assert_eq!(typed(client, "#word").await, "B Y");
        assert!(texts(client, "#walk-now").await[0].contains("4 of 8 moves"));
        let said = texts(client, "#verdict").await.concat();
        assert!(said.contains("The rule above"), "{said}");
        let next = page.click(client, "#teach").await;
        assert_ne!(next.question, page.question);
    })
    .await;
}

#[tokio::test]
async fn samples_are_looked_at_and_the_task_is_taught_once_more() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        let page = to_the_rule(client, &house).await;
        assert!(!texts(client, ".sample .says").await.is_empty());
        press(client, "#looked").await;
        let done = page.click(client, ".agree button[value=correct]").await;
        assert_eq!(done.kind, "done");
        assert!(texts(client, "#claim").await[0].contains("at most 27 %"));
        let before = client.current_url().await.unwrap();

        press(client, "#again summary").await;
        fill(client, "#seed", "9").await;
        let new = done.click(client, "#again button").await;
        assert!(
            ["comparison", "membership"].contains(&new.kind.as_str()),
            "{new:?}"
        );
        assert_ne!(client.current_url().await.unwrap().path(), before.path());

        // Another rule, and something wrong among its samples.
        let page = to_the_rule(client, &house).await;
        let next = page.click(client, ".sample .wrong").await;
        assert_ne!(next.question, page.question);
    })
    .await;
}
