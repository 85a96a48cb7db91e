//! libFuzzer's door to [`memrep_fuzz`]'s target `sample`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| memrep_fuzz::run("sample", data));
