//! The studies as the program makes them.

mod precision;
