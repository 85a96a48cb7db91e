//! What the API says of itself is what it does.

use std::collections::BTreeSet;

use axum::body::Body;
use axum::http::{Method, Request, StatusCode};
use memrep::oracle::{ScriptedTeacher, Target, TeacherSettings};
use serde_json::{Value, json};

use crate::api::{answer, create};
use crate::site::Site;

const API: &str = "/api/v1";

async fn description(site: &Site) -> Value {
    let reply = site.get(&format!("{API}/openapi.json")).await;
    assert_eq!(reply.header("content-type"), "application/json");
    reply.json()
}

/// The methods and paths that a source file gives to its router.
fn routes_in(source: &str) -> BTreeSet<(String, String)> {
    let mut routes = BTreeSet::new();
    for part in source.split(".route(").skip(1) {
        let Some((path, rest)) = part
            .trim_start()
            .strip_prefix('"')
            .and_then(|p| p.split_once('"'))
        else {
            continue;
        };
        let handlers = rest.split(")\n").next().unwrap();
        for method in ["get", "post"] {
            if handlers.contains(&format!("{method}(")) {
                routes.insert((method.to_owned(), path.to_owned()));
            }
        }
    }
    routes
}

#[tokio::test]
async fn it_describes_the_routes_that_there_are_and_no_others() {
    let site = Site::in_memory();
    let document = description(&site).await;
    let mut described = BTreeSet::new();
    for (path, operations) in document["paths"].as_object().unwrap() {
        for method in operations
            .as_object()
            .unwrap()
            .keys()
            .filter(|key| *key != "parameters")
        {
            described.insert((method.clone(), path.clone()));
        }
    }
    let mut there = routes_in(include_str!("../../src/server/api.rs"));
    there.extend(routes_in(include_str!("../../src/server/people_api.rs")));
    // Its upload has a deadline of its own, and is put in beside the others.
    // And these are beside the pages that do the same.
    for path in ["/sessions", "/sign-in", "/sign-out"] {
        there.insert(("post".to_owned(), path.to_owned()));
    }
    assert!(there.len() > 15, "{there:?}");
    assert_eq!(described, there);
    for (method, path) in described {
        let path = path
            .replace("{id}", "00000000000000000000000000000000")
            .replace("{key}", "none");
        let method = Method::from_bytes(method.to_ascii_uppercase().as_bytes()).unwrap();
        let request = Request::builder()
            .method(method)
            .uri(format!("{API}{path}"));
        let reply = site.send(request.body(Body::empty()).unwrap()).await;
        if !reply.status.is_success() {
            let code = &reply.json()["error"]["code"];
            assert!(
                code != "not_found" && code != "method_not_allowed",
                "{path}: {code}"
            );
        }
    }
}

/// What is wrong with a value by a schema: as much of JSON Schema as the description uses.
fn fault(document: &Value, schema: &Value, value: &Value) -> Option<String> {
    if let Some(name) = schema["$ref"].as_str() {
        let target = document.pointer(name.strip_prefix('#').unwrap());
        return fault(
            document,
            target.unwrap_or_else(|| panic!("no {name}")),
            value,
        );
    }
    if let Some(choices) = schema["oneOf"].as_array() {
        let faults: Vec<Option<String>> =
            choices.iter().map(|c| fault(document, c, value)).collect();
        let fitting = faults.iter().filter(|fault| fault.is_none()).count();
        return (fitting != 1).then(|| format!("{fitting} of {faults:?} fit {value}"));
    }
    if !schema["const"].is_null() && schema["const"] != *value {
        return Some(format!("{value} is not {}", schema["const"]));
    }
    if let Some(allowed) = schema["enum"].as_array()
        && !allowed.contains(value)
    {
        return Some(format!("{value} is none of {allowed:?}"));
    }
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_f64() => "number",
        Value::Number(_) => "integer",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    };
    let is = |wanted: &Value| wanted == kind || (wanted == "number" && kind == "integer");
    let fits = match &schema["type"] {
        Value::Null => true,
        Value::Array(kinds) => kinds.iter().any(is),
        one => is(one),
    };
    if !fits {
        return Some(format!("{value} is no {}", schema["type"]));
    }
    let required = schema["required"].as_array().into_iter().flatten();
    let missing = required.filter(|key| value.get(key.as_str().unwrap()).is_none());
    if let Some(key) = missing.into_iter().next() {
        return Some(format!("{key} is missing in {value}"));
    }
    let fields = value.as_object().into_iter().flatten();
    let inner = fields.filter_map(|(key, value)| Some((schema["properties"].get(key)?, value)));
    let items = value.as_array().into_iter().flatten();
    let items = items.filter_map(|item| Some((schema.get("items")?, item)));
    inner
        .chain(items)
        .find_map(|(schema, value)| fault(document, schema, value))
}

fn assert_fits(document: &Value, path: &str, method: &str, status: u16, value: &Value) {
    let responses = &document["paths"][path][method]["responses"];
    let response = responses
        .get(status.to_string())
        .unwrap_or(&responses["default"]);
    let response = match response["$ref"].as_str() {
        Some(name) => document.pointer(&name[1..]).unwrap(),
        None => response,
    };
    let schema = &response["content"]["application/json"]["schema"];
    assert!(schema.is_object(), "{method} {path} {status} has no schema");
    if let Some(fault) = fault(document, schema, value) {
        panic!("{method} {path} {status}: {fault}");
    }
}

#[tokio::test]
async fn replies_are_as_it_says() {
    let site = Site::in_memory();
    let document = description(&site).await;
    let target = Target::named("robot").unwrap();
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let session = create(&site, json!({"task": "robot"})).await;
    let mut kinds = BTreeSet::new();
    for _ in 0..40 {
        let question = site.get(&format!("{session}/question")).await.json();
        assert_fits(&document, "/sessions/{id}/question", "get", 200, &question);
        kinds.insert(question["kind"].as_str().unwrap().to_owned());
        if question["kind"] == "done" {
            break;
        }
        if question["kind"] == "equivalence" {
            let sheet = site.get(&format!("{session}/samples")).await;
            assert_fits(
                &document,
                "/sessions/{id}/samples",
                "get",
                200,
                &sheet.json(),
            );
        }
        let said = answer(&mut teacher, target.dfa().alphabet(), &question);
        let schema = json!({"$ref": "#/components/schemas/Answer"});
        assert_eq!(fault(&document, &schema, &said), None);
        let next = site.post(&format!("{session}/answers"), said).await;
        assert_fits(
            &document,
            "/sessions/{id}/answers",
            "post",
            200,
            &next.json(),
        );
    }
    assert!(kinds.contains("done") && kinds.len() >= 3, "{kinds:?}");
    let gets = [
        ("/sessions", "/api/v1/sessions".to_owned()),
        ("/sessions/{id}", session.clone()),
        ("/sessions/{id}/people", format!("{session}/people")),
        ("/sessions/{id}/concept", format!("{session}/concept")),
    ];
    for (path, at) in gets {
        let reply = site.get(&at).await;
        assert_eq!(reply.status, StatusCode::OK, "{at}: {}", reply.text);
        assert_fits(&document, path, "get", 200, &reply.json());
    }
    let late = site
        .post(
            &format!("{session}/answers"),
            json!({"question": 1, "answer": "correct"}),
        )
        .await;
    assert_fits(
        &document,
        "/sessions/{id}/answers",
        "post",
        late.status.into(),
        &late.json(),
    );
    assert!(late.status.is_client_error());
}

/// A client that is made from the description sends what is in it: no key of it may be
/// one that the server does not know.
#[tokio::test]
async fn the_server_knows_every_key_of_an_answer_that_it_describes() {
    let site = Site::in_memory();
    let document = description(&site).await;
    let session = create(&site, json!({"task": "robot"})).await;
    let person = site
        .post(&format!("{session}/people"), json!({"name": "Ada"}))
        .await;
    let link = person.json()["link"].as_str().unwrap().to_owned();
    for (schema, at) in [
        ("Answer", format!("{session}/answers")),
        ("PersonsAnswer", format!("{API}{link}")),
    ] {
        let schema = &document["components"]["schemas"][schema];
        assert_eq!(schema["additionalProperties"], false);
        let keys = schema["properties"].as_object().unwrap().keys();
        // Those of behaviours that are no words belong to other tasks.
        for key in keys.filter(|key| !["point", "item"].contains(&key.as_str())) {
            let reply = site.post(&at, json!({ key: "?" })).await;
            let message = reply.json()["error"]["message"].to_string();
            assert!(reply.status.is_client_error(), "{key}");
            assert!(!message.contains("unknown key"), "{at}: {key}: {message}");
        }
        let strange = site.post(&at, json!({"tooke": 1})).await;
        assert!(strange.text.contains("unknown key"), "{}", strange.text);
    }
}

/// Who has a password has to be told by the description that it is wanted, and where.
#[tokio::test]
async fn it_says_who_must_sign_in_and_how() {
    let (site, _) = crate::door::locked();
    let document = description(&site).await;
    let token = &document["components"]["securitySchemes"]["token"];
    assert_eq!(
        (&token["type"], &token["scheme"]),
        (&json!("http"), &json!("bearer"))
    );
    let mut locked = 0;
    for (path, operations) in document["paths"].as_object().unwrap() {
        for (method, operation) in operations.as_object().unwrap() {
            if method == "parameters" {
                continue;
            }
            let security = operation.get("security").unwrap_or(&document["security"]);
            let is_open = security.as_array().unwrap().is_empty();
            let at = path
                .replace("{id}", &"0".repeat(32))
                .replace("{key}", "none");
            let request = Request::builder()
                .method(method.to_ascii_uppercase().as_str())
                .uri(format!("{API}{at}"));
            let reply = site.send(request.body(Body::empty()).unwrap()).await;
            if is_open || path == "/sign-out" {
                assert_ne!(reply.status, StatusCode::UNAUTHORIZED, "{method} {path}");
            } else {
                assert_eq!(reply.status, StatusCode::UNAUTHORIZED, "{method} {path}");
                assert_fits(&document, path, method, 401, &reply.json());
                locked += 1;
            }
        }
    }
    assert!(locked > 15, "{locked}");
    let wrong = site.post("/api/v1/sign-in", json!({"password": "x"})).await;
    assert_fits(&document, "/sign-in", "post", 401, &wrong.json());
    let right = json!({"password": crate::door::PASSWORD});
    let given = site.post("/api/v1/sign-in", right).await;
    assert_fits(&document, "/sign-in", "post", 201, &given.json());
}
