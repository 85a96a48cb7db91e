//! Scripted teaching runs, and the tables made of them.
