//! Running programs, with what they took.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// The program under test.
pub(crate) struct Luxel {
    pub(crate) program: PathBuf,
}

/// What a process took.
pub(crate) struct Took {
    /// Wall time from start to end, seconds.
    pub(crate) seconds: f64,
    /// Processor time in user mode, seconds; `NaN` without `/usr/bin/time`.
    pub(crate) cpu: f64,
    /// Most memory it held at once, MiB; `None` without `/usr/bin/time`.
    pub(crate) megabytes: Option<f64>,
}

/// GNU time: the only portable way to a child's peak memory without unsafe code.
const TIME: &str = "/usr/bin/time";

impl Luxel {
    /// Renders a scene with more arguments, and throws the picture away.
    ///
    /// # Errors
    /// The program did not start or failed; its words.
    pub(crate) fn render(&self, scene: &Path, size: u32, spp: u32) -> Result<Took, String> {
        self.render_with(scene, size, spp, &[])
    }

    /// The same, with more words on the command line.
    ///
    /// # Errors
    /// As `render`.
    pub(crate) fn render_with(
        &self,
        scene: &Path,
        size: u32,
        spp: u32,
        more: &[&str],
    ) -> Result<Took, String> {
        let out = scratch()?.join("picture");
        let mut words = vec![self.program.clone(), "render".into(), scene.into()];
        words.extend(["--quiet", "-o"].map(PathBuf::from));
        words.push(out);
        let numbers = [format!("--size={size}x{size}"), format!("--spp={spp}")];
        words.extend(numbers.map(PathBuf::from));
        words.extend(more.iter().map(PathBuf::from));
        timed(&words)
    }

    /// Checks a scene that may be wrong; gives what was told of it, too.
    ///
    /// # Errors
    /// The program did not start.
    pub(crate) fn check(&self, scene: &Path) -> Result<(Took, String), String> {
        let (took, _, told) = ran(&[self.program.clone(), "check".into(), scene.into()])?;
        Ok((took, told))
    }
}

/// Runs a program that succeeds; `words` begins with it.
///
/// # Errors
/// The program did not start or failed; its words.
fn timed(words: &[PathBuf]) -> Result<Took, String> {
    told(words)
        .map(|(took, _)| took)
        .map_err(|told| format!("{} failed: {told}", words[0].display()))
}

/// Runs a program: what it took, whether it succeeded, and what it told.
fn ran(words: &[PathBuf]) -> Result<(Took, bool, String), String> {
    let with_time = Path::new(TIME).exists();
    let mut command = Command::new(if with_time { Path::new(TIME) } else { &words[0] });
    if with_time {
        command.args(["-f", "%M %U"]).arg(&words[0]);
    }
    command.args(&words[1..]).stdout(Stdio::null()).stderr(Stdio::piped());
    let start = Instant::now();
    let output = command.output().map_err(|e| format!("{}: {e}", words[0].display()))?;
    let seconds = start.elapsed().as_secs_f64();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let last = told.lines().last().filter(|_| with_time).unwrap_or_default();
    let mut numbers = last.split_whitespace().map_while(|word| word.parse::<f64>().ok());
    let (kilobytes, cpu) = (numbers.next(), numbers.next().unwrap_or(f64::NAN));
    let took = Took { seconds, cpu, megabytes: kilobytes.map(|k| k / 1024.0) };
    Ok((took, output.status.success(), told))
}

/// Starts this program anew to measure one thing, in memory that nothing else has used; what it took and
/// what it told.
///
/// # Errors
/// It did not start or failed; its words.
pub(crate) fn again(once: &str, case: &str, what: &str) -> Result<(Took, String), String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    told(&[program, once.into(), case.into(), what.into()])
}

/// The case and what is wanted of it, if this program was started so.
pub(crate) fn asked(once: &str) -> Option<(String, String)> {
    let words: [String; 3] = std::env::args().skip(1).collect::<Vec<_>>().try_into().ok()?;
    let [first, case, what] = words;
    (first == once).then_some((case, what))
}

/// Runs a program that succeeds; what it took and what it told.
///
/// # Errors
/// The program did not start or failed; its words.
fn told(words: &[PathBuf]) -> Result<(Took, String), String> {
    let (took, succeeded, told) = ran(words)?;
    if succeeded { Ok((took, told)) } else { Err(told) }
}

/// Whether this Python can import Mitsuba.
pub(crate) fn has_mitsuba(python: &Path) -> bool {
    let mut command = Command::new(python);
    command.args(["-c", "import mitsuba, numpy"]).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// A library in the folder of the program; where none is there, `cargo` makes it with these words, and
/// with the program's profile.
///
/// # Errors
/// It is not built, or elsewhere.
pub(crate) fn library(luxel: &Luxel, name: &str, words: &[&str]) -> Result<PathBuf, String> {
    let name = format!("{}{name}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = luxel.program.with_file_name(name);
    if !library.exists() {
        let mut cargo = Command::new("cargo");
        let is_release = luxel.program.parent().is_some_and(|folder| folder.ends_with("release"));
        cargo.args(words).args(is_release.then_some("--release"));
        let built = cargo.current_dir(here()).status();
        built.map_err(|error| format!("cargo: {error}"))?;
    }
    let told = || format!("no {}: `cargo {}` makes it", library.display(), words.join(" "));
    library.exists().then_some(()).ok_or_else(told)?;
    Ok(library)
}

/// A folder for what the benches make.
///
/// # Errors
/// The system's words.
pub(crate) fn scratch() -> Result<PathBuf, String> {
    let folder = std::env::temp_dir().join("luxel-bench");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    Ok(folder)
}

/// Writes a file among what the benches make.
///
/// # Errors
/// The system's words.
#[expect(clippy::disallowed_methods, reason = "a scratch file that nobody watches")]
pub(crate) fn write(name: &str, bytes: &[u8]) -> Result<PathBuf, String> {
    let path = scratch()?.join(name);
    std::fs::write(&path, bytes).map_err(|e| format!("{}: {e}", path.display()))?;
    Ok(path)
}

/// The whole of a file that the benches or a build made.
///
/// # Errors
/// The system's words.
#[expect(clippy::disallowed_methods, reason = "files of our own")]
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|e| format!("{}: {e}", path.display()))
}

/// The folder of the benches' scenes and scripts.
pub(crate) fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
