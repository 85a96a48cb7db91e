//! Scripted teachers and the targets they teach. Must not know learners.
