//! Every route of the table, asked by everybody who may not have it.

use axum::body::Body;
use axum::http::{Request, StatusCode};
use memrep::server::routes::{May, ROUTES};
use serde_json::json;

use crate::api::create;
use crate::door::{locked, sign_in};
use crate::site::{Reply, Site};

/// A session of the owner's to which Ada is invited, and another's guest.
struct House {
    owner: Site,
    /// The session's name.
    id: String,
    /// Ada's link to it, and Ada's browser, which is at its place.
    key: String,
    place: String,
    ada: Site,
    /// Whoever was invited to another session.
    stranger: Site,
}

async fn invite(owner: &Site, session: &str, name: &str) -> String {
    let path = format!("{session}/people");
    let made = owner.post(&path, json!({"name": name})).await;
    made.json()["link"].as_str().unwrap().to_owned()
}

async fn house() -> House {
    let (owner, _) = locked();
    sign_in(&owner).await;
    let setup = json!({"task": "tomita:4", "seed": 3});
    let session = create(&owner, setup.clone()).await;
    let other = create(&owner, setup).await;
    let link = invite(&owner, &session, "Ada").await;
    let to_other = invite(&owner, &other, "Stranger").await;
    let (ada, stranger) = (owner.elsewhere(), owner.elsewhere());
    let place = ada.enter(&link).await;
    stranger.enter(&to_other).await;
    let last = |path: &str| path.rsplit('/').next().unwrap().to_owned();
    House {
        id: last(&session),
        key: last(&link),
        place: last(&place),
        owner,
        ada,
        stranger,
    }
}

impl House {
    fn path(&self, path: &str) -> String {
        path.replace("{id}", &self.id)
            .replace("{key}", &self.key)
            .replace("{place}", &self.place)
            .replace("{person}", "1")
            .replace("{*path}", "a.png")
            .replace("{stamp}", "0")
            .replace("{name}", "none.css")
    }

    /// How many entries the session's log has.
    async fn entries(&self) -> usize {
        let log = self
            .owner
            .get(&format!("/api/v1/sessions/{}/log", self.id))
            .await;
        assert_eq!(log.status, StatusCode::OK);
        log.text.lines().count()
    }
}

async fn ask(site: &Site, method: &str, path: &str) -> Reply {
    let api = path.starts_with("/api/");
    let (kind, body) = match (method, api) {
        ("POST", true) => ("application/json", "{\"name\":\"x\",\"question\":1}"),
        ("POST", false) => ("application/x-www-form-urlencoded", "name=x&question=1"),
        _ => ("text/plain", ""),
    };
    let request = Request::builder().method(method).uri(path);
    let request = request.header("content-type", kind).body(Body::from(body));
    site.send(request.unwrap()).await
}

#[tokio::test]
async fn nobody_has_what_is_anothers_on_any_route() {
    let house = house().await;
    let nobody = house.owner.elsewhere();
    let before = house.entries().await;
    let mut asked = 0;
    for route in ROUTES {
        let path = house.path(route.path);
        for method in route.methods {
            let visitors: &[(&str, &Site)] = match route.may {
                May::Anyone | May::Key => &[],
                May::Invited => &[
                    ("nobody", &nobody),
                    ("a stranger", &house.stranger),
                    ("the owner", &house.owner),
                ],
                May::Teacher | May::Owner => &[
                    ("nobody", &nobody),
                    ("a stranger", &house.stranger),
                    ("a guest of this session", &house.ada),
                ],
            };
            for (who, site) in visitors {
                let reply = ask(site, method, &path).await;
                let said = format!("{who}: {method} {path}: {} {}", reply.status, reply.text);
                match route.may {
                    May::Invited => assert_eq!(reply.status, StatusCode::NOT_FOUND, "{said}"),
                    _ if path.starts_with("/api/") => {
                        assert_eq!(reply.status, StatusCode::UNAUTHORIZED, "{said}");
                    }
                    _ => assert!(reply.location().starts_with("/sign-in?to=/"), "{said}"),
                }
                assert!(!reply.text.contains("tomita"), "{said}");
                asked += 1;
            }
        }
    }
    assert!(asked > 120, "{asked}");
    assert_eq!(house.entries().await, before, "nothing has changed");
}

/// A row of the table without a route behind it would be a promise about nothing.
#[tokio::test]
async fn every_row_of_the_table_is_a_route() {
    let house = house().await;
    for route in ROUTES {
        let path = house.path(route.path);
        for method in ["GET", "POST", "PUT", "DELETE", "PATCH"] {
            let site = match route.may {
                May::Invited => &house.ada,
                _ => &house.owner,
            };
            // Streams do not end, and to sign out or dismiss somebody ends the test.
            let mut rows = ROUTES.iter().filter(|row| row.path == route.path);
            let is_promised = rows.any(|row| row.methods.contains(&method));
            let ends = ["/live", "/sign-out", "/dismissal", "/link", "/sign-in"];
            if is_promised && ends.iter().any(|end| path.ends_with(end)) {
                continue;
            }
            let reply = ask(site, method, &path).await;
            let is_known = reply.status != StatusCode::METHOD_NOT_ALLOWED;
            assert_eq!(
                is_known, is_promised,
                "{method} {path}: {} {}",
                reply.status, reply.text
            );
            let nothing = "There is nothing at this address";
            // This task has none of these.
            let files = ["/media/", "/static/", "/practice"];
            let files = files.iter().any(|part| path.contains(part));
            let near = path == "/metrics";
            assert!(
                files || near || !is_known || !reply.text.contains(nothing),
                "{method} {path} is nowhere"
            );
        }
    }
}

#[tokio::test]
async fn a_look_changes_nothing() {
    let house = house().await;
    // The first look at a session has it put a question.
    house.owner.get(&house.path("/sessions/{id}")).await;
    house.ada.get(&house.path("/answer/s/{place}")).await;
    let before = house.entries().await;
    let sessions = house.owner.get("/api/v1/sessions").await.text;
    for route in ROUTES.iter().filter(|route| route.methods.contains(&"GET")) {
        let path = house.path(route.path);
        if path.ends_with("/live") {
            continue;
        }
        for site in [&house.owner, &house.ada] {
            ask(site, "GET", &path).await;
            ask(site, "HEAD", &path).await;
        }
    }
    assert_eq!(house.entries().await, before);
    assert_eq!(house.owner.get("/api/v1/sessions").await.text, sessions);
}

#[tokio::test]
async fn what_is_no_route_is_for_nobody() {
    let house = house().await;
    for path in [
        "/none",
        "/api/v1/none",
        "/sessions/",
        "/answer/s",
        "/.git/config",
        "/..%2f",
    ] {
        for site in [&house.owner, &house.ada] {
            let reply = site.get(path).await;
            assert_eq!(
                reply.status,
                StatusCode::NOT_FOUND,
                "{path}: {}",
                reply.text
            );
        }
    }
}
