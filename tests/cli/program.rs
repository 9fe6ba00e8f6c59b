//! Runs the built program in a folder of its own.
#![expect(clippy::disallowed_methods, reason = "tests prepare and read files")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// A grey ball in a white furnace.
pub(crate) const SCENE: &str = r"scene 1
camera perspective {
  look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0))
  fov = 40 deg
}
film rgb { resolution = (32, 32) }
sampler sobol { samples = 4 }
light constant { scale = 1 }
shape sphere { radius = 1 m, material = material diffuse { reflectance = 0.5 } }
";

/// A path from the folder in which cargo builds this workspace.
pub(crate) fn below_target(name: &str) -> PathBuf {
    profile().parent().unwrap().join(name)
}

/// Where the tests were built.
fn profile() -> PathBuf {
    let tests = std::env::current_exe().unwrap();
    tests.parent().and_then(Path::parent).unwrap().to_path_buf()
}

/// The program, built once with the profile of the tests.
fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let profile = profile();
        let mut build = Command::new(option_env!("CARGO").unwrap_or("cargo"));
        build.args(["build", "--quiet", "--workspace", "--bin", "luxel", "--target-dir"]);
        build.arg(profile.parent().unwrap());
        build.args((!profile.ends_with("debug")).then_some("--release"));
        build.current_dir(env!("CARGO_MANIFEST_DIR"));
        assert!(build.status().unwrap().success(), "the program builds");
        profile.join(format!("luxel{}", std::env::consts::EXE_SUFFIX))
    })
}

/// Where the program's settings are, in a test's folder.
pub(crate) const CONFIG: &str = "config";

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Done {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// A folder of one test's own, removed in the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let n = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("luxel-cli-{name}-{}-{n}", std::process::id());
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn with(self, name: &str, text: &str) -> Self {
        self.write(name, text);
        self
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> &Self {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
        self
    }

    pub(crate) fn write_bytes(&self, name: &str, bytes: &[u8]) -> &Self {
        fs::write(self.0.join(name), bytes).unwrap();
        self
    }

    /// The bytes of a file; none if it is not there.
    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).unwrap_or_default()
    }

    /// What is in the folder, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Where a file of the folder is.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Runs the program to its end.
    pub(crate) fn luxel(&self, args: &[&str]) -> Done {
        self.luxel_in(&[], args)
    }

    /// Runs the program to its end, with these variables in its environment.
    pub(crate) fn luxel_in(&self, variables: &[(&str, &str)], args: &[&str]) -> Done {
        let mut command = self.among(Command::new(program()));
        command.args(args).envs(variables.iter().copied());
        told(&command.output().unwrap())
    }

    /// The same in a folder below this one.
    #[cfg(unix)]
    pub(crate) fn luxel_below(
        &self,
        below: &str,
        variables: &[(&str, &str)],
        args: &[&str],
    ) -> Done {
        let mut command = self.among(Command::new(program()));
        command.args(args).envs(variables.iter().copied()).current_dir(self.0.join(below));
        told(&command.output().unwrap())
    }

    /// A command in this folder, far from the settings of whoever runs the tests.
    fn among(&self, mut command: Command) -> Command {
        command.current_dir(&self.0).env_remove("LUXEL_PLUGIN_PATH");
        command.env("XDG_CONFIG_HOME", self.0.join(CONFIG));
        command
    }

    /// Runs the program to its end after a line of shell.
    #[cfg(unix)]
    pub(crate) fn luxel_under(&self, shell: &str, args: &[&str]) -> Done {
        let mut command = self.among(Command::new("sh"));
        command.args(["-c", &format!("{shell}; exec \"$0\" \"$@\"")]).arg(program()).args(args);
        told(&command.output().unwrap())
    }

    /// Starts the program and gives what it reads and writes.
    pub(crate) fn talk(&self, args: &[&str]) -> Child {
        let mut command = self.among(Command::new(program()));
        command.args(args).stdin(Stdio::piped()).stdout(Stdio::piped());
        command.spawn().unwrap()
    }

    /// Starts the program.
    pub(crate) fn start(&self, args: &[&str]) -> Running {
        let mut command = self.among(Command::new(program()));
        command.args(args).stdout(Stdio::piped()).stderr(Stdio::piped());
        Running(Some(command.spawn().unwrap()))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The program while it runs; killed when dropped.
pub(crate) struct Running(Option<Child>);

impl Running {
    /// As Ctrl-C does.
    #[cfg(unix)]
    pub(crate) fn interrupt(&mut self) {
        let id = self.0.as_ref().unwrap().id().to_string();
        assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    }

    /// How many files it has open, and how many threads.
    #[cfg(target_os = "linux")]
    pub(crate) fn held(&self) -> [usize; 2] {
        let process = format!("/proc/{}", self.0.as_ref().unwrap().id());
        ["fd", "task"].map(|of| fs::read_dir(format!("{process}/{of}")).unwrap().count())
    }

    /// Waits until Ctrl-C is answered by the program itself.
    #[cfg(target_os = "linux")]
    pub(crate) fn listens(&self) {
        let status = format!("/proc/{}/status", self.0.as_ref().unwrap().id());
        let caught = || {
            let status = fs::read_to_string(&status).unwrap();
            let mask = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
            u64::from_str_radix(mask.trim(), 16).unwrap() >> 1 & 1 == 1
        };
        while !caught() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
    }

    /// Whether it has come to its end by itself.
    pub(crate) fn is_over(&mut self) -> bool {
        self.0.as_mut().unwrap().try_wait().unwrap().is_some()
    }

    /// The port and token of the page that it serves.
    pub(crate) fn page(&mut self) -> (u16, String) {
        let told = self.says(|line| line.split_once("127.0.0.1:").map(|it| it.1.to_owned()));
        let (port, token) = told.split_once("/?token=").unwrap();
        (port.parse().unwrap(), token.to_owned())
    }

    /// Waits for a line on standard error of which `find` makes something; the others are lost.
    pub(crate) fn says<T>(&mut self, find: impl Fn(&str) -> Option<T>) -> T {
        let mut lines = BufReader::new(self.0.as_mut().unwrap().stderr.take().unwrap()).lines();
        let found = lines.find_map(|line| find(&line.unwrap())).expect("it is said");
        std::thread::spawn(move || lines.count());
        found
    }

    /// Reads its standard output no more.
    #[cfg(unix)]
    pub(crate) fn turn_away(&mut self) {
        drop(self.0.as_mut().unwrap().stdout.take());
    }

    pub(crate) fn end(mut self) -> Done {
        told(&self.0.take().unwrap().wait_with_output().unwrap())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

fn told(output: &Output) -> Done {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Done {
        code: output.status.code().unwrap_or(-1),
        out: text(&output.stdout),
        err: text(&output.stderr),
    }
}
