//! Debian's archive as the machine's own apt knows it: its site and the key that signs it.

use super::SUITE;
use crate::apt::Apt;
use crate::{paths, process};
use anyhow::{Context as _, Result};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A Debian archive that this machine already trusts.
#[derive(Debug)]
pub(in crate::godot) struct Archive {
    pub(super) site: String,
    /// The field `Signed-By` of the machine's own source, when it has one; continuation lines included.
    signed_by: Option<String>,
    pub(super) architecture: &'static Architecture,
}

/// Names of an architecture in Debian.
#[derive(Debug)]
pub(super) struct Architecture {
    pub(super) debian: &'static str,
    pub(super) libraries: &'static str,
    pub(super) loader: &'static str,
}

pub(super) const ARM64: Architecture = Architecture {
    debian: "arm64",
    libraries: "usr/lib/aarch64-linux-gnu",
    loader: "usr/lib/ld-linux-aarch64.so.1",
};

pub(super) const ARCHITECTURES: [Architecture; 2] = [
    Architecture {
        debian: "amd64",
        libraries: "usr/lib/x86_64-linux-gnu",
        loader: "usr/lib64/ld-linux-x86-64.so.2",
    },
    ARM64,
];

impl Architecture {
    /// This machine's.
    pub(super) fn of_host() -> Result<&'static Self> {
        let debian = process::read(Command::new("dpkg").arg("--print-architecture"))?;
        ARCHITECTURES
            .iter()
            .find(|one| one.debian == debian.trim())
            .with_context(|| {
                format!(
                    "Debian's {} is not among the architectures known here",
                    debian.trim()
                )
            })
    }
}

impl Archive {
    /// Asks the machine's own apt for the archive.
    pub(in crate::godot) fn find(cache: &Path) -> Result<Self> {
        for tool in ["apt-get", "dpkg"] {
            paths::on_path(&[tool])
                .with_context(|| format!("there is no `{tool}` on this system"))?;
        }
        let architecture = Architecture::of_host()?;
        let (site, entry) = match debian_site(&targets(Command::new("apt-get"))?) {
            Some(found) => found,
            // Where the system's lists are empty, apt does not know its archive yet: fetch lists of our own.
            None => debian_site(&targets_from_own_lists(&cache.join("probe"))?)
                .context("no source of this system's apt is Debian's own archive")?,
        };
        let signed_by = signed_by(&entry)?;
        Ok(Self {
            site,
            signed_by,
            architecture,
        })
    }

    /// A source of the one suite, in the same format as the machine's own.
    pub(super) fn source(&self) -> String {
        let signed_by = self
            .signed_by
            .as_ref()
            .map(|value| format!("Signed-By:{value}\n"))
            .unwrap_or_default();
        format!(
            "Types: deb\nURIs: {}\nSuites: {SUITE}\nComponents: main\n{signed_by}",
            self.site
        )
    }
}

/// Each package index that apt knows of: origin, code name, site and the source entry it stems from.
fn targets(mut apt_get: Command) -> Result<String> {
    let format = "$(CREATED_BY)|$(ORIGIN)|$(CODENAME)|$(SITE)|$(SOURCESENTRY)";
    process::read(apt_get.args(["indextargets", "--format", format]))
}

fn targets_from_own_lists(folder: &Path) -> Result<String> {
    eprintln!("asking the package archives for their lists …");
    let apt = Apt::bare(folder)?;
    process::read(apt.get().arg("update")).context("apt cannot reach its package archives")?;
    targets(apt.get())
}

/// The site of Debian's main archive and the entry of the source that names it.
fn debian_site(targets: &str) -> Option<(String, String)> {
    targets.lines().find_map(|line| {
        let mut fields = line.split('|');
        let (created_by, origin, codename) = (fields.next()?, fields.next()?, fields.next()?);
        let (site, entry) = (fields.next()?, fields.next()?);
        let main =
            created_by == "Packages" && origin == "Debian" && !codename.contains("-security");
        main.then(|| (site.to_owned(), entry.to_owned()))
    })
}

/// The key of a source, given as `file:number` as apt names it: a stanza of a `.sources` file, a line of a `.list` file.
fn signed_by(entry: &str) -> Result<Option<String>> {
    let (file, number) = entry
        .rsplit_once(':')
        .context("apt names its source in a way that is not known here")?;
    let number: usize = number
        .parse()
        .with_context(|| format!("apt's source {entry} has no number"))?;
    let text =
        fs::read_to_string(file).with_context(|| format!("cannot read apt's source {file}"))?;
    Ok(if file.ends_with(".sources") {
        key_of_stanza(&text, number)
    } else {
        key_of_line(&text, number)
    })
}

fn key_of_stanza(text: &str, number: usize) -> Option<String> {
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let stanza = lines
        .split(|line| line.trim().is_empty())
        .filter(|stanza| !stanza.is_empty())
        .nth(number.checked_sub(1)?)?;
    let mut lines = stanza
        .iter()
        .skip_while(|line| !line.to_ascii_lowercase().starts_with("signed-by:"));
    let first = lines.next()?.split_once(':')?.1.to_owned();
    Some(
        lines
            .take_while(|line| line.starts_with([' ', '\t']))
            .fold(first, |value, line| format!("{value}\n{line}")),
    )
}

fn key_of_line(text: &str, number: usize) -> Option<String> {
    let options = text
        .lines()
        .nth(number.checked_sub(1)?)?
        .split_once('[')?
        .1
        .split_once(']')?
        .0;
    let key = options
        .split_whitespace()
        .find_map(|option| option.strip_prefix("signed-by="))?;
    Some(format!(" {}", key.replace(',', " ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_main_archive_is_told_from_security_and_strangers() {
        let targets = "Packages|Google|stable|https://a.example/x|/etc/apt/x.list:1\n\
                       Packages|Debian|bookworm-security|http://b.example/s|/etc/apt/d.sources:2\n\
                       DEP-11|Debian|bookworm|http://c.example/debian|/etc/apt/d.sources:1\n\
                       Packages|Debian|bookworm|http://c.example/debian|/etc/apt/d.sources:1\n";
        let expected = (
            "http://c.example/debian".to_owned(),
            "/etc/apt/d.sources:1".to_owned(),
        );
        assert_eq!(debian_site(targets), Some(expected));
        assert_eq!(
            debian_site("Packages|Ubuntu|noble|http://u.example|/etc/apt/u.sources:1"),
            None
        );
    }

    #[test]
    fn keys_are_read_from_both_formats() {
        let stanzas = "# note\nTypes: deb\nSigned-By: /a.gpg\n\nTypes: deb\n# note\nSigned-By:\n -----BEGIN\n .\n key\nSuites: x\n";
        assert_eq!(key_of_stanza(stanzas, 1).as_deref(), Some(" /a.gpg"));
        assert_eq!(
            key_of_stanza(stanzas, 2).as_deref(),
            Some("\n -----BEGIN\n .\n key")
        );
        assert_eq!(key_of_stanza(stanzas, 3), None);
        assert_eq!(key_of_stanza("Types: deb\n", 1), None);
        let lines = "# note\ndeb [arch=amd64 signed-by=/a.gpg,/b.gpg] http://x bookworm main\ndeb http://y z main\n";
        assert_eq!(key_of_line(lines, 2).as_deref(), Some(" /a.gpg /b.gpg"));
        assert_eq!(key_of_line(lines, 3), None);
    }
}
