//! The content of a task file that the studio's form says.

use serde_json::{Map, Value, json};

use super::sheet::{Row, Sheet};

/// Under which key examples tell behaviours, by what is learned.
fn atom_key(sheet: &Sheet) -> &'static str {
    match sheet.at("class.kind") {
        "monotone" => "point",
        "finite" | "linear" => "item",
        _ => "word",
    }
}

/// What the form says, as the content of a task file. What cannot be read stays as it
/// was typed, so that whoever reads the task says what is wrong with it.
pub(super) fn content(sheet: &Sheet) -> Value {
    let mut task = Map::new();
    for key in ["name", "title", "empty", "guidelines", "strategy"] {
        put(&mut task, key, text(sheet.at(key)));
    }
    put(&mut task, "max_states", number(sheet.at("max_states")));
    let mut costs = Map::new();
    for key in ["membership", "comparison"] {
        put(&mut costs, key, number(sheet.at(&format!("costs.{key}"))));
    }
    put(&mut task, "costs", some(costs));
    put(&mut task, "target", target(sheet));
    if sheet.at("class.kind").is_empty() {
        let symbols = sheet.rows("symbols").iter().map(|row| {
            let told = row.iter().map(|(key, value)| (*key, text(value)));
            object(told)
        });
        task.insert("symbols".to_owned(), symbols.collect());
        put(&mut task, "world", world(sheet));
        let mut prior = Map::new();
        for key in ["holds", "suffices"] {
            let rows = sheet.rows(match key {
                "holds" => "prior.holds",
                _ => "prior.suffices",
            });
            let rules: Vec<Value> = rows.iter().map(|row| typed(of(row, "rule"))).collect();
            put(&mut prior, key, (!rules.is_empty()).then(|| rules.into()));
        }
        put(&mut task, "prior", some(prior));
    } else {
        task.insert("class".to_owned(), class(sheet));
    }
    let key = atom_key(sheet);
    let examples = sheet.rows("examples").iter().map(|row| {
        let label = of(row, "label");
        let label = label.parse::<bool>().ok().map(Value::from);
        object([(key, Some(atom(of(row, "atom"), sheet))), ("label", label)])
    });
    let examples: Vec<Value> = examples.collect();
    let examples = (!examples.is_empty()).then(|| examples.into());
    put(&mut task, "examples", examples);
    put(&mut task, "practice", practice(sheet));
    Value::Object(task)
}

/// A field of a row.
pub(super) fn of<'a>(row: &'a Row, key: &str) -> &'a str {
    row.get(key).map_or("", String::as_str)
}

fn put(map: &mut Map<String, Value>, key: &str, value: Option<Value>) {
    if let Some(value) = value {
        map.insert(key.to_owned(), value);
    }
}

fn some(map: Map<String, Value>) -> Option<Value> {
    (!map.is_empty()).then_some(Value::Object(map))
}

fn object<'a>(entries: impl IntoIterator<Item = (&'a str, Option<Value>)>) -> Value {
    let mut map = Map::new();
    for (key, value) in entries {
        put(&mut map, key, value);
    }
    Value::Object(map)
}

fn text(typed: &str) -> Option<Value> {
    let typed = typed.trim();
    (!typed.is_empty()).then(|| typed.into())
}

/// A number, or what stands in its place.
fn number(typed: &str) -> Option<Value> {
    let typed = typed.trim();
    let whole = typed.parse::<i64>().map(Value::from).ok();
    let real = || {
        let number = typed.parse::<f64>().ok().filter(|n| n.is_finite())?;
        Some(json!(number))
    };
    whole.or_else(real).or_else(|| text(typed))
}

/// JSON where it looks like it: an automaton, a list.
fn typed(text: &str) -> Value {
    let text = text.trim();
    let looks_so = text.starts_with('{') || text.starts_with('[');
    let read = looks_so.then(|| serde_json::from_str(text).ok()).flatten();
    read.unwrap_or_else(|| text.into())
}

fn numbers(text: &str) -> Value {
    let split = text.split(|c: char| c.is_whitespace() || c == ',');
    split.filter_map(number).collect()
}

/// A behaviour as people type it.
fn atom(text: &str, sheet: &Sheet) -> Value {
    match atom_key(sheet) {
        "point" => numbers(text),
        "item" => text.trim().into(),
        _ => word(text, sheet),
    }
}

/// Names with spaces or commas between; where all names are single characters the
/// spaces may be left out.
fn word(text: &str, sheet: &Sheet) -> Value {
    let symbols = sheet.rows("symbols");
    let named = |token: &str| symbols.iter().any(|row| of(row, "name").trim() == token);
    let single = (symbols.iter()).all(|row| of(row, "name").trim().chars().count() == 1);
    let split = text.split(|c: char| c.is_whitespace() || c == ',' || c == '·');
    let tokens = split.filter(|token| !token.is_empty());
    let names = tokens.flat_map(|token| -> Vec<String> {
        if single && !named(token) && token.chars().all(|c| named(&c.to_string())) {
            token.chars().map(String::from).collect()
        } else {
            vec![token.to_owned()]
        }
    });
    names.collect::<Vec<_>>().into()
}

fn world(sheet: &Sheet) -> Option<Value> {
    let kind = sheet.at("world.kind");
    let at = |key: &str| sheet.at(key);
    Some(match kind {
        "" | "words" => {
            let longest = number(at("world.longest"))?;
            json!({"kind": "words", "longest": longest})
        }
        "grid" => object([
            ("kind", text(kind)),
            ("map", Some(at("world.map").trim_matches('\n').into())),
            ("steps", number(at("world.steps"))),
            ("labelling", text(at("world.labelling"))),
        ]),
        "pool" => object([
            ("kind", text(kind)),
            ("recordings", text(at("world.recordings"))),
        ]),
        other => json!({ "kind": other }),
    })
}

fn class(sheet: &Sheet) -> Value {
    let kind = sheet.at("class.kind");
    let at = |key: &str| sheet.at(key);
    match kind {
        "monotone" => {
            let axes = sheet.rows("class.axes").iter().map(|row| {
                object([
                    ("name", text(of(row, "name"))),
                    ("unit", text(of(row, "unit"))),
                    ("best", number(of(row, "best"))),
                    ("worst", number(of(row, "worst"))),
                ])
            });
            object([
                ("kind", text(kind)),
                ("axes", Some(axes.collect())),
                ("ticks", number(at("class.ticks"))),
                ("picture", text(at("class.picture"))),
            ])
        }
        "finite" => object([
            ("kind", text(kind)),
            ("table", Some(at("class.table").into())),
        ]),
        "linear" => {
            let names = at("class.features").lines().filter_map(text);
            let behaviours = sheet.rows("class.behaviours").iter().map(|row| {
                let steps = of(row, "features").split([';', '\n']);
                let steps = steps.filter(|step| !step.trim().is_empty());
                object([
                    ("name", text(of(row, "name"))),
                    ("features", Some(steps.map(numbers).collect())),
                ])
            });
            object([
                ("kind", text(kind)),
                ("features", Some(names.collect())),
                ("finest", number(at("class.finest"))),
                ("behaviours", Some(behaviours.collect())),
            ])
        }
        other => json!({ "kind": other }),
    }
}

fn practice(sheet: &Sheet) -> Option<Value> {
    let behaviour = |field: &str| Some(atom(sheet.at(field), sheet));
    let (answer, why) = (
        text(sheet.at("practice.answer")),
        text(sheet.at("practice.why")),
    );
    match sheet.at("practice.kind") {
        "judgement" => Some(object([
            (atom_key(sheet), behaviour("practice.atom")),
            ("answer", answer),
            ("why", why),
        ])),
        "comparison" => Some(object([
            ("first", behaviour("practice.first")),
            ("second", behaviour("practice.second")),
            ("answer", answer),
            ("why", why),
        ])),
        _ => None,
    }
}

/// A rule a line, or one value as JSON; limits are numbers with spaces between.
fn target(sheet: &Sheet) -> Option<Value> {
    let told = sheet.at("target").trim();
    if told.is_empty() {
        return None;
    }
    let looks_like_json = told.starts_with('{') || told.starts_with('[');
    if sheet.at("class.kind") == "monotone" && !looks_like_json {
        return Some(numbers(told));
    }
    if let whole @ (Value::Object(_) | Value::Array(_)) = typed(told) {
        return Some(whole);
    }
    let rules: Vec<Value> = (told.lines().map(str::trim))
        .filter(|line| !line.is_empty())
        .map(typed)
        .collect();
    match &rules[..] {
        [one] => Some(one.clone()),
        _ => Some(rules.into()),
    }
}
