//! What makes no sense.

use axum::http::Method;
use rand::RngExt;

use super::Caller;

impl Caller {
    /// What makes no sense.
    pub(super) async fn nonsense(&mut self) {
        let ids = [
            self.id.clone(),
            self.id.to_uppercase(),
            "0".repeat(32),
            "%00".to_owned(),
            "..%2f..".to_owned(),
            "\u{202e}"
                .escape_unicode()
                .to_string()
                .replace(['\\', '{', '}'], ""),
            "x".repeat(3000),
        ];
        let doors = [
            "",
            "/question",
            "/answers",
            "/retractions",
            "/changes",
            "/undo",
            "/bound",
            "/automaton",
            "/concept",
            "/log",
            "/people",
            "/people/terms",
            "/samples",
            "/nothing",
            "/again",
            "/history",
            "/why",
            "/practice",
            "/media/x",
            "/people/9999999999/link",
        ];
        let bodies = [
            String::new(),
            "{".to_owned(),
            "[]".to_owned(),
            "null".to_owned(),
            "{\"question\":1e400,\"answer\":\"accept\"}".to_owned(),
            "{\"question\":18446744073709551616,\"answer\":\"accept\"}".to_owned(),
            "{\"question\":1,\"question\":2,\"answer\":{\"a\":[]}}".to_owned(),
            "{\"max_states\":4000000000}".to_owned(),
            "{\"task\":{\"symbols\":[\"a\"],\"max_states\":0}}".to_owned(),
            "{\"task\":\"modulo:51\",\"seed\":-1}".to_owned(),
            "{\"task\":{\"symbols\":[\"a\",\"a\"],\"world\":{\"kind\":\"pool\",\"upload\":\"x\"}}}"
                .to_owned(),
            "question=1&answer=accept&question=2".to_owned(),
            "question=%FF%00&answer=%u0000&act=remove+symbols%5B99999999999999999999%5D".to_owned(),
            "\u{0}\u{feff}<script>".to_owned(),
            "[".repeat(5000),
            "a".repeat(70_000),
            "--x\r\nContent-Disposition: form-data; name=\"task\"\r\n\r\n{}\r\n--x--".to_owned(),
        ];
        let kinds = [
            "application/json",
            "application/json",
            "application/x-www-form-urlencoded",
            "text/plain",
            "multipart/form-data; boundary=x",
            "multipart/form-data",
            "\u{7f}x/",
        ];
        let methods = [
            Method::GET,
            Method::POST,
            Method::POST,
            Method::POST,
            Method::PUT,
            Method::DELETE,
            Method::PATCH,
            Method::HEAD,
            Method::OPTIONS,
        ];
        let (id, door) = (self.some(&ids), self.some(&doors));
        let path = match self.random.random_range(0..8) {
            0..4 => format!("/api/v1/sessions/{id}{door}"),
            4 | 5 => format!("/sessions/{id}{door}"),
            6 if self.one_in(2) => format!("/answer/s/{id}{door}"),
            6 => format!("/api/v1/answer/{id}"),
            _ => self
                .some(&[
                    "/sessions",
                    "/api/v1/sessions",
                    "/studio",
                    "/studio/recordings",
                    "/api/v2",
                    "/answer/x/answers",
                ])
                .to_owned(),
        };
        let (method, kind, body) = (self.some(&methods), self.some(&kinds), self.some(&bodies));
        self.send(method, path, kind, body).await;
    }
}
