//! The footfall command line.

fn main() {}
