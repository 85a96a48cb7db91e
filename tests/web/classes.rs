//! Sessions that learn no automaton: limits on what is measured, tables, and rewards.

use axum::http::StatusCode;
use serde_json::{Value, json};

use crate::api::create;
use crate::site::{Reply, Site};

/// Teaches a rule: `accepts` says what of a behaviour, as it is written. Accepted is
/// better than not, and all else is equal.
async fn teach(
    site: &Site,
    session: &str,
    key: &str,
    accepts: impl Fn(&Value) -> bool,
    wrong: impl Fn(&Value) -> Option<Value>,
) -> Value {
    for _ in 0..300 {
        let question = site.get(&format!("{session}/question")).await.json();
        let number = question["number"].clone();
        let reply = match question["kind"].as_str().unwrap() {
            "done" => return question,
            "membership" => {
                let answer = if accepts(&question[key]) {
                    "accept"
                } else {
                    "reject"
                };
                json!({"question": number, "answer": answer})
            }
            "comparison" => {
                let sides = ["first", "second"].map(|side| accepts(&question[side]));
                let answer = match sides {
                    [true, false] => "first",
                    [false, true] => "second",
                    _ => "equal",
                };
                json!({"question": number, "answer": answer})
            }
            "equivalence" => match wrong(&question["hypothesis"]) {
                None => json!({"question": number, "answer": "correct"}),
                Some(atom) => {
                    let label = accepts(&atom);
                    json!({"question": number, "answer": "counterexample", key: atom, "label": label})
                }
            },
            other => panic!("{other}: {question}"),
        };
        let replied = site.post(&format!("{session}/answers"), reply).await;
        assert_eq!(replied.status, StatusCode::OK, "{}", replied.text);
    }
    panic!("it does not end");
}

fn numbers(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().unwrap().iter();
    numbers.map(|number| number.as_f64().unwrap()).collect()
}

/// At most 40 seconds, and at least a metre away.
fn comfortable(point: &Value) -> bool {
    let point = numbers(point);
    point[0] <= 40.0 + 1e-9 && point[1] >= 1.0 - 1e-9
}

/// A drive on which the limits are wrong: at the limits that are meant, or just beyond
/// one of them.
fn wrong_about_drives(hypothesis: &Value) -> Option<Value> {
    let limits = numbers(&hypothesis["limits"]);
    let accepted = |point: &[f64]| point[0] <= limits[0] + 1e-9 && point[1] >= limits[1] - 1e-9;
    let drives = (0..29).flat_map(|time| {
        (0..29).map(move |distance| {
            [
                12.0 + 2.0 * f64::from(time),
                3.0 - f64::from(distance) / 10.0,
            ]
        })
    });
    let wrong = drives.map(|drive| (accepted(&drive), json!(drive)));
    wrong
        .filter(|(accepted, drive)| *accepted != comfortable(drive))
        .map(|(_, drive)| drive)
        .next_back()
}

/// What is learned is what was meant, also across restarts, and it is exported.
#[tokio::test]
async fn limits_are_taught_across_restarts() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    let session = create(&Site::at(&path), json!({"task": "car", "seed": 7})).await;
    let first = Site::at(&path).get(&format!("{session}/question")).await;
    let again = Site::at(&path).get(&format!("{session}/question")).await;
    assert_eq!(first.json(), again.json());
    let site = Site::at(&path);
    let done = teach(&site, &session, "point", comfortable, wrong_about_drives).await;
    let limits = numbers(&done["hypothesis"]["limits"]);
    assert!(
        (limits[0] - 40.0).abs() < 1e-9 && (limits[1] - 1.0).abs() < 1e-9,
        "{limits:?}"
    );

    let site = Site::at(&path);
    assert_eq!(site.get(&format!("{session}/question")).await.json(), done);
    let saved = site.get(&format!("{session}/concept")).await.json();
    assert_eq!(saved["format"], "memrep-monotone");
    assert_eq!(saved["concept"]["limits"], done["hypothesis"]["limits"]);
    assert_eq!(saved["concept"]["axes"][1]["unit"], "m");
    let no_automaton = site.get(&format!("{session}/automaton")).await;
    assert_eq!(no_automaton.json()["error"]["code"], "not_an_automaton");
    let no_bound = site
        .post(&format!("{session}/bound"), json!({"max_states": 50}))
        .await;
    assert_eq!(no_bound.json()["error"]["code"], "no_bound");

    // The pages say so in the units of the axes, with what was said on the way.
    let page = site.get(&session.replace("/api/v1", "")).await.text;
    assert!(page.contains("time of at most 40 s") && page.contains("distance of at least 1 m"));
    assert!(page.contains("class=\"said"), "{page}");
    assert!(!page.contains("<dt>states</dt>"));
    let history = format!("{}/history", session.replace("/api/v1", ""));
    let history = site.get(&history).await.text;
    assert!(history.contains("class=\"drive\""));
}

const MANNERS: &str = "behaviour,all,polite,quiet,none\nsize,1,2,2,1\ngreets,1,1,0,0\nwaits,1,1,1,0\nshouts,1,0,0,0\n";

#[tokio::test]
async fn a_concept_of_a_table_is_taught() {
    let site = Site::in_memory();
    let task = json!({"title": "Manners", "class": {"kind": "finite", "table": MANNERS}});
    let session = create(&site, json!({"task": task})).await;
    let polite = |item: &Value| item == "greets" || item == "waits";
    let columns = [
        ("all", vec!["greets", "waits", "shouts"]),
        ("polite", vec!["greets", "waits"]),
        ("quiet", vec!["waits"]),
        ("none", vec![]),
    ];
    let wrong = |hypothesis: &Value| {
        let named = |column: &&(&str, Vec<&str>)| hypothesis["concept"] == column.0;
        let accepted = &columns.iter().find(named).unwrap().1;
        let items = ["greets", "waits", "shouts"].into_iter();
        let mut wrong = items.filter(|item| accepted.contains(item) != polite(&json!(item)));
        wrong.next().map(|item| json!(item))
    };
    let done = teach(&site, &session, "item", polite, wrong).await;
    assert_eq!(done["hypothesis"], json!({"concept": "polite"}));
    let saved = site.get(&format!("{session}/concept")).await.json();
    assert_eq!(saved["format"], "memrep-finite");
    let page = site.get(&session.replace("/api/v1", "")).await.text;
    assert!(page.contains("“polite”"), "{page}");
}

fn drives() -> Value {
    serde_json::from_str(include_str!("../../examples/drives.json")).unwrap()
}

#[tokio::test]
async fn a_reward_is_taught() {
    let site = Site::in_memory();
    let file = drives();
    let task = json!({
        "class": {
            "kind": "linear",
            "features": ["speed", "nearness"],
            "finest": 9,
            "behaviours": file["behaviours"],
        },
        "examples": [{"item": "brushes a mirror", "label": false}],
    });
    let session = create(&site, json!({"task": task})).await;
    let sum = |weights: &[f64], name: &Value| -> f64 {
        let behaviours = file["behaviours"].as_array().unwrap();
        let behaviour = behaviours.iter().find(|b| b["name"] == *name).unwrap();
        let steps = behaviour["features"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers);
        steps
            .map(|step| step.iter().zip(weights).map(|(f, w)| f * w).sum::<f64>())
            .sum()
    };
    let weights = numbers(&file["weights"]);
    // Not the threshold of the file, which is the sum of a behaviour but for rounding.
    let threshold = 0.15;
    let likes = |item: &Value| sum(&weights, item) > threshold;
    let wrong = |hypothesis: &Value| {
        let weights = numbers(&hypothesis["weights"]);
        let threshold = hypothesis["threshold"].as_f64().unwrap();
        let behaviours = file["behaviours"].as_array().unwrap().iter();
        let mut names = behaviours.map(|behaviour| behaviour["name"].clone());
        names.find(|name| (sum(&weights, name) > threshold) != likes(name))
    };
    let done = teach(&site, &session, "item", likes, wrong).await;
    assert_eq!(wrong(&done["hypothesis"]), None);
    let page = site.get(&session.replace("/api/v1", "")).await.text;
    assert!(page.contains("each step counting speed"), "{page}");
}

/// A person shows by numbers where limits are wrong, without any script; what is no
/// number, and what the rule says already, is told at its field.
#[tokio::test]
async fn limits_are_refuted_by_a_form() {
    let site = Site::in_memory();
    let session = create(&site, json!({"task": "car"})).await;
    let pages = session.replace("/api/v1", "");
    let mut number = None;
    for _ in 0..100 {
        let question = site.get(&format!("{session}/question")).await.json();
        if question["kind"] == "equivalence" {
            number = question["number"].as_u64();
            break;
        }
        let reply = json!({"question": question["number"], "answer": if question["kind"] == "membership" { "accept" } else { "equal" }});
        site.post(&format!("{session}/answers"), reply).await;
    }
    let number = number.unwrap();
    let send = async |time: &str, distance: &str, label: &str| -> Reply {
        let number = number.to_string();
        let fields = [
            ("question", number.as_str()),
            ("point", time),
            ("point", distance),
            ("label", label),
        ];
        site.form(&format!("{pages}/answers"), &fields).await
    };
    for (time, distance, label, part) in [
        ("soon", "1", "false", "`soon` is no number"),
        (
            "5",
            "1",
            "false",
            "5 s is no time: give one from 12 s to 68 s",
        ),
        ("12", "3", "", "choose whether this should be accepted"),
        ("12", "3", "true", "the rule shown already accepts that"),
    ] {
        let reply = send(time, distance, label).await;
        assert_eq!(
            reply.status,
            StatusCode::UNPROCESSABLE_ENTITY,
            "{}",
            reply.text
        );
        let told = reply.text.replace("&#39;", "'");
        assert!(
            told.to_lowercase().contains(&part.to_lowercase()),
            "{part}: {told}"
        );
        assert!(
            reply.text.contains(&format!("value=\"{time}\"")),
            "what was typed stays"
        );
    }
    let reply = send("68", "0,2", "false").await;
    assert_eq!(reply.status, StatusCode::SEE_OTHER, "{}", reply.text);
    let question = site.get(&format!("{session}/question")).await.json();
    assert_ne!(question["number"], number);
}

/// Checks that such a class makes no session, and that its fault is told at this field.
async fn refused(class: Value, more: Value, field: &str, part: &str) {
    let site = Site::in_memory();
    let mut task = json!({"class": class});
    for (key, value) in more.as_object().unwrap() {
        task[key] = value.clone();
    }
    let reply = site.post("/api/v1/sessions", json!({"task": task})).await;
    assert_eq!(
        reply.status,
        StatusCode::UNPROCESSABLE_ENTITY,
        "{task}: {}",
        reply.text
    );
    let error = &reply.json()["error"];
    assert_eq!(error["field"], field, "{error}");
    let message = error["message"].as_str().unwrap().to_lowercase();
    assert!(message.contains(&part.to_lowercase()), "{error}");
    let sessions = site.get("/api/v1/sessions").await.json();
    assert_eq!(sessions["sessions"], json!([]));
}

#[tokio::test]
async fn faulty_axes_make_no_session() {
    let axis = json!({"name": "time", "unit": "s", "best": 10, "worst": 60});
    for (class, more, field, part) in [
        (
            json!({"kind": "odd"}),
            json!({}),
            "task.class.kind",
            "monotone",
        ),
        (
            json!({"kind": "monotone"}),
            json!({}),
            "task.class.axes",
            "name what is measured",
        ),
        (
            json!({"kind": "monotone", "axes": []}),
            json!({}),
            "task.class.axes",
            "give 1 to 4",
        ),
        (
            json!({"kind": "monotone", "axes": [{"name": "t", "best": 1, "worst": 1}]}),
            json!({}),
            "task.class.axes[0].worst",
            "something between",
        ),
        (
            json!({"kind": "monotone", "axes": [axis, axis]}),
            json!({}),
            "task.class.axes[1].name",
            "another axis",
        ),
        (
            json!({"kind": "monotone", "axes": [axis], "ticks": 1}),
            json!({}),
            "task.class.ticks",
            "between 2 and 1000",
        ),
        (
            json!({"kind": "monotone", "axes": [axis], "picture": "passing"}),
            json!({}),
            "task.class.picture",
            "two axes",
        ),
        (
            json!({"kind": "monotone", "axes": [axis], "ticks": 11}),
            json!({"symbols": ["a"]}),
            "task.symbols",
            "about words",
        ),
        (
            json!({"kind": "monotone", "axes": [axis], "ticks": 11}),
            json!({"examples": [{"point": [11], "label": true}]}),
            "task.examples[0].point[0]",
            "give 10 or 15",
        ),
        (
            json!({"kind": "monotone", "axes": [axis], "ticks": 11}),
            json!({"examples": [{"word": ["a"], "label": true}]}),
            "task.examples[0].word",
            "unknown key",
        ),
        (
            json!({"kind": "monotone", "axes": [axis], "ticks": 11}),
            json!({"examples": [{"point": [60], "label": true}, {"point": [10], "label": false}]}),
            "task.examples",
            "no rule",
        ),
    ] {
        refused(class, more, field, part).await;
    }
}

#[tokio::test]
async fn faulty_tables_and_rewards_make_no_session() {
    for (class, more, field, part) in [
        (
            json!({"kind": "finite"}),
            json!({}),
            "task.class.table",
            "give the table",
        ),
        (
            json!({"kind": "finite", "table": "manners.csv"}),
            json!({}),
            "task.class.table",
            "reads no files",
        ),
        (
            json!({"kind": "finite", "table": "x,a\ny,2\n"}),
            json!({}),
            "task.class.table",
            "line 2, column 3",
        ),
        (
            json!({"kind": "finite", "table": MANNERS}),
            json!({"practice": {"item": "sings", "answer": "accept", "why": "."}}),
            "task.practice.item",
            "greets, waits, shouts",
        ),
        (
            json!({"kind": "linear", "features": []}),
            json!({}),
            "task.class.features",
            "give 1 to 3",
        ),
        (
            json!({"kind": "linear", "features": ["a"], "behaviours": [{"name": "x", "features": [[2]]}]}),
            json!({}),
            "task.class.behaviours",
            "from 0 to 1",
        ),
        (
            json!({"kind": "linear", "features": ["a", "b"], "behaviours": [{"name": "x", "features": [[1]]}]}),
            json!({}),
            "task.class.behaviours",
            "features",
        ),
    ] {
        refused(class, more, field, part).await;
    }
}

/// The practice question is asked, answered and explained, and nothing is kept of it.
#[tokio::test]
async fn the_practice_question_is_explained_and_not_kept() {
    let site = Site::in_memory();
    let session = create(&site, json!({"task": "car"})).await;
    let log = site.get(&format!("{session}/log")).await.text;
    let pages = session.replace("/api/v1", "");
    let page = site.get(&pages).await;
    assert!(page.text.contains(&format!("href=\"{pages}/practice\"")));
    let practice = format!("{pages}/practice");
    let asked = site.get(&practice).await;
    assert_eq!(asked.main("data-kind"), "practice");
    assert_eq!(asked.text.matches("class=\"drive\"").count(), 2);
    assert!(!asked.text.contains("touch the other car"));
    for (answer, verdict) in [
        ("first", "Yes, that is what is meant."),
        ("second", "What is meant is: A is better."),
    ] {
        let told = site.form(&practice, &[("answer", answer)]).await;
        assert_eq!(told.status, StatusCode::OK);
        assert!(told.text.contains(verdict), "{}", told.text);
        assert!(told.text.contains("touch the other car"));
    }
    let nonsense = site.form(&practice, &[("answer", "maybe")]).await;
    assert_eq!(nonsense.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert_eq!(site.get(&format!("{session}/log")).await.text, log);
    let without = create(&site, json!({"task": "tomita:1"})).await;
    let none = format!("{}/practice", without.replace("/api/v1", ""));
    assert_eq!(site.get(&none).await.status, StatusCode::NOT_FOUND);
}

/// Answers that no limits fit are a conflict, which more states would not resolve:
/// there are none.
#[tokio::test]
async fn limits_that_contradict_each_other_are_mended_by_an_answer() {
    let site = Site::in_memory();
    let task = json!({
        "class": {"kind": "monotone", "ticks": 3, "axes": [{"name": "time", "best": 0, "worst": 2}]},
    });
    let body = json!({"task": task, "strategy": "membership"});
    let session = create(&site, body).await;
    let mut question = site.get(&format!("{session}/question")).await.json();
    // The worst is accepted, and whatever else is asked is not, nor is the best.
    while question["kind"] != "conflict" {
        let number = &question["number"];
        let reply = match question["kind"].as_str().unwrap() {
            "membership" => {
                let answer = if question["point"] == json!([2.0]) {
                    "accept"
                } else {
                    "reject"
                };
                json!({"question": number, "answer": answer})
            }
            "equivalence" => {
                let all = question["hypothesis"]["limits"] == json!([2.0]);
                let point = if all { [0] } else { [2] };
                json!({"question": number, "answer": "counterexample", "point": point, "label": !all})
            }
            other => panic!("{other}: {question}"),
        };
        let replied = site.post(&format!("{session}/answers"), reply).await;
        assert_eq!(replied.status, StatusCode::OK, "{}", replied.text);
        question = replied.json();
    }
    assert_eq!(question.get("bound"), None, "{question}");
    let page = site.get(&session.replace("/api/v1", "")).await.text;
    assert!(page.contains("No rule of the kind that this task learns fits"));
    assert!(!page.contains("more states"), "{page}");
}
