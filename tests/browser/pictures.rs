//! The pictures of the README, made where `MEMREP_SCREENSHOTS` names a folder.

use std::path::PathBuf;

use fantoccini::Client;

use crate::driver::{Wishes, with};
use crate::house::House;
use crate::page::script;
use crate::teaching::{Person, begin};

/// What a picture in a README may weigh, in bytes.
const HEAVIEST: usize = 200_000;

/// Writes the part of the page that is seen now as `NAME.png`.
async fn take(client: &Client, folder: Option<&PathBuf>, name: &str) {
    // A focus ring is no part of a picture.
    script(client, "document.activeElement.blur(); scrollTo(0, 0)").await;
    let picture = client.screenshot().await.unwrap();
    assert!(picture.len() < HEAVIEST, "{name}: {}", picture.len());
    if let Some(folder) = folder {
        std::fs::create_dir_all(folder).unwrap();
        std::fs::write(folder.join(format!("{name}.png")), picture).unwrap();
    }
}

/// Teaches the robot's task as far as each picture needs.
#[tokio::test]
async fn pictures_of_the_three_pages() {
    let folder = std::env::var_os("MEMREP_SCREENSHOTS").map(PathBuf::from);
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        // A page of 1280 by 800 pixels, whatever frame the window has.
        client.set_window_size(1280, 800).await.unwrap();
        let house = House::build();
        let mut person = Person::thinking_of("robot");
        let page = begin(browser, &house.at("/"), "robot").await;
        let page = person.answer_until(client, page, "comparison").await;
        take(client, folder.as_ref(), "question").await;
        let mut page = person.answer_until(client, page, "equivalence").await;
        // The last rule, which is right, makes the best picture.
        while page.kind != "equivalence" || person.objection(&page).is_some() {
            page = person.answer(client, &page).await;
        }
        take(client, folder.as_ref(), "equivalence").await;
        person.answer_until(client, page, "done").await;
        take(client, folder.as_ref(), "result").await;
    })
    .await;
}
