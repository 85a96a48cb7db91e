//! Someone who builds a task in the studio: paints its grid by mouse and by keyboard,
//! saves it, begins, and answers its first question.

use fantoccini::actions::{InputSource, MOUSE_BUTTON_LEFT, MouseActions, PointerAction};
use fantoccini::{Client, Locator};
use memrep::task::{Task, WorldText};
use serde_json::Value;

use crate::driver::{Browser, Wishes, wait, with};
use crate::house::House;
use crate::page::{Page, fill, press, script, texts, typed};

/// Types keys where the focus is.
async fn keys(client: &Client, text: &str) {
    let focused = client.active_element().await.unwrap();
    focused.send_keys(text).await.unwrap();
}

/// Drags the mouse from one cell of the board to another.
async fn drag(client: &Client, from: &str, to: &str) {
    let cell = async |at: &str| {
        let selector = format!(".board [data-at='{at}']");
        client.find(Locator::Css(&selector)).await.unwrap()
    };
    let (first, last) = (cell(from).await, cell(to).await);
    script(
        client,
        "document.querySelector('.board').scrollIntoView({block: 'center'})",
    )
    .await;
    let over = |element| PointerAction::MoveToElement {
        element,
        duration: None,
        x: 0.0,
        y: 0.0,
    };
    let mouse = MouseActions::new("mouse".to_owned())
        .then(over(first))
        .then(PointerAction::Down {
            button: MOUSE_BUTTON_LEFT,
        })
        .then(over(last))
        .then(PointerAction::Up {
            button: MOUSE_BUTTON_LEFT,
        });
    client.perform_actions(mouse).await.unwrap();
}

/// Opens the text of a task file in the studio.
pub(crate) async fn open(client: &Client, text: &str) {
    let sent = "const form = Object.assign(document.createElement('form'),
            { method: 'post', action: '/studio', enctype: 'multipart/form-data' });
        for (const [name, value] of [['text', arguments[0]], ['do', 'open']]) {
            form.append(Object.assign(document.createElement('textarea'), { name, value }));
        }
        document.querySelector('main').remove();
        document.body.append(form);
        form.submit();";
    client.execute(sent, vec![Value::from(text)]).await.unwrap();
}

#[tokio::test]
async fn a_grid_is_painted_saved_and_taught() {
    with(Wishes::default(), async |browser: &Browser| {
        let client = &browser.client;
        let house = House::build();
        client.goto(&house.at("/")).await.unwrap();
        let mut page = Page::now(client).await.click(client, "#build").await;
        assert_eq!(page.kind, "studio");
        fill(client, "#title", "Fetch the post").await;
        fill(client, "#name", "post").await;
        // Rows come and go at once.
        press(client, "button[value='add symbols']").await;
        press(client, "button[value='remove symbols[1]']").await;
        for (place, name, letter) in [(0, "letter", "L"), (1, "dog", "D")] {
            fill(client, &format!("#symbols-{place}-name"), name).await;
            fill(client, &format!("#symbols-{place}-letter"), letter).await;
        }
        press(client, "#world-kind option[value=grid]").await;
        fill(client, "#map-rows", "3").await;
        fill(client, "#map-columns", "4").await;
        press(client, "button[value=resize]").await;
        assert_eq!(typed(client, "#world-map").await, "....\n....\n....");

        // By mouse: a wall across two cells.
        press(client, ".brush:has([value='#'])").await;
        drag(client, "1 1", "1 2").await;
        assert_eq!(typed(client, "#world-map").await, "....\n.##.\n....");
        // By keyboard: a letter, the brush, and back to nothing.
        press(client, ".board [data-at='0 0']").await;
        keys(client, "S").await;
        keys(client, "\u{e014}\u{e014}\u{e014}l").await;
        keys(client, "\u{e015}\u{e015}d").await;
        press(client, ".brush:has([value='D'])").await;
        press(client, ".board [data-at='2 0']").await;
        keys(client, "\u{e014} \u{e012}.").await;
        assert_eq!(typed(client, "#world-map").await, "S..L\n.##.\n.D.D");
        // A larger map keeps what is there.
        fill(client, "#map-columns", "5").await;
        press(client, "button[value=resize]").await;
        assert_eq!(typed(client, "#world-map").await, "S..L.\n.##..\n.D.D.");
        // What is typed is painted.
        fill(client, "#world-map", "S..L\n.##.\n.D.D").await;
        let painted = texts(client, ".board [data-at='2 3']").await;
        assert_eq!(painted, ["D"]);
        // The preview follows.
        wait("the preview", async || {
            let chips = texts(client, "#preview .chip").await;
            (chips.len() == 2 && !texts(client, "#preview .fine").await.is_empty()).then_some(())
        })
        .await;

        fill(client, "[name='prior.holds.x']", "letter").await;
        press(client, "[name='prior.holds.form'] option[value=reach]").await;
        press(client, "button[value='rule prior.holds']").await;
        assert_eq!(typed(client, "#prior-holds-0-rule").await, "reach letter");

        press(client, "button.plain[value=save]").await;
        let saved = browser.downloaded("post.toml").await;
        let task = Task::from_json(&Task::toml_content(&saved).unwrap()).unwrap();
        let Some(WorldText::Grid { map, .. }) = &task.world else {
            panic!("{saved}");
        };
        assert_eq!(map.join("\n"), "S..L\n.##.\n.D.D");
        assert_eq!(task.symbols.len(), 2);

        // Saving leaves the page as it is, and it can be begun.
        page = page.click(client, "button.primary[value=begin]").await;
        assert!(
            ["comparison", "membership"].contains(&page.kind.as_str()),
            "{page:?}"
        );
        let question = page.question.clone();
        page = page.click(client, "button[name=answer]").await;
        assert_ne!(page.question, question);
    })
    .await;
}
