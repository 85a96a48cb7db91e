//! The pages as a browser without script sees them: forms, headers, errors.

use crate::site::{Reply, Site};
use automata::Alphabet;
use axum::body::Body;
use axum::http::{Request, StatusCode};
use memrep::evidence::Comparison;
use memrep::oracle::{ScriptedTeacher, Target, Teacher, TeacherSettings};

fn word(alphabet: &Alphabet, text: &str) -> automata::Word {
    alphabet.word(text.split_whitespace()).unwrap()
}

/// Answers the page's question by its words, and gives the next page.
async fn answer(
    site: &Site,
    at: &str,
    page: &Reply,
    teacher: &mut ScriptedTeacher,
    alphabet: &Alphabet,
) -> Reply {
    let number = page.main("data-question");
    let words: Vec<_> = page.words().iter().map(|w| word(alphabet, w)).collect();
    let said = match page.main("data-kind").as_str() {
        "membership" => {
            assert_eq!(words.len(), 1);
            if teacher.membership(&words[0]) {
                "accept"
            } else {
                "reject"
            }
        }
        "comparison" => {
            assert_eq!(words.len(), 2);
            match teacher.comparison(&words[0], &words[1]) {
                Comparison::First => "first",
                Comparison::Second => "second",
                Comparison::Equal => "equal",
                Comparison::Incomparable => "incomparable",
            }
        }
        "equivalence" => {
            let hypothesis = site.get(&format!("/api/v1{at}/automaton")).await.text;
            let hypothesis = automata::format::json::read(&hypothesis).unwrap().dfa;
            match teacher.counterexample(&hypothesis) {
                None => "correct",
                Some((wrong, label)) => {
                    let typed: Vec<&str> = alphabet.spell(&wrong).collect();
                    let label = if label { "true" } else { "false" };
                    let fields = [
                        ("question", number.as_str()),
                        ("word", &typed.join(" ")),
                        ("label", label),
                    ];
                    let next = site
                        .form(&format!("{at}/answers"), &fields)
                        .await
                        .location();
                    return site.get(&next).await;
                }
            }
        }
        other => panic!("{other} is no question: {}", page.text),
    };
    let fields = [("question", number.as_str()), ("answer", said)];
    let next = site
        .form(&format!("{at}/answers"), &fields)
        .await
        .location();
    assert_eq!(next, at);
    site.get(&next).await
}

#[tokio::test]
async fn a_person_without_script_teaches_the_robot() {
    let site = Site::in_memory();
    let start = site.get("/").await;
    assert_eq!(start.main("data-kind"), "start");
    assert!(start.text.contains("data-task=\"robot\""));
    assert!(start.text.contains("data-task=\"tomita:5\""));
    let at = site
        .form("/sessions", &[("task", "robot")])
        .await
        .location();
    let target = Target::named("robot").unwrap();
    let alphabet = target.dfa().alphabet().clone();
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let mut page = site.get(&at).await;
    let mut asked = 0;
    while page.main("data-kind") != "done" {
        asked += 1;
        assert!(asked < 200);
        page = answer(&site, &at, &page, &mut teacher, &alphabet).await;
    }
    for format in ["json", "dot", "dot-people", "hoa", "svg", "log"] {
        assert!(
            page.text.contains(&format!("id=\"download-{format}\"")),
            "{format}"
        );
    }
    let drawing = site.get(&format!("{at}/automaton.svg")).await;
    assert_eq!(drawing.header("content-type"), "image/svg+xml");
    let history = site.get(&format!("{at}/history")).await;
    assert_eq!(history.text.matches("class=\"card past\"").count(), asked);
    let start = site.get("/").await;
    assert!(start.text.contains("rule learned"));
    // Going on opens the last question again.
    let agreed = format!("{asked}");
    let back = site
        .form(&format!("{at}/retractions"), &[("question", &agreed)])
        .await;
    assert_eq!(
        site.get(&back.location()).await.main("data-kind"),
        "equivalence"
    );
}

#[tokio::test]
async fn an_own_task_is_read_or_its_fault_named() {
    let site = Site::in_memory();
    let fields = [
        ("title", "Tea <b>&amp;"),
        ("symbols", "water, tea"),
        ("examples", "+ water tea\r\n- tea water"),
    ];
    let at = site.form("/sessions", &fields).await.location();
    let page = site.get(&at).await;
    assert!(page.text.contains("Tea &#60;b&#62;"), "{}", page.text);
    assert!(!page.text.contains("<b>&amp;"));
    let history = site.get(&format!("{at}/history")).await;
    assert_eq!(history.words(), ["water tea", "tea water"]);

    for (symbols, examples, message) in [
        ("", "", "Name the things that can happen"),
        ("a a", "", "named twice"),
        ("a b!", "", "letters, digits"),
        ("a b", "a", "line 1"),
        ("a b", "+ a\n- c", "`c` is not a symbol"),
        ("a b", "+ a\n- a", "other label"),
    ] {
        let reply = site
            .form("/sessions", &[("symbols", symbols), ("examples", examples)])
            .await;
        assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
        assert!(
            reply.text.to_lowercase().contains(&message.to_lowercase()),
            "{message}: {}",
            reply.text
        );
        assert!(
            reply.text.contains(&format!("value=\"{symbols}\"")),
            "what was typed is kept"
        );
    }
    let reply = site
        .form("/sessions", &[("symbols", "a \u{0}\u{1b}<i>")])
        .await;
    assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
    assert!(
        !reply.text.contains(['\u{0}', '\u{1b}']),
        "no page can have these"
    );
    assert!(!reply.text.contains("<i>"));
}

#[tokio::test]
async fn names_that_look_like_markup_stay_text() {
    let site = Site::in_memory();
    let body = serde_json::json!({"task": {
        "title": "</title><script>alert(1)</script>",
        "guidelines": "<img src=x onerror=alert(1)>",
        "empty": "\"><svg onload=alert(1)>",
        "symbols": [{"name": "a", "word": "</span><script>alert(2)</script>"}, {"name": "b", "word": "' onclick='x"}],
        "examples": [{"word": ["a"], "label": true}],
    }});
    let id = site.post("/api/v1/sessions", body).await.json()["id"]
        .as_str()
        .unwrap()
        .to_owned();
    let at = format!("/sessions/{id}");
    // Whatever comes: every page until a rule is on show, and that one too.
    for _ in 0..40 {
        let page = site.get(&at).await;
        let history = site.get(&format!("{at}/history")).await;
        for text in [&page.text, &history.text] {
            for bad in [
                "<script>alert",
                "<img src=x",
                "<svg onload",
                "</span><script",
                "' onclick='x",
            ] {
                assert!(!text.contains(bad), "{bad} in {text}");
            }
        }
        let number = page.main("data-question");
        let said = match page.main("data-kind").as_str() {
            "membership" => "reject",
            "comparison" => "equal",
            _ => {
                let drawing = site.get(&format!("/api/v1{at}/automaton?format=svg")).await;
                assert!(!drawing.text.contains("<script>"), "{}", drawing.text);
                return;
            }
        };
        site.form(
            &format!("{at}/answers"),
            &[("question", &number), ("answer", said)],
        )
        .await;
    }
    panic!("no rule came");
}

#[tokio::test]
async fn a_late_or_wrong_form_shows_the_question_that_is_open() {
    let site = Site::in_memory();
    let at = site
        .form("/sessions", &[("task", "robot")])
        .await
        .location();
    let answers = format!("{at}/answers");
    let skip = [("question", "1"), ("answer", "skip")];
    assert_eq!(site.form(&answers, &skip).await.location(), at);
    // A double click.
    assert_eq!(site.form(&answers, &skip).await.location(), at);
    let late = site
        .form(&answers, &[("question", "1"), ("answer", "accept")])
        .await;
    assert_eq!(late.status, StatusCode::CONFLICT);
    assert_eq!(late.main("data-question"), "2");
    assert!(
        late.text
            .contains("Question 1 is closed: question 2 is open now."),
        "{}",
        late.text
    );
    for fields in [
        &[("question", "2")][..],
        &[("answer", "accept")],
        &[("question", "x"), ("answer", "y")],
    ] {
        let reply = site.form(&answers, fields).await;
        assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
        assert!(reply.text.contains("role=\"alert\""));
    }
    let unreadable = site.post_text(&answers, "text/plain", "question=2").await;
    assert_eq!(unreadable.status, StatusCode::BAD_REQUEST);
}

#[tokio::test]
async fn a_word_that_is_no_counterexample_is_kept_in_its_field() {
    let site = Site::in_memory();
    let at = site
        .form("/sessions", &[("task", "tomita:1")])
        .await
        .location();
    let target = Target::named("tomita:1").unwrap();
    let alphabet = target.dfa().alphabet().clone();
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let mut page = site.get(&at).await;
    while page.main("data-kind") != "equivalence" {
        page = answer(&site, &at, &page, &mut teacher, &alphabet).await;
    }
    let number = page.main("data-question");
    assert!(
        page.text.contains("id=\"transitions\""),
        "the table is there for those who cannot see"
    );
    let accepts_empty = page.text.contains("(start)</th><td>yes");
    let label = if accepts_empty { "true" } else { "false" };
    for (word, label, part) in [
        ("", label, "no counterexample"),
        ("0 2", "true", "`2` is not a symbol"),
        ("0 1", "", "choose whether"),
    ] {
        let fields = [
            ("question", number.as_str()),
            ("word", word),
            ("label", label),
        ];
        let reply = site.form(&format!("{at}/answers"), &fields).await;
        assert_eq!(reply.status, StatusCode::UNPROCESSABLE_ENTITY);
        assert!(
            reply.text.to_lowercase().contains(part),
            "{part}: {}",
            reply.text
        );
        assert!(
            reply
                .text
                .contains(&format!("name=\"word\" value=\"{word}\""))
        );
    }
}

#[tokio::test]
async fn contradictory_answers_come_as_cards_that_can_be_mended() {
    let site = Site::in_memory();
    let at = site
        .form("/sessions", &[("symbols", "a b")])
        .await
        .location();
    // A person who prefers A whatever A is will be caught.
    let mut page = site.get(&at).await;
    for _ in 0..100 {
        let number = page.main("data-question");
        let fields = match page.main("data-kind").as_str() {
            "conflict" => break,
            "comparison" => vec![("question", number.as_str()), ("answer", "first")],
            "membership" => vec![("question", number.as_str()), ("answer", "accept")],
            "equivalence" if page.text.contains("(start)</th><td>yes") => {
                vec![
                    ("question", number.as_str()),
                    ("word", ""),
                    ("label", "false"),
                ]
            }
            _ => vec![
                ("question", number.as_str()),
                ("word", ""),
                ("label", "true"),
            ],
        };
        let next = site
            .form(&format!("{at}/answers"), &fields)
            .await
            .location();
        page = site.get(&next).await;
    }
    assert_eq!(page.main("data-kind"), "conflict", "{}", page.text);
    let cards = page.text.matches("class=\"card past\"").count();
    assert!(cards >= 1, "{}", page.text);
    let number = page
        .text
        .split("id=\"answer-")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap();
    let next = site
        .form(&format!("{at}/retractions"), &[("question", number)])
        .await
        .location();
    assert_ne!(site.get(&next).await.main("data-kind"), "conflict");
}

/// All that a page may load and do, word for word.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; \
    media-src 'self'; connect-src 'self'; form-action 'self'; frame-ancestors 'none'; \
    base-uri 'none'";

#[tokio::test]
async fn every_answer_has_the_headers_that_keep_others_out() {
    let site = Site::in_memory();
    let start = site.get("/").await.text;
    let after = start.split_once("href=\"/static/").unwrap().1;
    let stamp = after.split_once('/').unwrap().0;
    for (path, kind) in [
        ("/".to_owned(), "text/html"),
        ("/nothing".to_owned(), "text/html"),
        ("/api/v1/nothing".to_owned(), "application/json"),
        (format!("/static/{stamp}/app.css"), "text/css"),
        (format!("/static/{stamp}/app.js"), "text/javascript"),
        (format!("/static/{stamp}/swap.js"), "text/javascript"),
        (format!("/static/{stamp}/icon.svg"), "image/svg+xml"),
    ] {
        let reply = site.get(&path).await;
        let policy = reply.header("content-security-policy");
        assert_eq!(policy, POLICY, "{path}");
        assert_eq!(reply.header("x-content-type-options"), "nosniff", "{path}");
        assert_eq!(reply.header("referrer-policy"), "no-referrer", "{path}");
        assert!(reply.header("content-type").starts_with(kind), "{path}");
        assert!(!reply.header("x-request-id").is_empty(), "{path}");
        for inline in [" style=", "<style", " onclick=", "<script>"] {
            assert!(
                !reply.text.contains(inline) || !kind.ends_with("html"),
                "{inline} in {path}"
            );
        }
    }
    for path in [
        "/static/../Cargo.toml",
        "/static/app.js",
        "/static/00000000/app.js",
        &format!("/static/{stamp}/nothing.js"),
    ] {
        let gone = site.get(path).await;
        assert_eq!(gone.status, StatusCode::NOT_FOUND, "{path}");
        assert_eq!(gone.header("cache-control"), "no-store", "{path}");
    }
}

#[tokio::test]
async fn other_sites_cannot_act_here() {
    let site = Site::in_memory();
    let send = async |path: &str, headers: &[(&str, &str)]| {
        let mut request =
            Request::post(path).header("content-type", "application/x-www-form-urlencoded");
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        site.send(request.body(Body::from("task=robot")).unwrap())
            .await
            .status
    };
    let own = ("host", "127.0.0.1:8080");
    for (headers, status) in [
        (&[own][..], StatusCode::SEE_OTHER),
        (
            &[own, ("sec-fetch-site", "same-origin")],
            StatusCode::SEE_OTHER,
        ),
        (
            &[own, ("origin", "http://127.0.0.1:8080")],
            StatusCode::SEE_OTHER,
        ),
        (
            &[own, ("sec-fetch-site", "cross-site")],
            StatusCode::FORBIDDEN,
        ),
        (
            &[own, ("sec-fetch-site", "same-site")],
            StatusCode::FORBIDDEN,
        ),
        (
            &[own, ("origin", "http://evil.example")],
            StatusCode::FORBIDDEN,
        ),
        (&[own, ("origin", "null")], StatusCode::FORBIDDEN),
        (&[("host", "evil.example")], StatusCode::FORBIDDEN),
    ] {
        assert_eq!(send("/sessions", headers).await, status, "{headers:?}");
    }
    // Nothing changes by looking.
    let before = site.get("/").await.text;
    assert_eq!(site.get("/").await.text, before);
    assert_eq!(
        site.get("/sessions").await.status,
        StatusCode::METHOD_NOT_ALLOWED
    );
}
