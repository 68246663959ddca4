//! Checks of the first minutes with the add-on, unzipped into a project on a machine that has never seen it: `cargo verify newcomer`.

use crate::godot::Engine;
use crate::{addon, engine_run, export, godot, open, paths, skipped};
use anyhow::{Context as _, Result, bail};
use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Line that the project prints when everything that a newcomer does has worked.
const DONE: &str = "NEWCOMER OK";
/// Line that the editor prints when the add-on works that was unzipped while it ran.
const DONE_IN_EDITOR: &str = "RUNNING EDITOR OK";
/// Lines of a project's settings that enable the add-on's plugin.
const PLUGIN_ENABLED: &str =
    "\n[editor_plugins]\n\nenabled=PackedStringArray(\"res://addons/footfall/plugin.cfg\")\n";
/// Folder of the project's checks and of the plugin of the running editor.
const SOURCES: &str = "tests/newcomer";

/// Checks the archive of the add-on with the libraries that are in `bin/`, in both flavours. The projects and games of a check, up to 400 MB,
/// are removed when it has passed.
///
/// # Errors
/// The first thing that does not go as it should.
pub(crate) fn check() -> Result<()> {
    if !cfg!(target_os = "linux") {
        return skipped::note("newcomer", "the newcomer's game is exported on Linux only");
    }
    let engine = godot::provision()?;
    let folder = paths::target_folder().join("newcomer");
    paths::make_empty(&folder)?;
    let newcomer = Newcomer {
        archive: folder.join("footfall-addon.zip"),
        work: folder.join("work"),
        engine,
        folder,
    };
    addon::archive(&newcomer.archive)?;
    let checks = [
        Newcomer::imports_first,
        Newcomer::exports_first,
        Newcomer::brings_an_old_project,
        Newcomer::unzips_into_a_running_editor,
        Newcomer::has_half_an_addon,
    ];
    for check in checks {
        check(&newcomer)?;
        paths::make_empty(&newcomer.work)?;
    }
    Ok(())
}

/// A newcomer with the archive, a Godot and a folder.
struct Newcomer {
    engine: Engine,
    /// Folder of the archive and of the logs.
    folder: PathBuf,
    archive: PathBuf,
    /// Folder of the projects and games.
    work: PathBuf,
}

impl Newcomer {
    /// The editor's first look at a project succeeds, and the project runs.
    fn imports_first(&self) -> Result<()> {
        let project = self.project("first_import")?;
        self.quiet(self.godot(&project).arg("--import"), "first_import")?;
        self.runs(&project, "first_run")
    }

    /// A build server exports a project that no editor has opened.
    fn exports_first(&self) -> Result<()> {
        let project = self.project("first_export")?;
        self.exports(&project, "first_export")
    }

    /// A project has `.import` files of the add-on of another day, whose importers are gone, and nothing that they made.
    fn brings_an_old_project(&self) -> Result<()> {
        let project = self.project("old_project")?;
        let models = project.join("addons/footfall/models");
        let mut left_behind = Vec::new();
        for entry in fs::read_dir(&models).context("the archive holds no models")? {
            let uid = entry?.path();
            if uid.extension().is_some_and(|extension| extension == "uid") {
                let import = uid.with_extension("import");
                fs::write(&import, old_import(&fs::read_to_string(&uid)?))?;
                // The engine makes them anew, of what the `.import` files say.
                fs::remove_file(&uid)?;
                left_behind.push(import);
            }
        }
        if left_behind.is_empty() {
            bail!("the models have no .uid files");
        }
        self.quiet(self.godot(&project).arg("--import"), "old_project_import")?;
        self.runs(&project, "old_project_run")?;
        if let Some(import) = left_behind.iter().find(|file| file.exists()) {
            bail!("{} is still there", import.display());
        }
        for import in left_behind {
            fs::write(import, old_import(""))?;
        }
        self.exports(&project, "old_project_export")
    }

    /// The add-on works in an editor that ran when it was unzipped.
    fn unzips_into_a_running_editor(&self) -> Result<()> {
        let project = self.work.join("running_editor");
        copy(
            &paths::repository_root().join(SOURCES).join("editor"),
            &project,
        )?;
        let mut editor = self.godot(&project);
        editor.arg("--editor").arg("--").arg(&self.archive);
        self.says(&mut editor, "running_editor", DONE_IN_EDITOR)
    }

    /// Checks the messages without the library, without models at a node, and with files of two versions in the editor.
    fn has_half_an_addon(&self) -> Result<()> {
        let project = self.project("no_library")?;
        fs::remove_dir_all(project.join("addons/footfall/bin"))?;
        let mut settings = fs::OpenOptions::new()
            .append(true)
            .open(project.join("project.godot"))?;
        settings.write_all(PLUGIN_ENABLED.as_bytes())?;
        self.complains(
            self.godot(&project).args(["--editor", "--quit"]),
            "no_library",
            "is missing. Unzip the add-on again, or build the library",
        )?;
        let project = self.project("no_models")?;
        fs::remove_dir_all(project.join("addons/footfall/models"))?;
        let log = self.log("no_models_import");
        engine_run::started(self.godot(&project).arg("--import"), &log)?;
        self.complains(
            self.godot(&project)
                .args(["--fixed-fps", "60", "--quit-after", "3000"])
                .arg("res://without_model.tscn"),
            "no_models",
            "models/locomotion.footfall, is missing. Unzip the add-on again, or load",
        )?;
        let project = self.project("two_versions")?;
        let plugin = project.join("addons/footfall/plugin.cfg");
        let (version, other) = ("version=\"", "version=\"9.");
        fs::write(
            &plugin,
            fs::read_to_string(&plugin)?.replace(version, other),
        )?;
        self.complains(
            self.godot(&project)
                .args(["--editor", "--quit-after", "120"]),
            "two_versions",
            "Footfall: its files are of version 9.",
        )
    }

    /// The newcomer's project with the add-on in it, before it is opened for the first time.
    fn project(&self, name: &str) -> Result<PathBuf> {
        let project = self.work.join(name);
        copy(
            &paths::repository_root().join(SOURCES).join("project"),
            &project,
        )?;
        let archive = File::open(&self.archive)
            .with_context(|| format!("cannot read {}", self.archive.display()))?;
        zip::ZipArchive::new(archive)?.extract(&project)?;
        Ok(project)
    }

    fn godot(&self, project: &Path) -> Command {
        open::headless(&self.engine, project)
    }

    /// The project's checks hold.
    fn runs(&self, project: &Path, name: &str) -> Result<()> {
        self.says(self.godot(project).args(["--fixed-fps", "60"]), name, DONE)
    }

    /// The project becomes a game in which its checks hold.
    fn exports(&self, project: &Path, name: &str) -> Result<()> {
        if self.engine.release_template.is_none() {
            return skipped::note(name, "this Godot came without an export template");
        }
        eprintln!("{name} …");
        let game = self.work.join(format!("{name}_game/game.x86_64"));
        export::make(&self.engine, project, &game, &self.log(name))?;
        let mut game = godot::exported_game(&self.engine, &game)?;
        game.args(["--headless", "--audio-driver", "Dummy", "--fixed-fps", "60"]);
        self.says(&mut game, &format!("{name}_game"), DONE)
    }

    fn says(&self, command: &mut Command, name: &str, wanted: &str) -> Result<()> {
        let said = self.quiet(command, name)?;
        if !said.contains(wanted) {
            bail!("it did not say {wanted}: {}", self.log(name).display());
        }
        Ok(())
    }

    /// Runs Godot, which must say what is wrong, whatever else it says.
    fn complains(&self, command: &mut Command, name: &str, wanted: &str) -> Result<()> {
        eprintln!("{name} …");
        let (_, said) = engine_run::started(command, &self.log(name))?;
        if !said.contains(wanted) {
            bail!("it did not say \"{wanted}\": {}", self.log(name).display());
        }
        Ok(())
    }

    /// Runs Godot, which must not report a single error.
    fn quiet(&self, command: &mut Command, name: &str) -> Result<String> {
        eprintln!("{name} …");
        engine_run::quiet(command, &self.log(name))
    }

    fn log(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.log"))
    }
}

/// Text that the importers of old wrote beside a model.
fn old_import(uid: &str) -> String {
    let uid = uid.trim();
    format!(
        "[remap]\n\nimporter=\"footfall.gait_model\"\nimporter_version=1\ntype=\"GaitModel\"\nuid=\"{uid}\"\n\
         path=\"res://.godot/imported/gone.res\"\n\n[deps]\n\nsource_file=\"res://gone\"\n\
         dest_files=[\"res://.godot/imported/gone.res\"]\n\n[params]\n"
    )
}

/// Copies a folder with all that is in it.
fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("cannot create {}", to.display()))?;
    for entry in fs::read_dir(from).with_context(|| format!("cannot read {}", from.display()))? {
        let entry = entry?;
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type()?.is_dir() {
            copy(&source, &target)?;
        } else {
            fs::copy(&source, &target)
                .with_context(|| format!("cannot copy {}", source.display()))?;
        }
    }
    Ok(())
}
