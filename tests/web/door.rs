//! Who comes in, for how long, and what they then hold in their hands.

use std::sync::Arc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use axum::body::Body;
use axum::http::{Method, Request, StatusCode};
use memrep::server::{AppState, Limits, Reached, hash_password};
use memrep::store::{Sqlite, Store};
use serde_json::json;

use crate::api::create;
use crate::site::{Reply, Site};

pub(crate) const PASSWORD: &str = "correct horse battery";
const TLS: &str = "teach.example.org";
pub(crate) const HOUR: u64 = 3600;

/// A site with an owner's password, and its store.
pub(crate) fn locked() -> (Site, Arc<Sqlite>) {
    locked_and_reached(Reached::default())
}

pub(crate) fn locked_and_reached(reached: Reached) -> (Site, Arc<Sqlite>) {
    locked_with(reached, Limits::default())
}

pub(crate) fn locked_with(reached: Reached, limits: Limits) -> (Site, Arc<Sqlite>) {
    let store = Arc::new(Sqlite::in_memory().unwrap());
    (locked_over(&store, reached, limits), store)
}

pub(crate) fn locked_over(store: &Arc<Sqlite>, reached: Reached, limits: Limits) -> Site {
    let hash = hash_password(PASSWORD).unwrap();
    store.visits().set_password(Some(&hash)).unwrap();
    let lease = Duration::from_secs(600);
    let state = AppState::with_lease(store.clone(), lease);
    Site::of(state.reached(reached).with_limits(limits))
}

pub(crate) async fn sign_in(site: &Site) {
    let into = [("password", PASSWORD), ("to", "/")];
    assert_eq!(site.form("/sign-in", &into).await.location(), "/");
}

pub(crate) fn now() -> u64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.unwrap().as_secs()
}

#[tokio::test]
async fn the_owner_signs_in_and_goes_where_they_wanted_and_out_again() {
    let (site, _) = locked();
    let wanted = site.get("/sessions/ab?trace=0%2C1").await.location();
    assert_eq!(wanted, "/sign-in?to=/sessions/ab%3Ftrace%3D0%252C1");
    let page = site.get(&wanted).await;
    assert!(
        page.text.contains("value=\"/sessions/ab?trace=0%2C1\""),
        "{}",
        page.text
    );
    assert!(page.text.contains("autocomplete=\"current-password\""));

    let wrong = [("password", "correct horse batterz"), ("to", "/studio")];
    let wrong = site.form("/sign-in", &wrong).await;
    assert_eq!(wrong.status, StatusCode::UNAUTHORIZED);
    assert!(
        wrong.text.contains("That is not the password"),
        "{}",
        wrong.text
    );
    assert!(wrong.text.contains("value=\"/studio\""), "it is remembered");
    assert!(site.cookies().is_empty());

    let right = [("password", PASSWORD), ("to", "/studio")];
    let right = site.form("/sign-in", &right).await;
    assert_eq!(right.location(), "/studio");
    let cookie = right.header("set-cookie");
    for term in [
        "memrep=",
        "HttpOnly",
        "SameSite=Lax",
        "Path=/;",
        "Max-Age=86400",
    ] {
        assert!(cookie.contains(term), "{term}: {cookie}");
    }
    assert_eq!(site.cookies()["memrep"].len(), 64, "256 bits");
    assert_eq!(site.get("/").await.status, StatusCode::OK);

    let held = site.cookies();
    assert_eq!(site.form("/sign-out", &[]).await.location(), "/sign-in");
    assert!(site.cookies().is_empty());
    site.set_cookies(held);
    assert_eq!(
        site.get("/").await.status,
        StatusCode::SEE_OTHER,
        "it has ended"
    );
}

#[tokio::test]
async fn nobody_is_led_to_another_site() {
    let (site, _) = locked();
    for to in ["//evil.example", "https://evil.example/", "/\\evil.example"] {
        let into = [("password", PASSWORD), ("to", to)];
        assert_eq!(site.form("/sign-in", &into).await.location(), "/", "{to}");
    }
}

/// Whoever fixes a cookie beforehand does not know the one that counts.
#[tokio::test]
async fn a_sign_in_gives_a_new_key_and_ends_the_one_before() {
    let (site, _) = locked();
    let fixed = [("memrep".to_owned(), "ab".repeat(32))];
    site.set_cookies(fixed.clone().into());
    sign_in(&site).await;
    let first = site.cookies();
    assert_ne!(first, fixed.clone().into());
    sign_in(&site).await;
    assert_ne!(site.cookies(), first);
    assert_eq!(site.get("/").await.status, StatusCode::OK);
    for old in [fixed.into(), first] {
        site.set_cookies(old);
        assert_eq!(site.get("/").await.status, StatusCode::SEE_OTHER);
    }
}

#[tokio::test]
async fn another_password_ends_all_visits_and_none_opens_only_what_is_near() {
    let (site, store) = locked();
    sign_in(&site).await;
    let session = create_signed(&site).await;
    let link = invite(&site, &session, "Ada").await;
    let ada = site.elsewhere();
    let place = ada.enter(&link).await;
    let hash = hash_password("another horse battery").unwrap();
    store.visits().set_password(Some(&hash)).unwrap();
    assert_eq!(site.get("/").await.status, StatusCode::SEE_OTHER);
    assert_eq!(ada.get(&place).await.status, StatusCode::NOT_FOUND);
    assert_eq!(
        ada.enter(&link).await,
        place,
        "the link itself still leads in"
    );
    let old = [("password", PASSWORD)];
    assert_eq!(
        site.form("/sign-in", &old).await.status,
        StatusCode::UNAUTHORIZED
    );

    let reached = Reached {
        is_public: true,
        ..Reached::default()
    };
    let (public, store) = locked_and_reached(reached);
    store.visits().set_password(None).unwrap();
    for path in ["/", "/studio", "/sign-in", "/api/v1/sessions"] {
        let closed = public.get(path).await;
        assert_eq!(closed.status, StatusCode::FORBIDDEN, "{path}");
        assert!(closed.text.contains("memrep password"), "{}", closed.text);
    }
}

#[tokio::test]
async fn links_are_whole_where_it_was_said_how_people_reach_the_server() {
    let reached = Reached {
        origins: vec![format!("https://{TLS}").parse().unwrap()],
        ..Reached::default()
    };
    let (site, _) = locked_and_reached(reached);
    sign_in(&site).await;
    let session = create_signed(&site).await;
    let made = site
        .post(&format!("{session}/people"), json!({"name": "Ada"}))
        .await
        .json();
    let link = made["link"].as_str().unwrap();
    assert!(link.starts_with("/answer/"), "{link}");
    assert_eq!(made["url"], format!("https://{TLS}{link}"));
    let people = format!("{}/people", session.replace("/api/v1", ""));
    let page = site.form(&people, &[("name", "Bea")]).await;
    let whole = format!("value=\"https://{TLS}/answer/");
    assert!(page.text.contains(&whole), "{}", page.text);
}

pub(crate) async fn create_signed(site: &Site) -> String {
    create(site, json!({"task": "tomita:4", "seed": 3})).await
}

pub(crate) async fn invite(site: &Site, session: &str, name: &str) -> String {
    let made = site
        .post(&format!("{session}/people"), json!({"name": name}))
        .await;
    assert_eq!(made.status, StatusCode::CREATED, "{}", made.text);
    made.json()["link"].as_str().unwrap().to_owned()
}

#[tokio::test]
async fn scripts_sign_in_for_a_token() {
    let (site, _) = locked();
    let closed = site.get("/api/v1/sessions").await;
    assert_eq!(closed.status, StatusCode::UNAUTHORIZED);
    assert_eq!(closed.json()["error"]["code"], "sign_in");
    assert_eq!(closed.header("www-authenticate"), "Bearer");
    let wrong = site.post("/api/v1/sign-in", json!({"password": "x"})).await;
    assert_eq!(wrong.status, StatusCode::UNAUTHORIZED);
    let given = site
        .post("/api/v1/sign-in", json!({"password": PASSWORD}))
        .await;
    assert_eq!(given.status, StatusCode::CREATED, "{}", given.text);
    let token = given.json()["token"].as_str().unwrap().to_owned();
    assert!(given.json()["expires"].as_u64().unwrap() > now() + 23 * HOUR);
    assert!(site.cookies().is_empty(), "a token is no cookie");
    let ask = |method: Method, path: &str, token: &str| {
        let request = Request::builder().method(method).uri(path);
        request
            .header("authorization", format!("Bearer {token}"))
            .body(Body::empty())
            .unwrap()
    };
    let list = site
        .send(ask(Method::GET, "/api/v1/sessions", &token))
        .await;
    assert_eq!(list.status, StatusCode::OK);
    let other = site
        .send(ask(Method::GET, "/api/v1/sessions", &"0".repeat(64)))
        .await;
    assert_eq!(other.status, StatusCode::UNAUTHORIZED);
    let out = site
        .send(ask(Method::POST, "/api/v1/sign-out", &token))
        .await;
    assert_eq!(out.status, StatusCode::OK);
    let ended = site
        .send(ask(Method::GET, "/api/v1/sessions", &token))
        .await;
    assert_eq!(ended.status, StatusCode::UNAUTHORIZED);
}

/// Ten tries, and then none before a minute: from one address, and not from others.
#[tokio::test]
async fn passwords_cannot_be_tried_for_long() {
    let reached = Reached {
        behind_proxy: true,
        ..Reached::default()
    };
    let (site, _) = locked_and_reached(reached);
    let attempt = async |from: &str, password: &str| -> Reply {
        let request = Request::post("/sign-in")
            .header("content-type", "application/x-www-form-urlencoded")
            .header("x-forwarded-for", from)
            .body(Body::from(format!("password={password}")));
        site.send(request.unwrap()).await
    };
    for number in 0..10 {
        // What comes before the last address is what anybody may claim.
        let from = format!("10.0.0.{number}, 192.0.2.1");
        let tried = attempt(&from, "guess").await;
        assert_eq!(tried.status, StatusCode::UNAUTHORIZED, "{number}");
    }
    let refused = attempt("192.0.2.1", "correct%20horse%20battery").await;
    assert_eq!(
        refused.status,
        StatusCode::TOO_MANY_REQUESTS,
        "even if it is right"
    );
    let wait: u64 = refused.header("retry-after").parse().unwrap();
    assert!((1..=60).contains(&wait), "{wait}");
    assert!(refused.text.contains("try again in"), "{}", refused.text);
    let other = attempt("192.0.2.2", "correct%20horse%20battery").await;
    assert_eq!(other.status, StatusCode::SEE_OTHER);
}

/// A script that signs in for every run is not somebody who guesses.
#[tokio::test]
async fn only_wrong_passwords_are_counted_as_tries() {
    let (site, _) = locked();
    let at = "/api/v1/sign-in";
    for number in 0..15 {
        let odd = site.post(at, json!({"passwort": "x"})).await;
        assert_eq!(odd.status, StatusCode::UNPROCESSABLE_ENTITY, "{number}");
    }
    for number in 0..12 {
        let right = site.post(at, json!({"password": PASSWORD})).await;
        assert_eq!(right.status, StatusCode::CREATED, "{number}");
    }
    for number in 0..10 {
        let wrong = site.post(at, json!({"password": "guess"})).await;
        assert_eq!(wrong.status, StatusCode::UNAUTHORIZED, "{number}");
    }
    let late = site.post(at, json!({"password": PASSWORD})).await;
    assert_eq!(late.status, StatusCode::TOO_MANY_REQUESTS);
}

#[tokio::test]
async fn under_an_address_with_tls_cookies_are_for_that_host_alone() {
    let origin = format!("https://{TLS}").parse().unwrap();
    let reached = Reached {
        origins: vec![origin],
        is_public: true,
        ..Reached::default()
    };
    let (site, _) = locked_and_reached(reached);
    let ask = async |host: &str| -> Reply {
        let request = Request::post("/sign-in")
            .header("host", host)
            .header("content-type", "application/x-www-form-urlencoded")
            .body(Body::from(format!(
                "password={}",
                PASSWORD.replace(' ', "%20")
            )));
        site.elsewhere().send(request.unwrap()).await
    };
    let near = ask("127.0.0.1:8080").await;
    assert!(
        near.header("set-cookie").starts_with("memrep="),
        "no TLS there"
    );
    let far = ask(TLS).await;
    let cookie = far.header("set-cookie");
    assert!(cookie.starts_with("__Host-memrep="), "{cookie}");
    assert!(
        cookie.ends_with("; Secure") && cookie.contains("Path=/;"),
        "{cookie}"
    );
    assert!(!cookie.contains("Domain"), "{cookie}");
    assert_eq!(far.header("strict-transport-security"), "max-age=31536000");
    assert_eq!(ask("evil.example").await.status, StatusCode::FORBIDDEN);
    let (plain, _) = locked();
    assert_eq!(
        plain
            .get("/sign-in")
            .await
            .header("strict-transport-security"),
        ""
    );
}

/// A browser may hold several invitations: each at its own place, by its own cookie.
#[tokio::test]
async fn a_link_becomes_a_cookie_and_is_in_no_address_from_then_on() {
    let (site, _) = locked();
    sign_in(&site).await;
    let (one, two) = (create_signed(&site).await, create_signed(&site).await);
    let (first, second) = (
        invite(&site, &one, "Ada").await,
        invite(&site, &two, "Ada").await,
    );
    let ada = site.elsewhere();
    for _ in 0..3 {
        let looked = ada.get(&first).await;
        assert_eq!(looked.status, StatusCode::OK);
        assert!(
            looked.headers.get("set-cookie").is_none(),
            "a look is no visit"
        );
    }
    let (here, there) = (ada.enter(&first).await, ada.enter(&second).await);
    assert_ne!(here, there);
    assert_eq!(ada.cookies().len(), 2);
    let page = ada.get(&here).await;
    assert_eq!(page.status, StatusCode::OK);
    let key = first.rsplit('/').next().unwrap();
    assert!(!here.contains(key) && !page.text.contains(key), "{here}");
    let question = page.main("data-question");
    let skip = [("question", question.as_str()), ("answer", "skip")];
    let said = ada.form(&format!("{here}/answers"), &skip).await;
    assert_eq!(said.location(), here);
    assert_eq!(ada.get(&there).await.status, StatusCode::OK, "each goes on");
    // The same link again: the same place, another key.
    let held = ada.cookies();
    assert_eq!(ada.enter(&first).await, here);
    assert_ne!(ada.cookies(), held);
    // A key opens its own place only, whatever the cookie is called.
    let named = |place: &str| format!("memrep-{}", place.rsplit('/').next().unwrap());
    let swapped = [(named(&there), ada.cookies()[&named(&here)].clone())];
    ada.set_cookies(swapped.into());
    assert_eq!(ada.get(&there).await.status, StatusCode::NOT_FOUND);
}

#[tokio::test]
async fn who_teaches_alone_has_that_session_and_nothing_else() {
    let (site, _) = locked();
    sign_in(&site).await;
    let session = create_signed(&site).await;
    let terms = json!({"pooling": "alone"});
    site.post(&format!("{session}/people/terms"), terms).await;
    let (to_ada, to_bea) = (
        invite(&site, &session, "Ada").await,
        invite(&site, &session, "Bea").await,
    );
    let (ada, bea) = (site.elsewhere(), site.elsewhere());
    let (hers, other) = (ada.enter(&to_ada).await, bea.enter(&to_bea).await);
    assert!(hers.starts_with("/sessions/"), "{hers}");
    assert_eq!(ada.get(&hers).await.status, StatusCode::OK);
    assert_eq!(
        ada.get(&format!("/api/v1{hers}/question")).await.status,
        StatusCode::OK
    );
    let shared = session.replace("/api/v1", "");
    for closed in [other, shared, format!("{hers}/people"), "/".to_owned()] {
        assert_eq!(
            ada.get(&closed).await.status,
            StatusCode::SEE_OTHER,
            "{closed}"
        );
    }
    let by_key = ada.get(&format!("/api/v1{to_ada}")).await;
    assert_eq!(
        by_key.status,
        StatusCode::NOT_FOUND,
        "not the shared one's questions"
    );
    let ended = site
        .form(
            &format!("{}/people/1/dismissal", session.replace("/api/v1", "")),
            &[],
        )
        .await;
    assert_eq!(ended.status, StatusCode::SEE_OTHER);
    assert_eq!(
        ada.get(&hers).await.status,
        StatusCode::SEE_OTHER,
        "it has ended"
    );
}

/// Where other sites' requests come from, by what browsers say of them.
#[tokio::test]
async fn no_other_site_writes() {
    let (site, _) = locked();
    sign_in(&site).await;
    let own = "http://127.0.0.1:8080";
    for (method, fetched, origin, passes) in [
        ("POST", None, None, true),
        ("POST", Some("same-origin"), Some(own), true),
        ("POST", Some("none"), None, true),
        ("POST", None, Some(own), true),
        ("POST", Some("same-site"), Some("http://a.127.0.0.1"), false),
        (
            "POST",
            Some("cross-site"),
            Some("https://evil.example"),
            false,
        ),
        ("POST", Some("cross-site"), None, false),
        ("POST", None, Some("https://evil.example"), false),
        ("POST", None, Some("null"), false),
        ("POST", None, Some("http://127.0.0.1:9999"), false),
        (
            "POST",
            None,
            Some("http://127.0.0.1:8080.evil.example"),
            false,
        ),
        (
            "GET",
            Some("cross-site"),
            Some("https://evil.example"),
            true,
        ),
    ] {
        for path in [
            "/sessions",
            "/sign-in",
            "/sign-out",
            "/api/v1/sessions",
            "/answer/zz",
        ] {
            let mut request = Request::builder()
                .method(method)
                .uri(path)
                .header("host", "127.0.0.1:8080")
                .header("content-type", "application/x-www-form-urlencoded");
            if let Some(fetched) = fetched {
                request = request.header("sec-fetch-site", fetched);
            }
            if let Some(origin) = origin {
                request = request.header("origin", origin);
            }
            let reply = site.send(request.body(Body::empty()).unwrap()).await;
            let refused = reply.status == StatusCode::FORBIDDEN;
            assert_eq!(!refused, passes, "{method} {path} {fetched:?} {origin:?}");
        }
    }
}
