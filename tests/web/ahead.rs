//! What is worked out before it is asked for: answers that were foreseen, why a
//! question is asked, and news of a session.

use std::time::Duration;

use axum::body::Body;
use axum::http::{Request, StatusCode};
use memrep::oracle::{ScriptedTeacher, Target, TeacherSettings};
use serde_json::{Value, json};
use tokio_stream::StreamExt;

use crate::api::{answer, create};
use crate::site::Site;

/// The log without the times.
async fn log(site: &Site, api: &str) -> Vec<Value> {
    let text = site.get(&format!("{api}/log")).await.text;
    let entry = |line: &str| {
        let mut entry: Value = serde_json::from_str(line).unwrap();
        entry.as_object_mut().unwrap().remove("at");
        entry
    };
    text.lines().map(entry).collect()
}

/// Whether somebody thinks about an answer for long, and it is worked out meanwhile,
/// or answers at once: the log is the same.
#[tokio::test]
async fn foreseen_answers_leave_no_trace() {
    let mut logs = Vec::new();
    for pause in [Duration::ZERO, Duration::from_millis(700)] {
        let site = Site::in_memory();
        let target = Target::named("tomita:5").unwrap();
        let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
        let api = create(&site, json!({"task": "tomita:5", "seed": 11})).await;
        for round in 0..9 {
            let question = site.get(&format!("{api}/question")).await.json();
            tokio::time::sleep(pause).await;
            let reply = answer(&mut teacher, target.dfa().alphabet(), &question);
            site.post(&format!("{api}/answers"), reply.clone()).await;
            tokio::time::sleep(pause).await;
            match round {
                3 => drop(site.post(&format!("{api}/undo"), json!({})).await),
                5 => {
                    let taken = json!({"question": 1});
                    site.post(&format!("{api}/retractions"), taken).await;
                }
                _ => {}
            }
        }
        logs.push(log(&site, &api).await);
    }
    assert!(logs[0].len() > 15, "{}", logs[0].len());
    assert_eq!(logs[0], logs[1]);
}

#[tokio::test]
async fn why_a_question_is_asked_is_told_as_it_was_logged() {
    let site = Site::in_memory();
    for task in ["tomita:5", "robot-recharge", "car"] {
        let api = create(&site, json!({"task": task, "seed": 1})).await;
        let page = site
            .get(&format!("{}/why", api.replace("/api/v1", "")))
            .await;
        assert_eq!(page.status, StatusCode::OK, "{}", page.text);
        let asked = log(&site, &api).await.pop().unwrap();
        let removed = asked["removed"].as_array().unwrap();
        assert!(!removed.is_empty(), "{asked}");
        for one in removed {
            let told = format!("data-removed=\"{}\"", one["concepts"]);
            assert!(page.text.contains(&told), "{told}: {}", page.text);
        }
        let left = asked["left"]["concepts"].to_string();
        assert!(page.text.contains(&left), "{left}: {}", page.text);
        assert_eq!(page.text.matches("card rule rival").count(), 2);
    }
    let none = site
        .get("/sessions/00000000000000000000000000000000/why")
        .await;
    assert_eq!(none.status, StatusCode::NOT_FOUND);
}

#[tokio::test]
async fn a_session_is_followed_as_it_goes_on() {
    let site = Site::in_memory();
    let api = create(&site, json!({"task": "tomita:1", "seed": 1})).await;
    let live = Request::get(format!("{api}/live"))
        .body(Body::empty())
        .unwrap();
    let response = site.open(live).await;
    assert_eq!(response.headers()["content-type"], "text/event-stream");
    let mut news = response.into_body().into_data_stream();
    let mut next = async || {
        let news = tokio::time::timeout(Duration::from_secs(20), news.next()).await;
        let text = news.expect("there is news").unwrap().unwrap();
        let text = String::from_utf8(text.to_vec()).unwrap();
        assert!(text.contains("event: entries"), "{text}");
        let entries = text.split("data: ").nth(1).unwrap().trim();
        entries.parse::<u64>().unwrap()
    };
    let before = next().await;
    assert_eq!(before, log(&site, &api).await.len() as u64);
    let question = site.get(&format!("{api}/question")).await.json();
    let skip = json!({"question": question["number"], "answer": "skip"});
    site.post(&format!("{api}/answers"), skip).await;
    assert_eq!(next().await, log(&site, &api).await.len() as u64);
}
