//! Classes that the library registers with the engine, as a headless Godot reports them, with the class reference beside them.

use super::documents::Documents;
use crate::{demo, engine_run, godot, link, open, paths};
use anyhow::{Context as _, Result};
use serde::Deserialize;
use std::fs;

/// Classes that the library registers, and what is written of them.
#[derive(Debug)]
pub(super) struct Reference {
    pub(super) classes: Vec<Class>,
    pub(super) documents: Documents,
}

/// The file that `class_reference.gd` writes.
#[derive(Deserialize)]
struct ReferenceFile {
    classes: Vec<Class>,
    documents: Vec<String>,
}

/// One class, without what it inherits.
#[derive(Debug, Deserialize)]
pub(super) struct Class {
    pub(super) name: String,
    pub(super) base: String,
    pub(super) can_be_made: bool,
    pub(super) properties: Vec<Property>,
    pub(super) methods: Vec<Method>,
    pub(super) signals: Vec<Signal>,
}

/// Something with a type, as the engine describes it.
#[derive(Debug, Deserialize)]
pub(super) struct Slot {
    pub(super) name: String,
    #[serde(rename = "type")]
    pub(super) variant: u32,
    pub(super) class_name: String,
    pub(super) hint: u32,
    pub(super) hint_string: String,
    pub(super) usage: u64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Property {
    #[serde(flatten)]
    pub(super) slot: Slot,
    pub(super) writable: bool,
}

#[derive(Debug, Deserialize)]
pub(super) struct Method {
    pub(super) name: String,
    pub(super) args: Vec<Slot>,
    #[serde(rename = "return")]
    pub(super) returns: Slot,
    pub(super) flags: u32,
    /// Of the last parameters, as `GDScript` writes them.
    pub(super) defaults: Vec<String>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Signal {
    pub(super) name: String,
    pub(super) args: Vec<Slot>,
}

impl Slot {
    /// The class of an object, that of all resources where several are allowed.
    pub(super) fn class(&self) -> Option<&str> {
        let named = [&self.class_name, &self.hint_string];
        let name = named.into_iter().find(|name| !name.is_empty())?;
        Some(if name.contains(',') { "Resource" } else { name })
    }
}

impl Class {
    pub(super) fn property_names(&self) -> Vec<&str> {
        let names = self.properties.iter().map(|one| &one.slot.name);
        names.map(String::as_str).collect()
    }

    pub(super) fn method_names(&self) -> Vec<&str> {
        self.methods.iter().map(|one| one.name.as_str()).collect()
    }

    /// Everything of it that has a type.
    pub(super) fn slots(&self) -> impl Iterator<Item = &Slot> {
        let properties = self.properties.iter().map(|one| &one.slot);
        let methods = self.methods.iter();
        let methods = methods.flat_map(|one| one.args.iter().chain([&one.returns]));
        let signals = self.signals.iter().flat_map(|one| &one.args);
        properties.chain(methods).chain(signals)
    }

    pub(super) fn signal_names(&self) -> Vec<&str> {
        self.signals.iter().map(|one| one.name.as_str()).collect()
    }
}

impl Method {
    /// The engine's `METHOD_FLAG_STATIC`.
    pub(super) fn is_static(&self) -> bool {
        self.flags & 32 != 0
    }

    /// The default of a parameter.
    pub(super) fn default_of(&self, index: usize) -> Option<&str> {
        let required = self.args.len() - self.defaults.len();
        let index = index.checked_sub(required)?;
        self.defaults.get(index).map(String::as_str)
    }
}

impl Reference {
    /// Asks the library as it is built now, in the project of the tests.
    ///
    /// # Errors
    /// When Godot cannot be started, or does not know the add-on.
    pub(super) fn ask() -> Result<Self> {
        let engine = godot::provision()?;
        link::ensure()?;
        let project = paths::repository_root().join("tests/godot");
        if !project.join(".godot/extension_list.cfg").is_file() {
            demo::import(&engine, &project, "tests")?;
        }
        let folder = paths::target_folder().join("csharp");
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot create {}", folder.display()))?;
        let file = folder.join("class_reference.json");
        engine_run::judged(
            open::headless(&engine, &project)
                .args(["--script", "res://class_reference.gd", "--"])
                .arg(&file),
            &folder.join("class_reference.log"),
        )?;
        let text =
            fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        Self::read(&text)
    }

    pub(super) fn read(text: &str) -> Result<Self> {
        let file: ReferenceFile =
            serde_json::from_str(text).context("the class reference is damaged")?;
        let documents = Documents::read(&file.documents)?;
        let mut classes = file.classes;
        // Other extensions are not ours; the add-on's own tools are named after it.
        classes.retain(|class| {
            documents.class(&class.name).is_some() && !class.name.starts_with("Footfall")
        });
        // The order of registration is the linker's, and another one in every profile. Properties are one struct's, in its order.
        classes.sort_by(|one, other| one.name.cmp(&other.name));
        for class in &mut classes {
            class
                .methods
                .sort_by(|one, other| one.name.cmp(&other.name));
            class
                .signals
                .sort_by(|one, other| one.name.cmp(&other.name));
        }
        Ok(Self { classes, documents })
    }

    /// The class of ours with this name.
    pub(super) fn class(&self, name: &str) -> Option<&Class> {
        self.classes.iter().find(|class| class.name == name)
    }
}
