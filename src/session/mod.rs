//! One teaching session: a fold over its log. Must not know how the log is stored.
