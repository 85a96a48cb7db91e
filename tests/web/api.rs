//! The JSON API: a scripted teacher from the first question to the download,
//! and every way to get it wrong.

use crate::site::{Reply, Site};
use automata::{Alphabet, Dfa, Word};
use axum::http::StatusCode;
use memrep::evidence::Comparison;
use memrep::oracle::{ScriptedTeacher, Target, Teacher, TeacherSettings};
use serde_json::{Value, json};

pub(crate) fn word(alphabet: &Alphabet, value: &Value) -> Word {
    let names = value
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n.as_str().unwrap());
    alphabet.word(names).unwrap()
}

pub(crate) fn dfa(value: &Value) -> Dfa {
    automata::format::json::read(&value.to_string())
        .unwrap()
        .dfa
}

/// The teacher's answer to a question of the API.
pub(crate) fn answer(
    teacher: &mut impl Teacher<Atom = Word, Concept = Dfa>,
    alphabet: &Alphabet,
    question: &Value,
) -> Value {
    let number = &question["number"];
    match question["kind"].as_str().unwrap() {
        "membership" => {
            let accepted = teacher.membership(&word(alphabet, &question["word"]));
            json!({"question": number, "answer": if accepted { "accept" } else { "reject" }})
        }
        "comparison" => {
            let first = word(alphabet, &question["first"]);
            let second = word(alphabet, &question["second"]);
            let answer = match teacher.comparison(&first, &second) {
                Comparison::First => "first",
                Comparison::Second => "second",
                Comparison::Equal => "equal",
                Comparison::Incomparable => "incomparable",
            };
            json!({"question": number, "answer": answer})
        }
        "equivalence" => match teacher.counterexample(&dfa(&question["hypothesis"])) {
            None => json!({"question": number, "answer": "correct"}),
            Some((word, label)) => {
                let names: Vec<&str> = alphabet.spell(&word).collect();
                json!({"question": number, "answer": "counterexample", "word": names, "label": label})
            }
        },
        other => panic!("{other} is no question"),
    }
}

pub(crate) async fn create(site: &Site, body: Value) -> String {
    let reply = site.post("/api/v1/sessions", body).await;
    assert_eq!(reply.status, StatusCode::CREATED, "{}", reply.text);
    format!("/api/v1/sessions/{}", reply.json()["id"].as_str().unwrap())
}

#[tokio::test]
async fn a_scripted_teacher_is_understood_across_a_restart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.db");
    for (name, body) in [
        ("tomita:5", json!({"task": "tomita:5"})),
        (
            "robot",
            json!({"task": "robot", "membership_cost": 2, "seed": 3}),
        ),
        (
            "tomita:2",
            json!({"task": "tomita:2", "strategy": "membership"}),
        ),
        (
            "zeros:1",
            json!({"task": "zeros:1", "comparison_cost": "inf"}),
        ),
    ] {
        let target = Target::named(name).unwrap();
        let alphabet = target.dfa().alphabet().clone();
        let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
        let mut site = Site::at(&path);
        let session = create(&site, body).await;
        let mut question = site.get(&format!("{session}/question")).await.json();
        let mut asked = 0;
        while question["kind"] != "done" {
            asked += 1;
            assert!(asked < 200, "{name}: too many questions");
            if asked == 5 {
                site = Site::at(&path);
                let again = site.get(&format!("{session}/question")).await.json();
                assert_eq!(again, question, "{name}: another question after a restart");
            }
            let said = answer(&mut teacher, &alphabet, &question);
            let reply = site.post(&format!("{session}/answers"), said.clone()).await;
            assert_eq!(reply.status, StatusCode::OK, "{name}: {}", reply.text);
            let twice = site.post(&format!("{session}/answers"), said).await;
            assert_eq!(
                twice.text, reply.text,
                "{name}: a repeated answer is counted twice"
            );
            question = reply.json();
        }
        assert!(
            asked >= 5 || name == "zeros:1",
            "{name}: only {asked} questions"
        );
        let file = site.get(&format!("{session}/automaton")).await;
        assert_eq!(file.header("content-type"), "application/json");
        let learned = automata::format::json::read(&file.text).unwrap().dfa;
        assert!(learned.is_equivalent(target.dfa()).unwrap(), "{name}");

        let state = site.get(&session).await.json();
        assert_eq!(state["state"], "done");
        let counts = &state["counts"];
        let sum: u64 = ["membership", "comparison", "equivalence"]
            .iter()
            .map(|kind| counts[kind].as_u64().unwrap())
            .sum();
        assert_eq!(sum, asked, "{name}");
        for format in ["json", "dot", "dot-people", "hoa", "svg"] {
            let file = site
                .get(&format!("{session}/automaton?format={format}"))
                .await;
            assert_eq!(
                file.status,
                StatusCode::OK,
                "{name} {format}: {}",
                file.text
            );
            assert!(file.header("content-disposition").starts_with("attachment"));
        }
        let log = site.get(&format!("{session}/log")).await.text;
        let lines: Vec<Value> = log
            .lines()
            .map(|l| serde_json::from_str(l).unwrap())
            .collect();
        assert_eq!(lines.len() as u64, 2 + 2 * asked, "{name}");
        assert_eq!(lines[0]["event"], "created");
        assert_eq!(lines[2]["event"], "answered");
        assert_eq!(lines[2]["seq"], 2);
    }
}

/// Checks an error's status, code and field, and that it says something.
fn check(reply: &Reply, status: u16, code: &str, field: &str) {
    assert_eq!(reply.status, status, "{}", reply.text);
    let error = &reply.json()["error"];
    assert_eq!(error["code"], code, "{}", reply.text);
    assert_eq!(
        error["field"].as_str().unwrap_or(""),
        field,
        "{}",
        reply.text
    );
    assert!(
        error["message"].as_str().unwrap().len() > 15,
        "{}",
        reply.text
    );
}

#[tokio::test]
async fn sessions_that_cannot_be_are_refused() {
    let site = Site::in_memory();
    let long = vec!["a"; 2000];
    let many: Vec<String> = (0..65).map(|i| format!("s{i}")).collect();
    for (body, field) in [
        (json!([]), ""),
        (json!({}), "task"),
        (json!({"task": 5}), "task"),
        (json!({"task": "tomita:9"}), "task"),
        (json!({"task": "<script>alert(1)</script>"}), "task"),
        (json!({"task": "tomita:5", "sead": 1}), "sead"),
        (json!({"task": "tomita:5", "seed": 1.5}), "seed"),
        (json!({"task": "tomita:5", "strategy": "x"}), "strategy"),
        (
            json!({"task": "tomita:5", "membership_cost": 0}),
            "membership_cost",
        ),
        (
            json!({"task": "tomita:5", "comparison_cost": -2}),
            "comparison_cost",
        ),
        (json!({"task": {}}), "task.symbols"),
        (json!({"task": {"symbols": []}}), "task.symbols"),
        (json!({"task": {"symbols": ["a", "a"]}}), "task.symbols[1]"),
        (json!({"task": {"symbols": ["a", ""]}}), "task.symbols[1]"),
        (json!({"task": {"symbols": ["a b"]}}), "task.symbols[0]"),
        (
            json!({"task": {"symbols": ["x".repeat(61)]}}),
            "task.symbols[0]",
        ),
        (
            json!({"task": {"symbols": ["'; DROP TABLE sessions; --"]}}),
            "task.symbols[0]",
        ),
        (
            json!({"task": {"symbols": [{"name": "a", "word": "x\u{0}"}]}}),
            "task.symbols[0].word",
        ),
        (json!({"task": {"symbols": many}}), "task.symbols"),
        (
            json!({"task": {"symbols": ["a"], "target": "tomita:1"}}),
            "task.target",
        ),
        (
            json!({"task": {"symbols": ["a"], "examples": [{"word": ["b"], "label": true}]}}),
            "task.examples[0].word[0]",
        ),
        (
            json!({"task": {"symbols": ["a"], "examples": [{"word": long, "label": true}]}}),
            "task.examples[0].word",
        ),
        (
            json!({"task": {"symbols": ["a"], "max_states": 100_000}}),
            "task.max_states",
        ),
    ] {
        check(
            &site.post("/api/v1/sessions", body).await,
            422,
            "malformed",
            field,
        );
    }
    for text in ["", "{", "{\"task\": \"tomita:5\"", "task=tomita:5", "\u{0}"] {
        let reply = site
            .post_text("/api/v1/sessions", "application/json", text)
            .await;
        check(&reply, 400, "unreadable_body", "");
    }
    let cut = site
        .post_text("/api/v1/sessions", "application/json", "{\"task\":\n 5")
        .await;
    assert!(cut.text.contains("line 2 column"), "{}", cut.text);
    let huge = format!("\"{}\"", "a".repeat(3 << 20));
    let reply = site
        .post_text("/api/v1/sessions", "application/json", huge)
        .await;
    check(&reply, 413, "body_too_large", "");
    assert_eq!(
        site.get("/api/v1/sessions").await.json()["sessions"],
        json!([])
    );
}

/// Answers to the first question of a session of the robot, none of which can
/// be: the body, and the status, code and field of the error.
fn bad_answers() -> Vec<(Value, u16, &'static str, &'static str)> {
    vec![
        (json!(7), 422, "malformed", ""),
        (json!({"answer": "accept"}), 422, "malformed", "question"),
        (
            json!({"question": "1", "answer": "accept"}),
            422,
            "malformed",
            "question",
        ),
        (json!({"question": 1}), 422, "malformed", "answer"),
        (
            json!({"question": 1, "answer": "maybe"}),
            422,
            "malformed",
            "answer",
        ),
        (
            json!({"question": 1, "answer": "accept", "word": []}),
            422,
            "malformed",
            "word",
        ),
        (
            json!({"question": 1, "answer": "accept", "why": "?"}),
            422,
            "malformed",
            "why",
        ),
        (
            json!({"question": 1, "answer": "counterexample"}),
            422,
            "malformed",
            "word",
        ),
        (
            json!({"question": 1, "answer": "counterexample", "word": ["2"], "label": true}),
            422,
            "malformed",
            "word[0]",
        ),
        (
            json!({"question": 1, "answer": "counterexample", "word": "R", "label": true}),
            422,
            "malformed",
            "word",
        ),
        (
            json!({"question": 1, "answer": "counterexample", "word": ["R"]}),
            422,
            "malformed",
            "label",
        ),
        (
            json!({"question": 1, "answer": "correct"}),
            422,
            "answer_does_not_fit",
            "answer",
        ),
        (
            json!({"question": 2, "answer": "accept"}),
            404,
            "no_such_question",
            "question",
        ),
    ]
}

#[tokio::test]
async fn answers_that_cannot_be_are_refused() {
    let site = Site::in_memory();
    let session = create(&site, json!({"task": "robot"})).await;
    let answers = format!("{session}/answers");
    let open = site.get(&format!("{session}/question")).await.json();
    assert_eq!(open["number"], 1);
    for (body, status, code, field) in bad_answers() {
        let reply = site.post(&answers, body.clone()).await;
        check(&reply, status, code, field);
        assert_eq!(
            site.get(&format!("{session}/question")).await.json(),
            open,
            "{body}"
        );
    }
    check(
        &site.post(&format!("{session}/undo"), json!({})).await,
        409,
        "nothing_to_undo",
        "",
    );
    check(
        &site
            .post(&format!("{session}/retractions"), json!({"question": 1}))
            .await,
        409,
        "no_standing_answer",
        "question",
    );
    check(
        &site
            .post(&format!("{session}/bound"), json!({"max_states": 2}))
            .await,
        422,
        "bad_bound",
        "max_states",
    );
    check(
        &site.get(&format!("{session}/automaton")).await,
        409,
        "no_automaton",
        "",
    );
    check(
        &site.get(&format!("{session}/automaton?format=exe")).await,
        422,
        "malformed",
        "format",
    );

    // The first question is answered; another answer to it comes too late.
    let skip = site
        .post(&answers, json!({"question": 1, "answer": "skip"}))
        .await;
    assert_eq!(skip.json()["number"], 2);
    let late = match open["kind"].as_str().unwrap() {
        "membership" => "accept",
        _ => "equal",
    };
    let reply = site
        .post(&answers, json!({"question": 1, "answer": late}))
        .await;
    check(&reply, 409, "question_closed", "question");
    assert!(
        reply.text.contains("question 2 is open now"),
        "{}",
        reply.text
    );
}

#[tokio::test]
async fn addresses_that_lead_nowhere_say_so() {
    let site = Site::in_memory();
    let nobody = "/api/v1/sessions/0123456789abcdef0123456789abcdef";
    for path in [
        nobody.to_owned(),
        format!("{nobody}/question"),
        format!("{nobody}/automaton"),
        format!("{nobody}/log"),
        "/api/v1/sessions/..%2f..%2fetc".to_owned(),
        "/api/v1/sessions/%00".to_owned(),
    ] {
        check(&site.get(&path).await, 404, "no_such_session", "");
    }
    let answer = json!({"question": 1, "answer": "skip"});
    check(
        &site.post(&format!("{nobody}/answers"), answer).await,
        404,
        "no_such_session",
        "",
    );
    check(&site.get("/api/v1/nothing").await, 404, "not_found", "");
    for no_text in ["/api/v1/sessions/%ff", "/api/v1/%E0%80"] {
        check(&site.get(no_text).await, 404, "not_found", "");
    }
    let page = site.get("/sessions/%ff").await;
    assert_eq!(page.status, StatusCode::NOT_FOUND);
    assert!(page.text.contains("<html"), "{}", page.text);
    check(&site.get("/api/v2/sessions").await, 404, "not_found", "");
    check(
        &site.get(&format!("{nobody}/answers")).await,
        405,
        "method_not_allowed",
        "",
    );
}

#[tokio::test]
async fn answers_can_be_withdrawn_changed_and_undone() {
    let site = Site::in_memory();
    let session = create(&site, json!({"task": "robot", "strategy": "membership"})).await;
    let first = site.get(&format!("{session}/question")).await.json();
    assert_eq!(first["kind"], "membership");
    let answers = format!("{session}/answers");
    let second = site
        .post(&answers, json!({"question": 1, "answer": "accept"}))
        .await
        .json();
    assert_eq!(second["number"], 2);

    // Undone, the first question comes again under a new number.
    let again = site
        .post(&format!("{session}/undo"), json!({}))
        .await
        .json();
    assert_eq!(
        (&again["number"], &again["word"]),
        (&json!(3), &first["word"])
    );
    let twice = site
        .post(&format!("{session}/retractions"), json!({"question": 1}))
        .await;
    assert_eq!(twice.json(), again, "withdrawing twice is withdrawing once");

    site.post(&answers, json!({"question": 3, "answer": "accept"}))
        .await;
    let changed = json!({"question": 3, "answer": "reject"});
    let mended = site
        .post(&format!("{session}/changes"), changed.clone())
        .await;
    assert_eq!(mended.status, StatusCode::OK, "{}", mended.text);
    assert_eq!(
        site.post(&format!("{session}/changes"), changed).await.text,
        mended.text
    );
    // As if it had been rejected from the beginning.
    let fresh = create(&site, json!({"task": "robot", "strategy": "membership"})).await;
    let rejected = site
        .post(
            &format!("{fresh}/answers"),
            json!({"question": 1, "answer": "reject"}),
        )
        .await
        .json();
    assert_eq!(mended.json()["word"], rejected["word"]);
    assert_eq!(mended.json()["kind"], rejected["kind"]);
}

#[tokio::test]
async fn answers_given_at_once_are_counted_once() {
    let site = std::sync::Arc::new(Site::in_memory());
    let session = create(&site, json!({"task": "robot", "strategy": "membership"})).await;
    let tasks: Vec<_> = (0..8)
        .map(|i| {
            let (site, path) = (site.clone(), format!("{session}/answers"));
            let said = if i % 2 == 0 { "accept" } else { "reject" };
            tokio::spawn(async move {
                site.post(&path, json!({"question": 1, "answer": said}))
                    .await
                    .status
            })
        })
        .collect();
    let mut statuses = Vec::new();
    for task in tasks {
        statuses.push(task.await.unwrap().as_u16());
    }
    statuses.sort_unstable();
    assert_eq!(statuses, [200, 200, 200, 200, 409, 409, 409, 409]);
    let log = site.get(&format!("{session}/log")).await.text;
    assert_eq!(log.lines().count(), 4, "{log}");
}
