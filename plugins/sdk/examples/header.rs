//! Prints the C header: `cargo run -p luxel-sdk --example header > plugins/sdk/include/luxel.h`.

use std::io::Write;

fn main() -> std::io::Result<()> {
    std::io::stdout().write_all(luxel_sdk::abi::header().as_bytes())
}
