//! Who is at which question: a person has one for a while, in which it is nobody
//! else's. Kept in memory alone: after a restart everybody is simply asked again.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crate::session::Session;
use crate::store::SessionId;

/// How long a person has a question, where nothing else is said.
pub(crate) const LENGTH: Duration = Duration::from_secs(120);

struct Lease {
    person: u32,
    number: u32,
    until: Instant,
}

/// What a person is to do next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turn {
    /// Answer this question.
    Answer(u32),
    /// Answer this one once more.
    Repeat(u32),
}

/// The leases of all sessions.
pub(crate) struct Leases {
    held: Mutex<HashMap<SessionId, Vec<Lease>>>,
    length: Duration,
}

impl Leases {
    /// Leases of this length.
    pub(crate) fn new(length: Duration) -> Self {
        Self {
            held: Mutex::default(),
            length,
        }
    }

    /// What this person is to do, as the session stands; none where nothing that is
    /// open is theirs to answer. A question comes with a lease, which looking at it
    /// again does not prolong: after it others may have the question too, until
    /// somebody answers it.
    pub(crate) fn turn(&self, id: SessionId, session: &Session, person: u32) -> Option<Turn> {
        if let Some(number) = session.panel().due(person) {
            return Some(Turn::Repeat(number));
        }
        let now = Instant::now();
        let mut held = self.held();
        let mut leases = held.remove(&id).unwrap_or_default();
        leases.retain(|lease| session.is_open(lease.number));
        let turn = self.choose(&mut leases, session, person, now);
        if !leases.is_empty() {
            held.insert(id, leases);
        }
        turn
    }

    fn choose(
        &self,
        leases: &mut Vec<Lease>,
        session: &Session,
        person: u32,
        now: Instant,
    ) -> Option<Turn> {
        let open: Vec<u32> = session.open_to(person).collect();
        let own = leases.iter().find(|lease| lease.person == person);
        if let Some(own) = own.filter(|own| open.contains(&own.number)) {
            return Some(Turn::Answer(own.number));
        }
        let at_it = |number: u32| {
            let current = leases.iter().filter(|lease| lease.until > now);
            current.filter(|lease| lease.number == number).count()
        };
        let free = open
            .into_iter()
            .find(|number| at_it(*number) < session.wanted(*number))?;
        leases.push(Lease {
            person,
            number: free,
            until: now + self.length,
        });
        Some(Turn::Answer(free))
    }

    /// The people who are at a question now, each with it.
    pub(crate) fn at_work(&self, id: SessionId) -> Vec<(u32, u32)> {
        let now = Instant::now();
        let held = self.held();
        let leases = held.get(&id).map_or(&[][..], Vec::as_slice);
        let current = leases.iter().filter(|lease| lease.until > now);
        current.map(|lease| (lease.person, lease.number)).collect()
    }

    /// This person is at no question any more.
    pub(crate) fn release(&self, id: SessionId, person: u32) {
        let mut held = self.held();
        if let Some(leases) = held.get_mut(&id) {
            leases.retain(|lease| lease.person != person);
            if leases.is_empty() {
                held.remove(&id);
            }
        }
    }

    fn held(&self) -> MutexGuard<'_, HashMap<SessionId, Vec<Lease>>> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
