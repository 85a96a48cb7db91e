//! A recording as a card shows it.
