//! A person who brings recordings: sends them by the start page, sees them on the
//! cards, and teaches by them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use automata::{Alphabet, Dfa};
use fantoccini::{Client, Locator};
use memrep::concept::Prior;
use memrep::evidence::Comparison;
use memrep::oracle::{SituatedTeacher, Target, Teacher, TeacherSettings};
use memrep::world::World;
use memrep::world::pool::PoolReader;
use serde_json::{Value, json};

use crate::driver::{Browser, Wishes, wait, with};
use crate::house::House;
use crate::page::{Page, fill, press, script, texts, typed};
use crate::teaching::MANY;

/// Two pictures that follow each other for ever.
const GIF: &[u8] = b"GIF89a\x01\0\x01\0\x80\0\0\xff\0\0\0\0\xff\
    !\xff\x0bNETSCAPE2.0\x03\x01\0\0\0\
    !\xf9\x04\0\x32\0\0\0,\0\0\0\0\x01\0\x01\0\0\x02\x02D\x01\0\
    !\xf9\x04\0\x32\0\0\0,\0\0\0\0\x01\0\x01\0\0\x02\x02L\x01\0;";

/// A picture of one grey.
fn png(width: u32, height: u32, grey: u8) -> Vec<u8> {
    let mut rows = Vec::new();
    for _ in 0..height {
        rows.push(0);
        rows.extend(std::iter::repeat_n(grey, width as usize));
    }
    // Not compressed: one stored block, and the checksum of Adler.
    let length = u16::try_from(rows.len()).unwrap();
    let mut data = vec![0x78, 0x01, 0x01];
    data.extend(length.to_le_bytes());
    data.extend((!length).to_le_bytes());
    data.extend(&rows);
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in &rows {
        a = (a + u32::from(*byte)) % 65521;
        b = (b + a) % 65521;
    }
    data.extend((b << 16 | a).to_be_bytes());
    let mut head = [width.to_be_bytes(), height.to_be_bytes()].concat();
    head.extend([8, 0, 0, 0, 0]);
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    for (name, content) in [(b"IHDR", head), (b"IDAT", data), (b"IEND", Vec::new())] {
        png.extend((content.len() as u32).to_be_bytes());
        let named = [&name[..], &content].concat();
        let sum = named.iter().fold(u32::MAX, |sum, byte| {
            (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
                (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg())
            })
        });
        png.extend(named);
        png.extend((!sum).to_be_bytes());
    }
    png
}

/// A film that the browser itself makes.
async fn film(client: &Client) -> Vec<u8> {
    const MAKE: &str = r#"
        const done = arguments[arguments.length - 1];
        const canvas = Object.assign(document.createElement("canvas"), {width: 64, height: 48});
        const context = canvas.getContext("2d");
        let shade = 0;
        const paint = setInterval(() => {
            context.fillStyle = `hsl(${shade += 40} 80% 50%)`;
            context.fillRect(0, 0, 64, 48);
        }, 20);
        const recorder = new MediaRecorder(canvas.captureStream(25), {mimeType: "video/webm"});
        recorder.ondataavailable = async ({data}) => done([...new Uint8Array(await data.arrayBuffer())]);
        recorder.start();
        setTimeout(() => { recorder.stop(); clearInterval(paint); }, 400);
    "#;
    let bytes = client.execute_async(MAKE, Vec::new()).await.unwrap();
    serde_json::from_value(bytes).unwrap()
}

/// Recordings of all words of up to four symbols, with everything that can be seen;
/// and the files beside them.
struct Reel {
    folder: tempfile::TempDir,
    lines: String,
    media: Vec<PathBuf>,
}

impl Reel {
    fn shoot(film: Option<&[u8]>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut reel = Self {
            lines: String::new(),
            media: Vec::new(),
            folder,
        };
        for place in 0..4_u8 {
            reel.add(&format!("{place}.png"), &png(40, 30, place * 60));
        }
        reel.add("moving.gif", GIF);
        if let Some(film) = film {
            reel.add("film.webm", film);
        }
        let mut number = 0;
        for length in 0..5 {
            for bits in 0..1_usize << length {
                let bit = |place: usize| if bits >> place & 1 == 1 { "1" } else { "0" };
                let word: Vec<&str> = (0..length).map(bit).collect();
                let media = match number % 4 {
                    1 => json!({"kind": "animation", "path": "moving.gif"}),
                    2 => {
                        json!({"kind": "cells", "cells": [[0, 0], [0, 1], [1, 1], [1, 1], [0, 1]]})
                    }
                    3 if film.is_some() => json!({"kind": "video", "path": "film.webm"}),
                    _ => json!({"kind": "frames", "paths": ["0.png", "1.png", "2.png", "3.png"]}),
                };
                let line = json!({"id": format!("run-{number}"), "word": word, "media": media, "complete": number % 5 != 0});
                reel.lines.push_str(&line.to_string());
                reel.lines.push('\n');
                number += 1;
            }
        }
        reel.write("runs.jsonl", reel.lines.as_bytes());
        reel
    }

    fn write(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    fn add(&mut self, name: &str, content: &[u8]) {
        let path = self.write(name, content);
        self.media.push(path);
    }

    fn teacher(&self) -> (Alphabet, SituatedTeacher) {
        let target = Target::named("tomita:5").unwrap();
        let alphabet = target.dfa().alphabet().clone();
        let pool = PoolReader::read(alphabet.clone(), self.lines.as_bytes()).unwrap();
        let open = Prior::none(&alphabet).open().clone();
        let world = Arc::new(World::Pool(pool));
        let settings = TeacherSettings::default();
        (
            alphabet,
            SituatedTeacher::new(world, open, &target, settings),
        )
    }
}

/// Chooses files in a field.
async fn choose(client: &Client, selector: &str, files: &[PathBuf]) {
    let field = client.find(Locator::Css(selector)).await.unwrap();
    let paths: Vec<&str> = files.iter().map(|path| path.to_str().unwrap()).collect();
    field.send_keys(&paths.join("\n")).await.unwrap();
}

/// Fills the form of one's own rule.
async fn fill_form(client: &Client, recordings: &Path, media: &[PathBuf]) {
    fill(client, "#title", "What I filmed").await;
    fill(client, "#symbols", "0 1").await;
    press(client, ".uploads summary").await;
    choose(client, "#recordings", &[recordings.to_owned()]).await;
    choose(client, "#media", media).await;
}

const SEND: &str = "#own-task button.primary";

/// What there is to see on the cards of a question, once all of it has loaded.
async fn seen(client: &Client) -> BTreeSet<String> {
    const LOOK: &str = r##"
        const cards = [...document.querySelectorAll("#answer-form .card")];
        return cards.map((card) => {
            const images = [...card.querySelectorAll(".recording img")].filter((image) => image.checkVisibility());
            const video = card.querySelector(".recording video");
            const loaded = images.every((image) => image.complete && image.naturalWidth > 0);
            if (card.querySelector(".one-by-one")) return loaded && images.length === 1 && "player";
            if (card.querySelector(".frames")) return loaded && images.length === 4 && "strip";
            const canvas = card.querySelector(".recording canvas");
            if (canvas) return canvas.width > 0 && "animation";
            if (images.length > 0) return loaded && "animation";
            if (video) return video.videoWidth > 0 && "video";
            return card.querySelector("svg.scene path.way") !== null && "cells";
        });
    "##;
    wait("pictures and films", async || {
        let cards: Vec<Value> = serde_json::from_value(script(client, LOOK).await).unwrap();
        cards
            .iter()
            .map(|card| card.as_str().map(str::to_owned))
            .collect()
    })
    .await
}

/// Teaches to the end; what was seen on the way.
async fn teach(client: &Client, reel: &Reel) -> (Page, BTreeSet<String>) {
    let (alphabet, mut teacher) = reel.teacher();
    let mut page = Page::now(client).await;
    let mut all = BTreeSet::new();
    for _ in 0..MANY {
        let answer = match page.kind.as_str() {
            "done" => return (page, all),
            "equivalence" => {
                let rule: Dfa = page.rule(&alphabet);
                match teacher.counterexample(&rule) {
                    None => "correct".to_owned(),
                    Some((word, label)) => {
                        let names: Vec<&str> = alphabet.spell(&word).collect();
                        fill(client, "#word", &names.join(" ")).await;
                        press(
                            client,
                            &format!("#counterexample input[name=label][value=\"{label}\"]"),
                        )
                        .await;
                        page = page.click(client, "#teach").await;
                        continue;
                    }
                }
            }
            "membership" => {
                all.extend(seen(client).await);
                let accepted = teacher.membership(&page.word(0, &alphabet));
                (if accepted { "accept" } else { "reject" }).to_owned()
            }
            "comparison" => {
                all.extend(seen(client).await);
                let [first, second] = [0, 1].map(|place| page.word(place, &alphabet));
                match teacher.comparison(&first, &second) {
                    Comparison::First => "first",
                    Comparison::Second => "second",
                    Comparison::Equal => "equal",
                    Comparison::Incomparable => "incomparable",
                }
                .to_owned()
            }
            _ => panic!("{page:?}"),
        };
        let button = format!("button[name=answer][value={answer}]");
        page = page.click(client, &button).await;
    }
    panic!("no rule after {MANY} questions: {page:?}");
}

/// The first that stands still gets a name.
const MARK: &str = r#"document.querySelector("figure:has(canvas)").id = "still";"#;
/// Whether it moves now.
const LOADED: &str = r##"
    const image = document.querySelector("#still img");
    return image.complete && image.naturalWidth > 0;
"##;

/// A fault is told at its field, and what was chosen stays chosen; then recordings are
/// played on the cards.
#[tokio::test]
async fn recordings_are_sent_seen_and_taught_by() {
    with(Wishes::default(), async |browser: &Browser| {
        let client = &browser.client;
        let house = House::build();
        client.goto(&house.at("/")).await.unwrap();
        let reel = Reel::shoot(Some(&film(client).await));
        let broken = reel.write("broken.jsonl", b"{\"id\":\"a\",\"word\":[\"2\"]}\n");
        fill_form(client, &broken, &reel.media).await;
        press(client, SEND).await;
        let fault = wait("the fault", async || {
            texts(client, "#recordings-fault").await.pop()
        })
        .await;
        assert!(
            fault.starts_with("Line 1, column 19, `word[0]`: "),
            "{fault}"
        );
        assert_eq!(typed(client, "#title").await, "What I filmed");
        choose(
            client,
            "#recordings",
            &[reel.folder.path().join("runs.jsonl")],
        )
        .await;
        let page = Page::now(client).await;
        press(client, SEND).await;
        page.next(client).await;

        let (_, seen) = teach(client, &reel).await;
        let kinds = ["animation", "cells", "player", "video"].map(str::to_owned);
        assert_eq!(seen, BTreeSet::from(kinds));
        assert!(!texts(client, ".rule-table, .drawing").await.is_empty());

        // What moves stands still until it is let go; the browser asks for that.
        client.goto(&house.at("/")).await.unwrap();
        press(client, ".sessions a").await;
        press(client, "#history-link").await;
        let moving = "figure:has(canvas) button";
        wait("a still", async || {
            client.find(Locator::Css(moving)).await.ok()
        })
        .await;
        script(client, MARK).await;
        press(client, "#still button").await;
        assert_eq!(script(client, LOADED).await, Value::Bool(true));

        // The player's slider and its button.
        client.goto(&house.at("/")).await.unwrap();
        press(client, ".sessions a").await;
        press(client, "#history-link").await;
        let player = wait("a player", async || {
            client
                .find(Locator::Css(".player:has(.one-by-one):not(:has(video))"))
                .await
                .ok()
        })
        .await;
        let count = player.find(Locator::Css(".count")).await.unwrap();
        assert_eq!(count.text().await.unwrap(), "Step 0 of 3");
        let slider = player
            .find(Locator::Css("input[type=range]"))
            .await
            .unwrap();
        slider.send_keys("\u{e014}").await.unwrap();
        assert_eq!(count.text().await.unwrap(), "Step 1 of 3");
        let play = player.find(Locator::Css(".play-button")).await.unwrap();
        assert!(play.text().await.unwrap().starts_with("Play"));
        play.click().await.unwrap();
        wait("the last picture", async || {
            (count.text().await.ok()? == "Step 3 of 3").then_some(())
        })
        .await;
    })
    .await;
}

/// The same without a script: pictures are a strip.
#[tokio::test]
async fn recordings_are_sent_and_seen_without_a_script() {
    let wishes = Wishes {
        without_script: true,
        ..Wishes::default()
    };
    with(wishes, async |browser: &Browser| {
        let client = &browser.client;
        let house = House::build();
        client.goto(&house.at("/")).await.unwrap();
        let reel = Reel::shoot(None);
        let runs = reel.folder.path().join("runs.jsonl");
        fill_form(client, &runs, &reel.media[1..]).await;
        let page = Page::now(client).await;
        let page = page.click(client, SEND).await;
        let fault = texts(client, "#recordings-fault").await.concat();
        assert!(fault.contains("`0.png` was not sent"), "{fault}");
        assert!(texts(client, "#again").await.concat().contains("again"));
        choose(client, "#recordings", &[runs]).await;
        choose(client, "#media", &reel.media).await;
        page.click(client, SEND).await;
        let (_, seen) = teach(client, &reel).await;
        let kinds = ["animation", "cells", "strip"].map(str::to_owned);
        assert_eq!(seen, BTreeSet::from(kinds));
    })
    .await;
}
