//! The changelog's section about one version.

use anyhow::{Context as _, Result, ensure};

/// The section of a version, or what is not released yet where it has none; without its heading.
///
/// # Errors
/// When there is no such section, or nothing in it.
pub(super) fn section(changelog: &str, version: &str) -> Result<String> {
    let text = under(changelog, &format!("## [{version}]"))
        .or_else(|| under(changelog, "## [Unreleased]"))
        .with_context(|| format!("CHANGELOG.md has no section about {version}"))?;
    ensure!(
        !text.trim().is_empty(),
        "CHANGELOG.md says nothing about {version}"
    );
    Ok(format!("# Footfall {version}\n\n{}\n", text.trim()))
}

/// Text between a heading and the next of its kind.
fn under<'a>(changelog: &'a str, heading: &str) -> Option<&'a str> {
    let at = changelog.find(heading)?;
    let text = &changelog[at..];
    let text = &text[text.find('\n')?..];
    Some(&text[..text.find("\n## ").unwrap_or(text.len())])
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOG: &str =
        "# Changelog\n\n## [Unreleased]\n\n### Added\n\n- new\n\n## [0.1.0] - 2026\n\n- old\n";

    #[test]
    fn a_version_has_its_own_section_or_what_is_not_released_yet() {
        assert_eq!(
            section(LOG, "0.1.0").unwrap(),
            "# Footfall 0.1.0\n\n- old\n"
        );
        assert_eq!(
            section(LOG, "0.2.0").unwrap(),
            "# Footfall 0.2.0\n\n### Added\n\n- new\n"
        );
        assert!(section("# Changelog\n", "0.2.0").is_err());
        assert!(section("## [Unreleased]\n\n## [0.1.0]\n", "0.2.0").is_err());
    }
}
