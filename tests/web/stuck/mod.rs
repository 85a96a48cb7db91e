//! Nobody is kept waiting without a word, nothing is thought that nobody waits for,
//! and what breaks one session leaves the others alone.

mod gone;
mod large;

use std::sync::Arc;

use axum::http::StatusCode;
use serde_json::json;

use crate::door::invite;
use crate::site::Site;
use crate::unreliable::{Fault, Unreliable};

async fn begin(site: &Site) -> String {
    let reply = site
        .post("/api/v1/sessions", json!({"task": "tomita:4"}))
        .await;
    reply.json()["id"].as_str().unwrap().to_owned()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_page_that_would_have_to_wait_says_so_and_keeps_the_answer() {
    let store = Arc::new(Unreliable::in_memory());
    let before = Site::over_any(store.clone());
    let page = format!("/sessions/{}", begin(&before).await);
    let question = before.get(&page).await.main("data-question");
    // A server that has not thought ahead.
    let site = Site::over_any(store.clone());

    store.fail(Fault::Slow);
    let answer = [("question", question.as_str()), ("answer", "equal")];
    let answers = format!("{page}/answers");
    assert_eq!(site.form(&answers, &answer).await.location(), page);
    let waiting = site.get(&page).await;
    assert_eq!(waiting.status, StatusCode::ACCEPTED);
    assert!(waiting.text.contains("Still thinking"));
    assert!(waiting.text.contains("Your answers are kept"));
    assert!(waiting.text.contains("http-equiv=\"refresh\""));
    // It is kept indeed, and another session is not kept waiting for this one.
    let log = site.get(&format!("/api/v1{page}/log")).await.text;
    assert_eq!(log.matches("\"event\":\"answered\"").count(), 1);

    store.fail(Fault::None);
    let next = site.get(&format!("/api/v1{page}/question")).await.json();
    assert_ne!(next["number"].to_string(), question);
    let after = site.get(&page).await;
    assert_eq!(after.status, StatusCode::OK);
    assert_eq!(after.main("data-question"), next["number"].to_string());
    // Sent once more, as a page that lost its connection does, it counts once.
    assert_eq!(site.form(&answers, &answer).await.location(), page);
    let log = site.get(&format!("/api/v1{page}/log")).await.text;
    assert_eq!(log.matches("\"event\":\"answered\"").count(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn what_is_not_kept_yet_is_not_said_to_be() {
    let store = Arc::new(Unreliable::in_memory());
    let site = Site::over_any(store.clone());
    let page = format!("/sessions/{}", begin(&site).await);
    let question = site.get(&page).await.main("data-question");

    store.fail(Fault::Stuck);
    let answer = [("question", question.as_str()), ("answer", "equal")];
    let answers = format!("{page}/answers");
    assert_eq!(site.form(&answers, &answer).await.location(), page);
    let waiting = site.get(&page).await;
    assert_eq!(waiting.status, StatusCode::ACCEPTED);
    assert!(!waiting.text.contains("are kept"), "{}", waiting.text);
    assert!(waiting.text.contains("waits for its turn"));
    assert!(waiting.text.contains("http-equiv=\"refresh\""));

    // Nobody sent it again, and it is kept once that can be.
    store.fail(Fault::None);
    let next = site.get(&format!("/api/v1{page}/question")).await.json();
    assert_ne!(next["number"].to_string(), question);
    let log = site.get(&format!("/api/v1{page}/log")).await.text;
    assert_eq!(log.matches("\"event\":\"answered\"").count(), 1);
}

/// An invited person sends an answer while the session is busy with another's.
#[tokio::test(flavor = "multi_thread")]
async fn what_an_invited_person_sends_is_taken_while_the_session_is_busy() {
    let store = Arc::new(Unreliable::in_memory());
    let site = Site::over_any(store.clone());
    let session = format!("/api/v1/sessions/{}", begin(&site).await);
    let mut people = Vec::new();
    for name in ["Ada", "Bea"] {
        let link = invite(&site, &session, name).await;
        let browser = site.elsewhere();
        let home = browser.enter(&link).await;
        let question = browser.get(&home).await.main("data-question");
        people.push((browser, home, question));
    }
    assert_ne!(people[0].2, people[1].2, "each has a question of their own");

    store.fail(Fault::Stuck);
    for (browser, home, question) in &people {
        let answer = [("question", question.as_str()), ("answer", "equal")];
        let sent = browser.form(&format!("{home}/answers"), &answer).await;
        assert_eq!(sent.location(), *home);
        let waiting = browser.get(home).await;
        assert_eq!(waiting.status, StatusCode::ACCEPTED);
        assert!(waiting.text.contains("waits for its turn"));
    }
    store.fail(Fault::None);
    for (browser, home, question) in &people {
        let next = browser.get(home).await;
        assert_eq!(next.status, StatusCode::OK);
        assert_ne!(next.main("data-question"), *question);
    }
    let log = site.get(&format!("{session}/log")).await.text;
    assert_eq!(log.matches("\"event\":\"said\"").count(), 2, "{log}");
}

/// A store that kept what it could not say that it kept: what was asked happens once.
#[tokio::test]
async fn what_was_kept_without_a_word_happens_once() {
    let store = Arc::new(Unreliable::in_memory());
    let site = Site::over_any(store.clone());
    store.fail(Fault::Unsure);
    let session = format!("/api/v1/sessions/{}", begin(&site).await);
    for _ in 0..3 {
        let question = site.get(&format!("{session}/question")).await.json();
        let answer = json!({"question": question["number"], "answer": "equal"});
        store.fail(Fault::Unsure);
        let reply = site.post(&format!("{session}/answers"), answer).await;
        assert_eq!(reply.status, StatusCode::OK, "{}", reply.text);
    }
    store.fail(Fault::Unsure);
    let undone = site.post(&format!("{session}/undo"), json!({})).await;
    assert_eq!(undone.status, StatusCode::OK, "{}", undone.text);
    store.fail(Fault::Unsure);
    invite(&site, &session, "Ada").await;
    let log = site.get(&format!("{session}/log")).await.text;
    for (event, times) in [("answered", 3), ("retracted", 1), ("invited", 1)] {
        let event = format!("\"event\":\"{event}\"");
        assert_eq!(log.matches(&event).count(), times, "{log}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_session_that_breaks_leaves_the_others_alone() {
    let store = Arc::new(Unreliable::in_memory());
    let site = Site::over_any(store.clone());
    let (broken, other) = (begin(&site).await, begin(&site).await);
    store.fail(Fault::Panics(broken.parse().unwrap()));

    // Its log is what breaks, and its log is read for this page.
    let log = site.get(&format!("/api/v1/sessions/{broken}/log")).await;
    assert_eq!(log.status, StatusCode::INTERNAL_SERVER_ERROR);
    let error = log.json()["error"].clone();
    assert_eq!(error["code"], "internal");
    assert_eq!(error["request"], log.header("x-request-id"));
    assert!(!log.text.contains("breaks its reader"));

    // A server that has not got it in memory cannot show it, and says under which
    // name its log has the cause.
    let fresh = Site::over_any(store.clone());
    for _ in 0..3 {
        let page = fresh.get(&format!("/sessions/{broken}")).await;
        assert_eq!(page.status, StatusCode::INTERNAL_SERVER_ERROR);
        assert!(page.text.contains(page.header("x-request-id")));
        assert!(page.text.contains("Answers that were accepted are kept"));
    }
    let page = fresh.get(&format!("/sessions/{other}")).await;
    assert_eq!(page.status, StatusCode::OK);
    let question = page.main("data-question").parse::<u32>().unwrap();
    let body = json!({"question": question, "answer": "equal"});
    let reply = fresh
        .post(&format!("/api/v1/sessions/{other}/answers"), body)
        .await;
    assert_eq!(reply.status, StatusCode::OK);

    // Nothing of it is lost.
    store.fail(Fault::None);
    let page = fresh.get(&format!("/sessions/{broken}")).await;
    assert_eq!(page.status, StatusCode::OK);
}
