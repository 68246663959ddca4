//! Stubs of Android's system libraries: the names that a library may ask for, without code.
//!
//! The names are those that the official engine takes from the system, which runs on every Android from 7.0 on, and [`MORE`].

use super::super::Zig;
use super::{engine, zig_target};
use crate::binary::{Binary, Import};
use crate::process;
use anyhow::{Context as _, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Names that each library of the system offers.
pub(super) type Names = BTreeMap<&'static str, BTreeSet<String>>;

/// Libraries of the system that Rust asks for. A name is looked for in those that the add-on's library names, so each stub has its library's own.
const LIBRARIES: [&str; 4] = ["libc.so", "libdl.so", "liblog.so", "libm.so"];

/// Names that the engine does not use and the system has had since API level 24 or longer, as the lists of its symbols say (`libc.map.txt`,
/// `libdl.map.txt` and `libm.map.txt` of Android's C library).
pub(super) const MORE: [&str; 33] = [
    "accept4",
    "cfmakeraw",
    "clock_nanosleep",
    "dirfd",
    "dl_iterate_phdr",
    "dladdr",
    "epoll_create1",
    "epoll_ctl",
    "epoll_wait",
    "eventfd",
    "flock",
    "freeifaddrs",
    "fsync",
    "getifaddrs",
    "getpwuid_r",
    "if_nametoindex",
    "log1p",
    "log1pf",
    "lseek64",
    "ppoll",
    "prctl",
    "pread64",
    "pwrite64",
    "readv",
    "recvmsg",
    "sendmsg",
    "shutdown",
    "socketpair",
    "tcdrain",
    "tcflush",
    "tcgetattr",
    "tcsetattr",
    "writev",
];

/// Writes a stub of each library into a folder.
///
/// # Errors
/// When the engine's libraries cannot be read, or the linker fails.
pub(super) fn write(zig: &Zig, architecture: &str, engine: &Path, folder: &Path) -> Result<()> {
    for (library, names) in names(architecture, engine)? {
        let source = folder.join(library).with_extension("s");
        fs::write(&source, text(&names))
            .with_context(|| format!("cannot write {}", source.display()))?;
        process::read(
            zig.command()
                .args(["cc", "-target", &zig_target(architecture)])
                .args(["-shared", "-nostdlib", &format!("-Wl,-soname,{library}")])
                .arg(&source)
                .arg("-o")
                .arg(folder.join(library)),
        )
        .with_context(|| format!("cannot make a stub of Android's {library}"))?;
    }
    Ok(())
}

/// Every name that the official engine takes from each library of the system, and [`MORE`].
///
/// # Errors
/// When the engine's libraries cannot be read.
pub(super) fn names(architecture: &str, engine: &Path) -> Result<Names> {
    let mut names: Names = LIBRARIES.map(|library| (library, BTreeSet::new())).into();
    for library in engine::libraries(engine, architecture) {
        for import in Binary::read(&library)?.imports {
            add(&mut names, home(&import), &import.name);
        }
    }
    for name in MORE {
        let library = match name {
            _ if name.starts_with("dl") => "libdl.so",
            _ if name.starts_with("log1p") => "libm.so",
            _ => "libc.so",
        };
        add(&mut names, library, name);
    }
    Ok(names)
}

fn add(names: &mut Names, library: &str, name: &str) {
    if let Some(own) = names.get_mut(library) {
        own.insert(name.to_owned());
    }
}

/// The library that an import is of: its version says it, but the log's library has no versions.
fn home(import: &Import) -> &str {
    if import.name.starts_with("__android_log_") {
        "liblog.so"
    } else {
        &import.library
    }
}

/// Assembly that defines every name.
fn text(names: &BTreeSet<String>) -> String {
    let mut text = String::from(".text\n");
    for name in names {
        text.extend([
            ".globl ",
            name,
            "\n.type ",
            name,
            ",%function\n",
            name,
            ":\n",
        ]);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_defined() {
        let names = ["malloc", "free"].map(str::to_owned).into();
        let text = text(&names);
        assert!(text.contains(".globl malloc\n") && text.contains("\nmalloc:\n"));
        assert!(text.contains("\nfree:\n"));
    }
}
