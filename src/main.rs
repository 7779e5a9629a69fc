//! The binary: see `plica::cli`.

fn main() {
    plica::cli::main()
}
