//! One connection to a server on this machine, kept open between requests.

use std::net::SocketAddr;
use std::time::Duration;

use http_body_util::{BodyExt as _, Full, Limited};
use hyper::body::Bytes;
use hyper::client::conn::http1::{self, SendRequest};
use hyper::header::{CONTENT_TYPE, HOST};
use hyper::{Method, Request, StatusCode};
use hyper_util::rt::TokioIo;
use serde_json::Value;
use tokio::net::TcpStream;

/// How long an answer may take; a server that is slower does not answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// The largest answer that is read.
const LARGEST: usize = 16 << 20;

/// Why there was no answer.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// The server cannot be reached.
    #[error("no connection: {0}")]
    Connect(#[from] std::io::Error),
    /// The connection ended.
    #[error("the connection ended: {0}")]
    Ended(#[from] hyper::Error),
    /// The answer was too long, or ended too early.
    #[error("the answer is not whole: {0}")]
    Body(Box<dyn std::error::Error + Send + Sync>),
    /// The request cannot be written.
    #[error("no request: {0}")]
    Request(#[from] hyper::http::Error),
    /// There was none within a minute.
    #[error("no answer within a minute")]
    Slow,
    /// The server asks for patience.
    #[error("put off for too long")]
    PutOff,
    /// It is not what was expected.
    #[error("status {0}")]
    Status(u16),
    /// It is not what was expected.
    #[error("an answer without sense: {0}")]
    Nonsense(&'static str),
}

impl ClientError {
    /// What is counted together.
    pub(super) fn kind(&self) -> String {
        match self {
            Self::Connect(_) => "no connection".to_owned(),
            Self::Ended(_) => "the connection ended".to_owned(),
            Self::Body(_) => "half an answer".to_owned(),
            other => other.to_string(),
        }
    }
}

/// A connection, made when it is needed.
pub(super) struct Client {
    address: SocketAddr,
    sender: Option<SendRequest<Full<Bytes>>>,
    /// How often it had to be made anew.
    pub(super) reconnects: u64,
}

impl Client {
    pub(super) fn new(address: SocketAddr) -> Self {
        Self {
            address,
            sender: None,
            reconnects: 0,
        }
    }

    /// The JSON that comes back.
    pub(super) async fn json(
        &mut self,
        method: Method,
        path: &str,
        body: Option<&Value>,
    ) -> Result<Value, ClientError> {
        let (status, bytes) = self.send(method, path, body).await?;
        if status == StatusCode::SERVICE_UNAVAILABLE {
            let told: Value = serde_json::from_slice(&bytes).unwrap_or_default();
            if let Some("still_thinking" | "not_taken_yet") = told["error"]["code"].as_str() {
                return Err(ClientError::PutOff);
            }
        }
        if !status.is_success() {
            return Err(ClientError::Status(status.as_u16()));
        }
        serde_json::from_slice(&bytes).map_err(|_| ClientError::Nonsense("no JSON"))
    }

    /// What comes back. A request that meets a connection which the server has closed
    /// meanwhile is sent once more: the same answer counts once.
    pub(super) async fn send(
        &mut self,
        method: Method,
        path: &str,
        body: Option<&Value>,
    ) -> Result<(StatusCode, Bytes), ClientError> {
        let was_open = self.sender.is_some();
        let sent = tokio::time::timeout(PATIENCE, self.once(&method, path, body));
        let sent = sent.await.unwrap_or(Err(ClientError::Slow));
        if sent.is_ok() {
            return sent;
        }
        self.sender = None;
        if !was_open || !matches!(sent, Err(ClientError::Ended(_))) {
            return sent;
        }
        self.reconnects += 1;
        let again = tokio::time::timeout(PATIENCE, self.once(&method, path, body));
        let again = again.await.unwrap_or(Err(ClientError::Slow));
        if again.is_err() {
            self.sender = None;
        }
        again
    }

    async fn once(
        &mut self,
        method: &Method,
        path: &str,
        body: Option<&Value>,
    ) -> Result<(StatusCode, Bytes), ClientError> {
        let mut sender = match self.sender.take() {
            Some(sender) => sender,
            None => self.connect().await?,
        };
        let body = body.map_or(Bytes::new(), |value| value.to_string().into());
        let request = Request::builder()
            .method(method)
            .uri(path)
            .header(HOST, self.address.to_string())
            .header(CONTENT_TYPE, "application/json")
            .body(Full::new(body))?;
        sender.ready().await?;
        let response = sender.send_request(request).await?;
        let status = response.status();
        let whole = Limited::new(response.into_body(), LARGEST).collect();
        let bytes = whole.await.map_err(ClientError::Body)?.to_bytes();
        self.sender = Some(sender);
        Ok((status, bytes))
    }

    async fn connect(&self) -> Result<SendRequest<Full<Bytes>>, ClientError> {
        let stream = TcpStream::connect(self.address).await?;
        stream.set_nodelay(true)?;
        let (sender, connection) = http1::handshake(TokioIo::new(stream)).await?;
        // How it ends is seen by whoever sends next.
        tokio::spawn(connection);
        Ok(sender)
    }
}
