//! How much each address may ask for in a while: of what is costly, and of tries to
//! sign in. Kept in memory alone.

use std::collections::HashSet;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::extract::{ConnectInfo, Request};
use axum::http::HeaderMap;

use crate::server::budget::Budget;
use crate::server::error::WebError;

/// Tries to sign in that an address has, and how soon there is another.
const TRIES: (u32, Duration) = (10, Duration::from_secs(60));
/// The same for all addresses together.
const ALL_TRIES: (u32, Duration) = (100, Duration::from_secs(1));
/// Costly work for an address, in the table of routes' units: sixty sessions begun, or
/// six hundred drawings, and then a session a second or ten drawings.
const WORK: (u32, Duration) = (600, Duration::from_millis(100));
/// So many addresses from which the owner came in are remembered.
const MOST_KNOWN: usize = 1000;

/// Where a request comes from, as far as it counts for limits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whence {
    /// Of an IPv6 address its network, since one machine has all addresses of that.
    pub(super) address: IpAddr,
    /// Whether it is this machine, by itself or by an SSH tunnel.
    is_near: bool,
}

/// The budgets of a site.
pub(super) struct Budgets {
    behind_proxy: bool,
    tries: Budget<IpAddr>,
    all_tries: Budget<()>,
    /// Where the owner came in before.
    known: Mutex<HashSet<IpAddr>>,
    work: Budget<IpAddr>,
}

impl Budgets {
    pub(super) fn new(behind_proxy: bool) -> Self {
        Self {
            behind_proxy,
            tries: Budget::new(TRIES.0, TRIES.1),
            all_tries: Budget::new(ALL_TRIES.0, ALL_TRIES.1),
            known: Mutex::default(),
            work: Budget::new(WORK.0, WORK.1),
        }
    }

    /// Where a request comes from.
    pub(super) fn whence(&self, request: &Request) -> Whence {
        let peer = request.extensions().get::<ConnectInfo<SocketAddr>>();
        self.of(peer.map(|ConnectInfo(peer)| peer.ip()), request.headers())
    }

    fn of(&self, peer: Option<IpAddr>, headers: &HeaderMap) -> Whence {
        let told = headers.get_all("x-forwarded-for").iter().next_back();
        let told = told
            .filter(|_| self.behind_proxy)
            .and_then(|told| told.to_str().ok())
            .and_then(|told| told.rsplit(',').next()?.trim().parse().ok());
        // Without a connection it is this process that asks.
        let is_here = peer.is_none_or(|peer| peer.to_canonical().is_loopback());
        let nowhere = IpAddr::from([0, 0, 0, 0]);
        let address = match told.or(peer).unwrap_or(nowhere).to_canonical() {
            IpAddr::V6(address) => IpAddr::V6((u128::from(address) & (u128::MAX << 64)).into()),
            address @ IpAddr::V4(_) => address,
        };
        Whence {
            address,
            // What a proxy on this machine asks is asked by others.
            is_near: is_here && !self.behind_proxy,
        }
    }

    /// Takes one of the tries to sign in. Many addresses that try together leave the
    /// owner two ways: from where they came in before, and from the machine itself.
    pub(super) fn spend_try(&self, from: Whence) -> Result<(), WebError> {
        let now = Instant::now();
        let own = self.tries.take(&from.address, 1, now);
        own.map_err(|wait| {
            tracing::warn!(from = %from.address, "too many sign-ins");
            WebError::TooMany(wait)
        })?;
        if from.is_near || self.known().contains(&from.address) {
            return Ok(());
        }
        self.all_tries.take(&(), 1, now).map_err(|wait| {
            tracing::warn!("too many sign-ins from many addresses");
            WebError::Besieged(wait)
        })
    }

    /// The owner came in from there, and has the try back: a script may come in as
    /// often as it likes, and guesses beside it are not given back.
    pub(super) fn welcome(&self, from: Whence) {
        self.tries.give_back(&from.address, 1);
        let mut known = self.known();
        if known.len() >= MOST_KNOWN {
            known.clear();
        }
        known.insert(from.address);
    }

    /// Takes what costly work costs. Whoever sits at the machine has it anyway.
    pub(super) fn spend(&self, from: Whence, cost: u32) -> Result<(), WebError> {
        if cost == 0 || from.is_near {
            return Ok(());
        }
        let taken = self.work.take(&from.address, cost, Instant::now());
        taken.map_err(|wait| {
            tracing::warn!(from = %from.address, "too much costly work");
            WebError::TooMany(wait)
        })
    }

    fn known(&self) -> MutexGuard<'_, HashSet<IpAddr>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from(budgets: &Budgets, peer: &str, told: &str) -> Whence {
        let mut headers = HeaderMap::new();
        if !told.is_empty() {
            headers.insert("x-forwarded-for", told.parse().unwrap());
        }
        budgets.of(Some(peer.parse().unwrap()), &headers)
    }

    #[test]
    fn an_address_counts_as_what_nobody_can_claim() {
        let (plain, proxied) = (Budgets::new(false), Budgets::new(true));
        for (budgets, peer, told, address, is_near) in [
            (&plain, "127.0.0.1", "", "127.0.0.1", true),
            (&plain, "::1", "", "::", true),
            (&plain, "::ffff:127.0.0.1", "", "127.0.0.1", true),
            (&plain, "192.0.2.7", "127.0.0.1", "192.0.2.7", false),
            (&plain, "2001:db8::1:2:3:4", "", "2001:db8::", false),
            (&proxied, "127.0.0.1", "", "127.0.0.1", false),
            (
                &proxied,
                "127.0.0.1",
                "192.0.2.9, 192.0.2.8",
                "192.0.2.8",
                false,
            ),
            (&proxied, "127.0.0.1", "127.0.0.1", "127.0.0.1", false),
        ] {
            let whence = from(budgets, peer, told);
            let expected: IpAddr = address.parse().unwrap();
            assert_eq!(whence.address, expected, "{peer} {told}");
            assert_eq!(whence.is_near, is_near, "{peer} {told}");
        }
    }

    #[test]
    fn many_who_try_together_do_not_keep_the_owner_out() {
        let budgets = Budgets::new(false);
        let home = from(&budgets, "192.0.2.1", "");
        budgets.spend_try(home).unwrap();
        budgets.welcome(home);
        let tried = (0..=255).map(|last| from(&budgets, &format!("198.51.100.{last}"), ""));
        let refused = tried.filter(|whence| budgets.spend_try(*whence).is_err());
        let refused = refused.count();
        assert!((150..=157).contains(&refused), "{refused}");
        let elsewhere = from(&budgets, "203.0.113.1", "");
        let error = budgets.spend_try(elsewhere).unwrap_err();
        assert!(matches!(error, WebError::Besieged(wait) if wait <= Duration::from_secs(1)));
        budgets.spend_try(home).unwrap();
        budgets.spend_try(from(&budgets, "127.0.0.1", "")).unwrap();
    }

    #[test]
    fn costly_work_has_its_bound_for_others_and_none_at_the_machine() {
        let budgets = Budgets::new(false);
        let (near, far) = (from(&budgets, "::1", ""), from(&budgets, "192.0.2.1", ""));
        for _ in 0..60 {
            budgets.spend(far, 10).unwrap();
        }
        assert!(matches!(budgets.spend(far, 10), Err(WebError::TooMany(_))));
        budgets.spend(far, 0).unwrap();
        for _ in 0..1000 {
            budgets.spend(near, 10).unwrap();
        }
        budgets.spend(from(&budgets, "192.0.2.2", ""), 10).unwrap();
    }
}
