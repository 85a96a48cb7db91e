//! Whatever people call their tasks, symbols, behaviours and each other: it is text on
//! every page, and nothing in it runs.

use fantoccini::Client;
use serde_json::{Value, json};

use crate::driver::{Wishes, with};
use crate::house::House;
use crate::page::{Page, fill, press, script, typed};
use crate::studio::open;

/// Names that would like to be more. Each would leave a `blink` or set `window.hit`.
const NAMES: [&str; 8] = [
    "<script>window.hit=1</script>",
    "\"><img src=x onerror=window.hit=1><blink>",
    "' onmouseover='hit=1' autofocus onfocus='window.hit=1",
    "</script></title></textarea><svg onload=window.hit=1><blink>",
    "javascript:window.hit=1//<blink>&lt;b&gt;&#60;blink&#62;",
    "{{7*7}} ${7*7} {% raw %} __import__('os').system('id')",
    "=HYPERLINK(\"http://127.0.0.1\") \\\" \\' `id` $(id) ]]> --> */",
    "שלום عربى e\u{301}\u{301}\u{301} 👩‍🚀 ﷽",
];

/// What came of the names on this page; and all its text.
const LOOK: &str = r#"
    const bad = [];
    if (window.hit !== undefined) bad.push("a script ran");
    for (const element of document.querySelectorAll("*")) {
        if (element.matches("blink, iframe, object, embed, base, applet, frame")) bad.push(element.outerHTML);
        if (element.matches("script") && !new URL(element.src, location.href).pathname.startsWith("/static/")) bad.push(element.outerHTML);
        for (const {name, value} of element.attributes) {
            if (name.startsWith("on")) bad.push(`${name} of ${element.tagName}`);
            if (["href", "src", "action", "formaction", "xlink:href"].includes(name)
                && new URL(value, location.href).origin !== location.origin) bad.push(`${name}=${value}`);
        }
    }
    return {bad, text: document.title + " " + document.body.textContent};
"#;

/// A task with these names, from the `turn`-th on.
fn words(turn: usize) -> Value {
    let name = |place: usize| NAMES[(turn + place) % NAMES.len()];
    json!({
        "title": name(0),
        "guidelines": NAMES.join("\n\n"),
        "empty": name(1),
        "symbols": [{"name": "a", "word": name(2)}, {"name": "b", "word": name(3)}],
        "examples": [{"word": ["a", "b"], "label": true}],
        "practice": {"first": ["a"], "second": ["b", "a"], "answer": "first", "why": name(4)},
    })
}

/// A table whose behaviours have these names.
fn table() -> Value {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let rows = NAMES.iter().enumerate().map(|(place, name)| {
        let labels = [place % 2, usize::from(place > 3)].map(|label| label.to_string());
        format!("{},{}\n", quoted(name), labels.join(","))
    });
    let head = format!("behaviour,{},{}\n", quoted(NAMES[0]), quoted(NAMES[1]));
    let table = head + &rows.collect::<String>();
    json!({"title": "Manners", "class": {"kind": "finite", "table": table}})
}

/// What the API says to a request from the page that is shown.
async fn call(client: &Client, method: &str, path: &str, body: Value) -> Value {
    let send = r#"
        const [method, path, body, done] = arguments;
        fetch(path, {method, headers: {"content-type": "application/json"}, body: body && JSON.stringify(body)})
            .then((response) => response.json()).then(done, (error) => done({error: String(error)}));
    "#;
    let arguments = vec![method.into(), path.into(), body];
    client.execute_async(send, arguments).await.unwrap()
}

/// Nothing came of any name on the page at `path`, and these stand there as they are.
async fn is_text(client: &Client, house: &House, path: &str, names: &[&str]) {
    client.goto(&house.at(path)).await.unwrap();
    let found = script(client, LOOK).await;
    assert_eq!(found["bad"], json!([]), "{path}");
    let text = found["text"].as_str().unwrap();
    for name in names {
        assert!(text.contains(name), "{name} is not on {path}");
    }
}

/// Agrees with everything until the rule is right; every page on the way.
async fn teach(client: &Client, house: &House, session: &str) {
    for _ in 0..12 {
        let api = format!("/api/v1{session}");
        let question = call(client, "GET", &format!("{api}/question"), Value::Null).await;
        is_text(client, house, session, &[]).await;
        is_text(client, house, &format!("{session}/why"), &[]).await;
        let answer = match question["kind"].as_str().unwrap() {
            "membership" => "accept",
            "comparison" => "equal",
            "equivalence" => "correct",
            _ => return,
        };
        let body = json!({"question": question["number"], "answer": answer});
        let reply = call(client, "POST", &format!("{api}/answers"), body).await;
        assert_eq!(reply["error"], Value::Null, "{reply}");
    }
    panic!("{session} does not end");
}

#[tokio::test]
async fn names_are_text_on_every_page() {
    with(Wishes::default(), async |browser| {
        let client = &browser.client;
        let house = House::build();
        client.goto(&house.at("/")).await.unwrap();
        let mut sessions = Vec::new();
        for task in (0..NAMES.len()).map(words).chain([table()]) {
            let begun = call(client, "POST", "/api/v1/sessions", json!({"task": task})).await;
            let id = begun["id"].as_str().unwrap_or_else(|| panic!("{begun}"));
            sessions.push(format!("/sessions/{id}"));
        }
        is_text(client, &house, "/", &NAMES).await;
        for session in [&sessions[0], &sessions[3], &sessions[8]] {
            teach(client, &house, session).await;
            is_text(client, &house, session, &[]).await;
            is_text(client, &house, &format!("{session}/history"), &[]).await;
        }
        for (turn, session) in sessions[..8].iter().enumerate() {
            let api = format!("/api/v1{session}/people");
            for name in NAMES.map(|name| name.chars().take(60).collect::<String>()) {
                let reply = call(client, "POST", &api, json!({"name": name})).await;
                assert_eq!(reply["error"], Value::Null, "{reply}");
            }
            is_text(client, &house, session, &[NAMES[turn]]).await;
            for part in ["history", "practice", "people"] {
                let path = format!("{session}/{part}");
                is_text(client, &house, &path, &[NAMES[turn]]).await;
            }
        }
        // An invited person's pages, and what a form shows again with its faults.
        let api = format!("/api/v1{}/people", sessions[1]);
        let invited = call(client, "POST", &api, json!({"name": NAMES[2]})).await;
        let link = invited["link"]
            .as_str()
            .unwrap_or_else(|| panic!("{invited}"));
        is_text(client, &house, link, &[]).await;
        let door = Page::now(client).await;
        door.click(client, "main button").await;
        let place = client.current_url().await.unwrap().path().to_owned();
        for part in ["", "/history", "/practice"] {
            let path = format!("{place}{part}");
            is_text(client, &house, &path, &[NAMES[1]]).await;
        }
        client.goto(&house.at("/")).await.unwrap();
        press(client, ".uploads summary").await;
        for name in NAMES {
            fill(client, "#symbols", name).await;
            let page = Page::now(client).await;
            page.click(client, "#own-task button.primary").await;
            let found = script(client, LOOK).await;
            assert_eq!(found["bad"], json!([]), "{name}");
            assert_eq!(typed(client, "#symbols").await, name);
        }
        contradict(client, &house).await;
        for (turn, name) in NAMES.iter().enumerate() {
            open(client, &words(turn).to_string()).await;
            let studio = Page::now(client).await;
            assert_eq!(studio.kind, "studio");
            let found = script(client, LOOK).await;
            assert_eq!(found["bad"], json!([]), "the studio with {name}");
            assert_eq!(typed(client, "#title").await, *name);
            let place = format!("/sign-in?to=/{}", escaped(name));
            is_text(client, &house, &place, &[]).await;
        }
    })
    .await;
}

/// Answers that no rule of one state explains, and the page that says so.
async fn contradict(client: &Client, house: &House) {
    let mut task = words(5);
    task["max_states"] = 1.into();
    let new = json!({"task": task, "comparison_cost": "inf"});
    let begun = call(client, "POST", "/api/v1/sessions", new).await;
    let session = begun["id"].as_str().unwrap_or_else(|| panic!("{begun}"));
    let api = format!("/api/v1/sessions/{session}");
    for _ in 0..5 {
        let question = call(client, "GET", &format!("{api}/question"), Value::Null).await;
        let mut answer = json!({"question": question["number"], "answer": "reject"});
        match question["kind"].as_str().unwrap() {
            "membership" => {}
            "equivalence" => {
                answer["answer"] = "counterexample".into();
                answer["word"] = json!(["b"]);
                answer["label"] = false.into();
            }
            "conflict" => {
                is_text(client, house, &format!("/sessions/{session}"), &[NAMES[5]]).await;
                return;
            }
            other => panic!("{other}: {question}"),
        }
        let reply = call(client, "POST", &format!("{api}/answers"), answer).await;
        assert_eq!(reply["error"], Value::Null, "{reply}");
    }
    panic!("no contradiction");
}

/// A text as part of an address.
fn escaped(text: &str) -> String {
    let bytes: Vec<String> = text.bytes().map(|byte| format!("%{byte:02X}")).collect();
    bytes.concat()
}
