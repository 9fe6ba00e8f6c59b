//! Opening the page. A program's arguments can be read by every user of the machine, and the page's
//! address is a secret: the browser is given a file that leads there and that only its owner reads.

use std::io::Write;
use std::process::{Command, Stdio};

use tempfile::NamedTempFile;

use crate::isolate;

/// Asks the desktop to show the address. What it gives has to live until the browser has read it;
/// nothing, where there is no desktop.
pub(super) fn open(url: &str) -> Option<NamedTempFile> {
    let (opener, before): (_, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("explorer", &[])
    } else {
        let desktop = ["DISPLAY", "WAYLAND_DISPLAY"].map(std::env::var_os);
        desktop.iter().flatten().next()?;
        ("xdg-open", &[])
    };
    let mut file = tempfile::Builder::new().prefix("luxel-").suffix(".html").tempfile().ok()?;
    file.write_all(leading(url).as_bytes()).ok()?;
    let mut command = Command::new(opener);
    isolate::as_outside(&mut command);
    command.args(before).arg(file.path());
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()?;
    Some(file)
}

fn leading(url: &str) -> String {
    format!(
        "<!doctype html><meta http-equiv=\"refresh\" content=\"0;url={url}\"><title>Luxel</title>"
    )
}
