//! `carom study`.

mod scaling;
