//! `footfall doctor`: whether this machine has what Footfall needs, and what to do where it has not.

use crate::output;
use anyhow::{Result, bail};
use footfall_imu::live::serial::port;
use serde::Serialize;
use std::env;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Oldest engine that the add-on runs in.
const LEAST_GODOT: [u32; 2] = [4, 6];

/// Port that phones and trackers send to by default.
const UDP_PORT: u16 = 6969;

/// Check this machine for everything that Footfall needs
///
/// Checks Godot, graphics, display, serial ports and their permissions, network ports, and writable folders. Prints what to do about each
/// missing item. Exits with 1 only if the add-on cannot work without it.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  footfall doctor\n  footfall doctor --json")]
pub(crate) struct DoctorArgs {
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum State {
    Good,
    /// Something is not there that only some need.
    Missing,
    /// The add-on cannot do without.
    Bad,
}

#[derive(Debug, Serialize)]
struct Finding {
    what: &'static str,
    state: State,
    found: String,
    /// Next thing to do; empty when there is nothing to do.
    next: String,
}

#[derive(Serialize)]
struct Report {
    version: &'static str,
    findings: Vec<Finding>,
}

pub(crate) fn run(args: &DoctorArgs) -> Result<()> {
    let findings = vec![
        godot(),
        graphics(),
        screen(),
        serial(),
        udp(),
        data_folder(),
    ];
    let bad: Vec<&str> = findings
        .iter()
        .filter(|finding| finding.state == State::Bad)
        .map(|finding| finding.what)
        .collect();
    let summary = bad.join(", ");
    if args.json {
        output::print_json(&Report {
            version: env!("CARGO_PKG_VERSION"),
            findings,
        })?;
    } else {
        let lines: Vec<String> = findings.iter().map(line).collect();
        output::print_text(&lines.join("\n"))?;
    }
    if !summary.is_empty() {
        bail!("required, but missing: {summary}; see above for what to do");
    }
    Ok(())
}

fn line(finding: &Finding) -> String {
    let mark = match finding.state {
        State::Good => output::coloured("ok     ", output::Colour::Green),
        State::Missing => output::coloured("missing", output::Colour::Yellow),
        State::Bad => output::coloured("bad    ", output::Colour::Red),
    };
    let mut line = format!("{mark}  {:14} {}", finding.what, finding.found);
    if !finding.next.is_empty() {
        line.push_str("\n         → ");
        line.push_str(&finding.next);
    }
    line
}

fn finding(what: &'static str, state: State, found: impl Into<String>, next: &str) -> Finding {
    Finding {
        what,
        state,
        found: found.into(),
        next: next.to_owned(),
    }
}

/// Looked for as `cargo xtask godot` does: the variable, the path, the cache.
fn godot() -> Finding {
    const NEXT: &str = "get Godot 4.6 from godotengine.org and put it on the PATH or set the variable GODOT to it; in the repository \
                        `cargo xtask godot` fetches one";
    let named = env::var_os("GODOT").filter(|value| !value.is_empty());
    let cached = dirs::cache_dir().map(|folder| folder.join("footfall/godot/godot"));
    let candidates = named
        .map(PathBuf::from)
        .into_iter()
        .chain(["godot".into(), "godot4".into()])
        .chain(cached);
    for program in candidates {
        let Some(version) = version_of(&program) else {
            continue;
        };
        let found = format!("{version} at {}", program.display());
        if is_new_enough(&version) {
            return finding("Godot", State::Good, found, "");
        }
        return finding("Godot", State::Bad, found, NEXT);
    }
    finding("Godot", State::Bad, "not found", NEXT)
}

fn version_of(program: &Path) -> Option<String> {
    let output = Command::new(program).arg("--version").output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let version = text.lines().last()?.trim().to_owned();
    version
        .starts_with(|first: char| first.is_ascii_digit())
        .then_some(version)
}

/// Compares what stands before the first two points: `4.6.3.stable`.
fn is_new_enough(version: &str) -> bool {
    let mut numbers = version
        .split('.')
        .map_while(|part| part.parse::<u32>().ok());
    let own = [numbers.next().unwrap_or(0), numbers.next().unwrap_or(0)];
    own >= LEAST_GODOT
}

fn graphics() -> Finding {
    if !cfg!(target_os = "linux") {
        return finding("graphics", State::Good, "drivers come with the system", "");
    }
    let folders = [
        "/usr/share/vulkan/icd.d",
        "/etc/vulkan/icd.d",
        "/usr/local/share/vulkan/icd.d",
    ];
    let drivers = folders
        .iter()
        .filter_map(|folder| std::fs::read_dir(folder).ok())
        .flat_map(Iterator::flatten)
        .count();
    let device = Path::new("/dev/dri").exists();
    match (device, drivers) {
        (true, 1..) => finding(
            "graphics",
            State::Good,
            format!("a graphics device and {drivers} Vulkan drivers"),
            "",
        ),
        (true, 0) => finding(
            "graphics",
            State::Missing,
            "a graphics device, no Vulkan driver",
            "install mesa-vulkan-drivers or your card's driver for Forward+; Compatibility works without it",
        ),
        (false, _) => finding(
            "graphics",
            State::Missing,
            "no graphics device",
            "rendering is in software and slow; run games with --rendering-driver opengl3",
        ),
    }
}

fn screen() -> Finding {
    let is_set = |name: &str| env::var_os(name).is_some_and(|value| !value.is_empty());
    if !cfg!(target_os = "linux") || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") {
        return finding("screen", State::Good, "there is one", "");
    }
    finding(
        "screen",
        State::Missing,
        "neither DISPLAY nor WAYLAND_DISPLAY is set",
        "`footfall studio` and Godot's editor need one; `xvfb-run -a` gives them a virtual one",
    )
}

fn serial() -> Finding {
    let ports = port::ports();
    let usb: Vec<&str> = ports
        .iter()
        .filter(|port| port.is_usb)
        .map(|port| port.name.as_str())
        .collect();
    if usb.is_empty() {
        return finding(
            "serial ports",
            State::Missing,
            format!("none on USB, {} others", ports.len()),
            "to use a serial sensor, plug it in; `footfall imu monitor --ports` lists the ports",
        );
    }
    let shut = usb.iter().find(|name| {
        let open = std::fs::OpenOptions::new()
            .read(true)
            .write(true)
            .open(name);
        open.is_err_and(|error| error.kind() == std::io::ErrorKind::PermissionDenied)
    });
    match shut {
        Some(name) => finding(
            "serial ports",
            State::Missing,
            format!("{name} may not be opened by you"),
            "run `sudo usermod -aG dialout $USER`, then log out and in",
        ),
        None => finding("serial ports", State::Good, usb.join(", "), ""),
    }
}

fn udp() -> Finding {
    match UdpSocket::bind(("0.0.0.0", UDP_PORT)) {
        Ok(_) => finding(
            "UDP port 6969",
            State::Good,
            "free for phones and trackers",
            "",
        ),
        Err(error) => finding(
            "UDP port 6969",
            State::Missing,
            error.to_string(),
            "end the program that uses it (a SlimeVR server?), or set another port in the source and in the app",
        ),
    }
}

fn data_folder() -> Finding {
    const NEXT: &str =
        "create it with write permission; it holds phones' certificates and unsaved labels";
    let Some(base) = dirs::data_local_dir() else {
        return finding(
            "data folder",
            State::Missing,
            "this user has no data folder",
            NEXT,
        );
    };
    let folder = base.join("footfall");
    let probe = folder.join(format!(".doctor.{}", std::process::id()));
    let written = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&probe, b""));
    match written.and_then(|()| std::fs::remove_file(&probe)) {
        Ok(()) => finding("data folder", State::Good, folder.display().to_string(), ""),
        Err(error) => finding(
            "data folder",
            State::Missing,
            format!("{}: {error}", folder.display()),
            NEXT,
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_number() {
        for (version, is_new) in [
            ("4.6.3.stable", true),
            ("4.10.stable.official", true),
            ("5.0.dev1", true),
            ("4.5.1.stable", false),
            ("3.6.stable", false),
            ("nonsense", false),
        ] {
            assert_eq!(is_new_enough(version), is_new, "{version}");
        }
    }
}
