//! From a press to the next card, measured by the page's own clock. A time is never
//! asserted: `docs/results/answering.md` tells what it was, where.

use std::time::Duration;

use fantoccini::Client;
use serde::Deserialize;

use crate::driver::{Wishes, with};
use crate::house::House;
use crate::page::{Page, script};
use crate::robot::Reader;

/// How long somebody looks at a card.
const THINK: Duration = Duration::from_secs(1);

/// The sessions that are measured.
const SEEDS: std::ops::Range<u64> = 0..5;

/// From a trusted press that sends something until the next card is painted; the
/// server's part of it beside.
const WATCH: &str = r#"
    window.cards = [];
    let pressed = null;
    document.addEventListener("click", (event) => {
        if (event.target.closest("form[data-swap] button:not([type=button]), #skip")) pressed = event.timeStamp;
    }, { capture: true });
    new MutationObserver((changes) => {
        const came = changes.some(({ addedNodes }) => [...addedNodes].some((node) => node.nodeName === "MAIN"));
        if (!came || pressed === null) return;
        const [start, kind] = [pressed, document.querySelector("main").dataset.kind];
        pressed = null;
        requestAnimationFrame(() => {
            const painted = new MessageChannel();
            painted.port1.onmessage = () => {
                const end = performance.now();
                performance.measure("card to card", { start, end });
                const sent = performance.getEntriesByType("resource").filter((entry) => entry.startTime >= start - 1);
                cards.push({ kind, took: end - start, waited: Math.max(0, ...sent.map((entry) => entry.responseEnd)) - start });
            };
            painted.port2.postMessage(null);
        });
    }).observe(document.body, { childList: true });
"#;

#[derive(Deserialize)]
struct Card {
    kind: String,
    took: f64,
    waited: f64,
}

/// A session of the robot's task with this seed, as the ready task is set up.
async fn session(client: &Client, seed: u64) -> String {
    let made = format!(
        "const [done] = arguments;
         fetch('/api/v1/sessions', {{method: 'POST', headers: {{'content-type': 'application/json'}},
             body: JSON.stringify({{task: 'robot-recharge', strategy: 'bayes', membership_cost: 4, seed: {seed}}})}})
             .then((reply) => reply.json()).then(({{id}}) => done(id));"
    );
    let id = client.execute_async(&made, Vec::new()).await.unwrap();
    format!("/sessions/{}", id.as_str().unwrap())
}

/// Of these, in ascending order, the one that this many of a hundred do not exceed.
fn quantile(sorted: &[f64], percent: usize) -> f64 {
    let place = (percent * sorted.len()).div_ceil(100);
    sorted[place.clamp(1, sorted.len()) - 1]
}

fn tell(what: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let [half, most, all] = [50, 95, 100].map(|percent| quantile(&times, percent));
    let cards = times.len();
    println!(
        "{what:<24} {cards:4} cards: median {half:6.1} ms, 95 % within {most:6.1} ms, longest {all:6.1} ms"
    );
}

#[tokio::test]
#[ignore = "measures for minutes, and needs the machine for itself"]
async fn card_to_card() {
    let wishes = Wishes {
        moving: true,
        ..Wishes::default()
    };
    with(wishes, async |browser| {
        let client = &browser.client;
        let house = House::build();
        let mut all = Vec::new();
        for seed in SEEDS {
            client.goto(&house.at("/")).await.unwrap();
            let session = session(client, seed).await;
            client.goto(&house.at(&session)).await.unwrap();
            let page = Page::now(client).await;
            script(client, WATCH).await;
            let presses = Reader::new().teach(client, page, THINK).await;
            tokio::time::sleep(THINK).await;
            let cards = script(client, "return cards").await;
            let cards: Vec<Card> = serde_json::from_value(cards).unwrap();
            assert!(!cards.is_empty());
            println!("seed {seed}: {presses} presses, {} cards", cards.len());
            for card in cards.iter().filter(|card| card.took > 100.0) {
                println!(
                    "  {:.1} ms for {}, of it {:.1} ms until the answer of the server was there",
                    card.took, card.kind, card.waited
                );
            }
            all.extend(cards);
        }
        let asks = |card: &&Card| ["comparison", "membership"].contains(&card.kind.as_str());
        tell(
            "question to question",
            all.iter().filter(asks).map(|card| card.took).collect(),
        );
        tell("all", all.iter().map(|card| card.took).collect());
        tell(
            "all, of it the server",
            all.iter().map(|card| card.waited).collect(),
        );
    })
    .await;
}
