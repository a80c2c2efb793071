//! The program: runs scenes, explains them, lists them.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
