//! Plugin libraries in C that go wrong on purpose.
#![cfg(unix)]

use std::env::consts::DLL_SUFFIX;
use std::path::Path;
use std::process::Command;

use super::program::{Folder, SCENE};

/// A material that reflects nothing and does something else whenever it is asked.
const SOURCE: &str = r#"#include "luxel.h"
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
typedef struct { luxel_spectrum reflectance; } faulty;
static atomic_int asked;
static volatile int *volatile nowhere;
static volatile int never = 1;
static void *volatile kept;
static luxel_status prepare(void *at) {
    (void)at; (void)kept;
    MADE;
    return LUXEL_OK;
}
static luxel_status needs(const void *at, uint32_t *out) { (void)at; *out = 1; return LUXEL_OK; }
static luxel_status act(void) {
    int n = atomic_fetch_add(&asked, 1);
    (void)n; (void)nowhere; (void)never;
    FAULT;
    return LUXEL_OK;
}
static luxel_status eval(const void *at, const luxel_vec3 *wo, const luxel_vec3 *wi, luxel_eval *out) {
    const faulty *f = at;
    (void)wo; (void)wi;
    *out = (luxel_eval){{{0}}, 0.0f};
    out->f = f->reflectance;
    for (int i = 0; i < 4; i++) out->f.lanes[i] *= 0.0f;
    return act();
}
static luxel_status sample(const void *at, const luxel_vec3 *wo, const float (*u)[3], luxel_sample *out) {
    (void)at; (void)wo; (void)u; (void)out;
    luxel_status status = act();
    return status == LUXEL_OK ? LUXEL_NOTHING : status;
}
static const luxel_material_table TABLE = {
    .size = sizeof(luxel_material_table), .needs = needs, .eval = eval, .sample = sample,
};
static const luxel_param PARAMS[] = {
    {.name = LUXEL_TEXT("reflectance"), .doc = LUXEL_TEXT("Not looked at."),
     .ty = LUXEL_TYPE_SPECTRUM, .role = 1, .preset = 1, .numbers = {0.5}, .min = 0.0, .max = 1.0,
     .offset = offsetof(faulty, reflectance)},
};
static const luxel_class CLASSES[] = {
    {.kind = LUXEL_MATERIAL, .size = sizeof(faulty), .name = LUXEL_TEXT("faulty"),
     .doc = LUXEL_TEXT("Goes wrong."), .params = {PARAMS, 1}, .prepare = prepare,
     .behaviour = &TABLE},
};
static void said(luxel_byte_sink *sink) {
    (void)sink;
}
LUXEL_EXPORT const luxel_library luxel_plugin_v1_faulty = {
    .magic = LUXEL_MAGIC, .abi_major = LUXEL_ABI_MAJOR, .abi_minor = LUXEL_ABI_MINOR,
    .layout_hash = LUXEL_LAYOUT_HASH, .size = sizeof(luxel_library), .name = LUXEL_TEXT("faulty"),
    .version = LUXEL_TEXT("0.1.0"), .compiler = LUXEL_TEXT("C"), .panic = 1,
    .classes = {CLASSES, 1}, .last_panic = said,
};
OPENED
"#;

/// What a faulty library does when it is asked.
pub(crate) const NOTHING: &str = "";
pub(crate) const PANIC_AT_THE_THIRD: &str = "if (n == 2) return LUXEL_PANICKED";
pub(crate) const WRITE_TO_NOWHERE: &str = "*nowhere = 1";
pub(crate) const ABORT: &str = "abort()";
pub(crate) const LEAVE: &str = "if (n == 40) exit(0)";
pub(crate) const NEVER_END: &str = "while (never) {}";

/// And what it does when an object is made.
pub(crate) const LEAK: &str = "kept = malloc(24)";
/// Writes `begun` and looks at nothing but whether there is `go`.
pub(crate) const WAIT: &str = "fclose(fopen(\"begun\", \"w\"));
    for (FILE *go = 0; !(go = fopen(\"go\", \"r\"));) {}";

/// The same ball, of what the library offers.
pub(crate) fn scene() -> String {
    SCENE.replace("diffuse { reflectance = 0.5 }", "faulty {}")
}

/// Builds `plugins/libfaulty`, which does that, and puts it in its place at once.
pub(crate) fn build(folder: &Folder, fault: &str) -> String {
    build_with(folder, fault, "", "")
}

/// The same, with something that happens when an object is made, and when the library is opened.
pub(crate) fn build_with(folder: &Folder, fault: &str, made: &str, opened: &str) -> String {
    let source = SOURCE.replace("FAULT", fault).replace("MADE", made).replace("OPENED", opened);
    folder.write("plugins/faulty.c", &source);
    let include = Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/sdk/include");
    let mut command = Command::new("cc");
    command.args(["-std=c11", "-shared", "-fPIC", "-O1", "-o", "new", "faulty.c", "-I"]);
    let built = command.arg(include).current_dir(folder.path("plugins")).status();
    assert!(built.unwrap().success(), "the library builds");
    let name = format!("plugins/libfaulty{DLL_SUFFIX}");
    std::fs::rename(folder.path("plugins/new"), folder.path(&name)).unwrap();
    name
}

/// Lets the program use the library.
pub(crate) const OPEN: [&str; 3] = ["--plugin-dir", "plugins", "--allow-unlocked-plugins"];
