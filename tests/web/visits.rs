//! How long visits last, and that nothing lasts longer than the visit it came by.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use axum::body::Body;
use axum::http::{Request, StatusCode};
use http_body_util::BodyExt as _;
use memrep::server::{Limits, Reached, hash_password};
use memrep::store::{InviteKey, Sqlite, Store, VisitKey};

use crate::door::{HOUR, create_signed, invite, locked, locked_over, now, sign_in};
use crate::site::Site;

/// A cookie of a visit that began then.
fn visit_since(store: &Sqlite, begun: u64, seen: u64) -> [(String, String); 1] {
    let key = VisitKey::random().unwrap();
    let visits = store.visits();
    visits.begin_visit(&key.digest(), None, begun).unwrap();
    visits.see_visit(&key.digest(), seen).unwrap();
    [("memrep".to_owned(), key.to_string())]
}

#[tokio::test]
async fn a_visit_ends_after_an_hour_without_a_request_and_after_a_day() {
    let (site, store) = locked();
    let now = now();
    for (begun, seen, goes_on) in [
        (now, now, true),
        (now - 23 * HOUR, now - HOUR + 60, true),
        (now - 2 * HOUR, now - HOUR, false),
        (now - 24 * HOUR, now, false),
    ] {
        site.set_cookies(visit_since(&store, begun, seen).into());
        let status = site.get("/").await.status;
        assert_eq!(
            status == StatusCode::OK,
            goes_on,
            "{} {}",
            now - begun,
            now - seen
        );
    }
    // A request is a sign of life.
    site.set_cookies(visit_since(&store, now - 2 * HOUR, now - HOUR + 60).into());
    site.get("/").await;
    let key: VisitKey = site.cookies()["memrep"].parse().unwrap();
    let seen = store.visits().visit(&key.digest()).unwrap().unwrap().seen;
    assert!(seen >= now, "{seen}");
}

/// An invited person's visit lasts longer than the owner's, and not for ever.
#[tokio::test]
async fn an_invited_persons_visit_ends_after_twelve_hours_without_a_request_and_after_thirty_days()
{
    let (site, store) = locked();
    sign_in(&site).await;
    let session = create_signed(&site).await;
    let link = invite(&site, &session, "Ada").await;
    let key: InviteKey = link.rsplit('/').next().unwrap().parse().unwrap();
    let ada = site.elsewhere();
    let home = ada.enter(&link).await;
    let name = format!("memrep-{}", home.rsplit('/').next().unwrap());
    let (now, day) = (now(), 24 * HOUR);
    for (begun, seen, goes_on) in [
        (now, now, true),
        (now - 29 * day, now - 12 * HOUR + 60, true),
        (now - day, now - 12 * HOUR, false),
        (now - 30 * day, now, false),
    ] {
        let visit = VisitKey::random().unwrap();
        let visits = store.visits();
        let digest = visit.digest();
        visits
            .begin_visit(&digest, Some(&key.digest()), begun)
            .unwrap();
        visits.see_visit(&digest, seen).unwrap();
        ada.set_cookies([(name.clone(), visit.to_string())].into());
        let expected = if goes_on {
            StatusCode::OK
        } else {
            StatusCode::NOT_FOUND
        };
        let status = ada.get(&home).await.status;
        assert_eq!(status, expected, "{} {}", now - begun, now - seen);
        let kept = visits.visit(&digest).unwrap();
        assert_eq!(kept.is_some(), goes_on, "what has ended is forgotten");
    }
}

/// Has a visit of this database look as if it had last been seen then.
fn turn_back(database: &Path, site: &Site, seen: u64) {
    let key: VisitKey = site.cookies()["memrep"].parse().unwrap();
    let sql = "UPDATE visits SET seen = ?2 WHERE digest = ?1";
    let connection = rusqlite::Connection::open(database).unwrap();
    let changed = connection.execute(sql, (key.digest(), seen.cast_signed()));
    assert_eq!(changed.unwrap(), 1);
}

/// The next piece of a stream, if there is one soon; none where it has ended.
async fn next(stream: &mut Body) -> Option<Option<String>> {
    let frame = tokio::time::timeout(Duration::from_secs(5), stream.frame()).await;
    let frame = frame.ok()?.map(|frame| frame.unwrap().into_data().unwrap());
    Some(frame.map(|bytes| String::from_utf8(bytes.to_vec()).unwrap()))
}

async fn followed(site: &Site, path: &str) -> Body {
    let request = Request::get(path).body(Body::empty()).unwrap();
    let answer = site.open(site.with_cookies(request)).await;
    assert_eq!(answer.status(), StatusCode::OK, "{path}");
    let mut stream = answer.into_body();
    let first = next(&mut stream)
        .await
        .flatten()
        .expect("the first at once");
    assert!(first.contains("event: entries"), "{first}");
    stream
}

/// A page that was left open tells nothing more once its visit has ended.
#[tokio::test]
async fn open_streams_end_with_the_visit_by_which_they_were_opened() {
    let limits = Limits {
        stays: Duration::from_millis(50),
        ..Limits::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let database = folder.path().join("a.db");
    let store = Arc::new(Sqlite::open(&database).unwrap());
    let site = locked_over(&store, Reached::default(), limits);
    sign_in(&site).await;
    let session = create_signed(&site).await;
    let link = invite(&site, &session, "Ada").await;
    let page = session.replace("/api/v1", "");
    let [owners, api] = [format!("{page}/live"), format!("{session}/live")];

    // By signing out; and until then it goes on, without being a sign of life.
    let key: VisitKey = site.cookies()["memrep"].parse().unwrap();
    let quiet = now() - HOUR + 600;
    let mut streams = [followed(&site, &owners).await, followed(&site, &api).await];
    turn_back(&database, &site, quiet);
    tokio::time::sleep(Duration::from_millis(300)).await;
    let seen = store.visits().visit(&key.digest()).unwrap().unwrap().seen;
    assert_eq!(seen, quiet);
    for stream in &mut streams {
        let more = tokio::time::timeout(Duration::from_millis(20), stream.frame()).await;
        assert!(more.is_err(), "it goes on");
    }
    site.form("/sign-out", &[]).await;
    for stream in &mut streams {
        assert_eq!(next(stream).await, Some(None));
    }

    // By dismissal: whoever is not wanted any more hears nothing more.
    sign_in(&site).await;
    let bo = site.elsewhere();
    let place = bo.enter(&invite(&site, &session, "Bo").await).await;
    let mut theirs = followed(&bo, &format!("{place}/live")).await;
    site.form(&format!("{page}/people/2/dismissal"), &[]).await;
    while let Some(Some(_)) = next(&mut theirs).await {}
    assert_eq!(next(&mut theirs).await, Some(None));

    // By time, and by another password: the owner's and an invited person's.
    sign_in(&site).await;
    let ada = site.elsewhere();
    let place = ada.enter(&link).await;
    let mut stream = followed(&site, &owners).await;
    turn_back(&database, &site, now() - HOUR);
    assert_eq!(next(&mut stream).await, Some(None));
    sign_in(&site).await;
    let mut stream = followed(&site, &owners).await;
    let mut theirs = followed(&ada, &format!("{place}/live")).await;
    let hash = hash_password("another horse battery").unwrap();
    store.visits().set_password(Some(&hash)).unwrap();
    assert_eq!(next(&mut stream).await, Some(None));
    assert_eq!(next(&mut theirs).await, Some(None));
}
