//! The studio's form that says what a task file says: the other way round than
//! `content`.

use serde_json::Value;

use super::content::of;
use super::sheet::{Row, Sheet};

/// The form that says what this content of a task file says. What stands in the wrong
/// place is shown as it is.
pub(super) fn sheet(content: &Value) -> Sheet {
    let mut sheet = Sheet::default();
    for key in [
        "name",
        "title",
        "empty",
        "guidelines",
        "strategy",
        "max_states",
    ] {
        sheet.set(key, plain(&content[key]).trim());
    }
    sheet.set("costs.membership", plain(&content["costs"]["membership"]));
    sheet.set("costs.comparison", plain(&content["costs"]["comparison"]));
    sheet.set("target", rules(&content["target"]));
    fill_symbols(&mut sheet, content);
    fill_world(&mut sheet, &content["world"]);
    let prior = &content["prior"];
    for (list, rules) in [
        ("prior.holds", &prior["holds"]),
        ("prior.suffices", &prior["suffices"]),
    ] {
        for rule in items(rules) {
            sheet.push(list, Row::from([("rule", plain(rule))]));
        }
    }
    fill_class(&mut sheet, &content["class"]);
    let behaviour = |value: &Value| -> String {
        let keys = ["word", "point", "item"];
        let told = keys.iter().map(|key| &value[*key]).find(|v| !v.is_null());
        told.map_or_else(String::new, atom_text)
    };
    for example in items(&content["examples"]) {
        let row = [
            ("atom", behaviour(example)),
            ("label", plain(&example["label"])),
        ];
        sheet.push("examples", Row::from(row));
    }
    let practice = &content["practice"];
    if practice.is_object() {
        let compares = !practice["first"].is_null() || !practice["second"].is_null();
        sheet.set(
            "practice.kind",
            if compares { "comparison" } else { "judgement" },
        );
        sheet.set("practice.atom", behaviour(practice));
        sheet.set("practice.first", atom_text(&practice["first"]));
        sheet.set("practice.second", atom_text(&practice["second"]));
        sheet.set("practice.answer", plain(&practice["answer"]));
        sheet.set("practice.why", plain(&practice["why"]).trim());
    }
    sheet
}

fn items(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn plain(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        // A whole number as people write it.
        other => {
            let text = other.to_string();
            let is_number = other.is_number();
            let whole = text.strip_suffix(".0").filter(|_| is_number);
            whole.map_or(text.clone(), str::to_owned)
        }
    }
}

fn joined(value: &Value, between: &str) -> String {
    match value {
        Value::Array(list) => list.iter().map(plain).collect::<Vec<_>>().join(between),
        other => plain(other),
    }
}

fn atom_text(value: &Value) -> String {
    joined(value, " ")
}

fn rules(value: &Value) -> String {
    match value {
        Value::Array(list) if !list.iter().all(Value::is_number) => joined(value, "\n"),
        Value::Array(_) => joined(value, " "),
        other => plain(other),
    }
}

fn fill_symbols(sheet: &mut Sheet, content: &Value) {
    for symbol in items(&content["symbols"]) {
        let mut row = Row::new();
        match symbol {
            Value::Object(_) => {
                for key in ["name", "word", "letter", "colour"] {
                    row.insert(key, plain(&symbol[key]));
                }
            }
            name => {
                row.insert("name", plain(name));
            }
        }
        let colour = &content["colours"][of(&row, "name")];
        if !colour.is_null() && of(&row, "colour").is_empty() {
            row.insert("colour", plain(colour));
        }
        sheet.push("symbols", row);
    }
}

fn fill_world(sheet: &mut Sheet, world: &Value) {
    let kind = match &world["kind"] {
        Value::Null => "words".to_owned(),
        kind => plain(kind),
    };
    sheet.set("world.kind", kind);
    sheet.set("world.longest", plain(&world["longest"]));
    sheet.set("world.map", joined(&world["map"], "\n").trim_matches('\n'));
    sheet.set("world.steps", plain(&world["steps"]));
    sheet.set("world.labelling", plain(&world["labelling"]));
    let recordings = match &world["recordings"] {
        Value::Null => "recordings.jsonl".to_owned(),
        named => plain(named),
    };
    sheet.set("world.recordings", recordings);
}

fn fill_class(sheet: &mut Sheet, class: &Value) {
    sheet.set("class.kind", plain(&class["kind"]));
    sheet.set("class.ticks", plain(&class["ticks"]));
    sheet.set("class.picture", plain(&class["picture"]));
    sheet.set("class.table", plain(&class["table"]));
    sheet.set("class.features", joined(&class["features"], "\n"));
    sheet.set("class.finest", plain(&class["finest"]));
    for axis in items(&class["axes"]) {
        let keys = ["name", "unit", "best", "worst"];
        sheet.push(
            "class.axes",
            keys.into_iter()
                .map(|key| (key, plain(&axis[key])))
                .collect(),
        );
    }
    for behaviour in items(&class["behaviours"]) {
        let steps = items(&behaviour["features"]).iter();
        let steps: Vec<String> = steps.map(|step| joined(step, " ")).collect();
        let row = [
            ("name", plain(&behaviour["name"])),
            ("features", steps.join("; ")),
        ];
        sheet.push("class.behaviours", Row::from(row));
    }
}
