//! A rule is checked and its result read without script: what it does with a
//! behaviour, samples, a counterexample that cannot happen, and the same once more.

use axum::http::StatusCode;
use serde_json::{Value, json};

use crate::api::create;
use crate::site::{Reply, Site};

/// A small room in which water is one step away and recharge two.
fn room() -> Value {
    json!({
        "name": "room",
        "symbols": [{"name": "B", "word": "water"}, {"name": "Y", "word": "recharge"}],
        "world": {"kind": "grid", "map": ["SB.", ".#.", "..Y"], "steps": 8},
        "examples": [{"word": ["Y"], "label": true}, {"word": ["B"], "label": false}],
    })
}

/// Answers as one who wants to end at a recharge, until a rule is on show.
async fn to_the_rule(site: &Site, api: &str) -> Reply {
    let at = api.strip_prefix("/api/v1").unwrap();
    for _ in 0..100 {
        let question = site.get(&format!("{api}/question")).await.json();
        let ends = |key: &str| question[key].as_array().unwrap().last() == Some(&json!("Y"));
        let answer = match question["kind"].as_str().unwrap() {
            "membership" if ends("word") => "accept",
            "membership" => "reject",
            "comparison" => match (ends("first"), ends("second")) {
                (true, false) => "first",
                (false, true) => "second",
                _ => "incomparable",
            },
            "equivalence" => return site.get(at).await,
            other => panic!("{other}"),
        };
        let reply = json!({"question": question["number"], "answer": answer});
        site.post(&format!("{api}/answers"), reply).await;
    }
    panic!("no rule");
}

/// The hidden fields and the button of the first sample.
fn first_sample(page: &Reply) -> Vec<(String, String)> {
    let sheet = page.text.split_once("class=\"samples\"").unwrap().1;
    let form = sheet.split("</form>").next().unwrap();
    let hidden = form.split("<input type=\"hidden\" name=\"").skip(1);
    hidden
        .map(|field| {
            let (name, rest) = field.split_once("\" value=\"").unwrap();
            (name.to_owned(), rest.split('"').next().unwrap().to_owned())
        })
        .collect()
}

fn borrowed(fields: &[(String, String)]) -> Vec<(&str, &str)> {
    (fields.iter())
        .map(|(name, value)| (name.as_str(), value.as_str()))
        .collect()
}

#[tokio::test]
async fn a_behaviour_is_followed_through_the_rule() {
    let site = Site::in_memory();
    let api = create(&site, json!({"task": room()})).await;
    let page = to_the_rule(&site, &api).await;
    assert!(!page.text.contains("<li><strong>"));
    let at = api.strip_prefix("/api/v1").unwrap();
    let rule = automata::format::json::read(&site.get(&format!("{api}/automaton")).await.text);
    let rule = rule.unwrap().dfa;
    for names in ["Y B", "B Y", ""] {
        let word = rule.alphabet().word(names.split_whitespace()).unwrap();
        let page = site
            .get(&format!("{at}?trace={}", names.replace(' ', "+")))
            .await;
        let way = page.text.split_once("id=\"trace-way\"").unwrap().1;
        let way = way.split("</ol>").next().unwrap();
        assert_eq!(way.matches("<li>").count(), word.len() + 1, "{way}");
        let said = if rule.accepts(&word) {
            "The rule accepts this."
        } else {
            "The rule does not accept this."
        };
        assert!(page.text.contains(said), "{names}");
    }
    let wrong = site.get(&format!("{at}?trace=coffee")).await;
    assert!(wrong.text.contains("`coffee` is not a symbol"));
    assert_eq!(wrong.main("data-kind"), "equivalence");
}

#[tokio::test]
async fn a_sample_that_is_wrong_refutes_the_rule() {
    let site = Site::in_memory();
    for task in [json!(room()), json!("tomita:1")] {
        let api = create(&site, json!({"task": task})).await;
        let page = to_the_rule(&site, &api).await;
        let at = api.strip_prefix("/api/v1").unwrap();
        let fields = first_sample(&page);
        let sent = site
            .form(&format!("{at}/answers"), &borrowed(&fields))
            .await;
        assert_eq!(sent.location(), at);
        let log = site.get(&format!("{api}/log")).await.text;
        assert!(log.contains("\"answer\":\"counterexample\""), "{log}");
        // The same rule shows the same sheet each time.
        let samples = site.get(&format!("{api}/samples")).await;
        assert_eq!(samples.text, site.get(&format!("{api}/samples")).await.text);
    }
}

#[tokio::test]
async fn only_who_has_looked_at_all_samples_may_claim_anything() {
    let site = Site::in_memory();
    for looked in [None, Some("12")] {
        let api = create(&site, json!({"task": room()})).await;
        let at = api.strip_prefix("/api/v1").unwrap();
        let page = to_the_rule(&site, &api).await;
        let number = page.main("data-question");
        assert!(page.text.contains("name=\"looked\" value=\"12\""));
        let mut fields = vec![("question", number.as_str()), ("answer", "correct")];
        let answers = format!("{at}/answers");
        let some = [fields.clone(), vec![("looked", "5")]].concat();
        let refused = site.form(&answers, &some).await;
        assert_eq!(refused.status, StatusCode::UNPROCESSABLE_ENTITY);
        assert!(refused.text.contains("all 12"), "{}", refused.text);
        fields.extend(looked.map(|looked| ("looked", looked)));
        let done = site
            .get(&site.form(&answers, &fields).await.location())
            .await;
        assert_eq!(done.main("data-kind"), "done");
        assert_eq!(done.text.contains("id=\"claim\""), looked.is_some());
        let log = site.get(&format!("{api}/log")).await.text;
        assert_eq!(log.contains("\"looked\":12"), looked.is_some());
        // 1 - (0.05 / 2)^(1/12) = 0.2646: never less than may be claimed.
        assert_eq!(done.text.contains("at most 27 %"), looked.is_some());
        assert!(done.text.contains("less than a minute of answering"));
    }
}

#[tokio::test]
async fn what_cannot_happen_is_told_where_it_ends() {
    let site = Site::in_memory();
    let api = create(&site, json!({"task": room()})).await;
    let page = to_the_rule(&site, &api).await;
    let at = api.strip_prefix("/api/v1").unwrap();
    let number = page.main("data-question");
    let long = ["B Y"; 6].join(" ");
    let fields = [
        ("question", number.as_str()),
        ("word", long.as_str()),
        ("label", "false"),
    ];
    let reply = site.form(&format!("{at}/answers"), &fields).await;
    assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert!(
        reply
            .text
            .contains("at most 8 moves, and step 4 (recharge)"),
        "{}",
        reply.text
    );
    assert!(reply.text.contains(&format!("value=\"{long}\"")));
}

#[tokio::test]
async fn the_same_task_begins_anew_with_other_settings() {
    let site = Site::in_memory();
    let api = create(&site, json!({"task": room()})).await;
    let at = api.strip_prefix("/api/v1").unwrap();
    let page = to_the_rule(&site, &api).await;
    let number = page.main("data-question");
    let fields = [("question", number.as_str()), ("answer", "correct")];
    site.form(&format!("{at}/answers"), &fields).await;
    let again = format!("{at}/again");
    for (field, value, part) in [
        ("seed", "soon", "whole number"),
        ("membership_cost", "-1", "greater than 0"),
        ("max_states", "0", "whole number from 1"),
    ] {
        let refused = site.form(&again, &[(field, value)]).await;
        assert_eq!(refused.status, StatusCode::UNPROCESSABLE_ENTITY);
        assert!(refused.text.contains(part), "{field}: {}", refused.text);
        assert!(refused.text.contains(&format!("value=\"{value}\"")));
        assert!(refused.text.contains(&format!("id=\"{field}-fault\"")));
    }
    let fields = [
        ("strategy", "membership"),
        ("membership_cost", "2,5"),
        ("comparison_cost", "inf"),
        ("seed", "7"),
        ("max_states", "4"),
    ];
    let new = site.form(&again, &fields).await.location();
    assert_ne!(new, at);
    let state = site.get(&format!("/api/v1{new}")).await.json();
    assert_eq!(state["setup"]["strategy"], "membership");
    assert_eq!(state["setup"]["membership_cost"], 2.5);
    assert_eq!(state["setup"]["comparison_cost"], "inf");
    assert_eq!(state["setup"]["seed"], 7);
    assert_eq!(state["task"]["max_states"], 4);
    let before = site.get(&api).await.json();
    assert_eq!(state["task"]["symbols"], before["task"]["symbols"]);
    assert_eq!(state["task"]["world"], before["task"]["world"]);
}
