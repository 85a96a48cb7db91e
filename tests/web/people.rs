//! Several people who answer for one session, over HTTP: blind to each other, a
//! question each, and an owner who sees how far they agree.

use std::time::Duration;

use axum::http::StatusCode;
use serde_json::{Value, json};

use crate::api::create;
use crate::site::{Reply, Site};

/// Long enough that it does not end in a test.
const LONG: Duration = Duration::from_secs(600);

/// A session of Tomita 4 whose questions want so many answers.
async fn session(site: &Site, answers: u32) -> String {
    let session = create(site, json!({"task": "tomita:4", "seed": 3})).await;
    let terms = json!({"answers": answers});
    let set = site.post(&format!("{session}/people/terms"), terms).await;
    assert_eq!(set.status, StatusCode::OK, "{}", set.text);
    session
}

/// Invites people; the paths at which they answer by the API.
async fn invite(site: &Site, session: &str, names: &[&str]) -> Vec<String> {
    let mut paths = Vec::new();
    for name in names {
        let made = site
            .post(&format!("{session}/people"), json!({"name": name}))
            .await;
        assert_eq!(made.status, StatusCode::CREATED, "{}", made.text);
        paths.push(format!("/api/v1{}", made.json()["link"].as_str().unwrap()));
    }
    paths
}

fn is_accepted(word: &Value) -> bool {
    let symbols = word.as_array().unwrap();
    !(symbols.windows(3)).any(|three| three.iter().all(|symbol| symbol == "0"))
}

/// What somebody who knows the rule says.
fn honest(question: &Value) -> &'static str {
    if question["kind"] == "membership" {
        let accepted = is_accepted(&question["word"]);
        return if accepted { "accept" } else { "reject" };
    }
    match (
        is_accepted(&question["first"]),
        is_accepted(&question["second"]),
    ) {
        (true, false) => "first",
        (false, true) => "second",
        _ => "equal",
    }
}

async fn say(site: &Site, path: &str, question: &Value, answer: &str) -> Reply {
    let reply = json!({"question": question["number"], "answer": answer});
    site.post(path, reply).await
}

/// The owner says whether the rule on the table is right.
async fn judge(site: &Site, session: &str, question: &Value) {
    let rule = &question["hypothesis"];
    let run = |word: &[u8]| {
        let mut state = rule["start"].as_u64().unwrap();
        for symbol in word {
            let alphabet = rule["alphabet"].as_array().unwrap();
            let symbol = json!(symbol.to_string());
            let place = alphabet.iter().position(|name| *name == symbol);
            state = rule["delta"][state as usize][place.unwrap()]
                .as_u64()
                .unwrap();
        }
        rule["accepting"]
            .as_array()
            .unwrap()
            .contains(&json!(state))
    };
    let wrong = (0..9_u32).flat_map(|length| {
        (0..1_u32 << length)
            .map(move |bits| -> Vec<u8> { (0..length).map(|at| (bits >> at & 1) as u8).collect() })
    });
    let names = |word: &[u8]| json!(word.iter().map(u8::to_string).collect::<Vec<_>>());
    let wrong = wrong
        .map(|word| (names(&word), run(&word)))
        .find(|(names, says)| is_accepted(names) != *says);
    let reply = match wrong {
        None => json!({"question": question["number"], "answer": "correct"}),
        Some((word, says)) => json!({
            "question": question["number"], "answer": "counterexample", "word": word, "label": !says,
        }),
    };
    let judged = site.post(&format!("{session}/answers"), reply).await;
    assert_eq!(judged.status, StatusCode::OK, "{}", judged.text);
}

#[tokio::test]
async fn three_people_teach_one_rule() {
    for (answers, pooling) in [(1, "majority"), (2, "majority"), (3, "reliability")] {
        let site = Site::with_lease(LONG);
        let session = session(&site, answers).await;
        let terms = json!({"pooling": pooling});
        site.post(&format!("{session}/people/terms"), terms).await;
        let people = invite(&site, &session, &["Ada", "Bea", "Cem"]).await;
        let (mut said, mut repeated) = (0, 0);
        loop {
            let mut waiting = 0;
            for person in &people {
                let question = site.get(person).await.json();
                match question["kind"].as_str().unwrap() {
                    "waiting" | "done" => waiting += 1,
                    _ => {
                        repeated += usize::from(question["repeated"] == true);
                        said += 1;
                        let reply = say(&site, person, &question, honest(&question)).await;
                        assert_eq!(reply.status, StatusCode::OK, "{}", reply.text);
                    }
                }
            }
            assert!(said < 500, "it ends");
            let question = site.get(&format!("{session}/question")).await.json();
            match question["kind"].as_str().unwrap() {
                "done" => break,
                "equivalence" if waiting == people.len() => {
                    judge(&site, &session, &question).await;
                }
                "equivalence" | "membership" | "comparison" => {}
                other => panic!("{other}: {question}"),
            }
        }
        let done = site.get(&session).await.json();
        assert_eq!(done["hypothesis"]["states"], 4, "{done}");
        let told = site.get(&format!("{session}/people")).await.json();
        let same = &told["agreement"]["same"];
        assert!(same.is_null() || *same == json!(1.0), "{told}");
        assert!(
            repeated > 0 || said < 24,
            "of {said} answers some are asked for again"
        );
        let answered = |key: &str| -> u64 {
            let people = told["people"].as_array().unwrap().iter();
            people.map(|person| person[key].as_u64().unwrap()).sum()
        };
        assert_eq!(answered("repeated"), repeated as u64);
        assert_eq!(answered("consistent"), repeated as u64);
        assert_eq!(answered("answers") + answered("repeated"), said);
        if answers > 1 {
            assert!(
                told["agreement"]["questions"].as_u64().unwrap() > 5,
                "{told}"
            );
        }
    }
}

/// A person sees questions, and what they said themselves.
#[tokio::test]
async fn people_are_blind_to_each_other_and_to_the_session() {
    let site = Site::with_lease(LONG);
    let session = session(&site, 2).await;
    let people = invite(&site, &session, &["Ada", "Bea"]).await;
    let mut pages = Vec::new();
    for path in &people {
        pages.push(site.enter(&path.replace("/api/v1", "")).await);
    }
    let question = site.get(&people[0]).await.json();
    say(&site, &people[0], &question, honest(&question)).await;
    let id = session.rsplit('/').next().unwrap();
    for path in [
        pages[1].clone(),
        format!("{}/history", pages[1]),
        people[1].clone(),
    ] {
        let page = site.get(&path).await;
        assert_eq!(page.status, StatusCode::OK, "{path}: {}", page.text);
        for hidden in [
            id,
            "Ada",
            "bar-left",
            "removed",
            "Why this question",
            "rules",
        ] {
            assert!(
                !page.text.contains(hidden),
                "{path} tells {hidden}: {}",
                page.text
            );
        }
    }
    let other = site.get(&people[1]).await.json();
    assert_eq!(other["number"], question["number"], "it wants two answers");
    for path in ["why", "people", "log", "automaton", "bound"] {
        let page = site.get(&format!("{}/{path}", pages[1])).await;
        assert_eq!(page.status, StatusCode::NOT_FOUND, "{path}");
    }
    // The owner has all of it.
    let owner = site
        .get(&format!("{session}/people").replace("/api/v1", ""))
        .await;
    assert!(owner.text.contains("Ada") && owner.text.contains("Bea"));
}

/// Two people are not put to the same question where one answer is enough; and a
/// question that is left lying goes to somebody else.
#[tokio::test]
async fn a_lease_runs_out() {
    let lease = Duration::from_millis(400);
    let site = Site::with_lease(lease);
    let session = session(&site, 1).await;
    let people = invite(&site, &session, &["Ada", "Bea", "Cem"]).await;
    let first = site.get(&people[0]).await.json();
    let second = site.get(&people[1]).await.json();
    assert_ne!(first["number"], second["number"]);
    assert_ne!(
        (&first["first"], &first["second"]),
        (&second["first"], &second["second"])
    );
    let again = site.get(&people[0]).await.json();
    assert_eq!(
        first["number"], again["number"],
        "looking again changes nothing"
    );
    tokio::time::sleep(lease + Duration::from_millis(100)).await;
    let third = site.get(&people[2]).await.json();
    assert_eq!(third["number"], first["number"], "nobody is at it any more");
    let taken = say(&site, &people[2], &third, honest(&third)).await;
    assert_eq!(taken.status, StatusCode::OK, "{}", taken.text);
    // Ada comes back to a question that is answered: nothing is counted twice.
    let late = say(&site, &people[0], &first, honest(&first)).await;
    assert_eq!(late.status, StatusCode::CONFLICT, "{}", late.text);
    assert_eq!(late.json()["error"]["code"], "question_closed");
    let form = [
        ("question", first["number"].to_string()),
        ("answer", honest(&first).to_owned()),
    ];
    let form: Vec<(&str, &str)> = form.iter().map(|(k, v)| (*k, v.as_str())).collect();
    let page = site.enter(&people[0].replace("/api/v1", "")).await;
    let shown = site.form(&format!("{page}/answers"), &form).await;
    assert_eq!(shown.status, StatusCode::CONFLICT);
    assert!(shown.text.contains("is closed"), "{}", shown.text);
    assert_ne!(shown.main("data-question"), first["number"].to_string());
    let state = site.get(&session).await.json();
    assert_eq!(state["answers"].as_array().unwrap().len(), 1);
}

#[tokio::test]
async fn a_disagreement_is_shown_and_resolved() {
    let site = Site::with_lease(LONG);
    let session = session(&site, 2).await;
    let people = invite(&site, &session, &["Ada", "Bea"]).await;
    let question = site.get(&people[0]).await.json();
    let (one, other) = match question["kind"].as_str().unwrap() {
        "membership" => ("accept", "reject"),
        _ => ("first", "second"),
    };
    say(&site, &people[0], &question, one).await;
    let otherwise = say(&site, &people[0], &question, other).await;
    assert_eq!(otherwise.status, StatusCode::CONFLICT);
    assert_eq!(otherwise.json()["error"]["code"], "already_answered");
    say(&site, &people[1], &question, other).await;
    let told = site.get(&format!("{session}/people")).await.json();
    assert_eq!(told["disputes"], json!([question["number"]]), "{told}");
    assert_eq!(told["agreement"]["same"], 0.0);
    let state = site.get(&session).await.json();
    assert_eq!(state["answers"], json!([]), "nothing is taken from it");
    let page = site
        .get(&format!("{session}/people").replace("/api/v1", ""))
        .await;
    assert!(
        page.text.contains("Where they do not agree"),
        "{}",
        page.text
    );
    // They go on with something else meanwhile.
    let next = site.get(&people[0]).await.json();
    assert_ne!(next["number"], question["number"]);
    let number = question["number"].to_string();
    let form = [("question", number.as_str()), ("answer", honest(&question))];
    let home = session.replace("/api/v1", "");
    let resolved = site.form(&format!("{home}/answers"), &form).await;
    assert_eq!(resolved.location(), home);
    let told = site.get(&format!("{session}/people")).await.json();
    assert_eq!(told["disputes"], json!([]));
    let state = site.get(&session).await.json();
    assert_eq!(state["answers"], json!([question["number"]]));
    // Taking one's own answer back is no way round the owner's.
    let taken = json!({"question": question["number"]});
    let taken = site
        .post(&format!("{}/retractions", people[0]), taken)
        .await;
    assert_eq!(taken.status, StatusCode::OK, "{}", taken.text);
    let state = site.get(&session).await.json();
    assert_eq!(state["answers"], json!([question["number"]]));
}

#[tokio::test]
async fn a_link_ends() {
    let site = Site::with_lease(LONG);
    let session = session(&site, 1).await;
    let people = invite(&site, &session, &["Ada", "Bea"]).await;
    let owner = format!("{session}/people").replace("/api/v1", "");
    let entered = site.enter(&people[0].replace("/api/v1", "")).await;
    assert_eq!(site.get(&entered).await.status, StatusCode::OK);
    let new = site.form(&format!("{owner}/1/link"), &[]).await;
    assert_eq!(new.status, StatusCode::OK, "{}", new.text);
    let path = new.text.split("value=\"/answer/").nth(1).unwrap();
    let path = format!("/answer/{}", path.split('"').next().unwrap());
    assert_eq!(
        site.get(&entered).await.status,
        StatusCode::NOT_FOUND,
        "the visit ends with the link"
    );
    let old = site.get(&people[0].replace("/api/v1", "")).await;
    assert_eq!(old.status, StatusCode::NOT_FOUND);
    assert!(old.text.contains("ask whoever sent it"), "{}", old.text);
    let now = site.enter(&path).await;
    assert_eq!(site.get(&now).await.status, StatusCode::OK);
    assert!(
        !site.get(&owner).await.text.contains(&path),
        "it is shown once"
    );
    let ended = site.form(&format!("{owner}/1/dismissal"), &[]).await;
    assert_eq!(ended.location(), owner);
    assert_eq!(site.get(&path).await.status, StatusCode::NOT_FOUND);
    assert_eq!(site.get(&now).await.status, StatusCode::NOT_FOUND);
    // As from a page that was open before.
    let back = site.form(&format!("{owner}/1/link"), &[]).await;
    assert_eq!(back.status, StatusCode::CONFLICT, "{}", back.text);
    assert!(back.text.contains("invite them anew"), "{}", back.text);
    let other = site.get(&people[1]).await;
    assert_eq!(other.status, StatusCode::OK, "the others go on");
    for nobody in ["/answer/zz", "/answer/00000000000000000000000000000000"] {
        let page = site.get(nobody).await;
        assert_eq!(page.status, StatusCode::NOT_FOUND, "{nobody}");
    }
    assert_eq!(
        site.form(&format!("{owner}/7/link"), &[]).await.status,
        StatusCode::NOT_FOUND
    );
}

#[tokio::test]
async fn what_cannot_be_meant_is_refused() {
    let site = Site::with_lease(LONG);
    let session = session(&site, 1).await;
    let people = invite(&site, &session, &["Ada"]).await;
    let long = "x".repeat(61);
    for (path, body, field) in [
        ("people", json!({}), "name"),
        ("people", json!({"name": ""}), "name"),
        ("people", json!({"name": " \n"}), "name"),
        ("people", json!({"name": "a\u{0}b"}), "name"),
        ("people", json!({"name": "a\u{202e}b"}), "name"),
        ("people", json!({"name": long}), "name"),
        ("people/terms", json!({"answers": 0}), "answers"),
        ("people/terms", json!({"answers": 21}), "answers"),
        ("people/terms", json!({"pooling": "loudest"}), "pooling"),
        ("people/terms", json!({"shows_rule": "yes"}), "shows_rule"),
        ("people/terms", json!({"rule": 1}), "rule"),
    ] {
        let refused = site.post(&format!("{session}/{path}"), body.clone()).await;
        assert_eq!(
            refused.status,
            StatusCode::UNPROCESSABLE_ENTITY,
            "{body}: {}",
            refused.text
        );
        assert_eq!(refused.json()["error"]["field"], field, "{body}");
    }
    for hidden in ["a\u{0}b", "a\nb", "a\u{202e}b"] {
        let refused = site
            .post(&format!("{session}/people"), json!({"name": hidden}))
            .await;
        let message = &refused.json()["error"]["message"];
        assert!(
            message.as_str().unwrap().contains("control characters"),
            "{hidden:?}: {message}"
        );
    }
    let question = site.get(&people[0]).await.json();
    for answer in ["correct", "accept", "first"] {
        let fits = match question["kind"].as_str().unwrap() {
            "membership" => answer == "accept",
            _ => answer == "first",
        };
        if !fits {
            let refused = say(&site, &people[0], &question, answer).await;
            assert!(
                refused.status.is_client_error(),
                "{answer}: {}",
                refused.text
            );
        }
    }
    let once = say(&site, &people[0], &question, honest(&question)).await;
    let twice = say(&site, &people[0], &question, honest(&question)).await;
    assert_eq!(
        (once.status, twice.status),
        (StatusCode::OK, StatusCode::OK)
    );
    let told = site.get(&format!("{session}/people")).await.json();
    assert_eq!(told["people"][0]["answers"], 1, "it counts once");
    let hostile = "<script>alert(1)</script>'\"{{7*7}}";
    invite(&site, &session, &[hostile]).await;
    let page = site
        .get(&format!("{session}/people").replace("/api/v1", ""))
        .await;
    assert!(!page.text.contains("<script>alert"), "a name stays text");
}

#[tokio::test]
async fn everybody_may_teach_alone() {
    let site = Site::with_lease(LONG);
    let session = create(&site, json!({"task": "tomita:4", "seed": 3})).await;
    let terms = json!({"pooling": "alone"});
    site.post(&format!("{session}/people/terms"), terms).await;
    let people = invite(&site, &session, &["Ada", "Bea", "Cem"]).await;
    assert!(
        people
            .iter()
            .all(|path| path.starts_with("/api/v1/sessions/"))
    );
    for own in &people[..2] {
        for _ in 0..200 {
            let question = site.get(&format!("{own}/question")).await.json();
            match question["kind"].as_str().unwrap() {
                "done" => break,
                "equivalence" => judge(&site, own, &question).await,
                _ => {
                    let path = format!("{own}/answers");
                    let said = say(&site, &path, &question, honest(&question)).await;
                    assert_eq!(said.status, StatusCode::OK, "{}", said.text);
                }
            }
        }
    }
    let page = site
        .get(&format!("{session}/people").replace("/api/v1", ""))
        .await;
    let table = page
        .text
        .split("id=\"alone-people\"")
        .nth(1)
        .expect("a table");
    let table = table.split("</table>").next().unwrap();
    assert_eq!(
        table.matches("<td>done</td><td>1</td>").count(),
        2,
        "{table}"
    );
    assert_eq!(
        table.matches("<td>answering</td><td>–</td>").count(),
        1,
        "{table}"
    );
    // The session itself is still its owner's to teach.
    let question = site.get(&format!("{session}/question")).await.json();
    let said = say(
        &site,
        &format!("{session}/answers"),
        &question,
        honest(&question),
    )
    .await;
    assert_eq!(said.status, StatusCode::OK, "{}", said.text);
}
