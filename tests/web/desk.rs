//! The studio's form as a browser without script has it: typed into, and sent.

use crate::parts::Parts;
use crate::site::{Reply, Site};

/// The studio's form on a page, as it would be sent.
pub(crate) struct Desk {
    pub(crate) fields: Vec<(String, String)>,
    pub(crate) page: Reply,
}

pub(crate) fn unescaped(text: &str) -> String {
    let pairs = [
        ("&#34;", "\""),
        ("&#39;", "'"),
        ("&#60;", "<"),
        ("&#62;", ">"),
        ("&#38;", "&"),
    ];
    (pairs.iter()).fold(text.to_owned(), |text, (code, plain)| {
        text.replace(code, plain)
    })
}

fn attribute(tag: &str, name: &str) -> Option<String> {
    let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
    Some(unescaped(rest.split('"').next()?))
}

/// The fields of the form, in their order: what a browser would send of them.
fn fields_of(page: &str) -> Vec<(String, String)> {
    let form = page
        .split("id=\"studio\"")
        .nth(1)
        .expect("the page has the form");
    let form = form.split("</form>").next().unwrap();
    // What is in a template is no part of a page.
    let mut visible = String::new();
    for (i, part) in form.split("<template").enumerate() {
        visible += if i == 0 {
            part
        } else {
            part.split_once("</template>").unwrap().1
        };
    }
    let mut fields = Vec::new();
    for part in visible.split('<').skip(1) {
        let (tag, text) = part.split_once('>').unwrap_or((part, ""));
        let name = attribute(tag, "name");
        match (tag.split(' ').next().unwrap(), name) {
            ("input", Some(name)) if !tag.contains("type=\"file\"") => {
                fields.push((name, attribute(tag, "value").unwrap_or_default()));
            }
            ("textarea", Some(name)) => {
                let text = text.strip_prefix('\n').unwrap_or(text);
                fields.push((name, unescaped(text)));
            }
            ("select", Some(name)) => fields.push((name, "\u{0}".to_owned())),
            ("option", _)
                if fields.last().is_some_and(|(_, v)| v == "\u{0}")
                    || tag.ends_with(" selected") =>
            {
                // A list of suggestions has options too, and is no field.
                if let (Some((_, value)), Some(chosen)) =
                    (fields.last_mut(), attribute(tag, "value"))
                    && (value == "\u{0}" || tag.ends_with(" selected"))
                {
                    *value = chosen;
                }
            }
            _ => {}
        }
    }
    fields
}

impl Desk {
    pub(crate) async fn open(site: &Site, path: &str) -> Self {
        Self::of(site.get(path).await)
    }

    pub(crate) fn of(page: Reply) -> Self {
        Self {
            fields: fields_of(&page.text),
            page,
        }
    }

    pub(crate) fn fill(&mut self, name: &str, value: &str) {
        let field = self.fields.iter_mut().find(|(known, _)| known == name);
        let field = field.unwrap_or_else(|| panic!("no field {name}: {}", self.page.text));
        // As browsers send it.
        field.1 = value.replace('\n', "\r\n");
    }

    pub(crate) fn at(&self, name: &str) -> &str {
        let field = self.fields.iter().find(|(known, _)| known == name);
        let (_, value) = field.unwrap_or_else(|| panic!("no field {name}"));
        value
    }

    pub(crate) async fn press(&self, site: &Site, button: &str) -> Reply {
        let mut parts = Parts::default();
        for (name, value) in &self.fields {
            parts = parts.text(name, value);
        }
        assert!(
            button.starts_with("save-draft")
                || self.page.text.contains(&format!("value=\"{button}\"")),
            "no button {button}"
        );
        parts.text("do", button).send(site, "/studio").await
    }

    pub(crate) async fn then(&mut self, site: &Site, button: &str) {
        *self = Self::of(self.press(site, button).await);
    }

    /// What is said at a field.
    pub(crate) fn fault(&self, id: &str) -> Option<String> {
        let (_, rest) = self.page.text.split_once(&format!("id=\"{id}-fault\">"))?;
        Some(unescaped(rest.split("</").next()?))
    }
}
