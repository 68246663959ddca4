//! Needs and offers of a built library, whatever its format: ELF, PE or Mach-O.

use anyhow::{Context as _, Result, bail};
use object::read::macho::{FatArch as _, MachOFatFile32};
use object::read::{Import as Read, ImportFlags, NameOrOrdinal};
use object::{FileKind, Object as _};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// A name that another library has to have.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Import {
    /// The library, where the format says it.
    pub(crate) library: String,
    /// The name; `#` and a number for one that is requested by its number.
    pub(crate) name: String,
    /// The version of the name, as `GLIBC_2.17`; empty without one.
    pub(crate) version: String,
    /// Loading goes on without it.
    pub(crate) weak: bool,
}

/// Asked for and offered by a library of one architecture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Binary {
    /// Architecture, such as `Aarch64`.
    pub(crate) architecture: String,
    /// Libraries that are loaded with it.
    pub(crate) libraries: BTreeSet<String>,
    /// Names that these have to have.
    pub(crate) imports: BTreeSet<Import>,
    /// Names that it offers.
    pub(crate) exports: BTreeSet<String>,
}

impl Binary {
    /// Reads a library of one architecture.
    ///
    /// # Errors
    /// When it cannot be read or is damaged.
    pub(crate) fn read(file: &Path) -> Result<Self> {
        let bytes = fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        parse(&bytes).with_context(|| format!("{} is damaged", file.display()))
    }

    /// Fails unless it offers the entry point that `footfall.gdextension` names.
    ///
    /// # Errors
    /// When it does not.
    pub(crate) fn has_entry_point(&self) -> Result<()> {
        // Names of macOS begin with an underscore.
        if ["footfall_init", "_footfall_init"]
            .iter()
            .any(|&name| self.exports.contains(name))
        {
            return Ok(());
        }
        bail!("it does not offer footfall_init, which footfall.gdextension names");
    }

    /// Fails unless `known` holds every name that loading needs; returns how many these are.
    ///
    /// # Errors
    /// With the names that are not known.
    pub(crate) fn asks_only_for(&self, known: impl Fn(&Import) -> bool) -> Result<usize> {
        let needed = self.imports.iter().filter(|import| !import.weak);
        let (found, missing): (Vec<_>, Vec<_>) = needed.partition(|&import| known(import));
        if missing.is_empty() {
            return Ok(found.len());
        }
        let names: Vec<String> = missing
            .iter()
            .map(|import| [import.library.as_str(), import.name.as_str()].join(" "))
            .collect();
        bail!("the system does not offer {}", names.join(", "));
    }
}

/// Every architecture of a library of macOS, which holds several in one file.
///
/// # Errors
/// When it is none or is damaged.
pub(crate) fn slices(bytes: &[u8]) -> Result<Vec<&[u8]>> {
    match FileKind::parse(bytes)? {
        FileKind::MachOFat32 => MachOFatFile32::parse(bytes)?
            .arches()
            .iter()
            .map(|arch| Ok(arch.data(bytes)?))
            .collect(),
        _ => Ok(vec![bytes]),
    }
}

/// Reads a library of one architecture from its bytes.
///
/// # Errors
/// When it is damaged.
pub(crate) fn parse(bytes: &[u8]) -> Result<Binary> {
    let file = object::File::parse(bytes)?;
    let mut imports = BTreeSet::new();
    for import in file.imports()? {
        imports.insert(described(&import?));
    }
    let mut libraries = BTreeSet::new();
    for library in file.import_libraries()? {
        libraries.insert(text(library?.name()));
    }
    let mut exports = BTreeSet::new();
    for export in file.exports()? {
        exports.insert(named(export?.name()));
    }
    Ok(Binary {
        architecture: format!("{:?}", file.architecture()),
        libraries,
        imports,
        exports,
    })
}

fn described(import: &Read<'_>) -> Import {
    let version = match import.flags() {
        ImportFlags::Elf { version, .. } => version.unwrap_or_default(),
        _ => &[],
    };
    Import {
        library: text(import.library()),
        name: named(import.name()),
        version: text(version),
        weak: import.is_weak(),
    }
}

fn named(name: NameOrOrdinal<&[u8]>) -> String {
    match name {
        NameOrOrdinal::Name(name) => text(name),
        NameOrOrdinal::Ordinal(number) => format!("#{number}"),
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asking(imports: &[(&str, bool)]) -> Binary {
        Binary {
            architecture: "X86_64".into(),
            libraries: BTreeSet::new(),
            imports: imports
                .iter()
                .map(|&(name, weak)| Import {
                    library: "libc.so.6".into(),
                    name: name.into(),
                    version: String::new(),
                    weak,
                })
                .collect(),
            exports: BTreeSet::new(),
        }
    }

    #[test]
    fn what_loading_needs_has_to_be_known_and_nothing_else() {
        let library = asking(&[("malloc", false), ("gettid", true), ("strange", false)]);
        let error = library
            .asks_only_for(|one| one.name == "malloc")
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            "the system does not offer libc.so.6 strange"
        );
        assert_eq!(
            library.asks_only_for(|one| one.name != "gettid").unwrap(),
            2
        );
    }

    #[test]
    fn a_library_without_the_entry_point_is_told() {
        let mut library = asking(&[]);
        assert!(library.has_entry_point().is_err());
        library.exports.insert("_footfall_init".into());
        library.has_entry_point().unwrap();
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn this_programs_own_needs_are_read() {
        let own = Binary::read(&std::env::current_exe().unwrap()).unwrap();
        assert!(own.libraries.iter().any(|name| name.starts_with("libc.")));
        assert!(
            own.imports
                .iter()
                .any(|one| one.version.starts_with("GLIBC_2."))
        );
    }

    #[test]
    fn what_is_no_library_is_an_error() {
        assert!(parse(b"no library").is_err());
        assert!(slices(b"no").is_err());
    }
}
