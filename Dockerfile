# memrep in a container: built here, run by a user without rights. See
# docs/deployment.md.
FROM rust:1-slim-bookworm AS build
# The bundled SQLite is C.
RUN apt-get update && apt-get install -y --no-install-recommends gcc libc6-dev && rm -rf /var/lib/apt/lists/*
WORKDIR /memrep
COPY . .
# `postgres`, where servers are to share a database.
ARG FEATURES=
RUN cargo build --release --locked --bin memrep --features "$FEATURES" && strip target/release/memrep

FROM debian:bookworm-slim
# Whom to trust with a connection to a database elsewhere.
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates && rm -rf /var/lib/apt/lists/*
RUN useradd --system --uid 10001 --home-dir /data --shell /usr/sbin/nologin memrep \
    && install -d -o memrep -g memrep -m 0700 /data
COPY --from=build /memrep/target/release/memrep /usr/local/bin/memrep
USER 10001:10001
WORKDIR /data
VOLUME /data
# The log is for machines. In a container's own network namespace the address below
# is reached by what shares the namespace: a proxy beside it, as the document says.
ENV MEMREP_ADDR=127.0.0.1:8080 \
    MEMREP_DATABASE=/data/memrep.db \
    MEMREP_LOG_FORMAT=json
STOPSIGNAL SIGTERM
ENTRYPOINT ["memrep"]
CMD ["serve"]
