//! Every kind of contradiction is named in words, with the person's own answers
//! and no others, by the API and on the page.

use std::collections::BTreeMap;

use memrep::oracle::{Order, ScriptedTeacher, Target, TeacherSettings};
use serde_json::{Value, json};

use crate::api::{answer, create};
use crate::site::Site;

/// What the page says of a conflict of this many answers.
fn heading(answers: usize) -> String {
    match answers {
        1 => "This answer can’t be true".to_owned(),
        2 => "These two answers can’t both be true".to_owned(),
        many => format!("These {many} answers can’t all be true"),
    }
}

/// The words that tell a cause, by the number of answers and whether one of them
/// compares.
fn words(cause: &str, single: bool, compares: bool) -> &'static str {
    match (cause, single, compares) {
        ("order", false, true) => "better than itself",
        ("equality", false, true) => "that they are equally good, and that one is better",
        ("membership", false, true) => "They make something acceptable no better than something",
        ("membership", false, false) => "They call the same thing acceptable and not acceptable",
        ("states", false, _) => "states fits them. A larger rule would.",
        ("states", true, _) => "states fits it together with what was known",
        other => panic!("{other:?}"),
    }
}

/// Somebody teaches the truth, and then changes one answer after the other, and
/// back: so comes about what no new question would bring.
#[tokio::test]
async fn each_kind_is_told_in_words() {
    let site = Site::in_memory();
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for (name, seed) in [("tomita:4", 1), ("tomita:7", 2), ("tomita:7", 3)] {
        let target = Target::named(name).unwrap();
        let alphabet = target.dfa().alphabet().clone();
        let settings = TeacherSettings {
            order: Order::Random,
            seed,
            ..TeacherSettings::default()
        };
        let mut teacher = ScriptedTeacher::new(&target, settings);
        let task = json!({
            "symbols": ["0", "1"],
            "max_states": target.dfa().size(),
            "examples": [{"word": [], "label": true}],
        });
        let body = json!({"task": task, "membership_cost": 8, "strategy": "thesis", "seed": seed});
        let api = create(&site, body).await;
        let id = api.rsplit('/').next().unwrap();
        let mut given: BTreeMap<u64, Value> = BTreeMap::new();
        let mut kinds: BTreeMap<u64, bool> = BTreeMap::new();
        loop {
            let question = site.get(&format!("{api}/question")).await.json();
            if question["kind"] == "done" {
                break;
            }
            let number = question["number"].as_u64().unwrap();
            let reply = answer(&mut teacher, &alphabet, &question);
            kinds.insert(number, question["kind"] == "comparison");
            if question["kind"] != "equivalence" {
                given.insert(number, reply["answer"].clone());
            }
            let next = site.post(&format!("{api}/answers"), reply).await;
            assert!(next.status.is_success(), "{}", next.text);
        }
        for (number, right) in given {
            let others: &[&str] = if kinds[&number] {
                &["first", "second", "equal"]
            } else {
                &["accept", "reject"]
            };
            for wrong in others.iter().filter(|wrong| right != **wrong) {
                let change = |to: Value| json!({"question": number, "answer": to});
                let changes = format!("{api}/changes");
                let now = site.post(&changes, change((*wrong).into())).await.json();
                if now["kind"] == "conflict" {
                    let answers = now["answers"].as_array().unwrap();
                    assert!(answers.contains(&number.into()), "the others are true");
                    check(&site, id, &now, &kinds, &mut seen).await;
                }
                let back = site.post(&changes, change(right.clone())).await.json();
                assert_eq!(back["kind"], "done", "{back}");
            }
        }
    }
    for kind in ["order", "equality", "membership", "states"] {
        assert!(seen.get(kind).is_some_and(|count| *count > 0), "{seen:?}");
    }
}

/// An answer that cannot stand beside what was given is alone on its page.
#[tokio::test]
async fn a_single_answer_is_spoken_of_as_one() {
    let site = Site::in_memory();
    // What leads away from the start leads back to it, so `a b` is accepted.
    let examples = ["", "a", "aa", "b", "bb"].map(|word| {
        let symbols: Vec<String> = word.chars().map(String::from).collect();
        json!({"word": symbols, "label": word.len() % 2 == 0})
    });
    let task = json!({"symbols": ["a", "b"], "max_states": 2, "examples": examples});
    let created = site.post("/api/v1/sessions", json!({"task": task})).await;
    let id = created.json()["id"].as_str().unwrap().to_owned();
    let api = format!("/api/v1/sessions/{id}");
    let question = site.get(&format!("{api}/question")).await.json();
    assert_eq!(question["kind"], "equivalence", "{question}");
    let number = question["number"].as_u64().unwrap();
    let answer =
        json!({"question": number, "answer": "counterexample", "word": ["a", "b"], "label": false});
    let conflict = site.post(&format!("{api}/answers"), answer).await.json();
    assert_eq!(conflict["kind"], "conflict", "{conflict}");
    let mut seen = BTreeMap::new();
    check(
        &site,
        &id,
        &conflict,
        &BTreeMap::from([(number, false)]),
        &mut seen,
    )
    .await;
    assert_eq!(seen["states"], 1);
    assert_eq!(seen["single"], 1);
}

/// What the page says would follow if this answer was withdrawn.
fn follows(page: &str, number: u64) -> String {
    let place = format!("id=\"follows-{number}\">");
    let told = page.split(&place).nth(1).unwrap_or_default();
    told.split('<').next().unwrap().to_owned()
}

/// What is said to follow is what follows.
#[tokio::test]
async fn what_follows_is_told_and_comes_true() {
    let (mut agreed, mut still) = (0, 0);
    for seed in 0..6 {
        let site = Site::in_memory();
        let target = Target::named("tomita:7").unwrap();
        let settings = TeacherSettings {
            order: Order::Random,
            seed,
            ..TeacherSettings::default()
        };
        let mut teacher = ScriptedTeacher::new(&target, settings);
        let body =
            json!({"task": "tomita:7", "strategy": "thesis", "seed": seed, "membership_cost": 8});
        let api = create(&site, body).await;
        let page = api.replace("/api/v1", "");
        let mut compared = Vec::new();
        loop {
            let question = site.get(&format!("{api}/question")).await.json();
            if question["kind"] == "done" {
                break;
            }
            let reply = answer(&mut teacher, target.dfa().alphabet(), &question);
            if ["first", "second"]
                .iter()
                .any(|said| reply["answer"] == *said)
            {
                compared.push(reply.clone());
            }
            site.post(&format!("{api}/answers"), reply).await;
        }
        // One lie after another, until there is no more to mend.
        for reply in compared.iter().step_by(2) {
            let lie = if reply["answer"] == "first" {
                "second"
            } else {
                "first"
            };
            let lie = json!({"question": reply["question"], "answer": lie});
            site.post(&format!("{api}/changes"), lie).await;
        }
        for _ in 0..compared.len() {
            let now = site.get(&format!("{api}/question")).await.json();
            if now["kind"] != "conflict" {
                break;
            }
            let number = now["answers"][0].as_u64().unwrap();
            let told = follows(&site.get(&page).await.text, number);
            let body = json!({"question": number});
            let then = site.post(&format!("{api}/retractions"), body).await.json();
            let is_conflict = then["kind"] == "conflict";
            assert_eq!(told.contains("still can’t"), is_conflict, "{told}: {then}");
            assert_eq!(
                told.contains("your answers agree"),
                !is_conflict,
                "{told}: {then}"
            );
            agreed += usize::from(!is_conflict);
            still += usize::from(is_conflict);
        }
    }
    assert!(agreed > 0 && still > 0, "{agreed}, {still}");
}

async fn check(
    site: &Site,
    id: &str,
    conflict: &Value,
    kinds: &BTreeMap<u64, bool>,
    seen: &mut BTreeMap<String, usize>,
) {
    let cause = conflict["cause"].as_str().unwrap();
    let answers: Vec<u64> = (conflict["answers"].as_array().unwrap().iter())
        .map(|number| number.as_u64().unwrap())
        .collect();
    let single = answers.len() == 1;
    let compares = answers.iter().any(|number| kinds[number]);
    let expected = words(cause, single, compares);
    let message = conflict["message"].as_str().unwrap();
    assert!(message.contains(expected), "{message}");
    let look = async || site.get(&format!("/sessions/{id}")).await.text;
    let mut page = look().await;
    // A page does not wait long for what would follow: a busy machine is asked again.
    for _ in 0..20 {
        if answers
            .iter()
            .all(|number| !follows(&page, *number).is_empty())
        {
            break;
        }
        page = look().await;
    }
    assert!(page.contains(message), "{message}: {page}");
    assert!(page.contains(&heading(answers.len())), "{page}");
    for number in &answers {
        let told = follows(&page, *number);
        assert!(told.starts_with("Then "), "question {number}: {told}");
    }
    assert_eq!(page.contains("allow more states"), cause == "states");
    let mend = match (single, cause) {
        (true, "states") => "if it is wrong, change or withdraw it.",
        (false, "states") => "if one is wrong, change or withdraw it.",
        (true, _) => "Change or withdraw it;",
        (false, _) => "Change or withdraw one;",
    };
    assert!(page.contains(mend), "{mend}: {page}");
    let cards: Vec<u64> = (page.split("id=\"answer-").skip(1))
        .map(|card| card.split('"').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(cards, answers, "the answers, and nothing that was given");
    *seen.entry(cause.to_owned()).or_default() += 1;
    *seen.entry("single".to_owned()).or_default() += usize::from(single);
}
