//! Scenes that are meant to hurt: what each costs before it is refused.

use crate::attack_texts;
use crate::process::{self, Luxel};

/// Prints seconds, peak memory and the first code of each.
///
/// # Errors
/// A file that cannot be written, a program that does not start.
pub(crate) fn run(luxel: &Luxel) -> Result<(), String> {
    println!("attacks on `luxel check` (goals: 1 s, 256 MiB)");
    for attack in attack_texts::all() {
        for (name, text) in &attack.files {
            process::write(name, text.as_bytes())?;
        }
        let scene = process::write("attack.scene", attack.scene.as_bytes())?;
        let (took, told) = luxel.check(&scene)?;
        // Hundreds of megabytes are not left lying about.
        for (name, _) in &attack.files {
            process::write(name, b"")?;
        }
        let code = told.split("[E").nth(1).and_then(|rest| rest.get(..4)).unwrap_or("none");
        let megabytes = took.megabytes.unwrap_or(f64::NAN);
        println!("  {:20}{:7.2} s {megabytes:6.0} MiB  E{code}", attack.name, took.seconds);
    }
    Ok(())
}
