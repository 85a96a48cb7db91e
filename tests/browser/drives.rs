//! A passenger who sees nothing but the pictures: how long a drive takes and how close
//! it passes is read from its line and its dots.

use fantoccini::Client;
use serde::Deserialize;
use serde_json::Value;

use crate::driver::{Browser, Wishes, with};
use crate::house::House;
use crate::page::{fill, press, script, texts};
use crate::teaching::{MANY, begin};

/// A picture, as the document has it.
#[derive(Deserialize)]
struct Drawn {
    /// The gap between the cars, in units of the drawing.
    gap: f64,
    /// How long the way is in dots, of which each is so many seconds.
    dots: f64,
    seconds: f64,
    /// What is written below.
    values: Vec<String>,
}

const READ: &str = r##"
    return [...document.querySelectorAll("#answer-form .card")].map((card) => {
        const drive = card.querySelector("svg.drive");
        const way = drive.querySelector("path.way");
        const marks = [...drive.querySelectorAll("circle.mark")];
        const [first, second] = marks.map((mark) => Number(mark.getAttribute("cx")));
        const box = drive.querySelector("path.gap").getBBox();
        // Dots are as far apart as the first is from the start.
        const total = way.getTotalLength();
        let begun = 0;
        while (begun < total && way.getPointAtLength(begun).x < first) begun += 0.05;
        return {
            gap: box.height,
            dots: total / begun,
            seconds: Number(drive.querySelector(".time-text").textContent.match(/every ([\d.]+) s/)[1]),
            values: [...card.querySelectorAll("dd[data-axis]")].map((value) => value.textContent),
        };
    });
"##;

impl Drawn {
    /// The time in seconds and the distance in metres.
    fn measured(&self) -> (f64, f64) {
        let time = self.dots * self.seconds;
        let distance = 0.2 + (self.gap - 7.0) / 61.0 * 2.8;
        let written: Vec<f64> = (self.values.iter())
            .map(|value| value.split(' ').next().unwrap().parse().unwrap())
            .collect();
        assert!(
            (written[0] - time).abs() < 0.02 * time,
            "{time}: {written:?}"
        );
        assert!(
            (written[1] - distance).abs() < 0.02,
            "{distance}: {written:?}"
        );
        (written[0], written[1])
    }

    fn is_comfortable(&self) -> bool {
        let (time, distance) = self.measured();
        time <= 40.0 && distance >= 1.0
    }
}

async fn drawn(client: &Client) -> Vec<Drawn> {
    serde_json::from_value(script(client, READ).await).unwrap()
}

/// The limits that the page shows.
async fn limits(client: &Client) -> (f64, f64) {
    let limits = texts(client, ".limits li").await;
    let limit = |place: usize, otherwise: f64| {
        let number = limits[place].split(' ').find_map(|part| part.parse().ok());
        number.unwrap_or(otherwise)
    };
    (limit(0, 68.0), limit(1, 0.2))
}

#[tokio::test]
async fn a_passenger_is_understood_from_pictures_of_drives() {
    with(Wishes::default(), async |browser: &Browser| {
        let client = &browser.client;
        let house = House::build();
        let mut page = begin(browser, &house.at("/"), "car").await;
        for _ in 0..MANY {
            match page.kind.as_str() {
                "done" => {
                    assert_eq!(limits(client).await, (40.0, 1.0));
                    press(client, "#download-json").await;
                    let text = browser.downloaded(".json").await;
                    let saved: Value = serde_json::from_str(&text).unwrap();
                    assert_eq!(saved["concept"]["limits"], serde_json::json!([40.0, 1.0]));
                    return;
                }
                "equivalence" => {
                    let (time, distance) = limits(client).await;
                    // What is meant, where the page's rule rejects it; or else what it
                    // accepts too much.
                    let wrong = if time < 40.0 || distance > 1.0 {
                        Some(("40", "1", true))
                    } else if time > 40.0 {
                        Some(("42", "3", false))
                    } else if distance < 1.0 {
                        Some(("12", "0.9", false))
                    } else {
                        None
                    };
                    page = match wrong {
                        None => page.click(client, "button[value=correct]").await,
                        Some((time, distance, label)) => {
                            fill(client, "#point-1", time).await;
                            fill(client, "#point-2", distance).await;
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
                    let comfortable: Vec<bool> = drawn(client)
                        .await
                        .iter()
                        .map(Drawn::is_comfortable)
                        .collect();
                    let said = match comfortable[..] {
                        [true] => "accept",
                        [false] => "reject",
                        [true, false] => "first",
                        [false, true] => "second",
                        _ => "equal",
                    };
                    let button = format!("button[name=answer][value={said}]");
                    page = page.click(client, &button).await;
                }
            }
        }
        panic!("no rule after {MANY} questions: {page:?}");
    })
    .await;
}
