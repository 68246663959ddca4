//! LLVM's unwinder for Android, compiled from the sources that zig brings: what an NDK has as `libunwind.a`.

use super::super::Zig;
use super::zig_target;
use crate::process;
use anyhow::{Context as _, Result};
use std::path::Path;

/// Sources, each with the flags of its language.
const SOURCES: [(&str, &[&str]); 5] = [
    (
        "libunwind.cpp",
        &["-std=c++17", "-fno-exceptions", "-fno-rtti", "-nostdinc++"],
    ),
    ("UnwindLevel1.c", &["-std=c99", "-fexceptions"]),
    ("UnwindLevel1-gcc-ext.c", &["-std=c99", "-fexceptions"]),
    ("UnwindRegistersRestore.S", &[]),
    ("UnwindRegistersSave.S", &[]),
];

/// Writes `libunwind.a` into a folder; its symbols stay within the library that it is linked into.
///
/// # Errors
/// When a source does not compile.
pub(super) fn compile(zig: &Zig, architecture: &str, folder: &Path) -> Result<()> {
    let sources = zig.library().join("libunwind");
    let mut objects = Vec::new();
    for (source, flags) in SOURCES {
        let object = folder.join(source).with_extension("o");
        process::read(
            zig.command()
                .args(["cc", "-target", &zig_target(architecture), "-c", "-O2"])
                .args(["-fPIC", "-fvisibility=hidden", "-fno-sanitize=all"])
                .args(["-D_LIBUNWIND_HIDE_SYMBOLS", "-DNDEBUG"])
                .args(flags)
                .arg("-I")
                .arg(sources.join("include"))
                .arg(sources.join("src").join(source))
                .arg("-o")
                .arg(&object),
        )
        .with_context(|| format!("cannot compile {source}"))?;
        objects.push(object);
    }
    process::read(
        zig.command()
            .args(["ar", "rcs"])
            .arg(folder.join("libunwind.a"))
            .args(&objects),
    )
    .map(drop)
}
