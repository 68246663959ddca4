//! A Vulkan driver: the machine's own, or Mesa's that draws on the processor.
//!
//! On Debian-like systems without one it is fetched into the cache from the machine's own archive (16 MB), as Mono is.

use crate::apt;
use crate::shared_libraries::{self, entries};
use anyhow::{Context as _, Result};
use serde_json::Value;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];
const LOADER: &str = "libvulkan.so.1";
/// Folders of descriptions of drivers, from a root.
const DRIVERS: [&str; 2] = ["usr/share/vulkan/icd.d", "etc/vulkan/icd.d"];

/// Vulkan on this machine.
#[derive(Debug)]
pub(crate) enum Vulkan {
    Installed,
    Unpacked {
        /// Folder of the loader and of what it needs.
        libraries: PathBuf,
        /// Description of the driver.
        driver: PathBuf,
    },
}

impl Vulkan {
    /// Finds a driver, or fetches one that needs no graphics card.
    ///
    /// # Errors
    /// Reason why it is missing and cannot be obtained.
    pub(crate) fn provision() -> Result<Self> {
        let root = Path::new("/");
        let has_driver = env::var_os("VK_DRIVER_FILES").is_some()
            || env::var_os("VK_ICD_FILENAMES").is_some()
            || driver(root).is_some();
        if !cfg!(target_os = "linux") || (has_driver && libraries(root).is_some()) {
            return Ok(Self::Installed);
        }
        let is_whole = |root: &Path| libraries(root).is_some() && software(root).is_some();
        let root = apt::in_cache("vulkan", &PACKAGES, is_whole).context(
            "there is no Vulkan driver: install mesa-vulkan-drivers, or that of your graphics card",
        )?;
        let libraries = libraries(&root).context("the packages hold no loader of Vulkan")?;
        let described = software(&root).context("the packages hold no driver for the processor")?;
        let driver = root.with_file_name("driver.json");
        let moved = moved(&fs::read_to_string(&described)?, &libraries)
            .with_context(|| format!("cannot understand {}", described.display()))?;
        fs::write(&driver, moved).with_context(|| format!("cannot write {}", driver.display()))?;
        Ok(Self::Unpacked { libraries, driver })
    }

    /// Has a program find the driver.
    pub(crate) fn given_to<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        match self {
            Self::Installed => command,
            Self::Unpacked { libraries, driver } => {
                shared_libraries::looked_for_in(command, libraries).env("VK_ICD_FILENAMES", driver)
            }
        }
    }
}

/// The folder of a system's libraries that has the loader.
fn libraries(root: &Path) -> Option<PathBuf> {
    shared_libraries::folder_of(LOADER, root)
}

/// Description of any driver of a system.
fn driver(root: &Path) -> Option<PathBuf> {
    let files = DRIVERS
        .iter()
        .flat_map(|folder| entries(&root.join(folder)));
    files
        .into_iter()
        .find(|file| file.extension().is_some_and(|end| end == "json"))
}

/// Description of the driver that draws on the processor.
fn software(root: &Path) -> Option<PathBuf> {
    let named = |file: &PathBuf| {
        let name = file.file_name().unwrap_or_default();
        name.to_string_lossy().starts_with("lvp_icd")
    };
    entries(&root.join(DRIVERS[0])).into_iter().find(named)
}

/// A description of a driver whose library lies in another folder than where it would be installed.
fn moved(description: &str, libraries: &Path) -> Result<String> {
    let mut description: Value = serde_json::from_str(description)?;
    let library = description
        .pointer_mut("/ICD/library_path")
        .context("it names no library")?;
    let name = Path::new(library.as_str().unwrap_or_default())
        .file_name()
        .context("the name of its library is empty")?;
    *library = libraries.join(name).to_string_lossy().into();
    Ok(description.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_driver_that_was_unpacked_is_found_where_it_lies() {
        for path in [
            "/usr/lib/x86_64-linux-gnu/libvulkan_lvp.so",
            "libvulkan_lvp.so",
        ] {
            let installed = format!(
                r#"{{"file_format_version": "1.0.0", "ICD": {{"library_path": "{path}", "api_version": "1.3"}}}}"#
            );
            let unpacked: Value =
                serde_json::from_str(&moved(&installed, Path::new("cache/lib")).unwrap()).unwrap();
            assert_eq!(
                unpacked["ICD"]["library_path"],
                "cache/lib/libvulkan_lvp.so"
            );
            assert_eq!(unpacked["ICD"]["api_version"], "1.3");
        }
        assert!(moved("{}", Path::new("cache/lib")).is_err());
    }

    #[test]
    fn a_program_gets_the_unpacked_driver_and_keeps_its_other_libraries() {
        let vulkan = Vulkan::Unpacked {
            libraries: "cache/lib".into(),
            driver: "cache/driver.json".into(),
        };
        let mut command = Command::new("example");
        let given: Vec<_> = vulkan.given_to(&mut command).get_envs().collect();
        let value = |name: &str| {
            let found = given.iter().find(|(key, _)| *key == name);
            found.and_then(|(_, value)| *value).unwrap().to_owned()
        };
        assert_eq!(value("VK_ICD_FILENAMES"), "cache/driver.json");
        let folders: Vec<PathBuf> = env::split_paths(&value("LD_LIBRARY_PATH")).collect();
        assert_eq!(folders[0], Path::new("cache/lib"));
        assert!(!folders.contains(&PathBuf::new()));
    }
}
