//! The program from the outside: exit codes, what it prints, what it writes.

mod bad_corpus;
mod bad_input;
mod common;
mod corrections;
mod designs;
mod desk;
mod dynamics;
mod evaluate;
mod game_clips;
mod imu;
mod knees;
mod looked_at;
mod monitor;
mod pipeline;
mod recordings;
mod sensors;
mod study;
mod style;
