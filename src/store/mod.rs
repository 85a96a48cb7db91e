//! Where the logs of sessions last. Must not know the learner.
