//! What somebody may ask for in a while, and under which names they get it.

use std::collections::BTreeSet;

use axum::body::Body;
use axum::http::{Request, StatusCode};
use memrep::oracle::{ScriptedTeacher, Target, TeacherSettings};
use memrep::server::Reached;

use crate::api::answer;
use crate::door::{create_signed, locked, locked_and_reached, sign_in};
use crate::site::{Reply, Site};

/// What costs much is bounded for each address; what people do all day is not.
#[tokio::test]
async fn costly_work_is_bounded_for_each_address() {
    let reached = Reached {
        behind_proxy: true,
        ..Reached::default()
    };
    let (site, _) = locked_and_reached(reached);
    sign_in(&site).await;
    let ask = async |from: &str, method: &str, path: &str| -> Reply {
        let request = Request::builder()
            .method(method)
            .uri(path)
            .header("content-type", "application/x-www-form-urlencoded")
            .header("x-forwarded-for", from);
        site.send(request.body(Body::empty()).unwrap()).await
    };
    for number in 0..60 {
        let reply = ask("192.0.2.1", "POST", "/sessions").await;
        assert!(reply.status.is_client_error(), "{number}: {}", reply.text);
        assert_ne!(reply.status, StatusCode::TOO_MANY_REQUESTS, "{number}");
    }
    let mut refused = None;
    for path in ["/sessions", "/studio", "/api/v1/sessions"] {
        let reply = ask("192.0.2.1", "POST", path).await;
        assert_eq!(reply.status, StatusCode::TOO_MANY_REQUESTS, "{path}");
        let wait: u64 = reply.header("retry-after").parse().unwrap();
        assert!((1..=2).contains(&wait), "{wait}");
        refused.get_or_insert(reply);
    }
    let page = refused.unwrap().text;
    assert!(page.contains("try again in"), "{page}");
    for _ in 0..100 {
        let open = ask("192.0.2.1", "GET", "/").await;
        assert_eq!(open.status, StatusCode::OK, "looking costs nothing");
    }
    let other = ask("192.0.2.2", "POST", "/sessions").await;
    assert_ne!(other.status, StatusCode::TOO_MANY_REQUESTS);
    // At the machine itself there is no bound.
    let (near, _) = locked();
    sign_in(&near).await;
    for _ in 0..100 {
        let reply = near.form("/sessions", &[]).await;
        assert_ne!(reply.status, StatusCode::TOO_MANY_REQUESTS);
    }
}

/// Answers until a rule is on show.
async fn teach_some(site: &Site, session: &str) {
    let target = Target::named("tomita:4").unwrap();
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let mut question = site.get(&format!("{session}/question")).await.json();
    let rule = format!("{session}/automaton?format=json");
    for _ in 0..30 {
        if site.get(&rule).await.status == StatusCode::OK {
            return;
        }
        let said = answer(&mut teacher, target.dfa().alphabet(), &question);
        let reply = site.post(&format!("{session}/answers"), said).await;
        question = reply.json();
    }
    panic!("no rule is on show after 30 answers");
}

/// What is saved beside something else of the same session has a name of its own.
#[tokio::test]
async fn downloads_of_a_session_have_names_of_their_own() {
    let site = Site::in_memory();
    let session = create_signed(&site).await;
    let mut names = BTreeSet::new();
    teach_some(&site, &session).await;
    for path in [
        "automaton?format=json",
        "automaton?format=dot",
        "automaton?format=dot-people",
        "automaton?format=hoa",
        "automaton?format=svg",
        "log",
    ] {
        let said = site.get(&format!("{session}/{path}")).await;
        assert_eq!(said.status, StatusCode::OK, "{path}: {}", said.text);
        let name = said.header("content-disposition").to_owned();
        assert!(
            name.starts_with("attachment; filename=\""),
            "{path}: {name}"
        );
        assert!(names.insert(name.clone()), "{path}: {name}");
    }
}
