//! libFuzzer's door to [`memrep_fuzz`]'s target `task_json`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| memrep_fuzz::run("task_json", data));
