//! The program: three lines into the command line.
fn main() {}
