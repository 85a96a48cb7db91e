//! A person who sees nothing but the drawings: what a walk steps on is read from
//! its line and the tiles under it.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use automata::{Alphabet, Word};
use fantoccini::Client;
use memrep::evidence::Comparison;
use memrep::oracle::{SituatedTeacher, Target, Teacher, TeacherSettings};
use memrep::task::TaskFile;
use serde::Deserialize;

use crate::driver::{Browser, Wishes, with};
use crate::house::House;
use crate::page::{Page, fill, press, script};
use crate::pictures::Album;
use crate::teaching::{MANY, begin};

/// The side of a cell in the drawing.
const SIDE: i32 = 32;

/// A drawing, as the document has it.
#[derive(Deserialize)]
struct Drawn {
    way: String,
    tiles: Vec<(i32, i32, String)>,
    walls: Vec<(i32, i32)>,
}

const READ: &str = r##"
    const number = (element, name) => Number(element.getAttribute(name));
    return [...document.querySelectorAll("#answer-form svg.scene")].map((scene) => ({
        way: scene.querySelector("path.way").getAttribute("d"),
        tiles: [...scene.querySelectorAll("g.tile")].map((tile) => {
            const rect = tile.querySelector("rect");
            return [number(rect, "x"), number(rect, "y"), tile.querySelector("text").textContent];
        }),
        walls: [...scene.querySelectorAll("rect.wall")].map((wall) => [number(wall, "x"), number(wall, "y")]),
    }));
"##;

impl Drawn {
    /// The cells of the line, one after the other.
    fn cells(&self) -> Vec<(i32, i32)> {
        let points = self.way.split(['M', 'L']).map(str::trim);
        let cell = |point: &str| {
            let (x, y) = point.split_once(' ').unwrap();
            let place = |text: &str| text.parse::<i32>().unwrap().div_euclid(SIDE);
            (place(x), place(y))
        };
        points.filter(|point| !point.is_empty()).map(cell).collect()
    }

    /// What the walk steps on.
    fn word(&self, alphabet: &Alphabet) -> Word {
        let tiles: HashMap<(i32, i32), &str> = (self.tiles.iter())
            .map(|(x, y, letter)| ((x / SIDE, y / SIDE), letter.as_str()))
            .collect();
        let mut entered = Vec::new();
        for step in self.cells().windows(2) {
            let [before, now] = [step[0], step[1]];
            assert!((before.0 - now.0).abs() + (before.1 - now.1).abs() <= 1);
            assert!(!self.walls.contains(&(now.0 * SIDE, now.1 * SIDE)));
            if before != now {
                entered.extend(tiles.get(&now).copied());
            }
        }
        alphabet.word(entered).unwrap()
    }
}

/// What the drawings of a question show.
async fn drawn(client: &Client, page: &Page, alphabet: &Alphabet) -> Vec<Word> {
    let drawn: Vec<Drawn> = serde_json::from_value(script(client, READ).await).unwrap();
    let words: Vec<Word> = drawn.iter().map(|drawn| drawn.word(alphabet)).collect();
    // The list for readers of screens says the same.
    let listed: Vec<Word> = (0..page.words.len())
        .map(|place| page.word(place, alphabet))
        .collect();
    assert_eq!(words, listed);
    words
}

#[tokio::test]
async fn the_robot_is_taught_from_drawn_walks() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/tasks/robot-recharge.toml");
    let file = TaskFile::open(&file).unwrap();
    let situation = file.universe.situation().unwrap();
    let target = Target::named("robot").unwrap();
    let alphabet = target.dfa().alphabet().clone();
    let open = situation.prior.open().clone();
    let world = Arc::clone(&situation.world);
    let mut teacher = SituatedTeacher::new(world, open, &target, TeacherSettings::default());
    with(Wishes::default(), async |browser: &Browser| {
        let client = &browser.client;
        let house = House::build();
        let mut page = begin(browser, &house.at("/"), "robot-recharge").await;
        let mut album = Album::wished(client).await;
        for _ in 0..MANY {
            let objection = if page.kind == "equivalence" {
                teacher.counterexample(&page.rule(&alphabet))
            } else {
                None
            };
            album.see(client, &page, objection.is_none()).await;
            match page.kind.as_str() {
                "done" => {
                    album.is_complete();
                    press(client, "#download-json").await;
                    let text = browser.downloaded(".json").await;
                    let learned = automata::format::json::read(&text).unwrap().dfa;
                    assert!(learned.is_equivalent(target.dfa()).unwrap(), "{text}");
                    return;
                }
                "equivalence" => {
                    page = match objection {
                        None => page.click(client, "button[value=correct]").await,
                        Some((word, label)) => {
                            let names: Vec<&str> = alphabet.spell(&word).collect();
                            fill(client, "#word", &names.join(" ")).await;
                            press(
                                client,
                                &format!("#counterexample input[name=label][value=\"{label}\"]"),
                            )
                            .await;
                            page.click(client, "#teach").await
                        }
                    };
                }
                _ => {
                    let words = drawn(client, &page, &alphabet).await;
                    let said = match &words[..] {
                        [word] if teacher.membership(word) => "accept",
                        [_] => "reject",
                        [first, second] => match teacher.comparison(first, second) {
                            Comparison::First => "first",
                            Comparison::Second => "second",
                            Comparison::Equal => "equal",
                            Comparison::Incomparable => "incomparable",
                        },
                        _ => panic!("{page:?} shows nothing"),
                    };
                    page = page
                        .click(client, &format!("button[name=answer][value={said}]"))
                        .await;
                }
            }
        }
        panic!("no rule after {MANY} questions: {page:?}");
    })
    .await;
}
