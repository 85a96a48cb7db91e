//! An owner and two people, each in a browser of their own, at one session.

use fantoccini::Client;

use crate::driver::{Browser, Wishes, wait, with};
use crate::house::House;
use crate::page::{Page, fill, press, script, texts, typed};
use crate::teaching::begin;

/// The owner begins a session and opens the page about its people.
async fn open_people(owner: &Browser, house: &House) -> Page {
    begin(owner, &house.at("/"), "robot-recharge").await;
    let page = Page::now(&owner.client).await;
    page.click(&owner.client, "#people-link").await
}

/// Invites somebody; the link, as it is sent.
async fn invite(owner: &Client, page: &Page, name: &str) -> (String, Page) {
    fill(owner, "#name", name).await;
    let page = page.click(owner, ".inviting button").await;
    let heading = texts(owner, "#link-title").await;
    assert_eq!(heading, [format!("The link for {name}")]);
    (typed(owner, "input[data-link]").await, page)
}

/// Opens a link and comes in by it, where it still leads in.
async fn visit(client: &Client, link: &str) -> Page {
    client.goto(link).await.unwrap();
    let page = Page::now(client).await;
    if page.kind != "door" {
        return page;
    }
    let page = page.click(client, "#enter").await;
    let address = client.current_url().await.unwrap();
    let key = link.rsplit('/').next().unwrap();
    assert!(!address.as_str().contains(key), "{address}");
    page
}

/// What the table says of a person, cell by cell.
async fn row(owner: &Client, person: usize) -> Vec<String> {
    texts(owner, &format!("tr[data-person='{person}'] td")).await
}

#[tokio::test]
async fn two_people_disagree_and_the_owner_decides() {
    with(Wishes::default(), async |owner| {
        with(Wishes::default(), async |ada| {
            with(Wishes::default(), async |bea| {
                disagree(owner, &ada.client, &bea.client).await;
            })
            .await;
        })
        .await;
    })
    .await;
}

async fn disagree(owner: &Browser, ada: &Client, bea: &Client) {
    let house = House::build();
    let page = open_people(owner, &house).await;
    let owner = &owner.client;
    fill(owner, "#answers", "2").await;
    let page = page.click(owner, "form[action$='/terms'] button").await;
    let (to_ada, page) = invite(owner, &page, "Ada").await;
    let (to_bea, _) = invite(owner, &page, "Bea").await;
    assert_ne!(to_ada, to_bea);

    // They see the same question, and neither the owner's pages nor each other.
    let first = visit(ada, &to_ada).await;
    let same = visit(bea, &to_bea).await;
    assert_eq!(first.asks(), same.asks());
    for selector in ["#people-link", "#why", ".bar-left", "a.brand"] {
        assert!(texts(ada, selector).await.is_empty(), "{selector}");
    }
    script(owner, "window.kept = true").await;
    let next = first
        .click(ada, "#answer-form .pad button:first-of-type")
        .await;
    assert_ne!(next.question, first.question);
    let after = same
        .click(bea, "#answer-form .pad button:last-of-type")
        .await;
    assert_ne!(after.question, first.question);

    // The owner's page has followed by itself.
    wait("the disagreement", async || {
        let disputed = texts(owner, "#disputed").await;
        (!disputed.is_empty()).then_some(())
    })
    .await;
    assert_eq!(script(owner, "return window.kept").await, true);
    assert_eq!(
        typed(owner, "input[data-link]").await,
        to_bea,
        "it is still told"
    );
    let voices = texts(owner, ".voices li").await;
    assert_eq!(voices.len(), 2);
    assert!(
        voices[0].starts_with("Ada: ") && voices[1].starts_with("Bea: "),
        "{voices:?}"
    );
    let agreement = texts(owner, "#agreement dd").await;
    assert_eq!(agreement[..2], ["1".to_owned(), "0 %".to_owned()]);
    let times: f64 = row(owner, 1).await[2]
        .trim_end_matches(" s")
        .parse()
        .unwrap();
    assert!(times > 0.0, "the browser says how long an answer took");

    // The owner decides, and that is the session's answer.
    let page = Page::now(owner)
        .await
        .click(owner, ".past .others button")
        .await;
    assert_ne!(page.kind, "people");
    let page = page.click(owner, "#people-link").await;
    assert!(texts(owner, "#disputed").await.is_empty());
    assert_eq!(texts(owner, "#history-link").await, ["1 answered"]);

    // A link that is ended shows nothing any more.
    let _ = page.click(owner, "tr[data-person='2'] .withdraw").await;
    wait("the end of the link", async || {
        let row = row(owner, 2).await;
        (row[5] == "left").then_some(())
    })
    .await;
    let gone = visit(bea, &to_bea).await;
    assert_eq!(gone.kind, "error");
    // The other goes on: the next question is there, or comes by itself.
    let page = wait("a question for Ada", async || {
        let page = Page::now(ada).await;
        (page.kind != "waiting").then_some(page)
    })
    .await;
    assert_ne!(page.question, first.question);
    press(ada, "#skip").await;
    page.next(ada).await;
}

#[tokio::test]
async fn a_question_that_is_left_lying_goes_to_the_other() {
    with(Wishes::default(), async |owner| {
        with(Wishes::default(), async |ada| {
            with(Wishes::default(), async |bea| {
                leave_lying(owner, &ada.client, &bea.client).await;
            })
            .await;
        })
        .await;
    })
    .await;
}

async fn leave_lying(owner: &Browser, ada: &Client, bea: &Client) {
    let house = House::build_with(&["--lease", "3"]);
    let page = open_people(owner, &house).await;
    let (to_ada, page) = invite(&owner.client, &page, "Ada").await;
    let (to_bea, _) = invite(&owner.client, &page, "Bea").await;
    let lying = visit(ada, &to_ada).await;
    let since = std::time::Instant::now();
    let other = visit(bea, &to_bea).await;
    assert_ne!(other.question, lying.question, "each has one of their own");
    tokio::time::sleep(std::time::Duration::from_millis(3100).saturating_sub(since.elapsed()))
        .await;
    let taken = other
        .click(bea, "#answer-form .pad button:first-of-type")
        .await;
    assert_eq!(taken.question, lying.question);
    assert_eq!(taken.words, lying.words);
    // Bea answers it; Ada's page goes on by itself.
    taken
        .click(bea, "#answer-form .pad button:first-of-type")
        .await;
    wait("another question", async || {
        let page = Page::now(ada).await;
        (page.question != lying.question).then_some(())
    })
    .await;
}
