//! People who are invited, and what they send from their own pages.

use axum::http::{Method, StatusCode};
use rand::RngExt;
use rand::seq::IndexedRandom;
use serde_json::{Value, json};

use super::sensible::fields_of;
use super::{ANSWERS, Caller};

impl Caller {
    pub(super) async fn people(&mut self) {
        let path = format!("/api/v1/sessions/{}/people", self.id);
        match self.random.random_range(0..8) {
            0 => {
                let name = self.some(&[
                    "Ada",
                    "",
                    "<b>",
                    "\u{202e}x",
                    "a name that is much too long, for nobody is called so, not even on paper",
                ]);
                let made = self.json(Method::POST, path, json!({"name": name})).await;
                if made.status == StatusCode::CREATED {
                    let link = made.json()["link"].as_str().unwrap().to_owned();
                    self.keys.push(link.rsplit('/').next().unwrap().to_owned());
                }
            }
            1 => {
                let pooling = self.some(&["majority", "reliability", "none"]);
                let body = json!({"answers": self.number(), "pooling": pooling});
                self.json(Method::POST, format!("{path}/terms"), body).await;
            }
            2 => {
                let person = self.random.random_range(0..4);
                let what = self.some(&["link", "dismissal"]);
                self.form(format!("/sessions/{}/people/{person}/{what}", self.id), &[])
                    .await;
            }
            _ => {
                let Some(key) = self.keys.choose(&mut self.random).cloned() else {
                    return drop(self.get(path).await);
                };
                if self.one_in(3) {
                    self.by_script(&key).await;
                } else {
                    self.by_browser(&key).await;
                }
            }
        }
    }

    /// What an invited program sends.
    async fn by_script(&mut self, key: &str) {
        let door = format!("/api/v1/answer/{key}");
        if self.one_in(3) {
            let body = json!({"question": self.number()});
            self.json(Method::POST, format!("{door}/retractions"), body)
                .await;
        } else {
            let reply = self.answer_of(key).await;
            self.json(Method::POST, door, reply).await;
        }
    }

    /// What an invited person's browser sends: it has come in by the link, and from
    /// then on is at a place that the link does not tell.
    async fn by_browser(&mut self, key: &str) {
        let known = self.homes.iter().find(|(of, _)| of == key);
        let home = match known.map(|(_, home)| home.clone()) {
            Some(home) if !self.one_in(10) => home,
            _ => {
                self.get(format!("/answer/{key}")).await;
                let entered = self.form(format!("/answer/{key}"), &[]).await;
                if entered.status != StatusCode::SEE_OTHER {
                    // The link was replaced, or they were dismissed.
                    return;
                }
                let home = entered.location();
                self.homes.push((key.to_owned(), home.clone()));
                home
            }
        };
        match self.random.random_range(0..10) {
            0..4 => {
                let reply = self.answer_of(key).await;
                let mut fields = fields_of(&reply);
                if self.one_in(2) {
                    fields.push(("mirrored", "1".to_owned()));
                    fields.push(("took", self.number().to_string()));
                }
                self.form(format!("{home}/answers"), &fields).await;
            }
            4 => {
                let number = self.number().to_string();
                self.form(format!("{home}/retractions"), &[("question", number)])
                    .await;
            }
            5 => {
                let answer = self.some(&ANSWERS).to_owned();
                self.form(format!("{home}/practice"), &[("answer", answer)])
                    .await;
            }
            6 => {
                let shown = self.get(home.clone()).await;
                // Who was dismissed has no news to follow.
                if shown.status == StatusCode::OK {
                    self.follow(format!("{home}/live")).await;
                }
            }
            _ => {
                for page in ["", "/history", "/practice", "/media/a.png"] {
                    self.get(format!("{home}{page}")).await;
                }
            }
        }
    }

    /// An answer to what this person is asked.
    async fn answer_of(&mut self, key: &str) -> Value {
        let asked = self.get(format!("/api/v1/answer/{key}")).await;
        let question = serde_json::from_str(&asked.text).unwrap_or_default();
        self.reply_to(&question)
    }
}
