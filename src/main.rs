//! The binary: see `plica::cli`.

use std::process::ExitCode;

fn main() -> ExitCode {
    plica::cli::main()
}
