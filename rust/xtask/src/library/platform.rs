//! Names of the library on each platform, as `footfall.gdextension` has them.

use super::Flavour;
use anyhow::{Result, bail};
use std::env::consts::{ARCH, OS};
use std::path::{Path, PathBuf};

/// Name of a library on a platform, and its place in the add-on.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Platform {
    pub(super) folder: &'static str,
    prefix: &'static str,
    suffix: &'static str,
}

impl Platform {
    /// The platform of a target triple; of this machine without one.
    pub(super) fn of(target: Option<&str>) -> Result<Self> {
        let host = format!("{ARCH}-{OS}");
        let target = target.unwrap_or(&host);
        let arm = target.starts_with("aarch64");
        let (folder, prefix, suffix) = match target {
            _ if target.contains("android") && arm => ("android-arm64", "lib", "so"),
            _ if target == "x86_64-linux-android" => ("android-x86_64", "lib", "so"),
            _ if target.contains("linux") && !target.contains("android") => (
                if arm { "linux-arm64" } else { "linux-x86_64" },
                "lib",
                "so",
            ),
            _ if target.contains("windows") => (
                if arm {
                    "windows-arm64"
                } else {
                    "windows-x86_64"
                },
                "",
                "dll",
            ),
            _ if target.contains("darwin") || target.contains("macos") => {
                ("macos-universal", "lib", "dylib")
            }
            _ => bail!(
                "the add-on is not built for {target}: Linux, Windows, macOS or Android, on x86-64 or arm64"
            ),
        };
        Ok(Self {
            folder,
            prefix,
            suffix,
        })
    }

    /// Argument by which the platform's linker follows a script as well, where it knows scripts.
    pub(super) fn link_argument(&self, script: &Path) -> Option<String> {
        let script = script.display();
        match self.system() {
            "linux" => Some(format!("-Wl,-T,{script}")),
            // There `rust-lld` is called itself.
            "android" => Some(format!("-T{script}")),
            _ => None,
        }
    }

    /// Operating system, as the folder names it.
    pub(super) fn system(&self) -> &str {
        self.folder.split('-').next().unwrap_or_default()
    }

    /// Cargo's name of the library.
    pub(super) fn built(&self) -> String {
        format!("{}footfall_godot.{}", self.prefix, self.suffix)
    }

    /// Its path in the add-on, from `addons/footfall`.
    pub(super) fn shipped(&self, flavour: Flavour) -> PathBuf {
        let name = match flavour {
            Flavour::Editor => format!("{}footfall_godot.editor.{}", self.prefix, self.suffix),
            Flavour::Game => self.built(),
        };
        Path::new("bin").join(self.folder).join(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_are_named_as_the_gdextension_file_names_them() {
        let shipped = |target, flavour| {
            Platform::of(Some(target))
                .unwrap()
                .shipped(flavour)
                .display()
                .to_string()
        };
        let editor = Flavour::Editor;
        assert_eq!(
            shipped("x86_64-unknown-linux-gnu", editor),
            "bin/linux-x86_64/libfootfall_godot.editor.so"
        );
        assert_eq!(
            shipped("x86_64-unknown-linux-gnu", Flavour::Game),
            "bin/linux-x86_64/libfootfall_godot.so"
        );
        assert_eq!(
            shipped("aarch64-unknown-linux-gnu", Flavour::Game),
            "bin/linux-arm64/libfootfall_godot.so"
        );
        assert_eq!(
            shipped("x86_64-pc-windows-gnu", editor),
            "bin/windows-x86_64/footfall_godot.editor.dll"
        );
        assert_eq!(
            shipped(super::super::MACOS_UNIVERSAL, Flavour::Game),
            "bin/macos-universal/libfootfall_godot.dylib"
        );
        assert_eq!(
            shipped("aarch64-linux-android", Flavour::Game),
            "bin/android-arm64/libfootfall_godot.so"
        );
        assert_eq!(
            shipped("x86_64-linux-android", Flavour::Game),
            "bin/android-x86_64/libfootfall_godot.so"
        );
        assert!(Platform::of(Some("wasm32-unknown-unknown")).is_err());
        assert!(Platform::of(None).is_ok());
    }
}
