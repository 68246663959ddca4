//! Check that the add-on's files and its library are of one version: an archive that was unzipped over a running editor, or halfway, leaves them apart.

use crate::shipped;
use godot::classes::ConfigFile;
use godot::global::Error;
use godot::prelude::*;

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Reports files of another version than the library.
pub(super) fn check() {
    let file = format!("{}/plugin.cfg", shipped::folder());
    let mut config = ConfigFile::new_gd();
    // An add-on may do without the file.
    if config.load(&file) != Error::OK {
        return;
    }
    let version = config.get_value("plugin", "version").to_string();
    if version != VERSION {
        godot_error!(
            "Footfall: its files are of version {version}, its library of version {VERSION}. Close the editor, remove {}, and unzip the add-on again.",
            shipped::folder()
        );
    }
}
