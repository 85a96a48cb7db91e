//! Pools of recordings.
