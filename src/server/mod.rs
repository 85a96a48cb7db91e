//! Pages and API over sessions. Must not know SAT or encodings.
//!
//! [`app`] is the whole site as a service, [`run`] serves it. A request goes
//! through the layers of [`app`], a handler in `api` or `pages`, and
//! `teaching`, which is the only way to a session.

mod again;
mod ahead;
mod api;
mod archive;
mod assets;
mod behaviour;
mod budget;
mod busy;
mod chart;
mod check;
mod connections;
mod desks;
mod done;
mod drive;
mod error;
mod export;
mod follow;
mod forms;
mod guard;
mod health;
mod invited;
mod leases;
mod live;
mod media;
mod metrics;
mod observe;
mod outlook;
mod owner;
mod pages;
mod past;
mod people;
mod people_api;
mod practice;
mod recording;
pub mod routes;
mod rule;
mod scene;
mod spent;
mod standing;
mod start;
mod studio;
mod teaching;
mod trace;
mod upload;
mod views;
mod walk;

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::{Body, HttpBody as _};
use axum::extract::{DefaultBodyLimit, Request, State};
use axum::http::Uri;
use axum::http::header::CONTENT_TYPE;
use axum::middleware::{Next, from_fn, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::csrf::{CsrfLayer, ProtectionError};
use tower_http::timeout::{DeadlineBody, RequestBodyDeadlineLayer};

use crate::store::Store;
pub use connections::Limits;
use error::{ApiError, PageError, WebError};
use metrics::Metrics;
pub use owner::{BadPassword, NoOrigin, Origin, Reached, hash_password};
use owner::{Door, SharedDoor};
use teaching::Teaching;

/// The largest body of a form: 64 KiB.
const FORM_LIMIT: usize = 64 * 1024;
/// The largest body of an API request: 2 MiB.
const API_LIMIT: usize = 2 * 1024 * 1024;
/// Connections to the address of the figures: whoever watches has a few.
const FIGURES_CONNECTIONS: usize = 64;
/// So many bodies that are larger than a form's are in memory at the same time.
const LARGE_AT_ONCE: usize = 16;
/// How long requests in progress may take to finish once the server stops.
const FAREWELL: Duration = Duration::from_secs(3);

/// What all requests share.
#[derive(Clone)]
pub struct AppState {
    teaching: Teaching,
    metrics: Arc<Metrics>,
    /// Whose turn it is to ask whether the store is well.
    probes: Arc<Semaphore>,
    /// Who may come in.
    door: SharedDoor,
    /// Whether the figures are on an address of their own.
    figures_apart: bool,
    limits: Limits,
    /// Whose turn it is to send much at once.
    large: Arc<Semaphore>,
}

impl AppState {
    /// A site over this store, in which as many sessions think at the same
    /// time as the machine has cores.
    pub fn new(store: Arc<dyn Store>) -> Self {
        Self::with_lease(store, leases::LENGTH)
    }

    /// The same, where each of several people has a question for so long before it
    /// is offered to another.
    pub fn with_lease(store: Arc<dyn Store>, lease: Duration) -> Self {
        let width = std::thread::available_parallelism().map_or(2, usize::from);
        let metrics = Arc::new(Metrics::default());
        Self {
            teaching: Teaching::new(store, width, lease, Arc::clone(&metrics)),
            metrics,
            probes: Arc::new(Semaphore::new(1)),
            door: Arc::new(Door::new(Reached::default())),
            figures_apart: false,
            limits: Limits::default(),
            large: Arc::new(Semaphore::new(LARGE_AT_ONCE)),
        }
    }

    /// The same, whose connections may ask so much.
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }

    /// The same, reached in this way.
    #[must_use]
    pub fn reached(self, reached: Reached) -> Self {
        Self {
            door: Arc::new(Door::new(reached)),
            ..self
        }
    }

    /// The same, where a session thinks on for so long after the last who waited for it
    /// has gone.
    #[must_use]
    pub fn with_grace(self, grace: Duration) -> Self {
        Self {
            teaching: self.teaching.with_grace(grace),
            ..self
        }
    }

    /// The same for scripts, which rather wait than ask again.
    fn patient(&self) -> Self {
        Self {
            teaching: self.teaching.patient(),
            ..self.clone()
        }
    }

    /// The same, with its figures on no address but [the one](run_figures) that is
    /// theirs.
    #[must_use]
    pub fn with_figures_apart(self) -> Self {
        Self {
            figures_apart: true,
            ..self
        }
    }
}

/// The whole site.
pub fn app(state: AppState) -> Router {
    let in_time = RequestBodyDeadlineLayer::new(state.limits.body);
    let uploads_in_time = from_fn_with_state(state.clone(), uploads_in_time);
    let new_session = Router::new().route("/sessions", post(upload::create));
    let api = api::routes()
        .merge(people_api::routes())
        .merge(owner::api_routes().layer(DefaultBodyLimit::max(FORM_LIMIT)))
        .layer(in_time.clone())
        .merge(new_session.layer(uploads_in_time.clone()))
        .layer(from_fn_with_state(state.clone(), in_turn))
        .fallback(async || ApiError(WebError::NoPage))
        .method_not_allowed_fallback(async || ApiError(WebError::NoMethod))
        .layer(CatchPanicLayer::custom(|panic| {
            ApiError(panicked(&panic)).into_response()
        }))
        .layer(DefaultBodyLimit::max(API_LIMIT));
    let new_session = Router::new()
        .route("/sessions", post(start::begin))
        .route("/studio/recordings", post(studio::record));
    let pages = pages::routes()
        .merge(studio::routes())
        .merge(people::routes())
        .merge(invited::routes())
        .merge(owner::routes())
        .route("/static/{stamp}/{name}", get(assets::get))
        .layer(in_time)
        .merge(new_session.layer(uploads_in_time))
        .layer(from_fn_with_state(state.clone(), in_turn))
        .fallback(async |uri: Uri| guard::refuse(uri.path(), WebError::NoPage))
        .method_not_allowed_fallback(async || PageError(WebError::NoMethod))
        .layer(CatchPanicLayer::custom(|panic| {
            PageError(panicked(&panic)).into_response()
        }))
        .layer(DefaultBodyLimit::max(FORM_LIMIT));
    let same_site = CsrfLayer::new().with_rejection_response(|error: ProtectionError| {
        tracing::info!(%error, "cross-site request refused");
        ApiError(WebError::Foreign).into_response()
    });
    Router::new()
        .nest("/api/v1", api.with_state(state.patient()))
        .merge(pages.with_state(state.clone()))
        .layer(from_fn_with_state(state.clone(), owner::admit))
        .layer(same_site)
        .layer(from_fn(guard::text))
        .layer(from_fn_with_state(state.clone(), guard::host))
        .merge(health::routes(state.clone()))
        .layer(from_fn_with_state(state.clone(), guard::headers))
        .layer(from_fn_with_state(state, observe::observe))
}

/// Lets files take longer to arrive than all else that goes to the same routes.
async fn uploads_in_time(State(app): State<AppState>, request: Request, next: Next) -> Response {
    let time = if upload::is_multipart(&request) {
        app.limits.upload
    } else {
        app.limits.body
    };
    let request = request.map(|body| Body::new(DeadlineBody::new(time, body)));
    next.run(request).await
}

/// Lets few bodies that are larger than a form's come at the same time, for they are in
/// memory as a whole. Files are not.
async fn in_turn(State(app): State<AppState>, request: Request, next: Next) -> Response {
    let most = request.body().size_hint().upper();
    let is_large = most.is_none_or(|most| most > FORM_LIMIT as u64);
    let _turn = if is_large && !upload::is_multipart(&request) {
        app.large.acquire().await.ok()
    } else {
        None
    };
    next.run(request).await
}

fn panicked(panic: &(dyn std::any::Any + Send)) -> WebError {
    let cause = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied())
        .unwrap_or("unknown panic");
    WebError::internal(format!("panic: {cause}"))
}

/// Serves the site on `listener` until `shutdown` resolves; requests in
/// progress then have three seconds to finish.
pub async fn run(
    listener: TcpListener,
    state: AppState,
    shutdown: impl Future<Output = ()> + Send + 'static,
) {
    let (stopping, stopped) = tokio::sync::oneshot::channel();
    let (teaching, limits) = (state.teaching.clone(), state.limits);
    let shutdown = async move {
        shutdown.await;
        teaching.end();
        let _ = stopping.send(());
    };
    let farewell = async {
        // An error means that the server ended by itself.
        if stopped.await.is_ok() {
            tokio::time::sleep(FAREWELL).await;
        } else {
            std::future::pending::<()>().await;
        }
    };
    tokio::select! {
        () = connections::serve(listener, app(state), &limits, shutdown) => {}
        () = farewell => {
            tracing::warn!("stopped with requests unfinished; their sessions go on at the next start");
        }
    }
}

/// Serves `/metrics` and `/healthz` on an address of their own, which whoever chose it
/// keeps from others.
pub async fn run_figures(listener: TcpListener, state: AppState) {
    let limits = Limits {
        connections: FIGURES_CONNECTIONS,
        ..state.limits
    };
    connections::serve(
        listener,
        health::apart(state),
        &limits,
        std::future::pending(),
    )
    .await;
}

/// A response whose body is text of this type.
fn typed(kind: &'static str, body: String) -> Response {
    ([(CONTENT_TYPE, kind)], body).into_response()
}
