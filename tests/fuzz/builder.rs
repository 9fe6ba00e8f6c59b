//! Bytes of a fuzzer's choice as a mesh and rays at it.
#![no_main]

#[path = "../builder.rs"]
mod builder;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    builder::judge(bytes);
});
