//! Packages of the machine's own archive, unpacked side by side in a folder. Nothing is installed on the system and no rights are needed.

use crate::{paths, process, progress};
use anyhow::{Context as _, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// An apt with its state apart from the system's.
#[derive(Debug)]
pub(crate) struct Apt {
    folder: PathBuf,
    options: Vec<String>,
}

/// One file to fetch.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Package {
    pub(crate) file: String,
    bytes: u64,
}

impl Apt {
    /// One that takes nothing for installed: what it fetches runs without the system's libraries.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub(crate) fn bare(folder: &Path) -> Result<Self> {
        let mut apt = Self::on_system(folder)?;
        let status = folder.join("status");
        if !status.exists() {
            fs::write(&status, "").with_context(|| format!("cannot write {}", status.display()))?;
        }
        apt.option(&format!("Dir::State::Status={}", status.display()));
        Ok(apt)
    }

    /// One that knows what the system has: only what is missing is fetched.
    ///
    /// # Errors
    /// When the folder cannot be written.
    pub(crate) fn on_system(folder: &Path) -> Result<Self> {
        for part in ["lists/partial", "cache/archives/partial"] {
            fs::create_dir_all(folder.join(part))
                .with_context(|| format!("cannot write into {}", folder.display()))?;
        }
        let mut apt = Self {
            folder: folder.to_path_buf(),
            options: Vec::new(),
        };
        for (name, part) in [
            ("Dir::State::Lists", "lists"),
            ("Dir::State::extended_states", "extended_states"),
            ("Dir::Cache", "cache"),
        ] {
            apt.option(&format!("{name}={}", folder.join(part).display()));
        }
        for option in [
            "APT::Install-Recommends=false",
            "Acquire::Languages=none",
            // The folder is the user's own: apt's download user could not write there.
            "APT::Sandbox::User=",
            "Debug::NoLocking=true",
            "Acquire::Retries=3",
        ] {
            apt.option(option);
        }
        Ok(apt)
    }

    /// Sets one of apt's own options.
    pub(crate) fn option(&mut self, option: &str) {
        self.options.push(format!("-o{option}"));
    }

    /// `apt-get` with this state.
    pub(crate) fn get(&self) -> Command {
        let mut command = Command::new("apt-get");
        command
            .env("DEBIAN_FRONTEND", "noninteractive")
            .env("LC_ALL", "C")
            .args(&self.options);
        command
    }

    /// Every package that is needed for these, themselves included.
    ///
    /// # Errors
    /// When apt cannot have them.
    pub(crate) fn packages(&self, names: &[&str]) -> Result<Vec<Package>> {
        let said = process::read(
            self.get()
                .args(["install", "-y", "--download-only", "--print-uris", "-qq"])
                .args(names),
        )
        .with_context(|| format!("apt finds no way to have {}", names.join(", ")))?;
        let packages = parse_uris(&said);
        if packages.is_empty() {
            bail!(
                "apt lists nothing to download: remove {} and run this again",
                self.folder.display()
            );
        }
        Ok(packages)
    }

    /// Downloads; what an interrupted run had finished is kept.
    ///
    /// # Errors
    /// When the download breaks off.
    pub(crate) fn download(&self, names: &[&str], packages: &[Package]) -> Result<()> {
        let archives = self.archives();
        let total = packages.iter().map(|package| package.bytes).sum();
        let bar = progress::bytes(total, &format!("downloading {} packages", packages.len()));
        let log = archives.with_file_name("download.log");
        let output =
            fs::File::create(&log).with_context(|| format!("cannot write {}", log.display()))?;
        let mut child = self
            .get()
            .args(["install", "-y", "--download-only", "-q=2"])
            .args(names)
            .stdin(Stdio::null())
            .stdout(output.try_clone()?)
            .stderr(output)
            .spawn()
            .context("cannot start `apt-get`")?;
        let status = loop {
            if let Some(status) = child.try_wait()? {
                break status;
            }
            bar.set_position(bytes_in(&archives) + bytes_in(&archives.join("partial")));
            std::thread::sleep(Duration::from_millis(100));
        };
        bar.finish_and_clear();
        if !status.success() {
            let said = fs::read_to_string(&log).unwrap_or_default();
            bail!(
                "the download was interrupted; run this again to resume it:\n{}",
                process::tail(&said, 8)
            );
        }
        Ok(())
    }

    /// Unpacks into `root`, beside it first and renamed at the end, so that a half-made one is never taken for whole; then drops the
    /// packages. `what` is said while it goes on.
    ///
    /// # Errors
    /// When the disk is full or a package damaged.
    pub(crate) fn unpack(&self, packages: &[Package], root: &Path, what: &str) -> Result<()> {
        let archives = self.archives();
        let partial = root.with_extension("partial");
        for folder in [&partial, root] {
            if folder.exists() {
                fs::remove_dir_all(folder)
                    .with_context(|| format!("cannot remove {}", folder.display()))?;
            }
        }
        fs::create_dir_all(&partial)
            .with_context(|| format!("cannot create {}", partial.display()))?;
        let bar = progress::count(packages.len() as u64, what);
        for package in packages {
            process::read(
                Command::new("dpkg")
                    .arg("-x")
                    .arg(archives.join(&package.file))
                    .arg(&partial),
            )
            .with_context(|| format!("cannot unpack {}: is the disk full?", package.file))?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        fs::rename(&partial, root).with_context(|| format!("cannot create {}", root.display()))?;
        fs::remove_dir_all(&archives)
            .with_context(|| format!("cannot clear {}", archives.display()))
    }

    /// Fetches packages of the machine's own suites, with what they need that it has not, and unpacks them into `root` of the folder.
    ///
    /// # Errors
    /// When there is no apt, or it cannot have them.
    pub(crate) fn fetch(folder: &Path, names: &[&str], what: &str) -> Result<PathBuf> {
        for tool in ["apt-get", "dpkg"] {
            paths::on_path(&[tool])
                .with_context(|| format!("there is no `{tool}` on this system"))?;
        }
        let apt = Self::on_system(&folder.join("apt"))?;
        process::read(apt.get().arg("update")).context("apt cannot reach its package archives")?;
        let packages = apt.packages(names)?;
        apt.download(names, &packages)?;
        let root = folder.join("root");
        apt.unpack(&packages, &root, what)?;
        Ok(root)
    }

    fn archives(&self) -> PathBuf {
        self.folder.join("cache/archives")
    }
}

/// The folder that packages of the machine's own archive are unpacked into, in the cache: as an earlier call left it, if that works, or fetched now.
///
/// # Errors
/// When apt is not there or cannot have them, or when what it has does not work.
pub(crate) fn in_cache(
    name: &str,
    packages: &[&str],
    works: impl Fn(&Path) -> bool,
) -> Result<PathBuf> {
    let cache = paths::cache(name)?;
    fs::create_dir_all(&cache).with_context(|| format!("cannot create {}", cache.display()))?;
    let lock = fs::File::create(cache.join("lock"))
        .with_context(|| format!("cannot write into {}", cache.display()))?;
    lock.lock()
        .with_context(|| format!("cannot lock {}", cache.display()))?;
    let root = cache.join("root");
    if works(&root) {
        return Ok(root);
    }
    Apt::fetch(
        &cache,
        packages,
        &format!("unpacking {}", packages.join(", ")),
    )?;
    if !works(&root) {
        bail!(
            "what was just fetched ({}) does not work",
            packages.join(", ")
        );
    }
    Ok(root)
}

/// Lines such as `'<address>' name_1.0_amd64.deb 1234 SHA256:…`.
fn parse_uris(said: &str) -> Vec<Package> {
    let package = |line: &str| {
        let mut words = line
            .strip_prefix('\'')?
            .split_once('\'')?
            .1
            .split_whitespace();
        Some(Package {
            file: words.next()?.to_owned(),
            bytes: words.next()?.parse().ok()?,
        })
    };
    said.lines().filter_map(package).collect()
}

/// The size of the packages that lie in a folder, whole or in part.
fn bytes_in(folder: &Path) -> u64 {
    let Ok(entries) = fs::read_dir(folder) else {
        return 0;
    };
    entries
        .flatten()
        .filter(|entry| entry.file_name().to_string_lossy().contains(".deb"))
        .filter_map(|entry| entry.metadata().ok())
        .map(|data| data.len())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_names_are_read_from_apt() {
        let said = "'http://x/pool/g/godot_4.6%2bds-1_amd64.deb' godot_4.6+ds-1_amd64.deb 1234 SHA256:ab\nNotice: other\n";
        assert_eq!(
            parse_uris(said),
            [Package {
                file: "godot_4.6+ds-1_amd64.deb".into(),
                bytes: 1234
            }]
        );
    }
}
