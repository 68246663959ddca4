//! `cargo xtask link`: both Godot projects see `addons/` through a link, so that git holds the add-on once.

use crate::paths;
use anyhow::{Context as _, Result, bail};
use std::fs;
use std::path::Path;

/// Links the add-on into both Godot projects and says so.
///
/// # Errors
/// As [`ensure`].
pub(crate) fn command() -> Result<()> {
    ensure()?;
    eprintln!("demo_project/addons and tests/godot/addons show addons/");
    Ok(())
}

/// Links the add-on into both Godot projects; nothing is touched where the link is there already.
///
/// # Errors
/// When something else stands where the link belongs, or the link cannot be made.
pub(crate) fn ensure() -> Result<()> {
    let root = paths::repository_root();
    for (project, to_root) in [("demo_project", ".."), ("tests/godot", "../..")] {
        link(
            &root.join(project),
            &Path::new(to_root).join("addons"),
            &root.join("addons"),
        )?;
    }
    Ok(())
}

/// Makes `project/addons` show `addons`; `relative` is the way there from `project`.
fn link(project: &Path, relative: &Path, addons: &Path) -> Result<()> {
    fs::create_dir_all(project).with_context(|| format!("cannot create {}", project.display()))?;
    let link = project.join("addons");
    if let (Ok(found), Ok(wanted)) = (link.canonicalize(), addons.canonicalize())
        && found == wanted
    {
        return Ok(());
    }
    match link.symlink_metadata() {
        Ok(data) if data.is_symlink() => {
            fs::remove_file(&link)
                .with_context(|| format!("cannot remove the stale link {}", link.display()))?;
        }
        Ok(_) => bail!(
            "{} blocks the link to addons/; move it elsewhere",
            link.display()
        ),
        Err(_) => {}
    }
    make(relative, &link, addons)
        .with_context(|| format!("cannot link {} to addons/", link.display()))
}

#[cfg(unix)]
fn make(relative: &Path, link: &Path, _addons: &Path) -> Result<()> {
    Ok(std::os::unix::fs::symlink(relative, link)?)
}

/// A junction needs no rights, unlike a symbolic link.
#[cfg(windows)]
fn make(_relative: &Path, link: &Path, addons: &Path) -> Result<()> {
    let native = |path: &Path| {
        path.display()
            .to_string()
            .trim_start_matches(r"\\?\")
            .replace('/', "\\")
    };
    crate::process::read(
        std::process::Command::new("cmd")
            .args(["/C", "mklink", "/J"])
            .arg(native(link))
            .arg(native(addons)),
    )
    .map(drop)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn linking_twice_is_linking_once_and_a_stale_link_is_renewed() {
        let folder = std::env::temp_dir().join(format!("footfall_link_{}", std::process::id()));
        let (addons, project) = (folder.join("addons"), folder.join("project"));
        fs::create_dir_all(addons.join("footfall")).unwrap();
        for _ in 0..2 {
            link(&project, Path::new("../addons"), &addons).unwrap();
            assert!(project.join("addons/footfall").is_dir());
        }
        fs::remove_file(project.join("addons")).unwrap();
        std::os::unix::fs::symlink("../nowhere", project.join("addons")).unwrap();
        link(&project, Path::new("../addons"), &addons).unwrap();
        assert!(project.join("addons/footfall").is_dir());
        fs::remove_file(project.join("addons")).unwrap();
        fs::create_dir(project.join("addons")).unwrap();
        assert!(
            link(&project, Path::new("../addons"), &addons)
                .unwrap_err()
                .to_string()
                .contains("blocks the link")
        );
        fs::remove_dir_all(folder).unwrap();
    }
}
