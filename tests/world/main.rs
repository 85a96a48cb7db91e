//! Worlds through their public door, beside brute-force twins, and learning in
//! them.

mod draw;
mod grid;
mod large;
mod learn;
mod pool;
mod prior;
mod robot;
mod situated;
