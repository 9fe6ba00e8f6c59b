//! What a plugin's author is told by the compiler: each file of `refused` with the phrases that are
//! ours, one after each `//~`, or with the compiler's code where no word is ours.
//!
//! The compiler's own words change from version to version, so nothing else is compared. A file
//! without phrases must compile.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, io};

use serde_json::Value;

const MARK: &str = "//~";

/// One file of `refused`.
struct Case {
    name: String,
    /// Without the phrases: the compiler repeats lines of the source, which must not count.
    source: String,
    phrases: Vec<String>,
}

impl Case {
    fn new(path: &Path) -> Self {
        let text = read(path);
        let phrase = |line: &str| Some(line.trim_start().strip_prefix(MARK)?.trim().to_owned());
        let source: Vec<_> = text.lines().filter(|line| phrase(line).is_none()).collect();
        let case = Self {
            name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            source: source.join("\n"),
            phrases: text.lines().filter_map(phrase).collect(),
        };
        for phrase in &case.phrases {
            let told_anyway = phrase.is_empty() || case.source.contains(phrase);
            assert!(!told_anyway && !case.source.contains(MARK), "{}: {phrase:?}", case.name);
        }
        case
    }

    /// What is wrong with what the compiler told, if anything.
    fn fault(&self, told: &Told) -> Option<String> {
        if self.phrases.is_empty() {
            let sound = told.compiled && told.errors.is_empty();
            return (!sound).then(|| format!("{}: does not compile", self.name));
        }
        // The same mistake at two places is two messages.
        let count = |phrase: &str, texts: &[String]| {
            texts.iter().filter(|text| text.contains(phrase)).count()
        };
        let is_missing =
            |phrase: &&String| count(phrase, &told.errors) < count(phrase, &self.phrases);
        let missing: Vec<_> = self.phrases.iter().filter(is_missing).collect();
        let refused = !told.compiled && !told.errors.is_empty();
        (!refused || !missing.is_empty()).then(|| format!("{}: without {missing:#?}", self.name))
    }
}

/// What the compiler told of one case.
#[derive(Default)]
struct Told {
    compiled: bool,
    errors: Vec<String>,
}

#[expect(clippy::disallowed_methods, reason = "the test's own files")]
fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[expect(clippy::disallowed_methods, reason = "a package that is thrown away")]
fn write(path: &Path, text: &str) -> io::Result<()> {
    fs::write(path, text)
}

fn cases() -> io::Result<Vec<Case>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/refused");
    let entries = fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let mut paths: Vec<PathBuf> = entries.collect::<io::Result<_>>()?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "rs"));
    paths.sort();
    Ok(paths.iter().map(|path| Case::new(path)).collect())
}

/// A package with each case as a program and the libraries that this workspace has locked.
fn package(folder: &Path, cases: &[Case]) -> io::Result<()> {
    let sdk = Path::new(env!("CARGO_MANIFEST_DIR"));
    let glam = read(&sdk.join("Cargo.toml"));
    let glam = glam.lines().find(|line| line.starts_with("glam ")).expect("the sdk uses glam");
    let path = sdk.to_str().expect("manifests are UTF-8");
    // A workspace of its own, for it may lie within ours. Warnings are not the matter here.
    let mut manifest = format!(
        "[package]\nname = \"refused\"\nversion = \"0.0.0\"\nedition = \"2024\"\nautobins = false\n\
         [workspace]\n[lints.rust]\nwarnings = \"allow\"\n\
         [dependencies]\nluxel-sdk = {{ path = {path:?} }}\n{glam}\n"
    );
    fs::create_dir_all(folder)?;
    for Case { name, source, .. } in cases {
        writeln!(manifest, "[[bin]]\nname = {name:?}\npath = \"{name}.rs\"").expect("text grows");
        write(&folder.join(format!("{name}.rs")), source)?;
    }
    write(&folder.join("Cargo.lock"), &read(&sdk.join("../../Cargo.lock")))?;
    write(&folder.join("Cargo.toml"), &manifest)
}

/// What the compiler tells of each case by name.
fn compile(folder: &Path) -> BTreeMap<String, Told> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["check", "--offline", "--bins", "--keep-going", "--message-format=json"]);
    cargo.current_dir(folder).arg("--target-dir").arg(folder.join("target"));
    // Lints that were made errors for the workspace would be told of the cases, too.
    let output = cargo.env_remove("RUSTFLAGS").env_remove("CARGO_ENCODED_RUSTFLAGS").output();
    let output = output.expect("cargo runs this test");

    let mut told: BTreeMap<String, Told> = BTreeMap::new();
    for line in String::from_utf8(output.stdout).expect("JSON is UTF-8").lines() {
        let line: Value = serde_json::from_str(line).expect("asked for JSON");
        let of_case = line["target"]["kind"][0] == "bin";
        let Some(name) = line["target"]["name"].as_str().filter(|_| of_case) else { continue };
        let of = told.entry(name.to_owned()).or_default();
        of.compiled |= line["reason"] == "compiler-artifact";
        if line["message"]["level"] == "error" {
            of.errors.push(line["message"]["rendered"].as_str().unwrap_or_default().to_owned());
        }
    }
    assert!(!told.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    told
}

#[test]
fn what_a_parameter_cannot_be_is_told_by_the_compiler() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("refused");
    let cases = cases().unwrap();
    package(&folder, &cases).unwrap();
    let mut told = compile(&folder);

    let mut faults = vec![];
    for case in &cases {
        let told = told.remove(&case.name).unwrap_or_default();
        faults
            .extend(case.fault(&told).map(|fault| format!("{fault}\n{}", told.errors.join("\n"))));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n\n"));
    let n_sound = cases.iter().filter(|case| case.phrases.is_empty()).count();
    assert!(n_sound > 0 && n_sound < cases.len(), "either kind of case is needed");
}
